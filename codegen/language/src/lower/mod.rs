//! Lowers a description to the model of the mechanical system that it means.
//!
//! Names have been resolved and shapes checked before; errors in them are not repeated here. Every other semantic
//! error is found here, where arithmetic can tell: later stages cannot fail on user input.

mod affine;
mod agreement;
mod applied;
mod arithmetic;
mod axes;
mod bodies;
mod branch;
mod build;
mod choice;
mod completion;
mod component;
mod curve;
mod curves;
mod declare;
mod defaults;
mod definitions;
mod dynamics;
mod elements;
mod expression;
mod externals;
mod frames;
mod functions;
mod independent;
mod speed_jumps;
mod static_scope;
// Open to tests, which compare shapes with values.
mod configuration_manifold;
mod independent_velocities;
#[doc(hidden)]
pub mod inspect;
mod invariants;
mod joints;
mod kinematics;
mod line;
mod loads;
mod motion;
mod names;
mod negative;
mod observe;
mod pfaffian;
mod plausibility;
mod prescribe;
mod quadratic;
mod rate;
mod rates;
mod reader;
mod relations;
mod scope;
mod start;
mod states;
mod tangency;
mod time;
mod unused;

pub use build::{build, build_at};
