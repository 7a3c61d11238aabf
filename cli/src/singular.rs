//! Singular states in the names of the description: which velocity has no inertia.

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

/// Pivots that are smaller than this part of the diagonal entry that they began as are rounding of zero.
const ROUNDING: f64 = 1e-12;
/// Constraints listed at most.
const LISTED: usize = 6;
/// What is said where no inertia is missing.
const CONFIGURATION: &str = "the mechanism is at a singular configuration, where its velocities do not determine its motion";
const DEPENDENT: &str = "the constraints on the velocities depend on one another";

/// Which function had no value, and at which x.
#[derive(Clone, Debug)]
pub enum Failed {
    /// ξ̇, or the velocities of momenta.
    Motion(Vec<f64>),
    /// The step that closes loops, or the one that keeps constraints on velocities.
    Projection,
}

/// Velocities as messages call them, with the lines on which they are declared.
pub fn labels(model: &Model, text: &str) -> Vec<String> {
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

/// What is said where constraints that are kept by multipliers depend on one another.
pub fn dependent(model: &Model, text: &str) -> String {
    let rows = model.constraints.iter().take(LISTED);
    let rows: Vec<String> = rows.map(|row| shown(row, text)).collect();
    match model.constraints.len() {
        0 => DEPENDENT.into(),
        count if count > LISTED => format!("{DEPENDENT}: {} and others", rows.join(", ")),
        _ => format!("{DEPENDENT}: {}", rows.join(", ")),
    }
}

/// What a mass matrix that is not positive definite is told as, by the labels of its rows.
pub fn of_mass(mass: &DMatrix<f64>, names: &[String]) -> Option<String> {
    let (place, part) = weakest(mass)?;
    (part <= ROUNDING).then(|| told(place, names))
}

fn told(place: usize, names: &[String]) -> String {
    let name = names.get(place).map_or("", String::as_str);
    let number = place + 1;
    format!("the mass matrix is not positive definite at pivot {number} ({name})")
}

/// What it means that a pivot of a function is not positive.
pub fn meaning(cause: Cause, model: &Model, text: &str) -> String {
    match cause {
        Cause::Velocity(place) => {
            let names = labels(model, text);
            let name = names.get(place).map_or("", String::as_str);
            format!("the mass matrix is not positive definite: {name} has no inertia")
        }
        Cause::Mass => "the mass matrix is not positive definite".into(),
        Cause::Constraint(_) => dependent(model, text),
        Cause::Kinematics(_) => CONFIGURATION.into(),
    }
}

/// What is said of a state where ξ̇ has no value, from the mass matrix there.
pub fn at(mass: &DMatrix<f64>, names: &[String]) -> String {
    of_mass(mass, names).unwrap_or_else(|| CONFIGURATION.into())
}

/// The same of a description with parameters: what was divided by 0 comes first.
pub fn of(generated: &Generated, params: &[f64], mass: &DMatrix<f64>, text: &str) -> String {
    let divisors = Divisors::of(generated, text);
    let divided = divisors.as_ref().and_then(|all| all.zero(params));
    match divided {
        Some(divided) => divided.to_owned(),
        None => at(mass, &labels(&generated.active, text)),
    }
}

/// The first row whose inertia, with the rows before it eliminated, is not positive, else the one that keeps
/// the least part of its inertia; with that part.
fn weakest(mass: &DMatrix<f64>) -> Option<(usize, f64)> {
    let mut rest = mass.clone();
    let mut weakest: Option<(usize, f64)> = None;
    for k in 0..rest.nrows() {
        let pivot = rest[(k, k)];
        // What is not a number is not positive either.
        let part = Some(pivot / mass[(k, k)].abs()).filter(|part| *part > ROUNDING);
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
    /// An error where the mass matrix is constant in time, and not positive definite with the parameters.
    pub fn check_parameters(&self, x: &[f64]) -> Result<(), Failure> {
        match self.constant_singular() {
            true => Err(Failure::failed(format!(
                "{} with these parameters",
                self.at(x)
            ))),
            false => Ok(()),
        }
    }

    /// ξ̇, or why it has no value.
    pub fn motion(&self, x: &[f64], xi: &[f64], u: &[f64]) -> Result<Vec<f64>, String> {
        match self.forward_dynamics(&x.into(), &xi.into(), &u.into()) {
            Ok(_) if self.constant_singular() => Err(self.at(x)),
            Ok(xi_dot) => Ok(xi_dot.to_vec()),
            Err(cause) => Err(self.singular(cause)),
        }
    }

    /// What is said of a failure of ξ̇, of a projection or of a change to velocities.
    pub fn singular(&self, cause: Singular) -> String {
        if let Some(divided) = self.divided() {
            return divided.to_owned();
        }
        if let Singular::Kinematics { .. } = cause {
            return CONFIGURATION.into();
        }
        match self.failed() {
            Some(Failed::Motion(x)) => {
                let mass = self.mass(&x);
                match (of_mass(&mass, self.velocity_labels()), weakest(&mass)) {
                    (Some(why), _) => why,
                    // Without constraints no other pivot can have failed.
                    (None, Some((place, _))) if !self.is_constrained() => {
                        told(place, self.velocity_labels())
                    }
                    _ => self.dependent().into(),
                }
            }
            Some(Failed::Projection) => self.dependent().into(),
            None => cause.to_string(),
        }
    }

    /// What is said of a step that was not taken.
    pub fn said(&self, error: &StepError) -> String {
        match error {
            StepError::Singular { cause, time } => {
                let why = self.singular(*cause);
                format!("{why}, in the step from t = {}", short(*time))
            }
            other => other.to_string(),
        }
    }

    /// What is said of a state where ξ̇ has no value.
    pub fn at(&self, x: &[f64]) -> String {
        if let Some(divided) = self.divided() {
            return divided.to_owned();
        }
        at(&self.mass(x), self.velocity_labels())
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
    use super::of_mass;
    use nalgebra::DMatrix;

    #[test]
    fn the_velocity_without_inertia_is_named() {
        let names = ["`a`", "`w[1]`, line 3", "`w[2]`"].map(String::from);
        let told = |entries: [f64; 9]| of_mass(&DMatrix::from_row_slice(3, 3, &entries), &names);
        assert_eq!(told([2.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 1.0]), None);
        // Row 2 is half of row 1: what is left of it is rounding.
        let dependent = told([0.3, 0.1, 0.0, 0.1, 0.1 * (0.1 / 0.3), 0.0, 0.0, 0.0, 1.0]);
        let expected = "the mass matrix is not positive definite at pivot 2 (`w[1]`, line 3)";
        assert_eq!(dependent.as_deref(), Some(expected));
        let nowhere = told([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f64::NAN]);
        assert!(nowhere.is_some_and(|why| why.ends_with("pivot 3 (`w[2]`)")));
    }
}
