//! The words of the language that names can meet: its functions, how they are called, and its constants.

use crate::algebra::function::Function;
use std::borrow::Cow;

/// Names of functions and constants of the language, which cannot be redefined.
const RESERVED: &[&str] = &[
    "transpose",
    "dot",
    "cross",
    "hat",
    "vee",
    "norm",
    "diag",
    "trace",
    "outer",
    "identity",
    "sin",
    "cos",
    "tan",
    "atan2",
    "sqrt",
    "exp",
    "log",
    "sinh",
    "cosh",
    "tanh",
    "asin",
    "acos",
    "atan",
    "min",
    "max",
    "clamp",
    "hypot",
    "rotx",
    "roty",
    "rotz",
    "rpy",
    "axis_angle",
    "rot",
    "qmul",
    "pose",
    "inverse",
    "rate",
    "pi",
    "world",
];

/// Names of functions and constants of the language: those of the table of functions without a place of their own
/// come last.
pub fn reserved() -> impl Iterator<Item = &'static str> {
    let table = Function::ALL.iter().map(|function| function.name());
    let further = table.filter(|name| !RESERVED.contains(name) && Function::named(name).is_some());
    RESERVED.iter().copied().chain(further)
}

/// The functions of motions; a value may share the name of one, as a coordinate `position` does.
pub const FUNCTIONS: [&str; 5] = [
    "position",
    "velocity",
    "acceleration",
    "angular_velocity",
    "angular_acceleration",
];

/// What a joint calls for its axis; no name of the language has blanks.
pub const AXIS: &str = "the axis of a joint";
/// What a joint calls for its place.
pub const PLACE: &str = "the place of a joint";
/// What a planar joint calls for the two directions of its plane, as the columns of a 3×2 matrix.
pub const PLANE: &str = "the plane of a joint";

/// Whether a function is known only once the rates are.
pub fn needs_rates(function: &str) -> bool {
    function == "rate" || FUNCTIONS.contains(&function) && function != "position"
}

/// Functions whose names values and functions of a description may share.
const NAMES_OF_ALL: [&str; 2] = ["translation", "angle"];

/// The functions of the language by their names.
pub fn names() -> impl Iterator<Item = &'static str> {
    reserved()
        .chain(FUNCTIONS)
        .chain(NAMES_OF_ALL)
        .filter(|name| usage(name).is_some())
}

/// Whether a name is that of a function of the language, which no function of a description can have.
pub fn is_function(name: &str) -> bool {
    usage(name).is_some() && !NAMES_OF_ALL.contains(&name)
        || FUNCTIONS.contains(&name)
        || name == "rate"
}

/// How a function is called.
pub fn usage(name: &str) -> Option<Cow<'static, str>> {
    let text = match name {
        "sin" => "`sin(angle)` of a scalar",
        "cos" => "`cos(angle)` of a scalar",
        "tan" => "`tan(angle)` of a scalar",
        "asin" => "`asin(a)` of a scalar",
        "acos" => "`acos(a)` of a scalar",
        "atan" => "`atan(a)` of a scalar",
        "atan2" => "`atan2(y, x)` of scalars",
        "min" => "`min(a, b)` of scalars",
        "max" => "`max(a, b)` of scalars",
        "clamp" => "`clamp(a, low, high)` of scalars",
        "hypot" => "`hypot(a, b)` of scalars",
        "dot" => "`dot(a, b)` of vectors of equal length",
        "cross" => "`cross(a, b)` of vectors of 3",
        "outer" => "`outer(a, b)` of vectors",
        "norm" => "`norm(v)` of a vector",
        "hat" => "`hat(w)` of a vector of 3",
        "vee" => "`vee(W)` of a 3×3 matrix",
        "transpose" => "`transpose(M)` of a matrix",
        "trace" => "`trace(M)` of a square matrix",
        "diag" => "`diag(a, b, c)` of scalars or `diag(v)` of a vector",
        "identity" => "`identity(n)` with a number n from 1 to 64, known at build time",
        "rotx" => "`rotx(angle)`, `rotx(c, s)` or `rotx(q)` with an S1 coordinate q",
        "roty" => "`roty(angle)`, `roty(c, s)` or `roty(q)` with an S1 coordinate q",
        "rotz" => "`rotz(angle)`, `rotz(c, s)` or `rotz(q)` with an S1 coordinate q",
        "rpy" => "`rpy(roll, pitch, yaw)` of scalars",
        "axis_angle" => {
            "`axis_angle(axis, angle)` of a unit vector of 3 and a scalar, `axis_angle(axis, c, s)` or `axis_angle(axis, q)` with an S1 coordinate q"
        }
        "rot" => "`rot(q)` of a unit quaternion, scalar first",
        "qmul" => "`qmul(p, q)` of vectors of 4, scalar first",
        "pose" => "`pose(R, p)` of a rotation matrix and a vector of 3",
        "inverse" => "`inverse(P)` of a pose",
        "translation" => "`translation(p)` of a vector of 3",
        "angle" => "`angle(q)` of an S1 coordinate, or of a cosine and a sine in one vector",
        "position" => "`position(f, p)` of a frame and a point of it",
        "velocity" => "`velocity(f, p)` of a frame and a point of it",
        "acceleration" => "`acceleration(f, p)` of a frame and a point of it",
        "angular_velocity" => "`angular_velocity(f)` of a frame",
        "angular_acceleration" => "`angular_acceleration(f)` of a frame",
        name => {
            let name = Function::named(name)?.name();
            return Some(format!("`{name}(a)` of a scalar").into());
        }
    };
    Some(text.into())
}
