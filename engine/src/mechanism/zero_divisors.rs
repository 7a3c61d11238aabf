//! Finds zero divisors in constraints that were solved by dividing by parameters.

use crate::names;
use crate::state::dependent_velocities::describe_constraint;
use hamel_codegen::algebra::graph::{Edge, Graph};
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::algebra::text::short;
use hamel_codegen::generate::Generated;

/// Largest length of a factor in a message.
const MAX_SHOWN_LENGTH: usize = 40;

/// Factors by which constraints were divided to solve them for velocities, unless they are plain numbers, each with the
/// message for the case that it is 0.
pub struct Divisors {
    graph: Graph,
    factors: Vec<(Edge, String)>,
}

impl Divisors {
    /// Collects the divisors of a description, whose text is for messages; `None` if there are none.
    pub fn of(generated: &Generated, text: &str) -> Option<Self> {
        let model = &generated.model;
        let names = names::velocities(model);
        let factor = |&(velocity, row): &(usize, usize)| {
            let constraint = model.constraints.get(row)?;
            let edge = *constraint.row.get(velocity)?;
            // Elimination never divides by the number 0.
            if model.graph.class(edge.node()) == 0 {
                return None;
            }
            let (row, name) = (describe_constraint(constraint, text), names.get(velocity)?);
            let factor = short(&model.graph, edge, MAX_SHOWN_LENGTH);
            let factor = factor.map_or(String::new(), |factor| format!(" `{factor}`"));
            let said = format!("{row}, gives `{name}` by others, but its factor{factor} is 0");
            Some((edge, said))
        };
        let factors: Vec<(Edge, String)> = generated.solved.iter().filter_map(factor).collect();
        (!factors.is_empty()).then(|| Divisors {
            graph: model.graph.clone(),
            factors,
        })
    }

    /// Returns the message of the first divisor that is 0 with these parameters, if any.
    pub fn message_if_zero(&self, params: &[f64]) -> Option<&str> {
        let mut numbers = vec![std::f64::consts::PI];
        numbers.extend_from_slice(params);
        numbers.resize(self.graph.symbols().len(), f64::NAN);
        let edges: Vec<Edge> = self.factors.iter().map(|(edge, _)| *edge).collect();
        let values = evaluate(&self.graph, &edges, &numbers);
        let mut all = values.iter().zip(&self.factors);
        let (_, (_, said)) = all.find(|(value, _)| **value == 0.0)?;
        Some(said)
    }
}
