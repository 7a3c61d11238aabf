//! Reads links and joints from XML, with the place of everything that may be wrong.

mod drive;
mod joint;
mod link;
mod plugin;
mod schema;
mod ties;
mod unrecognized;
mod xml;

use crate::options::Options;
use crate::problem::Problems;
use crate::robot::{Read, Robot};
use std::ops::Range;
use xml::Reader;

const XACRO: &str = "this is a xacro file, whose macros are not part of URDF";
const EXPAND: &str = "expand them first: `xacro FILE > robot.urdf`";

/// Whether a parse error is at a xacro macro whose namespace is not declared.
fn is_xacro(text: &str, range: &Range<usize>) -> bool {
    let rest = text.get(range.start..).unwrap_or("");
    ["xacro:", "<xacro:"]
        .iter()
        .any(|start| rest.starts_with(start))
}

/// Reads the file; `None` if there is no robot in it. Parts with errors are left out.
pub(crate) fn robot<'t>(
    text: &str,
    options: &Options,
    errors: &mut Problems<'t>,
    warnings: &mut Problems<'t>,
) -> Option<Read> {
    let document = match xml::parse(text) {
        Ok(document) => document,
        Err((range, ..)) if is_xacro(text, &range) => {
            errors.push(&range, XACRO, EXPAND);
            return None;
        }
        Err((range, message, help)) => {
            errors.push(&range, message, help);
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
        tolerance: options.tolerance,
        errors,
        warnings,
        cleaned: Vec::new(),
        unrecognized: Vec::new(),
    };
    let name = reader.robot_name(&root, options.name.is_some());
    let mut robot = Robot {
        range: name.as_ref().map_or(0..0, |name| name.range.clone()),
        name: name.map_or_else(String::new, |name| name.name),
        links: Vec::new(),
        joints: Vec::new(),
        loops: Vec::new(),
        springs: Vec::new(),
    };
    for element in root.children().filter(|node| node.is_element()) {
        match xml::written(text, &element) {
            "link" => robot.links.extend(reader.link(&element)),
            "joint" | "drake:joint" => robot.joints.extend(reader.joint(&element)),
            _ => {}
        }
    }
    reader.beside(&root, &mut robot);
    reader.plugins(&root, &robot.joints);
    reader.compare(&root, &schema::ROBOT);
    reader.warn_of_unrecognized();
    let cleaned = reader.cleaned;
    Some(Read { robot, cleaned })
}
