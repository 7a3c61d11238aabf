//! One point of the variety: the values modulo p of all symbols, and of sin, cos, exp, √ at it.
//!
//! Transcendental functions get values that obey their group laws. The angle of an atom `a` has a
//! random point on the unit circle for a/12; sin and cos of n·a/12 follow by the group law, so that
//! sin(a + b) and sin a cos b + cos a sin b have the same value; those of twelfths of π are exact.
//! exp is treated likewise. Square roots keep the laws of positive numbers (`roots`).

use super::fp::{Fp, P, Random};
use super::graph::Function;
use super::roots;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;

/// Σ coefficient · atom, the argument of a function with a group law; atoms by their values. Of a
/// square root: the rational factor of its argument (`Graph::form`).
pub type LinearForm = Vec<(Fp, BigRational)>;

/// The part of an angle that gets a random circle point: halves, thirds, quarters and sixths of an
/// atom are then whole multiples of it.
const PARTS: i64 = 12;

/// A point: values of symbols, and a seed from which the values of functions follow. Values of
/// functions depend on values of arguments alone, so that two graphs agree at the same point.
#[derive(Clone, Debug)]
pub struct Lane {
    seed: u64,
    symbols: Vec<Fp>,
    /// Set when a square root was asked of a non-square: the point should be chosen anew.
    pub stuck: bool,
    /// Whether roots of non-squares are taken in F_p(i), where √a √b may be −√(ab).
    pub lenient: bool,
}

impl Lane {
    /// A point without symbols yet.
    pub fn new(seed: u64) -> Self {
        Lane {
            seed,
            symbols: Vec::new(),
            stuck: false,
            lenient: false,
        }
    }

    /// The same functions, without symbols.
    pub fn fresh(&self) -> Self {
        Lane {
            lenient: self.lenient,
            ..Lane::new(self.seed)
        }
    }

    /// Adds the next symbol.
    pub fn push_symbol(&mut self, value: Fp) {
        self.symbols.push(value);
    }

    /// Gives a symbol another value; functions follow where their arguments change.
    pub fn set_symbol(&mut self, index: usize, value: Fp) {
        if let Some(known) = self.symbols.get_mut(index) {
            *known = value;
        }
    }

    /// The value of a symbol.
    pub fn symbol(&self, index: usize) -> Fp {
        self.symbols[index]
    }

    /// Value of a function of one argument; `form` is `Graph::form` of the argument.
    pub fn function(&mut self, function: Function, argument: Fp, form: &LinearForm) -> Fp {
        match function {
            Function::Sin => self.angle(form).1,
            Function::Cos => self.angle(form).0,
            Function::Exp => self.exp(form),
            Function::Sqrt => self.root(argument, form).unwrap_or_else(|| {
                self.stuck = true;
                self.opaque(function, argument, Fp::ZERO)
            }),
            Function::Log | Function::Atan2 => self.opaque(function, argument, Fp::ZERO),
        }
    }

    /// f′ of a function of one argument with its value there; `None` where it has none. `Atan2` has two
    /// arguments and is a node of its own.
    pub fn slope(
        &mut self,
        function: Function,
        argument: Fp,
        form: &LinearForm,
        value: Fp,
    ) -> Option<Fp> {
        Some(match function {
            Function::Sin => self.function(Function::Cos, argument, form),
            Function::Cos => -self.function(Function::Sin, argument, form),
            Function::Exp => value,
            Function::Log => argument.inv()?,
            Function::Sqrt => (value + value).inv()?,
            Function::Atan2 => Fp::ZERO,
        })
    }

    /// √(c e) = √c √e with the factor c of the form; a number without a form has any root.
    fn root(&self, argument: Fp, form: &LinearForm) -> Option<Fp> {
        let Some((_, factor)) = form.first() else {
            return argument.sqrt();
        };
        let rest = argument * Fp::from_rational(factor)?.inv()?;
        let root = roots::principal(rest);
        let root = root.or_else(|| self.lenient.then(|| rest.sqrt())?)?;
        Some(roots::of_rational(factor)? * root)
    }

    /// A value without any law but equality of arguments.
    pub fn opaque(&self, function: Function, a: Fp, b: Fp) -> Fp {
        self.draw(function as u64, a, b).element()
    }

    /// A random stream that belongs to a tag and two values.
    fn draw(&self, tag: u64, a: Fp, b: Fp) -> Random {
        let mut seed = self.seed;
        for part in [tag, a.bits(), b.bits()] {
            seed = Random::new(seed ^ part.wrapping_mul(0x2545_f491_4f6c_dd1d)).bits();
        }
        Random::new(seed)
    }

    fn angle(&self, form: &LinearForm) -> (Fp, Fp) {
        form.iter()
            .fold((Fp::ONE, Fp::ZERO), |total, (atom, coefficient)| {
                let (base, count, parts) = split(*atom, coefficient);
                let point = if base == Fp::PI && parts == 1 {
                    twelfth()
                } else {
                    circle_point(&mut self.draw(64 + parts, base, Fp::ONE))
                };
                rotate(total, power(point, count))
            })
    }

    fn exp(&self, form: &LinearForm) -> Fp {
        form.iter().fold(Fp::ONE, |total, (atom, coefficient)| {
            let (base, count, parts) = split(*atom, coefficient);
            let magnitude = self
                .draw(96 + parts, base, Fp::ONE)
                .element()
                .pow(count.unsigned_abs());
            total
                * if count < 0 {
                    magnitude.inv().unwrap_or(Fp::ONE)
                } else {
                    magnitude
                }
        })
    }
}

/// Writes c·atom as a whole number of parts of a base, signs made canonical; where c is no
/// multiple of a part, c·atom is a base of its own.
fn split(atom: Fp, coefficient: &BigRational) -> (Fp, i64, u64) {
    let parts = coefficient * BigRational::from_integer(BigInt::from(PARTS));
    let whole = parts
        .is_integer()
        .then(|| parts.to_integer().to_i64())
        .flatten();
    let (base, count, parts) = match whole {
        Some(count) => (atom, count, 1),
        None => (
            atom * Fp::from_rational(coefficient).unwrap_or(Fp::ONE),
            1,
            0,
        ),
    };
    if base.is_negative() {
        (-base, -count, parts)
    } else {
        (base, count, parts)
    }
}

/// A random point (c, s) of the unit circle: ((1 − t²), 2t)/(1 + t²); 1 + t² ≠ 0 as p ≡ 3 mod 4.
pub fn circle_point(random: &mut Random) -> (Fp, Fp) {
    let t = random.element();
    let scale = (Fp::ONE + t * t).inv().unwrap_or(Fp::ONE);
    ((Fp::ONE - t * t) * scale, (t + t) * scale)
}

/// Cosine and sine of π/12, (√3 ± 1) √2 / 4.
fn twelfth() -> (Fp, Fp) {
    let root = |n: i64| {
        let number = BigRational::from_integer(BigInt::from(n));
        roots::of_rational(&number).unwrap_or(Fp::ONE)
    };
    let quarter = Fp::new(4).inv().unwrap_or(Fp::ONE) * root(2);
    ((root(3) + Fp::ONE) * quarter, (root(3) - Fp::ONE) * quarter)
}

fn rotate(a: (Fp, Fp), b: (Fp, Fp)) -> (Fp, Fp) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn power(base: (Fp, Fp), count: i64) -> (Fp, Fp) {
    let mut base = if count < 0 { (base.0, -base.1) } else { base };
    let mut count = count.unsigned_abs() % (P + 1);
    let mut result = (Fp::ONE, Fp::ZERO);
    while count > 0 {
        if count & 1 == 1 {
            result = rotate(result, base);
        }
        base = rotate(base, base);
        count >>= 1;
    }
    result
}
