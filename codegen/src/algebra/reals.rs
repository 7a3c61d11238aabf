//! Real values of expressions beside those modulo p: they tell e from −e and from |e|.
//!
//! A square root modulo p is one of two, so expressions that differ modulo p by nothing may differ
//! as real numbers by the sign of a root. Where a root takes part, equal values modulo p therefore
//! count only if no real sample contradicts. Values carry a bound of their rounding errors; what
//! has no value at a sample says nothing there.

use super::graph::Function;

/// Number of real samples: |e| and e differ at one of them but for bad luck.
pub const SAMPLES: usize = 6;

/// A real number and a bound of its error; NaN where unknown.
#[derive(Clone, Copy, Debug)]
pub struct Real {
    value: f64,
    error: f64,
}

/// A real number at each sample.
pub type Reals = [Real; SAMPLES];

impl Real {
    /// No value.
    pub const UNKNOWN: Real = Real {
        value: f64::NAN,
        error: f64::NAN,
    };

    /// A number that is off by at most `error`.
    pub fn new(value: f64, error: f64) -> Self {
        Real { value, error }
    }

    /// Rounded once more.
    fn rounded(value: f64, error: f64) -> Self {
        Real {
            value,
            error: error + value.abs() * f64::EPSILON,
        }
    }

    /// −a where asked.
    pub fn signed(self, negative: bool) -> Self {
        Real {
            value: if negative { -self.value } else { self.value },
            error: self.error,
        }
    }

    /// a + b.
    pub fn plus(self, b: Real) -> Self {
        Real::rounded(self.value + b.value, self.error + b.error)
    }

    /// a · b.
    pub fn times(self, b: Real) -> Self {
        let error = self.value.abs() * b.error + self.error * b.value.abs() + self.error * b.error;
        Real::rounded(self.value * b.value, error)
    }

    /// a / b; unknown where b may be 0.
    pub fn over(self, b: Real) -> Self {
        let least = b.value.abs() - b.error;
        if least > 0.0 {
            let quotient = self.value / b.value;
            Real::rounded(quotient, (self.error + quotient.abs() * b.error) / least)
        } else {
            Real::UNKNOWN
        }
    }

    /// A function of one argument.
    pub fn apply(self, function: Function) -> Self {
        let Real { value, error } = self;
        match function {
            Function::Sin => Real::rounded(value.sin(), error),
            Function::Cos => Real::rounded(value.cos(), error),
            Function::Exp => Real::rounded(value.exp(), value.exp() * error.exp_m1()),
            Function::Log if value > error => Real::rounded(value.ln(), error / (value - error)),
            Function::Sqrt if value + error >= 0.0 => {
                let (least, most) = ((value - error).max(0.0).sqrt(), (value + error).sqrt());
                Real::rounded(value.max(0.0).sqrt(), most - least)
            }
            Function::Log | Function::Sqrt | Function::Atan2 => Real::UNKNOWN,
        }
    }

    /// atan2(a, b).
    pub fn atan2(self, b: Real) -> Self {
        let radius = self.value.hypot(b.value) - self.error - b.error;
        // At the cut the value jumps by 2π.
        if radius > 0.0 && (b.value > b.error || self.value.abs() > self.error) {
            Real::rounded(self.value.atan2(b.value), (self.error + b.error) / radius)
        } else {
            Real::UNKNOWN
        }
    }

    /// Whether the two are different numbers, whatever the errors.
    fn differs(self, b: Real) -> bool {
        let apart = (self.value - b.value).abs();
        apart > 4.0 * (self.error + b.error) && apart > f64::MIN_POSITIVE
    }
}

/// Whether two expressions differ at a sample.
pub fn contradict(a: &Reals, b: &Reals) -> bool {
    a.iter().zip(b).any(|(a, b)| a.differs(*b))
}

#[cfg(test)]
mod tests {
    use super::Real;
    use crate::algebra::graph::Function;

    fn exact(value: f64) -> Real {
        Real::new(value, 0.0)
    }

    #[test]
    fn equal_numbers_agree_and_others_differ() {
        let root = |n: f64| exact(n).apply(Function::Sqrt);
        let (two, three) = (root(2.0), root(3.0));
        // √3 − √2 = √(5 − 2√6), and its negative is another number.
        let difference = three.plus(two.signed(true));
        let nested = exact(5.0)
            .plus(exact(-2.0).times(root(6.0)))
            .apply(Function::Sqrt);
        assert!(!difference.differs(nested) && difference.signed(true).differs(nested));
        assert!(!two.times(three).differs(root(6.0)));
        // What cancels is 0 within its error, and not another small number.
        let zero = root(6.0).plus(two.times(three).signed(true));
        assert!(!zero.differs(exact(0.0)) && zero.differs(exact(1e-12)));
    }

    #[test]
    fn what_has_no_value_contradicts_nothing() {
        let unknown = [
            exact(-1.0).apply(Function::Sqrt),
            exact(1.0).over(Real::new(0.0, 1e-16)),
            exact(0.0).apply(Function::Log),
            Real::new(0.0, 1e-16).atan2(exact(-1.0)),
        ];
        for value in unknown {
            assert!(!value.differs(exact(3.0)) && !exact(3.0).differs(value.plus(exact(1.0))));
        }
    }

    #[test]
    fn errors_bound_what_a_perturbation_does() {
        let (a, b, h) = (0.8, 1.7, 1e-7);
        let functions = [
            Function::Sin,
            Function::Cos,
            Function::Exp,
            Function::Log,
            Function::Sqrt,
        ];
        let one = |of: &dyn Fn(Real) -> Real| {
            let (blurred, moved) = (of(Real::new(a, h)), of(exact(a + h)));
            let change = (blurred.value - moved.value).abs();
            assert!(change > 0.0 && change <= blurred.error * (1.0 + 1e-6));
        };
        for function in functions {
            one(&|x| x.apply(function));
        }
        one(&|x| x.times(exact(b)));
        one(&|x| exact(b).over(x));
        one(&|x| x.over(exact(b)));
        one(&|x| x.atan2(exact(b)));
        one(&|x| x.plus(exact(b)));
    }
}
