//! Numbers that count the operations performed on them.

use hamel::Scalar;
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

thread_local! {
    static OPERATIONS: Cell<u64> = const { Cell::new(0) };
}

/// Counts the operations of a run. Additions, subtractions, products, quotients, roots and other functions count one
/// each, a fused product two. Signs, comparisons and choices are free.
pub fn counted(run: impl FnOnce()) -> u64 {
    OPERATIONS.set(0);
    run();
    OPERATIONS.get()
}

/// An `f64` that counts its operations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counted(f64);

fn done(operations: u64, value: f64) -> Counted {
    OPERATIONS.set(OPERATIONS.get() + operations);
    Counted(value)
}

macro_rules! operators {
    ($($of:ident $function:ident $assign:ident $assigned:ident $operator:tt;)+) => {$(
        impl $of for Counted {
            type Output = Self;

            fn $function(self, other: Self) -> Self {
                done(1, self.0 $operator other.0)
            }
        }

        impl $assign for Counted {
            fn $assigned(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )+};
}

operators! {
    Add add AddAssign add_assign +;
    Sub sub SubAssign sub_assign -;
    Mul mul MulAssign mul_assign *;
    Div div DivAssign div_assign /;
}

impl Neg for Counted {
    type Output = Self;

    fn neg(self) -> Self {
        Counted(-self.0)
    }
}

impl Scalar for Counted {
    const EPSILON: f64 = f64::EPSILON;

    fn from_f64(value: f64) -> Self {
        Counted(value)
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (done(1, sin), Counted(cos))
    }

    fn sqrt(self) -> Self {
        done(1, self.0.sqrt())
    }

    fn exp(self) -> Self {
        done(1, self.0.exp())
    }

    fn ln(self) -> Self {
        done(1, self.0.ln())
    }

    fn atan2(self, x: Self) -> Self {
        done(1, self.0.atan2(x.0))
    }

    fn abs(self) -> Self {
        Counted(self.0.abs())
    }

    fn mul_add(self, a: Self, b: Self) -> Self {
        done(2, self.0 * a.0 + b.0)
    }

    fn max(self, other: Self) -> Self {
        Counted(self.0.max(other.0))
    }

    fn select_lt(self, limit: Self, then: Self, otherwise: Self) -> Self {
        if self.0 < limit.0 { then } else { otherwise }
    }

    fn is_positive(self) -> bool {
        self.0 > 0.0
    }

    fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    fn largest_lane(self) -> f64 {
        self.0
    }
}
