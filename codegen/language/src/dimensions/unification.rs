//! Equations between dimensions, solved for the unknown ones as they arise: linear equations over the rational numbers.

use super::form::{Form, Term};
use crate::syntax::ast::Span;
use num_rational::BigRational;
use num_traits::One;

/// An unknown dimension.
#[derive(Debug)]
struct Unknown {
    /// Description of the quantity that has this dimension, for messages.
    name: String,
    /// Its solution, which may contain unknowns that were solved later, and the place of the equation.
    solution: Option<(Form, Span)>,
}

/// The unknown dimensions of a description, and what is known of them.
#[derive(Debug, Default)]
pub struct Unknowns {
    all: Vec<Unknown>,
}

/// Two dimensions that should be one.
#[derive(Debug)]
pub struct Mismatch {
    /// The first.
    pub first: Form,
    /// The second.
    pub second: Form,
}

impl Unknowns {
    /// Creates an unknown dimension.
    pub fn fresh(&mut self, name: &str) -> Term {
        self.all.push(Unknown {
            name: name.to_owned(),
            solution: None,
        });
        Term::Quantity(Form::unknown(self.all.len() - 1))
    }

    /// Returns the name of an unknown.
    pub fn name(&self, number: usize) -> &str {
        &self.all[number].name
    }

    /// Returns the place of the equation that determined one of the unknowns of a form.
    pub fn place(&self, form: &Form) -> Option<Span> {
        let solutions = form.unknowns.keys().rev();
        let mut places = solutions.filter_map(|number| self.all[*number].solution.as_ref());
        places.next().map(|(_, at)| *at)
    }

    /// Replaces the unknowns that have solutions.
    pub fn reduced(&self, form: &Form) -> Form {
        let mut form = form.clone();
        let solved = |form: &Form| {
            let mut all = form.unknowns.iter();
            let (number, power) = all.find(|(number, _)| self.all[**number].solution.is_some())?;
            Some((*number, power.clone()))
        };
        // A solution contains only unknowns that were solved after it, so that this ends.
        while let Some((number, power)) = solved(&form) {
            form.unknowns.remove(&number);
            if let Some((solution, _)) = &self.all[number].solution {
                form = form.times(solution, &power);
            }
        }
        form
    }

    /// Demands that two dimensions are one, and returns it. If their quotient contains unknowns, the last of them
    /// follows from the others.
    pub fn unify(&mut self, first: &Term, second: &Term, at: Span) -> Result<Term, Mismatch> {
        let (a, b) = match (first, second) {
            (Term::Zero, other) | (other, Term::Zero) => return Ok(other.clone()),
            (Term::Plain, other) | (other, Term::Plain) => return Ok(other.clone()),
            (Term::Quantity(a), Term::Quantity(b)) => (a, b),
        };
        let quotient = self.reduced(&a.times(b, &-BigRational::one()));
        match quotient.unknowns.iter().next_back() {
            Some((&number, power)) => {
                let mut rest = quotient.clone();
                rest.unknowns.remove(&number);
                let one = Form::known(crate::units::Dimension::one());
                let solution = one.times(&rest, &-power.recip());
                self.all[number].solution = Some((solution, at));
                Ok(first.clone())
            }
            None if quotient.known.is_one() => Ok(first.clone()),
            None => Err(Mismatch {
                first: self.reduced(a),
                second: self.reduced(b),
            }),
        }
    }

    /// Describes a dimension in words.
    pub fn describe(&self, form: &Form) -> String {
        let form = self.reduced(form);
        let Some((number, _)) = form.unknowns.iter().next() else {
            return form.known.describe();
        };
        let name = self.name(*number);
        match form.known.is_one() {
            true => format!("a quantity whose dimension depends on that of `{name}`"),
            false => format!(
                "a quantity in [{}] times one that depends on `{name}`",
                form.known
            ),
        }
    }
}
