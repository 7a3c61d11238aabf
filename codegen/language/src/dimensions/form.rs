//! Dimensions with unknowns: a known dimension times rational powers of unknown ones.

use crate::units::Dimension;
use num_rational::BigRational;
use num_traits::{One, Zero};
use std::collections::BTreeMap;

/// A dimension as a product of a known dimension and powers of unknown ones.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Form {
    /// The known factor.
    pub known: Dimension,
    /// Exponents of the unknowns by their numbers, none of them 0.
    pub unknowns: BTreeMap<usize, BigRational>,
}

impl Form {
    /// Creates a known dimension.
    pub fn known(known: Dimension) -> Self {
        let unknowns = BTreeMap::new();
        Form { known, unknowns }
    }

    /// Creates an unknown dimension.
    pub fn unknown(number: usize) -> Self {
        Form {
            known: Dimension::one(),
            unknowns: BTreeMap::from([(number, BigRational::one())]),
        }
    }

    /// Returns the product of this with a power of another.
    pub fn times(&self, other: &Form, exponent: &BigRational) -> Self {
        let mut product = self.clone();
        product.known = product.known.times(&other.known, exponent);
        for (number, power) in &other.unknowns {
            let sum = product
                .unknowns
                .entry(*number)
                .or_insert_with(BigRational::zero);
            *sum += power * exponent;
        }
        product.unknowns.retain(|_, power| !power.is_zero());
        product
    }

    /// Returns the dimension if nothing in it is unknown.
    pub fn as_known(&self) -> Option<&Dimension> {
        self.unknowns.is_empty().then_some(&self.known)
    }
}

/// The dimension of one number.
///
/// A plain number has the dimension that its place asks for where it is a term, a value or a side of a comparison; as a
/// factor it has none. Zero has every dimension.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Term {
    /// Zero.
    Zero,
    /// A plain number, or what is computed of plain numbers alone.
    Plain,
    /// A quantity.
    Quantity(Form),
}

impl Term {
    /// Creates the dimension of a quantity.
    pub fn of(dimension: Dimension) -> Self {
        Term::Quantity(Form::known(dimension))
    }

    /// Creates the dimension of a number or an angle.
    pub fn one() -> Self {
        Term::of(Dimension::one())
    }

    /// Returns the dimension of a product of this with a power of another, where the exponent is not 0.
    pub fn times(&self, other: &Term, exponent: &BigRational) -> Self {
        match (self, other) {
            (Term::Zero, _) => Term::Zero,
            (_, Term::Zero) if exponent > &BigRational::zero() => Term::Zero,
            (term, Term::Zero | Term::Plain) => term.clone(),
            (Term::Plain, Term::Quantity(other)) => {
                Term::Quantity(Form::known(Dimension::one()).times(other, exponent))
            }
            (Term::Quantity(own), Term::Quantity(other)) => {
                Term::Quantity(own.times(other, exponent))
            }
        }
    }

    /// Returns the dimension of a product.
    pub fn product(&self, other: &Term) -> Self {
        self.times(other, &BigRational::one())
    }

    /// Returns the dimension of a quotient.
    pub fn quotient(&self, other: &Term) -> Self {
        self.times(other, &-BigRational::one())
    }

    /// Returns the dimension of a power.
    pub fn power(&self, exponent: &BigRational) -> Self {
        match self {
            Term::Quantity(form) => {
                Term::Quantity(Form::known(Dimension::one()).times(form, exponent))
            }
            Term::Zero | Term::Plain if exponent.is_zero() => Term::Plain,
            plain => plain.clone(),
        }
    }
}
