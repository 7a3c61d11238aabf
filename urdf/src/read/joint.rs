//! `<joint>`.

use super::xml::{Reader, tag};
use crate::decimal::Decimal;
use crate::robot::{Follows, Joint, Kind, Origin};
use roxmltree::Node;

/// The types of joints, as URDF names them.
const KINDS: [(&str, Kind); 6] = [
    ("fixed", Kind::Fixed),
    ("revolute", Kind::Revolute),
    ("continuous", Kind::Continuous),
    ("prismatic", Kind::Prismatic),
    ("planar", Kind::Planar),
    ("floating", Kind::Floating),
];

/// What stands in a joint.
const ELEMENTS: [&str; 9] = [
    "parent",
    "child",
    "origin",
    "axis",
    "dynamics",
    "limit",
    "mimic",
    "calibration",
    "safety_controller",
];

impl<'a> Reader<'a, '_, '_> {
    /// A joint; `None` where its name or its links cannot be read. What else is wrong with it is an error, and does not hide
    /// what is wrong with the tree.
    pub(super) fn joint(&mut self, node: &Node<'_, 'a>) -> Option<Joint> {
        let name = self.name(node, "name");
        let kind = self.kind(node);
        let [parent, child] = ["parent", "child"].map(|end| {
            let form = format!("<{end} link=\"…\"/>");
            let element = self.required(node, end, &form)?;
            self.name(&element, "link")
        });
        let origin = self.origin(node);
        let axis = self
            .child(node, "axis")
            .map(|element| self.axis(&element, kind));
        let dynamics = self.child(node, "dynamics");
        let [damping, friction] = ["damping", "friction"]
            .map(|name| dynamics.and_then(|element| self.coefficient(&element, name)));
        if let Some(element) = dynamics {
            let known = ["damping", "friction"];
            self.attributes(&element, &known, "add it to the description");
        }
        self.elements(node, &ELEMENTS);
        let limit = self.child(node, "limit");
        if let Some(element) = limit {
            let known = ["lower", "upper", "velocity", "effort"];
            self.attributes(&element, &known, "add it to the description");
        }
        let [lower, upper, velocity, effort] = ["lower", "upper", "velocity", "effort"]
            .map(|name| limit.and_then(|element| self.optional(&element, name)));
        // Positions of the other types have no limits in URDF, whatever the file says.
        let limited = matches!(kind, Some(Kind::Revolute | Kind::Prismatic));
        if let (Some(lower), Some(upper), Some(element)) = (&lower, &upper, limit)
            && limited
            && lower.value > upper.value
        {
            self.errors.push(
                &element.range(),
                format!(
                    "the lower limit {} is above the upper one {}",
                    lower.text, upper.text
                ),
                "exchange them",
            );
        }
        let mimic = self
            .child(node, "mimic")
            .and_then(|element| self.mimic(&element));
        Some(Joint {
            name: name?,
            kind: kind.unwrap_or(Kind::Revolute),
            parent: parent?,
            child: child?,
            origin: origin.unwrap_or_else(Origin::identity),
            axis: axis.flatten(),
            damping,
            friction,
            lower,
            upper,
            velocity,
            effort,
            mimic,
        })
    }

    fn kind(&mut self, node: &Node<'_, 'a>) -> Option<Kind> {
        let attribute = self.attribute(node, "type")?;
        let written = attribute.value().trim();
        let found = KINDS.iter().find(|(name, _)| *name == written);
        if found.is_none() {
            let names = KINDS.map(|(name, _)| name).join(", ");
            self.errors.push(
                &attribute.range_value(),
                format!("`{written}` is not a type of joint"),
                format!("URDF has {names}"),
            );
        }
        found.map(|(_, kind)| *kind)
    }

    /// A direction; it need not have length 1.
    fn axis(&mut self, element: &Node<'_, 'a>, kind: Option<Kind>) -> Option<[Decimal; 3]> {
        let attribute = self.attribute(element, "xyz")?;
        let mut axis = self.vector(&attribute)?;
        self.clean(&mut axis, &attribute.range_value(), 0.0);
        let needed = !matches!(kind, Some(Kind::Fixed | Kind::Floating));
        if needed && axis.iter().all(Decimal::is_zero) {
            self.errors.push(
                &attribute.range_value(),
                "the axis is zero",
                "write a direction in the axes of the joint, as in `0 0 1`",
            );
            return None;
        }
        Some(axis)
    }

    /// A number of `<dynamics>`, not negative.
    fn coefficient(&mut self, element: &Node<'_, 'a>, name: &str) -> Option<Decimal> {
        let number = self.optional(element, name)?;
        if number.value < 0.0 {
            let range = element
                .attribute_node(name)
                .map(|value| value.range_value());
            self.errors.push(
                &range.unwrap_or_else(|| tag(self.text, element)),
                format!("the {name} {} is negative", number.text),
                "a joint that dissipates energy has a positive one",
            );
            return None;
        }
        (!number.is_zero()).then_some(number)
    }

    fn mimic(&mut self, element: &Node<'_, 'a>) -> Option<Follows> {
        let known = ["joint", "multiplier", "offset"];
        self.attributes(element, &known, "it is `multiplier` · source + `offset`");
        let source = self.name(element, "joint");
        let multiplier = match element.attribute_node("multiplier") {
            Some(_) => self.optional(element, "multiplier"),
            None => Some(Decimal::one()),
        };
        let offset = match element.attribute_node("offset") {
            Some(_) => self.optional(element, "offset"),
            None => Some(Decimal::zero()),
        };
        Some(Follows {
            source: source?,
            multiplier: multiplier?,
            offset: offset?,
        })
    }
}
