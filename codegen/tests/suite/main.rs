//! Laws of derivation and emission, one module for each subject. To run a single module:
//! `cargo test -p hamel-codegen --test suite mounts::`.

#[path = "common/arm.rs"]
mod arm;
mod assembly;
mod built;
mod care;
mod claims;
mod closing;
mod common;
mod components;
mod constrained;
mod continuous;
mod coordinates;
mod degenerate;
#[path = "common/dense.rs"]
mod dense;
mod emit;
mod entries;
mod expressions;
mod externals;
mod fixtures;
mod functions;
mod gyroscopic;
mod headers;
mod idle;
mod include;
mod inerter;
#[path = "common/jet.rs"]
mod jet;
#[path = "common/jointed/mod.rs"]
mod jointed;
mod joints;
mod language;
mod loops;
mod massless;
#[path = "common/models.rs"]
mod models;
mod mounts;
mod observed;
mod own_words;
mod powers;
#[path = "common/precise.rs"]
mod precise;
mod prescribed;
mod proofs;
mod proved;
mod recognise;
mod recursions;
mod redundant;
mod regressions;
mod reuse;
mod roots;
mod rounding;
mod said;
mod scene;
#[path = "common/some.rs"]
mod some;
mod tilted;
#[path = "common/tree/mod.rs"]
mod tree;
mod trees;
mod unsaid;
mod urdf;
mod work;

use common::Random;
