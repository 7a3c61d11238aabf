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
//! | [`syntax`] | grammar and source positions |
//! | [`reuse`] | components, parts and repetition, which are written out here |
//! | [`algebra`] | expression graph, polynomials and normal forms, without mechanics |
//! | `symbols` | what names stand for, and every error about them |
//! | `shapes` | the shapes of all expressions, and every error about them |
//! | [`mod@lower`] | from a description to a model, and every other semantic error |
//! | [`model`] | a mechanical system as expressions of a graph |
//! | [`mod@derive`] | the symbols of the formalism, and ξ̇ by the cheapest route |
//! | [`proof`] | everything derived once more by other routes, and compared |
//! | [`program`] | binding times, operation counts, tapes, interpretation |
//! | [`emit`] | Rust and C99 as text, without any algebra |
//! | [`tables`] | the tables of coefficients that people read |
//! | [`vocabulary`] | the words of the language, for references and editors |
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
#[cfg(feature = "files")]
pub mod builder;
pub mod derive;
pub mod diagnostics;
pub mod emit;
mod expand;
pub mod functions;
pub mod generate;
pub mod lower;
pub mod model;
pub mod program;
pub mod proof;
pub mod render;
pub mod reuse;
#[cfg(feature = "files")]
pub mod scene;
mod shapes;
mod symbols;
pub mod syntax;
pub mod tables;
#[cfg(feature = "urdf")]
pub mod urdf;
pub mod vocabulary;

#[cfg(feature = "files")]
pub use builder::{BuildError, Builder};
pub use expand::{MACRO_STATEMENTS, expand};
