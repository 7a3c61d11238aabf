//! Cancellation of runs.

use std::fmt;
use std::sync::Arc;

/// A callback that returns whether to cancel a run. It is called often, and has to be fast.
#[derive(Clone)]
pub struct Stop(pub Arc<dyn Fn() -> bool + Send + Sync>);

impl fmt::Debug for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Stop")
    }
}
