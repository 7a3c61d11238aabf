//! Robots in URDF as descriptions.

use super::OpenOptions;
use crate::error::Error;
use crate::reporter::{Reporter, Warning};
use hamel_codegen::syntax::suggest::closest;
use hamel_codegen::urdf::{self, Imported};
use std::fmt;

/// Imported robot, with the text from which it was read.
pub struct Robot {
    /// The URDF.
    pub urdf: String,
    /// The result of the import.
    pub imported: Imported,
}

/// Name that no link of a robot has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownLink {
    /// The requested name.
    pub name: String,
    /// The link whose name is closest to it.
    pub closest: Option<String>,
    /// All links.
    pub known: Vec<String>,
}

impl fmt::Display for UnknownLink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no link is called `{}`; ", self.name)?;
        match &self.closest {
            Some(near) => write!(f, "did you mean `{near}`?"),
            None => write!(f, "the links are {}", self.known.join(", ")),
        }
    }
}

impl std::error::Error for UnknownLink {}

impl Robot {
    /// Converts a URDF text into a description, which the robot holds with the text, and reports warnings; `path` is
    /// for messages and for the options of the import.
    pub fn from_urdf(
        urdf: String,
        path: &str,
        options: &OpenOptions,
        reporter: &dyn Reporter,
    ) -> Result<Self, Error> {
        match urdf::import(&urdf, &options.import(path)) {
            Ok(imported) => {
                reporter.warn(&Warning::Robot {
                    path,
                    urdf: &urdf,
                    imported: &imported,
                });
                Ok(Robot { urdf, imported })
            }
            Err(problems) => Err(Error::Import {
                path: path.into(),
                urdf,
                problems,
            }),
        }
    }

    /// Finds the frame of a link, by the link's name in the file or else in the description; a link that is fixed in
    /// the world becomes a frame.
    pub fn frame(&mut self, link: &str) -> Result<String, UnknownLink> {
        let Imported { links, ground, .. } = &self.imported;
        let all: Vec<&(String, String)> = links.iter().chain(ground).collect();
        let written = all.iter().find(|(written, _)| written == link);
        let found = written.or_else(|| all.iter().find(|(_, name)| name == link));
        let Some((_, frame)) = found else {
            let names = || all.iter().map(|(written, _)| written.as_str());
            return Err(UnknownLink {
                name: link.into(),
                closest: closest(link, names()).map(String::from),
                known: names().map(String::from).collect(),
            });
        };
        let frame = frame.clone();
        if ground.as_ref().is_some_and(|(_, name)| *name == frame) {
            self.imported.add_ground_frame();
        }
        Ok(frame)
    }
}
