//! `hamel eval`: evaluates all quantities at a state.

mod sample;

use crate::failure::{Failure, print, warn};
use crate::json::Json;
use crate::robot::RobotOptions;
use crate::source;
use clap::Args;
use hamel_engine::evaluate::{Cube, Kinematics, Value, evaluate, requested_jacobians};
use hamel_engine::state::StateFile;
use hamel_engine::{Evaluation, State};
use std::path::PathBuf;

/// Number of velocities above which γ and Γ, with n³ entries each, are printed only with --tables.
const MAX_SHOWN_VELOCITIES: usize = 64;

/// Prints the values of A, γ, M, Γ, forces, rates and energies at a state, as JSON.
///
/// The state is the description's start with default parameters and zero input, changed by the entries of STATE.json:
/// {"param": {…}, "coord": {"r": […], "R": [[…]]}, "velocity": {…}, "state": {…}, "input": {…}}. A circle takes [cos,
/// sin] or an angle, a pose {"p": […], "R": [[…]]}, a symmetric matrix all rows. Velocities of joints may also be given
/// by the joint's name (for a robot, its name in the URDF file). The state is the start that the description would have
/// if it contained these numbers: they and the other exact starts are kept, prescribed motions are followed, and the
/// remaining numbers close the loops and satisfy the constraints. Where the numbers contradict exact starts of the
/// text, the starts that loops and constraints tie to them move to the nearest values; a state that by itself
/// contradicts loops or constraints is refused. From a list of samples, as `hamel simulate --out` writes it to a .json
/// file, the last is taken. Matrices are written by rows; gamma[i][j][k] is γ of lower i, j and upper k, Gamma[i][j][k]
/// is Γ_ijk. A, γ, M and Γ refer to all velocities, named in `frame`; forces, bias and accel to the velocities that
/// constraints leave, named in `velocities`. `undetermined` names the rows of `constraints` whose forces are not
/// unique: their values are one of many solutions.
///
/// STATE.json may also be given by joints, for every command that takes a state: {"configuration": {"elbow": 0.3,
/// "root_joint": {"position": […], "rotation": [[…]]}}, "velocity": {"elbow": 1, "root_joint": {"linear": […],
/// "angular": […]}}, "param": {…}, "force": […]}, angles in rad, forces by joint or in the order of the rows; a planar
/// joint has {"position": [x, y], "angle": a} and {"linear": [vx, vy], "angular": w}. Then `velocities` names
/// each row by its joint, `bias` is Γ ξ ξ + ∂V, including gravity, and `accel` is M⁻¹ (force − bias): force is the
/// whole generalised force, including friction. `force`, and a list {"samples": […]} of such states, are for `eval`
/// alone.
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
    /// Print pose, twist, Jacobian and bias acceleration of a frame, or of a robot's link by its name in the URDF file;
    /// once for each.
    #[arg(long, value_name = "NAME")]
    frame: Vec<String>,
    /// Print γ and Γ even for systems with more than 64 velocities.
    #[arg(long)]
    tables: bool,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Evaluates and prints; values that do not exist are `null`, and make the command fail.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut source = source::open(&arguments.file, &arguments.robot)?.for_evaluation();
    if !arguments.frame.is_empty() {
        source = source.showing_frames();
    }
    let frames = source.frames(&arguments.frame)?;
    let at = arguments.at.as_deref();
    let at = at.map(|path| StateFile::read(path, &source)).transpose()?;
    if let Some(at) = at.as_ref().filter(|at| at.is_by_joints()) {
        return sample::run(&source, at, &frames);
    }
    let generated = source.derive_available(&requested_jacobians(&frames))?;
    let state = match &at {
        Some(at) => at.state(&source, &generated)?,
        None => State::start(&generated.active),
    };
    let shown = arguments.tables || generated.model.n() <= MAX_SHOWN_VELOCITIES;
    let numbers = evaluate((&generated, source.shown()), &state, &frames, shown)?;
    if !shown {
        warn(&format!(
            "gamma and Gamma, 2 × {}³ numbers, are left out: --tables prints them\n",
            generated.model.n()
        ));
    }
    print(&json(&numbers).pretty())?;
    match numbers.missing.is_empty() {
        true => Ok(()),
        false => Err(Failure::failed(format!(
            "{}: {}",
            source.path,
            numbers.missing.join("; ")
        ))),
    }
}

/// Returns the numbers as JSON.
fn json(numbers: &Evaluation) -> Json {
    let cube = |table: &Cube| Json::List(table.iter().map(|rows| Json::matrix(rows)).collect());
    let vector = |list: &Option<Vec<f64>>| list.as_deref().map_or(Json::Null, Json::vector);
    let mut members = vec![
        ("system", Json::Text(numbers.system.clone())),
        ("coordinates", Json::texts(&numbers.coordinates)),
        ("velocities", Json::texts(&numbers.velocities)),
        ("states", Json::texts(&numbers.states)),
        ("frame", Json::texts(&numbers.frame)),
        ("x", Json::vector(&numbers.x)),
        ("xi", Json::vector(&numbers.xi)),
    ];
    members.retain(|(name, _)| *name != "states" || !numbers.states.is_empty());
    members.extend(
        numbers
            .joints
            .iter()
            .map(|rows| ("joints", Json::texts(rows))),
    );
    members.push(("A", Json::matrix(&numbers.a)));
    members.extend(numbers.gamma.iter().map(|gamma| ("gamma", cube(gamma))));
    let mass = numbers.mass.as_deref();
    members.push(("M", mass.map_or(Json::Null, Json::matrix)));
    let connection = numbers.connection.iter();
    members.extend(connection.map(|table| ("Gamma", table.as_ref().map_or(Json::Null, cube))));
    let outputs = numbers.outputs.iter();
    let outputs = outputs.map(|(name, value)| (name.as_str(), json_of(value)));
    members.extend([
        ("bias", vector(&numbers.bias)),
        ("potential_force", Json::vector(&numbers.potential_force)),
        (
            "generalized_force",
            Json::vector(&numbers.generalized_force),
        ),
        ("rate", Json::vector(&numbers.rate)),
        ("accel", vector(&numbers.accel)),
        (
            "kinetic_energy",
            numbers.kinetic_energy.map_or(Json::Null, Json::Number),
        ),
        ("potential_energy", Json::Number(numbers.potential_energy)),
        ("constraint", Json::vector(&numbers.constraint)),
        ("outputs", Json::object(outputs)),
    ]);
    if let Some(forces) = &numbers.multipliers {
        members.push(("constraints", Json::texts(&forces.constraints)));
        members.push(("constraint_force", Json::vector(&forces.constraint_force)));
        if !forces.undetermined.is_empty() {
            members.push(("undetermined", Json::texts(&forces.undetermined)));
        }
    }
    members.extend(
        numbers
            .kinematics
            .iter()
            .map(|all| ("kinematics", json_of_frames(all))),
    );
    Json::object(members)
}

/// Returns a value, matrices by rows.
fn json_of(value: &Value) -> Json {
    match value {
        Value::Number(number) => Json::Number(*number),
        Value::Vector(list) => Json::vector(list),
        Value::Matrix(rows) => Json::matrix(rows),
    }
}

/// Returns an object for every frame.
fn json_of_frames(Kinematics(frames): &Kinematics) -> Json {
    let frame = |values: &[(String, Value)]| {
        let values = values.iter();
        Json::object(values.map(|(name, value)| (name.as_str(), json_of(value))))
    };
    let frames = frames.iter();
    Json::object(frames.map(|(name, values)| (name.as_str(), frame(values))))
}

fn finite(value: &Json) -> bool {
    match value {
        Json::Number(number) => number.is_finite(),
        Json::List(items) => items.iter().all(finite),
        Json::Object(members) => members.iter().all(|(_, value)| finite(value)),
        _ => true,
    }
}
