//! Units of measurement: products of powers of named units, with their dimensions and exact factors to SI.

mod dimension;
mod table;

pub use dimension::{BASE, Dimension};
pub use table::{names, suggestions};

use crate::syntax::ast::Span;
use num_rational::BigRational;
use num_traits::{One, ToPrimitive};

/// Largest exponent in a unit.
pub const MOST_POWER: u32 = 99;

/// A unit as it stands in brackets: `kg*m^2/s`. One of it is `factor` · π^`pi` of the SI unit of its dimension.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Its text, without blanks.
    pub text: String,
    /// Rational part of the factor to SI.
    pub factor: BigRational,
    /// Exponent of π in the factor to SI.
    pub pi: i32,
    /// Its dimension.
    pub dimension: Dimension,
    /// Position in the source.
    pub span: Span,
}

impl Unit {
    /// Returns the unit 1.
    pub fn one() -> Self {
        Unit {
            text: "1".into(),
            factor: BigRational::one(),
            pi: 0,
            dimension: Dimension::one(),
            span: Span::NOWHERE,
        }
    }

    /// Returns a named unit, with its prefix if it has one, such as `kg`, `mm` or `deg`.
    pub fn named(name: &str) -> Option<Self> {
        let (factor, pi, exponents) = table::find(name)?;
        Some(Unit {
            text: name.to_owned(),
            factor,
            pi,
            dimension: Dimension::of(exponents),
            ..Unit::one()
        })
    }

    /// Returns whether this is the unit that SI has for its dimension, so that numbers need no conversion.
    pub fn is_si(&self) -> bool {
        self.pi == 0 && self.factor.is_one()
    }

    /// Multiplies by a power of another unit; the text is left as it is. Returns `None` if the exponent is not whole
    /// and the factor of that unit is not 1, since its root need not be rational, or if a factor becomes too large.
    pub fn multiply(&mut self, other: &Unit, exponent: &BigRational) -> Option<()> {
        if !other.is_si() {
            let whole = Some(exponent).filter(|exponent| exponent.is_integer())?;
            let whole = whole.to_integer().to_i32()?;
            self.factor *= other.factor.pow(whole);
            self.pi += other.pi * whole;
        }
        self.dimension = self.dimension.times(&other.dimension, exponent);
        Some(())
    }
}
