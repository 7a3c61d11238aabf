//! The proof that stands before every emission: at fresh points of X modulo p, the emitted ξ̇
//! satisfies M ξ̇ + h + ∂V = f with M, h, V and f derived on an independent route, T, V, D are those of
//! that route, and outputs have the values of their expressions.

use super::calculus::Calculus;
use super::slopes::Slopes;
use super::{commutation, connection, energy, inertia, kinematics, virtual_power};
use crate::algebra::fp::Fp;
use crate::algebra::graph::Edge;
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::program::Program;

/// Fresh points for every program.
pub const POINTS: u64 = 8;
/// Points tried where square roots have no value.
const TRIES: u64 = 400;

/// The independent derivation: M, h = Γ ξ ξ, ∂V, f, T, V.
pub(super) struct Reference {
    /// The model, its graph holding the rest.
    pub(super) model: Model,
    /// M.
    pub(super) mass: Vec<Vec<Edge>>,
    /// h.
    pub(super) bias: Vec<Edge>,
    /// ∂V.
    pub(super) slope: Vec<Edge>,
    /// f.
    pub(super) force: Vec<Edge>,
    /// T.
    pub(super) kinetic: Edge,
    /// V.
    pub(super) potential: Edge,
    /// D.
    pub(super) dissipation: Edge,
}

impl Reference {
    /// Hamel's form (30a), from T and γ, not from traced bodies.
    pub(super) fn new(model: &Model) -> Option<Self> {
        let mut model = model.clone();
        let mut calculus = Calculus::new(&model);
        let mass = inertia::mass_matrix(&mut model, &mut calculus);
        let rows = kinematics::left_inverse(&mut model)?;
        let gamma = commutation::gamma(&mut model, &mut calculus, &rows);
        let bias = connection::quadratic(&mut model, &mut calculus, &mass, &gamma);
        let potential = energy::potential(&mut model);
        let slope = (0..model.n())
            .map(|i| calculus.along(&mut model.graph, i, potential))
            .collect();
        let mut graph = model.graph.clone();
        let force = virtual_power::applied(&model, &mut graph, &mut calculus);
        let power = virtual_power::dissipated(&model, &mut graph, &mut calculus);
        let half = graph.ratio(1, 2);
        let dissipation = graph.mul(half, power);
        model.graph = graph;
        let kinetic = energy::kinetic(&mut model, &mass);
        Some(Reference {
            model,
            mass,
            bias,
            slope,
            force,
            kinetic,
            potential,
            dissipation,
        })
    }
}

/// Validates the functions of a program; an error here is a fault of the generator, never emitted.
pub fn validate(model: &Model, program: &Program) -> Result<(), Diagnostic> {
    let mut reference = Reference::new(model).ok_or_else(|| failure(model, "the kinematics"))?;
    let slopes = Slopes::new(&mut reference, program);
    let mut seed = 0;
    for _ in 0..POINTS {
        loop {
            seed += 1;
            if seed > TRIES {
                return Err(failure(model, "no point was found at which the code"));
            }
            let Some(lane) = model.points.lane(0x7a11 + seed) else {
                continue;
            };
            let found = at_point(&reference, program, lane.clone());
            let found = match found {
                Some(Ok(())) => slopes.at_point(&reference, program, &lane),
                found => found,
            };
            match found {
                None => continue,
                Some(Ok(())) => break,
                Some(Err(what)) => return Err(failure(model, what)),
            }
        }
    }
    Ok(())
}

/// A fault of the generator, which is never emitted.
pub(super) fn failure(model: &Model, what: &str) -> Diagnostic {
    Diagnostic::new(
        model.span,
        format!(
            "internal check failed: {what} of `{}` does not satisfy its equation",
            model.name
        ),
    )
    .help("this is a fault of the generator, nothing was emitted; please report the description")
}

/// Compares at one point; `None` where it cannot be evaluated there.
fn at_point(
    reference: &Reference,
    program: &Program,
    lane: Lane,
) -> Option<Result<(), &'static str>> {
    let n = program.n;
    let graph = &reference.model.graph;
    let mut roots: Vec<Edge> = reference.mass.concat();
    roots.extend(
        reference
            .bias
            .iter()
            .chain(&reference.slope)
            .chain(&reference.force),
    );
    roots.extend([
        reference.kinetic,
        reference.potential,
        reference.dissipation,
    ]);
    let expected = evaluate_at(graph, &roots, &mut lane.clone())?;
    let (mass, rest) = expected.split_at(n * n);
    let (bias, rest) = rest.split_at(n);
    let (slope, rest) = rest.split_at(n);
    let (force, energies) = rest.split_at(n);
    let value = |name: &str| {
        let function = program.function(name)?;
        evaluate_at(&program.graph, &function.outputs, &mut lane.clone())
    };
    let wanted = |name: &str| program.function(name).is_some();
    if wanted("accel") {
        let xi_dot = value("accel")?;
        for i in 0..n {
            let inertial = (0..n).fold(Fp::ZERO, |sum, j| sum + mass[i * n + j] * xi_dot[j]);
            if inertial + bias[i] + slope[i] != force[i] {
                return Some(Err("ξ̇"));
            }
        }
    }
    let table: [(&str, &[Fp], &'static str); 7] = [
        ("mass_matrix", mass, "M"),
        ("bias", bias, "Γ ξ ξ"),
        ("potential_force", slope, "∂V"),
        ("generalized_force", force, "f"),
        ("kinetic_energy", &energies[..1], "T"),
        ("potential_energy", &energies[1..2], "V"),
        ("dissipation", &energies[2..], "D"),
    ];
    for (name, expected, what) in table {
        if wanted(name) && value(name)? != expected {
            return Some(Err(what));
        }
    }
    for (name, expected) in &reference.model.outputs {
        let expected = evaluate_at(graph, &expected.entries(), &mut lane.clone())?;
        if wanted(name) && value(name)? != expected {
            return Some(Err("an output"));
        }
    }
    Some(Ok(()))
}
