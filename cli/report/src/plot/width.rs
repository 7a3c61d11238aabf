//! Estimates the width of texts: the font on a reader's machine is unknown, so the widest of the fonts in the style
//! sheet is assumed.

/// Returns the width of a text of this size, in whole pixels.
pub fn width(text: &str, size: f64, bold: bool) -> f64 {
    let em: f64 = text.chars().map(letter).sum();
    (size * em * if bold { 1.0 } else { REGULAR_WIDTH }).ceil()
}

/// Returns the text, or a beginning of it with `…` if it is wider than `widest`.
pub fn fit(text: &str, size: f64, bold: bool, widest: f64) -> String {
    if width(text, size, bold) <= widest {
        return text.to_string();
    }
    let mut kept = text.to_string();
    while !kept.is_empty() && width(&format!("{kept}…"), size, bold) > widest {
        kept.pop();
    }
    format!("{}…", kept.trim_end())
}

/// Width of a letter that is not bold, relative to a bold one.
const REGULAR_WIDTH: f64 = 0.9;

/// Returns the width of a bold letter, relative to the size of the font.
fn letter(letter: char) -> f64 {
    match letter {
        // Combining marks.
        '\u{300}'..='\u{36f}' => 0.0,
        'i' | 'j' | 'l' | 'I' | ' ' | '.' | ',' | ':' | ';' | '\'' | '|' => 0.38,
        'f' | 'r' | 't' | '(' | ')' | '[' | ']' | '-' | '/' | '!' | '·' => 0.5,
        '⁰'..='⁹' | '₀'..='₉' | '¹' | '²' | '³' | '⁻' => 0.46,
        'm' | 'w' | 'M' | 'W' | '%' | '@' => 1.1,
        'a'..='z' | '0'..='9' | '_' => 0.72,
        'A'..='Z' => 0.84,
        '\u{20}'..='\u{7e}' => 0.84,
        // Letters of scripts in square form are among these.
        '\u{2e80}'..='\u{ffff}' => 1.1,
        _ => 0.88,
    }
}

#[cfg(test)]
mod tests {
    use super::{fit, width};

    #[test]
    fn wide_letters_count_for_more() {
        assert!(width("mmm", 12.0, true) > 2.0 * width("iii", 12.0, true));
        assert!(width("abc", 12.0, true) > width("abc", 12.0, false));
        assert_eq!(width("ξ̇", 12.0, true), width("ξ", 12.0, true));
    }

    #[test]
    fn what_is_too_long_is_cut_where_it_fits() {
        assert_eq!(fit("a top", 12.0, false, 100.0), "a top");
        let cut = fit("a top whose axis is held at one point", 12.0, false, 100.0);
        assert!(cut.starts_with("a top") && cut.ends_with('…'), "{cut}");
        assert!(width(&cut, 12.0, false) <= 100.0);
    }
}
