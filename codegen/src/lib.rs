//! Symbolic generator of equations of motion in redundant coordinates and quasi-velocities, after
//! M. Konz and J. Rudolph, *Redundant configuration coordinates and nonholonomic velocity
//! coordinates in analytical mechanics*, IFAC-PapersOnLine 51-2 (2018) 409-414 (KR18).
//!
//! `text/tokens → ast → model → derivation → program → proof → Rust | tables | interpreter`, one module a
//! stage. Dependencies point one way:
//!
//! | module | owns |
//! |---|---|
//! | [`syntax`] | grammar and spans |
//! | [`reuse`] | components, parts and repetition, written out |
//! | [`algebra`] | expression graph, polynomials, normal forms; no mechanics |
//! | [`mod@lower`] | from a description to a model: names, shapes, every semantic error |
//! | [`model`] | a mechanical system as expressions of a graph |
//! | [`mod@derive`] | the symbols of the formalism, ξ̇ by the cheapest route |
//! | [`proof`] | everything once more, on other routes, and compared |
//! | [`program`] | binding times, operation counts, interpretation |
//! | [`emit`] | Rust text; no algebra |
//! | [`tables`] | what people read |
//! | [`vocabulary`] | the words of the language, for references and editors |
//! | `scene` | descriptions as data, built in Rust or read from text |
//! | [`generate`], [`expand()`], [`Builder`] | the front ends; `urdf` with the feature of that name |

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
pub mod syntax;
pub mod tables;
#[cfg(feature = "urdf")]
pub mod urdf;
pub mod vocabulary;

#[cfg(feature = "files")]
pub use builder::{BuildError, Builder};
pub use expand::{MACRO_STATEMENTS, expand};
