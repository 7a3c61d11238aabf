//! Comparison of candidates: by cost, or first by the digits that they lose to rounding.
//!
//! A program is first assembled by cost alone and then measured. If it loses more digits than it
//! should, it is assembled again with care: the description's own frames become candidates, too,
//! long expansions do not, and of two candidates the one that keeps more digits is preferred to the
//! cheaper one.

use super::norms::{greatest, inverse, norm};
use super::tree::Placement;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::matrix;
use hamel_algebra::rounding::evaluate_rounded;
use hamel_language::functions::Needs;
use hamel_language::model::Model;
use hamel_language::model::states::states;
use hamel_program::Program;
use hamel_program::rounding::{Measured, digits_lost};

/// Number of lost digits from which on the documentation of a function mentions them.
pub const MANY: f64 = 6.0;
/// Advice to users if all candidates lose digits.
pub const HELP: &str =
    "Frames close to their bodies and no differences of large terms lose fewer digits.";
/// Number of digits that a function may lose before candidates are compared by them.
const ENOUGH: f64 = 2.5;
/// Number of digits that a candidate may lose without being penalised.
const LITTLE: f64 = 1.5;
/// Loss of a candidate that has no value: more digits than there are.
const ALL: f64 = 99.0;
/// Step in digits by which losses are compared.
const STEP: f64 = 0.5;

/// States at which candidates are measured; empty if cost alone decides.
#[derive(Clone, Debug, Default)]
pub struct Care {
    states: Vec<Vec<f64>>,
}

impl Care {
    /// Compares by digits first, at states of a model.
    pub fn of(model: &Model) -> Self {
        Care {
            states: states(model),
        }
    }

    /// Returns whether digits come first.
    pub fn is_taken(&self) -> bool {
        !self.states.is_empty()
    }

    /// Returns the placements of link frames to try.
    pub fn placements(&self) -> &'static [Placement] {
        match self.is_taken() {
            true => &[Placement::Chosen, Placement::Parallel, Placement::Described],
            false => &[Placement::Chosen, Placement::Parallel],
        }
    }

    /// Returns the number of digits that a candidate loses to rounding, in steps.
    ///
    /// This is 0 if cost alone decides, and counts all digits if the candidate has no value at any
    /// state.
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

/// Functions that are 0 on X, where their digits mean nothing.
const ZERO: [&str; 3] = ["constraint", "correction", "project_position"];

/// Returns the number of digits that each function of a program loses to rounding, in order; `None`
/// for functions that are 0.
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

/// Returns by how many digits the worst function of a program exceeds its permitted loss, or 0.
///
/// Functions that solve with M may lose additional digits, as many as the condition number of M
/// has.
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

/// Adds a remark to the documentation of functions that lose many digits, with advice.
pub fn note(program: &mut Program, losses: &[Option<f64>]) {
    for (function, digits) in program.functions.iter_mut().zip(losses) {
        if let Some(digits) = digits.filter(|&digits| digits >= MANY) {
            let digits = digits.min(16.0);
            function.docs.extend([
                String::new(),
                format!("Rounding loses about {digits:.0} of its 16 digits at the start or near it. {HELP}"),
            ]);
        }
    }
}

/// Returns log₁₀ ‖M‖ ‖M⁻¹‖ (norm: largest row sum), the largest at the states; infinite if unknown.
fn condition_digits(model: &Model, program: &Program, mass: &[Vec<Edge>]) -> f64 {
    let mut most = 1.0_f64;
    for state in states(model) {
        let values = evaluate_rounded(&program.graph, &mass.concat(), &state);
        let entries: Vec<f64> = values.iter().map(|entry| entry.exact.to_f64()).collect();
        let rows = matrix(&entries, mass.len());
        let of = [most, norm(&rows) * norm(&inverse(rows))];
        most = greatest(of.into_iter());
    }
    most.log10()
}
