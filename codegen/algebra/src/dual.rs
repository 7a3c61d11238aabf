//! Automatic differentiation: numbers with slopes (derivatives). The rules of differentiation are written
//! once, here; how slopes are carried is a separate choice:
//!
//! | slopes | carried as | cost |
//! |---|---|---|
//! | ∂f along one direction | [`ForwardMode`]: a number | that of a value |
//! | ∂f along many directions | [`VectorForwardMode`]: a number for each; empty if all are 0 | that of a value, times the directions |
//! | ∂f/∂xₖ for all symbols | [`Record`]: an index into a record that is read backwards (reverse mode) | that of a value |
//! | Σ \|∂f/∂a\| eₐ, bounds of errors | `rounding` | that of a value |
//!
//! Numbers with slopes are numbers themselves, so second derivatives are slopes over [`Duals`].

use super::numbers::{Arithmetic, Form, Modular, Step};
use super::residue_pair::ResiduePair;
use num_traits::Signed;

/// Partial derivative ∂f/∂a of an operation.
#[derive(Clone, Debug)]
pub enum Partial<N> {
    /// 1.
    One,
    /// −1.
    MinusOne,
    /// Any other value.
    Factor(N),
}

impl<N: Clone> Partial<N> {
    /// Multiplies a slope by this derivative.
    fn times<C: Arithmetic<Number = N>>(&self, numbers: &mut C, slope: &N) -> Option<N> {
        match self {
            Partial::One => Some(slope.clone()),
            Partial::MinusOne => numbers.make(Step::Neg(slope)),
            Partial::Factor(factor) => numbers.make(Step::Mul(factor, slope)),
        }
    }
}

/// A way to carry slopes through operations.
pub trait Slopes<C: Arithmetic> {
    /// The slope that is carried along with a value.
    type Slope: Clone;
    /// Returns the slope of a symbol.
    fn symbol(&mut self, numbers: &mut C, index: usize) -> Self::Slope;
    /// Applies the chain rule: Σ ∂f/∂a times the slope of a over the operands a, where `value` is f.
    fn combine(
        &mut self,
        numbers: &mut C,
        value: &C::Number,
        parts: &[(Partial<C::Number>, &Self::Slope)],
    ) -> Option<Self::Slope>;
    /// Whether a slope may differ from 0.
    fn is_nonzero(&self, numbers: &C, slope: &Self::Slope) -> bool;
}

/// Numbers with slopes.
#[derive(Debug)]
pub struct Duals<C, S> {
    /// The underlying numbers.
    pub numbers: C,
    /// The way in which slopes are carried.
    pub slopes: S,
}

impl<C: Arithmetic, S: Slopes<C>> Duals<C, S> {
    fn with_slope(
        &mut self,
        value: C::Number,
        parts: &[(Partial<C::Number>, &S::Slope)],
    ) -> Option<(C::Number, S::Slope)> {
        let slope = self.slopes.combine(&mut self.numbers, &value, parts)?;
        Some((value, slope))
    }
}

impl<C: Arithmetic, S: Slopes<C>> Arithmetic for Duals<C, S> {
    type Number = (C::Number, S::Slope);

    fn make(&mut self, step: Step<Self::Number>) -> Option<Self::Number> {
        let numbers = &mut self.numbers;
        let by = |factor: &C::Number| Partial::Factor(factor.clone());
        match step {
            Step::Whole(value) => {
                let value = numbers.make(Step::Whole(value))?;
                self.with_slope(value, &[])
            }
            Step::Constant(value) => {
                let value = numbers.make(Step::Constant(value))?;
                self.with_slope(value, &[])
            }
            Step::Symbol(index) => {
                let value = numbers.make(Step::Symbol(index))?;
                let slope = self.slopes.symbol(numbers, index);
                Some((value, slope))
            }
            Step::Neg(a) => {
                let value = numbers.make(Step::Neg(&a.0))?;
                self.with_slope(value, &[(Partial::MinusOne, &a.1)])
            }
            Step::Add(a, b) => {
                let sum = numbers.make(Step::Add(&a.0, &b.0))?;
                self.with_slope(sum, &[(Partial::One, &a.1), (Partial::One, &b.1)])
            }
            Step::Sub(a, b) => {
                let difference = numbers.make(Step::Sub(&a.0, &b.0))?;
                self.with_slope(
                    difference,
                    &[(Partial::One, &a.1), (Partial::MinusOne, &b.1)],
                )
            }
            Step::Mul(a, b) => {
                let product = numbers.make(Step::Mul(&a.0, &b.0))?;
                self.with_slope(product, &[(by(&b.0), &a.1), (by(&a.0), &b.1)])
            }
            Step::Div(a, b) => {
                let [quotient, by_a, by_b] = numbers.quotient(&a.0, &b.0)?;
                self.with_slope(
                    quotient,
                    &[(Partial::Factor(by_a), &a.1), (Partial::Factor(by_b), &b.1)],
                )
            }
            Step::Apply(function, a, form) => {
                let form = || -> Form<C::Number> {
                    let atoms = form().into_iter();
                    atoms.map(|((value, _), c)| (value, c)).collect()
                };
                let value = numbers.make(Step::Apply(function, &a.0, &form))?;
                if !self.slopes.is_nonzero(numbers, &a.1) {
                    return self.with_slope(value, &[]);
                }
                let factor = numbers.slope(function, (&a.0, &value), &form)?;
                self.with_slope(value, &[(Partial::Factor(factor), &a.1)])
            }
            // Each branch has its own slope. If it is not known which branch is taken, each contributes by
            // its weight.
            Step::Select(c, a, b) => match numbers.is_positive(&c.0) {
                Some(true) => Some(a.clone()),
                Some(false) => Some(b.clone()),
                None => {
                    let value = numbers.make(Step::Select(&c.0, &a.0, &b.0))?;
                    let (zero, one) =
                        (numbers.make(Step::Whole(0))?, numbers.make(Step::Whole(1))?);
                    let by_a = numbers.make(Step::Select(&c.0, &one, &zero))?;
                    let by_b = numbers.make(Step::Select(&c.0, &zero, &one))?;
                    self.with_slope(
                        value,
                        &[(Partial::Factor(by_a), &a.1), (Partial::Factor(by_b), &b.1)],
                    )
                }
            },
            // A list has no slope of its own: the functions that read it differentiate by each of its
            // entries.
            Step::Listed(rest, a) => {
                let value = numbers.make(Step::Listed(&rest.0, &a.0))?;
                self.with_slope(value, &[])
            }
            // Σ ∂f/∂aⱼ aⱼ′.
            Step::External(component, list, form) => {
                let listed = form();
                let values = || -> Form<C::Number> {
                    let values = listed.iter().map(|((a, _), c)| (a.clone(), c.clone()));
                    values.collect()
                };
                let value = numbers.make(Step::External(component, &list.0, &values))?;
                let mut total = self.with_slope(value, &[])?;
                for (place, ((_, slope), sign)) in listed.iter().enumerate() {
                    if !self.slopes.is_nonzero(&self.numbers, slope) {
                        continue;
                    }
                    let by = component.differentiate(place);
                    let mut factor = self.numbers.make(Step::External(by, &list.0, &values))?;
                    if sign.is_negative() {
                        factor = self.numbers.make(Step::Neg(&factor))?;
                    }
                    let (value, before) = total;
                    let parts = [(Partial::One, &before), (Partial::Factor(factor), slope)];
                    total = self.with_slope(value, &parts)?;
                }
                Some(total)
            }
            // (x y′ − y x′)/(x² + y²).
            Step::Atan2(y, x) => {
                let value = numbers.make(Step::Atan2(&y.0, &x.0))?;
                if [y, x]
                    .iter()
                    .all(|a| !self.slopes.is_nonzero(numbers, &a.1))
                {
                    return self.with_slope(value, &[]);
                }
                let xx = numbers.make(Step::Mul(&x.0, &x.0))?;
                let yy = numbers.make(Step::Mul(&y.0, &y.0))?;
                let square = numbers.make(Step::Add(&xx, &yy))?;
                let minus = numbers.make(Step::Neg(&y.0))?;
                let by_y = numbers.make(Step::Div(&x.0, &square))?;
                let by_x = numbers.make(Step::Div(&minus, &square))?;
                self.with_slope(
                    value,
                    &[(Partial::Factor(by_y), &y.1), (Partial::Factor(by_x), &x.1)],
                )
            }
        }
    }

    fn is_zero(&self, a: &Self::Number) -> bool {
        self.numbers.is_zero(&a.0) && !self.slopes.is_nonzero(&self.numbers, &a.1)
    }

    fn is_positive(&self, a: &Self::Number) -> Option<bool> {
        self.numbers.is_positive(&a.0)
    }

    /// Needs only one division.
    fn quotient(&mut self, a: &Self::Number, b: &Self::Number) -> Option<[Self::Number; 3]> {
        let one = self.make(Step::Whole(1))?;
        let inverse = self.make(Step::Div(&one, b))?;
        let quotient = self.make(Step::Mul(a, &inverse))?;
        let by_b = self.make(Step::Mul(&quotient, &inverse))?;
        Some([quotient, inverse, self.make(Step::Neg(&by_b))?])
    }
}

impl<C: Modular, S: Slopes<C>> Modular for Duals<C, S> {
    fn residue(&mut self, value: ResiduePair) -> Option<Self::Number> {
        let value = self.numbers.residue(value)?;
        self.with_slope(value, &[])
    }
}

/// Slopes along one direction; the function gives the slope of each symbol.
#[derive(Clone, Debug)]
pub struct ForwardMode<F>(pub F);

impl<C: Arithmetic, F: Fn(usize) -> C::Number> Slopes<C> for ForwardMode<F> {
    type Slope = C::Number;

    fn symbol(&mut self, _: &mut C, index: usize) -> C::Number {
        (self.0)(index)
    }

    fn combine(
        &mut self,
        numbers: &mut C,
        _: &C::Number,
        parts: &[(Partial<C::Number>, &C::Number)],
    ) -> Option<C::Number> {
        let mut sum: Option<C::Number> = None;
        for (partial, slope) in parts {
            if !numbers.is_zero(slope) {
                let term = partial.times(numbers, slope)?;
                sum = Some(match sum {
                    Some(sum) => numbers.make(Step::Add(&sum, &term))?,
                    None => term,
                });
            }
        }
        sum.or_else(|| numbers.make(Step::Whole(0)))
    }

    fn is_nonzero(&self, numbers: &C, slope: &C::Number) -> bool {
        !numbers.is_zero(slope)
    }
}

/// Slopes along many directions; the function gives the slopes of each symbol. The list is empty if all are
/// 0.
#[derive(Clone, Debug)]
pub struct VectorForwardMode<F>(pub F);

impl<C: Arithmetic, F: Fn(usize) -> Vec<C::Number>> Slopes<C> for VectorForwardMode<F> {
    type Slope = Vec<C::Number>;

    fn symbol(&mut self, numbers: &mut C, index: usize) -> Vec<C::Number> {
        let slopes = (self.0)(index);
        let still = slopes.iter().all(|slope| numbers.is_zero(slope));
        if still { Vec::new() } else { slopes }
    }

    /// Operands with slope 0 do not contribute, even if their factor is infinite.
    fn combine(
        &mut self,
        numbers: &mut C,
        _: &C::Number,
        parts: &[(Partial<C::Number>, &Vec<C::Number>)],
    ) -> Option<Vec<C::Number>> {
        let width = parts.iter().map(|(_, slopes)| slopes.len()).max();
        let mut sums = vec![numbers.make(Step::Whole(0))?; width.unwrap_or(0)];
        for (partial, slopes) in parts {
            for (sum, slope) in sums.iter_mut().zip(*slopes) {
                if !numbers.is_zero(slope) {
                    let term = partial.times(numbers, slope)?;
                    *sum = numbers.make(Step::Add(sum, &term))?;
                }
            }
        }
        Some(sums)
    }

    fn is_nonzero(&self, _: &C, slopes: &Vec<C::Number>) -> bool {
        !slopes.is_empty()
    }
}

/// Derivatives of a value by at most two earlier entries, with the places of these in the record.
type Entry<N> = [Option<(Partial<N>, usize)>; 2];

/// Record of the operations on values that depend on symbols, for reverse-mode differentiation.
#[derive(Clone, Debug)]
pub struct Record<N> {
    entries: Vec<Entry<N>>,
    /// Indices of symbols, with their places in the record.
    symbols: Vec<(usize, usize)>,
}

impl<N> Default for Record<N> {
    fn default() -> Self {
        Record {
            entries: Vec::new(),
            symbols: Vec::new(),
        }
    }
}

impl<N: Clone> Record<N> {
    /// Computes ∂f/∂xₖ for the first `symbols` symbols by a reverse sweep, for f at a place of the record.
    pub fn gradient<C: Arithmetic<Number = N>>(
        &self,
        numbers: &mut C,
        place: Option<usize>,
        symbols: usize,
    ) -> Option<Vec<N>> {
        let zero = numbers.make(Step::Whole(0))?;
        let mut weights = vec![zero.clone(); self.entries.len()];
        if let Some(place) = place {
            weights[place] = numbers.make(Step::Whole(1))?;
        }
        for (place, parts) in self.entries.iter().enumerate().rev() {
            let weight = weights[place].clone();
            if numbers.is_zero(&weight) {
                continue;
            }
            for (partial, place) in parts.iter().flatten() {
                let share = partial.times(numbers, &weight)?;
                weights[*place] = numbers.make(Step::Add(&weights[*place], &share))?;
            }
        }
        let mut row = vec![zero; symbols];
        for &(symbol, place) in &self.symbols {
            if let Some(entry) = row.get_mut(symbol) {
                *entry = weights[place].clone();
            }
        }
        Some(row)
    }
}

impl<C: Arithmetic> Slopes<C> for Record<C::Number> {
    type Slope = Option<usize>;

    fn symbol(&mut self, _: &mut C, index: usize) -> Option<usize> {
        self.symbols.push((index, self.entries.len()));
        self.entries.push([None, None]);
        Some(self.entries.len() - 1)
    }

    fn combine(
        &mut self,
        _: &mut C,
        _: &C::Number,
        parts: &[(Partial<C::Number>, &Option<usize>)],
    ) -> Option<Option<usize>> {
        let part = |k: usize| {
            let (partial, place) = parts.get(k)?;
            Some((partial.clone(), (**place)?))
        };
        let entry = [part(0), part(1)];
        if entry.iter().all(Option::is_none) {
            return Some(None);
        }
        self.entries.push(entry);
        Some(Some(self.entries.len() - 1))
    }

    fn is_nonzero(&self, _: &C, place: &Option<usize>) -> bool {
        place.is_some()
    }
}
