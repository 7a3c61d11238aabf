//! Computations of ξ̇ compared: of each family of candidates the best is polished first.

use super::saddle::Projections;
use crate::care::Care;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::resubstitute::resubstitute;
use hamel_language::model::Model;
use hamel_language::syntax::ast::Axes;
use hamel_program::count::{Count, count};

/// The chosen computation of ξ̇.
#[derive(Clone, Debug)]
pub struct Acceleration {
    /// The graph that it lives in: the model's, with the route's nodes added.
    pub graph: Graph,
    /// ξ̇.
    pub xi_dot: Vec<Edge>,
    /// Pivots that have to be positive: one for each velocity in their order, then one for each constraint that the
    /// model keeps.
    pub pivots: Vec<Edge>,
    /// Whether the velocities that were eliminated are the twist of the one body, not the model's.
    pub twist: bool,
    /// Multipliers of the constraints that the model keeps.
    pub multipliers: Vec<Edge>,
    /// What leads back to these constraints, where there are some.
    pub projections: Option<Projections>,
    /// The digits that rounding takes of it, in steps, as far as they count.
    pub loss: usize,
    /// Its operations.
    pub count: Count,
    /// Its longest chain of operations after one another: of two equal counts the flatter is faster.
    pub depth: usize,
    /// What was chosen, for people.
    pub route: String,
    /// The cheapest candidate before polishing, where another one was cheaper after it.
    pub other: Option<Box<Acceleration>>,
}

impl Acceleration {
    /// A candidate, counted.
    pub(super) fn counted(
        graph: Graph,
        xi_dot: Vec<Edge>,
        pivots: Vec<Edge>,
        route: String,
    ) -> Self {
        let mut roots = xi_dot.clone();
        roots.extend(pivots.iter().filter(|pivot| !graph.is_free(pivot.node())));
        Acceleration {
            other: None,
            count: count(&graph, &roots),
            depth: graph.depth(&roots),
            graph,
            xi_dot,
            pivots,
            twist: false,
            multipliers: Vec::new(),
            projections: None,
            loss: 0,
            route,
        }
    }

    /// None, where no ξ̇ is wanted; in a graph of the model's symbols.
    pub fn none(graph: Graph) -> Self {
        Acceleration {
            graph,
            xi_dot: Vec::new(),
            pivots: Vec::new(),
            twist: false,
            multipliers: Vec::new(),
            projections: None,
            loss: 0,
            count: Count::default(),
            depth: 0,
            route: String::new(),
            other: None,
        }
    }

    /// Digits first, where they count, then operations, then depth.
    pub(super) fn cost(&self) -> (usize, usize, usize) {
        (self.loss, self.count.weight(), self.depth)
    }
}

/// Families are polished whose best keeps as many digits as the cheapest and takes at most this part of its
/// operations.
pub(crate) const NEAR: (usize, usize) = (4, 3);

/// Candidates that are alike: of each family the best is polished before they are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    /// Recursions over links.
    Links,
    /// Bodies traced in these axes, in the model's velocities or in the twist of its one body.
    Traced { twist: bool, axes: Axes },
    /// Expanded and factored anew.
    Polynomial,
}

/// The best candidates so far, one of each family.
pub(super) struct Best<'a> {
    care: &'a Care,
    families: Vec<(Family, Acceleration)>,
}

impl<'a> Best<'a> {
    pub(super) fn new(care: &'a Care) -> Self {
        Best {
            care,
            families: Vec::new(),
        }
    }

    /// Keeps a candidate that is better than what its family has.
    pub(super) fn keep(&mut self, family: Family, mut candidate: Acceleration) {
        candidate.loss = self
            .care
            .loss(&candidate.graph, &candidate.xi_dot, &candidate.pivots);
        match self.families.iter_mut().find(|(known, _)| *known == family) {
            Some((_, best)) if candidate.cost() < best.cost() => *best = candidate,
            Some(_) => {}
            None => self.families.push((family, candidate)),
        }
    }

    /// The weight of the cheapest.
    pub(super) fn least(&self) -> usize {
        let weights = self.families.iter().map(|(_, best)| best.count.weight());
        weights.min().unwrap_or(usize::MAX)
    }

    /// The best as it is.
    pub(super) fn cheapest(self) -> Option<Acceleration> {
        let all = self.families.into_iter().map(|(_, best)| best);
        all.min_by_key(Acceleration::cost)
    }

    /// The best after resubstitution.
    pub(super) fn polished(self, model: &Model) -> Option<Acceleration> {
        let care = self.care;
        let costs = self.families.iter().map(|(_, best)| best.cost());
        let (loss, weight, depth) = costs.min()?;
        // What is far behind before is behind afterwards; digits come before operations.
        let most = (loss, weight * NEAR.0 / NEAR.1, usize::MAX);
        let all = self.families.into_iter().map(|(_, best)| best);
        let near: Vec<Acceleration> = all.filter(|best| best.cost() <= most).collect();
        let mut places = near.iter().map(Acceleration::cost);
        let plain = places.position(|cost| cost == (loss, weight, depth))?;
        let all = near.into_iter().map(|best| polished(best, model, care));
        let mut all: Vec<Acceleration> = all.collect();
        let (first, _) = all.iter().enumerate().min_by_key(|(_, best)| best.cost())?;
        let other = (first != plain).then(|| Box::new(all[plain].clone()));
        let mut best = all.swap_remove(first);
        best.other = other;
        Some(best)
    }
}

/// The chosen computation after resubstitution.
fn polished(chosen: Acceleration, model: &Model, care: &Care) -> Acceleration {
    let roots: Vec<Edge> = chosen
        .xi_dot
        .iter()
        .chain(&chosen.pivots)
        .copied()
        .collect();
    let Some((graph, edges)) = resubstitute(&chosen.graph, &roots, &model.graph) else {
        return chosen;
    };
    let (xi_dot, pivots) = edges.split_at(chosen.xi_dot.len());
    let varying = edges
        .iter()
        .copied()
        .filter(|edge| !graph.is_free(edge.node()))
        .collect::<Vec<_>>();
    let polished = Acceleration {
        loss: care.loss(&graph, xi_dot, pivots),
        count: count(&graph, &varying),
        depth: graph.depth(&varying),
        route: chosen.route.clone(),
        other: None,
        xi_dot: xi_dot.to_vec(),
        pivots: pivots.to_vec(),
        twist: chosen.twist,
        multipliers: Vec::new(),
        projections: None,
        graph,
    };
    let cost = |a: &Acceleration| (a.loss, a.count.weight());
    if cost(&polished) < cost(&chosen) {
        polished
    } else {
        chosen
    }
}
