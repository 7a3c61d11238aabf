//! A mechanical system that runs.
//!
#![doc = include_str!("../README.md")]
//!
//! # Modules
//!
//! | module | owns |
//! |---|---|
//! | [`source`] | descriptions and robots in URDF: reading and deriving them |
//! | [`state`] | the numbers of a state: reading and completing them |
//! | [`mechanism`] | a described system as the integrators run it, and explanations of its singular states |
//! | [`method`] | the methods by their names, and which systems they are for |
//! | [`baselines`] | methods that serve as baselines of comparisons |
//! | [`run`] | runs in time: plans, steps, inputs, events, samples |
//! | [`evaluate`], [`linearize`] | numbers at a state |
//! | [`linear`] | linear systems: steps, modes, zeros, regulators, responses |
//! | [`trim`] | equilibria and steady motions |
//! | [`drawing`] | the drawable parts of a mechanism at a state, as numbers |
//! | [`session`] | a description with everything that can be asked of it |
//! | [`reporter`] | warnings and progress, for a front end |
//! | [`error`] | errors as data |
//! | [`names`] | names of single numbers |
//! | [`option_text`] | texts of options that are lists, with places for error messages |
//!
//! Machine code is made by `hamel-native`, which holds the only `unsafe` code.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `machine` | runs by machine code; without it functions are evaluated step by step, on any target |

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod baselines;
pub mod drawing;
pub mod error;
pub mod evaluate;
pub mod linear;
pub mod linearize;
pub mod mechanism;
pub mod method;
pub mod names;
pub mod option_text;
pub mod reporter;
pub mod run;
pub mod session;
pub mod source;
pub mod state;
pub mod trim;

pub use drawing::{Drawing, ParametrizedDrawing, Scene};
pub use error::Error;
pub use evaluate::Evaluation;
pub use linear::{LinearError, LinearSystem};
pub use linearize::Linearization;
pub use reporter::{Quiet, Reporter, Warning, WarningTexts};
pub use run::{
    CancellationToken, ControlLaw, InputOptions, InputSource, Run, RunArrays, Samples, Simulation,
    Stepping, TimeSeries,
};
pub use session::{Function, Grip, Names, Session};
pub use source::{OpenOptions, Source};
pub use state::State;
pub use trim::{Trim, TrimOptions, TrimProblem};
