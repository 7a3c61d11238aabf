//! Evaluates everything at a state: tables, forces, rates, energies, frames.

mod frames;
mod geometry;
mod value;

pub use frames::{Kinematics, NamedFrame, kinematics, requested_jacobians};
pub use geometry::Cube;
pub use value::Value;

use crate::error::Error;
use crate::mechanism::{Instance, function};
use crate::names;
use crate::state::{State, joints, rows};
use geometry::Geometry;
use hamel::{Energies, System};
use hamel_codegen::derive::undetermined::undetermined_multipliers;
use hamel_codegen::functions::FunctionId;
use hamel_codegen::generate::Generated;
use serde::Serialize;

/// Values of all quantities at a state. A quantity without a value is NaN; one that does not exist is `None`.
#[derive(Clone, Debug, Serialize)]
pub struct Evaluation {
    /// Name of the system.
    pub system: String,
    /// Names of the entries of x.
    pub coordinates: Vec<String>,
    /// Names of the velocities that constraints leave.
    pub velocities: Vec<String>,
    /// Names of the states of first order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<String>,
    /// Names of all velocities.
    pub frame: Vec<String>,
    /// x.
    pub x: Vec<f64>,
    /// ξ, followed by the states of first order.
    pub xi: Vec<f64>,
    /// Names of the velocities that constraints leave by their joints, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joints: Option<Vec<String>>,
    /// A, by rows.
    #[serde(rename = "A")]
    pub a: Vec<Vec<f64>>,
    /// γ, `gamma[i][j][k]` that of lower i, j and upper k, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gamma: Option<Cube>,
    /// M, by rows.
    #[serde(rename = "M")]
    pub mass: Option<Vec<Vec<f64>>>,
    /// Γ, if requested; `Some(None)` without inertia.
    #[serde(rename = "Gamma", skip_serializing_if = "Option::is_none")]
    pub connection: Option<Option<Cube>>,
    /// Γ ξ ξ.
    pub bias: Option<Vec<f64>>,
    /// ∂V.
    pub potential_force: Vec<f64>,
    /// The generalised force of all loads.
    pub generalized_force: Vec<f64>,
    /// ẋ.
    pub rate: Vec<f64>,
    /// ξ̇.
    pub accel: Option<Vec<f64>>,
    /// T.
    pub kinetic_energy: Option<f64>,
    /// V.
    pub potential_energy: f64,
    /// φ.
    pub constraint: Vec<f64>,
    /// Outputs by their names.
    #[serde(serialize_with = "value::by_name")]
    pub outputs: Vec<(String, Value)>,
    /// Forces of constraints and drives, if there are any.
    #[serde(flatten)]
    pub multipliers: Option<Multipliers>,
    /// Requested frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kinematics: Option<Kinematics>,
    /// Messages about the quantities that have no value.
    #[serde(skip)]
    pub missing: Vec<String>,
}

/// Forces by which constraints on velocities and drives act.
#[derive(Clone, Debug, Serialize)]
pub struct Multipliers {
    /// The constraints as they are written, and the velocities whose rates are given.
    pub constraints: Vec<String>,
    /// Their forces λ.
    pub constraint_force: Vec<f64>,
    /// Those of them whose forces are not unique.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub undetermined: Vec<String>,
}

/// Evaluates all quantities at a state, with the kinematics of the frames in `frames` and, if `with_tables`, the Hamel
/// coefficients γ and the connection coefficients Γ; `shown` is the text
/// whose line numbers messages give.
///
/// # Errors
/// A function is missing or cannot be evaluated.
pub fn evaluate(
    (generated, shown): (&Generated, &str),
    state: &State,
    frames: &[NamedFrame],
    with_tables: bool,
) -> Result<Evaluation, Error> {
    let (full, active) = (&generated.model, &generated.active);
    let State { params, x, xi, u } = state;
    let Geometry { a, mass, tables } = Geometry::new(generated, state, with_tables)?;
    let (gamma, connection) = tables.unzip();
    let system = Instance::new(generated, state, shown)?;
    let vector = |name: &str| -> Result<Vec<f64>, Error> {
        let value = function(&generated.program, name, params)?.call(x, xi, u, &[]);
        Ok(value.unwrap_or_default())
    };
    let mut missing = Vec::new();
    let accel = match system.motion(x, xi, u) {
        Ok(accel) => Some(accel),
        // That the function is missing has been reported before.
        Err(_) if generated.program.function(FunctionId::Accel).is_none() => None,
        Err(why) => {
            missing.push(format!("{why}: `accel` has no value"));
            None
        }
    };
    let has_inertia = full.has_inertia;
    let start = system.start();
    // Rows by joint, if there are joints.
    let known = joints(active, &[]);
    let mut evaluation = Evaluation {
        system: full.name.clone(),
        coordinates: names::coordinates(full),
        velocities: names::velocities(active),
        states: full.states.iter().flat_map(names::group).collect(),
        frame: names::velocities(full),
        x: x.clone(),
        xi: xi.clone(),
        joints: (!known.is_empty()).then(|| rows(active, &known)),
        a,
        gamma,
        mass,
        connection,
        bias: has_inertia.then(|| vector("bias")).transpose()?,
        potential_force: vector("potential_force")?,
        generalized_force: vector("generalized_force")?,
        rate: vector("rate")?,
        accel,
        kinetic_energy: has_inertia.then(|| system.kinetic_energy(&start.0, &start.1)),
        potential_energy: system.potential_energy(&start.0),
        constraint: system.constraint(x).to_vec(),
        outputs: outputs(&system, state),
        multipliers: multipliers(generated, &vector)?,
        kinematics: kinematics(generated, state, frames)?,
        missing,
    };
    let infinite = evaluation.infinite();
    if !infinite.is_empty() {
        let why = format!("not finite at this state: {}", infinite.join(", "));
        evaluation.missing.push(why);
    }
    Ok(evaluation)
}

/// Evaluates all outputs.
fn outputs(system: &Instance, state: &State) -> Vec<(String, Value)> {
    let outputs = system.outputs().iter().map(|output| {
        let values = system.output(output, 0.0, &state.x, &state.xi);
        (output.name.clone(), Value::new(output.shape, &values))
    });
    outputs.collect()
}

/// Evaluates λ of constraints on the velocities and forces of drives; `None` without constraints and drives.
fn multipliers(
    generated: &Generated,
    vector: &dyn Fn(&str) -> Result<Vec<f64>, Error>,
) -> Result<Option<Multipliers>, Error> {
    let model = &generated.model;
    if !model.has_multipliers() {
        return Ok(None);
    }
    let constraint_force = match generated.program.function("constraint_force") {
        Some(_) => vector("constraint_force")?,
        None => Vec::new(),
    };
    // The independent rows as they are written, and the velocities whose rates are prescribed.
    let rows = model.constraints.iter().filter(|row| !row.redundant);
    let rows = rows.map(|row| row.label());
    let names = names::velocities(model);
    let driven = model.accelerated.iter();
    let driven = driven.filter_map(|&(velocity, _)| names.get(velocity).cloned());
    let constraints: Vec<String> = rows.chain(driven).collect();
    let free = undetermined_multipliers(model)
        .into_iter()
        .zip(&constraints);
    let free = free.filter(|(free, _)| *free).map(|(_, row)| row.clone());
    Ok(Some(Multipliers {
        undetermined: free.collect(),
        constraints,
        constraint_force,
    }))
}

impl Evaluation {
    /// Returns the names of the numbers that are not finite, in order.
    fn infinite(&self) -> Vec<&'static str> {
        let list = |list: &[f64]| list.iter().all(|number| number.is_finite());
        let rows = |rows: &[Vec<f64>]| rows.iter().all(|row| list(row));
        let cube = |cube: &Cube| cube.iter().all(|plane| rows(plane));
        let maybe = |numbers: &Option<Vec<f64>>| numbers.as_deref().is_none_or(list);
        let values = |all: &[(String, Value)]| all.iter().all(|(_, value)| value.is_finite());
        let force = self.multipliers.as_ref();
        let frames = self.kinematics.as_ref();
        let all = [
            ("x", list(&self.x)),
            ("xi", list(&self.xi)),
            ("A", rows(&self.a)),
            ("gamma", self.gamma.as_ref().is_none_or(cube)),
            ("M", self.mass.as_deref().is_none_or(rows)),
            ("Gamma", self.connection.iter().flatten().all(cube)),
            ("bias", maybe(&self.bias)),
            ("potential_force", list(&self.potential_force)),
            ("generalized_force", list(&self.generalized_force)),
            ("rate", list(&self.rate)),
            ("accel", maybe(&self.accel)),
            (
                "kinetic_energy",
                self.kinetic_energy.is_none_or(f64::is_finite),
            ),
            ("potential_energy", self.potential_energy.is_finite()),
            ("constraint", list(&self.constraint)),
            ("outputs", values(&self.outputs)),
            (
                "constraint_force",
                force.is_none_or(|force| list(&force.constraint_force)),
            ),
            ("kinematics", frames.is_none_or(Kinematics::is_finite)),
        ];
        let infinite = all.into_iter().filter(|(_, finite)| !finite);
        infinite.map(|(name, _)| name).collect()
    }
}
