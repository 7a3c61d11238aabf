//! Which of many models a slow comparison looks at.

/// Every third of a list, and all of it with `HAMEL_ATTACK`, as in `cargo xtask ci`: for models whose identities, physics and
/// tables other tests look at one by one.
pub fn thin_out<T>(all: Vec<T>) -> Vec<T> {
    let apart = match std::env::var_os("HAMEL_ATTACK") {
        Some(_) => 1,
        None => 3,
    };
    all.into_iter().step_by(apart).collect()
}
