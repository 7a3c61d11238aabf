//! Turns the names of links and joints into identifiers of the language.
//!
//! Every character other than an ASCII letter, digit or underscore becomes `_`. A name that starts with a digit gets
//! the prefix `n`. A keyword of the language or of Rust, or a name already in use, gets the suffix `_joint`, `_link`
//! or `_loop`, and then `_2`, `_3` and so on. Joints choose first, in the order of the file.

use crate::robot::{Joint, Kind, Robot};
use hamel_language::vocabulary::is_reserved;
use std::collections::BTreeSet;

/// Reserved words in addition to the functions and constants of the language: its statements, connectives and coordinate
/// kinds, names in generated code, and keywords of Rust.
const WORDS: &str = "\
abstract angular_momentum armature as async at await become body box break com const constraint \
continue continuous coord crate cylindrical damper damping dissipation do dyn else energy enum \
extern false final fixed fn follows for force frame free from gen generalized generate gravity if \
impl in inactive inertia input invariant joint kinetic length let limit linear_momentum loop macro \
mass match max_force max_speed mod move moves mut nonholonomic on origin output override param \
particle planar potential prismatic priv pub ref rest return revolute Self self spherical spring \
stabilized start static stiffness struct super system to torque trait true try type typeof universal \
unsafe unsized use virtual when where while wrench yield about cart _ x xi u xi_dot R1 R2 R3 S1 S3 \
SO3 SE3 vec2 vec3 mat3 sym3";

/// Returns whether a name is a reserved word.
fn is_word(name: &str) -> bool {
    is_reserved(name) || WORDS.split(' ').any(|word| word == name)
}

/// Suffixes of the symbols that belong to a joint.
const SUFFIXES: [&str; 10] = [
    "", "_dot", "_tau", "_r", "_r_dot", "_R", "_v", "_w", "_force", "_torque",
];
/// Suffixes of the symbols that belong to a joint with two angles.
const PAIR: [&str; 6] = ["", "_1", "_2", "_1_dot", "_2_dot", "_tau"];
/// Suffixes of the frames of a loop-closing joint.
const ENDS: [&str; 3] = ["", "_1", "_2"];
/// Suffixes of the parameters of a link's body.
const PARAMETERS: [&str; 4] = ["", "_mass", "_com", "_inertia"];

/// Names in the description, by index of the joint, link or loop.
#[derive(Debug)]
pub(crate) struct Names {
    pub(crate) system: String,
    /// Name of the joint of a floating base.
    pub(crate) root: String,
    pub(crate) joints: Vec<String>,
    pub(crate) links: Vec<String>,
    /// Names of loop-closing joints.
    pub(crate) loops: Vec<String>,
}

impl Names {
    /// Chooses all names; `root` is used only if the base floats.
    pub(crate) fn of(robot: &Robot, system: Option<&str>) -> Self {
        let mut taken = Taken::default();
        let root = robot
            .joints
            .iter()
            .any(|joint| joint.name.name == "root_joint");
        // A floating base moves by `root_joint`, unless the robot has a joint of that name.
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

/// Names that are in use, with their suffixes.
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

    /// Picks the first candidate that is free with all its suffixes.
    fn choose(&mut self, name: &str, kind: &str, suffixes: &[&str]) -> String {
        let plain = identifier(name);
        let reserved = is_word(&plain);
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
        // The candidates never run out, so the fallback is never used.
        let chosen = candidates.find(free).unwrap_or(longer);
        self.0
            .extend(suffixes.iter().map(|suffix| format!("{chosen}{suffix}")));
        chosen
    }
}

/// Replaces everything but ASCII letters and digits by `_`; the result starts with a letter or `_`.
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

/// Converts a name to a type name: `so_arm100` becomes `SoArm100`.
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
    if is_word(&joined) {
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
        // The velocity of joint `a` would have the name of another joint, `a_dot`.
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
