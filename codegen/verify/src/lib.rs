//! Proofs of generated functions, required before every emission, and the identities that `hamel check` reports.
//!
#![doc = include_str!("../README.md")]
//!
//! Every emitted function is derived a second time, along routes that the generator did not take, and both results are
//! compared at fresh points of X modulo two primes.
//!
//! | file | object | KR18 |
//! |---|---|---|
//! | `validate` | every emitted function agrees with the equations of motion | (30) |
//! | `constrained` | the same for systems with constraints on ξ | |
//! | `charts` | the rates of charts times their tangents K are ẋ | |
//! | `correction` | the stabilising term leads back to X | (8) |
//! | `splitting` | the functions of a system that splits | |
//! | `numbers` | the three forms of the equations at points modulo p, the reference of every build | (30) |
//! | `slopes` | the linearisation, by dual numbers modulo p | |
//! | `regressor` | base parameters and their regressor columns | |
//! | `outputs` | outputs of constrained systems, and derivatives of outputs | |
//! | `centroidal` | the centre of mass, and the momentum about it | |
//! | `frames` | poses, twists, Jacobians and bias accelerations of frames | |
//! | `states` | rates of states of first order, and their derivatives | |
//! | `virtual_power` | loads as forces on points, motion of points | (28) |
//! | `hamel_form` | equations of Lagrange and Hamel, from T and γ | (30a) |
//! | `gibbs` | equations of Gibbs and Appell, from accelerations | (30b) |
//! | `levi_civita` | explicit equations, from M and Γ | (30c) |
//! | `forms` | all quantities that identities compare | (30) |
//! | `check`, `motion` | the identities that any derivation has to satisfy | (6), (12), (13), (21), (28) |
//! | `invariants` | claimed constants of the motion, proved or refuted | |
//! | `points` | the fresh points at which everything is compared | |
//! | `confidence` | the chance of error of equality at random points | |
//! | `verdict` | the result of a proof | |
//! | `violation` | identities that a program violates | |

mod centroidal;
mod charts;
pub mod check;
pub mod confidence;
// Public for tests, which insert wrong signs.
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
// Public for tests, as above.
#[doc(hidden)]
pub mod numbers;
mod outputs;
mod points;
// Public for tests, as above.
#[doc(hidden)]
pub mod reference;
pub mod regressor;
mod slopes;
mod splitting;
mod states;
pub mod validate;
mod verdict;
mod violation;
pub mod virtual_power;

use hamel_dynamics::reduction::Reduction;
use hamel_dynamics::regressor::Regressor;
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::Model;
use hamel_program::Program;
pub use violation::{RegressorFault, Violation};

/// Proves the functions of a program, and the claims of the description that quantities are constant along the motion.
///
/// `reduction` solves the constraints of the model, if it has any; `regressor` holds the base parameters, if they are
/// asked for. `motion` is a program that has been proved itself: its ξ̇ decides claims about systems with constraints.
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
        Some(reduction) => {
            invariants::constrained::reject_false_constrained_invariants(&reduction.model, motion)
        }
        None => invariants::reject_false_invariants(model),
    }
}
