//! Symbolic derivation of equations of motion in redundant coordinates and quasi-velocities, with proofs.
//!
#![doc = include_str!("../README.md")]
//!
//! # The stages
//!
//! `text or tokens → ast → names → shapes → model → derivation → program → proof → Rust, C | tables | machine code | interpreter`,
//! one module for each stage. Dependencies point one way:
//!
//! | module | what it owns |
//! |---|---|
//! | [`algebra`] | a crate of its own: expression graph, polynomials and normal forms, without mechanics |
//! | [`syntax`], [`reuse`], [`mod@lower`], [`model`] | the crate `hamel-language`: from a description to a mechanical system as expressions of a graph |
//! | [`mod@derive`] | the symbols of the formalism, and ξ̇ by the cheapest route |
//! | [`proof`] | everything derived once more by other routes, and compared |
//! | [`program`] | binding times, operation counts, tapes, interpretation |
//! | [`emit`] | Rust and C99 as text, without any algebra |
//! | [`tables`] | the tables of coefficients that people read |
//! | `scene` | descriptions as data, built in Rust or read from text |
//! | [`generate`], [`expand()`], [`Builder`] | the front ends |
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `files` | yes | `.eom` files in and formatted `.rs` files out: source positions, underlined errors, the [`Builder`] for build scripts, and `scene` |
//! | `urdf` | no | robots in URDF, wherever a description can stand |
//!
//! The formalism is that of M. Konz and J. Rudolph, *Redundant configuration coordinates and nonholonomic velocity
//! coordinates in analytical mechanics*, IFAC-PapersOnLine 51-2 (2018) 409-414, which the documentation quotes as KR18.

#![cfg_attr(docsrs, feature(doc_cfg))]

pub use hamel_algebra as algebra;
pub use hamel_language::{
    diagnostics, functions, inertia, lower, model, render, reuse, syntax, vocabulary,
};
#[cfg(feature = "files")]
pub mod builder;
pub mod derive;
pub mod emit;
mod expand;
pub mod generate;
pub mod program;
pub mod proof;
#[cfg(feature = "files")]
pub mod scene;
pub mod tables;
#[cfg(feature = "urdf")]
pub mod urdf;

#[cfg(feature = "files")]
pub use builder::{BuildError, Builder};
pub use expand::{MACRO_STATEMENTS, expand};
