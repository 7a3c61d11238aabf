//! Distributions of an entry: `normal(mean, sd)`, `uniform(a, b)`, `latin(a, b)`, `grid(a, b, n)`.

use super::draws::Draws;
use super::permutation::Permutation;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::syntax::suggest::closest;
use hamel_engine::option_text::Piece;

/// Largest number of points of one grid.
const MAX_GRID_POINTS: f64 = 1e9;

/// The names with their arguments, for messages.
const DISTRIBUTIONS: [(&str, &[&str]); 4] = [
    ("normal", &["mean", "sd"]),
    ("uniform", &["a", "b"]),
    ("latin", &["a", "b"]),
    ("grid", &["a", "b", "n"]),
];

/// The distribution of a number.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Mean and standard deviation.
    Normal(f64, f64),
    /// Uniform between two numbers.
    Uniform(f64, f64),
    /// Latin hypercube: uniform, with exactly one member in each of as many equal parts as there are members.
    Latin(f64, f64),
    /// This many equidistant numbers from the first to the last.
    Grid(f64, f64, u64),
}

impl Distribution {
    /// Reads the distributions of the entries of a target; `numbers` evaluates an argument.
    pub fn read(
        piece: Piece,
        entries: usize,
        numbers: &dyn Fn(Piece) -> Result<Vec<f64>, Diagnostic>,
    ) -> Result<Vec<Self>, Vec<Diagnostic>> {
        let Some((name, inner)) = piece.call() else {
            return Err(vec![
                piece
                    .wrong("expected a distribution")
                    .help(known_distributions()),
            ]);
        };
        let Some((_, names)) = DISTRIBUTIONS.iter().find(|(known, _)| *known == name.text) else {
            let close = closest(name.text, DISTRIBUTIONS.iter().map(|(known, _)| *known));
            let help = close.map_or_else(known_distributions, |close| {
                format!("did you mean `{close}`?")
            });
            let message = format!("no distribution is called `{}`", name.text);
            return Err(vec![name.wrong(message).help(help)]);
        };
        let given = inner.split(',');
        if given.len() != names.len() {
            let message = format!(
                "`{}` takes {}: {}({})",
                name.text,
                count(names.len(), "argument"),
                name.text,
                names.join(", ")
            );
            return Err(vec![piece.wrong(message)]);
        }
        let mut errors = Vec::new();
        let mut arguments: Vec<Vec<f64>> = Vec::new();
        for piece in &given {
            match argument(*piece, entries, numbers) {
                Ok(values) => arguments.push(values),
                Err(error) => errors.push(error),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let last = given[given.len() - 1];
        let mut all = Vec::new();
        for entry in 0..entries {
            let (a, b) = (arguments[0][entry], arguments[1][entry]);
            all.push(match name.text {
                "normal" if b < 0.0 => {
                    return Err(vec![last.wrong("a standard deviation cannot be negative")]);
                }
                "normal" => Distribution::Normal(a, b),
                _ if a > b => {
                    let message = format!("write the lower end first: {a} is above {b}");
                    return Err(vec![given[1].wrong(message)]);
                }
                "uniform" => Distribution::Uniform(a, b),
                "latin" => Distribution::Latin(a, b),
                _ => {
                    let n = arguments[2][entry];
                    if n.fract() != 0.0 || !(1.0..=MAX_GRID_POINTS).contains(&n) {
                        let message = format!("a whole number from 1 to 1e9 is needed, not {n}");
                        return Err(vec![last.wrong(message)]);
                    }
                    Distribution::Grid(a, b, n as u64)
                }
            });
        }
        Ok(all)
    }

    /// Returns the value for a member, at its point of the grid, and with the permutation of its strata.
    pub fn value(
        &self,
        draws: &Draws,
        member: u64,
        entry: usize,
        point: u64,
        strata: Option<(&Permutation, u64)>,
    ) -> f64 {
        // Interpolate as a sum: the difference b − a may overflow.
        let between = |a: f64, b: f64, part: f64| a * (1.0 - part) + b * part;
        match (self, strata) {
            (Distribution::Normal(mean, sd), _) => mean + sd * draws.normal(member, entry),
            (Distribution::Latin(a, b), Some((permutation, members))) => {
                let stratum = permutation.at(member) as f64;
                let part = (stratum + draws.uniform(member, entry)) / members as f64;
                between(*a, *b, part)
            }
            (Distribution::Uniform(a, b) | Distribution::Latin(a, b), _) => {
                between(*a, *b, draws.uniform(member, entry))
            }
            (Distribution::Grid(a, _, 1), _) => *a,
            (Distribution::Grid(_, b, n), _) if point + 1 == *n => *b,
            (Distribution::Grid(a, b, n), _) => between(*a, *b, point as f64 / (*n - 1) as f64),
        }
    }
}

/// Reads an argument: one number for each entry.
fn argument(
    piece: Piece,
    entries: usize,
    numbers: &dyn Fn(Piece) -> Result<Vec<f64>, Diagnostic>,
) -> Result<Vec<f64>, Diagnostic> {
    if piece.text.is_empty() {
        return Err(piece.wrong("an argument is missing"));
    }
    let values = match piece.text.parse::<f64>() {
        Ok(value) => vec![value],
        Err(_) => numbers(piece)?,
    };
    if !values.iter().all(|value| value.is_finite()) {
        return Err(piece.wrong("this is not a finite number"));
    }
    match values.len() {
        1 => Ok(vec![values[0]; entries]),
        found if found == entries => Ok(values),
        found => Err(piece.wrong(format!(
            "expected {}, or a single number for all; this is {}",
            match entries {
                1 => "one number".into(),
                _ => format!("{entries} numbers"),
            },
            count(found, "number")
        ))),
    }
}

fn known_distributions() -> String {
    let one = |(name, arguments): &(&str, &[&str])| format!("{name}({})", arguments.join(", "));
    let all: Vec<String> = DISTRIBUTIONS.iter().map(one).collect();
    format!("there are {}", all.join(", "))
}

/// Formats a count: `1 number`, `2 numbers`.
pub fn count(count: usize, word: &str) -> String {
    match count {
        1 => format!("1 {word}"),
        _ => format!("{count} {word}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::Distribution;
    use crate::sweep::draws::Draws;
    use hamel_codegen::diagnostics::Diagnostic;
    use hamel_engine::option_text::Piece;

    fn read(text: &str, entries: usize) -> Result<Vec<Distribution>, Vec<Diagnostic>> {
        let numbers = |piece: Piece| Err(piece.wrong(format!("{} is unknown", piece.text)));
        Distribution::read(Piece::of(text).expect("brackets"), entries, &numbers)
    }

    #[test]
    fn wrong_ones_are_refused() {
        for (text, said) in [
            ("normal(1, -1)", "cannot be negative"),
            ("uniform(2, 1)", "write the lower end first"),
            ("grid(0, 1, 2.5)", "a whole number"),
            ("grid(0, 1, 0)", "a whole number"),
            ("grid(0, 1)", "takes 3 arguments"),
            ("uniform(p, q)", "p is unknown; q is unknown"),
            ("uniform(1e999, 2)", "not a finite number"),
            ("uniform(, 2)", "missing"),
            ("uniforn(1, 2)", "no distribution"),
            ("3", "expected a distribution"),
        ] {
            let errors = read(text, 1).expect_err(text);
            let messages: Vec<&str> = errors.iter().map(|error| error.message.as_str()).collect();
            let messages = messages.join("; ");
            assert!(messages.contains(said), "{text}: {messages}");
        }
    }

    /// Mean and deviation of 20,000 draws are within five standard errors of the requested values.
    #[test]
    fn moments_are_those_asked_for() {
        let (draws, count) = (Draws::new(1), 20_000);
        for (text, mean, deviation) in [
            ("normal(1.3, 0.1)", 1.3, 0.1),
            ("uniform(-1, 3)", 1.0, 4.0 / 12_f64.sqrt()),
        ] {
            let one = &read(text, 1).expect(text)[0];
            let values = (0..count).map(|member| one.value(&draws, member, 3, 0, None));
            let values: Vec<f64> = values.collect();
            let found = values.iter().sum::<f64>() / count as f64;
            let squares = values.iter().map(|value| (value - found).powi(2));
            let spread = (squares.sum::<f64>() / count as f64).sqrt();
            let off = 5.0 * deviation / (count as f64).sqrt();
            assert!((found - mean).abs() < off, "{text}: {found}");
            assert!((spread - deviation).abs() < off, "{text}: {spread}");
        }
    }

    #[test]
    fn grids_reach_from_end_to_end() {
        let draws = Draws::new(1);
        let values = |text: &str, n: u64| -> Vec<f64> {
            let one = &read(text, 1).expect(text)[0];
            (0..n)
                .map(|point| one.value(&draws, 9, 0, point, None))
                .collect()
        };
        assert_eq!(values("grid(-0.1, 0.3, 5)", 5).first(), Some(&-0.1));
        assert_eq!(values("grid(-0.1, 0.3, 5)", 5).last(), Some(&0.3));
        assert_eq!(values("grid(0, 1, 3)", 3), [0.0, 0.5, 1.0]);
        assert_eq!(values("grid(2, 5, 1)", 1), [2.0]);
    }
}
