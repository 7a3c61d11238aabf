//! Texts in which `code` stands between backticks, as in Markdown, for places that are no Markdown.

use maud::{Markup, html};

/// The parts of a text in turn, and whether they are code. A backtick without a partner stands for itself.
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

/// The text in HTML.
pub fn mark_up(text: &str) -> Markup {
    html! {
        @for (part, code) in parts(text) {
            @if code { code { (part) } } @else { (part) }
        }
    }
}

/// The text without marks, where nothing can be set apart: in pictures and titles of pages.
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
