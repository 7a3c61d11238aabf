//! Reads joint properties that dialects of URDF keep elsewhere: rotor inertias in `<transmission>`, springs in
//! `<gazebo>`.

use super::schema::{RATIOS, ROTORS};
use super::xml::{Reader, tag, written};
use crate::decimal::Decimal;
use crate::robot::{Joint, Kind, Named};
use crate::tree::unknown;
use roxmltree::Node;

/// Suffix of the types of transmissions with one joint and one actuator.
const SIMPLE: &str = "SimpleTransmission";
/// Prefix of the names that Drake defines.
const DRAKE: &str = "drake:";

impl<'a> Reader<'a, '_, '_> {
    /// Reads the rotor inertias of a transmission. Reflected to the joint, a rotor has inertia · ratio².
    pub(super) fn transmission(&mut self, node: &Node<'_, 'a>, joints: &mut [Joint]) {
        let text = self.text;
        let all = |name: &str| -> Vec<Node<'_, 'a>> {
            let children = node.children().filter(Node::is_element);
            children
                .filter(|child| written(text, child) == name)
                .collect()
        };
        let (driven, actuators) = (all("joint"), all("actuator"));
        for part in driven.iter().chain(&actuators) {
            let rotors = part
                .children()
                .filter(|child| child.is_element() && ROTORS.contains(&written(text, child)));
            for rotor in rotors {
                let name = written(text, &rotor);
                let Some(inertia) = self.said(&rotor) else {
                    continue;
                };
                if inertia.is_zero() {
                    continue;
                }
                let range = tag(text, &rotor);
                let kinds = [all("type"), all("plugin")].concat();
                let kind = kinds.first().and_then(Node::text).map(str::to_string);
                let kind = kind.or_else(|| node.attribute("type").map(str::to_string));
                let simple = kind.is_none_or(|kind| kind.trim().ends_with(SIMPLE));
                let (true, [moved], [drive]) = (simple, driven.as_slice(), actuators.as_slice())
                else {
                    self.note(
                        range,
                        format!(
                            "`<{name}>` of a transmission with several joints or drives is left out"
                        ),
                        "add the energy of the rotor to the description as an `inerter`"
                            .to_string(),
                    );
                    continue;
                };
                let Some(joint) = self.name(moved, "name") else {
                    continue;
                };
                let Some(ratio) = self.ratio(&rotor, &[*drive, *moved, *node]) else {
                    continue;
                };
                self.rotor(&rotor, &joint, (inertia, ratio), joints);
            }
        }
    }

    /// Reads the gear ratio of a rotor. A missing ratio is 1 in Drake; elsewhere it is unknown, and the rotor is left
    /// out.
    fn ratio(&mut self, rotor: &Node<'_, 'a>, around: &[Node<'_, 'a>]) -> Option<Decimal> {
        let text = self.text;
        let name = written(text, rotor);
        let drake = name.starts_with(DRAKE);
        let names = match drake {
            true => &RATIOS[..1],
            false => &RATIOS[..],
        };
        let found = around.iter().find_map(|part| {
            let mut children = part.children().filter(Node::is_element);
            children.find(|child| names.contains(&written(text, child)))
        });
        match found {
            Some(element) => self.said(&element),
            None if drake => Some(Decimal::one()),
            None => {
                self.note(
                    tag(text, rotor),
                    format!("`<{name}>` without a gear ratio is left out"),
                    "add the ratio, as in `<gear_ratio>100</gear_ratio>`".to_string(),
                );
                None
            }
        }
    }

    /// Adds a rotor to its joint.
    fn rotor(
        &mut self,
        element: &Node<'_, 'a>,
        joint: &Named,
        (inertia, ratio): (Decimal, Decimal),
        joints: &mut [Joint],
    ) {
        let name = written(self.text, element);
        let range = tag(self.text, element);
        if inertia.value < 0.0 {
            let message = format!("the inertia {} is negative", inertia.text);
            let help = "a rotor has a positive inertia";
            return self.errors.push(&range, message, help);
        }
        let Some(found) = self.driven(name, &range, joint, joints) else {
            return;
        };
        self.note(
            range,
            format!(
                "`<{name}>` is not part of URDF; it gives `{}` the armature {} · {}²",
                joint.name,
                inertia.text,
                ratio.text.trim_start_matches('-')
            ),
            "other programs may ignore it".to_string(),
        );
        found.rotors.push((inertia, ratio));
    }

    /// Finds the joint that an element refers to. Notes that the element is left out if the joint has no single angle
    /// or length, unless the joint is fixed and the element is not a spring.
    fn driven<'j>(
        &mut self,
        element: &str,
        range: &std::ops::Range<usize>,
        joint: &Named,
        joints: &'j mut [Joint],
    ) -> Option<&'j mut Joint> {
        if joints.iter().all(|other| other.name.name != joint.name) {
            let names = joints.iter().map(|joint| joint.name.name.as_str());
            unknown("joint", joint, names, self.warnings);
            return None;
        }
        let mut joints = joints.iter_mut();
        let found = joints.find(|other| other.name.name == joint.name)?;
        if found.kind.is_single() {
            return Some(found);
        }
        if found.kind != Kind::Fixed || element == SPRING {
            self.note(
                range.clone(),
                format!("`<{element}>` of a joint without a single angle or length is left out"),
                "add it to the description".to_string(),
            );
        }
        None
    }

    /// Reads the spring k (q − q₀) that Gazebo may add to a joint.
    pub(super) fn gazebo(&mut self, node: &Node<'_, 'a>, joints: &mut [Joint]) {
        let Some(element) = self.child(node, SPRING) else {
            return;
        };
        let Some(stiffness) = self.said(&element).filter(|number| !number.is_zero()) else {
            return;
        };
        let rest = match self.child(node, "springReference") {
            Some(reference) => self.said(&reference),
            None => Some(Decimal::zero()),
        };
        let (Some(rest), Some(joint)) = (rest, self.name(node, "reference")) else {
            return;
        };
        let range = tag(self.text, &element);
        let Some(found) = self.driven(SPRING, &range, &joint, joints) else {
            return;
        };
        self.note(
            range,
            format!(
                "`<{SPRING}>` is not part of URDF; it gives `{}` a spring",
                joint.name
            ),
            "other programs may ignore it".to_string(),
        );
        found.spring = Some((stiffness, rest));
    }

    /// Reads the number of an element, from its attribute `value` or from its text.
    pub(super) fn said(&mut self, element: &Node<'_, 'a>) -> Option<Decimal> {
        if element.has_attribute("value") {
            return self.number(element, "value");
        }
        let number = element.text().unwrap_or("").trim().to_string();
        let range = tag(self.text, element);
        self.decimal(&number, &range)
    }
}

/// Gazebo's element for the stiffness of a joint.
const SPRING: &str = "springStiffness";
