//! The limits of joints, as constants of the type: they document the machine, and no function uses
//! them.

use super::names::{Unique, snake};
use super::number::literal;
use crate::model::joints::Joint;
use crate::program::Program;
use crate::syntax::ast::JointKind;

/// `pub const ELBOW_LIMIT: [f64; 2] = [-2.0, 2.0];` and the like.
pub fn constants(program: &Program) -> String {
    let mut names = Unique::default();
    let mut text = String::new();
    for joint in &program.joints {
        let mut constant = |ending: &str, what: String, kind: &str, value: String| {
            let wanted = format!("{}_{ending}", snake(&joint.name)).to_ascii_uppercase();
            let name = names.claim(&wanted);
            let title = format!("Joint `{}`: {what}.", joint.name);
            text.push_str(&format!(
                "/// {title}\npub const {name}: {kind} = {value};\n\n"
            ));
        };
        let [place, speed, force] = units(joint);
        if let Some([lower, upper]) = joint.limit {
            let value = format!("[{}, {}]", literal(lower), literal(upper));
            let what = format!("its smallest and largest coordinate ({place})");
            constant("LIMIT", what, "[f64; 2]", value);
        }
        if let Some(most) = joint.max_speed {
            let what = format!("the largest size of its velocity ({speed})");
            constant("MAX_SPEED", what, "f64", literal(most));
        }
        if let Some(most) = joint.max_force {
            let what = format!("the largest size of its force ({force})");
            constant("MAX_FORCE", what, "f64", literal(most));
        }
    }
    text
}

/// Units of the coordinate, the velocity and the force of a joint.
fn units(joint: &Joint) -> [&'static str; 3] {
    match joint.kind {
        JointKind::Prismatic => ["m", "m/s", "N"],
        _ => ["rad", "rad/s", "N m"],
    }
}
