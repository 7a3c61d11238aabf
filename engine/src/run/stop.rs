//! Runs that nobody wants any more.

use std::fmt;
use std::sync::Arc;

/// A function that is asked on the way of a run whether the run is to end there: often, so that it has to be quick.
#[derive(Clone)]
pub struct Stop(pub Arc<dyn Fn() -> bool + Send + Sync>);

impl fmt::Debug for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Stop")
    }
}
