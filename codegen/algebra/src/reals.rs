//! Real values of expressions, in addition to those modulo p: they distinguish e from −e and from |e|.
//!
//! A square root modulo p is one of two, so expressions with the same value modulo p may differ as real
//! numbers by the sign of a root. Where a root is involved, equal values modulo p therefore count only if
//! no real sample contradicts them: both expressions must be the same number, and the one that is kept must
//! have a value wherever the other has one. Values carry a bound of their rounding errors. Where the value
//! of a symbol is not known, a sample says nothing.

use std::cmp::Ordering;

/// Number of real samples. Except by bad luck, |e| and e differ at one of them.
pub const SAMPLES: usize = 8;

/// A real number and a bound of its error. If the number is NaN, an error of 0 says that the number does
/// not exist, such as a root of −1; any other error says that it is not known.
#[derive(Clone, Copy, Debug)]
pub struct Real {
    /// Value of the number.
    pub value: f64,
    /// Bound of the absolute error.
    pub error: f64,
}

/// A real number at each sample.
pub type Reals = [Real; SAMPLES];

impl Real {
    /// A number that is not known.
    pub const UNKNOWN: Real = Real {
        value: f64::NAN,
        error: f64::NAN,
    };

    /// A number that does not exist.
    pub const UNDEFINED: Real = Real {
        value: f64::NAN,
        error: 0.0,
    };

    /// Creates a number that is off by at most `error`.
    pub fn new(value: f64, error: f64) -> Self {
        Real { value, error }
    }

    /// Whether the number exists and is known.
    pub(super) fn is_known(self) -> bool {
        !self.value.is_nan()
    }

    fn is_undefined(self) -> bool {
        self.value.is_nan() && self.error == 0.0
    }

    /// Result of an operation of which an operand is not a known number.
    pub(super) fn without(self, b: Real) -> Self {
        if self.is_undefined() || b.is_undefined() {
            Real::UNDEFINED
        } else {
            Real::UNKNOWN
        }
    }

    /// Creates a number that was rounded once more.
    fn rounded(value: f64, error: f64) -> Self {
        if !value.is_finite() || !error.is_finite() {
            return Real::UNKNOWN;
        }
        Real {
            value,
            error: error + value.abs() * f64::EPSILON,
        }
    }

    /// Returns −a if `negative`, else a.
    pub fn signed(self, negative: bool) -> Self {
        Real {
            value: if negative { -self.value } else { self.value },
            error: self.error,
        }
    }

    /// a + b.
    pub fn plus(self, b: Real) -> Self {
        if !self.is_known() || !b.is_known() {
            return self.without(b);
        }
        Real::rounded(self.value + b.value, self.error + b.error)
    }

    /// a · b.
    pub fn times(self, b: Real) -> Self {
        if !self.is_known() || !b.is_known() {
            return self.without(b);
        }
        let error = self.value.abs() * b.error + self.error * b.value.abs() + self.error * b.error;
        Real::rounded(self.value * b.value, error)
    }

    /// a / b; unknown where b may be 0.
    pub fn over(self, b: Real) -> Self {
        if !self.is_known() || !b.is_known() {
            return self.without(b);
        }
        let least = b.value.abs() - b.error;
        if least > 0.0 {
            let quotient = self.value / b.value;
            Real::rounded(quotient, (self.error + quotient.abs() * b.error) / least)
        } else {
            Real::UNKNOWN
        }
    }

    pub(super) fn sin(self) -> Self {
        Real::rounded(self.value.sin(), self.error)
    }

    pub(super) fn cos(self) -> Self {
        Real::rounded(self.value.cos(), self.error)
    }

    pub(super) fn exp(self) -> Self {
        let value = self.value.exp();
        Real::rounded(value, value * self.error.exp_m1())
    }

    pub(super) fn sinh(self) -> Self {
        let slope = (self.value.abs() + self.error).cosh();
        Real::rounded(self.value.sinh(), slope * self.error)
    }

    pub(super) fn cosh(self) -> Self {
        let slope = (self.value.abs() + self.error).sinh();
        Real::rounded(self.value.cosh(), slope * self.error)
    }

    pub(super) fn tanh(self) -> Self {
        Real::rounded(self.value.tanh(), self.error)
    }

    pub(super) fn log(self) -> Self {
        let Real { value, error } = self;
        if value > error {
            Real::rounded(value.ln(), error / (value - error))
        } else if value + error >= 0.0 {
            Real::UNKNOWN
        } else {
            Real::UNDEFINED
        }
    }

    pub(super) fn sqrt(self) -> Self {
        let Real { value, error } = self;
        if value + error >= 0.0 {
            let (least, most) = ((value - error).max(0.0).sqrt(), (value + error).sqrt());
            Real::rounded(value.max(0.0).sqrt(), most - least)
        } else {
            Real::UNDEFINED
        }
    }

    pub(super) fn abs(self) -> Self {
        Real {
            value: self.value.abs(),
            error: self.error,
        }
    }

    /// Sign; unknown if the number may be on either side of 0.
    pub(super) fn sign(self) -> Self {
        match self.side() {
            Some(side) => Real::new(f64::from(side as i8), 0.0),
            None => Real::UNKNOWN,
        }
    }

    /// Returns a if this is positive, else b; unknown if it may be either.
    pub(super) fn select(self, a: Real, b: Real) -> Self {
        match self.side() {
            Some(Ordering::Greater) => a,
            Some(_) => b,
            None if self.is_known() => Real::UNKNOWN,
            None => self.without(self),
        }
    }

    /// Compares the number with 0; `None` if the result is not certain.
    pub(super) fn side(self) -> Option<Ordering> {
        let certain = self.value.abs() > self.error || self.error == 0.0;
        let side = self.value.partial_cmp(&0.0);
        side.filter(|_| certain)
    }

    /// atan2(a, b).
    pub fn atan2(self, b: Real) -> Self {
        if !self.is_known() || !b.is_known() {
            return self.without(b);
        }
        let radius = self.value.hypot(b.value) - self.error - b.error;
        // At the branch cut, the value jumps by 2π.
        if radius > 0.0 && (b.value > b.error || self.value.abs() > self.error) {
            Real::rounded(self.value.atan2(b.value), (self.error + b.error) / radius)
        } else {
            Real::UNKNOWN
        }
    }

    /// Whether b cannot stand for this: it is a different number, whatever the errors, or it does not exist
    /// although this does.
    fn differs(self, b: Real) -> bool {
        if self.is_known() && b.is_undefined() {
            return true;
        }
        let apart = (self.value - b.value).abs();
        apart > 4.0 * (self.error + b.error) && apart > f64::MIN_POSITIVE
    }
}

/// Whether b cannot stand for a at some sample.
pub fn contradict(a: &[Real], b: &[Real]) -> bool {
    a.iter().zip(b).any(|(a, b)| a.differs(*b))
}
