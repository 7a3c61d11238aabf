//! Reads connections between links outside the tree: loop-closing joints, and springs between points.

use super::xml::{Reader, tag, written};
use crate::decimal::Decimal;
use crate::robot::{Closing, End, Link, Loop, Named, Origin, Spring};
use crate::tree::unknown;
use roxmltree::Node;

/// Drake's elements for a ball joint that closes a loop, and for a spring with damper between points.
const BALL: &str = "drake:ball_constraint";
const SPRING: &str = "drake:linear_spring_damper";

impl<'a> Reader<'a, '_, '_> {
    /// Reads a `<loop_joint>` of a supported type.
    pub(super) fn loop_joint(&mut self, node: &Node<'_, 'a>, links: &[Link]) -> Option<Loop> {
        let range = tag(self.text, node);
        let ends = ["link1", "link2"].map(|end| self.child(node, end));
        let written = node.attribute("type").map_or("revolute", str::trim);
        let axis = match self.child(node, "axis") {
            Some(element) => self.direction(&element)?,
            // URDF's default.
            None => [Decimal::one(), Decimal::zero(), Decimal::zero()],
        };
        let closing = match written {
            "revolute" | "continuous" => Closing::Revolute(axis),
            "prismatic" => Closing::Prismatic(axis),
            "spherical" | "ball" => Closing::Spherical,
            "fixed" | "weld" => Closing::Fixed,
            _ => {
                self.note(
                    range,
                    format!("a `<loop_joint>` of the type `{written}` is left out"),
                    "the types that are read are revolute, prismatic, spherical and fixed; for others add a `loop` to the description".to_string(),
                );
                return None;
            }
        };
        let [Some(first), Some(second)] = ends else {
            self.note(
                range,
                "a `<loop_joint>` without `<link1>` and `<link2>` is left out".to_string(),
                "add a `loop` to the description".to_string(),
            );
            return None;
        };
        let name = self.name(node, "name")?;
        let [first, second] = [first, second].map(|element| {
            let link = self.linked(&element, "link", links);
            let origin = self.pose(&element);
            Some(End {
                link: link?,
                origin: origin?,
            })
        });
        self.note(
            range,
            "`<loop_joint>` is not part of URDF; it is read as a joint that closes a loop"
                .to_string(),
            "other programs may ignore it".to_string(),
        );
        Some(Loop {
            name,
            closing,
            ends: [first?, second?],
        })
    }

    /// Reads a `<drake:ball_constraint>`: two points coincide.
    pub(super) fn ball(&mut self, node: &Node<'_, 'a>, links: &[Link]) -> Option<Loop> {
        let ends = self.points(node, BALL, links)?;
        let range = tag(self.text, node);
        self.note(
            range.clone(),
            format!("`<{BALL}>` is not part of URDF; it is read as a joint that closes a loop"),
            "other programs may ignore it".to_string(),
        );
        let name = "ball_constraint".to_string();
        Some(Loop {
            name: Named { name, range },
            closing: Closing::Spherical,
            ends,
        })
    }

    /// Reads a `<drake:linear_spring_damper>`: a spring and a damper between two points.
    pub(super) fn spring(&mut self, node: &Node<'_, 'a>, links: &[Link]) -> Option<Spring> {
        let ends = self.points(node, SPRING, links);
        let [length, stiffness, damping] = ["free_length", "stiffness", "damping"].map(|name| {
            let name = format!("{SPRING}_{name}");
            let form = format!("<{name} value=\"…\"/>");
            let element = self.required(node, &name, &form)?;
            self.number(&element, "value")
        });
        let range = tag(self.text, node);
        self.note(
            range.clone(),
            format!("`<{SPRING}>` is not part of URDF; it is read as a spring and a damper"),
            "other programs may ignore it".to_string(),
        );
        Some(Spring {
            range,
            ends: ends?,
            length: length?,
            stiffness: stiffness?,
            damping: damping?,
        })
    }

    /// Reads the points on two links that Drake's elements name.
    fn points(&mut self, node: &Node<'_, 'a>, element: &str, links: &[Link]) -> Option<[End; 2]> {
        let ends = [("body_A", "p_AP"), ("body_B", "p_BQ")].map(|(body, point)| {
            let (body, point) = (format!("{element}_{body}"), format!("{element}_{point}"));
            let form = format!("<{body} name=\"…\"/>");
            let body = self.required(node, &body, &form);
            let link = body.and_then(|body| self.linked(&body, "name", links));
            let form = format!("<{point} value=\"0 0 0\"/>");
            let point = self.required(node, &point, &form)?;
            let position = self.attribute(&point, "value")?;
            let position = self.vector(&position)?;
            let origin = Origin {
                position,
                ..Origin::identity()
            };
            Some(End {
                link: link?,
                origin,
            })
        });
        let [first, second] = ends;
        Some([first?, second?])
    }

    /// Reads the name of a link, which must belong to this robot.
    fn linked(&mut self, node: &Node<'_, 'a>, attribute: &str, links: &[Link]) -> Option<Named> {
        let link = self.name(node, attribute)?;
        let names = || links.iter().map(|link| link.name.name.as_str());
        if names().any(|name| name == link.name) {
            return Some(link);
        }
        unknown("link", &link, names(), self.errors);
        None
    }

    /// Reads the `<axis xyz>` of a loop-closing joint.
    fn direction(&mut self, element: &Node<'_, 'a>) -> Option<[Decimal; 3]> {
        let attribute = self.attribute(element, "xyz")?;
        let axis = self.vector(&attribute)?;
        if axis.iter().all(Decimal::is_zero) {
            self.errors.push(
                &attribute.range_value(),
                "the axis is zero",
                "write a direction in the axes of the joint, as in `0 0 1`",
            );
            return None;
        }
        Some(axis)
    }

    /// Reads the connections outside the tree, and the joint properties that dialects keep outside `<joint>`.
    pub(super) fn beside(&mut self, root: &Node<'_, 'a>, robot: &mut crate::robot::Robot) {
        for element in root.children().filter(Node::is_element) {
            match written(self.text, &element) {
                "loop_joint" => robot.loops.extend(self.loop_joint(&element, &robot.links)),
                BALL => robot.loops.extend(self.ball(&element, &robot.links)),
                SPRING => robot.springs.extend(self.spring(&element, &robot.links)),
                "transmission" => self.transmission(&element, &mut robot.joints),
                "gazebo" => self.gazebo(&element, &mut robot.joints),
                "ros2_control" => {
                    let text = self.text;
                    let all = element.children().filter(Node::is_element);
                    for part in all.filter(|part| written(text, part) == "transmission") {
                        self.transmission(&part, &mut robot.joints);
                    }
                }
                _ => {}
            }
        }
    }
}
