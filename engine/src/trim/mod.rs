//! Trim: equilibria and steady motions.
//!
//! Unknowns are x, on the manifold with closed loops, velocities, states of first order and inputs that are free.
//! Conditions are ξ̇ = 0 for the independent velocities, ż = 0, what the caller fixes and, for a steady motion,
//! d/dt ξ̇ = 0 along the motion, A (ξ, ξ̇, ż) = 0 with the rows of A that belong to ξ̇ and ż.

mod conditions;
mod directions;
mod problem;
mod solve;

pub use directions::{Direction, Spectrum, Stability};
pub use problem::{TrimOptions, TrimProblem, Unmet};

use crate::error::Error;
use crate::option_text::Piece;
use crate::session::SingleStepper;
use crate::source::Source;
use crate::source::added_outputs::{self, AddedOutput};
use crate::state::State;
use conditions::Conditions;
use hamel_codegen::algebra::dense::largest;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::Generated;
use solve::{Solution, search};

/// Option that adds equations.
const FIX: &str = "--fix";
/// Number of steps by which a steady motion is confirmed.
const CONFIRMING_STEPS: u32 = 20;
/// Length of one of these steps, relative to the time in which the motion turns or changes by 1.
const CONFIRMING_STEP: f64 = 0.01;
/// Largest change of a velocity in these steps, relative to 1 or to the largest velocity.
const STEADY_TOLERANCE: f64 = 1e-7;

/// Equilibrium or steady motion.
#[derive(Clone, Debug)]
pub struct Trim {
    /// The state found, with its inputs and parameters.
    pub state: State,
    /// ξ of the full frame.
    pub full: Vec<f64>,
    /// Largest absolute residual of all conditions.
    pub residual: f64,
    /// Number of steps of the search.
    pub steps: usize,
    /// Number of the neighbour of the start from which the search led to the state; 0 if it did from the start itself.
    pub neighbour: usize,
    /// Numbers of unknowns and of conditions.
    pub unknowns: usize,
    /// Number of conditions.
    pub conditions: usize,
    /// Rank of the conditions at the solution.
    pub rank: usize,
    /// Directions along which solutions form a family.
    pub undetermined: Vec<Direction>,
    /// Eigenvalues of the motion; `None` if they were not found.
    pub spectrum: Option<Spectrum>,
    /// ξ̇ and ż.
    pub xi_dot: Vec<f64>,
}

/// Derives a description with its linearisation and with the equations of a trim as outputs.
///
/// # Errors
/// The description or an equation has errors.
pub fn derive(source: &Source, options: &TrimOptions) -> Result<Generated, Error> {
    let joined = options.fix.join("; ");
    let (mut added, mut errors, mut start) = (Vec::new(), Vec::<Diagnostic>::new(), 0);
    for (item, text) in options.fix.iter().enumerate() {
        let whole = Piece { text, start };
        start += text.len() + "; ".len();
        if let Err(error) = Piece::of(text) {
            errors.push(whole.moved(error));
            continue;
        }
        let sides = whole.sides();
        if sides.len() != 2 || sides.iter().any(|side| side.text.is_empty()) || text.contains(';') {
            errors.push(whole.wrong("expected one equation, as in `speed = 30`"));
            continue;
        }
        added.push(AddedOutput {
            name: added_outputs::name(item),
            whole,
            sides,
        });
    }
    added_outputs::derive(
        source,
        (FIX, &joined),
        &added,
        errors,
        Source::try_derive_linearized,
    )
}

/// Finds the equilibrium or steady motion to which a search from a state leads; `generated` is the result of [`derive()`]
/// with the same options, `shown` the text whose line numbers messages give.
///
/// # Errors
/// A name is unknown, or there is no solution near the state; see [`TrimProblem`].
pub fn trim(
    generated: &Generated,
    start: &State,
    options: &TrimOptions,
    shown: &str,
) -> Result<Trim, Error> {
    let conditions = Conditions::new(generated, options, &start.params)?;
    let point = conditions.start(start).ok_or(TrimProblem::NoStart)?;
    let stepper = match options.steady {
        true => Some(SingleStepper::of(generated, start, shown)?),
        false => None,
    };
    let confirm = |solution: &Solution| match &stepper {
        Some(stepper) => confirm_steady(&conditions, solution, stepper),
        None => Ok(()),
    };
    let (solution, neighbour) = search(&conditions, &point, &confirm)?;
    let (rank, undetermined) = directions::undetermined(&conditions, &solution)?;
    let Solution {
        point,
        local,
        steps,
        ..
    } = solution;
    let spectrum = directions::spectrum(&conditions, &local);
    Ok(Trim {
        residual: largest(&local.residuals),
        steps,
        neighbour,
        unknowns: local.columns.len(),
        conditions: local.rows.len(),
        rank,
        undetermined,
        spectrum,
        xi_dot: local.xi_dot,
        state: point.state,
        full: point.full,
    })
}

/// Confirms by a short run that velocities stay constant, or change as they should.
fn confirm_steady(
    conditions: &Conditions,
    Solution { point, local, .. }: &Solution,
    stepper: &SingleStepper,
) -> Result<(), TrimProblem> {
    let spectrum = directions::spectrum(conditions, local);
    let fastest = spectrum.iter().flat_map(|spectrum| &spectrum.values);
    let fastest = fastest.map(|(re, im)| re.hypot(*im));
    let step = CONFIRMING_STEP / fastest.fold(largest(&point.full).max(1.0), f64::max);
    let State {
        mut x, mut xi, u, ..
    } = point.state.clone();
    for _ in 0..CONFIRMING_STEPS {
        let stepped = stepper.step(&mut x, &mut xi, &u, step);
        stepped.map_err(|_| TrimProblem::LeavesDomain { steps: 0 })?;
    }
    let time = f64::from(CONFIRMING_STEPS) * step;
    let most = largest(&point.state.xi).max(1.0);
    let moving = local
        .kept
        .iter()
        .filter_map(|k| k.checked_sub(conditions.sizes[0]));
    let changes = moving.map(|i| (i, xi[i] - point.state.xi[i] - time * local.xi_dot[i]));
    for (i, change) in changes {
        if change.is_nan() || change.abs() > STEADY_TOLERANCE * most {
            let condition = conditions.name(i);
            let residual = change / time;
            return Err(TrimProblem::NotSteady(Unmet {
                condition,
                residual,
            }));
        }
    }
    Ok(())
}
