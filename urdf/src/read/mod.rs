//! From XML to links and joints: what a robot is, with the place of everything that may be wrong.

mod joint;
mod link;
mod strange;
mod xml;

use crate::angle::Rotation;
use crate::decimal::Decimal;
use crate::problem::Problems;
use std::ops::Range;
use xml::Reader;

/// A robot, as written.
#[derive(Debug)]
pub(crate) struct Robot {
    pub(crate) name: String,
    /// Place of the robot's name.
    pub(crate) range: Range<usize>,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
}

/// A name with its place.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) range: Range<usize>,
}

/// A link.
#[derive(Debug)]
pub(crate) struct Link {
    pub(crate) name: Named,
    /// `None` without `<inertial>`.
    pub(crate) inertial: Option<Inertial>,
}

/// Mass and inertia of a link.
#[derive(Debug)]
pub(crate) struct Inertial {
    pub(crate) range: Range<usize>,
    pub(crate) mass: Decimal,
    /// Centre of mass and principal frame, in link axes.
    pub(crate) origin: Origin,
    /// xx, xy, xz, yy, yz, zz about the centre of mass, in the axes of the origin.
    pub(crate) inertia: [Decimal; 6],
    pub(crate) inertia_range: Range<usize>,
}

impl Inertial {
    /// Whether it says that there is no mass.
    pub(crate) fn is_zero(&self) -> bool {
        self.mass.is_zero() && self.inertia.iter().all(Decimal::is_zero)
    }
}

/// `<origin>`: a pose.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    pub(crate) position: [Decimal; 3],
    pub(crate) rotation: Rotation,
}

impl Origin {
    fn identity() -> Self {
        Origin {
            position: std::array::from_fn(|_| Decimal::zero()),
            rotation: Rotation::identity(),
        }
    }
}

/// Types of joints in URDF.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Fixed,
    Revolute,
    Continuous,
    Prismatic,
    Planar,
    Floating,
}

/// A joint.
#[derive(Debug)]
pub(crate) struct Joint {
    pub(crate) name: Named,
    pub(crate) kind: Kind,
    pub(crate) parent: Named,
    pub(crate) child: Named,
    pub(crate) origin: Origin,
    /// `None` where URDF's default (1, 0, 0) is meant.
    pub(crate) axis: Option<[Decimal; 3]>,
    pub(crate) damping: Option<Decimal>,
    /// Coulomb friction, which descriptions do not model.
    pub(crate) friction: Option<Decimal>,
    pub(crate) lower: Option<Decimal>,
    pub(crate) upper: Option<Decimal>,
    pub(crate) velocity: Option<Decimal>,
    pub(crate) effort: Option<Decimal>,
    pub(crate) mimic: Option<Follows>,
}

/// `<mimic>`: q = multiplier · source + offset.
#[derive(Debug)]
pub(crate) struct Follows {
    pub(crate) source: Named,
    pub(crate) multiplier: Decimal,
    pub(crate) offset: Decimal,
}

/// A number that was taken for a rounding.
#[derive(Debug)]
pub(crate) struct Cleaned {
    pub(crate) range: Range<usize>,
    pub(crate) written: String,
    pub(crate) read: String,
}

/// A robot and what was changed while it was read.
#[derive(Debug)]
pub(crate) struct Read {
    pub(crate) robot: Robot,
    pub(crate) cleaned: Vec<Cleaned>,
}

const XACRO: &str = "this is a xacro file, whose macros are not part of URDF";
const EXPAND: &str = "expand them first: `xacro FILE > robot.urdf`";

/// Whether what is not well-formed is a macro without its namespace.
fn is_xacro(text: &str, range: &Range<usize>) -> bool {
    let rest = text.get(range.start..).unwrap_or("");
    ["xacro:", "<xacro:"]
        .iter()
        .any(|start| rest.starts_with(start))
}

/// Reads the file; `None` where there is no robot in it. Parts with errors are left out.
pub(crate) fn robot<'t>(
    text: &str,
    tolerance: f64,
    errors: &mut Problems<'t>,
    warnings: &mut Problems<'t>,
) -> Option<Read> {
    let document = match xml::parse(text) {
        Ok(document) => document,
        Err((range, _)) if is_xacro(text, &range) => {
            errors.push(&range, XACRO, EXPAND);
            return None;
        }
        Err((range, message)) => {
            errors.push(
                &range,
                format!("this is not well-formed XML: {message}"),
                "mend it here, or a little before",
            );
            return None;
        }
    };
    let root = document.root_element();
    let macros = document.descendants().find(|node| {
        let space = node.tag_name().namespace();
        space.is_some_and(|space| space.contains("xacro"))
    });
    if let Some(node) = macros {
        errors.push(&xml::tag(text, &node), XACRO, EXPAND);
        return None;
    }
    if root.tag_name().name() != "robot" {
        errors.push(
            &xml::tag(text, &root),
            format!("the outermost element is `{}`", root.tag_name().name()),
            "a URDF file is one `<robot name=\"…\">` element; convert other formats to URDF first",
        );
        return None;
    }
    let mut reader = Reader {
        text,
        tolerance,
        errors,
        warnings,
        cleaned: Vec::new(),
        strange: Vec::new(),
    };
    let name = reader.name(&root, "name");
    let mut robot = Robot {
        range: name.as_ref().map_or(0..0, |name| name.range.clone()),
        name: name.map_or_else(String::new, |name| name.name),
        links: Vec::new(),
        joints: Vec::new(),
    };
    for element in root.children().filter(|node| node.is_element()) {
        match element.tag_name().name() {
            "link" => robot.links.extend(reader.link(&element)),
            "joint" => robot.joints.extend(reader.joint(&element)),
            _ => {}
        }
    }
    let known = ["link", "joint", "material", "transmission", "gazebo"];
    reader.elements(&root, &known);
    reader.tell();
    let cleaned = reader.cleaned;
    Some(Read { robot, cleaned })
}
