//! Explains singular states in terms of the description: finds the velocity without inertia.

use crate::divided::Divisors;
use crate::failure::Failure;
use crate::mechanism::Instance;
use crate::names;
use crate::number::short;
use crate::state::solved::shown;
use hamel::{Singular, StepError, System};
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Model;
use hamel_codegen::program::Cause;
use nalgebra::DMatrix;

/// Pivots below this, relative to the original diagonal entry, are rounding errors of zero.
const PIVOT_TOLERANCE: f64 = 1e-12;
/// Largest number of constraints listed.
const MAX_LISTED: usize = 6;
/// Messages for singular states at which every velocity has inertia.
const CONFIGURATION: &str = "the mechanism is at a singular configuration, where its velocities do not determine its motion";
const DEPENDENT_CONSTRAINTS: &str = "the constraints on the velocities depend on one another";

/// The function that had no value, with x.
#[derive(Clone, Debug)]
pub enum Failed {
    /// ξ̇, or the velocities from momenta.
    Motion(Vec<f64>),
    /// The projection that closes loops, or that enforces constraints on velocities.
    Projection,
}

/// Names of velocities for messages, with the lines on which they are declared.
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

/// The message for dependent constraints that multipliers enforce.
pub fn dependent_message(model: &Model, text: &str) -> String {
    let rows = model.constraints.iter().take(MAX_LISTED);
    let rows: Vec<String> = rows.map(|row| shown(row, text)).collect();
    match model.constraints.len() {
        0 => DEPENDENT_CONSTRAINTS.into(),
        count if count > MAX_LISTED => {
            format!("{DEPENDENT_CONSTRAINTS}: {} and others", rows.join(", "))
        }
        _ => format!("{DEPENDENT_CONSTRAINTS}: {}", rows.join(", ")),
    }
}

/// The message for a mass matrix that is not positive definite, with the labels of its rows.
pub fn mass_message(mass: &DMatrix<f64>, names: &[String]) -> Option<String> {
    let (place, part) = weakest(mass)?;
    (part <= PIVOT_TOLERANCE).then(|| pivot_message(place, names))
}

fn pivot_message(place: usize, names: &[String]) -> String {
    let name = names.get(place).map_or("", String::as_str);
    let number = place + 1;
    format!("the mass matrix is not positive definite at pivot {number} ({name})")
}

/// The message for a pivot of a function that is not positive.
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

/// The message for a state where ξ̇ has no value, from the mass matrix there.
pub fn state_message(mass: &DMatrix<f64>, names: &[String]) -> String {
    mass_message(mass, names).unwrap_or_else(|| CONFIGURATION.into())
}

/// Like [`state_message`], for a description with parameters: divisions by 0 are reported first.
pub fn description_message(
    generated: &Generated,
    params: &[f64],
    mass: &DMatrix<f64>,
    text: &str,
) -> String {
    let divisors = Divisors::of(generated, text);
    let divided = divisors.as_ref().and_then(|all| all.zero(params));
    match divided {
        Some(divided) => divided.to_owned(),
        None => state_message(mass, &velocity_labels(&generated.active, text)),
    }
}

/// The first row whose inertia, after elimination of the rows before it, is not positive, or else the row that keeps
/// the smallest fraction of its inertia; with that fraction.
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
    /// Fails if the mass matrix is constant in time and not positive definite with the parameters.
    pub fn check_parameters(&self, x: &[f64]) -> Result<(), Failure> {
        match self.constant_singular() {
            true => Err(Failure::failed(format!(
                "{} with these parameters",
                self.state_message(x)
            ))),
            false => Ok(()),
        }
    }

    /// ξ̇, or the reason why it has no value.
    pub fn motion(&self, x: &[f64], xi: &[f64], u: &[f64]) -> Result<Vec<f64>, String> {
        match self.accel(&x.into(), &xi.into(), &u.into()) {
            Ok(_) if self.constant_singular() => Err(self.state_message(x)),
            Ok(xi_dot) => Ok(xi_dot.to_vec()),
            Err(cause) => Err(self.singular_message(cause)),
        }
    }

    /// The message for a failure of ξ̇, of a projection or of a change of velocities.
    pub fn singular_message(&self, cause: Singular) -> String {
        if let Some(divided) = self.divided() {
            return divided.to_owned();
        }
        if let Singular::Kinematics { .. } = cause {
            return CONFIGURATION.into();
        }
        match self.failed() {
            Some(Failed::Motion(x)) => {
                let mass = self.mass(&x);
                match (mass_message(&mass, self.velocity_labels()), weakest(&mass)) {
                    (Some(why), _) => why,
                    // Without constraints no other pivot can have failed.
                    (None, Some((place, _))) if !self.is_constrained() => {
                        pivot_message(place, self.velocity_labels())
                    }
                    _ => self.dependent().into(),
                }
            }
            Some(Failed::Projection) => self.dependent().into(),
            None => cause.to_string(),
        }
    }

    /// The message for a failed step.
    pub fn step_message(&self, error: &StepError) -> String {
        match error {
            StepError::Singular { cause, time } => {
                let why = self.singular_message(*cause);
                format!("{why}, in the step from t = {}", short(*time))
            }
            other => other.to_string(),
        }
    }

    /// The message for a state where ξ̇ has no value.
    pub fn state_message(&self, x: &[f64]) -> String {
        if let Some(divided) = self.divided() {
            return divided.to_owned();
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
    use super::mass_message;
    use nalgebra::DMatrix;

    #[test]
    fn the_velocity_without_inertia_is_named() {
        let names = ["`a`", "`w[1]`, line 3", "`w[2]`"].map(String::from);
        let message =
            |entries: [f64; 9]| mass_message(&DMatrix::from_row_slice(3, 3, &entries), &names);
        assert_eq!(message([2.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 1.0]), None);
        // Row 2 is half of row 1: the rest is a rounding error.
        let dependent = message([0.3, 0.1, 0.0, 0.1, 0.1 * (0.1 / 0.3), 0.0, 0.0, 0.0, 1.0]);
        let expected = "the mass matrix is not positive definite at pivot 2 (`w[1]`, line 3)";
        assert_eq!(dependent.as_deref(), Some(expected));
        let nowhere = message([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f64::NAN]);
        assert!(nowhere.is_some_and(|why| why.ends_with("pivot 3 (`w[2]`)")));
    }
}
