//! Tests that reserved words of C are not used as identifiers.

use super::legal_identifier;

#[test]
fn words_of_c_and_of_its_headers_are_left_to_them() {
    for word in ["int", "y0", "sin", "sinf", "linux", "xor", "gamma"] {
        assert_eq!(legal_identifier(word.into()), format!("{word}_"));
    }
    for word in ["of", "f", "sine", "m", "k", "infinity"] {
        assert_eq!(legal_identifier(word.into()), word);
    }
}
