//! From the description of a mechanical system to a model of it.
//!
#![doc = include_str!("../README.md")]
//!
//! # The stages
//!
//! `text or tokens → ast → names → shapes → model`, one module for each stage. Dependencies point one way:
//!
//! | module | what it owns |
//! |---|---|
//! | [`syntax`] | grammar and source positions |
//! | [`expression`] | expressions that are written in Rust |
//! | [`reuse`] | components, parts and repetition, which are written out here |
//! | `symbols` | what names stand for, and every error about them |
//! | `shapes` | the shapes of all expressions, and every error about them |
//! | [`mod@lower`] | from a description to a model, and every other semantic error |
//! | [`model`] | a mechanical system as expressions of a graph |
//! | [`functions`] | the functions that can be asked for |
//! | [`inertia`] | what is said of systems without inertia |
//! | [`vocabulary`] | the words of the language, for references and editors |
//! | [`diagnostics`], [`render`] | errors, and how they are shown |
//!
//! The expressions are those of [`algebra`]; `hamel-codegen` derives equations of motion from a model.
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `files` | yes | texts besides tokens: source positions, and errors that are underlined in them |

#![cfg_attr(docsrs, feature(doc_cfg))]

pub use hamel_algebra as algebra;

pub mod diagnostics;
pub mod expression;
pub mod functions;
pub mod inertia;
pub mod lower;
pub mod model;
pub mod render;
pub mod reuse;
mod shapes;
mod symbols;
pub mod syntax;
pub mod vocabulary;
