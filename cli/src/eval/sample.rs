//! Evaluates states given by joints: M, bias and acceleration as other programs define them.

use super::{finite, json_of_frames};
use crate::failure::{Failure, print};
use crate::json::Json;
use hamel_codegen::functions::FunctionId;
use hamel_codegen::generate::Generated;
use hamel_engine::evaluate::{NamedFrame, kinematics, requested_jacobians};
use hamel_engine::mechanism::{self, constant_singular, function};
use hamel_engine::names;
use hamel_engine::state::{JointState, StateFile, VELOCITY_ORDER, rows};
use hamel_engine::{Error, Source, State};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;

/// The evaluated functions; no others are derived.
const FUNCTIONS: [FunctionId; 8] = [
    FunctionId::Rate,
    FunctionId::Accel,
    FunctionId::MassMatrix,
    FunctionId::Bias,
    FunctionId::PotentialForce,
    FunctionId::GeneralizedForce,
    FunctionId::KineticEnergy,
    FunctionId::PotentialEnergy,
];
/// Largest relative residual of a force that inputs produce.
const FORCE_TOLERANCE: f64 = 1e-9;

/// Evaluates and prints one state, or each state of a list `samples`.
///
/// `bias` is Γ ξ ξ + ∂V, so that M ξ̇ + bias = force, where force is the whole generalised force:
/// friction and other loads of the description are part of it, not added to it. Without a force
/// the loads of the description act, with zero input.
pub fn run(source: &Source, at: &StateFile, frames: &[NamedFrame]) -> Result<(), Failure> {
    let StateFile { path, json } = at;
    let generated = source.derive_only(&FUNCTIONS, &requested_jacobians(frames))?;
    let (list, several) = match json.get("samples") {
        Some(Value::Array(list)) => (list.as_slice(), true),
        _ => (std::slice::from_ref(json), false),
    };
    // Entries that are common to all samples.
    let order = json.get(VELOCITY_ORDER).filter(|_| several);
    let mut errors = Vec::new();
    let mut samples = Vec::new();
    for (index, one) in list.iter().enumerate() {
        match JointState::parse(
            State::start(&generated.active),
            one,
            order,
            (&generated, &source.text),
            source.joints(),
        ) {
            Ok(sample) => samples.push(sample),
            Err(found) if several => {
                errors.extend(
                    found
                        .iter()
                        .map(|error| format!("samples[{index}].{error}")),
                );
            }
            Err(found) => errors.extend(found.iter().map(ToString::to_string)),
        }
    }
    if !errors.is_empty() {
        return Err(Failure::usages(path, &errors));
    }
    let mut failed = Vec::new();
    let mut written = Vec::new();
    for (index, sample) in samples.iter().enumerate() {
        let (members, missing) = members((&generated, source.shown()), sample, frames)?;
        let place = match several {
            true => format!("samples[{index}]: "),
            false => String::new(),
        };
        failed.extend(missing.into_iter().map(|why| format!("{place}{why}")));
        written.push(Json::object(members));
    }
    let output = match written.pop() {
        Some(only) if !several => only,
        last => {
            written.extend(last);
            Json::object([("samples", Json::List(written))])
        }
    };
    print(&output.pretty())?;
    match failed.is_empty() {
        true => Ok(()),
        false => Err(Failure::failed(format!(
            "{}: {}",
            source.path,
            failed.join("; ")
        ))),
    }
}

/// The printed members of a state, and messages about missing values.
type Members = (Vec<(&'static str, Json)>, Vec<String>);

fn members(
    (generated, text): (&Generated, &str),
    sample: &JointState,
    frames: &[NamedFrame],
) -> Result<Members, Error> {
    let model = &generated.active;
    let state = &sample.state;
    let call = |name: &str| -> Result<Vec<f64>, Error> {
        let value = function(&generated.program, name, &state.params)?;
        Ok(value
            .call(&state.x, &state.xi, &state.u, &[])
            .unwrap_or_default())
    };
    let n = model.n();
    // Without inertia there is no M, nor anything derived from it.
    let with_inertia = |name: &str| match generated.model.has_inertia {
        true => call(name).map(Some),
        false => Ok(None),
    };
    let mass = with_inertia("mass_matrix")?.map(|entries| square(entries, n));
    let mass = mass.transpose()?;
    let mass = mass.map(|entries| DMatrix::from_row_slice(n, n, &entries));
    let slope = call("potential_force")?;
    let bias = with_inertia("bias")?.map(|bias| {
        let sums = bias.iter().zip(&slope).map(|(a, b)| a + b);
        Json::vector(&sums.collect::<Vec<f64>>())
    });
    let accel = accel(generated, sample, mass.as_ref())?;
    let rows_of_mass = mass.as_ref().map(|mass| {
        let rows = mass.row_iter().map(|row| row.iter().copied().collect());
        Json::matrix(&rows.collect::<Vec<Vec<f64>>>())
    });
    let number = |values: Vec<f64>| Json::Number(values.first().copied().unwrap_or(f64::NAN));
    let kinetic = with_inertia("kinetic_energy")?.map(number);
    let mut members = vec![
        ("system", Json::Text(generated.model.name.clone())),
        ("coordinates", Json::texts(&names::coordinates(model))),
        ("velocities", Json::texts(&rows(model, &sample.joints))),
        ("x", Json::vector(&state.x)),
        ("xi", Json::vector(&state.xi)),
        ("M", rows_of_mass.unwrap_or(Json::Null)),
        ("bias", bias.unwrap_or(Json::Null)),
        ("potential_force", Json::vector(&slope)),
        ("generalized_force", Json::vector(&accel.force)),
        ("rate", Json::vector(&call("rate")?)),
        (
            "accel",
            accel.value.as_deref().map_or(Json::Null, Json::vector),
        ),
        ("kinetic_energy", kinetic.unwrap_or(Json::Null)),
        ("potential_energy", number(call("potential_energy")?)),
    ];
    let kinematics = kinematics(generated, state, frames)?;
    members.extend(kinematics.map(|all| ("kinematics", json_of_frames(&all))));
    let mut missing = Vec::new();
    // A missing function has been reported before.
    let is_there = generated.program.function(FunctionId::Accel).is_some();
    if let (None, true, Some(mass)) = (&accel.value, is_there, &mass) {
        let why = mechanism::explain_singular_state(generated, &state.params, mass, text);
        missing.push(format!("{why}: `accel` has no value"));
    }
    let infinite = members.iter().filter(|(_, value)| !finite(value));
    let infinite: Vec<&str> = infinite.map(|(name, _)| *name).collect();
    if !infinite.is_empty() {
        missing.push(format!("not finite at this state: {}", infinite.join(", ")));
    }
    Ok((members, missing))
}

/// ξ̇ and the force that causes it.
struct Accel {
    value: Option<Vec<f64>>,
    force: Vec<f64>,
}

fn accel(
    generated: &Generated,
    sample: &JointState,
    mass: Option<&DMatrix<f64>>,
) -> Result<Accel, Error> {
    let state = &sample.state;
    let program = &generated.program;
    let forward = function(program, "accel", &state.params).ok();
    let loads = function(program, "generalized_force", &state.params)?;
    let loads = |u: &[f64]| {
        let value = loads.call(&state.x, &state.xi, u, &[]);
        DVector::from_vec(value.unwrap_or_default())
    };
    let singular = constant_singular(program, &state.params);
    let accel = |u: &[f64]| match singular {
        true => None,
        false => forward.as_ref()?.call(&state.x, &state.xi, u, &[]).ok(),
    };
    let own = loads(&state.u);
    let Some(force) = &sample.force else {
        return Ok(Accel {
            value: accel(&state.u),
            force: own.as_slice().to_vec(),
        });
    };
    // Loads are affine in the inputs: find the inputs that produce the force, if any.
    let wanted = DVector::from_column_slice(force);
    let missing = &wanted - &own;
    let columns: Vec<DVector<f64>> = (0..state.u.len())
        .map(|index| {
            let mut u = state.u.clone();
            u[index] = 1.0;
            loads(&u) - &own
        })
        .collect();
    let inputs = match columns.is_empty() {
        true => None,
        false => {
            let reach = DMatrix::from_columns(&columns);
            let solved = reach.clone().svd(true, true).solve(&missing, f64::EPSILON);
            solved.ok().filter(|u| {
                let short = (&reach * u - &missing).norm();
                short <= FORCE_TOLERANCE * (wanted.norm() + own.norm())
            })
        }
    };
    let value = match inputs {
        Some(inputs) => accel(inputs.as_slice()),
        // No inputs produce this force: M ξ̇ = M ξ̇₀ + the missing force.
        None => accel(&state.u).and_then(|start| {
            let more = mass?.clone().cholesky()?.solve(&missing);
            Some((DVector::from_vec(start) + more).as_slice().to_vec())
        }),
    };
    Ok(Accel {
        value,
        force: force.clone(),
    })
}

/// Checks that there are n × n entries.
fn square(entries: Vec<f64>, n: usize) -> Result<Vec<f64>, Error> {
    if entries.len() == n * n {
        Ok(entries)
    } else {
        Err(Error::NoMassMatrix)
    }
}
