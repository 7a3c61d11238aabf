//! Functions of systems with constraints: the multipliers, and what leads back to where they hold.

use super::assemble::Builder;
use super::candidates::Candidates;
use super::multipliers::multipliers;
use super::reduction::Reduction;
use crate::algebra::graph::Edge;
use crate::algebra::transplant::rebuild;
use crate::model::Model;
use crate::program::{Argument, Function, Shape};
use Argument::{Coordinates, Inputs, Velocities};

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
        self.functions.push(Function {
            name: "constraint_force".into(),
            docs: vec![
                "Multipliers λ of the constraints B(x) ξ = 0, M ξ̇ + Γ ξ ξ + ∂V = f + Bᵀ λ, in their order: the".into(),
                "generalised force that keeps an inactive velocity at zero, a force where B ξ is a speed.".into(),
            ],
            arguments: vec![Coordinates, Velocities, Inputs],
            shape: Shape::Vector(outputs.len()),
            outputs,
            guards,
            fallible: true,
        });
    }

    /// What leads back to the constraints that are kept.
    pub(super) fn projections(&mut self) {
        let Some(projections) = self.chosen.projections.clone() else {
            return;
        };
        let guards = self.guards();
        let n = self.model.n();
        let table: [(&str, &str, &[Argument], Vec<Edge>); 2] = [
            (
                "close",
                "The step along A that closes the loops φ(x) = 0 to first order, −M⁻¹ Bᵀ S⁻¹ φ with S = B M⁻¹ Bᵀ.",
                &[Coordinates],
                projections.close,
            ),
            (
                "settle",
                "The velocities with B ξ = 0 that are nearest in kinetic energy, ξ − M⁻¹ Bᵀ S⁻¹ B ξ.",
                &[Coordinates, Velocities],
                projections.settle,
            ),
        ];
        let loops = !self.loops().is_empty();
        for (name, docs, arguments, outputs) in table {
            if name == "close" && !loops {
                continue;
            }
            self.functions.push(Function {
                name: name.into(),
                docs: vec![docs.into()],
                arguments: arguments.to_vec(),
                shape: Shape::Vector(n),
                outputs,
                guards: guards.clone(),
                fallible: true,
            });
        }
    }
}
