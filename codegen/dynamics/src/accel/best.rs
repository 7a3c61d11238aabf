//! Comparison of candidates for ξ̇; the best of each family is polished before the final comparison.

use super::kkt::Projections;
use crate::numerical_loss::NumericalLoss;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::resubstitute::resubstitute;
use hamel_language::model::Model;
use hamel_language::syntax::ast::Axes;
use hamel_program::count::{Count, count};

/// Computation of ξ̇ that is compared with others: its expressions in a graph of its own, their pivots and their cost.
#[derive(Clone, Debug)]
pub struct AccelerationCandidate {
    /// Graph of the expressions: the model's graph with the nodes of the route added.
    pub graph: Graph,
    /// Accelerations ξ̇.
    pub xi_dot: Vec<Edge>,
    /// Pivots that must be positive: one for each velocity in their order, then one for each constraint that the
    /// model keeps.
    pub pivots: Vec<Edge>,
    /// Whether the eliminated velocities, to which the pivots belong, are the twist of the only body instead of the
    /// model's velocities.
    pub twist: bool,
    /// Multipliers of the constraints that the model keeps.
    pub multipliers: Vec<Edge>,
    /// Projections onto these constraints, if there are any.
    pub projections: Option<Projections>,
    /// Digits lost to rounding, in steps, as far as they count.
    pub loss: usize,
    /// Number of operations.
    pub count: Count,
    /// Length of the longest chain of dependent operations; of two equal counts, the shallower computation is
    /// faster.
    pub depth: usize,
    /// Description of the chosen route, for people to read.
    pub route: String,
    /// Candidate that was cheapest before polishing, if another one was cheaper afterwards.
    pub other: Option<Box<AccelerationCandidate>>,
}

impl AccelerationCandidate {
    /// Creates a candidate and counts its operations.
    pub(super) fn with_counts(
        graph: Graph,
        xi_dot: Vec<Edge>,
        pivots: Vec<Edge>,
        route: String,
    ) -> Self {
        let mut roots = xi_dot.clone();
        roots.extend(pivots.iter().filter(|pivot| !graph.is_free(pivot.node())));
        AccelerationCandidate {
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

    /// Returns an empty computation, for models whose ξ̇ is not needed, in a graph of the model's symbols.
    pub fn none(graph: Graph) -> Self {
        AccelerationCandidate {
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

    /// Returns the key by which candidates are compared: loss of digits (if it counts), then operations, then
    /// depth.
    pub(super) fn cost(&self) -> (usize, usize, usize) {
        (self.loss, self.count.weight(), self.depth)
    }
}

/// Largest ratio of operations to the cheapest family's at which a family that loses no more digits is still
/// polished.
pub(crate) const MAX_POLISHED_COST_RATIO: (usize, usize) = (4, 3);

/// Families of similar candidates; the best of each is polished before they are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CandidateFamily {
    /// Recursions over links.
    Links,
    /// Bodies traced in these axes, in the model's velocities or in the twist of its only body.
    Traced { twist: bool, axes: Axes },
    /// Right-hand side expanded and factored again.
    Polynomial,
}

/// Best candidates so far, one for each family.
pub(super) struct BestCandidates<'a> {
    numerical_loss: &'a NumericalLoss,
    families: Vec<(CandidateFamily, AccelerationCandidate)>,
}

impl<'a> BestCandidates<'a> {
    pub(super) fn new(numerical_loss: &'a NumericalLoss) -> Self {
        BestCandidates {
            numerical_loss,
            families: Vec::new(),
        }
    }

    /// Keeps a candidate if it is better than the best of its family.
    pub(super) fn keep(&mut self, family: CandidateFamily, mut candidate: AccelerationCandidate) {
        candidate.loss =
            self.numerical_loss
                .loss(&candidate.graph, &candidate.xi_dot, &candidate.pivots);
        match self.families.iter_mut().find(|(known, _)| *known == family) {
            Some((_, best)) if candidate.cost() < best.cost() => *best = candidate,
            Some(_) => {}
            None => self.families.push((family, candidate)),
        }
    }

    /// Returns the smallest operation count.
    pub(super) fn min_operations(&self) -> usize {
        let weights = self.families.iter().map(|(_, best)| best.count.weight());
        weights.min().unwrap_or(usize::MAX)
    }

    /// Returns the best candidate without polishing.
    pub(super) fn cheapest(self) -> Option<AccelerationCandidate> {
        let all = self.families.into_iter().map(|(_, best)| best);
        all.min_by_key(AccelerationCandidate::cost)
    }

    /// Returns the best candidate after resubstitution.
    pub(super) fn into_polished(self, model: &Model) -> Option<AccelerationCandidate> {
        let numerical_loss = self.numerical_loss;
        let costs = self.families.iter().map(|(_, best)| best.cost());
        let (loss, weight, depth) = costs.min()?;
        // A family that is far behind stays behind after polishing; digits take precedence over operations.
        let most = (
            loss,
            weight * MAX_POLISHED_COST_RATIO.0 / MAX_POLISHED_COST_RATIO.1,
            usize::MAX,
        );
        let all = self.families.into_iter().map(|(_, best)| best);
        let near: Vec<AccelerationCandidate> = all.filter(|best| best.cost() <= most).collect();
        let mut places = near.iter().map(AccelerationCandidate::cost);
        let plain = places.position(|cost| cost == (loss, weight, depth))?;
        let all = near
            .into_iter()
            .map(|best| polish(best, model, numerical_loss));
        let mut all: Vec<AccelerationCandidate> = all.collect();
        let (first, _) = all.iter().enumerate().min_by_key(|(_, best)| best.cost())?;
        let other = (first != plain).then(|| Box::new(all[plain].clone()));
        let mut best = all.swap_remove(first);
        best.other = other;
        Some(best)
    }
}

/// Returns a candidate after resubstitution, or unchanged if that does not make it cheaper.
fn polish(
    chosen: AccelerationCandidate,
    model: &Model,
    numerical_loss: &NumericalLoss,
) -> AccelerationCandidate {
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
    let polished = AccelerationCandidate {
        loss: numerical_loss.loss(&graph, xi_dot, pivots),
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
    let cost = |a: &AccelerationCandidate| (a.loss, a.count.weight());
    if cost(&polished) < cost(&chosen) {
        polished
    } else {
        chosen
    }
}
