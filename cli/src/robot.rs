//! Options for robots in URDF and for descriptions, common to all commands that read descriptions.

use crate::parse::Expected;
use clap::{Args, ValueEnum};
use hamel_codegen::urdf;
use hamel_engine::OpenOptions;

/// Options for reading a robot in URDF.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Robots in URDF")]
pub struct RobotOptions {
    /// Let the base move freely: `root_joint`, position and rotation, with its twist in body axes.
    #[arg(long)]
    pub floating: bool,
    /// Fix a joint at an angle (rad) or length (m); once for each joint.
    #[arg(long = "lock", value_name = "JOINT=VALUE", value_parser = lock)]
    pub locks: Vec<(String, String)>,
    /// Make masses, centres of mass and inertias run-time parameters instead of exact constants.
    #[arg(long)]
    pub params: bool,
    /// Motion of joints that mimic another one.
    #[arg(long, value_enum, value_name = "HOW")]
    pub mimic: Option<Mimic>,
    /// Name of the system; default: the robot's.
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// Angles within TOL (rad) of a multiple of π/2 become that multiple. Entries below TOL times the largest entry
    /// of their vector or matrix become 0, and so do lengths below a millionth of TOL (m); default: 1e-9; 0 keeps every
    /// digit.
    #[arg(long, value_name = "TOL", value_parser = tolerance)]
    pub rounding: Option<f64>,
    /// Replace the value of a constant of the description, such as the length of a chain; once for each constant.
    #[arg(long = "const", value_name = "NAME=VALUE", value_parser = constant, help_heading = "Descriptions")]
    pub constants: Vec<(String, String)>,
}

/// Motion of joints that mimic another one.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Mimic {
    /// Follow the joint that they mimic.
    Follow,
    /// Move independently.
    Free,
}

impl From<&RobotOptions> for OpenOptions {
    fn from(options: &RobotOptions) -> Self {
        OpenOptions {
            floating: options.floating,
            locks: options.locks.clone(),
            params: options.params,
            mimic: options.mimic.map(|mimic| match mimic {
                Mimic::Follow => urdf::Mimic::Follow,
                Mimic::Free => urdf::Mimic::Free,
            }),
            name: options.name.clone(),
            rounding: options.rounding,
            constants: options.constants.clone(),
        }
    }
}

fn lock(text: &str) -> Result<(String, String), Expected> {
    let (joint, value) = text.rsplit_once('=').ok_or(Expected::Joint)?;
    Ok((joint.to_string(), value.to_string()))
}

fn constant(text: &str) -> Result<(String, String), Expected> {
    let (name, value) = text.split_once('=').ok_or(Expected::Constant)?;
    Ok((name.trim().to_string(), value.trim().to_string()))
}

fn tolerance(text: &str) -> Result<f64, Expected> {
    let tolerance: f64 = text.parse().map_err(|_| Expected::Number)?;
    match (0.0..=0.1).contains(&tolerance) {
        true => Ok(tolerance),
        false => Err(Expected::Tolerance),
    }
}
