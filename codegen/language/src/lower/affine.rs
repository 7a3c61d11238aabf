//! Functions that are linear in some variables but for a term without them: f = Σ fᵢ vᵢ + f₀.

use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::transplant::substitute;

/// A function taken apart by variables. Where it is linear in them, neither the slopes nor the rest depend on them;
/// the caller looks at what they depend on, and says what is wrong in his own words.
pub struct Affine {
    /// fᵢ = ∂f/∂vᵢ.
    pub slopes: Vec<Edge>,
    /// Σ fᵢ vᵢ.
    pub linear: Edge,
    /// f − Σ fᵢ vᵢ.
    pub rest: Edge,
}

impl Affine {
    /// Of a function, by symbols of its graph.
    pub fn of(graph: &mut Graph, function: Edge, variables: &[Edge]) -> Affine {
        let mut one = Affine::of_each(graph, &[function], variables);
        one.remove(0)
    }

    /// Of several functions, which share their derivatives.
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

    /// The classes of symbols in the slopes and in the rest.
    pub fn classes(&self, graph: &Graph) -> (u8, u8) {
        let class = |edges: &[Edge]| (edges.iter()).fold(0, |all, e| all | graph.class(e.node()));
        (class(&self.slopes), class(&[self.rest]))
    }
}

/// f − Σ fᵢ vᵢ, which is f at v = 0 where f is linear. In the difference as it stands the variables may be left, each
/// against itself, as in q (v + c) − q v; and as equal values share one form in a graph, f at v = 0 has to be there
/// before it.
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
