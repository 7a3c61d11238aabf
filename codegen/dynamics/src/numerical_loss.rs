//! Numerical loss: the digits that a computation loses to rounding, and the choice between candidates by it.
//!
//! A program is first assembled by its number of operations alone and then measured. If it loses more digits than
//! it should, it is assembled again with losses compared first: the description's own frames become candidates,
//! too, long expansions do not, and of two candidates the one that keeps more digits is preferred to the cheaper
//! one.

use super::norms::{inverse_positive_definite, max_or_infinite, row_sum_norm};
use super::tree::Placement;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::matrix;
use hamel_algebra::rounding::evaluate_rounded;
use hamel_language::functions::Needs;
use hamel_language::model::Model;
use hamel_language::model::states::states;
use hamel_program::Program;
use hamel_program::rounding::{Measured, digits_lost};

/// Smallest number of lost digits that the documentation of an emitted function mentions.
pub const DOCUMENTED_LOSS: f64 = 6.0;
/// Advice to users whose functions lose digits by every candidate.
pub const LOSS_ADVICE: &str =
    "Frames close to their bodies and no differences of large terms lose fewer digits.";
/// Largest number of digits that a function may lose without a new choice of candidates by their losses.
const ACCEPTED_LOSS: f64 = 2.5;
/// Number of lost digits up to which candidates count as equally good.
const UNPENALISED_LOSS: f64 = 1.5;
/// Loss, in digits, of a candidate that has no value: more than any number has.
const LOSS_WITHOUT_VALUE: f64 = 99.0;
/// Unit, in digits, in which losses are compared.
const LOSS_STEP: f64 = 0.5;

/// Measure of the digits that candidates lose to rounding, at states of a model.
///
/// Without states, losses do not count, and the number of operations decides alone.
#[derive(Clone, Debug, Default)]
pub struct NumericalLoss {
    states: Vec<Vec<f64>>,
}

impl NumericalLoss {
    /// Measures losses at states of a model, and compares by them before operations.
    pub fn at_states_of(model: &Model) -> Self {
        NumericalLoss {
            states: states(model),
        }
    }

    /// Returns whether losses are compared before operations.
    pub fn is_compared_first(&self) -> bool {
        !self.states.is_empty()
    }

    /// Returns the placements of link frames to try.
    pub fn link_placements(&self) -> &'static [Placement] {
        match self.is_compared_first() {
            true => &[Placement::Chosen, Placement::Parallel, Placement::Described],
            false => &[Placement::Chosen, Placement::Parallel],
        }
    }

    /// Returns the number of digits that a candidate loses to rounding, in steps.
    ///
    /// This is 0 if cost alone decides, and counts all digits if the candidate has no value at any
    /// state.
    pub fn loss(&self, graph: &Graph, outputs: &[Edge], guards: &[Edge]) -> usize {
        if !self.is_compared_first() {
            return 0;
        }
        let measured = Measured { outputs, guards };
        let digits = match digits_lost(graph, &[measured], &self.states)[..] {
            [Some(digits)] => digits.min(LOSS_WITHOUT_VALUE),
            _ => LOSS_WITHOUT_VALUE,
        };
        ((digits - UNPENALISED_LOSS).max(0.0) / LOSS_STEP).ceil() as usize
    }
}

/// Names of functions that are 0 on X, where their digits mean nothing.
const FUNCTIONS_THAT_VANISH: [&str; 3] = ["constraint", "correction", "project_position"];

/// Returns the number of digits that each function of a program loses to rounding, in order; `None`
/// for functions that are 0.
pub fn losses(model: &Model, program: &Program) -> Vec<Option<f64>> {
    let functions: Vec<Measured> = program
        .functions
        .iter()
        .map(|function| Measured {
            outputs: match FUNCTIONS_THAT_VANISH.contains(&function.name.as_str()) {
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
pub fn excess_loss(
    model: &Model,
    program: &Program,
    mass: &[Vec<Edge>],
    losses: &[Option<f64>],
) -> f64 {
    let mut condition = None;
    let mut worst = 0.0_f64;
    for (function, digits) in program.functions.iter().zip(losses) {
        let mut beyond = digits.unwrap_or(0.0) - ACCEPTED_LOSS;
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

/// Adds a remark to the documentation of those functions of a program that lose many digits, with advice.
pub fn add_loss_remarks(program: &mut Program, losses: &[Option<f64>]) {
    for (function, digits) in program.functions.iter_mut().zip(losses) {
        if let Some(digits) = digits.filter(|&digits| digits >= DOCUMENTED_LOSS) {
            let digits = digits.min(16.0);
            function.docs.extend([
                String::new(),
                format!("Rounding loses about {digits:.0} of its 16 digits at the start or near it. {LOSS_ADVICE}"),
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
        let of = [
            most,
            row_sum_norm(&rows) * row_sum_norm(&inverse_positive_definite(rows)),
        ];
        most = max_or_infinite(of.into_iter());
    }
    most.log10()
}
