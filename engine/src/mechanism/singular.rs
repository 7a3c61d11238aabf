//! Explains singular states in the terms of the description, such as the velocity without inertia.

use super::Instance;
use super::zero_divisors::Divisors;
use crate::error::Error;
use crate::names;
use crate::state::dependent_velocities::describe_constraint;
use hamel::{Singular, StepError, System};
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Model;
use hamel_codegen::program::Cause;
use nalgebra::DMatrix;
use std::fmt;

/// Pivots below this, relative to the original diagonal entry, are rounding errors of zero.
const PIVOT_TOLERANCE: f64 = 1e-12;
/// Largest number of constraints listed.
const MAX_LISTED: usize = 6;
/// Messages for singular states at which every velocity has inertia.
const CONFIGURATION: &str = "the mechanism is at a singular configuration, where its velocities do not determine its motion";
const DEPENDENT_CONSTRAINTS: &str = "the constraints on the velocities depend on one another";

/// Function of a system that had no value, with the x at which it had none.
#[derive(Clone, Debug)]
pub enum FailedFunction {
    /// ξ̇, or the velocities from momenta.
    Motion(Vec<f64>),
    /// The projection that closes loops, or that enforces constraints on velocities.
    Projection,
}

/// Returns the names of velocities for messages, with the lines on which they are declared.
pub fn velocity_labels(model: &Model, text: &str) -> Vec<String> {
    let names = names::velocities(model).into_iter();
    let label = |(place, name): (usize, String)| {
        let span = model.velocity_spans.get(place);
        let start = span.and_then(|span| Some(model.origins.source(*span).range()?.start));
        match start.and_then(|start| text.get(..start)) {
            Some(before) => format!("`{name}`, line {}", 1 + before.matches('\n').count()),
            None => format!("`{name}`"),
        }
    };
    names.enumerate().map(label).collect()
}

/// Composes the message for dependent constraints that multipliers enforce.
pub fn dependent_message(model: &Model, text: &str) -> String {
    let rows = model.constraints.iter().take(MAX_LISTED);
    let rows: Vec<String> = rows.map(|row| describe_constraint(row, text)).collect();
    match model.constraints.len() {
        0 => DEPENDENT_CONSTRAINTS.into(),
        count if count > MAX_LISTED => {
            format!("{DEPENDENT_CONSTRAINTS}: {} and others", rows.join(", "))
        }
        _ => format!("{DEPENDENT_CONSTRAINTS}: {}", rows.join(", ")),
    }
}

/// Reason why the motion has no value at a state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SingularState {
    /// A constraint was solved by dividing by a factor that is 0: the sentence says which.
    ZeroDivisor(String),
    /// The mass matrix is not positive definite.
    MassMatrix {
        /// The first pivot that is not positive, counted from 1.
        pivot: usize,
        /// Its velocity, with the line on which that is declared.
        velocity: String,
    },
    /// The velocities do not determine the motion of the mechanism.
    Configuration,
    /// Constraints on the velocities depend on one another: the sentence names them.
    DependentConstraints(String),
    /// Anything else.
    Other(Singular),
}

impl fmt::Display for SingularState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SingularState::ZeroDivisor(why) | SingularState::DependentConstraints(why) => {
                f.write_str(why)
            }
            SingularState::MassMatrix { pivot, velocity } => write!(
                f,
                "the mass matrix is not positive definite at pivot {pivot} ({velocity})"
            ),
            SingularState::Configuration => f.write_str(CONFIGURATION),
            SingularState::Other(cause) => cause.fmt(f),
        }
    }
}

impl std::error::Error for SingularState {}

/// Names the velocity at which a mass matrix fails to be positive definite; `None` if it is positive definite.
fn explain_mass_matrix(mass: &DMatrix<f64>, names: &[String]) -> Option<SingularState> {
    let (place, part) = weakest(mass)?;
    (part <= PIVOT_TOLERANCE).then(|| at_pivot(place, names))
}

fn at_pivot(place: usize, names: &[String]) -> SingularState {
    SingularState::MassMatrix {
        pivot: place + 1,
        velocity: names.get(place).cloned().unwrap_or_default(),
    }
}

/// Composes the message for a pivot of a function that is not positive.
pub fn cause_message(cause: Cause, model: &Model, text: &str) -> String {
    match cause {
        Cause::Velocity(place) => {
            let names = velocity_labels(model, text);
            let name = names.get(place).map_or("", String::as_str);
            format!("the mass matrix is not positive definite: {name} has no inertia")
        }
        Cause::Mass => "the mass matrix is not positive definite".into(),
        Cause::Constraint(_) => dependent_message(model, text),
        Cause::Kinematics(_) => CONFIGURATION.into(),
    }
}

/// Explains from the mass matrix at a state why ξ̇ has no value there.
fn state_message(mass: &DMatrix<f64>, names: &[String]) -> SingularState {
    explain_mass_matrix(mass, names).unwrap_or(SingularState::Configuration)
}

/// Explains why ξ̇ has no value with these parameters and this mass matrix: a division by 0, a singular M, or else a
/// singular configuration.
pub fn explain_singular_state(
    generated: &Generated,
    params: &[f64],
    mass: &DMatrix<f64>,
    text: &str,
) -> SingularState {
    let divisors = Divisors::of(generated, text);
    let divided = divisors
        .as_ref()
        .and_then(|all| all.message_if_zero(params));
    match divided {
        Some(divided) => SingularState::ZeroDivisor(divided.to_owned()),
        None => state_message(mass, &velocity_labels(&generated.active, text)),
    }
}

/// Finds the first row whose inertia, after elimination of the rows before it, is not positive, or else the row that
/// keeps the smallest fraction of its inertia; with that fraction.
fn weakest(mass: &DMatrix<f64>) -> Option<(usize, f64)> {
    let mut rest = mass.clone();
    let mut weakest: Option<(usize, f64)> = None;
    for k in 0..rest.nrows() {
        let pivot = rest[(k, k)];
        // NaN is not positive either.
        let part = Some(pivot / mass[(k, k)].abs()).filter(|part| *part > PIVOT_TOLERANCE);
        let Some(part) = part else {
            return Some((k, 0.0));
        };
        if weakest.is_none_or(|(_, least)| part < least) {
            weakest = Some((k, part));
        }
        for i in k + 1..rest.nrows() {
            let factor = rest[(i, k)] / pivot;
            for j in k + 1..rest.ncols() {
                rest[(i, j)] -= factor * rest[(k, j)];
            }
        }
    }
    weakest
}

impl Instance {
    /// Returns an error if the mass matrix is constant in time and not positive definite with the parameters.
    pub fn check_parameters(&self, x: &[f64]) -> Result<(), Error> {
        match self.constant_singular() {
            true => Err(Error::SingularParameters(self.state_message(x))),
            false => Ok(()),
        }
    }

    /// Evaluates ξ̇, or explains why it has no value.
    pub fn motion(&self, x: &[f64], xi: &[f64], u: &[f64]) -> Result<Vec<f64>, SingularState> {
        match self.forward_dynamics(&x.into(), &xi.into(), &u.into()) {
            Ok(_) if self.constant_singular() => Err(self.state_message(x)),
            Ok(xi_dot) => Ok(xi_dot.to_vec()),
            Err(cause) => Err(self.singular_message(cause)),
        }
    }

    /// Explains why ξ̇, a projection or a change to velocities has failed.
    pub fn singular_message(&self, cause: Singular) -> SingularState {
        if let Some(divided) = self.zero_divisor_message() {
            return SingularState::ZeroDivisor(divided.to_owned());
        }
        if let Singular::Kinematics { .. } = cause {
            return SingularState::Configuration;
        }
        let dependent =
            || SingularState::DependentConstraints(self.dependent_constraints_message().into());
        match self.last_failure() {
            Some(FailedFunction::Motion(x)) => {
                let mass = self.mass(&x);
                match (
                    explain_mass_matrix(&mass, self.velocity_labels()),
                    weakest(&mass),
                ) {
                    (Some(why), _) => why,
                    // Without constraints no other pivot can have failed.
                    (None, Some((place, _))) if !self.is_constrained() => {
                        at_pivot(place, self.velocity_labels())
                    }
                    _ => dependent(),
                }
            }
            Some(FailedFunction::Projection) => dependent(),
            None => SingularState::Other(cause),
        }
    }

    /// Explains why a step was not taken.
    pub fn step_error(&self, error: &StepError) -> Error {
        match error {
            StepError::Singular { cause, time } => Error::SingularStep {
                state: self.singular_message(*cause),
                time: *time,
            },
            other => Error::Step(*other),
        }
    }

    /// Explains why ξ̇ has no value at a state.
    pub fn state_message(&self, x: &[f64]) -> SingularState {
        if let Some(divided) = self.zero_divisor_message() {
            return SingularState::ZeroDivisor(divided.to_owned());
        }
        state_message(&self.mass(x), self.velocity_labels())
    }

    /// M at x.
    fn mass(&self, x: &[f64]) -> DMatrix<f64> {
        let n = self.velocity_labels().len();
        let still = self.momentum(x, &vec![0.0; n]);
        let mut mass = DMatrix::zeros(n, n);
        for column in 0..n {
            let mut xi = vec![0.0; n];
            xi[column] = 1.0;
            let momenta = self.momentum(x, &xi);
            for (row, (p, start)) in momenta.iter().zip(still.iter()).take(n).enumerate() {
                mass[(row, column)] = p - start;
            }
        }
        mass
    }
}

#[cfg(test)]
mod tests {
    use super::explain_mass_matrix;
    use nalgebra::DMatrix;

    #[test]
    fn the_velocity_without_inertia_is_named() {
        let names = ["`a`", "`w[1]`, line 3", "`w[2]`"].map(String::from);
        let told = |entries: [f64; 9]| {
            let state = explain_mass_matrix(&DMatrix::from_row_slice(3, 3, &entries), &names);
            state.map(|state| state.to_string())
        };
        assert_eq!(told([2.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 1.0]), None);
        // Row 2 is half of row 1: the rest is a rounding error.
        let dependent = told([0.3, 0.1, 0.0, 0.1, 0.1 * (0.1 / 0.3), 0.0, 0.0, 0.0, 1.0]);
        let expected = "the mass matrix is not positive definite at pivot 2 (`w[1]`, line 3)";
        assert_eq!(dependent.as_deref(), Some(expected));
        let nowhere = told([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f64::NAN]);
        assert!(nowhere.is_some_and(|why| why.ends_with("pivot 3 (`w[2]`)")));
    }
}
