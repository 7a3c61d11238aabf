//! The number of cases of an attack.

/// Returns `few`; four times as many with `HAMEL_ATTACK=more`, as in `cargo xtask ci`, and `many` with
/// `HAMEL_ATTACK=full`.
pub fn size(few: u64, many: u64) -> u64 {
    match std::env::var("HAMEL_ATTACK").as_deref() {
        Ok("full") => many,
        Ok("more") => 4 * few,
        _ => few,
    }
}
