//! Options for robots in URDF and for descriptions, common to all commands that read descriptions.

use crate::failure::Failure;
use clap::{Args, ValueEnum};
use hamel_codegen::syntax::suggest::closest;
use hamel_codegen::urdf::{self, Imported, Options, TOLERANCE};
use std::path::Path;

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
    /// Whether any option was given.
    pub fn given(&self) -> bool {
        self.floating
            || !self.locks.is_empty()
            || self.params
            || self.mimic.is_some()
            || self.name.is_some()
            || self.rounding.is_some()
    }

    /// The options of the import.
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
    /// The result of the import.
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

    /// The frame of a link, by the link's name in the file or else in the description; a link that is fixed in the
    /// world becomes a frame.
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
            self.stand();
        }
        Ok(frame)
    }

    /// Makes the link that is fixed in the world a frame of the description.
    fn stand(&mut self) {
        let Imported {
            text,
            origins,
            links,
            ground,
            ..
        } = &mut self.imported;
        let (Some(place), Some(link)) = (text.rfind('}'), ground.take()) else {
            return;
        };
        text.insert_str(
            place,
            &format!("    frame {} = pose(identity(3), [0, 0, 0]);\n", link.1),
        );
        origins.insert(origins.len().saturating_sub(1), None);
        links.push(link);
    }
}
