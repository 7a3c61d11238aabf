//! Names of links and joints as identifiers of the language.
//!
//! What is no letter, digit or underscore becomes `_`; a name that starts with a digit gets `n`
//! before it; a word of the language, a name of Rust's, or one that is taken gets `_joint` or
//! `_link` after it, and then `_2`, `_3` and so on. Joints choose first, in the order of the file.

use crate::robot::{Joint, Kind, Robot};
use std::collections::BTreeSet;

/// Words that name nothing, or something else: statements, connectives, functions, constants of
/// the language, and keywords of Rust.
const WORDS: &str = "\
abs abstract acceleration acos angular_acceleration angular_momentum angular_velocity armature as \
asin async at atan atan2 await axis_angle become body box break clamp com const constraint continue \
continuous coord cos cosh crate cross cylindrical damper damping diag dissipation do dot dyn else \
energy enum exp extern false final fixed fn follows for force frame free from gen generalized \
generate gravity hat hypot identity if impl in inactive inertia input invariant inverse joint \
kinetic length let limit linear_momentum log loop macro mass match max max_force max_speed min mod \
move moves mut nonholonomic norm on origin outer output override param particle pi planar pose \
position potential prismatic priv pub qmul rate ref rest return revolute rot rotx roty rotz rpy \
Self self sign sin sinh spherical spring sqrt stabilized start static stiffness struct super \
system tan tanh to torque trace trait transpose true try type typeof universal unsafe unsized use \
vee velocity virtual when where while world wrench yield about cart _ x xi u xi_dot R1 R2 R3 S1 S3 \
SO3 SE3 vec2 vec3 mat3 sym3";

/// What the symbols that belong to a joint add to its name.
const SUFFIXES: [&str; 10] = [
    "", "_dot", "_tau", "_r", "_r_dot", "_R", "_v", "_w", "_force", "_torque",
];
/// The same of a joint with two angles.
const PAIR: [&str; 6] = ["", "_1", "_2", "_1_dot", "_2_dot", "_tau"];
/// What the frames of a closing joint add to its name.
const ENDS: [&str; 3] = ["", "_1", "_2"];
/// What the parameters of a body add to its link's name.
const PARAMETERS: [&str; 4] = ["", "_mass", "_com", "_inertia"];

/// Names in the description, by index of joint and link.
#[derive(Debug)]
pub(crate) struct Names {
    pub(crate) system: String,
    /// The joint of a floating base.
    pub(crate) root: String,
    pub(crate) joints: Vec<String>,
    pub(crate) links: Vec<String>,
    /// Closing joints.
    pub(crate) loops: Vec<String>,
}

impl Names {
    /// Chooses all names; the root link's own is needed where the base floats.
    pub(crate) fn of(robot: &Robot, system: Option<&str>) -> Self {
        let mut taken = Taken::default();
        let root = robot
            .joints
            .iter()
            .any(|joint| joint.name.name == "root_joint");
        // A floating base is `root_joint`, unless the robot has one already.
        let root_first = (!root).then(|| taken.choose("root_joint", "_joint", &SUFFIXES));
        let joints = robot.joints.iter();
        let joints: Vec<String> = joints.map(|joint| taken.joint(joint)).collect();
        let root = match root_first {
            Some(root) => root,
            None => taken.choose("root_joint", "_joint", &SUFFIXES),
        };
        let links = robot.links.iter();
        let links = links
            .map(|link| taken.choose(&link.name.name, "_link", &PARAMETERS))
            .collect();
        let loops = robot.loops.iter();
        let loops = loops
            .map(|closing| taken.choose(&closing.name.name, "_loop", &ENDS))
            .collect();
        let system = camel(system.unwrap_or(&robot.name));
        Names {
            system,
            root,
            joints,
            links,
            loops,
        }
    }
}

/// Names that are in use.
#[derive(Default)]
struct Taken(BTreeSet<String>);

impl Taken {
    fn joint(&mut self, joint: &Joint) -> String {
        let suffixes: &[&str] = match joint.kind {
            Kind::Fixed => &SUFFIXES[..1],
            Kind::Universal => &PAIR,
            _ => &SUFFIXES,
        };
        self.choose(&joint.name.name, "_joint", suffixes)
    }

    /// The first name that is free with all its suffixes.
    fn choose(&mut self, name: &str, kind: &str, suffixes: &[&str]) -> String {
        let plain = identifier(name);
        let reserved = WORDS.split(' ').any(|word| word == plain);
        let longer = format!("{plain}{kind}");
        let first = (!reserved).then(|| plain.clone());
        let mut candidates = first
            .into_iter()
            .chain(std::iter::once(longer.clone()))
            .chain((2..).map(|number: u64| format!("{longer}_{number}")));
        let free = |candidate: &String| {
            suffixes
                .iter()
                .all(|suffix| !self.0.contains(&format!("{candidate}{suffix}")))
        };
        // The numbers do not end.
        let chosen = candidates.find(free).unwrap_or(longer);
        self.0
            .extend(suffixes.iter().map(|suffix| format!("{chosen}{suffix}")));
        chosen
    }
}

/// Letters, digits and underscores, a letter first.
fn identifier(name: &str) -> String {
    let plain: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
        .collect();
    let digit = plain.starts_with(|c: char| c.is_ascii_digit());
    if digit || plain.chars().all(|c| c == '_') {
        format!("n{plain}")
    } else {
        plain
    }
}

/// `so_arm100` as `SoArm100`.
fn camel(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric());
    let joined: String = words
        .map(|word| {
            let mut letters = word.chars();
            let first = letters.next().map(|first| first.to_ascii_uppercase());
            first.into_iter().chain(letters).collect::<String>()
        })
        .collect();
    if joined.is_empty() || joined.starts_with(|c: char| c.is_ascii_digit()) {
        return format!("Robot{joined}");
    }
    if WORDS.split(' ').any(|word| word == joined) {
        return format!("{joined}Robot");
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::{Taken, camel};

    #[test]
    fn names_are_identifiers_and_differ() {
        let mut taken = Taken::default();
        let mut choose = |name: &str, kind: &str| taken.choose(name, kind, &["", "_dot"]);
        assert_eq!(choose("iris__/imu joint", "_joint"), "iris___imu_joint");
        assert_eq!(choose("elbow", "_joint"), "elbow");
        assert_eq!(choose("elbow", "_link"), "elbow_link");
        assert_eq!(choose("elbow", "_link"), "elbow_link_2");
        // Its velocity would be taken for another joint.
        assert_eq!(choose("a_dot", "_joint"), "a_dot");
        assert_eq!(choose("a", "_joint"), "a_joint");
        assert_eq!(choose("body", "_link"), "body_link");
        assert_eq!(choose("2nd", "_link"), "n2nd");
    }

    #[test]
    fn systems_have_names_of_types() {
        let names = ["ur5", "so_arm100", "2-link", "Self", ""].map(camel);
        assert_eq!(
            names,
            ["Ur5", "SoArm100", "Robot2Link", "SelfRobot", "Robot"]
        );
    }
}
