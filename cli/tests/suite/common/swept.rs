//! Runs sweeps of a ball and of other descriptions.

use crate::common::{hamel, text};
use crate::table::{Table, fresh};
use std::path::{Path, PathBuf};

/// A ball in a vertical plane, z̈ = −g + F/m.
pub const BALL: &str = "system Ball {
    param m = 2, g = 10;
    param drift: vec2 = [0, 0];
    coord y, z;
    velocity v, w;
    rate y = v;
    rate z = w;
    particle mass m at [y, 0, z];
    gravity [0, 0, -g];
    input F;
    generalized force w = F;
    output height = z;
    start v = 1;
    start w = 4;
}";

/// Sweeps a description, given as text or file, into a new folder.
pub fn swept_into(name: &str, model: &str, options: &[&str]) -> PathBuf {
    let folder = fresh(name);
    run(&folder, model, options);
    folder
}

/// Runs a sweep with this output folder.
pub fn run(folder: &Path, model: &str, options: &[&str]) {
    let out = folder.display().to_string();
    let (file, input) = match model.contains('{') {
        true => ("-", model),
        false => (model, ""),
    };
    let output = hamel(&[&["sweep", file, "--out", &out], options].concat(), input);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// The rows of a sweep.
pub fn swept(name: &str, model: &str, options: &[&str]) -> Table {
    Table::read(&swept_into(name, model, options))
}
