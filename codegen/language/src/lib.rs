//! Reads the description of a mechanical system and builds a model from it.
//!
#![doc = include_str!("../README.md")]
//!
//! # The stages
//!
//! `text or tokens → ast → names → shapes → model`, with one module per stage. Dependencies point one way:
//!
//! | module | contents |
//! |---|---|
//! | [`syntax`] | grammar and source positions |
//! | [`expression`] | building expressions in Rust code |
//! | [`reuse`] | expansion of components, parts and repetition into plain statements |
//! | `symbols` | name resolution, and every error about names |
//! | `shapes` | the shapes of all expressions, and every error about shapes |
//! | [`mod@lower`] | from a description to a model, and every other semantic error |
//! | [`model`] | a mechanical system as expressions of a graph |
//! | [`functions`] | the functions that can be generated |
//! | [`inertia`] | the error for systems that lack the inertia they need |
//! | `dimensions` | the dimensions of all expressions, if any unit is written, and every error about dimensions |
//! | [`units`] | units with their exact factors, and dimensions |
//! | [`vocabulary`] | the words of the language, for references and editors |
//! | [`diagnostics`] | errors with their places |
//!
//! Expressions are built with [`algebra`]; `hamel-codegen` derives equations of motion from a model.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `files` | yes | parsing of text in addition to tokens: source positions |

#![cfg_attr(docsrs, feature(doc_cfg))]

pub use hamel_algebra as algebra;

pub mod diagnostics;
pub mod dimensions;
pub mod expression;
pub mod functions;
pub mod inertia;
pub mod lower;
pub mod model;
pub mod reuse;
mod shapes;
mod symbols;
pub mod syntax;
pub mod units;
pub mod vocabulary;
