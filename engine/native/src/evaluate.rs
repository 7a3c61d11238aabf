//! Interprets tapes step by step: if there is no machine code, and for the rare arguments that it does not handle.

use hamel::Scalar;
use hamel::trig::{self, Arithmetic};
use hamel_codegen::algebra::for_each_function;
use hamel_codegen::algebra::graph::Function;
use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::{ARGUMENTS, Operand, Source, Step, Tape};

/// Evaluates a tape. Constants are the parameters, followed by the values kept with them. If `fused`, a step that the
/// machine rounds once is rounded once.
///
/// # Errors
/// The cause of a pivot that is not positive.
pub fn evaluate(
    tape: &Tape,
    fused: bool,
    constants: &[f64],
    arguments: [&[f64]; 5],
    out: &mut [f64],
) -> Result<(), Cause> {
    run(tape, &Rounded { fused }, constants, arguments, out)
}

/// Evaluates a tape in another type of number, such as numbers with slopes.
///
/// # Errors
/// The cause of a pivot that is not positive.
pub fn evaluate_in<S: Scalar>(
    tape: &Tape,
    constants: &[f64],
    arguments: [&[S]; 5],
    out: &mut [S],
) -> Result<(), Cause> {
    run(tape, &Own, constants, arguments, out)
}

/// Operations that depend on the rounding of products and sums.
trait Rounding<S> {
    /// a b + c
    fn fused(&self, a: S, b: S, c: S) -> S;
    /// sin a and cos a
    fn sin_cos(&self, a: S) -> [S; 2];
}

impl Rounding<f64> for Rounded {
    fn fused(&self, a: f64, b: f64, c: f64) -> f64 {
        Rounded { ..*self }.times_plus(a, b, c)
    }

    fn sin_cos(&self, a: f64) -> [f64; 2] {
        sin_cos(a, self.fused)
    }
}

/// The rounding of the number type itself.
struct Own;

impl<S: Scalar> Rounding<S> for Own {
    fn fused(&self, a: S, b: S, c: S) -> S {
        a.mul_add(b, c)
    }

    fn sin_cos(&self, a: S) -> [S; 2] {
        a.sin_cos().into()
    }
}

fn run<S: Scalar>(
    tape: &Tape,
    rounding: &impl Rounding<S>,
    constants: &[f64],
    arguments: [&[S]; 5],
    out: &mut [S],
) -> Result<(), Cause> {
    let mut values: Vec<S> = Vec::with_capacity(tape.values());
    for step in &tape.steps {
        let of = |operand: Operand| read(operand, &values, constants, arguments);
        let value = match *step {
            Step::Add(a, b) => of(a) + of(b),
            Step::Multiply(a, b) => of(a) * of(b),
            Step::Fused(a, b, c) => rounding.fused(of(a), of(b), of(c)),
            Step::Divide(a, b) => of(a) / of(b),
            Step::SinCos(a) => {
                let [sine, cosine] = rounding.sin_cos(of(a));
                values.push(sine);
                cosine
            }
            Step::Apply(function, a) => apply(function, of(a)),
            Step::Atan2(y, x) => of(y).atan2(of(x)),
            Step::Select(c, a, b) => of(c).select_positive(of(a), of(b)),
            Step::Check(cause, pivot) => match of(pivot).is_positive() {
                true => continue,
                false => return Err(cause),
            },
        };
        values.push(value);
    }
    for (out, &operand) in out.iter_mut().zip(&tape.outputs) {
        *out = read(operand, &values, constants, arguments);
    }
    Ok(())
}

/// Numbers whose products are rounded before they are added if not `fused`.
struct Rounded {
    fused: bool,
}

impl Arithmetic for Rounded {
    type Number = f64;

    fn is_fused(&self) -> bool {
        self.fused
    }

    fn number(&mut self, number: f64) -> f64 {
        number
    }

    fn minus(&mut self, a: f64, b: f64) -> f64 {
        a - b
    }

    fn times(&mut self, a: f64, b: f64) -> f64 {
        a * b
    }

    fn times_plus(&mut self, a: f64, b: f64, c: f64) -> f64 {
        match self.fused {
            true => f64::mul_add(a, b, c),
            false => a * b + c,
        }
    }

    fn less_times(&mut self, c: f64, a: f64, b: f64) -> f64 {
        self.times_plus(-a, b, c)
    }

    fn plus(&mut self, a: f64, b: f64) -> f64 {
        a + b
    }
}

/// Returns (sin x, cos x), as in generated code.
fn sin_cos(x: f64, fused: bool) -> [f64; 2] {
    // Not `>`, so that NaN is not near.
    let near = x.abs() <= trig::FARTHEST;
    if !near {
        return Scalar::sin_cos(x).into();
    }
    let w = &mut Rounded { fused };
    let reduced = trig::reduced(w, x);
    let row = trig::TURNED[(reduced.shifted.to_bits() & 3) as usize];
    trig::turned(w, row, reduced)
}

/// Returns the value of an operand.
pub(crate) fn read<S: Scalar>(
    operand: Operand,
    values: &[S],
    constants: &[f64],
    arguments: [&[S]; 5],
) -> S {
    let value = match operand.source {
        Source::Number(number) => Some(S::from_f64(number)),
        Source::Constant(index) => constants.get(index).copied().map(S::from_f64),
        Source::Value(index) => values.get(index).copied(),
        Source::Argument(argument, index) => {
            let place = ARGUMENTS.iter().position(|&of| of == argument);
            place.and_then(|place| arguments[place].get(index)).copied()
        }
    };
    let value = value.unwrap_or_else(|| S::from_f64(f64::NAN));
    if operand.negative { -value } else { value }
}

/// Evaluates a function of one argument by its call in generated code; NaN for functions of several arguments, which
/// have steps of their own.
macro_rules! evaluate_by_calls {
    ($($function:ident $call:tt)*) => {
        /// Evaluates a function of one argument, as in generated code.
        pub fn apply<S: Scalar>(function: Function, a: S) -> S {
            match function {
                $(Function::$function => evaluate_by_calls!(@call a $call),)*
            }
        }
    };
    (@call $a:ident [$($name:ident)?]) => { S::from_f64(f64::NAN) };
    (@call $a:ident [$($call:tt)*]) => { $a.$($call)* };
}
for_each_function!(evaluate_by_calls);
