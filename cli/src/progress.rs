//! Progress bars on standard error, shown if it is a terminal.

use crate::failure::warn_of;
use hamel_engine::{Reporter, Warning};
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Interval between updates of a spinner.
const TICK: Duration = Duration::from_millis(200);

/// Returns a bar for a number of steps, with the remaining time.
fn bar(steps: u64) -> ProgressBar {
    styled(steps, "{percent}%  {eta} left")
}

/// Returns a bar for many items, with their rate and the remaining time.
pub fn rated(count: u64) -> ProgressBar {
    let bar = styled(count, "{percent}%  {pos} of {len}, {per_sec}, {eta} left");
    bar.enable_steady_tick(TICK);
    bar
}

fn styled(steps: u64, told: &str) -> ProgressBar {
    let colour = anstream::AutoStream::choice(&std::io::stderr()) != anstream::ColorChoice::Never;
    let bar = ProgressBar::new(steps);
    let drawn = if colour { "{bar:40.cyan}" } else { "{bar:40}" };
    match ProgressStyle::with_template(&format!("{drawn} {told}")) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Returns a bar with a name and the elapsed time; its length is set later.
pub fn named(name: &str) -> ProgressBar {
    let bar = ProgressBar::new(1).with_message(name.to_string());
    match ProgressStyle::with_template("{msg} {bar:40} {elapsed}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Shows what the engine reports on standard error: warnings, and how long work takes if that is a terminal.
#[derive(Default)]
pub struct Terminal(Mutex<Option<ProgressBar>>);

impl Terminal {
    fn bar(&self) -> MutexGuard<'_, Option<ProgressBar>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Reporter for Terminal {
    fn warn(&self, warning: &Warning<'_>) {
        warn_of(warning);
    }

    fn begin(&self, work: &'static str) {
        let spinner = ProgressBar::new_spinner().with_message(work);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
            spinner.set_style(style);
        }
        spinner.enable_steady_tick(TICK);
        self.bar().replace(spinner);
    }

    fn advance(&self, done: u64, all: u64) {
        self.bar()
            .get_or_insert_with(|| bar(all))
            .set_position(done);
    }

    fn end(&self) {
        if let Some(bar) = self.bar().take() {
            bar.finish_and_clear();
        }
    }
}
