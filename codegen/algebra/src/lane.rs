//! One point of the variety in each of the two fields: the values of all symbols, and of sin, cos, exp, √.
//!
//! The value of a function follows from that of its argument, in the same way at every point: two points differ in the values
//! of symbols alone. So a number, such as √(sin² 1 + sin² 2), has one image modulo p. If images differed, a root of such a sum
//! would be one of the two roots here and the other one there, and what holds between numbers at one point would fail at others.
//!
//! Transcendental functions get values that obey their group laws. The angle of an atom `a` has a
//! random point on the unit circle for a/12; sin and cos of n·a/12 follow by the group law, so that
//! sin(a + b) and sin a cos b + cos a sin b have the same value; those of twelfths of π are exact.
//! exp is treated likewise, and sinh, cosh and tanh follow from it. Square roots keep the laws of positive numbers (`roots`).

use super::external::Component;
use super::fp::{Fp, Random};
use super::function::Function;
use super::numbers::{Form, Modular, Numbers, Step};
use super::prime::Residue;
use super::roots;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use rustc_hash::FxHashMap;

/// Σ coefficient · atom, the argument of a function with a group law; atoms by their values. Of a
/// square root: the rational factor of its argument (`Graph::form`).
pub type LinearForm = Form<Fp>;

/// The part of an angle that gets a random circle point: halves, thirds, quarters and sixths of an
/// atom are then whole multiples of it.
const PARTS: i64 = 12;

/// The tag of the random numbers that stand for sides of 0.
const POSITIVE: u64 = 128;

/// Numerators and denominators with so many bits are recognised as rational.
const PLAIN_BITS: u32 = 29;

/// Which square roots have values at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Roots {
    /// Those of squares of F_p: √a √b = √(ab).
    #[default]
    OfSquares,
    /// Those of squares of F_p(i), where √a √b may be −√(ab).
    Extended,
    /// All; where F_p(i) has no root, any value stands for it, whose square is another one: what is proved
    /// with it holds, but not all that holds is proved.
    Anything,
}

/// A point: values of symbols. Values of functions depend on values of arguments alone, so that two graphs agree at the same
/// point; those in one field do not depend on those in the other.
#[derive(Clone, Debug, Default)]
pub struct Lane {
    symbols: Vec<Fp>,
    /// In which field a square root was asked of a non-square: the point should be chosen anew there.
    stuck: [bool; 2],
    /// Which roots have values.
    pub roots: Roots,
    /// Symbols that stand for linear forms, by their values.
    written: FxHashMap<Fp, LinearForm>,
}

impl Lane {
    /// A point without symbols yet.
    pub fn new() -> Self {
        Lane::default()
    }

    /// The same functions, without symbols.
    pub fn fresh(&self) -> Self {
        Lane {
            roots: self.roots,
            ..Lane::new()
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

    /// From now on, functions take a symbol of this value for the linear form that another graph has in its
    /// place: sin(a + b) and sin(c) are equal where c = a + b.
    pub fn write_out(&mut self, value: Fp, form: LinearForm) {
        self.written.insert(value, form);
    }

    /// The form with each atom once, as the graph has it in which it is written out.
    fn written_out(&self, form: &LinearForm) -> LinearForm {
        let mut all = LinearForm::new();
        for (atom, coefficient) in form {
            match self.written.get(atom) {
                None => collect(&mut all, *atom, coefficient.clone()),
                Some(form) => {
                    for (atom, own) in form {
                        collect(&mut all, *atom, own * coefficient);
                    }
                }
            }
        }
        all
    }

    /// The value of a symbol.
    pub fn symbol(&self, index: usize) -> Fp {
        self.symbols[index]
    }

    /// Whether a square root was asked of a non-square, in either field.
    pub fn is_stuck(&self) -> bool {
        self.stuck != [false; 2]
    }

    /// In which of the fields a square root was asked of a non-square.
    pub fn stuck(&self) -> [bool; 2] {
        self.stuck
    }

    /// Value of a function of one argument; `form` is `Graph::form` of the argument.
    pub fn function(&mut self, function: Function, argument: Fp, form: &LinearForm) -> Fp {
        if !self.written.is_empty() && function.row().law.is_additive() {
            let form = self.written_out(form);
            return self.value(function, argument, &form);
        }
        self.value(function, argument, form)
    }

    fn value(&mut self, function: Function, argument: Fp, form: &LinearForm) -> Fp {
        match function {
            Function::Sin => Fp(self.angle(form, &first).1, self.angle(form, &second).1),
            Function::Cos => Fp(self.angle(form, &first).0, self.angle(form, &second).0),
            Function::Exp => Fp(self.exp(form, &first), self.exp(form, &second)),
            Function::Sinh | Function::Cosh | Function::Tanh => Fp(
                hyperbolic(function, self.exp(form, &first)),
                hyperbolic(function, self.exp(form, &second)),
            ),
            Function::Sqrt | Function::Norm => {
                let roots = (
                    self.root(argument.0, form, &first),
                    self.root(argument.1, form, &second),
                );
                self.stuck[0] |= roots.0.is_none();
                self.stuck[1] |= roots.1.is_none();
                let other = self.opaque(Function::Sqrt, argument, Fp::ZERO);
                Fp(roots.0.unwrap_or(other.0), roots.1.unwrap_or(other.1))
            }
            Function::Abs => self.sign(argument) * argument,
            Function::Sign => self.sign(argument),
            // It is odd.
            Function::Inverse => {
                let of = |a| self.opaque(function, a, Fp::ZERO);
                of(argument) - of(-argument)
            }
            // It is linear.
            Function::Raised => argument * self.opaque(function, Fp::ONE, Fp::ZERO),
            Function::Log
            | Function::Atan2
            | Function::Select
            | Function::Listed
            | Function::External => self.opaque(function, argument, Fp::ZERO),
        }
    }

    /// √(c e) = √c √e with the factor c of the form; a number without a form has any root.
    fn root<const K: usize>(
        &self,
        argument: Residue<K>,
        form: &LinearForm,
        _: Part<K>,
    ) -> Option<Residue<K>> {
        let anything = || {
            (self.roots == Roots::Anything)
                .then(|| Lane::draw(Function::Sqrt as u64, argument, Residue::ZERO).residue())
        };
        let Some((_, factor)) = form.first() else {
            return argument.sqrt().or_else(anything);
        };
        let rest = argument * Residue::from_rational(factor)?.inv()?;
        let root = rest.principal_root();
        let root = root.or_else(|| rest.sqrt().filter(|_| self.roots != Roots::OfSquares));
        let root = root.map(|root| Some(roots::of_rational::<K>(factor)? * root));
        root.unwrap_or_else(anything)
    }

    /// A value without any law but equality of arguments.
    pub fn opaque(&self, function: Function, a: Fp, b: Fp) -> Fp {
        let tag = function as u64;
        Fp(
            Lane::draw(tag, a.0, b.0).residue(),
            Lane::draw(tag, a.1, b.1).residue(),
        )
    }

    /// What stands for a list: lists of the same numbers have it in common.
    pub fn listed(&self, rest: Fp, last: Fp) -> Fp {
        self.opaque(Function::Listed, rest, last)
    }

    /// A component of a function of which nothing is known but that it is a function.
    pub fn external(&self, component: Component, list: Fp) -> Fp {
        self.opaque(Function::External, list, Fp::from_i64(component.number()))
    }

    /// 1 where a > 0 and 0 elsewhere, for numbers a; for anything else a random number s that belongs to the
    /// value of a.
    ///
    /// Whatever holds for a random s holds for 1 and for 0, and so on both sides. What holds on each of the sides
    /// only because s is 1 or 0 there, such as s² = s, is not found. That s(−a) = 1 − s(a) is not true where
    /// a = 0; so the two are chosen apart.
    pub fn positive(&self, a: Fp) -> Fp {
        if let Some((n, _)) = a.to_small_rational(PLAIN_BITS) {
            return if n > 0 { Fp::ONE } else { Fp::ZERO };
        }
        Fp(
            Lane::draw(POSITIVE, a.0, Residue::ONE).residue(),
            Lane::draw(POSITIVE, a.1, Residue::ONE).residue(),
        )
    }

    /// The sign of a as the difference of a > 0 and −a > 0: 0 where a is 0.
    fn sign(&self, a: Fp) -> Fp {
        self.positive(a) - self.positive(-a)
    }

    /// The random stream that belongs to a tag and two values.
    fn draw<const K: usize>(tag: u64, a: Residue<K>, b: Residue<K>) -> Random {
        let mut seed = (K as u64) << 63;
        for part in [tag, a.bits(), b.bits()] {
            seed = Random::new(seed ^ part.wrapping_mul(0x2545_f491_4f6c_dd1d)).bits();
        }
        Random::new(seed)
    }

    fn angle<const K: usize>(&self, form: &LinearForm, part: Part<K>) -> Turn<K> {
        form.iter().fold(
            (Residue::ONE, Residue::ZERO),
            |total, (atom, coefficient)| {
                let (base, count, parts) = split(part(*atom), coefficient);
                // A velocity that is 0 at this point.
                if base.is_zero() {
                    return total;
                }
                let pi = part(Fp::PI);
                let (point, count) = match parts {
                    1 if base == pi => (twelfth(), count),
                    1 if base == -pi => (twelfth(), -count),
                    _ => {
                        let mut random = Lane::draw(64 + parts, base, Residue::ONE);
                        (circle_residue(&mut random), count)
                    }
                };
                rotate(total, power(point, count))
            },
        )
    }

    fn exp<const K: usize>(&self, form: &LinearForm, part: Part<K>) -> Residue<K> {
        form.iter()
            .fold(Residue::ONE, |total, (atom, coefficient)| {
                let (base, count, parts) = split(part(*atom), coefficient);
                if base.is_zero() {
                    return total;
                }
                let magnitude = Lane::draw(96 + parts, base, Residue::ONE)
                    .residue::<K>()
                    .pow(count.unsigned_abs());
                total
                    * if count < 0 {
                        magnitude.inv().unwrap_or(Residue::ONE)
                    } else {
                        magnitude
                    }
            })
    }
}

impl Numbers for Lane {
    type Number = Fp;

    /// Roots that it does not have are noted (`is_stuck`).
    #[inline]
    fn make(&mut self, step: Step<Fp>) -> Option<Fp> {
        Some(match step {
            Step::Whole(0) => Fp::ZERO,
            Step::Whole(1) => Fp::ONE,
            Step::Whole(value) => Fp::from_i64(value.into()),
            Step::Constant(value) => Fp::from_rational(value)?,
            Step::Symbol(index) => self.symbols[index],
            Step::Neg(a) => -*a,
            Step::Add(a, b) => *a + *b,
            Step::Sub(a, b) => *a - *b,
            Step::Mul(a, b) => *a * *b,
            Step::Div(a, b) => *a * b.inv()?,
            Step::Apply(function, a, form) => self.function(function, *a, &form()),
            Step::Atan2(y, x) => self.opaque(Function::Atan2, *y, *x),
            Step::Select(c, a, b) => *b + self.positive(*c) * (*a - *b),
            Step::Listed(rest, a) => self.listed(*rest, *a),
            Step::External(component, list, _) => self.external(component, *list),
        })
    }

    fn is_zero(&self, a: &Fp) -> bool {
        a.is_zero()
    }

    /// With one inverse.
    fn quotient(&mut self, a: &Fp, b: &Fp) -> Option<[Fp; 3]> {
        let inverse = b.inv()?;
        let quotient = *a * inverse;
        Some([quotient, inverse, -(quotient * inverse)])
    }
}

impl Modular for Lane {
    fn residue(&mut self, value: Fp) -> Option<Fp> {
        Some(value)
    }
}

/// Adds a term to a form.
fn collect(form: &mut LinearForm, atom: Fp, coefficient: BigRational) {
    for (known, sum) in form.iter_mut() {
        if *known == atom {
            *sum += coefficient;
            return;
        }
        if *known == -atom {
            *sum -= coefficient;
            return;
        }
    }
    form.push((atom, coefficient));
}

/// Cosine and sine.
type Turn<const K: usize> = (Residue<K>, Residue<K>);

/// One of the two fields.
type Part<'a, const K: usize> = &'a dyn Fn(Fp) -> Residue<K>;

fn first(value: Fp) -> Residue<0> {
    value.0
}

fn second(value: Fp) -> Residue<1> {
    value.1
}

/// (e ∓ 1/e)/2, or the one over the other: e² is not −1, as p ≡ 3 mod 4.
fn hyperbolic<const K: usize>(function: Function, e: Residue<K>) -> Residue<K> {
    let inverse = |a: Residue<K>| a.inv().unwrap_or(Residue::ONE);
    let (less, more) = (e - inverse(e), e + inverse(e));
    match function {
        Function::Sinh => less * inverse(Residue::new(2)),
        Function::Cosh => more * inverse(Residue::new(2)),
        _ => less * inverse(more),
    }
}

/// Writes c·atom as a whole number of parts of a base, signs made canonical; where c is no
/// multiple of a part, c·atom is a base of its own.
fn split<const K: usize>(atom: Residue<K>, coefficient: &BigRational) -> (Residue<K>, i64, u64) {
    let parts = coefficient * BigRational::from_integer(BigInt::from(PARTS));
    let whole = parts
        .is_integer()
        .then(|| parts.to_integer().to_i64())
        .flatten()
        // Its negative is a number of the same kind, too.
        .filter(|count| *count != i64::MIN);
    let (base, count, parts) = match whole {
        Some(count) => (atom, count, 1),
        None => (
            atom * Residue::from_rational(coefficient).unwrap_or(Residue::ONE),
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
fn circle_residue<const K: usize>(random: &mut Random) -> Turn<K> {
    let t = random.residue();
    let scale = (Residue::ONE + t * t).inv().unwrap_or(Residue::ONE);
    ((Residue::ONE - t * t) * scale, (t + t) * scale)
}

/// The same in both fields.
pub fn circle_point(random: &mut Random) -> (Fp, Fp) {
    let (a, b) = (circle_residue(random), circle_residue(random));
    (Fp(a.0, b.0), Fp(a.1, b.1))
}

/// Cosine and sine of π/12, (√3 ± 1) √2 / 4.
fn twelfth<const K: usize>() -> Turn<K> {
    let root = |n: i64| {
        let number = BigRational::from_integer(BigInt::from(n));
        roots::of_rational::<K>(&number).unwrap_or(Residue::ONE)
    };
    let quarter = Residue::new(4).inv().unwrap_or(Residue::ONE) * root(2);
    (
        (root(3) + Residue::ONE) * quarter,
        (root(3) - Residue::ONE) * quarter,
    )
}

fn rotate<const K: usize>(a: Turn<K>, b: Turn<K>) -> Turn<K> {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn power<const K: usize>(base: Turn<K>, count: i64) -> Turn<K> {
    let mut base = if count < 0 { (base.0, -base.1) } else { base };
    let mut count = count.unsigned_abs();
    let mut result = (Residue::ONE, Residue::ZERO);
    while count > 0 {
        if count & 1 == 1 {
            result = rotate(result, base);
        }
        base = rotate(base, base);
        count >>= 1;
    }
    result
}
