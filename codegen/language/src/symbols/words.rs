//! Words of the language that can conflict with names: its functions, with their usage, and its constants.

use crate::algebra::function::Function;
use std::borrow::Cow;

/// Names of functions and constants of the language that descriptions cannot redefine.
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

/// Returns the reserved names of functions and constants. Functions of the algebra that are not listed explicitly come
/// last.
pub fn reserved() -> impl Iterator<Item = &'static str> {
    let table = Function::ALL.iter().map(|function| function.name());
    let further =
        table.filter(|name| !RESERVED.contains(name) && Function::from_name(name).is_some());
    RESERVED.iter().copied().chain(further)
}

/// Functions for the motion of frames. Values may share their names, such as a coordinate named `position`.
pub const FUNCTIONS: [&str; 5] = [
    "position",
    "velocity",
    "acceleration",
    "angular_velocity",
    "angular_acceleration",
];

/// Internal function that joints call to normalize their axis. Its name has blanks, so no description can call it.
pub const AXIS: &str = "the axis of a joint";
/// Internal function that joints call for their placement.
pub const PLACE: &str = "the place of a joint";
/// Internal function that planar joints call for the two directions of their plane, the columns of a 3×2 matrix.
pub const PLANE: &str = "the plane of a joint";

/// Returns whether a function can be evaluated only once the rates of the coordinates are known.
pub fn needs_rates(function: &str) -> bool {
    function == "rate" || FUNCTIONS.contains(&function) && function != "position"
}

/// Functions of the language whose names a description may use for its own values and functions.
const NAMES_OF_ALL: [&str; 2] = ["translation", "angle"];

/// Returns the names of the functions of the language.
pub fn names() -> impl Iterator<Item = &'static str> {
    reserved()
        .chain(FUNCTIONS)
        .chain(NAMES_OF_ALL)
        .filter(|name| usage(name).is_some())
}

/// Returns whether this is the name of a function of the language that a description cannot use for its own functions.
pub fn is_function(name: &str) -> bool {
    usage(name).is_some() && !NAMES_OF_ALL.contains(&name)
        || FUNCTIONS.contains(&name)
        || name == "rate"
}

/// Describes how a function is called.
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
            let name = Function::from_name(name)?.name();
            return Some(format!("`{name}(a)` of a scalar").into());
        }
    };
    Some(text.into())
}
