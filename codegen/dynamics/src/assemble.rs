//! Assembly of the program of a model, with every function that is emitted; it is validated before
//! it is returned.

use super::accel::cheapest::MassAndForces;
use super::accel::{AccelerationCandidate, forward_dynamics, mass_and_forces};
use super::calculus::Calculus;
use super::candidates::{Candidates, SHORT_SEARCH_NODES};
use super::multipliers::with_accelerations;
use super::numerical_loss::{self, NumericalLoss};
use super::program::{MAX_LITERAL_VELOCITIES, ProgramBuilder, shape_of};
use super::reduction::Reduction;
use super::regressor::Regressor;
use super::structure::{self, SplitFunctions, StructureAnalysis};
use super::{correction, energy, inertia, kinematics};
use Argument::{Accelerations, Coordinates, Inputs, Velocities};
use hamel_algebra::graph::{Edge, Graph, Node, NodeId};
use hamel_algebra::transplant::{copy, rebuild};
use hamel_language::diagnostics::Diagnostic;
use hamel_language::functions::Needs;
use hamel_language::model::{Model, class};
use hamel_program::provenance::Provenance;
use hamel_program::structure::Structure;
use hamel_program::{Argument, Cause, Function, FunctionId, Program};
use rustc_hash::FxHashSet;

/// Derives the expressions of all requested functions of a model, and returns them as a program.
///
/// `reduction` solves its constraints; `regressor` contains its base parameters, if they are
/// requested. The program is the cheapest one or, if that loses too many digits to rounding, one
/// that keeps more of them.
///
/// # Errors
/// Returns a diagnostic if the mass matrix is singular or not positive definite although its
/// inverse is needed, or if a requested function does not exist for the model.
pub fn assemble(
    full: &Model,
    reduction: Option<&Reduction>,
    regressor: Option<&Regressor>,
    linearized: bool,
) -> Result<Program, Diagnostic> {
    let model = reduction.map_or(full, |reduction| &reduction.model);
    let (mut program, mass) = build_program(
        full,
        reduction,
        regressor,
        linearized,
        &NumericalLoss::default(),
    )?;
    // Dependent rows amplify the deviation of the start from loop closure, whatever program is
    // emitted.
    if !model.overconstrained {
        let mut losses = numerical_loss::losses(model, &program);
        let excess = numerical_loss::excess_loss(model, &program, &mass, &losses);
        if excess > 0.0 {
            let (careful, mass) = build_program(
                full,
                reduction,
                regressor,
                linearized,
                &NumericalLoss::at_states_of(model),
            )?;
            let kept = numerical_loss::losses(model, &careful);
            if numerical_loss::excess_loss(model, &careful, &mass, &kept) < excess {
                (program, losses) = (careful, kept);
            }
        }
        numerical_loss::add_loss_remarks(&mut program, &losses);
    }
    Ok(program)
}

/// Returns the program before validation, and M in its graph.
fn build_program(
    full: &Model,
    reduction: Option<&Reduction>,
    regressor: Option<&Regressor>,
    linearized: bool,
    numerical_loss: &NumericalLoss,
) -> Result<(Program, Vec<Vec<Edge>>), Diagnostic> {
    let model = reduction.map_or(full, |reduction| &reduction.model);
    let mut reference = model.clone();
    let inverts = model.asked.needs() == Needs::Inverse;
    if model.n() <= MAX_LITERAL_VELOCITIES && inverts {
        let mut calculus = Calculus::new(&reference);
        let mass = inertia::mass_matrix(&mut reference, &mut calculus);
        inertia::check_positive_definite(model, &reference.graph, &mass)?;
    }
    let alone = (!inverts)
        .then(|| mass_and_forces(model, numerical_loss))
        .flatten()
        .map(|computed| (AccelerationCandidate::none(model.graph.clone()), computed));
    let Some((chosen, computed)) = alone.or_else(|| forward_dynamics(model, numerical_loss)) else {
        // Elimination at the start configuration shows which velocity is the first without inertia.
        let (graph, mass) = match mass_and_forces(model, numerical_loss) {
            Some(MassAndForces { graph, parts }) => (graph, parts.mass),
            None => {
                let mut calculus = Calculus::new(&reference);
                let mass = inertia::mass_matrix(&mut reference, &mut calculus);
                (reference.graph, mass)
            }
        };
        inertia::check_positive_definite(model, &graph, &mass)?;
        return Err(Diagnostic::new(
            model.span,
            "the mass matrix is singular for every configuration",
        )
        .help("every velocity needs inertia: check masses and inertias; `generate inverse_dynamics, mass_matrix;` and similar selections do not need its inverse")
        .lacking(Needs::Inverse));
    };
    if model.n() > MAX_LITERAL_VELOCITIES && inverts {
        inertia::check_positive_definite(model, &computed.graph, &computed.parts.mass)?;
    }
    let potential = energy::potential(&mut reference);
    let mut builder = ProgramBuilder::new(model, chosen, computed, numerical_loss);
    builder.kinematics();
    builder.dynamics(&reference.graph, potential);
    builder.momentum();
    if linearized {
        builder.linearize(full, reduction);
    }
    builder.dissipation();
    builder.variety(full)?;
    builder.outputs();
    builder.frames();
    builder.centroidal(full)?;
    builder.inverse_dynamics_derivatives(full, reduction);
    builder.parameter_derivatives(full)?;
    if let Some(regressor) = regressor {
        builder.regressor(regressor);
    }
    builder.invariants();
    if let Some(reduction) = reduction {
        builder.constraint_force(full, reduction);
        builder.projections();
    }
    let MassAndForces { graph, parts } = &builder.shared;
    let found = structure::analyse_structure(full, model, graph, parts);
    let mut others = Vec::new();
    if found.functions.is_some() && model.n() <= MAX_LITERAL_VELOCITIES {
        // In a graph without the computation of ξ̇.
        let mut apart = model.graph.clone();
        let parts = builder.parts.rebuild_in(&builder.graph, &mut apart);
        others.extend(structure::analyse_structure(full, model, &apart, &parts).functions);
    }
    let structure = builder.splitting(found, &others)?;
    let mass = builder.parts.mass.clone();
    Ok((builder.finish(structure), mass))
}

impl ProgramBuilder<'_> {
    fn kinematics(&mut self) {
        let model = self.model;
        let rate = rebuild(&model.graph, &mut self.graph, &model.rate);
        let x = model.x.clone();
        let chart = kinematics::chart_rates(&mut self.graph, &model.blocks, &x, &rate);
        self.push(FunctionId::Rate, rate);
        self.push(FunctionId::ChartRate, chart);
    }

    fn dynamics(&mut self, reference: &Graph, potential: Edge) {
        let guards = self.guards();
        let route = format!("Route: {}.", self.chosen.route);
        let mut rates = self.chosen.xi_dot.clone();
        let stateful = !self.model.states.is_empty();
        if stateful {
            rates.extend(self.state_rates(&rates));
        }
        self.push_guarded(FunctionId::Accel, rates, guards);
        if let (Some(accel), true) = (self.functions.last_mut(), stateful) {
            let text = "The rates ż of the states follow ξ̇.";
            accel.docs.push(text.into());
        }
        if let Some(accel) = self.functions.last_mut() {
            accel.docs.push(route);
        }
        let mass = self.parts.mass.clone();
        let graph = &mut self.graph;
        let bias: Vec<Edge> = self.parts.inertia.iter().map(|&edge| -edge).collect();
        let slope: Vec<Edge> = self.parts.conservative.iter().map(|&edge| -edge).collect();
        let applied = self.parts.applied.clone();
        let momentum = self.parts.momentum_of(graph, self.model);
        let inverse = self.parts.inverse_dynamics_of(graph, self.model);
        let [kinetic, energy] = self.energies(&momentum, reference, potential);
        let potential = rebuild(reference, &mut self.graph, &[potential])[0];
        self.push(FunctionId::InverseDynamics, inverse);
        self.push(FunctionId::MassMatrix, mass.concat());
        self.push(FunctionId::Bias, bias);
        self.push(FunctionId::PotentialForce, slope);
        self.push(FunctionId::GeneralizedForce, applied);
        self.push(FunctionId::Momentum, momentum);
        let gyroscopic = self.model.gyroscopic != self.model.graph.zero();
        self.push(FunctionId::KineticEnergy, vec![kinetic]);
        if let (Some(function), true) = (self.functions.last_mut(), gyroscopic) {
            let text = "Of what is written as `kinetic`, T₂ − T₀ by degrees in ẋ: with it T + V is ẋ · ∂L/∂ẋ − L.";
            function.docs.push(text.into());
        }
        self.push(FunctionId::PotentialEnergy, vec![potential]);
        self.push(FunctionId::Energy, vec![energy]);
        if let (Some(function), true) = (self.functions.last_mut(), gyroscopic) {
            let text =
                "Of what is written as `kinetic`, T₂ − T₀ by degrees in ẋ: this is ẋ · ∂L/∂ẋ − L.";
            function.docs.push(text.into());
        }
    }

    /// Returns the part of T in the energy, and the energy, i.e. that part plus V.
    ///
    /// T is computed as ½ ξ · p or from the velocities of points and bodies, whichever is cheaper.
    /// `potential` is V in the graph `reference`.
    fn energies(&mut self, momentum: &[Edge], reference: &Graph, potential: Edge) -> [Edge; 2] {
        let [mut kinetic, mut energy] = [(); 2].map(|()| Candidates::new(&self.numerical_loss));
        let mut offer = |graph: Graph, t: Edge| {
            let mut around = graph.clone();
            let v = rebuild(reference, &mut around, &[potential])[0];
            let sum = around.add(t, v);
            energy.offer_own(around, vec![sum]);
            kinetic.offer_own(graph, vec![t]);
        };
        let mut graph = self.graph.clone();
        let by_momentum = self.parts.kinetic_of(&mut graph, self.model, momentum);
        let value = graph.value(by_momentum);
        offer(graph, by_momentum);
        if self.model.graph.len() < SHORT_SEARCH_NODES {
            let mut model = self.model.clone();
            let mut calculus = Calculus::new(&model);
            let traced = energy::kinetic_of_bodies(&mut model, &mut calculus);
            let traced = energy::kinetic_in_energy(&mut model, traced);
            // Only p includes armatures and an M given in the description.
            if model.graph.value(traced) == value {
                offer(model.graph, traced);
            }
        }
        let [kinetic, energy] = [kinetic, energy].map(|all| all.cheapest(&mut self.graph)[0]);
        [kinetic, energy]
    }

    /// Returns ż with the given ξ̇.
    pub(super) fn state_rates(&mut self, xi_dot: &[Edge]) -> Vec<Edge> {
        let model = self.model;
        let rates = rebuild(&model.graph, &mut self.graph, &model.state_rates);
        with_accelerations(&mut self.graph, &rates, xi_dot)
    }

    /// Adds the dissipation function D, if there is one.
    fn dissipation(&mut self) {
        let model = self.model;
        let asked = model.asked.names(FunctionId::Dissipation);
        if model.dissipation == model.graph.zero() && !asked {
            return;
        }
        let value = rebuild(&model.graph, &mut self.graph, &[model.dissipation]);
        self.push(FunctionId::Dissipation, value);
    }

    /// Adds φ and −Ψ φ, which are needed off X as well: they are copied node by node from the graph
    /// with free points.
    fn variety(&mut self, model: &Model) -> Result<(), Diagnostic> {
        let mut free = model.points.free.clone();
        let rows: Vec<Edge> = model.phi.iter().map(|(edge, _)| *edge).collect();
        let correction = correction::correction(model, &mut free).ok_or_else(|| {
            Diagnostic::new(model.span, "no Ψ was found: [Y; Φ] has no inverse on X")
                .help("write the constraints so that their derivatives are independent")
        })?;
        let mut phi = copy(&free, &mut self.graph, &rows);
        phi.extend(self.loops());
        let correction = copy(&free, &mut self.graph, &correction);
        self.push(FunctionId::Constraint, phi);
        self.push(FunctionId::Correction, correction);
        Ok(())
    }

    fn outputs(&mut self) {
        for (name, value) in &self.model.outputs {
            let entries = rebuild(&self.model.graph, &mut self.graph, &value.entries());
            let shape = shape_of(value);
            let docs = format!("Output `{name}` of the description.");
            let arguments = self.arguments(&entries);
            self.functions
                .push(Function::described(name, docs, &arguments, shape, entries));
        }
    }

    /// Returns the quantities on which expressions depend, as arguments of a function.
    fn arguments(&self, entries: &[Edge]) -> Vec<Argument> {
        let states: Vec<NodeId> = self.model.z().iter().map(|z| z.node()).collect();
        let of = |id: NodeId| match self.graph.class(id) {
            _ if states.contains(&id) => Some(Velocities),
            class::COORD | class::TIME => Some(Coordinates),
            class::VELOCITY => Some(Velocities),
            class::ACCEL => Some(Accelerations),
            class::INPUT => Some(Inputs),
            _ => None,
        };
        let reached = self.graph.reachable(entries).into_iter();
        let symbols = reached.filter(|&id| matches!(self.graph.node(id), Node::Symbol(_)));
        let found: Vec<Argument> = symbols.filter_map(of).collect();
        let all = [Coordinates, Velocities, Accelerations, Inputs];
        all.into_iter()
            .filter(|argument| found.contains(argument))
            .collect()
    }

    /// Adds the functions that splitting methods call.
    ///
    /// # Errors
    /// Returns a diagnostic if they are requested although the system does not split.
    fn splitting(
        &mut self,
        found: StructureAnalysis,
        others: &[SplitFunctions],
    ) -> Result<Structure, Diagnostic> {
        let model = self.model;
        if let (Err(reasons), true) = (
            &found.structure.split,
            model.asked.names(FunctionId::Splitting),
        ) {
            let reasons: Vec<String> = reasons.iter().map(ToString::to_string).collect();
            return Err(Diagnostic::new(
                model.span,
                format!("the equations do not split: {}", reasons.join("; ")),
            )
            .help(
                "leave `splitting` out of `generate`; `accel` serves the methods for any system",
            ));
        }
        if let (Some(functions), true) =
            (&found.functions, model.asked.wants(FunctionId::Splitting))
        {
            let pivots = functions.add_to_program(others, self);
            let graph = &self.graph;
            let varies = |pivot: &Edge| !graph.is_free(pivot.node());
            if self.chosen.pivots.iter().any(varies) {
                self.constant_guards.extend(pivots);
            }
        }
        Ok(found.structure)
    }

    fn finish(mut self, structure: Structure) -> Program {
        let model = self.model;
        let names = let_names(model, &mut self.graph);
        self.functions.retain(|function| match function.id {
            Some(id) => model.asked.wants(id),
            None => model.asked.wants_output(&function.name),
        });
        let constants = &model.completion.constants;
        let first = self.kinematic_guards.len();
        self.kinematic_guards
            .extend(rebuild(&model.graph, &mut self.graph, constants));
        let all = self.kinematic_guards.iter().copied().enumerate();
        let new = all.map(|(number, pivot)| (pivot, Cause::Kinematics(number)));
        self.causes.splice(first..first, new.skip(first));
        // Numbers were checked to be positive together with M.
        let of_parameters = |edge: &Edge| {
            self.graph.is_free(edge.node()) && self.graph.as_rational(*edge).is_none()
        };
        let kinematic = self.kinematic_guards.iter().copied().filter(of_parameters);
        let mut constant_guards: Vec<Edge> = if self.functions.iter().any(|f| f.fallible) {
            self.chosen
                .pivots
                .iter()
                .copied()
                .filter(of_parameters)
                .chain(kinematic)
                .collect()
        } else {
            Vec::new()
        };
        constant_guards.extend(&self.constant_guards);
        // Sorted such that the first failure is reported: later pivots are computed from earlier
        // ones.
        constant_guards.sort_by_key(|guard| guard.node());
        constant_guards.dedup();
        let loops = self.loops().len();
        let kinds: usize = model.blocks.iter().map(|block| block.constraints()).sum();
        // Pivots that are numbers or guard nothing are never checked, so they need no cause.
        let guards = self.functions.iter().flat_map(|function| &function.guards);
        let guards: FxHashSet<Edge> = guards.chain(&constant_guards).copied().collect();
        let mut causes = self.causes;
        causes.retain(|(pivot, _)| guards.contains(pivot));
        Program {
            name: model.name.clone(),
            public: model.public,
            docs: model.docs.clone(),
            graph: self.graph,
            params: model.params.clone(),
            defaults: model.defaults.clone(),
            coordinates: model.coordinates.clone(),
            blocks: model.blocks.clone(),
            velocities: model.velocities.clone(),
            inputs: model.inputs.clone(),
            states: model.states.clone(),
            joints: model.joints.clone(),
            nu: model.nu(),
            n: model.n(),
            m: model.m(),
            n_z: model.state_rates.len(),
            phi: model.phi.len() + loops,
            clock: model.clock.map(|clock| clock.x),
            embedded: model.completion.independent.len() > kinds,
            start_x: model.start_x.clone(),
            start_xi: [&model.start_xi[..], &model.start_z].concat(),
            names,
            constant_guards,
            causes,
            functions: self.functions,
            structure,
            provenance: Provenance::of(model),
        }
    }
}

/// Returns names of temporaries from the user's `let`s: `p`, and `p_1` … for the entries of a
/// vector.
fn let_names(model: &Model, graph: &mut Graph) -> Vec<(String, Edge)> {
    let mut names = Vec::new();
    for (name, value) in &model.lets {
        let entries = rebuild(&model.graph, graph, &value.entries());
        if let [only] = entries.as_slice() {
            names.push((name.clone(), *only));
        } else {
            names.extend(
                entries
                    .into_iter()
                    .enumerate()
                    .map(|(i, edge)| (format!("{name}_{}", i + 1), edge)),
            );
        }
    }
    names
}
