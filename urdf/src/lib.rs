//! Robots in URDF (Unified Robot Description Format) as descriptions of `hamel`.
//!
//! [`import`] reads the tree of links and joints and writes an `.eom` text: one `joint` statement
//! for each joint, one `body` for each link with mass, in the order of the tree. Numbers keep the
//! decimals that were written, save those that are roundings of multiples of π/2 or of 0; what
//! was changed is said in the text. What the equations of motion do not need (shapes, meshes,
//! transmissions, simulators' own elements) is left out.
//!
//! XML is read by `roxmltree`, which keeps the place of every attribute: errors name it, and no
//! number that is missing or unreadable becomes a silent zero.
//!
//! ```
//! let urdf = r#"<robot name="pendulum">
//!   <link name="base"/>
//!   <joint name="hinge" type="revolute">
//!     <parent link="base"/> <child link="rod"/> <axis xyz="0 1 0"/>
//!   </joint>
//!   <link name="rod">
//!     <inertial>
//!       <origin xyz="0 0 -0.5"/> <mass value="2"/>
//!       <inertia ixx="0.2" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.01"/>
//!     </inertial>
//!   </link>
//! </robot>"#;
//! let imported = hamel_urdf::import(urdf, &hamel_urdf::Options::default()).unwrap();
//! assert!(imported.text.contains("joint hinge: revolute [0, 1, 0] moves rod"));
//! ```

mod angle;
mod decimal;
mod inertia;
mod names;
mod options;
mod plan;
mod problem;
mod read;
mod robot;
mod tree;
mod write;

pub use options::{Imported, Mimic, Options, TOLERANCE};
pub use problem::Problem;

use problem::Problems;

/// Reads a robot and writes its description; all independent errors at once, in the order of the
/// text.
pub fn import(xml: &str, options: &Options) -> Result<Imported, Vec<Problem>> {
    let mut errors = Problems::new(xml);
    let mut warnings = Problems::new(xml);
    let Some(read) = read::robot(xml, options.tolerance, &mut errors, &mut warnings) else {
        return Err(errors.sorted());
    };
    // A tree of what was misread would be wrong about what is right.
    let tree = tree::tree(&read.robot, &mut errors);
    let plan = plan::plan(&read.robot, options, &mut errors, &mut warnings);
    let (Some(tree), true) = (tree, errors.is_empty()) else {
        return Err(errors.sorted());
    };
    inertia::check(
        &read.robot,
        &tree,
        &plan,
        options.floating,
        &mut errors,
        &mut warnings,
    );
    let moving = |motion: &plan::Mobility| matches!(motion, plan::Mobility::Free);
    if !options.floating && !plan.motions.iter().any(moving) {
        errors.push(
            &read.robot.range,
            "nothing of this robot moves",
            "`--floating` lets its base move; joints move that are not fixed and not locked",
        );
    }
    if !errors.is_empty() {
        return Err(errors.sorted());
    }
    let mut imported = write::write(xml, &read, &tree, &plan, options);
    imported.warnings = warnings.sorted();
    Ok(imported)
}
