//! `--vary`: the entries that differ from member to member, and the state of each member.

use super::distribution::{Distribution, count};
use super::draws::Draws;
use super::permutation::Permutation;
use super::target::{Part, Target};
use crate::failure::Failure;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::Generated;
use hamel_engine::State;
use hamel_engine::option_text::{Piece, invalid_option};
use hamel_engine::run::constant;
use serde_json::{Map, Value};

const OPTION: &str = "--vary";

/// A varied number.
#[derive(Clone, Debug)]
struct Entry {
    target: usize,
    place: usize,
    column: String,
    distribution: Distribution,
    strata: Option<Permutation>,
    /// Number of consecutive members with the same value of a grid.
    stride: u64,
}

/// The varied entries and their distributions.
#[derive(Clone, Debug)]
pub struct Variations {
    targets: Vec<Target>,
    entries: Vec<Entry>,
    draws: Draws,
    /// Number of members.
    members: u64,
}

/// Returns the parameter that an item varies.
fn parameter<'a>(item: Piece<'a>) -> Option<&'a str> {
    let (left, _) = item.text.split_once('=')?;
    let name = left.split('[').next()?.trim();
    (!name.is_empty() && !name.contains(char::is_whitespace)).then_some(name)
}

impl Variations {
    /// Reads the option; `members` is the requested number of members, if given.
    pub fn read(
        text: &str,
        generated: &Generated,
        state: &State,
        seed: u64,
        members: Option<u64>,
    ) -> Result<Self, Failure> {
        let wrong = |errors: Vec<Diagnostic>| Failure::from(invalid_option(OPTION, text, &errors));
        let whole = Piece::of(text).map_err(|error| wrong(vec![error]))?;
        let mut vary = Variations {
            targets: Vec::new(),
            entries: Vec::new(),
            draws: Draws::new(seed),
            members: 0,
        };
        let mut errors = Vec::new();
        let items = whole.split(';');
        let varied: Vec<&str> = items.iter().filter_map(|item| parameter(*item)).collect();
        for item in items {
            if !item.text.is_empty()
                && let Err(more) = vary.item(item, &varied, generated, state)
            {
                errors.extend(more);
            }
        }
        if !errors.is_empty() {
            return Err(wrong(errors));
        }
        if vary.entries.is_empty() {
            return Err(wrong(vec![whole.wrong(
                "nothing is varied; an item is written `NAME = DISTRIBUTION`",
            )]));
        }
        vary.count(whole, members)
            .map_err(|error| wrong(vec![error]))?;
        let members = vary.members;
        for (index, entry) in vary.entries.iter_mut().enumerate() {
            if let Distribution::Latin(..) = entry.distribution {
                entry.strata = Some(vary.draws.permutation(index, members));
            }
        }
        Ok(vary)
    }

    fn item(
        &mut self,
        item: Piece,
        varied: &[&str],
        generated: &Generated,
        state: &State,
    ) -> Result<(), Vec<Diagnostic>> {
        let sides = item.split('=');
        let [left, right] = sides.as_slice() else {
            return Err(vec![item.wrong("an item is written `NAME = DISTRIBUTION`").help(
                "as in `m = normal(1.3, 0.1)`, `start w = uniform([-1, -1, -1], [1, 1, 1])`, `input F = grid(0, 1, 5)`",
            )]);
        };
        let (part, name) = match left.text.split_once(char::is_whitespace) {
            Some(("start", name)) => (Part::Start, name.trim()),
            Some(("input", name)) => (Part::Input, name.trim()),
            _ => (Part::Parameter, left.text),
        };
        let (target, places) = Target::find(*left, part, name, &generated.active, state)
            .map_err(|error| vec![error])?;
        let known = self.targets.iter().position(|known| known.is(&target));
        let number = known.unwrap_or(self.targets.len());
        let taken = |entry: &Entry| entry.target == number && places.contains(&entry.place);
        if self.entries.iter().any(taken) {
            return Err(vec![left.wrong(format!("`{}` is varied twice", left.text))]);
        }
        let mut words = right
            .text
            .split(|c: char| !c.is_alphanumeric() && !matches!(c, '_' | '.'));
        let own = parameter(item);
        if let Some(word) = words.find(|word| varied.contains(word) && own != Some(*word)) {
            let message = format!("`{word}` is itself varied and has no value here");
            let help =
                "arguments are numbers, and expressions of parameters that other items do not vary";
            return Err(vec![right.wrong(message).help(help)]);
        }
        let numbers = |piece: Piece| {
            let numbers = constant(piece.text, generated, &state.params);
            numbers.map_err(|problem| piece.wrong(problem.to_string()))
        };
        let distributions = Distribution::read(*right, places.len(), &numbers)?;
        for (place, distribution) in places.into_iter().zip(distributions) {
            self.entries.push(Entry {
                target: number,
                place,
                column: format!("{}{}", part.word(), target.entries[place]),
                distribution,
                strata: None,
                stride: 1,
            });
        }
        if known.is_none() {
            self.targets.push(target);
        }
        Ok(())
    }

    /// Counts the members: the requested number, or the points of all grids.
    fn count(&mut self, whole: Piece, asked: Option<u64>) -> Result<(), Diagnostic> {
        let mut points: u64 = 1;
        let mut grids = false;
        // The last grid varies fastest.
        for entry in self.entries.iter_mut().rev() {
            if let Distribution::Grid(_, _, n) = entry.distribution {
                entry.stride = points;
                grids = true;
                points = points
                    .checked_mul(n)
                    .filter(|points| *points <= i64::MAX as u64)
                    .ok_or_else(|| whole.wrong("the grids have more points than can be counted"))?;
            }
        }
        self.members = match (asked, grids) {
            (Some(asked), true) if asked % points != 0 => {
                return Err(whole.wrong(format!(
                    "the grids have {}: --members has to be a multiple of that or omitted",
                    count(points as usize, "point")
                )));
            }
            (Some(asked), _) => asked,
            (None, true) => points,
            (None, false) => return Err(whole.wrong("without a grid, --members is required")),
        };
        Ok(())
    }

    /// Returns the number of members.
    pub fn members(&self) -> u64 {
        self.members
    }

    /// Returns the names of the varied numbers, as in the option.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.column.as_str())
    }

    /// Indices in u of the varied inputs, with their names.
    pub fn inputs(&self, generated: &Generated) -> Vec<(usize, &str)> {
        let place = |entry: &Entry| {
            let target = &self.targets[entry.target];
            let mut groups = generated.active.inputs.iter();
            let group = groups.find(|group| target.part == "input" && group.name == target.name)?;
            Some(group.offset + entry.place)
        };
        let all = self.entries.iter();
        all.filter_map(|entry| Some((place(entry)?, entry.column.as_str())))
            .collect()
    }

    /// Returns the values for a member, in the order of the columns.
    pub fn values(&self, member: u64) -> Vec<f64> {
        let value = |(index, entry): (usize, &Entry)| {
            let point = match entry.distribution {
                Distribution::Grid(_, _, n) => member / entry.stride % n,
                _ => 0,
            };
            let strata = entry.strata.as_ref().map(|strata| (strata, self.members));
            entry
                .distribution
                .value(&self.draws, member, index, point, strata)
        };
        self.entries.iter().enumerate().map(value).collect()
    }

    /// Returns the state in JSON with these values, and otherwise the entries of `base`.
    pub fn state(&self, values: &[f64], base: &Map<String, Value>) -> Value {
        let mut numbers: Vec<Vec<f64>> = self.targets.iter().map(|t| t.base.clone()).collect();
        for (entry, value) in self.entries.iter().zip(values) {
            numbers[entry.target][entry.place] = *value;
        }
        let mut state = base.clone();
        for (target, numbers) in self.targets.iter().zip(&numbers) {
            target.set_values(&mut state, numbers);
        }
        state.into()
    }

    /// Returns the state with nothing varied.
    pub fn nominal_state(&self, base: &Map<String, Value>) -> Value {
        let values: Vec<f64> = self
            .entries
            .iter()
            .map(|entry| self.targets[entry.target].base[entry.place])
            .collect();
        self.state(&values, base)
    }
}
