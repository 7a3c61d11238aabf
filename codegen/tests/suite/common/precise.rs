//! Real numbers of 200 bits, for derivations that are independent of the generator.

use astro_float_num::{BigFloat, Consts, RoundingMode};
use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Bits of the mantissa.
const PRECISION_BITS: usize = 200;
const ROUNDING_MODE: RoundingMode = RoundingMode::ToEven;

thread_local! {
    static CONSTANTS: RefCell<Consts> = RefCell::new(Consts::new().expect("memory"));
}

/// A real number.
#[derive(Clone, Debug)]
pub struct Precise(BigFloat);

impl Precise {
    /// Parses a decimal number, without rounding to f64.
    pub fn parse(text: &str) -> Self {
        let parsed = CONSTANTS.with_borrow_mut(|constants| {
            BigFloat::parse(
                text,
                astro_float_num::Radix::Dec,
                PRECISION_BITS,
                ROUNDING_MODE,
                constants,
            )
        });
        assert!(!parsed.is_nan(), "{text}");
        Precise(parsed)
    }

    /// Converts an f64 exactly.
    pub fn of(value: f64) -> Self {
        Precise(BigFloat::from_f64(value, PRECISION_BITS))
    }

    /// 2^exponent
    pub fn power_of_two(exponent: i32) -> Self {
        let mut power = Precise::of(1.0);
        let step = Precise::of(if exponent < 0 { 0.5 } else { 2.0 });
        for _ in 0..exponent.abs() {
            power = &power * &step;
        }
        power
    }

    /// π
    pub fn pi() -> Self {
        Precise(CONSTANTS.with_borrow_mut(|constants| constants.pi(PRECISION_BITS, ROUNDING_MODE)))
    }

    /// Sine.
    pub fn sin(&self) -> Self {
        Precise(
            CONSTANTS
                .with_borrow_mut(|constants| self.0.sin(PRECISION_BITS, ROUNDING_MODE, constants)),
        )
    }

    /// Cosine.
    pub fn cos(&self) -> Self {
        Precise(
            CONSTANTS
                .with_borrow_mut(|constants| self.0.cos(PRECISION_BITS, ROUNDING_MODE, constants)),
        )
    }

    /// Exponential.
    pub fn exp(&self) -> Self {
        Precise(
            CONSTANTS
                .with_borrow_mut(|constants| self.0.exp(PRECISION_BITS, ROUNDING_MODE, constants)),
        )
    }

    /// Natural logarithm.
    pub fn log(&self) -> Self {
        Precise(
            CONSTANTS
                .with_borrow_mut(|constants| self.0.ln(PRECISION_BITS, ROUNDING_MODE, constants)),
        )
    }

    /// Arc cosine.
    pub fn acos(&self) -> Self {
        Precise(
            CONSTANTS
                .with_borrow_mut(|constants| self.0.acos(PRECISION_BITS, ROUNDING_MODE, constants)),
        )
    }

    /// Arc sine.
    pub fn asin(&self) -> Self {
        Precise(
            CONSTANTS
                .with_borrow_mut(|constants| self.0.asin(PRECISION_BITS, ROUNDING_MODE, constants)),
        )
    }

    /// Arc tangent.
    pub fn atan(&self) -> Self {
        Precise(
            CONSTANTS
                .with_borrow_mut(|constants| self.0.atan(PRECISION_BITS, ROUNDING_MODE, constants)),
        )
    }

    /// Square root.
    pub fn sqrt(&self) -> Self {
        Precise(self.0.sqrt(PRECISION_BITS, ROUNDING_MODE))
    }

    /// |a|
    pub fn abs(&self) -> Self {
        Precise(self.0.abs())
    }

    /// Returns whether it is finite, not the root of a negative number or a quotient by 0.
    pub fn is_finite(&self) -> bool {
        !self.0.is_nan() && !self.0.is_inf()
    }

    /// Returns whether a < 0.
    pub fn is_negative(&self) -> bool {
        self.0.is_negative() && !self.0.is_zero()
    }

    /// Returns an f64 within about one rounding.
    pub fn to_f64(&self) -> f64 {
        if self.0.is_zero() {
            return 0.0;
        }
        self.0.to_string().parse().expect("a number")
    }
}

macro_rules! operator {
    ($trait:ident, $name:ident) => {
        impl $trait<&Precise> for &Precise {
            type Output = Precise;
            fn $name(self, other: &Precise) -> Precise {
                Precise(self.0.$name(&other.0, PRECISION_BITS, ROUNDING_MODE))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for &Precise {
    type Output = Precise;
    fn neg(self) -> Precise {
        Precise(self.0.clone().neg())
    }
}

/// A vector of three numbers.
pub type Three = [Precise; 3];

/// A matrix by rows.
pub type Matrix = [Three; 3];

/// a · b
pub fn dot(a: &Three, b: &Three) -> Precise {
    (0..3).fold(Precise::of(0.0), |sum, i| &sum + &(&a[i] * &b[i]))
}

/// a × b
pub fn cross(a: &Three, b: &Three) -> Three {
    let entry = |i: usize, j: usize| &(&a[i] * &b[j]) - &(&a[j] * &b[i]);
    [entry(1, 2), entry(2, 0), entry(0, 1)]
}

/// a + b
pub fn plus(a: &Three, b: &Three) -> Three {
    std::array::from_fn(|i| &a[i] + &b[i])
}

/// a − b
pub fn minus(a: &Three, b: &Three) -> Three {
    std::array::from_fn(|i| &a[i] - &b[i])
}

/// s a
pub fn scaled(s: &Precise, a: &Three) -> Three {
    std::array::from_fn(|i| s * &a[i])
}

/// a divided by its length
pub fn normed(a: &Three) -> Three {
    let length = dot(a, a).sqrt();
    std::array::from_fn(|i| &a[i] / &length)
}

/// R a
pub fn apply(r: &Matrix, a: &Three) -> Three {
    std::array::from_fn(|i| dot(&r[i], a))
}

/// A B
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |j: usize| -> Three { std::array::from_fn(|i| b[i][j].clone()) };
    let columns = [column(0), column(1), column(2)];
    std::array::from_fn(|i| std::array::from_fn(|j| dot(&a[i], &columns[j])))
}

/// The rotation about a unit axis, I c + s n̂ + (1 − c) n nᵀ
pub fn about(n: &Three, c: &Precise, s: &Precise) -> Matrix {
    let one = Precise::of(1.0);
    let rest = &one - c;
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let plain = &(&n[i] * &n[j]) * &rest;
            if i == j {
                return &plain + c;
            }
            let k = 3 - i - j;
            let turn = s * &n[k];
            if (j + 3 - i) % 3 == 1 {
                &plain - &turn
            } else {
                &plain + &turn
            }
        })
    })
}

/// I
pub fn identity() -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| Precise::of(f64::from(u8::from(i == j)))))
}
