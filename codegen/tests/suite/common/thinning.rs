//! Selects models for a slow comparison.

/// Returns every third entry of a list, or all of them with `HAMEL_ATTACK`, as in `cargo xtask ci`: for models whose
/// identities, physics and tables are checked by other tests.
pub fn thin_out<T>(all: Vec<T>) -> Vec<T> {
    let apart = match std::env::var_os("HAMEL_ATTACK") {
        Some(_) => 1,
        None => 3,
    };
    all.into_iter().step_by(apart).collect()
}
