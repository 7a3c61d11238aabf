//! Symbolic derivation of equations of motion in redundant coordinates and quasi-velocities, with proofs.
//!
#![doc = include_str!("../README.md")]
//!
//! # The stages
//!
//! `text or tokens → ast → names → shapes → model → derivation → program → proof → Rust, C | tables | machine code | interpreter`.
//! Most stages are crates of their own, in folders of this one; their dependencies form no cycle:
//!
//! | module | crate | contents |
//! |---|---|---|
//! | [`algebra`] | `hamel-algebra` | expression graph, polynomials and normal forms, without mechanics |
//! | [`syntax`], [`reuse`], [`mod@lower`], [`model`] | `hamel-language` | from a description to a mechanical system as expressions of a graph |
//! | [`program`] | `hamel-program` | binding times, operation counts, tapes, interpretation |
//! | [`derive`](mod@derive) | `hamel-dynamics` | the symbols of the formalism, and ξ̇ by the cheapest route |
//! | [`proof`] | `hamel-verify` | derives everything once more by other routes, and compares |
//! | [`emit`] | `hamel-emit` | Rust and C99 as text, without any algebra |
//! | [`tables`] | `hamel-tables` | tables of coefficients for people to read |
//! | `scene` | | descriptions as data, built in Rust or read from text |
//! | [`generate`], [`expand()`], [`Builder`] | | the front ends |
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `files` | yes | `.eom` files in and formatted `.rs` files out: source positions, underlined errors, the [`Builder`] for build scripts, `scene`, and `tables` |
//! | `urdf` | no | robots in URDF in place of descriptions |
//!
//! The formalism is that of M. Konz and J. Rudolph, *Redundant configuration coordinates and nonholonomic velocity
//! coordinates in analytical mechanics*, IFAC-PapersOnLine 51-2 (2018) 409-414, which the documentation quotes as KR18.

#![cfg_attr(docsrs, feature(doc_cfg))]

pub use hamel_algebra as algebra;
pub use hamel_dynamics as derive;
pub use hamel_emit as emit;
pub use hamel_language::{
    diagnostics, functions, inertia, lower, model, reuse, syntax, vocabulary,
};
pub use hamel_program as program;
#[cfg(feature = "files")]
pub use hamel_tables as tables;
pub use hamel_verify as proof;

#[cfg(feature = "files")]
pub mod builder;
mod expand;
pub mod generate;
pub mod render;
#[cfg(feature = "files")]
pub mod scene;
#[cfg(feature = "files")]
pub mod trace;
#[cfg(feature = "urdf")]
pub mod urdf;

#[cfg(feature = "files")]
pub use builder::{BuildError, BuildProblem, Builder};
pub use expand::{MACRO_STATEMENTS, expand};
