//! Notes plugins of Gazebo that move joints or push links: they are programs, which cannot be imported.

use super::xml::{Reader, tag, written};
use crate::robot::Joint;
use roxmltree::Node;

/// Parts of the names of plugins that apply forces.
const FORCES: [&str; 14] = [
    "lift",
    "drag",
    "buoyan",
    "hydrodynamic",
    "wind",
    "thruster",
    "motor_model",
    "multicopter",
    "propeller",
    "rotor",
    "wheel_slip",
    "wheelslip",
    "spring",
    "damper",
];
/// Elements naming a joint that a plugin couples to another one.
const TIED: [&str; 2] = ["mimicJoint", "virtualJoint"];

impl<'a> Reader<'a, '_, '_> {
    /// Notes the plugins that change the motion, recognized by their names and by the joints that they couple.
    pub(super) fn plugins(&mut self, root: &Node<'_, 'a>, joints: &[Joint]) {
        let text = self.text;
        let named =
            |node: &Node<'_, 'a>, name: &str| node.is_element() && written(text, node) == name;
        let extensions = root.children().filter(|node| named(node, "gazebo"));
        for plugin in extensions.flat_map(|node| node.children()) {
            if !named(&plugin, "plugin") {
                continue;
            }
            let file = plugin.attribute("filename").or(plugin.attribute("name"));
            let file = file.unwrap_or("").trim();
            let small = file.to_lowercase();
            let follows = |name: &str| {
                let mut joints = joints.iter();
                joints.any(|joint| joint.name.name == name && joint.mimic.is_some())
            };
            let ties = plugin.children().any(|part| {
                let name = match part.children().find(|child| named(child, "name")) {
                    Some(name) => name.text(),
                    None => part.text(),
                };
                TIED.iter().any(|tie| named(&part, tie))
                    && !name.is_some_and(|name| follows(name.trim()))
            });
            let pushes = FORCES.iter().any(|part| small.contains(part));
            let does = match (pushes, ties) {
                (true, _) => "acts with forces",
                (false, true) => "ties joints that do not mimic another joint",
                (false, false) => continue,
            };
            self.note(
                tag(text, &plugin),
                format!("the plugin `{file}` {does} and is left out"),
                "add its effect to the description".to_string(),
            );
        }
    }
}
