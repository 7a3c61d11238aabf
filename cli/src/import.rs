//! `hamel import`: converts a robot in URDF into a description.

use crate::failure::{Failure, print, warn, write};
use crate::outputs;
use crate::robot::RobotOptions;
use crate::source;
use clap::Args;
use std::path::PathBuf;

/// Writes a robot in URDF as a description.
///
/// The description has one `joint` for each joint and one `body` for each link with mass, in the order of the tree; the
/// joints on one link in the order of their names. Inertias are exact constants unless --params is given. Every joint
/// gets an input, its motor's torque or force. Limits become documented constants. Numbers corrected as rounding errors
/// are listed on standard error; anything that changes the motion and is not understood or not modelled, such as
/// Coulomb friction, is a warning; both are also comments of the description.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel import arm.urdf -o arm.eom
  hamel import quadruped.urdf --floating -o quadruped.eom
  hamel import arm.urdf --lock finger_joint1=0.04 --lock finger_joint2=0.04
  hamel import arm.urdf --params -o arm.eom

The other commands also take the file:
  hamel ops quadruped.urdf --floating")]
pub struct Arguments {
    /// Robot; `-` for standard input.
    #[arg(value_name = "ROBOT.urdf")]
    file: PathBuf,
    /// Output file; default: standard output.
    #[arg(short, long, value_name = "F.eom")]
    out: Option<PathBuf>,
    #[command(flatten)]
    robot: RobotOptions,
}

/// Imports the robot and writes its description.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    outputs::apart(
        [("-o", arguments.out.as_deref())],
        [Some(arguments.file.as_path())],
    )?;
    let source = source::read(&arguments.file)?;
    if !source.is_urdf() {
        return Err(Failure::usage(format!(
            "{}: this is not URDF, which is XML and begins with `<`; a description needs no import",
            source.path
        )));
    }
    let source = source.interpret(&(&arguments.robot).into())?;
    let cleaned = source
        .robot
        .iter()
        .flat_map(|robot| &robot.imported.cleaned);
    let cleaned: String = cleaned
        .map(|change| format!("{}: {change}\n", source.path))
        .collect();
    warn(&cleaned);
    match &arguments.out {
        Some(out) => write(out, &source.text),
        None => print(&source.text),
    }
}
