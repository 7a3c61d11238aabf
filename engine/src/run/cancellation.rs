//! Cancellation of runs.

use std::fmt;
use std::sync::Arc;

/// Cancellation token of a run: a function that returns whether to cancel it. It is called often, and has to be fast.
#[derive(Clone)]
pub struct CancellationToken(pub Arc<dyn Fn() -> bool + Send + Sync>);

impl fmt::Debug for CancellationToken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("CancellationToken")
    }
}
