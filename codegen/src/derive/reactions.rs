//! Functions of systems with constraints: the multipliers, and what leads back to where they hold.

use super::candidates::Candidates;
use super::multipliers::multipliers;
use super::program::Builder;
use super::reduction::Reduction;
use crate::algebra::graph::Edge;
use crate::algebra::transplant::rebuild;
use crate::model::Model;
use crate::program::FunctionId;

impl Builder<'_> {
    /// φ of the loops that multipliers keep.
    pub(super) fn loops(&mut self) -> Vec<Edge> {
        let zero = self.model.graph.zero();
        let constraints = self.model.constraints.iter();
        let residuals: Vec<Edge> = constraints
            .map(|constraint| constraint.residual)
            .filter(|&residual| residual != zero)
            .collect();
        rebuild(&self.model.graph, &mut self.graph, &residuals)
    }

    /// λ of all constraints; an overconstrained mechanism has no unique ones.
    pub(super) fn constraint_force(&mut self, full: &Model, reduction: &Reduction) {
        if self.model.overconstrained {
            return;
        }
        let mut candidates = Candidates::with(&self.care);
        let contexts = [self.shared.graph.clone(), self.graph.clone()];
        for mut graph in contexts.into_iter().chain([self.chosen.graph.clone()]) {
            let Some(outputs) = multipliers(full, reduction, &self.chosen, &mut graph) else {
                return;
            };
            let pivots = self.chosen.pivots.iter().copied();
            let pivots = pivots.filter(|pivot| !graph.is_free(pivot.node()));
            let roots = outputs.into_iter().chain(pivots).collect();
            candidates.offer_own(graph, roots);
        }
        let mut outputs = candidates.cheapest(&mut self.graph);
        outputs.truncate(full.constraints.len());
        let guards = self.guards();
        self.push_guarded(FunctionId::ConstraintForce, outputs, guards);
    }

    /// What leads back to the constraints that are kept.
    pub(super) fn projections(&mut self) {
        let Some(projections) = self.chosen.projections.clone() else {
            return;
        };
        let guards = self.guards();
        let loops = !self.loops().is_empty();
        if loops {
            let outputs = projections.position;
            self.push_guarded(FunctionId::ProjectPosition, outputs, guards.clone());
        }
        self.push_guarded(FunctionId::ProjectVelocity, projections.velocity, guards);
    }
}
