//! Functions at the top of a generated module, each only if it is used: what modules of arrays do not have.

/// Names and texts of the helpers.
const HELPERS: &[(&str, &str)] = &[
    (
        "_entries",
        r#"
def _entries(xp, given, length, name):
    """Entries of the states in an array, along a new first axis."""
    given = xp.asarray(given) + 0.0
    if given.ndim == 0 or given.shape[-1] != length:
        raise ValueError(f"`{name}` needs {length} numbers along its last axis, but its shape is {given.shape}")
    return xp.moveaxis(given, -1, 0)
"#,
    ),
    (
        "_shaped",
        r#"
def _shaped(xp, entries, shape, arguments, valid):
    """Entries of a result along its last axes, NaN where a pivot is not positive."""
    axes = xp.broadcast_shapes(*(xp.shape(a)[1:] for a in arguments), *(xp.shape(a) for a in (valid, *entries)))
    if not entries:
        return xp.zeros(axes + shape)
    entries = [xp.broadcast_to(xp.asarray(a), axes) for a in entries]
    if valid is not True:
        entries = [xp.where(valid, a, math.nan) for a in entries]
    return xp.reshape(xp.stack(entries, axis=-1), axes + shape)
"#,
    ),
    (
        "_is_positive",
        r#"
def _is_positive(a):
    """Whether a pivot can be divided by."""
    return (a > 0.0) & (a < math.inf)
"#,
    ),
    (
        "_select",
        r#"
def _select(xp, c, a, b):
    """a where c > 0, else b; NaN where c is."""
    return xp.where(c > 0.0, a, xp.where(c <= 0.0, b, c))
"#,
    ),
    (
        "_sign",
        r#"
def _sign(xp, a):
    """1 with the sign of a, 0 of 0, NaN of NaN."""
    return xp.sign(a)
"#,
    ),
    (
        "_inverse_of_length",
        r#"
def _inverse_of_length(xp, a):
    """1/a, but a large number where a is nearly 0: times a sum of products that are 0 there it is 0."""
    shortest = 1e-100 if xp.finfo(xp.result_type(a)).eps < 1e-10 else 1e-12
    return 1.0 / xp.where(xp.abs(a) < shortest, shortest, a)
"#,
    ),
    (
        "_raised",
        r#"
def _raised(xp, a):
    """a, larger by a part that rounding does not hide: a pivot that may be nothing but rounding can be divided by."""
    bits = 26 if xp.finfo(xp.result_type(a)).eps < 1e-10 else 15
    return a * (1.0 + 2.0**-bits)
"#,
    ),
];

/// Returns the Python source of the helper functions that a text calls.
pub fn helpers_used_by(text: &str) -> String {
    let called = HELPERS
        .iter()
        .filter(|(name, _)| text.contains(&format!("{name}(")));
    called.map(|(_, text)| format!("\n{text}")).collect()
}

#[cfg(test)]
mod tests {
    use super::HELPERS;
    use hamel_algebra::function::Function;

    /// A function that `<math.h>` does not have has a helper.
    #[test]
    fn every_function_has_a_name_in_python() {
        for function in Function::ALL {
            if let Some(helper) = function.row().c.strip_prefix('@') {
                assert!(HELPERS.iter().any(|(name, _)| *name == helper), "{helper}");
            }
        }
    }
}
