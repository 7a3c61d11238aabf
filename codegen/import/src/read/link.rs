//! Reads `<link>` and `<inertial>`.

use super::xml::{Reader, tag};
use crate::robot::{Inertial, Link};
use roxmltree::Node;

const INERTIA: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

impl<'a> Reader<'a, '_, '_> {
    /// Reads a link; `None` if it has no name.
    pub(super) fn link(&mut self, node: &Node<'_, 'a>) -> Option<Link> {
        let name = self.name(node, "name");
        let inertial = self
            .child(node, "inertial")
            .and_then(|inertial| self.inertial(&inertial));
        Some(Link {
            name: name?,
            inertial,
        })
    }

    fn inertial(&mut self, node: &Node<'_, 'a>) -> Option<Inertial> {
        let origin = self.origin(node);
        let mass = self
            .required(node, "mass", "<mass value=\"…\"/>")
            .and_then(|mass| {
                let number = self.number(&mass, "value")?;
                if number.value < 0.0 {
                    let range = mass
                        .attribute_node("value")
                        .map(|value| value.range_value());
                    self.errors.push(
                        &range.unwrap_or_else(|| tag(self.text, &mass)),
                        format!("the mass {} is negative", number.text),
                        "masses are positive numbers of kilograms",
                    );
                    return None;
                }
                Some(number)
            });
        let form = "<inertia ixx=\"…\" ixy=\"…\" ixz=\"…\" iyy=\"…\" iyz=\"…\" izz=\"…\"/>";
        let element = self.required(node, "inertia", form);
        let inertia = element.and_then(|element| {
            let entries = INERTIA.map(|name| self.number(&element, name));
            let [Some(xx), Some(xy), Some(xz), Some(yy), Some(yz), Some(zz)] = entries else {
                return None;
            };
            let mut entries = [xx, xy, xz, yy, yz, zz];
            let range = element.range();
            self.clean(&mut entries, &range, 0.0);
            Some((entries, range))
        });
        let (inertia, inertia_range) = inertia?;
        Some(Inertial {
            range: tag(self.text, node),
            mass: mass?,
            origin: origin?,
            inertia,
            inertia_range,
        })
    }
}
