//! Numbers that record the operations on them, so that an algorithm in Rust, such as a step of a method, becomes a
//! tape.

use hamel::Scalar;
use hamel_codegen::algebra::graph::Function;
use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::{ARGUMENTS, Operand, Source, Step, Tape};
use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// The record of operations.
#[derive(Debug, Default)]
struct Written {
    steps: Vec<Step>,
    values: usize,
    /// Whether the algorithm needed a value that only a run has.
    refused: bool,
}

thread_local! {
    static WRITTEN: RefCell<Written> = RefCell::default();
}

/// A number of a tape that is being recorded.
#[derive(Clone, Copy, Debug)]
pub struct Traced(Operand);

/// Records the tape of an algorithm that returns its results; `None` if it depends on a value that only a run has, such
/// as the convergence of an iteration.
///
/// Every test for a positive number succeeds while recording, and becomes a check at which the tape fails.
pub fn traced(name: &str, algorithm: impl FnOnce() -> Vec<Traced>) -> Option<Tape> {
    let outer = WRITTEN.take();
    let outputs = algorithm();
    let written = WRITTEN.replace(outer);
    (!written.refused).then(|| Tape {
        name: name.into(),
        steps: written.steps,
        outputs: outputs.into_iter().map(|number| number.0).collect(),
    })
}

/// Records another tape with these arguments, and returns its results. Both tapes need constants of the same program.
pub fn inlined(tape: &Tape, arguments: [&[Traced]; 5]) -> Vec<Traced> {
    let mut values: Vec<Traced> = Vec::with_capacity(tape.values());
    for &step in &tape.steps {
        let of = |operand: Operand| mapped(operand, &values, arguments);
        let step = match step {
            Step::Add(a, b) => Step::Add(of(a), of(b)),
            Step::Multiply(a, b) => Step::Multiply(of(a), of(b)),
            Step::Fused(a, b, c) => Step::Fused(of(a), of(b), of(c)),
            Step::Divide(a, b) => Step::Divide(of(a), of(b)),
            Step::SinCos(a) => Step::SinCos(of(a)),
            Step::Apply(function, a) => Step::Apply(function, of(a)),
            Step::Atan2(y, x) => Step::Atan2(of(y), of(x)),
            Step::Select(c, a, b) => Step::Select(of(c), of(a), of(b)),
            Step::Check(cause, pivot) => Step::Check(cause, of(pivot)),
        };
        let first = write(step);
        values.extend((first..first + step.results()).map(Traced::value));
    }
    let outputs = tape.outputs.iter();
    outputs
        .map(|&output| Traced(mapped(output, &values, arguments)))
        .collect()
}

fn mapped(operand: Operand, values: &[Traced], arguments: [&[Traced]; 5]) -> Operand {
    let known = match operand.source {
        Source::Value(value) => values.get(value),
        Source::Argument(argument, index) => {
            let place = ARGUMENTS.iter().position(|&of| of == argument);
            place.and_then(|place| arguments[place].get(index))
        }
        Source::Number(_) | Source::Constant(_) => return operand,
    };
    let known = known.map_or(Traced::from_f64(f64::NAN).0, |known| known.0);
    Operand {
        source: known.source,
        negative: known.negative != operand.negative,
    }
}

/// Records a step, and returns the index of its first result.
fn write(step: Step) -> usize {
    WRITTEN.with_borrow_mut(|written| {
        let first = written.values;
        written.values += step.results();
        written.steps.push(step);
        first
    })
}

impl Traced {
    /// Returns an entry of an argument.
    pub fn argument(source: Source) -> Self {
        Traced(Operand {
            source,
            negative: false,
        })
    }

    fn value(place: usize) -> Self {
        Traced::argument(Source::Value(place))
    }

    fn of(step: Step) -> Self {
        Traced::value(write(step))
    }

    /// Returns the value if it is known before any run.
    fn known(self) -> Option<f64> {
        match self.0.source {
            Source::Number(number) if self.0.negative => Some(-number),
            Source::Number(number) => Some(number),
            _ => None,
        }
    }

    fn apply(self, function: Function) -> Self {
        match self.known() {
            Some(number) => Traced::from_f64(super::evaluate::apply(function, number)),
            None => Traced::of(Step::Apply(function, self.0)),
        }
    }
}

impl Default for Traced {
    fn default() -> Self {
        Traced::from_f64(0.0)
    }
}

impl Neg for Traced {
    type Output = Self;

    fn neg(self) -> Self {
        Traced(Operand {
            negative: !self.0.negative,
            ..self.0
        })
    }
}

impl Add for Traced {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        match (self.known(), other.known()) {
            (Some(a), Some(b)) => Traced::from_f64(a + b),
            (Some(0.0), None) => other,
            (None, Some(0.0)) => self,
            _ => Traced::of(Step::Add(self.0, other.0)),
        }
    }
}

impl Sub for Traced {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Traced {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        match (self.known(), other.known()) {
            (Some(a), Some(b)) => Traced::from_f64(a * b),
            (Some(1.0), None) => other,
            (None, Some(1.0)) => self,
            _ => Traced::of(Step::Multiply(self.0, other.0)),
        }
    }
}

impl Div for Traced {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        match (self.known(), other.known()) {
            (Some(a), Some(b)) => Traced::from_f64(a / b),
            _ => Traced::of(Step::Divide(self.0, other.0)),
        }
    }
}

macro_rules! assigned {
    ($($trait:ident $name:ident $operator:tt)*) => {
        $(impl $trait for Traced {
            fn $name(&mut self, other: Self) {
                *self = *self $operator other;
            }
        })*
    };
}

assigned! {
    AddAssign add_assign +
    SubAssign sub_assign -
    MulAssign mul_assign *
    DivAssign div_assign /
}

impl Scalar for Traced {
    const EPSILON: f64 = f64::EPSILON;

    fn from_f64(value: f64) -> Self {
        Traced::argument(Source::Number(value))
    }

    fn sin_cos(self) -> (Self, Self) {
        match self.known() {
            Some(number) => {
                let (sine, cosine) = Scalar::sin_cos(number);
                (Traced::from_f64(sine), Traced::from_f64(cosine))
            }
            None => {
                let first = write(Step::SinCos(self.0));
                (Traced::value(first), Traced::value(first + 1))
            }
        }
    }

    fn sqrt(self) -> Self {
        self.apply(Function::Sqrt)
    }

    fn exp(self) -> Self {
        self.apply(Function::Exp)
    }

    fn ln(self) -> Self {
        self.apply(Function::Log)
    }

    fn sinh(self) -> Self {
        self.apply(Function::Sinh)
    }

    fn cosh(self) -> Self {
        self.apply(Function::Cosh)
    }

    fn tanh(self) -> Self {
        self.apply(Function::Tanh)
    }

    fn atan2(self, x: Self) -> Self {
        Traced::of(Step::Atan2(self.0, x.0))
    }

    fn abs(self) -> Self {
        self.apply(Function::Abs)
    }

    fn mul_add(self, a: Self, b: Self) -> Self {
        // Fused where `f64` is fused in this program, so that a tape has the numbers of the algorithm.
        match cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
            true => Traced::of(Step::Fused(self.0, a.0, b.0)),
            false => self * a + b,
        }
    }

    fn max(self, other: Self) -> Self {
        Traced::of(Step::Select((self - other).0, self.0, other.0))
    }

    fn select_lt(self, limit: Self, then: Self, otherwise: Self) -> Self {
        (limit - self).select_positive(then, otherwise)
    }

    fn select_positive(self, then: Self, otherwise: Self) -> Self {
        match self.known() {
            Some(number) => match number > 0.0 {
                true => then,
                false => otherwise,
            },
            None => Traced::of(Step::Select(self.0, then.0, otherwise.0)),
        }
    }

    fn inverse_of_length(self) -> Self {
        self.apply(Function::Inverse)
    }

    fn inflated(self) -> Self {
        self.apply(Function::Raised)
    }

    fn is_positive(self) -> bool {
        match self.known() {
            Some(number) => Scalar::is_positive(number),
            None => {
                write(Step::Check(Cause::Mass, self.0));
                true
            }
        }
    }

    /// True if unknown: the caller of the tape checks its results.
    fn is_finite(self) -> bool {
        self.known().is_none_or(f64::is_finite)
    }

    fn largest_lane(self) -> f64 {
        self.known().unwrap_or_else(|| {
            WRITTEN.with_borrow_mut(|written| written.refused = true);
            0.0
        })
    }
}
