//! No-op progress bars for builds without the feature `command`.

/// A bar that is not shown.
pub struct Bar;

impl Bar {
    pub fn set_position(&self, _: u64) {}

    pub fn set_length(&self, _: u64) {}

    pub fn finish_and_clear(&self) {}
}

/// A bar for a number of steps.
pub fn bar(_: u64) -> Bar {
    Bar
}

/// A bar that is not shown.
pub fn hidden() -> Bar {
    Bar
}

/// A bar with a name.
pub fn named(_: &str) -> Bar {
    Bar
}

/// Does work of unknown length.
pub fn during<T>(_: &'static str, work: impl FnOnce() -> T) -> T {
    work()
}
