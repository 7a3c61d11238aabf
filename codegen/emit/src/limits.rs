//! Joint limits as constants of the generated type: they document the machine, and no function uses
//! them.

use super::names::{UniqueNames, to_snake_case};
use super::number::literal;
use hamel_language::model::joints::Joint;
use hamel_language::syntax::ast::JointKind;
use hamel_program::Program;

/// A limit of a joint's position, speed or force, generated as a documented constant.
pub struct JointLimit {
    /// Name of the constant.
    pub name: String,
    /// Text of its doc comment.
    pub title: String,
    /// One number, or the lower and the upper limit.
    pub values: Vec<f64>,
}

/// Returns the limits of all joints of a program, in the order of its joints.
pub fn joint_limits(program: &Program) -> Vec<JointLimit> {
    let mut names = UniqueNames::default();
    let mut all = Vec::new();
    for joint in &program.joints {
        let mut push = |ending: &str, what: String, values: Vec<f64>| {
            let wanted = format!("{}_{ending}", to_snake_case(&joint.name)).to_ascii_uppercase();
            all.push(JointLimit {
                name: names.claim(&wanted),
                title: format!("Joint `{}`: {what}.", joint.name),
                values,
            });
        };
        let [place, speed, force] = units(joint);
        if let Some([lower, upper]) = joint.limit {
            let what = format!("its smallest and largest coordinate ({place})");
            push("LIMIT", what, vec![lower, upper]);
        }
        if let Some(most) = joint.max_speed {
            let what = format!("the largest size of its velocity ({speed})");
            push("MAX_SPEED", what, vec![most]);
        }
        if let Some(most) = joint.max_force {
            let what = format!("the largest size of its force ({force})");
            push("MAX_FORCE", what, vec![most]);
        }
    }
    all
}

/// Prints joint limits (position, speed, force) as associated constants of Rust, such as `pub const ELBOW_LIMIT: [f64;
/// 2] = [-2.0, 2.0];`.
pub fn limit_constants(program: &Program) -> String {
    let constant = |limit: JointLimit| {
        let (kind, value) = match limit.values.as_slice() {
            &[lower, upper] => (
                "[f64; 2]",
                format!("[{}, {}]", literal(lower), literal(upper)),
            ),
            values => ("f64", values.iter().map(|&value| literal(value)).collect()),
        };
        let JointLimit { name, title, .. } = limit;
        format!("/// {title}\npub const {name}: {kind} = {value};\n\n")
    };
    joint_limits(program).into_iter().map(constant).collect()
}

/// Units of coordinate, velocity and force of a joint.
fn units(joint: &Joint) -> [&'static str; 3] {
    match joint.kind {
        JointKind::Prismatic => ["m", "m/s", "N"],
        _ => ["rad", "rad/s", "N m"],
    }
}
