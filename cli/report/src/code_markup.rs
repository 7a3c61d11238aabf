//! Texts with `code` between backticks, as in Markdown, for output in other formats.

use maud::{Markup, html};

/// Splits a text into parts, each with a flag for code. An unpaired backtick is an ordinary character.
fn parts(text: &str) -> Vec<(&str, bool)> {
    let mut parts = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('`') {
        let Some((code, after)) = after.split_once('`').filter(|(code, _)| !code.is_empty()) else {
            break;
        };
        parts.extend([(before, false), (code, true)]);
        rest = after;
    }
    parts.push((rest, false));
    parts.retain(|(part, _)| !part.is_empty());
    parts
}

/// Renders a text as HTML.
pub fn mark_up(text: &str) -> Markup {
    html! {
        @for (part, code) in parts(text) {
            @if code { code { (part) } } @else { (part) }
        }
    }
}

/// Removes the marks, for pictures and titles of pages, in which code has no style.
pub fn plain(text: &str) -> String {
    parts(text).into_iter().map(|(part, _)| part).collect()
}

#[cfg(test)]
mod tests {
    use super::{mark_up, plain};

    #[test]
    fn code_stands_between_pairs_of_backticks() {
        for (text, html, bare) in [
            ("a & b", "a &amp; b", "a & b"),
            (
                "`auto` takes `a < b`.",
                "<code>auto</code> takes <code>a &lt; b</code>.",
                "auto takes a < b.",
            ),
            ("one ` alone", "one ` alone", "one ` alone"),
            ("`x` and `", "<code>x</code> and `", "x and `"),
            ("`` is none", "`` is none", "`` is none"),
            ("`<b>`", "<code>&lt;b&gt;</code>", "<b>"),
        ] {
            assert_eq!(mark_up(text).into_string(), html);
            assert_eq!(plain(text), bare);
        }
    }
}
