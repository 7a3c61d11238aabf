//! Descriptions as the command line opens them: what there is to say goes to the terminal.

use crate::failure::Failure;
#[cfg(feature = "command")]
use crate::progress::Terminal;
use crate::robot::RobotOptions;
#[cfg(not(feature = "command"))]
use hamel_engine::Quiet as Terminal;
use hamel_engine::Source;
use std::path::Path;
use std::sync::Arc;

/// Reads a file, or standard input if the path is `-`.
pub fn read(path: &Path) -> Result<Source, Failure> {
    Ok(Source::read(path, Arc::new(Terminal::default()))?)
}

/// Reads a description, or a robot in URDF.
pub fn open(path: &Path, options: &RobotOptions) -> Result<Source, Failure> {
    Ok(read(path)?.interpret(&options.into())?)
}
