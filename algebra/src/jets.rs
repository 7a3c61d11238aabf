//! Values with first and mixed second derivatives modulo p, by hyper-dual numbers: f, its slope f₁ along
//! one direction, its slopes f₂ along many others, and all f₁₂, without a derivative ever being written
//! as an expression.
//!
//! With symbols x(s, t) that have ∂x/∂s = x₁, ∂x/∂t = x₂ and ∂²x/∂s∂t = x₁₂,
//! f₁₂ = D²f [x₁, x₂] + Df(x₁₂).

use super::dual::{Across, Duals};
use super::fp::Fp;
use super::lane::Lane;
use super::tangent::{Dual, duals};
use super::tape::Tape;

/// How symbols move: one entry for each symbol, 0 beyond the end.
#[derive(Clone, Debug, Default)]
pub struct Seeds {
    /// x₁.
    pub along: Vec<Fp>,
    /// x₂ of every column.
    pub across: Vec<Vec<Fp>>,
    /// x₁₂ of every column, 0 for columns beyond the end.
    pub mixed: Vec<Vec<Fp>>,
}

/// f, f₁, and f₂, f₁₂ for every column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Jet {
    /// f.
    pub value: Fp,
    /// f₁.
    pub along: Fp,
    /// f₂ of every column; empty where nothing of it moves.
    pub across: Vec<Fp>,
    /// f₁₂ of every column; empty where nothing of it moves.
    pub mixed: Vec<Fp>,
}

impl Jet {
    /// f₂ of a column.
    pub fn across(&self, column: usize) -> Fp {
        self.across.get(column).copied().unwrap_or(Fp::ZERO)
    }

    /// f₁₂ of a column.
    pub fn mixed(&self, column: usize) -> Fp {
        self.mixed.get(column).copied().unwrap_or(Fp::ZERO)
    }

    /// Whether nothing of it moves.
    pub fn is_still(&self) -> bool {
        self.across.is_empty() && self.along.is_zero()
    }
}

impl Tape {
    /// Jets of the expressions at a point; `None` where something has no value there.
    pub fn jets(&self, lane: &Lane, seeds: &Seeds) -> Option<Vec<Jet>> {
        // f + f₁ along s; the slopes of both along all t.
        let of_symbol = |index: usize| -> Vec<Dual> {
            let at = |row: Option<&Vec<Fp>>| row?.get(index).copied();
            let slope = |k: usize| {
                let (across, mixed) = (at(seeds.across.get(k)), at(seeds.mixed.get(k)));
                (across.unwrap_or(Fp::ZERO), mixed.unwrap_or(Fp::ZERO))
            };
            (0..seeds.across.len()).map(slope).collect()
        };
        let mut all = Duals {
            numbers: duals(lane, &seeds.along),
            slopes: Across(of_symbol),
        };
        let values = self.run(&mut all)?;
        let jet = |((value, along), columns): (Dual, Vec<Dual>)| {
            let (across, mixed) = columns.into_iter().unzip();
            Jet {
                value,
                along,
                across,
                mixed,
            }
        };
        let jets = values.into_iter().map(jet);
        (!all.numbers.numbers.is_stuck()).then(|| jets.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::Seeds;
    use crate::derivation::Derivation;
    use crate::fp::{Fp, Random};
    use crate::graph::{Edge, Graph};
    use crate::lane::Lane;
    use crate::numeric::evaluate_at;
    use crate::tape::Tape;
    use crate::tests::quotients;

    /// Symbols s, t, a(s, t) = s t + s, b(s, t) = s² − t of the chain rule, and functions of a and b.
    #[test]
    fn mixed_derivatives_are_those_of_the_symbolic_derivative() {
        let mut random = Random::new(5);
        let mut graph = Graph::new(1, 0);
        let [s, t, a, b] = ["s", "t", "a", "b"].map(|name| graph.symbol(name, 2, random.element()));
        let product = graph.mul(a, b);
        let mut roots = vec![graph.sub(product, b)];
        roots.extend(quotients(&mut graph, roots[0], a));
        roots.push(graph.atan2(roots[0], b));
        let seeded = |graph: &mut Graph, seeds: [(Edge, Edge); 3]| {
            let _ = &graph;
            Derivation::new(seeds.map(|(symbol, seed)| (symbol.node(), seed)))
        };
        // a₁ = t + 1, b₁ = 2 s; a₂ = s, b₂ = −1; a₁₂ = 1, b₁₂ = 0.
        let one = graph.one();
        let (more, twice) = (graph.add(t, one), graph.add(s, s));
        let mut by_s = seeded(&mut graph, [(s, one), (a, more), (b, twice)]);
        let mut by_t = seeded(&mut graph, [(t, one), (a, s), (b, -one)]);
        let along = by_s.all(&mut graph, &roots);
        let across = by_t.all(&mut graph, &roots);
        let mixed = by_t.all(&mut graph, &along);
        let tape = Tape::new(&graph, &roots).expect("numbers");
        let mut found = 0;
        for seed in 0..40 {
            let mut lane = Lane::new(seed);
            (0..4).for_each(|_| lane.push_symbol(random.element()));
            let (s, t) = (lane.symbol(0), lane.symbol(1));
            let (zero, one) = (Fp::ZERO, Fp::ONE);
            let seeds = Seeds {
                along: vec![one, zero, t + one, s + s],
                across: vec![vec![zero, one, s, -one], vec![]],
                mixed: vec![vec![zero, zero, one, zero]],
            };
            let Some(jets) = tape.jets(&lane, &seeds) else {
                continue;
            };
            let expect =
                |edges: &[Edge]| evaluate_at(&graph, edges, &mut lane.clone()).expect("a value");
            let tables = [
                expect(&roots),
                expect(&along),
                expect(&across),
                expect(&mixed),
            ];
            for (i, jet) in jets.iter().enumerate() {
                assert_eq!(
                    [jet.value, jet.along, jet.across[0], jet.mixed[0]],
                    [tables[0][i], tables[1][i], tables[2][i], tables[3][i]],
                    "expression {i}"
                );
                assert_eq!([jet.across[1], jet.mixed[1]], [zero, zero]);
            }
            assert_eq!(tape.values(&lane), Some(tables[0].clone()));
            found += 1;
        }
        assert!(found > 5);
    }
}
