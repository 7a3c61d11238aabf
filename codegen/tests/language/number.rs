//! Literals: decimals are exact, and everything else is refused.

use included::value;

// Included, since the text of a description never gives an empty literal.
#[path = "../../language/src/syntax/number.rs"]
mod included;

fn exact(text: &str) -> String {
    match value(text, text) {
        Ok(number) => number.to_string(),
        Err(refusal) => {
            assert!(!refusal.help.is_empty(), "{text}");
            refusal.message
        }
    }
}

#[test]
fn decimals_are_exact() {
    assert_eq!(exact("9.81"), "981/100");
    assert_eq!(exact("1e-3"), "1/1000");
    assert_eq!(exact("1_000"), "1000");
    assert_eq!(exact("1."), "1");
    assert_eq!(exact("0.1"), "1/10");
    assert_eq!(exact("2.5E+1"), "25");
    assert_eq!(exact("1_0.0_1e0_1"), "1001/10");
    assert_eq!(exact("0"), "0");
    assert_eq!(exact("007"), "7");
    assert_eq!(exact("1e400").len(), 401);
    assert_eq!(exact("1e-400").len(), 403);
}

#[test]
fn other_literals_are_refused() {
    assert_eq!(exact("1e401"), "the exponent of `1e401` is beyond 400");
    assert_eq!(
        exact("1e-99999999999999999999"),
        "the exponent of `1e-99999999999999999999` is beyond 400"
    );
    assert_eq!(exact(&"1".repeat(401)), "a number of more than 400 digits");
    assert_eq!(exact("1e"), "the exponent of `1e` is missing");
    assert_eq!(exact("1u8"), "the number `1u8` has a suffix");
    assert_eq!(exact("1e3f64"), "the number `1e3f64` has a suffix");
    assert_eq!(exact("2m"), "the number `2m` has a suffix");
    assert_eq!(exact("0x1F"), "`0x1F` is not a decimal number");
    assert_eq!(exact("\"a\""), "a string is not a value: `\"a\"`");
    assert_eq!(exact("'a'"), "a character is not a value: `'a'`");
    assert_eq!(exact(""), "not a number: ``");
}
