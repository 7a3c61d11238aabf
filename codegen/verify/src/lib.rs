//! The proof that stands before every emission, and what `hamel check` says.
//!
#![doc = include_str!("../README.md")]
//!
//! Everything here is derived once more, on routes that the emitted functions did not take, and compared at fresh
//! points of X modulo two primes.
//!
//! | file | object | KR18 |
//! |---|---|---|
//! | `validate` | every emitted function is the one that the equations imply | (30) |
//! | `constrained` | the same where constraints act on ξ | |
//! | `charts` | the rates of charts are those that K leads back to ẋ | |
//! | `correction` | the stabilising term leads back to X | (8) |
//! | `splitting` | the functions of a system that splits | |
//! | `numbers` | the three forms at points modulo p: what every build is compared with | (30) |
//! | `slopes` | the linearisation, by dual numbers modulo p | |
//! | `regressor` | base parameters and the columns that go with them | |
//! | `outputs` | outputs of constrained systems, and slopes of outputs | |
//! | `centroidal` | the centre of mass, and the momentum about it | |
//! | `frames` | poses, twists, Jacobians and bias accelerations of frames | |
//! | `states` | rates of states of first order, and their slopes | |
//! | `virtual_power` | loads as forces on points, motion of points | (28) |
//! | `hamel_form` | equations of Lagrange and Hamel, from T and γ | (30a) |
//! | `gibbs` | equations of Gibbs and Appell, from accelerations | (30b) |
//! | `levi_civita` | explicit equations, from M and Γ | (30c) |
//! | `forms` | all symbols side by side, to be compared | (30) |
//! | `check`, `motion` | the identities that any derivation has to satisfy | (6), (12), (13), (21), (28) |
//! | `invariants` | claims of constancy along the motion, proved or refuted | |
//! | `points` | the fresh points that all of it is compared at | |
//! | `confidence` | what equality at random points says | |
//! | `verdict` | what a proof says | |

mod centroidal;
mod charts;
pub mod check;
pub mod confidence;
// Open to tests, which put wrong signs in.
#[doc(hidden)]
pub mod constrained;
pub mod correction;
mod derivatives;
pub mod forms;
mod frames;
pub mod gibbs;
pub mod hamel_form;
pub mod invariants;
mod kernel;
pub mod levi_civita;
pub mod motion;
// As above.
#[doc(hidden)]
pub mod numbers;
mod outputs;
mod points;
// As above.
#[doc(hidden)]
pub mod reference;
pub mod regressor;
mod slopes;
mod splitting;
mod states;
pub mod validate;
mod verdict;
pub mod virtual_power;

use hamel_dynamics::reduction::Reduction;
use hamel_dynamics::regressor::Regressor;
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::Model;
use hamel_program::Program;

/// Proves the functions of a program, and that what the description claims to be constant along the motion is;
/// `reduction` solves its constraints,
/// `regressor` are the base parameters where they are asked for. Claims about a motion with constraints are held against the ξ̇
/// of `motion`, a program that was proved itself.
///
/// # Errors
/// A fault of the generator, with the identities that are broken; or the claims that are false.
pub fn prove(
    model: &Model,
    reduction: Option<&Reduction>,
    regressor: Option<&Regressor>,
    [program, motion]: [&Program; 2],
) -> Result<(), Vec<Diagnostic>> {
    let one = |error| vec![error];
    match reduction {
        Some(reduction) => constrained::validate(model, reduction, program).map_err(one)?,
        None => validate::validate(model, program).map_err(one)?,
    }
    correction::validate(model, program).map_err(one)?;
    if let Some(derived) = regressor {
        regressor::validate(model, derived, program).map_err(one)?;
    }
    match reduction {
        Some(reduction) => invariants::constrained::refute(&reduction.model, motion),
        None => invariants::refute(model),
    }
}
