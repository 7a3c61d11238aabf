//! Imports robots in URDF (Unified Robot Description Format) as descriptions for `hamel`.
//!
#![doc = include_str!("../README.md")]
//!
//! # What is imported
//!
//! [`import`] reads the tree of links and joints and builds a description from it: one `joint` statement for each
//! joint, one `body` for each link with mass, in the order of the tree. Numbers keep their decimals, except for rounded
//! multiples of π/2 and rounded zeros; a comment says which numbers were changed. `read/schema.rs` lists the elements and
//! attributes that a file may contain.
//!
//! Each statement knows the part of the file that it was made from, and later errors about it have their place there.
//!
//! XML is parsed by `roxmltree`, which keeps the position of every attribute, so that every error names its place.

mod angle;
mod decimal;
mod decode;
mod inertia;
mod names;
mod options;
mod plan;
mod problem;
mod read;
mod robot;
mod tree;
mod write;

pub use decode::{Undecoded, decode};
pub use options::{Idle, Imported, Mimic, Options, TOLERANCE};
pub use problem::Problem;

use problem::Problems;
use std::collections::BTreeMap;

/// Reads a robot and builds its description.
///
/// # Errors
/// Returns all independent errors at once, in the order of the text.
pub fn import(xml: &str, options: &Options) -> Result<Imported, Vec<Problem>> {
    import_without(xml, options, &BTreeMap::new())
}

/// Imports a robot as [`import`] does, but leaves out redundant equations of loop-closing joints.
///
/// The keys of `idle` are indices into the [`equations`](Imported::equations) that [`import`] gives; the values are
/// the reasons. The description keeps the equations as comments, with the reason. The caller has to find them, since that
/// takes derivatives of the equations along the tree.
///
/// # Errors
/// As [`import`].
pub fn import_without(
    xml: &str,
    options: &Options,
    idle: &BTreeMap<usize, Idle>,
) -> Result<Imported, Vec<Problem>> {
    let mut errors = Problems::new(xml);
    let mut warnings = Problems::new(xml);
    let Some(read) = read::robot(xml, options, &mut errors, &mut warnings) else {
        return Err(errors.sorted());
    };
    // After errors in reading, tree and plan are still checked for errors of their own, but not used.
    let tree = tree::tree(&read.robot, &mut errors);
    let plan = plan::plan(&read.robot, options, &mut errors, &mut warnings);
    let (Some(tree), true) = (tree, errors.is_empty()) else {
        return Err(errors.sorted());
    };
    inertia::check(&read.robot, &tree, &plan, options.floating, &mut warnings);
    let moving = |motion: &plan::Mobility| matches!(motion, plan::Mobility::Free);
    if !options.floating && !plan.motions.iter().any(moving) {
        errors.push(
            &read.robot.range,
            "no part of this robot moves",
            "`--floating` makes its base move; joints move unless they are fixed or locked",
        );
    }
    if !errors.is_empty() {
        return Err(errors.sorted());
    }
    let warnings = warnings.sorted();
    Ok(write::write(
        xml,
        &read,
        (&tree, &plan),
        (options, idle),
        warnings,
    ))
}
