//! How candidates are compared: by cost, or first by the digits that rounding takes of them.
//!
//! A program is first put together by cost alone, then measured. Where it loses more than it should, it
//! is put together again with care: the description's own frames are candidates too, long expansions
//! are not, and of two candidates the one that keeps more digits is taken before the cheaper one.

use super::norms::{greatest, inverse, norm};
use super::tree::Placement;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::matrix;
use hamel_algebra::rounding::rounded;
use hamel_language::functions::Needs;
use hamel_language::model::Model;
use hamel_language::model::states::states;
use hamel_program::Program;
use hamel_program::rounding::{Measured, digits_lost};

/// Functions that lose so many digits say so.
pub const MANY: f64 = 6.0;
/// What keeps digits that all candidates lose.
pub const HELP: &str = "Frames near their bodies, and no differences of large terms, keep more.";
/// Digits that a function may lose before candidates are compared by them.
const ENOUGH: f64 = 2.5;
/// The same for candidates: what is lost below counts nothing.
const LITTLE: f64 = 1.5;
/// More than there are: what a candidate loses that has no value.
const ALL: f64 = 99.0;
/// Losses are compared in steps of so many digits.
const STEP: f64 = 0.5;

/// The states at which candidates are measured; none where cost alone decides.
#[derive(Clone, Debug, Default)]
pub struct Care {
    states: Vec<Vec<f64>>,
}

impl Care {
    /// Digits first, at states of a model.
    pub fn of(model: &Model) -> Self {
        Care {
            states: states(model),
        }
    }

    /// Whether digits come first.
    pub fn is_taken(&self) -> bool {
        !self.states.is_empty()
    }

    /// Where links of candidates have their frames.
    pub fn placements(&self) -> &'static [Placement] {
        match self.is_taken() {
            true => &[Placement::Chosen, Placement::Parallel, Placement::Described],
            false => &[Placement::Chosen, Placement::Parallel],
        }
    }

    /// The digits that rounding takes of a candidate, in steps; 0 where cost alone decides, and all of them where it has no
    /// value at any state.
    pub fn loss(&self, graph: &Graph, outputs: &[Edge], guards: &[Edge]) -> usize {
        if !self.is_taken() {
            return 0;
        }
        let measured = Measured { outputs, guards };
        let digits = match digits_lost(graph, &[measured], &self.states)[..] {
            [Some(digits)] => digits.min(ALL),
            _ => ALL,
        };
        ((digits - LITTLE).max(0.0) / STEP).ceil() as usize
    }
}

/// Functions that are 0 on X: their digits mean nothing there.
const ZERO: [&str; 3] = ["constraint", "correction", "project_position"];

/// The digits that rounding takes of every function of a program, by their order; `None` for what is 0.
pub fn losses(model: &Model, program: &Program) -> Vec<Option<f64>> {
    let functions: Vec<Measured> = program
        .functions
        .iter()
        .map(|function| Measured {
            outputs: match ZERO.contains(&function.name.as_str()) {
                true => &[],
                false => &function.outputs,
            },
            guards: &function.guards,
        })
        .collect();
    digits_lost(&program.graph, &functions, &states(model))
}

/// By how many digits the worst function of a program loses more than it should: what is solved with M
/// may lose as many more as the condition of M has. 0 where all is well.
pub fn excess(model: &Model, program: &Program, mass: &[Vec<Edge>], losses: &[Option<f64>]) -> f64 {
    let mut condition = None;
    let mut worst = 0.0_f64;
    for (function, digits) in program.functions.iter().zip(losses) {
        let mut beyond = digits.unwrap_or(0.0) - ENOUGH;
        if beyond > 0.0
            && function
                .id
                .is_some_and(|id| id.row().needs == Needs::Inverse)
        {
            beyond -= *condition.get_or_insert_with(|| condition_digits(model, program, mass));
        }
        worst = worst.max(beyond);
    }
    worst
}

/// Says in the documentation of functions that lose many digits that they do, and what helps.
pub fn note(program: &mut Program, losses: &[Option<f64>]) {
    for (function, digits) in program.functions.iter_mut().zip(losses) {
        if let Some(digits) = digits.filter(|&digits| digits >= MANY) {
            let digits = digits.min(16.0);
            function.docs.extend([
                String::new(),
                format!("Rounding takes about {digits:.0} of its 16 digits at the start or near it. {HELP}"),
            ]);
        }
    }
}

/// log₁₀ ‖M‖ ‖M⁻¹‖ (greatest sums of rows), the greatest at the states; infinite where it is not known.
fn condition_digits(model: &Model, program: &Program, mass: &[Vec<Edge>]) -> f64 {
    let mut most = 1.0_f64;
    for state in states(model) {
        let values = rounded(&program.graph, &mass.concat(), &state);
        let entries: Vec<f64> = values.iter().map(|entry| entry.exact.to_f64()).collect();
        let rows = matrix(&entries, mass.len());
        let of = [most, norm(&rows) * norm(&inverse(rows))];
        most = greatest(of.into_iter());
    }
    most.log10()
}
