//! Reads `<joint>` and `<drake:joint>`.

use super::xml::{Reader, tag, written};
use crate::decimal::Decimal;
use crate::robot::{Follows, Joint, Kind, Origin};
use roxmltree::Node;

/// Drake's element for joints that URDF does not have; their axes are those of the joint's frame.
const DRAKE: &str = "drake:joint";

/// Types of joints in URDF.
const KINDS: [(&str, Kind); 6] = [
    ("fixed", Kind::Fixed),
    ("revolute", Kind::Revolute),
    ("continuous", Kind::Continuous),
    ("prismatic", Kind::Prismatic),
    ("planar", Kind::Planar),
    ("floating", Kind::Floating),
];

/// Types of joints in dialects: those of Bullet, SDF, MuJoCo and Drake.
const OTHERS: [(&str, Kind); 3] = [
    ("spherical", Kind::Spherical),
    ("ball", Kind::Spherical),
    ("universal", Kind::Universal),
];

impl<'a> Reader<'a, '_, '_> {
    /// Reads a joint; `None` if its name or its links cannot be read. Other errors do not drop the joint, so that
    /// errors of the tree are still found.
    pub(super) fn joint(&mut self, node: &Node<'_, 'a>) -> Option<Joint> {
        let name = self.name(node, "name");
        let drake = written(self.text, node) == DRAKE;
        let kind = self.kind(node, drake);
        let [parent, child] = ["parent", "child"].map(|end| {
            let form = format!("<{end} link=\"…\"/>");
            let element = self.required(node, end, &form)?;
            self.name(&element, "link")
        });
        let origin = self.origin(node);
        let written_axis = self.child(node, "axis");
        let mut axis = written_axis.map(|element| self.axis(&element, kind));
        if drake && kind == Some(Kind::Planar) {
            axis = Some(Some(self.normal(written_axis, axis.flatten())));
        }
        let dynamics = self.child(node, "dynamics");
        let properties = self.child(node, "joint_properties");
        let [damping, friction] =
            ["damping", "friction"].map(|name| self.dissipation(dynamics, properties, name, kind));
        let armature = dynamics.and_then(|element| self.armature(&element));
        let limit = self.child(node, "limit");
        let [lower, upper, velocity, effort] = ["lower", "upper", "velocity", "effort"]
            .map(|name| limit.and_then(|element| self.bound(&element, name)));
        // In URDF only revolute and prismatic joints have limits of position, whatever the file says.
        let limited = matches!(kind, Some(Kind::Revolute | Kind::Prismatic));
        if let (Some(lower), Some(upper), Some(element)) = (&lower, &upper, limit)
            && limited
            && lower.value > upper.value
        {
            self.warnings.push(
                &element.range(),
                format!(
                    "the lower limit {} is above the upper one {}: both are left out",
                    lower.text, upper.text
                ),
                "swap them; they do not enter the equations",
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
            rotors: armature.into_iter().collect(),
            spring: None,
        })
    }

    fn kind(&mut self, node: &Node<'_, 'a>, drake: bool) -> Option<Kind> {
        let attribute = self.attribute(node, "type")?;
        let written = attribute.value().trim();
        let listed = |list: &[(&str, Kind)]| {
            let found = list.iter().find(|(name, _)| *name == written);
            found.map(|(_, kind)| *kind)
        };
        let known = listed(&KINDS);
        // Only Drake defines the axes of a universal joint.
        let other = listed(&OTHERS).filter(|&kind| drake || kind != Kind::Universal);
        if known.is_none() && other.is_none() {
            let names = KINDS.map(|(name, _)| name).join(", ");
            self.errors.push(
                &attribute.range_value(),
                format!("`{written}` is not a type of joint"),
                format!("URDF has {names}; `spherical` and `ball` are also read"),
            );
        } else if known.is_none() || drake {
            let read = match (known, other) {
                (None, Some(Kind::Universal)) => "as one about x and then about the turned y",
                (None, _) => "as one that turns freely about a point",
                _ => "as the joint of that type in URDF",
            };
            let named = match drake {
                true => format!("`<{DRAKE} type=\"{written}\">`"),
                false => format!("the type `{written}`"),
            };
            self.note(
                attribute.range_value(),
                format!("{named} is not part of URDF; it is read {read}"),
                "other programs may read the file differently".to_string(),
            );
        }
        known.or(other)
    }

    /// Reads an axis, which need not have unit length.
    fn axis(&mut self, element: &Node<'_, 'a>, kind: Option<Kind>) -> Option<[Decimal; 3]> {
        let attribute = self.attribute(element, "xyz")?;
        let mut axis = self.vector(&attribute)?;
        self.clean(&mut axis, &attribute.range_value(), 0.0);
        let needed = !matches!(
            kind,
            Some(Kind::Fixed | Kind::Floating | Kind::Spherical | Kind::Universal)
        );
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

    /// Returns the normal of Drake's planar joints: always z, with a note if the file says otherwise.
    fn normal(
        &mut self,
        element: Option<Node<'_, 'a>>,
        axis: Option<[Decimal; 3]>,
    ) -> [Decimal; 3] {
        if let (Some(element), Some([x, y, z])) = (element, axis)
            && !(x.is_zero() && y.is_zero() && z.value > 0.0)
        {
            self.note(
                tag(self.text, &element),
                format!("the axis of a planar `<{DRAKE}>` is the z axis; this one is left out"),
                "turn the joint by its `<origin>`".to_string(),
            );
        }
        [Decimal::zero(), Decimal::zero(), Decimal::one()]
    }

    /// Reads damping or friction from `<dynamics>`, or else from its predecessor `<joint_properties>`.
    fn dissipation(
        &mut self,
        dynamics: Option<Node<'_, 'a>>,
        properties: Option<Node<'_, 'a>>,
        name: &str,
        kind: Option<Kind>,
    ) -> Option<Decimal> {
        if name == "damping" && matches!(kind, Some(Kind::Planar | Kind::Floating)) {
            return self.several(dynamics.or(properties)?);
        }
        let read = dynamics.and_then(|element| self.coefficient(&element, name));
        let old = properties.and_then(|element| self.coefficient(&element, name));
        let range = |element: Option<Node<'_, 'a>>| {
            let attribute = element.and_then(|element| element.attribute_node(name));
            attribute.map_or(0..0, |attribute| attribute.range())
        };
        let from_old = dynamics.is_none_or(|element| !element.has_attribute(name));
        let (number, range) = match from_old {
            true => (old, range(properties)),
            false => {
                if old.is_some() {
                    self.note(
                        range(properties),
                        format!(
                            "`{name}` of `<joint_properties>` is left out: `<dynamics>` also has it"
                        ),
                        "remove one of them".to_string(),
                    );
                }
                (read, range(dynamics))
            }
        };
        let number = number?;
        let kind = kind?;
        if name == "friction" && kind != Kind::Fixed {
            self.note(
                range,
                "Coulomb friction is not modelled and is left out".to_string(),
                "add it to the description as a `generalized force`".to_string(),
            );
        } else if from_old && kind != Kind::Fixed {
            self.note(
                range,
                format!("`{name}` of `<joint_properties>` is not part of URDF; it is read as that of `<dynamics>`"),
                format!("write `<dynamics {name}=\"…\"/>`"),
            );
        }
        Some(number)
    }

    /// Reads damping of a joint with several degrees of freedom, which URDF does not define and which is not
    /// modelled.
    fn several(&mut self, element: Node<'_, 'a>) -> Option<Decimal> {
        let attribute = element.attribute_node("damping")?;
        let written = attribute.value().trim();
        if written
            .split_whitespace()
            .all(|word| word.parse() == Ok(0.0))
        {
            return None;
        }
        self.note(
            attribute.range(),
            "damping of several degrees of freedom is not modelled and is left out".to_string(),
            "add it to the description as a `dissipation`".to_string(),
        );
        Decimal::parse(written)
    }

    /// Reads `armature` of `<dynamics>`, which some dialects have.
    fn armature(&mut self, element: &Node<'_, 'a>) -> Option<(Decimal, Decimal)> {
        let armature = self.coefficient(element, "armature")?;
        let attribute = element.attribute_node("armature")?;
        self.note(
            attribute.range(),
            "`armature` is not part of URDF; it is read as the inertia of the drive, added to that of the joint"
                .to_string(),
            "other programs may ignore it".to_string(),
        );
        Some((armature, Decimal::one()))
    }

    /// Reads a limit. Limits do not enter the equations, so one that is not a number is left out with a note.
    fn bound(&mut self, element: &Node<'_, 'a>, name: &str) -> Option<Decimal> {
        let attribute = element.attribute_node(name)?;
        let written = attribute.value().trim();
        let number = Decimal::parse(written);
        if number.is_none() {
            self.note(
                attribute.range_value(),
                format!("the bound `{name}` is `{written}`, which is not finite, and is left out"),
                "limits do not enter the equations; remove it from the file".to_string(),
            );
        }
        number
    }

    /// Reads a non-negative number of `<dynamics>`; `None` if it is 0.
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
