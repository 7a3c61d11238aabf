//! Functions in addition to the equations of motion: momenta, the linearisation, invariants.

use super::accel::cheapest::MassAndForces;
use super::accel::context::DerivationContext;
use super::accel::recursive::TreeRecursion;
use super::accel::{AccelerationCandidate, tree_recursions};
use super::calculus::Calculus;
use super::candidates::Candidates;
use super::linearize::{
    Displacements, ForwardDynamics, Linearization, append_states, linearize, output_derivatives,
};
use super::program::{MAX_LITERAL_VELOCITIES, ProgramBuilder, shape_of};
use super::reduction::Reduction;
use super::regressor::Regressor;
use super::tree::Placement;
use super::{momentum, quantity};
use Argument::{Coordinates, Inputs, Velocities};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::transplant::graft;
use hamel_language::functions::SLOPES;
use hamel_language::model::invariants::Quantity;
use hamel_language::model::{Model, class};
use hamel_program::{Argument, Cause, Function, FunctionId, Shape};

impl ProgramBuilder<'_> {
    /// Adds ṗ as a function of (x, ξ, u), and ξ as a function of (x, p).
    pub(super) fn momentum(&mut self) {
        if !self.model.spans {
            return;
        }
        let given = DerivationContext::in_given_velocities(self.model);
        let recursions = tree_recursions(&given, &self.numerical_loss);
        if self.model.asked.wants(FunctionId::MomentumRate) {
            self.momentum_rate(&recursions);
        }
        if self.model.asked.wants(FunctionId::VelocityFromMomentum) {
            self.velocity_from_momentum(&recursions);
        }
    }

    fn momentum_rate(&mut self, recursions: &[TreeRecursion]) {
        let n = self.model.n();
        let mut candidates = Candidates::new(&self.numerical_loss);
        let traced = recursions.iter().filter_map(TreeRecursion::momentum_rate);
        let mut recursive = false;
        for (graph, rate) in traced {
            candidates.offer_own(graph, rate);
            recursive = true;
        }
        // For longer trees the recursion is certainly the cheapest.
        if !recursive || n <= momentum::MAX_EXPLICIT_VELOCITIES {
            let contexts = [
                (&self.shared.graph, &self.shared.parts),
                (&self.graph, &self.parts),
            ];
            for (graph, parts) in contexts {
                let mut graph = graph.clone();
                let rate = momentum::momentum_rate(self.model, &mut graph, parts);
                candidates.offer_own(graph, rate);
            }
        }
        let rate = candidates.cheapest(&mut self.graph);
        self.push(FunctionId::MomentumRate, rate);
    }

    fn velocity_from_momentum(&mut self, recursions: &[TreeRecursion]) {
        let n = self.model.n();
        let p = &self.model.momenta;
        let mut candidates = Candidates::new(&self.numerical_loss);
        let mut recursive = false;
        for (graph, solution) in recursions
            .iter()
            .filter_map(TreeRecursion::velocity_from_momentum)
        {
            candidates.offer_own(graph, [solution.xi_dot, solution.pivots].concat());
            recursive = true;
        }
        if !recursive || n <= momentum::MAX_EXPLICIT_VELOCITIES {
            let shared = &self.shared;
            let contexts = [(&self.graph, &self.parts), (&shared.graph, &shared.parts)];
            let found =
                contexts.map(|(graph, parts)| momentum::velocity_from_momentum(graph, parts, p));
            let cheapest = found.into_iter().flatten().min_by_key(|(cost, ..)| *cost);
            if let Some((_, graph, solution)) = cheapest {
                let roots = [solution.xi_dot, solution.pivots].concat();
                candidates.offer_both(graph, roots, &shared.graph);
            }
        }
        let mut xi = candidates.cheapest(&mut self.graph);
        if xi.len() < n {
            return;
        }
        let pivots = xi.split_off(n);
        let causes = (0..n).map(Cause::Velocity);
        self.causes.extend(pivots.iter().copied().zip(causes));
        let varying = |edge: &Edge| !self.graph.is_free(edge.node());
        let guards = pivots.into_iter().filter(varying).collect();
        let id = FunctionId::VelocityFromMomentum;
        self.push_guarded(id, xi, guards);
    }

    /// Adds the linearisation `[A B]`.
    ///
    /// It is derived from ξ̇ as it is computed, or as the cheapest candidate before polishing would
    /// compute it, whichever gives the cheaper derivatives.
    pub(super) fn linearize(&mut self, full: &Model, reduction: Option<&Reduction>) {
        let shared = &self.shared;
        let apart = |motion: &AccelerationCandidate| {
            let mut graph = motion.graph.clone();
            let parts = shared.parts.rebuild_in(&shared.graph, &mut graph);
            MassAndForces { graph, parts }
        };
        let chosen = &self.chosen;
        let mut motions = vec![(chosen, shared.clone())];
        if self.model.n() <= MAX_LITERAL_VELOCITIES {
            motions.push((chosen, apart(chosen)));
        }
        motions.extend(chosen.other.as_deref().map(|other| (other, apart(other))));
        let mut best: Option<((usize, usize), Linearization)> = None;
        for (motion, MassAndForces { mut graph, parts }) in motions {
            let Some(displacements) = Displacements::new(full, reduction, &mut graph) else {
                return;
            };
            let right = parts.right_hand_side(&mut graph);
            let varying = |edge: &Edge| !graph.is_free(edge.node());
            let causes = self.causes_of(motion).into_iter();
            let known = motion.pivots.iter().copied().zip(causes);
            let guards: Vec<(Edge, Cause)> = known.filter(|(pivot, _)| varying(pivot)).collect();
            let displacements = ForwardDynamics {
                graph: &graph,
                xi_dot: &motion.xi_dot,
                guards: &guards,
                displacements,
                // With multipliers or drives, M F is not the right-hand side.
                implicit: (self.model.constraints.is_empty() && self.model.accelerated.is_empty())
                    .then_some((&parts.mass, &right)),
            };
            let linear = linearize(self.model, &displacements, &self.numerical_loss);
            let cost = linear.cost();
            if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                best = Some((cost, linear));
            }
        }
        let Some((_, linear)) = best else {
            return;
        };
        let roots = graft(&linear.graph, &mut self.graph, &linear.roots());
        let (mut rows, guards, mut rates) = linear.separate_roots(roots);
        let columns = rows.first().map_or(1, Vec::len);
        self.causes.extend(guards.iter().copied());
        let guards = guards.into_iter().map(|(guard, _)| guard).collect();
        if !self.model.states.is_empty() {
            let Some(displacements) = Displacements::new(full, reduction, &mut self.graph) else {
                return;
            };
            let xi_dot = &self.chosen.xi_dot;
            rows = append_states(self.model, &displacements, (&mut self.graph, rows), xi_dot);
            if !rates.is_empty() {
                rates.extend(self.state_rates(&rates));
            }
        }
        self.push_guarded(FunctionId::Linearize, rows.concat(), guards);
        if let Some(linearize) = self.functions.last_mut() {
            linearize.shape = Shape::Matrix(rows.len(), columns);
            linearize.rates = rates;
            if !self.model.states.is_empty() {
                linearize.docs.push(
                    "With states the rows are those of (h, δξ, δz), the columns those of (h, δξ, δz, δu).".into(),
                );
            }
        }
        self.displacements(full, reduction);
        self.output_slopes(full, reduction, &rows);
    }

    /// Adds `[C D]` for the requested outputs: their derivatives by (h, δξ, δz, δu), where ξ̇
    /// follows the motion.
    fn output_slopes(&mut self, full: &Model, reduction: Option<&Reduction>, linear: &[Vec<Edge>]) {
        let model = self.model;
        for (name, value) in &model.outputs {
            if !model.asked.slopes.contains(name) {
                continue;
            }
            let entries = value.entries();
            let follows = depends_on_acceleration(model, &entries);
            // Outputs that depend on ξ̇ are built in the graph of its derivatives, all others on
            // their own.
            let mut graph = match follows {
                true => self.graph.clone(),
                false => model.graph.clone(),
            };
            let Some(displacements) = Displacements::new(full, reduction, &mut graph) else {
                return;
            };
            let changes: &[Vec<Edge>] = match follows {
                true => &linear[displacements.n()..displacements.n() + model.n()],
                false => &[],
            };
            let xi_dot: &[Edge] = if follows { &self.chosen.xi_dot } else { &[] };
            let rows = output_derivatives(
                model,
                &displacements,
                &mut graph,
                &entries,
                (changes, xi_dot),
            );
            let columns = rows.first().map_or(0, Vec::len);
            let shape = Shape::Matrix(rows.len(), columns);
            let mut candidates = Candidates::new(&self.numerical_loss);
            candidates.offer_own(graph, rows.concat());
            let outputs = candidates.cheapest(&mut self.graph);
            let guards = if follows { self.guards() } else { Vec::new() };
            let states = if model.states.is_empty() { "" } else { ", δz" };
            let docs = format!(
                "Slopes [C D] of the output `{name}`, δ{name} = C (h, δξ{states}) + D δu, by rows, where δx = A(x) h."
            );
            let mut function = Function::described(
                &format!("{name}{SLOPES}"),
                docs,
                &[Coordinates, Velocities, Inputs],
                shape,
                outputs,
            );
            if follows {
                let text = "It depends on ξ̇, which is that of `accel` and moves with the state.";
                function.docs.push(text.into());
            }
            self.functions.push(Function {
                guards,
                fallible: follows,
                ..function
            });
        }
    }

    /// Adds the matrices A and Y between displacements and changes of x.
    fn displacements(&mut self, full: &Model, reduction: Option<&Reduction>) {
        let Some(Displacements { a, y, .. }) = Displacements::new(full, reduction, &mut self.graph)
        else {
            return;
        };
        for (id, rows) in [
            (FunctionId::DisplacementFrame, a),
            (FunctionId::DisplacementCoframe, y),
        ] {
            self.push(id, rows.concat());
            if let Some(function) = self.functions.last_mut() {
                let columns = rows.first().map_or(0, Vec::len);
                function.shape = Shape::Matrix(rows.len(), columns);
            }
        }
    }

    /// Adds the regressor Y of the base parameters, and the values of β in the description.
    pub(super) fn regressor(&mut self, regressor: &Regressor) {
        let (from, n) = (&regressor.model.graph, regressor.model.n());
        let columns: Vec<&Vec<Edge>> = regressor.base.iter().map(|base| &base.column).collect();
        let rows = (0..n).flat_map(|row| columns.iter().map(move |column| column[row]));
        let outputs = graft(from, &mut self.graph, &rows.collect::<Vec<_>>());
        self.push(FunctionId::Regressor, outputs);
        let names = regressor.base.iter();
        let names: Vec<String> = names.map(|base| format!("`{}`", base.name)).collect();
        // Four names per line.
        let listed: Vec<String> = names.chunks(4).map(|names| names.join(", ")).collect();
        let mut lines = vec![format!("{}.", listed.join(",\n"))];
        if !regressor.besides.is_empty() {
            let besides = regressor.besides.join(", ");
            lines.push(format!(
                "Not part of it, and no linear function of them: {besides}."
            ));
        }
        if let Some(function) = self.functions.last_mut() {
            function.shape = Shape::Matrix(n, columns.len());
            function.docs.extend(lines.clone());
        }
        let mut graph = from.clone();
        let beta: Vec<Edge> = regressor
            .base
            .iter()
            .map(|base| {
                let terms = base
                    .terms
                    .iter()
                    .map(|&(k, factor)| graph.mul(factor, regressor.standard[k].value));
                let terms: Vec<Edge> = terms.collect();
                graph.sum(&terms)
            })
            .collect();
        let outputs = graft(&graph, &mut self.graph, &beta);
        self.push(FunctionId::BaseParameters, outputs);
        if let Some(function) = self.functions.last_mut() {
            function.docs.push(lines.swap_remove(0));
            function.docs.push(
                "Each has others regrouped with it: `hamel regressor` prints the sums.".into(),
            );
        }
    }

    /// Adds the quantities that are claimed to be constant, as functions to monitor them.
    pub(super) fn invariants(&mut self) {
        let mut model = self.model.clone();
        let mut calculus = Calculus::new(&model);
        let given = DerivationContext::in_given_velocities(self.model);
        let total = (!self.model.invariants.is_empty())
            .then(|| TreeRecursion::of(&given, Placement::Described, &self.numerical_loss))
            .flatten()
            .map(|recursion| recursion.total_momentum());
        for claim in &self.model.invariants {
            // The energy already has a function of its own.
            if matches!(claim.quantity, Quantity::Energy) && claim.name == "energy" {
                continue;
            }
            let energy = self.functions.iter().find(|f| f.name == "energy");
            let energy = energy.and_then(|f| f.outputs.first()).copied();
            let (shape, outputs) = match (&claim.quantity, energy) {
                (Quantity::Energy, Some(energy)) => (Shape::Scalar, vec![energy]),
                (quantity, _) => {
                    let zero = model.graph.zero();
                    let value =
                        quantity::quantity_value(&mut model, &mut calculus, (zero, zero), quantity);
                    let mut candidates = Candidates::new(&self.numerical_loss);
                    candidates.offer_both(model.graph.clone(), value.entries(), &self.graph);
                    if let Some((graph, linear, angular)) = &total {
                        let mut graph = graph.clone();
                        let found =
                            quantity::quantity_of_total(&mut graph, (*linear, *angular), quantity);
                        // The result has to agree with the definition at the graph's point, in two
                        // finite fields.
                        let values = |graph: &Graph, entries: &[Edge]| -> Vec<ResiduePair> {
                            entries.iter().map(|&entry| graph.value(entry)).collect()
                        };
                        let defined = values(&model.graph, &value.entries());
                        if let Some(found) = found.filter(|f| values(&graph, f) == defined) {
                            candidates.offer_own(graph, found);
                        }
                    }
                    (shape_of(&value), candidates.cheapest(&mut self.graph))
                }
            };
            let when = match claim.when.as_str() {
                "" => String::new(),
                when => format!(" when {when}"),
            };
            let docs = format!(
                "Invariant `{}`: constant along the motion{when}.",
                claim.name
            );
            let arguments = [Coordinates, Velocities];
            self.functions.push(Function::described(
                &claim.name,
                docs,
                &arguments,
                shape,
                outputs,
            ));
        }
    }
}

/// Returns whether expressions of a model depend on ξ̇.
fn depends_on_acceleration(model: &Model, entries: &[Edge]) -> bool {
    let class = |edge: &Edge| model.graph.class(edge.node());
    entries.iter().any(|edge| class(edge) & class::ACCEL != 0)
}
