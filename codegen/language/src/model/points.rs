//! Random points of X over both prime fields: values of all symbols that satisfy φ = 0.

use super::class;
use super::layout::{Block, sample};
use crate::algebra::field_point::{FieldPoint, Roots};
use crate::algebra::graph::{Edge, Graph, Node};
use crate::algebra::newton::Newton;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::poly;
use crate::algebra::poly::monomial::Var;
use crate::algebra::poly::polynomial::Poly;
use crate::algebra::prime::Residue;
use crate::algebra::residue_pair::{Random, ResiduePair};
use crate::algebra::transplant::copy;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// Largest number of points tried until all square roots have values; each root halves the chance.
const TRIES: usize = 4000;
/// Number of tries after which roots of non-squares are allowed.
const STRICT_TRIES: usize = 300;
/// Largest number of independent roots for which all have to be roots of squares; with more, too many tries would be
/// needed.
const MOST_STRICT: usize = 6;
/// Number of constraint systems without a solution after which the search gives up.
const FAILURES: usize = 3;
/// Largest degree in the coordinates of a constraint that can be sampled.
pub const HIGHEST_DEGREE: u32 = 32;
/// Largest number of terms of a constraint.
const MOST_TERMS: usize = 2000;

/// Sampler of the manifold X of configurations: draws random points of X, with values of all symbols, modulo p.
#[derive(Clone, Debug)]
pub struct Points {
    /// Graph with unconstrained points, in which `constraints` live.
    pub free: Graph,
    /// Constraints that the user wrote, each to be 0.
    pub constraints: Vec<Edge>,
    /// Blocks of x.
    pub blocks: Vec<Block>,
    /// Index of the symbol of the first coordinate x₁.
    pub first: usize,
    /// Number of symbols that get values at a point.
    pub symbols: usize,
    /// Square roots, in `free`, that need values at every point.
    radicals: Vec<Edge>,
    /// Which roots have values: more than those of squares of F_p if points with such roots were too rare.
    pub roots: Roots,
}

impl Points {
    /// Creates the sampler of X from constraints that live in a graph with unconstrained points, and blocks of x, whose
    /// symbols begin at `first`.
    pub fn new(free: Graph, constraints: Vec<Edge>, blocks: Vec<Block>, first: usize) -> Self {
        let symbols = free.symbols().len();
        Points {
            free,
            constraints,
            blocks,
            first,
            symbols,
            radicals: Vec::new(),
            roots: Roots::default(),
        }
    }

    /// Returns φ(x) = 0 as a system for numerical solution.
    pub fn equations(&self, phi: &[(Edge, String)]) -> Newton {
        let rows: Vec<Edge> = phi.iter().map(|(row, _)| *row).collect();
        Newton::new(&self.free, &rows, self.first, self.dimension())
    }

    /// Returns the range of indices of the symbols of x.
    pub fn places(&self) -> Range<usize> {
        self.first..self.first + self.dimension()
    }

    /// Returns the number of entries of x.
    pub fn dimension(&self) -> usize {
        self.blocks.iter().map(|block| block.len()).sum()
    }

    /// Returns values of all symbols at a random point of X; `None` if no point was found.
    pub fn choose(&self, random: &mut Random) -> Option<Vec<ResiduePair>> {
        self.choose_where(
            random,
            TRIES,
            &[&(|_: &mut Vec<ResiduePair>| Some(())) as &Change<'_>; 2],
        )
    }

    /// Does the same, but changes values before and after the coordinates are solved for; either change may reject
    /// the point.
    fn choose_where(
        &self,
        random: &mut Random,
        tries: usize,
        [before, after]: &[&Change<'_>; 2],
    ) -> Option<Vec<ResiduePair>> {
        let mut failures = 0;
        // The values in the two fields are searched for separately: each root halves the chance in both.
        let mut found: [Option<Vec<ResiduePair>>; 2] = [None, None];
        for _ in 0..tries {
            let mut values = self.unconstrained(random);
            if before(&mut values).is_none() {
                continue;
            }
            if !self.constraints.is_empty() {
                // Functions of parameters in the constraints may lack a value here.
                let Some(system) = self.system(&values) else {
                    continue;
                };
                let Some(solution) = self.solve(&system, random) else {
                    failures += 1;
                    if failures == FAILURES {
                        return None;
                    }
                    continue;
                };
                for (var, value) in solution {
                    values[var as usize] = value;
                }
            }
            if after(&mut values).is_none() {
                continue;
            }
            let stuck = self.stuck(&values);
            for (place, stuck) in found.iter_mut().zip(stuck) {
                if !stuck && place.is_none() {
                    *place = Some(values.clone());
                }
            }
            if let [Some(one), Some(other)] = &found {
                return Some(
                    one.iter()
                        .zip(other)
                        .map(|(a, b)| ResiduePair(a.0, b.1))
                        .collect(),
                );
            }
        }
        None
    }

    /// Returns a random point of the blocks of x, with random values of all other symbols.
    fn unconstrained(&self, random: &mut Random) -> Vec<ResiduePair> {
        let mut values: Vec<ResiduePair> = (0..self.symbols).map(|_| random.element()).collect();
        // π is the first symbol, and the same everywhere.
        if let Some(first) = values.first_mut() {
            *first = ResiduePair::PI;
        }
        let mut place = self.first;
        for &block in &self.blocks {
            for value in sample(block, random) {
                values[place] = value;
                place += 1;
            }
        }
        values
    }

    /// Returns in which of the two fields a square root has no value.
    fn stuck(&self, values: &[ResiduePair]) -> [bool; 2] {
        if self.radicals.is_empty() {
            return [false; 2];
        }
        let mut lane = self.lane_of(values);
        match evaluate_at(&self.free, &self.radicals, &mut lane) {
            Some(_) => [false; 2],
            None if lane.has_missing_root() => lane.missing_roots(),
            None => [true; 2],
        }
    }

    /// Restricts the points chosen from now on to those at which the square roots of another graph have values.
    pub fn require_roots(&mut self, graph: &Graph) {
        let is_root = |&id: &u32| graph.node(id).is_root();
        let roots: Vec<Edge> = (0..graph.len() as u32)
            .filter(is_root)
            .map(Edge::of)
            .collect();
        let radicals = copy(graph, &mut self.free, &roots);
        // The same roots are stuck once more: to tell |e| from e, a graph takes another sign, which is no square.
        let again = !self.radicals.is_empty() && graph.has_missing_root();
        self.radicals = radicals;
        let (varying, fixed): (Vec<Edge>, Vec<Edge>) =
            (self.radicals.iter()).partition(|root| self.free.class(root.node()) != 0);
        let many = varying.len() > MOST_STRICT;
        let mut random = Random::new(0x5_71c7);
        for roots in [Roots::BaseField, Roots::ExtensionField] {
            let skipped = self.roots == Roots::Arbitrary
                || roots == Roots::ExtensionField && again && self.roots == Roots::ExtensionField
                || roots == Roots::BaseField
                    && (many || again || self.roots == Roots::ExtensionField);
            if skipped {
                continue;
            }
            self.roots = roots;
            let mut found = || {
                let anything = |_: &mut Vec<ResiduePair>| Some(());
                let anything = [&anything as &Change<'_>; 2];
                self.choose_where(&mut random, STRICT_TRIES, &anything)
                    .is_some()
            };
            if (fixed.is_empty() || self.keeps(&fixed)) && found() && found() {
                return;
            }
        }
        self.roots = Roots::Arbitrary;
    }

    /// Returns whether the roots of constants have values. If log 9, say, is not a square, no choice of a point
    /// helps: its root lies outside of F_p, and x + √log 9 is not a square of F_p for any x.
    fn keeps(&self, fixed: &[Edge]) -> bool {
        let values = self.unconstrained(&mut Random::new(0));
        let mut lane = self.lane_of(&values);
        let inside =
            |value: &ResiduePair| value.0.is_in_prime_field() && value.1.is_in_prime_field();
        let found = evaluate_at(&self.free, fixed, &mut lane);
        found.is_some_and(|found| self.roots != Roots::BaseField || found.iter().all(inside))
    }

    /// Returns the same manifold with roots in F_p(i), where every number of F_p is a square; `None` if it has these
    /// already.
    pub fn extended(&self) -> Option<Self> {
        (self.roots == Roots::BaseField).then(|| Points {
            roots: Roots::ExtensionField,
            ..self.clone()
        })
    }

    /// Returns the same manifold without the requirement that roots have values.
    pub(crate) fn without_roots(&self) -> Self {
        Points {
            radicals: Vec::new(),
            ..self.clone()
        }
    }

    /// Returns the user's constraints as polynomials in the coordinates.
    fn system(&self, values: &[ResiduePair]) -> Option<Vec<Poly<ResiduePair>>> {
        let constraints = self.constraints.iter();
        constraints
            .map(|&constraint| self.polynomial(constraint, values))
            .collect()
    }

    /// Finds coordinates that satisfy the user's constraints, in both fields.
    fn solve(
        &self,
        generators: &[Poly<ResiduePair>],
        random: &mut Random,
    ) -> Option<Vec<(Var, ResiduePair)>> {
        let one = self.solve_in(part(generators, |c| c.0), random)?;
        let other = self.solve_in(part(generators, |c| c.1), random)?;
        let pairs = one.into_iter().zip(other);
        Some(
            pairs
                .map(|((var, a), (_, b))| (var, ResiduePair(a, b)))
                .collect(),
        )
    }

    /// Finds such coordinates in one field, by elimination.
    fn solve_in<const K: usize>(
        &self,
        mut generators: Vec<Poly<Residue<K>>>,
        random: &mut Random,
    ) -> Option<Vec<(Var, Residue<K>)>> {
        let mut variables: Vec<Var> = generators.iter().flat_map(|g| g.variables()).collect();
        variables.sort_unstable();
        variables.dedup();
        // A constrained block that takes part adds its own φ.
        let mut place = self.first as Var;
        for &block in &self.blocks {
            let range: Vec<Var> = (place..place + block.len() as Var).collect();
            place += block.len() as Var;
            if range.iter().any(|var| variables.contains(var)) {
                generators.extend(match block {
                    Block::Flat(_) => Vec::new(),
                    Block::Circle => poly::ideals::circle(range[0], range[1]),
                    Block::Quaternion => {
                        poly::ideals::quaternion([range[0], range[1], range[2], range[3]])
                    }
                    Block::Rotation => poly::ideals::rotation(std::array::from_fn(|i| range[i])),
                });
                if !matches!(block, Block::Flat(_)) {
                    variables.extend(&range);
                }
            }
        }
        variables.sort_unstable();
        variables.dedup();
        poly::solve::point(&generators, &variables, random)
    }

    /// Returns a constraint as a polynomial in the coordinates, all other symbols having values; subexpressions
    /// without coordinates are evaluated, including functions of parameters.
    fn polynomial(&self, edge: Edge, values: &[ResiduePair]) -> Option<Poly<ResiduePair>> {
        let graph = &self.free;
        let nodes = graph.reachable(&[edge]);
        let moves = |id: u32| graph.class(id) & class::COORD != 0;
        let fixed: Vec<Edge> = nodes
            .iter()
            .filter(|&&id| !moves(id))
            .map(|&id| Edge::of(id))
            .collect();
        let numbers = evaluate_at(graph, &fixed, &mut self.lane_of(values))?;
        let constants = fixed
            .iter()
            .zip(numbers)
            .map(|(edge, n)| (edge.node(), Poly::constant(n)));
        let mut memo: FxHashMap<u32, Poly<ResiduePair>> = constants.collect();
        for id in nodes.into_iter().filter(|&id| moves(id)) {
            let read = |edge: Edge| {
                let polynomial = memo.get(&edge.node())?;
                Some(if edge.is_negative() {
                    polynomial.neg()
                } else {
                    polynomial.clone()
                })
            };
            let polynomial = match graph.node(id) {
                Node::Symbol(index) => Poly::var(index),
                Node::Add(a, b) => read(a)?.add(&read(b)?),
                Node::Mul(a, b) => read(a)?.mul_limited(&read(b)?, MOST_TERMS)?,
                Node::Div(a, b) => read(a)?.scale(&read(b)?.as_constant()?.inv()?),
                _ => return None,
            };
            memo.insert(id, polynomial);
        }
        let polynomial = memo.get(&edge.node())?;
        Some(if edge.is_negative() {
            polynomial.neg()
        } else {
            polynomial.clone()
        })
    }

    /// Returns a random point of X where some symbols have the values of expressions of `graph`; `None` if no point was
    /// found.
    pub fn lane_where(
        &self,
        seed: u64,
        graph: &Graph,
        set: &[(usize, Edge)],
    ) -> Option<FieldPoint> {
        self.lane_moved(seed, graph, set, &|_| Some(Vec::new()))
    }

    /// Returns a random point of X as [`lane_where`](Self::lane_where) does; once the coordinates are chosen, `moved`
    /// gives further symbols values that depend on them.
    pub fn lane_moved(
        &self,
        seed: u64,
        graph: &Graph,
        set: &[(usize, Edge)],
        moved: &dyn Fn(FieldPoint) -> Option<Moved>,
    ) -> Option<FieldPoint> {
        let move_in = |values: &mut Vec<ResiduePair>, moved: Moved| {
            for (symbol, value) in moved {
                *values.get_mut(symbol)? = value;
            }
            Some(())
        };
        let before = |values: &mut Vec<ResiduePair>| {
            let imposed = imposed(self.lane_of(values), graph, set)?;
            move_in(values, imposed)
        };
        let after = |values: &mut Vec<ResiduePair>| {
            let moved = moved(self.lane_of(values))?;
            move_in(values, moved)
        };
        let random = &mut Random::new(seed ^ 0x0b5e);
        let values = self.choose_where(random, TRIES, &[&before as &Change<'_>, &after])?;
        Some(self.lane_of(&values))
    }

    /// Returns a random point of X with values of all symbols, chosen by a seed; `None` if no point was found.
    pub fn lane(&self, seed: u64) -> Option<FieldPoint> {
        let values = self.choose(&mut Random::new(seed ^ 0x0b5e))?;
        Some(self.lane_of(&values))
    }

    fn lane_of(&self, values: &[ResiduePair]) -> FieldPoint {
        let mut lane = FieldPoint::new();
        // Values derived from others may lie outside F_p; then sums with them are not squares of F_p.
        let outside =
            |value: &ResiduePair| !(value.0.is_in_prime_field() && value.1.is_in_prime_field());
        lane.roots = match self.roots {
            Roots::BaseField if values.iter().any(outside) => Roots::ExtensionField,
            roots => roots,
        };
        for &value in values {
            lane.push_symbol(value);
        }
        lane
    }
}

/// A function that changes the values of symbols; `None` rejects them.
type Change<'a> = dyn Fn(&mut Vec<ResiduePair>) -> Option<()> + 'a;

/// Symbols, by index, with their new values.
pub type Moved = Vec<(usize, ResiduePair)>;

/// Evaluates expressions to the values of the symbols that they are assigned to.
pub fn imposed(mut lane: FieldPoint, graph: &Graph, set: &[(usize, Edge)]) -> Option<Moved> {
    let edges: Vec<Edge> = set.iter().map(|(_, edge)| *edge).collect();
    let values = evaluate_at(graph, &edges, &mut lane)?;
    let symbols = set.iter().map(|(symbol, _)| *symbol);
    Some(symbols.zip(values).collect())
}

/// Returns the polynomials with coefficients in one of the fields.
fn part<const K: usize>(
    polynomials: &[Poly<ResiduePair>],
    of: fn(ResiduePair) -> Residue<K>,
) -> Vec<Poly<Residue<K>>> {
    let one = |polynomial: &Poly<ResiduePair>| {
        let terms = polynomial.terms().iter().map(|(m, c)| (m.clone(), of(*c)));
        Poly::from_terms(polynomial.order(), terms.collect())
    };
    polynomials.iter().map(one).collect()
}
