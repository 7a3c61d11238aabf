//! `hamel eval`: numbers of everything at a state.

mod frames;
mod geometry;
mod sample;

use crate::failure::{Failure, print, warn};
use crate::json::Json;
use crate::mechanism::{Instance, function};
use crate::names;
use crate::robot::RobotOptions;
use crate::source::Source;
use crate::state::State;
use crate::state::file::File;
use crate::state::joints::{joints, rows};
use clap::Args;
use geometry::Geometry;
use hamel::{Energies, System};
use hamel_codegen::derive::undetermined::undetermined;
use hamel_codegen::functions::FunctionId;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Shape;
use std::path::PathBuf;

/// γ and Γ have n³ entries each: of systems with more velocities they are printed where --tables asks.
const MOST_SHOWN: usize = 64;

/// Prints the numbers of A, γ, M, Γ, forces, rates and energies at a state, as JSON.
///
/// The state is the description's start with default parameters and zero input, changed by what
/// STATE.json gives: {"param": {…}, "coord": {"r": […], "R": [[…]]}, "velocity": {…},
/// "state": {…}, "input": {…}}.
/// A circle takes [cos, sin] or an angle, a pose {"p": […], "R": [[…]]}, a symmetric matrix all rows.
/// Velocities of joints are known by the joint's name, too, that of the URDF file for a robot. A state is the start
/// that the description would have if it contained these numbers: they and the other exact starts are kept, what is
/// prescribed follows, loops are closed and constraints kept by the rest. Where the numbers contradict exact starts of
/// the text, the ones that loops and constraints tie to them move to the nearest values; a state that contradicts
/// loops or constraints by itself is refused. Of a list of samples, as `hamel simulate --out` writes it to a .json
/// file, the last is taken. Matrices are written by rows; gamma[i][j][k] is γ of lower i, j and upper k, Gamma[i][j][k]
/// is Γ_ijk. A, γ, M and Γ are those of all velocities, which `frame` names; forces, bias and accel are of those that
/// constraints leave, which `velocities` names. `undetermined` names the rows of `constraints` whose forces are not unique: what
/// stands for them is one of many solutions.
///
/// STATE.json may also be about joints, for every command that takes a state: {"configuration": {"elbow": 0.3,
/// "root_joint": {"position": […], "rotation": [[…]]}}, "velocity": {"elbow": 1, "root_joint": {"linear": […],
/// "angular": […]}}, "param": {…}, "force": […]}, angles in rad, forces by joint or in the order of the rows; a planar
/// joint has {"position": [x, y], "angle": a} and {"linear": [vx, vy], "angular": w}. Then `velocities` names
/// each row by its joint, `bias` is Γ ξ ξ + ∂V, gravity in it, and `accel` is M⁻¹ (force − bias): force is
/// all of the generalised force, friction in it. `force`, and a list {"samples": […]} of such states, are
/// for `eval` alone.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel eval heavy_top.eom
  hamel eval heavy_top.eom --at state.json
  hamel eval quadruped.urdf --floating --at sample.json
  hamel eval arm.urdf --frame tool0
  echo '{\"velocity\": {\"w\": [0, 0, 9]}}' | hamel eval heavy_top.eom --at -")]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// State, by coordinates or by joints; `-` for standard input.
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,
    /// Pose, twist, Jacobian and bias acceleration of a frame, or of a robot's link by its name in the URDF file; once
    /// for each.
    #[arg(long, value_name = "NAME")]
    frame: Vec<String>,
    /// Print γ and Γ of systems with more than 64 velocities, too.
    #[arg(long)]
    tables: bool,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Evaluates and prints; where something has no value it is `null`, and the command fails.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut source = Source::open(&arguments.file, &arguments.robot)?.in_numbers();
    if !arguments.frame.is_empty() {
        source = source.showing_frames();
    }
    let frames = source.frames(&arguments.frame)?;
    let at = arguments.at.as_deref();
    let at = at.map(|path| File::read(path, &source)).transpose()?;
    if let Some(at) = at.as_ref().filter(|at| at.is_by_joints()) {
        return sample::run(&source, at, &frames);
    }
    let generated = source.derive_available(&frames::asked(&frames))?;
    let state = match &at {
        Some(at) => at.state(&source, &generated)?,
        None => State::start(&generated.active),
    };
    let shown = arguments.tables || generated.model.n() <= MOST_SHOWN;
    let (value, missing) = numbers((&generated, source.shown()), &state, &frames, shown)?;
    if !shown {
        warn(&format!(
            "gamma and Gamma, 2 × {}³ numbers, are left out: --tables prints them\n",
            generated.model.n()
        ));
    }
    print(&value.pretty())?;
    if missing.is_empty() {
        Ok(())
    } else {
        Err(Failure::failed(format!(
            "{}: {}",
            source.path,
            missing.join("; ")
        )))
    }
}

/// The numbers of everything at a state and of frames, γ and Γ among them where they are wanted, and what has no value;
/// `shown` is the text that messages give lines of.
pub fn numbers(
    (generated, shown): (&Generated, &str),
    state: &State,
    frames: &[frames::Named],
    with_tables: bool,
) -> Result<(Json, Vec<String>), Failure> {
    let states = generated.model.states.iter();
    let states: Vec<String> = states.flat_map(names::group).collect();
    let mut members = vec![
        ("system", Json::Text(generated.model.name.clone())),
        (
            "coordinates",
            Json::texts(&names::coordinates(&generated.model)),
        ),
        (
            "velocities",
            Json::texts(&names::velocities(&generated.active)),
        ),
        ("states", Json::texts(&states)),
        ("frame", Json::texts(&names::velocities(&generated.model))),
        ("x", Json::vector(&state.x)),
        ("xi", Json::vector(&state.xi)),
    ];
    members.retain(|(name, _)| *name != "states" || !states.is_empty());
    // Rows by joint, where there are any.
    let known = joints(&generated.active, &[]);
    if !known.is_empty() {
        let rows = rows(&generated.active, &known);
        members.push(("joints", Json::texts(&rows)));
    }
    members.extend(Geometry::new(generated, state, with_tables)?.members());
    let mut missing: Vec<String> = Vec::new();
    members.extend(motion(generated, (state, shown), &mut missing)?);
    members.extend(frames::kinematics(generated, state, frames)?.map(|all| ("kinematics", all)));
    let infinite = members.iter().filter(|(_, value)| !finite(value));
    let infinite: Vec<&str> = infinite.map(|(name, _)| *name).collect();
    if !infinite.is_empty() {
        missing.push(format!("not finite at this state: {}", infinite.join(", ")));
    }
    Ok((Json::object(members), missing))
}

/// Forces, rates, energies, outputs.
fn motion(
    generated: &Generated,
    (state, text): (&State, &str),
    missing: &mut Vec<String>,
) -> Result<Vec<(&'static str, Json)>, Failure> {
    let system = Instance::new(generated, state, text)?;
    let State { params, x, xi, u } = state;
    let start = system.start();
    let vector = |name: &str| -> Result<Json, Failure> {
        let value = function(&generated.program, name, params)?.call(x, xi, u, &[]);
        Ok(Json::vector(&value.unwrap_or_default()))
    };
    let has_inertia = generated.model.has_inertia;
    let accel = match system.motion(x, xi, u) {
        Ok(accel) => Json::vector(&accel),
        // That there is none was said before.
        Err(_) if generated.program.function(FunctionId::Accel).is_none() => Json::Null,
        Err(why) => {
            missing.push(format!("{why}: `accel` has no value"));
            Json::Null
        }
    };
    // λ of constraints on the velocities and forces of drives; none where there are none.
    let constraint_force = match generated.program.function("constraint_force") {
        _ if !generated.model.has_multipliers() => None,
        Some(_) => Some(vector("constraint_force")?),
        None => Some(Json::vector(&[])),
    };
    let outputs = system.outputs().iter().map(|output| {
        let values = system.output(output, 0.0, x, xi);
        let value = match output.shape {
            Shape::Scalar => Json::Number(values.first().copied().unwrap_or(f64::NAN)),
            Shape::Vector(_) => Json::vector(&values),
            Shape::Matrix(_, columns) => Json::matrix(
                &values
                    .chunks(columns.max(1))
                    .map(<[f64]>::to_vec)
                    .collect::<Vec<_>>(),
            ),
        };
        (output.name.as_str(), value)
    });
    let mut members = vec![
        (
            "bias",
            match has_inertia {
                true => vector("bias")?,
                false => Json::Null,
            },
        ),
        ("potential_force", vector("potential_force")?),
        ("generalized_force", vector("generalized_force")?),
        ("rate", vector("rate")?),
        ("accel", accel),
        (
            "kinetic_energy",
            match has_inertia {
                true => Json::Number(system.kinetic_energy(&start.0, &start.1)),
                false => Json::Null,
            },
        ),
        (
            "potential_energy",
            Json::Number(system.potential_energy(&start.0)),
        ),
        ("constraint", Json::vector(&system.constraint(x))),
        ("outputs", Json::object(outputs)),
    ];
    if let Some(force) = constraint_force {
        // The rows that say something, as they are written, and the velocities whose rates are given.
        let model = &generated.model;
        let rows = model.constraints.iter().filter(|row| !row.redundant);
        let rows = rows.map(|row| row.label());
        let names = names::velocities(model);
        let driven = model.accelerated.iter();
        let driven = driven.filter_map(|&(velocity, _)| names.get(velocity).cloned());
        let rows: Vec<String> = rows.chain(driven).collect();
        let free = undetermined(model).into_iter().zip(&rows);
        let free = free.filter(|(free, _)| *free).map(|(_, row)| row.clone());
        let free: Vec<String> = free.collect();
        members.push(("constraints", Json::texts(&rows)));
        members.push(("constraint_force", force));
        if !free.is_empty() {
            members.push(("undetermined", Json::texts(&free)));
        }
    }
    Ok(members)
}

fn finite(value: &Json) -> bool {
    match value {
        Json::Number(number) => number.is_finite(),
        Json::List(items) => items.iter().all(finite),
        Json::Object(members) => members.iter().all(|(_, value)| finite(value)),
        _ => true,
    }
}
