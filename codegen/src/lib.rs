//! Symbolic generator of equations of motion in redundant coordinates and quasi-velocities.
//!
//! `text/tokens → ast → model → derivation → program → Rust tokens | tables | interpreter`; one
//! module a stage, see ARCHITECTURE.md.

pub mod algebra;
pub mod derive;
pub mod diagnostics;
pub mod model;
pub mod program;
pub mod render;
pub mod syntax;
