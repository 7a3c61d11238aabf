//! Chooses the polynomial that is shown for an expression: as it stands, or in normal form modulo φ.

use super::circles::{pairs, shorten};
use hamel_algebra::graph::{Edge, Graph, Node, NodeId};
use hamel_algebra::poly::monomial::Var;
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::topoly::{Expander, OPAQUE};
use hamel_dynamics::normal::NormalForms;
use hamel_language::model::class;
use hamel_language::model::layout::Block;
use hamel_language::model::points::Points;
use num_rational::BigRational;
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of terms of a polynomial that is shown.
pub const MAX_SHOWN_TERMS: usize = 60;

/// Largest number of terms of an intermediate polynomial when an expression is expanded as it stands.
const MAX_EXPANDED_TERMS: usize = 100;

/// Number of expressions without a short polynomial after which intermediate polynomials are limited to the length of
/// those that are shown. For a long chain no entry has a short polynomial, and finding that out is slow for each.
const MAX_LONG_EXPRESSIONS: usize = 100;

/// Largest number of terms of a polynomial inside an expression that is not itself a polynomial.
const MAX_INNER_TERMS: usize = 8;

/// Simplification of the expressions of one graph.
pub struct Simplifier {
    expander: Expander,
    forms: Option<NormalForms>,
    /// Number of expressions that had no short polynomial.
    failures: usize,
    /// Symbol of x₁.
    first: NodeId,
    /// Block index of every coordinate.
    blocks: Vec<usize>,
    kinds: Vec<Block>,
    inside: BTreeMap<Var, BTreeSet<usize>>,
}

impl Simplifier {
    /// Creates a simplifier that works modulo φ.
    pub fn modulo(points: &Points) -> Self {
        let forms = Some(NormalForms::new(points));
        Simplifier {
            forms,
            ..Simplifier::free(points)
        }
    }

    /// Creates a simplifier that only expands: for φ itself, and for functions as they are generated.
    pub fn free(points: &Points) -> Self {
        let numbered = points.blocks.iter().enumerate();
        Simplifier {
            expander: Expander::default().with_term_limit(MAX_EXPANDED_TERMS),
            forms: None,
            failures: 0,
            first: points.first as NodeId,
            blocks: numbered
                .flat_map(|(i, block)| vec![i; block.len()])
                .collect(),
            kinds: points.blocks.clone(),
            inside: BTreeMap::new(),
        }
    }

    /// Returns the polynomial to show: the candidate with the fewest blocks of coordinates, then the
    /// fewest coordinates, then the fewest terms; `None` if that is too long.
    pub fn whole(&mut self, graph: &Graph, node: NodeId) -> Option<Poly<BigRational>> {
        let shortest = self.shortest(graph, node);
        if shortest.is_none() {
            self.failures += 1;
            if self.failures == MAX_LONG_EXPRESSIONS
                && let Some(forms) = &mut self.forms
            {
                forms.limit_terms(MAX_SHOWN_TERMS);
            }
        }
        shortest
    }

    fn shortest(&mut self, graph: &Graph, node: NodeId) -> Option<Poly<BigRational>> {
        let plain = self.expander.expand(graph, Edge::of(node));
        let mut candidates: Vec<Poly<BigRational>> = plain.into_iter().collect();
        if graph.class(node) & class::CONFIGURATION != 0
            && let Some(forms) = &mut self.forms
        {
            candidates.extend(forms.normal_form(graph, Edge::of(node)));
            let shorter: Vec<Poly<BigRational>> = candidates
                .iter()
                .map(|candidate| {
                    let pairs = pairs(graph, self.first, &self.kinds, candidate);
                    shorten(candidate.clone(), &pairs)
                })
                .collect();
            // The first candidate also stays as it is: in a tie it wins over those with squares on circles replaced.
            candidates.truncate(1);
            candidates.extend(shorter);
        }
        let costs: Vec<_> = candidates
            .iter()
            .map(|candidate| self.cost(graph, candidate))
            .collect();
        let least = (0..candidates.len()).min_by_key(|&candidate| costs[candidate])?;
        let best = candidates.swap_remove(least);
        // Products that contain quotients are shorter when they are not multiplied out.
        let quotient = |var: Var| {
            let id = var.checked_sub(OPAQUE);
            id.is_some_and(|id| matches!(graph.node(id), Node::Div(..)))
        };
        let most = match best.variables().into_iter().any(quotient) {
            true => MAX_INNER_TERMS,
            false => MAX_SHOWN_TERMS,
        };
        (best.terms().len() <= most).then_some(best)
    }

    /// Returns the polynomial of a part of a longer expression, if it is short.
    pub fn part(&mut self, graph: &Graph, node: NodeId) -> Option<Poly<BigRational>> {
        let plain = self.expander.expand(graph, Edge::of(node))?;
        (plain.terms().len() <= MAX_INNER_TERMS).then_some(plain)
    }

    fn cost(&mut self, graph: &Graph, polynomial: &Poly<BigRational>) -> (usize, usize, usize) {
        let mut coordinates: BTreeSet<usize> = BTreeSet::new();
        for var in polynomial.variables() {
            coordinates.extend(self.coordinates(graph, var));
        }
        let blocks: BTreeSet<usize> = coordinates.iter().map(|&c| self.blocks[c]).collect();
        (blocks.len(), coordinates.len(), polynomial.terms().len())
    }

    /// Returns the coordinates on which a variable depends.
    fn coordinates(&mut self, graph: &Graph, var: Var) -> BTreeSet<usize> {
        let (first, count) = (self.first, self.blocks.len());
        let place = |symbol: u32| {
            let place = symbol.checked_sub(first)? as usize;
            (place < count).then_some(place)
        };
        let Some(id) = var.checked_sub(OPAQUE) else {
            return place(var).into_iter().collect();
        };
        let written = self.inside.entry(var).or_insert_with(|| {
            let nodes = graph.reachable(&[Edge::of(id)]).into_iter();
            let symbols = nodes.filter_map(|node| match graph.node(node) {
                Node::Symbol(index) => place(index),
                _ => None,
            });
            symbols.collect()
        });
        written.clone()
    }
}
