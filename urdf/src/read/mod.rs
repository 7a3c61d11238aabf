//! From XML to links and joints: what a robot is, with the place of everything that may be wrong.

mod joint;
mod link;
mod strange;
mod xml;

use crate::problem::Problems;
use crate::robot::{Read, Robot};
use std::ops::Range;
use xml::Reader;

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
