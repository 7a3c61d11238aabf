//! Suggestions for misspelt words.

use hamel_language::syntax::suggest::closest;

#[test]
fn close_words_are_suggested() {
    let words = ["velocity", "rate", "coord", "output"];
    assert_eq!(closest("velocty", words), Some("velocity"));
    assert_eq!(closest("raet", words), Some("rate"));
    assert_eq!(closest("Coord", words), Some("coord"));
    assert_eq!(closest("spring", words), None);
    assert_eq!(closest("", words), None);
    assert_eq!(closest(&"r".repeat(1_000_000), words), None);
}
