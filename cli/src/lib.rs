//! What the commands of `hamel` do, for the command line and for other front ends.
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
//! | `added` | a description with more outputs: what a sweep keeps, what a run watches |
//! | `text` | options that are lists, and where they are wrong |
//! | `robot` | robots in URDF as descriptions, and the options for them |
//! | `state` | reading the numbers of a state |
//! | `mechanism` | a described system that the integrators can run |
//! | `singular` | which velocity has no inertia where a run or an evaluation fails |
//! | `method` | the methods by their names, and which systems they are for |
//! | `json`, `names`, `columns` | how results are written; pictures and numbers are those of `hamel-report` |
//! | `progress` | what long work shows; `silent` without the feature `command` |
//! | `drawing` | what of a mechanism can be drawn at a state, as plain numbers |
//! | `command` | the command line, with the feature of that name |
//! | `session` | the same for other front ends: numbers in place of texts |
//! | `failure` | errors, warnings and exit statuses |

//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `command` | the program `hamel`, its sweeps, its pictures, and what it shows while work takes its time |
//! | `machine` | runs by machine code; without it functions are evaluated step by step, on any target |

#![cfg_attr(docsrs, feature(doc_cfg))]
// What the command line alone calls stays where it is when the crate is built without it.
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

pub use check::Checked;
#[cfg(feature = "command")]
pub use command::{asked, command, described};
pub use compare::Comparison;
pub use drawing::{Drawing, Drawn, Scene};
pub use failure::{Failure, Mark, Said};
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

/// Which changes of sign are events.
pub use hamel::adaptive::Direction;
/// The shape of a value, matrices by rows.
pub use hamel_codegen::program::Shape;

use hamel_report::number;
