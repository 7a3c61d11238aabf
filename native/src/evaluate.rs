//! Tapes step by step: where there is no machine code, and for the rare arguments that it leaves to this.

use hamel::Scalar;
use hamel::trig::{self, Arithmetic};
use hamel_codegen::algebra::graph::Function;
use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::{ARGUMENTS, Operand, Source, Step, Tape};

/// The results of a tape. Constants are the parameters and what is kept behind them; a step that a machine
/// rounds once is rounded once where `fused`.
///
/// # Errors
/// What a pivot that is not positive means.
pub fn evaluate(
    tape: &Tape,
    fused: bool,
    constants: &[f64],
    arguments: [&[f64]; 5],
    out: &mut [f64],
) -> Result<(), Cause> {
    let mut values: Vec<f64> = Vec::with_capacity(tape.values());
    for step in &tape.steps {
        let of = |operand: Operand| read(operand, &values, constants, arguments);
        let value = match *step {
            Step::Add(a, b) => of(a) + of(b),
            Step::Multiply(a, b) => of(a) * of(b),
            Step::Fused(a, b, c) => Rounded { fused }.times_plus(of(a), of(b), of(c)),
            Step::Divide(a, b) => of(a) / of(b),
            Step::SinCos(a) => {
                let [sine, cosine] = sin_cos(of(a), fused);
                values.push(sine);
                cosine
            }
            Step::Apply(function, a) => apply(function, of(a)),
            Step::Atan2(y, x) => Scalar::atan2(of(y), of(x)),
            Step::Select(c, a, b) => of(c).select_positive(of(a), of(b)),
            Step::Check(cause, pivot) => match of(pivot) > 0.0 {
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

/// Numbers whose products are rounded before they are added, or not.
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

/// (sin x, cos x), as generated code has it.
fn sin_cos(x: f64, fused: bool) -> [f64; 2] {
    // Not `>`: NaN is far.
    let near = x.abs() <= trig::FARTHEST;
    if !near {
        return Scalar::sin_cos(x).into();
    }
    let w = &mut Rounded { fused };
    let reduced = trig::reduced(w, x);
    let row = trig::TURNED[(reduced.shifted.to_bits() & 3) as usize];
    trig::turned(w, row, reduced)
}

/// The value of an operand.
pub(crate) fn read(
    operand: Operand,
    values: &[f64],
    constants: &[f64],
    arguments: [&[f64]; 5],
) -> f64 {
    let value = match operand.source {
        Source::Number(number) => Some(number),
        Source::Constant(index) => constants.get(index).copied(),
        Source::Value(index) => values.get(index).copied(),
        Source::Argument(argument, index) => {
            let place = ARGUMENTS.iter().position(|&of| of == argument);
            place.and_then(|place| arguments[place].get(index)).copied()
        }
    };
    let value = value.unwrap_or(f64::NAN);
    if operand.negative { -value } else { value }
}

/// A function of one argument, as generated code has it.
pub fn apply(function: Function, a: f64) -> f64 {
    match function {
        Function::Sin => Scalar::sin_cos(a).0,
        Function::Cos => Scalar::sin_cos(a).1,
        Function::Exp => Scalar::exp(a),
        Function::Log => Scalar::ln(a),
        Function::Sqrt | Function::Norm => Scalar::sqrt(a),
        Function::Sinh => Scalar::sinh(a),
        Function::Cosh => Scalar::cosh(a),
        Function::Tanh => Scalar::tanh(a),
        Function::Sign => Scalar::sign(a),
        Function::Abs => Scalar::abs(a),
        Function::Inverse => a.inverse_of_length(),
        // Steps of their own.
        Function::Atan2 | Function::Select | Function::Listed | Function::External => f64::NAN,
    }
}
