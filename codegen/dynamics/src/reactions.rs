//! Functions of systems with constraints: the multipliers, and projections onto the constraints.

use super::accel::context::DerivationContext;
use super::accel::tree_recursions;
use super::candidates::Candidates;
use super::multipliers::{force_residuals, multipliers};
use super::program::ProgramBuilder;
use super::reduction::Reduction;
use super::undetermined::undetermined_multipliers;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::transplant::rebuild;
use hamel_language::functions::Needs;
use hamel_language::model::{Model, entry};
use hamel_program::FunctionId;

/// Largest number of characters shown of a constraint as it was written.
const MAX_SHOWN_CHARACTERS: usize = 72;

impl ProgramBuilder<'_> {
    /// Returns φ of the loops that are kept closed by multipliers.
    pub(super) fn loops(&mut self) -> Vec<Edge> {
        let zero = self.model.graph.zero();
        let constraints = self.model.constraints.iter();
        let residuals: Vec<Edge> = constraints
            .map(|constraint| constraint.residual)
            .filter(|&residual| residual != zero)
            .collect();
        rebuild(&self.model.graph, &mut self.graph, &residuals)
    }

    /// Adds λ of all non-redundant constraints, then the forces of drives with prescribed rates.
    ///
    /// If they are not unique, those of one solution are returned; the docs name them.
    pub(super) fn constraint_force(&mut self, full: &Model, reduction: &Reduction) {
        let constraints = || full.constraints.iter().filter(|row| !row.redundant);
        let rows = constraints().count() + full.accelerated.len();
        let unneeded = self.model.asked.needs() == Needs::Nothing;
        if rows == 0 || unneeded {
            return;
        }
        let solved = reduction.solved.iter().map(|&(_, velocity)| velocity);
        let driven = full.accelerated.iter().map(|&(velocity, _)| velocity);
        let velocities: Vec<usize> = solved.chain(driven).collect();
        // If the other velocities are prescribed, the recursion over links applies.
        let whole = self.model.full_frame.is_some() || full.constraints.is_empty();
        let mut traced: Vec<(Graph, Vec<Edge>)> = Vec::new();
        if whole {
            let given = DerivationContext::in_given_velocities(self.model);
            let recursions = tree_recursions(&given, &self.numerical_loss);
            traced.extend(recursions.iter().map(|of| of.residuals(&velocities)));
        }
        if traced.is_empty() {
            traced.push(force_residuals(full, reduction, &velocities));
        }
        let mut candidates = Candidates::new(&self.numerical_loss);
        let contexts = [self.shared.graph.clone(), self.graph.clone()];
        let contexts = contexts.into_iter().chain([self.chosen.graph.clone()]);
        let contexts = contexts.flat_map(|graph| traced.iter().map(move |of| (graph.clone(), of)));
        for (mut graph, (from, residuals)) in contexts {
            let residuals = (from, residuals.as_slice());
            let found = multipliers(full, reduction, &self.chosen, residuals, &mut graph);
            let Some(outputs) = found else {
                return;
            };
            let pivots = self.chosen.pivots.iter().copied();
            let pivots = pivots.filter(|pivot| !graph.is_free(pivot.node()));
            let roots = outputs.into_iter().chain(pivots).collect();
            candidates.offer_own(graph, roots);
        }
        let mut outputs = candidates.cheapest(&mut self.graph);
        outputs.truncate(rows);
        let guards = self.guards();
        self.push_guarded(FunctionId::ConstraintForce, outputs, guards);
        // Document which entry belongs to which constraint.
        let rows = constraints().map(|row| (row.written.clone(), row.entry.clone()));
        let drives = full.accelerated.iter();
        let drives = drives.map(|&(velocity, _)| {
            let name = entry(&full.velocities, velocity);
            (format!("rate({name})"), String::new())
        });
        let unique = undetermined_multipliers(full).into_iter().map(|free| !free);
        let all = rows.chain(drives).zip(unique.clone()).enumerate();
        let docs = all.map(|(row, ((text, entry), unique))| {
            let shown: String = text.chars().take(MAX_SHOWN_CHARACTERS).collect();
            let more = if shown.len() < text.len() { " …" } else { "" };
            let entry = match entry.as_str() {
                "" => String::new(),
                entry => format!(", entry `{entry}`"),
            };
            let free = if unique { "" } else { "; not determined" };
            format!("- {}: `{shown}{more}`{entry}{free}", row + 1)
        });
        if let Some(function) = self.functions.last_mut() {
            function.docs.push(String::new());
            function.docs.extend(docs);
            if unique.clone().any(|unique| !unique) {
                function.docs.push(String::new());
                let text = "Rows that depend on one another share a force that motion does not tell apart: only its sum Bᵀ λ is determined.";
                function.docs.push(text.into());
            }
        }
    }

    /// Adds the projections onto the constraints that are kept.
    pub(super) fn projections(&mut self) {
        let Some(projections) = self.chosen.projections.clone() else {
            return;
        };
        let guards = self.guards();
        let loops = !self.loops().is_empty();
        // Projections do not change states of first order.
        let states = rebuild(&self.model.graph, &mut self.graph, self.model.z());
        if loops {
            let mut outputs = projections.position;
            outputs.resize(outputs.len() + states.len(), self.graph.zero());
            self.push_guarded(FunctionId::ProjectPosition, outputs, guards.clone());
        }
        let outputs = [projections.velocity, states].concat();
        self.push_guarded(FunctionId::ProjectVelocity, outputs, guards);
    }
}
