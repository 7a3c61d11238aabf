//! `--keep`: the results kept of each member.

use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::syntax::suggest::closest;
use hamel_engine::option_text::Piece;
use hamel_engine::source::added_outputs::{self, AddedOutput};

pub const OPTION: &str = "--keep";

/// The possible items, as messages list them.
const KNOWN_ITEMS: &str =
    "the choices are end, max(EXPR), min(EXPR), mean(EXPR), at(TIME, EXPR), event(EXPR < EXPR)";
const NAMES: [&str; 6] = ["end", "max", "min", "mean", "at", "event"];

/// The quantity derived from an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// Maximum.
    Max,
    /// Minimum.
    Min,
    /// Mean over time.
    Mean,
    /// Value at a time.
    At(f64),
    /// The first time at which a comparison becomes true: value less than 0, or at most 0.
    Event {
        /// Whether 0 counts.
        equal: bool,
    },
}

/// A kept item.
#[derive(Clone, Debug, PartialEq)]
pub enum Item<'a> {
    /// The end time of a member, x and ξ.
    End,
    /// A quantity of an expression; for an event, of the difference of two.
    Quantity(Quantity, Vec<Piece<'a>>),
}

/// An item with its text.
pub type KeptItem<'a> = (Piece<'a>, Item<'a>);

/// Returns the outputs to add for the kept items.
pub fn outputs_to_add<'a>(kept: &[KeptItem<'a>]) -> Vec<AddedOutput<'a>> {
    let of = |(index, (whole, item)): (usize, &KeptItem<'a>)| match item {
        Item::End => None,
        Item::Quantity(_, sides) => Some(AddedOutput {
            name: added_outputs::name(index),
            whole: *whole,
            sides: sides.clone(),
        }),
    };
    kept.iter().enumerate().filter_map(of).collect()
}

/// Reads the option for runs of length `until`: items, and the errors of others.
pub fn read(text: &str, until: f64) -> (Vec<KeptItem<'_>>, Vec<Diagnostic>) {
    let (mut kept, mut errors): (Vec<KeptItem>, Vec<Diagnostic>) = Default::default();
    let whole = match Piece::of(text) {
        Ok(whole) => whole,
        Err(error) => return (kept, vec![error]),
    };
    for piece in whole
        .split(';')
        .into_iter()
        .filter(|piece| !piece.text.is_empty())
    {
        if kept.iter().any(|(known, _)| known.text == piece.text) {
            errors.push(piece.wrong(format!("`{}` is kept twice", piece.text)));
            continue;
        }
        match item(piece, until) {
            Ok(item) => kept.push((piece, item)),
            Err(error) => errors.push(error),
        }
    }
    if kept.is_empty() && errors.is_empty() {
        errors.push(whole.wrong("nothing is kept").help(KNOWN_ITEMS));
    }
    (kept, errors)
}

fn item(piece: Piece, until: f64) -> Result<Item, Diagnostic> {
    if piece.text == "end" {
        return Ok(Item::End);
    }
    let Some((name, inner)) = piece.call() else {
        let message = format!("`{}` cannot be kept", piece.text);
        return Err(piece.wrong(message).help(KNOWN_ITEMS));
    };
    let alone = |piece: Piece<'_>| match piece.split(',').as_slice() {
        [one] if !one.text.is_empty() => Ok(()),
        _ => Err(piece.wrong("expected one expression")),
    };
    let of = match name.text {
        "max" => Quantity::Max,
        "min" => Quantity::Min,
        "mean" => Quantity::Mean,
        "event" => return event(inner),
        "at" => {
            let [time, expression] = inner.split(',')[..] else {
                return Err(inner.wrong("expected a time and an expression: at(TIME, EXPR)"));
            };
            alone(expression)?;
            let at = time.text.parse::<f64>().ok();
            let Some(at) = at.filter(|at| (0.0..=until).contains(at)) else {
                return Err(time.wrong(format!("expected a time from 0 to {until}")));
            };
            return Ok(Item::Quantity(Quantity::At(at), vec![expression]));
        }
        other => {
            let help = match closest(other, NAMES) {
                Some(close) => format!("did you mean `{close}`?"),
                None => KNOWN_ITEMS.into(),
            };
            let message = format!("nothing that can be kept is called `{other}`");
            return Err(name.wrong(message).help(help));
        }
    };
    alone(inner)?;
    Ok(Item::Quantity(of, vec![inner]))
}

/// Parses `A < B`, which becomes A − B < 0; the other direction becomes B − A < 0.
fn event(inner: Piece) -> Result<Item, Diagnostic> {
    let outside = inner.outside();
    let bytes = inner.text.as_bytes();
    let signs: Vec<usize> = outside
        .into_iter()
        .filter(|place| matches!(bytes[*place], b'<' | b'>' | b'='))
        .collect();
    let (place, equal) = match signs.as_slice() {
        [one] if bytes[*one] != b'=' => (*one, false),
        [one, next] if *next == one + 1 && bytes[*one] != b'=' && bytes[*next] == b'=' => {
            (*one, true)
        }
        _ => {
            let message = "expected one comparison, as in event(r[3] < 0)";
            return Err(inner.wrong(message));
        }
    };
    let behind = place + 1 + usize::from(equal);
    let (left, right) = (inner.part(0..place), inner.part(behind..inner.text.len()));
    for side in [left, right] {
        if side.text.is_empty() || side.split(',').len() > 1 {
            return Err(inner.wrong("expected an expression on each side of the comparison"));
        }
    }
    let sides = match bytes[place] {
        b'<' => vec![left, right],
        _ => vec![right, left],
    };
    Ok(Item::Quantity(Quantity::Event { equal }, sides))
}

#[cfg(test)]
mod tests {
    use super::{Item, OPTION, Quantity, read};
    use crate::sweep::distribution::Distribution;
    use hamel_engine::option_text::{Piece, invalid_option};

    fn refused(text: &str) -> String {
        let (_, errors) = read(text, 10.0);
        assert!(!errors.is_empty(), "{text}");
        invalid_option(OPTION, text, &errors).to_string()
    }

    #[test]
    fn items_are_read() {
        let kept = read(
            "end; max(norm(w)); event(r[3] >= [1, 2][1]);at(2.5,w) ;",
            10.0,
        );
        let (kept, errors) = kept;
        assert!(errors.is_empty(), "{errors:?}");
        let texts: Vec<&str> = kept.iter().map(|(piece, _)| piece.text).collect();
        assert_eq!(
            texts,
            [
                "end",
                "max(norm(w))",
                "event(r[3] >= [1, 2][1])",
                "at(2.5,w)"
            ]
        );
        let Item::Quantity(Quantity::Event { equal: true }, sides) = &kept[2].1 else {
            panic!("{kept:?}");
        };
        assert_eq!((sides[0].text, sides[1].text), ("[1, 2][1]", "r[3]"));
        assert!(matches!(kept[3].1, Item::Quantity(Quantity::At(2.5), _)));
    }

    /// Random texts are read or refused, and their errors can be rendered.
    #[test]
    fn no_text_panics() {
        let words = [
            "max", "min(", "event(", "at(", "end", ";", ",", "(", ")", "[", "]", "{", "}", "<",
            "<=", ">", "=", "ü", "→", " ", "1", "1e999", "x", "normal(", "grid(", "\n", "//", "'",
        ];
        let mut state: u64 = 1;
        let mut next = |below: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as usize % below
        };
        let (mut good, mut bad) = (0, 0);
        for _ in 0..20_000 {
            let text: String = (0..1 + next(9)).map(|_| words[next(words.len())]).collect();
            let numbers = |piece: Piece| match piece.text.len() {
                1 => Ok(vec![1.0]),
                _ => Err(piece.wrong("unknown".to_string())),
            };
            if let Ok(piece) = Piece::of(&text) {
                for entries in [1, 3] {
                    if let Err(errors) = Distribution::read(piece, entries, &numbers) {
                        invalid_option("--vary", &text, &errors);
                    }
                }
            }
            match read(&text, 10.0).1.as_slice() {
                [] => good += 1,
                errors => {
                    invalid_option(OPTION, &text, errors);
                    bad += 1;
                }
            }
        }
        assert!(good > 50 && bad > 10_000, "{good} {bad}");
    }

    #[test]
    fn wrong_items_are_refused_all_at_once() {
        let said =
            refused("ends; max(a, b); event(a); event(a < b < c); at(11, a); mix(a); end; end");
        for message in [
            "`ends` cannot be kept",
            "expected one expression",
            "expected one comparison",
            "expected a time from 0 to 10",
            "did you mean `max`",
            "`end` is kept twice",
            "7 errors",
        ] {
            assert!(said.contains(message), "{message}: {said}");
        }
        assert!(refused("").contains("nothing is kept"));
        assert!(refused("event(a == b)").contains("one comparison"));
        assert!(refused("event(< b)").contains("on each side"));
    }
}
