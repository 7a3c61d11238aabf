//! One point of the variety in each of the two fields, with the values of all symbols, and of sin,
//! cos, exp, √.
//!
//! The value of a function depends only on the value of its argument, in the same way at every point: two
//! points differ only in the values of symbols. A number such as √(sin² 1 + sin² 2) therefore has one image
//! modulo p. If its images differed, the root of the sum would be one of the two roots at one point and the
//! other at another point, and relations between numbers that hold at one point would fail at others.
//!
//! Transcendental functions get values that obey their group laws. The angle of an atom `a` has a random
//! point on the unit circle for a/12; sin and cos of n·a/12 follow by the group law, so that sin(a + b) and
//! sin a cos b + cos a sin b have the same value. The sines and cosines of twelfths of π are exact. exp is
//! treated likewise, and sinh, cosh and tanh follow from it. Square roots keep the laws of positive numbers
//! (`roots`).

use super::external::Component;
use super::function::{Function, Parity};
use super::numbers::{Arithmetic, Form, Modular, Step};
use super::prime::Residue;
use super::residue_pair::{Random, ResiduePair};
use super::roots;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use rustc_hash::FxHashMap;

/// Argument of a function with a group law as Σ coefficient · atom, with the values of the atoms. For a
/// square root, the rational factor of its argument (`Graph::form`).
pub type LinearForm = Form<ResiduePair>;

/// Number of parts into which the atom of an angle is divided. A part gets a random circle point, so that
/// halves, thirds, quarters and sixths of the atom are whole multiples of it.
const PARTS_PER_ANGLE: i64 = 12;

/// Tag of the random numbers that stand for conditions a > 0.
const CONDITION_TAG: u64 = 128;

/// Largest number of bits of the numerator and denominator of a value that is recognised as rational.
const RATIONAL_BITS: u32 = 29;

/// Selection of the square roots that have values at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Roots {
    /// Roots of squares of F_p, for which √a √b = √(ab).
    #[default]
    BaseField,
    /// Roots of squares of F_p(i), for which √a √b may be −√(ab).
    ExtensionField,
    /// All roots. If F_p(i) has no root, an arbitrary value stands for it, whose square is not the
    /// argument. What is proved with such values holds, but not everything that holds is proved.
    Arbitrary,
}

/// A point, given by the values of symbols. Values of functions depend only on the values of their
/// arguments, so that two graphs agree at the same point. Values in one field do not depend on those in the
/// other.
#[derive(Clone, Debug, Default)]
pub struct FieldPoint {
    symbols: Vec<ResiduePair>,
    /// Whether a square root of a non-square was requested, for each field; the point should be chosen anew
    /// there.
    missing_roots: [bool; 2],
    /// Which square roots have values.
    pub roots: Roots,
    /// Linear forms that symbols stand for, by the values of the symbols.
    written: FxHashMap<ResiduePair, LinearForm>,
}

impl FieldPoint {
    /// Creates a point that has no symbols yet.
    pub fn new() -> Self {
        FieldPoint::default()
    }

    /// Creates a point with the same functions, but without symbols.
    pub fn without_symbols(&self) -> Self {
        FieldPoint {
            roots: self.roots,
            ..FieldPoint::new()
        }
    }

    /// Adds the next symbol.
    pub fn push_symbol(&mut self, value: ResiduePair) {
        self.symbols.push(value);
    }

    /// Gives a symbol another value; functions of it change accordingly.
    pub fn set_symbol(&mut self, index: usize, value: ResiduePair) {
        if let Some(known) = self.symbols.get_mut(index) {
            *known = value;
        }
    }

    /// From now on, functions read a symbol of this value as the linear form that another graph has in its
    /// place, so that sin(a + b) and sin(c) are equal where c = a + b.
    pub fn set_linear_form(&mut self, value: ResiduePair, form: LinearForm) {
        self.written.insert(value, form);
    }

    /// Replaces symbols by the linear forms that they stand for, as in the graph in which these are written
    /// out, and collects equal atoms.
    fn substitute_forms(&self, form: &LinearForm) -> LinearForm {
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
    pub fn symbol(&self, index: usize) -> ResiduePair {
        self.symbols[index]
    }

    /// Whether a square root of a non-square was requested in either field.
    pub fn has_missing_root(&self) -> bool {
        self.missing_roots != [false; 2]
    }

    /// Whether a square root of a non-square was requested, for each field.
    pub fn missing_roots(&self) -> [bool; 2] {
        self.missing_roots
    }

    /// Returns the value of a function of one argument; `form` is `Graph::form` of the argument.
    pub fn function(
        &mut self,
        function: Function,
        argument: ResiduePair,
        form: &LinearForm,
    ) -> ResiduePair {
        if !self.written.is_empty() && function.row().law.is_additive() {
            let form = self.substitute_forms(form);
            return self.value(function, argument, &form);
        }
        self.value(function, argument, form)
    }

    fn value(
        &mut self,
        function: Function,
        argument: ResiduePair,
        form: &LinearForm,
    ) -> ResiduePair {
        match function {
            Function::Sin => ResiduePair(self.angle(form, &first).1, self.angle(form, &second).1),
            Function::Cos => ResiduePair(self.angle(form, &first).0, self.angle(form, &second).0),
            Function::Exp => ResiduePair(self.exp(form, &first), self.exp(form, &second)),
            Function::Sinh | Function::Cosh | Function::Tanh => ResiduePair(
                hyperbolic(function, self.exp(form, &first)),
                hyperbolic(function, self.exp(form, &second)),
            ),
            Function::Sqrt | Function::Norm => {
                let roots = (
                    self.root(argument.0, form, &first),
                    self.root(argument.1, form, &second),
                );
                self.missing_roots[0] |= roots.0.is_none();
                self.missing_roots[1] |= roots.1.is_none();
                let other = self.opaque(Function::Sqrt, argument, ResiduePair::ZERO);
                ResiduePair(roots.0.unwrap_or(other.0), roots.1.unwrap_or(other.1))
            }
            Function::Abs => self.sign(argument) * argument,
            Function::Sign => self.sign(argument),
            // The function is linear.
            Function::Raised => {
                argument * self.opaque(function, ResiduePair::ONE, ResiduePair::ZERO)
            }
            // Of functions without a law, nothing is known but their symmetry.
            _ => {
                let of = |a| self.opaque(function, a, ResiduePair::ZERO);
                match function.row().parity {
                    Parity::Odd => of(argument) - of(-argument),
                    Parity::Even => of(argument) + of(-argument),
                    Parity::Neither => of(argument),
                }
            }
        }
    }

    /// √(c e) = √c √e, with the factor c of the form. A number without a form may have either root.
    fn root<const K: usize>(
        &self,
        argument: Residue<K>,
        form: &LinearForm,
        _: Part<K>,
    ) -> Option<Residue<K>> {
        let anything = || {
            (self.roots == Roots::Arbitrary)
                .then(|| FieldPoint::draw(Function::Sqrt as u64, argument, Residue::ZERO).residue())
        };
        let Some((_, factor)) = form.first() else {
            return argument.sqrt().or_else(anything);
        };
        let rest = argument * Residue::from_rational(factor)?.inv()?;
        let root = rest.principal_root();
        let root = root.or_else(|| rest.sqrt().filter(|_| self.roots != Roots::BaseField));
        let root = root.map(|root| Some(roots::of_rational::<K>(factor)? * root));
        root.unwrap_or_else(anything)
    }

    /// Returns a pseudo-random value that obeys no law, except that equal arguments give equal values.
    pub fn opaque(&self, function: Function, a: ResiduePair, b: ResiduePair) -> ResiduePair {
        let tag = function as u64;
        ResiduePair(
            FieldPoint::draw(tag, a.0, b.0).residue(),
            FieldPoint::draw(tag, a.1, b.1).residue(),
        )
    }

    /// Returns the value that stands for a list; lists of the same numbers have the same value.
    pub fn listed(&self, rest: ResiduePair, last: ResiduePair) -> ResiduePair {
        self.opaque(Function::Listed, rest, last)
    }

    /// Returns the value of a component of an external function, of which nothing is known except that it
    /// is a function.
    pub fn external(&self, component: Component, list: ResiduePair) -> ResiduePair {
        self.opaque(
            Function::External,
            list,
            ResiduePair::from_i64(component.number()),
        )
    }

    /// Returns the value that stands for the condition a > 0. For a rational number a, it is 1 or 0; for
    /// any other value, it is a random number s that belongs to the value of a.
    ///
    /// Whatever holds for a random s holds for 1 and for 0, and so on both sides. Relations that hold on
    /// each of the sides only because s is 1 or 0 there, such as s² = s, are not found. The relation s(−a)
    /// = 1 − s(a) is false at a = 0, so the two are chosen independently.
    pub fn positive(&self, a: ResiduePair) -> ResiduePair {
        if let Some((n, _)) = a.to_small_rational(RATIONAL_BITS) {
            return if n > 0 {
                ResiduePair::ONE
            } else {
                ResiduePair::ZERO
            };
        }
        ResiduePair(
            FieldPoint::draw(CONDITION_TAG, a.0, Residue::ONE).residue(),
            FieldPoint::draw(CONDITION_TAG, a.1, Residue::ONE).residue(),
        )
    }

    /// Sign of a, as the difference of the conditions a > 0 and −a > 0: 0 if a is 0.
    fn sign(&self, a: ResiduePair) -> ResiduePair {
        self.positive(a) - self.positive(-a)
    }

    /// Returns the random stream that belongs to a tag and two values.
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
                // The atom is a symbol, such as a velocity, that is 0 at this point.
                if base.is_zero() {
                    return total;
                }
                let pi = part(ResiduePair::PI);
                let (point, count) = match parts {
                    1 if base == pi => (twelfth(), count),
                    1 if base == -pi => (twelfth(), -count),
                    _ => {
                        let mut random = FieldPoint::draw(64 + parts, base, Residue::ONE);
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
                let magnitude = FieldPoint::draw(96 + parts, base, Residue::ONE)
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

impl Arithmetic for FieldPoint {
    type Number = ResiduePair;

    /// Missing square roots are noted (`has_missing_root`).
    #[inline]
    fn make(&mut self, step: Step<ResiduePair>) -> Option<ResiduePair> {
        Some(match step {
            Step::Whole(0) => ResiduePair::ZERO,
            Step::Whole(1) => ResiduePair::ONE,
            Step::Whole(value) => ResiduePair::from_i64(value.into()),
            Step::Constant(value) => ResiduePair::from_rational(value)?,
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

    fn is_zero(&self, a: &ResiduePair) -> bool {
        a.is_zero()
    }

    /// Needs only one inversion.
    fn quotient(&mut self, a: &ResiduePair, b: &ResiduePair) -> Option<[ResiduePair; 3]> {
        let inverse = b.inv()?;
        let quotient = *a * inverse;
        Some([quotient, inverse, -(quotient * inverse)])
    }
}

impl Modular for FieldPoint {
    fn residue(&mut self, value: ResiduePair) -> Option<ResiduePair> {
        Some(value)
    }
}

/// Adds a term to a form.
fn collect(form: &mut LinearForm, atom: ResiduePair, coefficient: BigRational) {
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

/// Cosine and sine of an angle.
type Turn<const K: usize> = (Residue<K>, Residue<K>);

/// Projection to one of the two fields.
type Part<'a, const K: usize> = &'a dyn Fn(ResiduePair) -> Residue<K>;

fn first(value: ResiduePair) -> Residue<0> {
    value.0
}

fn second(value: ResiduePair) -> Residue<1> {
    value.1
}

/// (e ∓ 1/e)/2, or the quotient of the two; e + 1/e is not 0, because e² is not −1 for p ≡ 3 mod 4.
fn hyperbolic<const K: usize>(function: Function, e: Residue<K>) -> Residue<K> {
    let inverse = |a: Residue<K>| a.inv().unwrap_or(Residue::ONE);
    let (less, more) = (e - inverse(e), e + inverse(e));
    match function {
        Function::Sinh => less * inverse(Residue::new(2)),
        Function::Cosh => more * inverse(Residue::new(2)),
        _ => less * inverse(more),
    }
}

/// Writes c·atom as a whole number of parts of a base, with the sign of the base made canonical. If c is
/// not a multiple of a part, c·atom is a base of its own. Returns the base, the number, and 1 or 0 for
/// these two cases.
fn split<const K: usize>(atom: Residue<K>, coefficient: &BigRational) -> (Residue<K>, i64, u64) {
    let parts = coefficient * BigRational::from_integer(BigInt::from(PARTS_PER_ANGLE));
    let whole = parts
        .is_integer()
        .then(|| parts.to_integer().to_i64())
        .flatten()
        // The negative count must be representable, too.
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

/// Draws a random point (c, s) of the unit circle: ((1 − t²), 2t)/(1 + t²); 1 + t² ≠ 0 as p ≡ 3 mod 4.
fn circle_residue<const K: usize>(random: &mut Random) -> Turn<K> {
    let t = random.residue();
    let scale = (Residue::ONE + t * t).inv().unwrap_or(Residue::ONE);
    ((Residue::ONE - t * t) * scale, (t + t) * scale)
}

/// Draws a random point of the unit circle in both fields.
pub fn circle_point(random: &mut Random) -> (ResiduePair, ResiduePair) {
    let (a, b) = (circle_residue(random), circle_residue(random));
    (ResiduePair(a.0, b.0), ResiduePair(a.1, b.1))
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
