//! Reads a description: the order of the steps, and the checks between them.

use super::configuration_manifold::ConfigurationManifold;
use super::motion::TimeDerivative;
use super::rate::At;
use super::static_scope::StaticScope;
use super::{
    dynamics, externals, independent_velocities, invariants, joints, kinematics, negative,
    pfaffian, plausibility, prescribe, speed_jumps, start, states, time, unused,
};
use crate::algebra::graph::Graph;
use crate::diagnostics::{Diagnostic, Report};
use crate::inertia;
use crate::model::Model;
use crate::model::initial_conditions::InitialConditions;
use crate::model::loop_closure::LoopClosure;
use crate::model::samples;
use crate::model::statements::Statements;
use crate::reuse;
use crate::syntax::ast::{ItemKind, Origins, System};
use crate::{dimensions, shapes, symbols};
use std::collections::BTreeSet;

/// Number of times that points are chosen anew because a square root has no value.
const ATTEMPTS: u64 = 8;

/// Number of points at which square roots may be confused before they are kept apart.
const DOUBTS: usize = 3;

/// Number of draws of real values, eight of each symbol, to tell square roots apart.
const DRAWN: u64 = 16;

/// Seed of the points: fixed, so that builds repeat.
const SEED: u64 = 0x4a6d_656c;

/// Reads a description; all its independent errors are reported together.
///
/// # Errors
/// Returns the errors of the description.
pub fn build(system: &System) -> Result<Model, Vec<Diagnostic>> {
    build_at(system, 0)
}

/// Reads a description as [`build`] does, at other points of the manifold, chosen by a number.
///
/// # Errors
/// Returns the errors of the description.
pub fn build_at(system: &System, number: u64) -> Result<Model, Vec<Diagnostic>> {
    let written = reuse::expand(system)?;
    let origins = &written.system.origins;
    let model = read(&written.system, &written.used, number);
    let mut model = model.map_err(|errors| origins.located_all(errors))?;
    model.warnings = origins.located_all(std::mem::take(&mut model.warnings));
    model.warnings.extend(written.warnings);
    model.origins = origins.clone();
    Ok(model)
}

/// Reads a description whose components and repetitions are expanded; `used` are the names that these mention.
fn read(system: &System, used: &BTreeSet<String>, number: u64) -> Result<Model, Vec<Diagnostic>> {
    let own = SEED + number * ATTEMPTS;
    let mut first = Report::new();
    let described = system;
    let system = &joints::expand(system, &mut first);
    let system = &time::expand(system, &mut first);
    let names = symbols::resolve(system, &mut first);
    shapes::check(system, &names, &mut first);
    let dimensions = match first.is_empty() {
        true => dimensions::check(system, &names, &mut first),
        false => None,
    };
    let mut manifold = ConfigurationManifold::of(system, &names, own, &mut first);
    let mut errors = first.finish().err().unwrap_or_default();
    let mut branches = false;
    let mut doubts = 0;
    for seed in own..own + ATTEMPTS {
        let mut choice = Report::new();
        let point = manifold.choose(system, seed, &mut choice);
        errors.extend(choice.finish().err().unwrap_or_default());
        let mut report = Report::new();
        errors.iter().cloned().for_each(|error| report.push(error));
        let mut statics = StaticScope::on(&manifold, &point, system, &names, seed, &mut report);
        if doubts == DOUBTS {
            statics.graph.forbid_root_merges();
        }
        let result = read_at(system, &manifold, &names.order, statics, report);
        match result {
            Ok(model) if model.graph.has_bad_prime() => {
                errors.push(
                    Diagnostic::new(
                        system.name.span,
                        "a number is a multiple of a prime that proofs compute with",
                    )
                    .help("change the last digit of the longest number, or make it a parameter"),
                );
                return Err(errors);
            }
            // Another point may be on the branch of the start.
            Ok(model) if model.graph.has_contradicted_samples() => branches = true,
            Err((_, Some(graph))) if graph.has_contradicted_samples() => branches = true,
            Ok(model) if model.graph.has_missing_root() => {
                manifold.points.require_roots(&model.graph)
            }
            Err((_, Some(graph))) if graph.has_missing_root() => {
                manifold.points.require_roots(&graph)
            }
            Ok(model) if doubts < DOUBTS && is_doubtful(&manifold, &model) => doubts += 1,
            Ok(mut model) => {
                model.points.require_roots(&model.graph);
                if let Some(dimensions) = dimensions {
                    model.measure(dimensions);
                }
                let implausible = plausibility::plausibility_warnings(described, &model);
                let jumps = speed_jumps::speed_jump_warnings(described, &model);
                let idle = std::mem::take(&mut model.warnings);
                model.warnings = unused::unused_warnings(described, &(&names.used | used));
                model.warnings.extend(idle);
                model.warnings.extend(implausible);
                model.warnings.extend(jumps);
                let negative = negative::negative_value_warnings(system, &model);
                model.warnings.extend(negative);
                return Ok(model);
            }
            Err((errors, _)) => return Err(errors),
        }
    }
    if branches {
        let statement = system.items.iter();
        let mut statement =
            statement.filter(|item| matches!(item.kind, ItemKind::Constraint { .. }));
        let span = statement.next().map_or(system.name.span, |item| item.span);
        errors.push(
            Diagnostic::new(
                span,
                "the constraints have several branches, and that of the start could not be isolated",
            )
            .help("write only the branch that is meant: one factor of a product, not the product"),
        );
        return Err(errors);
    }
    errors.push(
        Diagnostic::new(
            system.name.span,
            "no point was found at which all square roots have values",
        )
        .help("replace the root of a product, such as 3 * a^2, by a parameter"),
    );
    Err(errors)
}

/// Returns whether an expression was identified with another one that it equals only at some real points, such as
/// √(e²) with e.
fn is_doubtful(manifold: &ConfigurationManifold, model: &Model) -> bool {
    let near = manifold.near.as_deref();
    let samples =
        (1..=DRAWN).map(|seed| samples::sample(&manifold.points, &manifold.phi, seed, near));
    model.graph.has_doubtful_merges(samples)
}

/// The errors, and the graph if there is one.
type Failure = (Vec<Diagnostic>, Option<Box<Graph>>);

/// Reads a description at a point of its manifold, given its motion-independent part.
fn read_at(
    system: &System,
    manifold: &ConfigurationManifold,
    order: &symbols::Order,
    mut statics: StaticScope,
    mut report: Report,
) -> Result<Model, Failure> {
    let StaticScope {
        graph,
        scope,
        declared,
        defaults,
        names,
        constraints: written,
    } = &mut statics;
    let errors = &mut report;
    manifold.check(written, graph, errors);
    // The start is needed to choose pivots; its errors are reported last.
    let mut last = Report::new();
    let mut starts = start::read(system, graph, scope, declared, defaults, &mut last);
    start::guess::check(system, declared, &mut last);
    let written = starts.as_ref().map(|start| start.x.clone());
    if let (Some(start), Some(x)) = (&mut starts, &manifold.assembled) {
        start.x.clone_from(x);
    }
    if let Some(start) = &starts {
        start::check::check(system, manifold, declared, defaults, &start.x, &mut last);
    }
    let known = last.is_empty() && !defaults.iter().any(|number| number.is_nan());
    let at = starts.as_ref().filter(|_| known).map(|start| At {
        defaults,
        x: &start.x,
    });
    let kinematics = kinematics::read(system, graph, scope, manifold, declared, at, errors);
    if let Some(kinematics) = &kinematics {
        let motion = TimeDerivative::new(
            &declared.x,
            &kinematics.rate,
            &declared.xi,
            &declared.xi_dot,
        );
        scope.motion = Some(motion);
    }
    scope.unmoved = kinematics.is_none();
    names.read(&order.after, graph, scope, errors);
    let scope = &*scope;
    let numbers = declared.numbers(defaults, starts.as_ref());
    let frames = std::mem::take(&mut names.frames);
    let mut dynamics = dynamics::read(system, graph, scope, &frames, declared, &numbers, errors);
    let joints = joints::read(system, graph, scope, errors);
    let armature = joints::armature(system, graph, scope, declared, &mut dynamics, errors);
    dynamics.has_inertia |= dynamics.kinetic != graph.zero();
    let invariants = invariants::read(system, graph, scope, &frames, declared, errors);
    let (mut constraints, closures, idle) =
        pfaffian::read(system, graph, scope, declared, kinematics.as_ref(), errors);
    let (drives, prescribed, accelerated) = prescribe::read(
        system,
        graph,
        scope,
        declared,
        manifold,
        kinematics.as_ref(),
        errors,
    );
    constraints.extend(drives);
    let states = states::read(system, graph, scope, declared, defaults, errors);
    let independent =
        independent_velocities::read(system, graph, scope, declared, &constraints, errors);
    let initial = starts
        .as_ref()
        .map(|start| start.initial_conditions(graph, &states));
    if let (Some(start), Some(initial), Some(kinematics), true) = (
        &mut starts,
        &initial,
        &kinematics,
        errors.is_empty() && last.is_empty(),
    ) && !defaults.iter().any(|number| number.is_nan())
    {
        let (all, n) = (&declared.coordinates, declared.xi.len());
        let rows = || manifold.phi.iter().map(|(edge, _)| *edge).collect();
        let constrained = !manifold.user_rows().is_empty();
        let closure = LoopClosure::new(
            graph,
            all,
            (&kinematics.a, n),
            declared.clock,
            &constraints,
            constrained.then(|| (&manifold.points.free, rows())),
            defaults,
        );
        let mass = |x: &[f64]| {
            let (inertia, moved) = ((&frames[..], &dynamics), (&*declared, kinematics));
            start::guess::mass(graph, inertia, moved, &numbers, x)
        };
        let tied = (&constraints[..], &prescribed[..]);
        errors.keep(start.complete(initial.clone(), &closure, tied, &mass));
    }
    last.finish()
        .err()
        .unwrap_or_default()
        .into_iter()
        .for_each(|error| report.push(error));
    if let Err(mut errors) = report.finish() {
        // Without other errors, missing inertia is reported later, for the functions that are derived; these may be
        // fewer than those that the description asks for.
        let claims = invariants.iter().map(|claim| claim.name.as_str());
        errors.extend(inertia::lacking(
            system.name.span,
            dynamics.has_inertia,
            &dynamics.asked,
            claims,
        ));
        return Err((errors, Some(Box::new(statics.graph))));
    }
    let (Some(kinematics), Some(start), Some(initial), Some(written), false) = (
        kinematics,
        starts,
        initial,
        written,
        statics.scope.missed.get(),
    ) else {
        let error = Diagnostic::new(system.name.span, "the description could not be read");
        return Err((vec![error], None));
    };
    let externals = externals::places(&statics.scope);
    let StaticScope {
        graph,
        scope,
        declared,
        defaults,
        names,
        ..
    } = statics;
    let (motion, called) = (scope.motion, scope.called.into_inner());
    let zero = graph.zero();
    let model = Model {
        name: system.name.name.clone(),
        public: system.public,
        docs: system.docs.clone(),
        graph,
        points: manifold.points.clone(),
        params: declared.params,
        defaults,
        coordinates: declared.coordinates,
        blocks: manifold.points.blocks.clone(),
        x: declared.x,
        phi: manifold.phi.clone(),
        velocities: declared.velocities,
        xi: declared.xi,
        velocity_spans: declared.velocity_spans,
        xi_dot: declared.xi_dot,
        momenta: declared.momenta,
        inputs: declared.inputs,
        u: declared.u,
        states: declared.states,
        state_rates: states.rates,
        rate: kinematics.rate,
        a: kinematics.a,
        constraints,
        clock: declared.clock,
        prescribed,
        accelerated,
        independent,
        full_frame: None,
        spans: true,
        overconstrained: false,
        augmented: false,
        starts_anywhere: system.starts_anywhere,
        kinetic_terms: None,
        completion: kinematics.completion,
        frames,
        joints,
        closures,
        bodies: dynamics.bodies,
        particles: dynamics.particles,
        kinetic: dynamics.kinetic,
        has_inertia: dynamics.has_inertia,
        gyroscopic: zero,
        armature,
        potential: dynamics.potential,
        gravity: dynamics.gravity,
        wrenches: dynamics.wrenches,
        generalized: dynamics.generalized,
        dissipation: dynamics.dissipation,
        elements: dynamics.elements,
        observed: motion.map_or(Vec::new(), |motion| motion.seen.into_inner()),
        outputs: dynamics.outputs,
        invariants,
        lets: names.lets,
        externals,
        dimensions: None,
        start_x: start.x,
        start_xi: start.xi,
        start_z: states.start,
        initial_conditions: InitialConditions {
            x: written,
            ..initial
        },
        asked: dynamics.asked,
        span: system.name.span,
        statements: Statements::of(system),
        origins: Origins::default(),
        warnings: idle,
    };
    match externals::misplaced(&model, &called) {
        Some(error) => Err((vec![error], None)),
        None => Ok(model),
    }
}
