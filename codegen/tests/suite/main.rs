//! Laws of derivation and emission, one module for each subject. To run a single module:
//! `cargo test -p hamel-codegen --test suite mounts::`.

#[path = "common/arm.rs"]
mod arm;
mod assembly;
mod builder_errors;
mod cable;
mod claims;
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
mod lie_algebras;
mod loops;
mod massless;
mod message_vocabulary;
#[path = "common/models.rs"]
mod models;
mod mounts;
mod numerical_loss;
mod observed;
mod powers;
#[path = "common/precise.rs"]
mod precise;
mod prescribed;
mod proofs;
mod proved;
mod random_scenes;
mod recursions;
mod redundant;
mod regressions;
mod reuse;
mod robot_loops;
mod roots;
mod rounding;
mod scene;
#[path = "common/thinning.rs"]
mod thinning;
mod tilted;
#[path = "common/tree/mod.rs"]
mod tree;
mod trees;
mod urdf;
mod velocity_definitions;
mod work;
#[path = "common/wrong_descriptions.rs"]
mod wrong_descriptions;

use common::Random;
