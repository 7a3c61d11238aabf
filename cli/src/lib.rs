//! The commands of `hamel`, which print what [`hamel_engine`] computes.
//!
#![doc = include_str!("../README.md")]
//!
//! # Files
//!
//! | file | owns |
//! |---|---|
//! | `tables`, `regressor`, `check`, `ops`, `emit`, `eval`, `linearize`, `lqr`, `step`, `bode`, `trim`, `simulate`, `draw`, `sweep`, `compare`, `import` | one subcommand each |
//! | `linear` | linear systems as `lqr`, `step` and `bode` open them |
//! | `command` | the command line, with the feature of that name |
//! | `source`, `robot` | descriptions as the command line opens them, and the options for that |
//! | `reports` | reports of the commands, for other front ends |
//! | `absent` | messages of commands where a feature is missing |
//! | `series` | time series in CSV files |
//! | `parse` | numbers on the command line |
//! | `json`, `columns`, `outputs` | how results are written; pictures are those of `hamel-report` |
//! | `progress` | progress of long work |
//! | `failure` | errors and warnings as they are shown, and exit statuses |

//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `command` | the program `hamel`, its pictures and its progress bars |
//! | `sweep` | `hamel sweep`; without it this command says how to get it |
//! | `machine` | runs as machine code; without it functions are interpreted, on any target |

#![cfg_attr(docsrs, feature(doc_cfg))]
// Without the command line or sweeps, code that only they call is kept and unused.
#![cfg_attr(not(feature = "sweep"), allow(dead_code, unused_imports))]

#[cfg(feature = "command")]
mod absent;
#[cfg(feature = "command")]
mod bode;
mod check;
mod columns;
#[cfg(feature = "command")]
mod command;
mod compare;
#[cfg(feature = "command")]
mod draw;
#[cfg(feature = "command")]
mod emit;
#[cfg(feature = "command")]
mod eval;
mod failure;
#[cfg(feature = "command")]
mod import;
mod json;
#[cfg(feature = "command")]
mod linear;
#[cfg(feature = "command")]
mod linearize;
#[cfg(feature = "command")]
mod lqr;
mod ops;
#[cfg(feature = "command")]
mod outputs;
mod parse;
#[cfg(feature = "command")]
mod progress;
#[cfg(feature = "command")]
mod regressor;
#[cfg(feature = "command")]
mod report;
pub mod reports;
mod robot;
#[cfg(feature = "command")]
mod series;
#[cfg(feature = "command")]
mod simulate;
mod source;
#[cfg(feature = "command")]
mod step;
#[cfg(feature = "sweep")]
mod sweep;
mod tables;
#[cfg(feature = "command")]
mod trim;

pub use check::CheckedIdentity;
#[cfg(feature = "command")]
pub use command::{asked, command, described};
pub use compare::Comparison;
pub use failure::Failure;
#[cfg(feature = "command")]
pub use progress::Terminal;
#[cfg(feature = "command")]
pub use series::{SeriesError, read_series};
pub use tables::Format;
