//! The commands of `hamel`, for the command line and for other front ends.
//!
#![doc = include_str!("../README.md")]
//!
//! # Files
//!
//! | file | owns |
//! |---|---|
//! | `tables`, `regressor`, `check`, `ops`, `emit`, `eval`, `linearize`, `simulate`, `draw`, `sweep`, `compare`, `import` | one subcommand each |
//! | `eigenvalues` | eigenvalues of a general matrix |
//! | `source` | reading and deriving a description |
//! | `added` | a description with more outputs: those that a sweep keeps or a run watches |
//! | `text` | options that are lists, and the places of errors in them |
//! | `robot` | robots in URDF as descriptions, and the options for them |
//! | `state` | reading the values of a state |
//! | `mechanism` | a described system as the integrators run it |
//! | `singular` | finding the velocity without inertia after a failed run or evaluation |
//! | `method` | the methods by name, and the systems that each fits |
//! | `json`, `names`, `columns` | writing results; pictures and numbers come from `hamel-report` |
//! | `progress` | progress bars; `silent` without the feature `command` |
//! | `drawing` | the drawable parts of a mechanism at a state, as plain numbers |
//! | `command` | the command line, with the feature of that name |
//! | `session` | the commands for other front ends: numbers instead of text |
//! | `failure` | errors, warnings and exit statuses |

//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `command` | the program `hamel`, its sweeps, its pictures and its progress bars |
//! | `machine` | runs as machine code; without it functions are interpreted, on any target |

#![cfg_attr(docsrs, feature(doc_cfg))]
// Without the command line, code that only it calls is kept and unused.
#![cfg_attr(not(feature = "command"), allow(dead_code, unused_imports))]

mod added;
mod check;
mod columns;
#[cfg(feature = "command")]
mod command;
mod compare;
mod constants;
mod divided;
#[cfg(feature = "command")]
mod draw;
pub mod drawing;
mod eigenvalues;
mod emit;
mod eval;
mod failure;
mod import;
mod json;
mod linearize;
mod mechanism;
mod method;
mod names;
mod ops;
mod outputs;
#[cfg_attr(not(feature = "command"), path = "silent.rs")]
mod progress;
mod regressor;
mod robot;
mod session;
mod simulate;
mod singular;
mod source;
mod state;
#[cfg(feature = "command")]
mod sweep;
mod tables;
mod text;

pub use check::CheckedIdentity;
#[cfg(feature = "command")]
pub use command::{asked, command, described};
pub use compare::Comparison;
pub use drawing::{Drawing, ParametrizedDrawing, Scene};
pub use failure::{Captured, Failure, Mark};
pub use linearize::Linear;
pub use mechanism::{End, Varied};
pub use robot::{Mimic, RobotOptions};
pub use session::{Function, Grip, Happened, Motion, Names, Session, Stepped, imported};
pub use simulate::events::{Event, Gauge, Watched};
pub use simulate::inputs::{Asked, Control, Law};
pub use simulate::plan::Every;
pub use simulate::stepping::Stepping;
pub use simulate::stop::Stop;
pub use source::decoded;
pub use state::State;
pub use tables::Format;

/// The sign changes that count as events.
pub use hamel::adaptive::Direction;
/// The shape of a value, matrices by rows.
pub use hamel_codegen::program::Shape;

use hamel_report::number;
