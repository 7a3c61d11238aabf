//! Splits functions that are affine in some variables: f = Σ fᵢ vᵢ + f₀.

use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::transplant::substitute;

/// A function split by variables. If the function is affine in them, neither the slopes nor the rest depend on them;
/// the caller checks that with [`classes`](Self::classes) and reports errors in its own words.
pub struct Affine {
    /// fᵢ = ∂f/∂vᵢ.
    pub slopes: Vec<Edge>,
    /// Linear part Σ fᵢ vᵢ.
    pub linear: Edge,
    /// Rest f − Σ fᵢ vᵢ.
    pub rest: Edge,
}

impl Affine {
    /// Splits a function by symbols of its graph.
    pub fn of(graph: &mut Graph, function: Edge, variables: &[Edge]) -> Affine {
        let mut one = Affine::of_each(graph, &[function], variables);
        one.remove(0)
    }

    /// Splits several functions, which share their derivatives.
    pub fn of_each(graph: &mut Graph, functions: &[Edge], variables: &[Edge]) -> Vec<Affine> {
        let mut slopes = vec![Vec::new(); functions.len()];
        for variable in variables {
            let mut derivation = Derivation::new([(variable.node(), graph.one())]);
            for (slopes, &function) in slopes.iter_mut().zip(functions) {
                slopes.push(derivation.of(graph, function));
            }
        }
        let mut all = Vec::new();
        for (slopes, &function) in slopes.into_iter().zip(functions) {
            let linear = graph.dot(&slopes, variables);
            let rest = rest(graph, function, linear, variables);
            all.push(Affine {
                slopes,
                linear,
                rest,
            });
        }
        all
    }

    /// Returns the classes of the symbols in the slopes and of those in the rest.
    pub fn classes(&self, graph: &Graph) -> (u8, u8) {
        let class = |edges: &[Edge]| (edges.iter()).fold(0, |all, e| all | graph.class(e.node()));
        (class(&self.slopes), class(&[self.rest]))
    }
}

/// Returns f − Σ fᵢ vᵢ, as f at v = 0 if that is equal. The difference itself may still contain the variables,
/// cancelling one another, as in q (v + c) − q v. Equal values share the node that was built first, so f at v = 0 has
/// to be built before the difference.
fn rest(graph: &mut Graph, function: Edge, linear: Edge, variables: &[Edge]) -> Edge {
    let symbols = graph.symbols().iter().enumerate();
    let variable = |node| variables.iter().any(|variable| variable.node() == node);
    let set: Vec<(usize, Edge)> = symbols
        .filter(|(_, symbol)| variable(symbol.node))
        .map(|(place, _)| (place, graph.zero()))
        .collect();
    let still = substitute(graph, &[function], &set)[0];
    match graph.add(linear, still) == function {
        true => still,
        false => graph.sub(function, linear),
    }
}
