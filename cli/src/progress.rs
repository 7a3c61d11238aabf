//! Progress bars on standard error, shown if it is a terminal.

pub use indicatif::ProgressBar as Bar;
use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// Interval between updates of a spinner.
const TICK: Duration = Duration::from_millis(200);

/// A bar for a number of steps, with the remaining time.
pub fn bar(steps: u64) -> Bar {
    styled(steps, "{percent}%  {eta} left")
}

/// A bar for many items, with their rate and the remaining time.
pub fn rated(count: u64) -> Bar {
    let bar = styled(count, "{percent}%  {pos} of {len}, {per_sec}, {eta} left");
    bar.enable_steady_tick(TICK);
    bar
}

fn styled(steps: u64, told: &str) -> Bar {
    let colour = anstream::AutoStream::choice(&std::io::stderr()) != anstream::ColorChoice::Never;
    let bar = ProgressBar::new(steps);
    let drawn = if colour { "{bar:40.cyan}" } else { "{bar:40}" };
    match ProgressStyle::with_template(&format!("{drawn} {told}")) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// A bar that is not shown.
pub fn hidden() -> Bar {
    ProgressBar::hidden()
}

/// A bar with a name and the elapsed time; its length is set later.
pub fn named(name: &str) -> Bar {
    let bar = ProgressBar::new(1).with_message(name.to_string());
    match ProgressStyle::with_template("{msg} {bar:40} {elapsed}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Does work of unknown length, showing the elapsed time.
pub fn during<T>(what: &'static str, work: impl FnOnce() -> T) -> T {
    let bar = ProgressBar::new_spinner().with_message(what);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(TICK);
    let done = work();
    bar.finish_and_clear();
    done
}
