//! Options for robots in URDF, and for descriptions, which every command takes that takes descriptions.

use crate::failure::Failure;
use clap::{Args, ValueEnum};
use hamel_codegen::syntax::suggest::closest;
use hamel_codegen::urdf::{self, Imported, Options, TOLERANCE};
use std::path::Path;

/// How a robot in URDF is read.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Robots in URDF")]
pub struct RobotOptions {
    /// The base moves freely: `root_joint`, position and rotation, with its twist in body axes.
    #[arg(long)]
    pub floating: bool,
    /// A joint that does not move, with its angle (rad) or length (m); once for each joint.
    #[arg(long = "lock", value_name = "JOINT=VALUE", value_parser = lock)]
    pub locks: Vec<(String, String)>,
    /// Masses, centres of mass and inertias are run-time parameters, not exact constants.
    #[arg(long)]
    pub params: bool,
    /// How joints move that mimic another one.
    #[arg(long, value_enum, value_name = "HOW")]
    pub mimic: Option<Mimic>,
    /// Name of the system; by default the robot's.
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// Angles within TOL (rad) of a multiple of π/2 become that multiple. Entries below TOL times the largest
    /// of their vector or matrix become 0, and so do lengths below a millionth of TOL (m); default 1e-9, 0 keeps every
    /// digit.
    #[arg(long, value_name = "TOL", value_parser = tolerance)]
    pub rounding: Option<f64>,
    /// Another value of a constant of the description, such as the length of a chain; once for each constant.
    #[arg(long = "const", value_name = "NAME=VALUE", value_parser = constant, help_heading = "Descriptions")]
    pub constants: Vec<(String, String)>,
}

/// How joints move that mimic another one.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Mimic {
    /// As the joint that they mimic.
    Follow,
    /// By themselves.
    Free,
}

fn lock(text: &str) -> Result<(String, String), String> {
    let (joint, value) = text
        .rsplit_once('=')
        .ok_or("write JOINT=VALUE, as in `--lock finger_joint=0.04`")?;
    Ok((joint.to_string(), value.to_string()))
}

fn constant(text: &str) -> Result<(String, String), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("write NAME=VALUE, as in `--const n=100`")?;
    Ok((name.trim().to_string(), value.trim().to_string()))
}

fn tolerance(text: &str) -> Result<f64, String> {
    let tolerance: f64 = text.parse().map_err(|_| "not a number".to_string())?;
    if (0.0..=0.1).contains(&tolerance) {
        Ok(tolerance)
    } else {
        Err("not between 0 and 0.1".into())
    }
}

impl RobotOptions {
    /// Whether anything was asked for.
    pub fn given(&self) -> bool {
        self.floating
            || !self.locks.is_empty()
            || self.params
            || self.mimic.is_some()
            || self.name.is_some()
            || self.rounding.is_some()
    }

    /// The same for an import.
    fn options(&self, path: &str) -> Options {
        let file = Path::new(path).file_name();
        Options {
            file: file.map_or_else(|| path.to_string(), |file| file.to_string_lossy().into()),
            name: self.name.clone(),
            floating: self.floating,
            locks: self.locks.clone(),
            params: self.params,
            mimic: match self.mimic {
                Some(Mimic::Free) => urdf::Mimic::Free,
                Some(Mimic::Follow) | None => urdf::Mimic::Follow,
            },
            tolerance: self.rounding.unwrap_or(TOLERANCE),
        }
    }
}

/// A robot, with the text that it was read from.
pub struct Robot {
    /// The URDF.
    pub urdf: String,
    /// What was made of it.
    pub imported: Imported,
}

impl Robot {
    /// Reads a URDF text; warnings go to standard error.
    pub fn read(urdf: String, path: &str, options: &RobotOptions) -> Result<Self, Failure> {
        let imported =
            urdf::import(&urdf, &options.options(path), path, true).map_err(Failure::Failed)?;
        crate::failure::warn(&urdf::warnings(&imported, path, &urdf, true));
        Ok(Robot { urdf, imported })
    }

    /// The frame of a link, by the link's name in the file or else in the description; the link that stands in the world
    /// becomes a frame.
    pub fn frame(&mut self, link: &str) -> Result<String, String> {
        let Imported { links, ground, .. } = &self.imported;
        let all: Vec<&(String, String)> = links.iter().chain(ground).collect();
        let written = all.iter().find(|(written, _)| written == link);
        let found = written.or_else(|| all.iter().find(|(_, name)| name == link));
        let Some((_, frame)) = found else {
            let names = || all.iter().map(|(written, _)| written.as_str());
            let help = match closest(link, names()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("the links are {}", names().collect::<Vec<_>>().join(", ")),
            };
            return Err(format!("no link is called `{link}`; {help}"));
        };
        let frame = frame.clone();
        if ground.as_ref().is_some_and(|(_, name)| *name == frame) {
            self.imported.add_ground_frame();
        }
        Ok(frame)
    }
}
