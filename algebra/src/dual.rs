//! Numbers with slopes. The rules of derivation stand here once; how slopes are carried is a matter of
//! its own:
//!
//! | slopes | carried as | cost |
//! |---|---|---|
//! | ∂f along one direction | [`Along`]: a number | that of a value |
//! | ∂f along many directions | [`Across`]: a number for each; none where nothing moves | that of a value, times the directions |
//! | ∂f/∂xₖ for all symbols | [`Record`]: a place in a record that is read backwards | that of a value |
//! | Σ \|∂f/∂a\| eₐ, bounds of errors | `rounding` | that of a value |
//!
//! Numbers with slopes are numbers: slopes of slopes are those over [`Duals`].

use super::fp::Fp;
use super::function::Function;
use super::numbers::{Form, Modular, Numbers, slope};
use num_rational::BigRational;

/// ∂f/∂a of an operation.
#[derive(Clone, Debug)]
pub enum Partial<N> {
    /// 1.
    One,
    /// −1.
    MinusOne,
    /// Any other.
    By(N),
}

impl<N: Clone> Partial<N> {
    /// It times a slope.
    fn times<C: Numbers<Number = N>>(&self, numbers: &mut C, slope: &N) -> N {
        match self {
            Partial::One => slope.clone(),
            Partial::MinusOne => numbers.neg(slope),
            Partial::By(factor) => numbers.mul(factor, slope),
        }
    }
}

/// A way to carry slopes.
pub trait Slopes<C: Numbers> {
    /// What goes with a value.
    type Slope: Clone;
    /// Of a symbol.
    fn symbol(&mut self, numbers: &mut C, index: usize, value: &C::Number) -> Self::Slope;
    /// Σ ∂f/∂a times the slope of a, for f with this value.
    fn combine(
        &mut self,
        numbers: &mut C,
        value: &C::Number,
        parts: &[(Partial<C::Number>, &Self::Slope)],
    ) -> Self::Slope;
    /// Of −f.
    fn neg(&mut self, numbers: &mut C, slope: &Self::Slope) -> Self::Slope;
    /// Whether it may differ from 0.
    fn moves(&self, numbers: &C, slope: &Self::Slope) -> bool;
}

/// Numbers with slopes.
#[derive(Debug)]
pub struct Duals<C, S> {
    /// The numbers.
    pub numbers: C,
    /// How slopes are carried.
    pub slopes: S,
}

impl<C: Numbers, S: Slopes<C>> Duals<C, S> {
    fn with(
        &mut self,
        value: C::Number,
        parts: &[(Partial<C::Number>, &S::Slope)],
    ) -> (C::Number, S::Slope) {
        let slope = self.slopes.combine(&mut self.numbers, &value, parts);
        (value, slope)
    }
}

impl<C: Numbers, S: Slopes<C>> Numbers for Duals<C, S> {
    type Number = (C::Number, S::Slope);

    fn whole(&mut self, value: i32) -> Self::Number {
        let value = self.numbers.whole(value);
        self.with(value, &[])
    }

    fn constant(&mut self, value: &BigRational) -> Option<Self::Number> {
        let value = self.numbers.constant(value)?;
        Some(self.with(value, &[]))
    }

    fn symbol(&mut self, index: usize) -> Option<Self::Number> {
        let value = self.numbers.symbol(index)?;
        let slope = self.slopes.symbol(&mut self.numbers, index, &value);
        Some((value, slope))
    }

    fn neg(&mut self, a: &Self::Number) -> Self::Number {
        let slope = self.slopes.neg(&mut self.numbers, &a.1);
        (self.numbers.neg(&a.0), slope)
    }

    fn add(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number {
        let sum = self.numbers.add(&a.0, &b.0);
        self.with(sum, &[(Partial::One, &a.1), (Partial::One, &b.1)])
    }

    fn sub(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number {
        let difference = self.numbers.sub(&a.0, &b.0);
        self.with(
            difference,
            &[(Partial::One, &a.1), (Partial::MinusOne, &b.1)],
        )
    }

    fn mul(&mut self, a: &Self::Number, b: &Self::Number) -> Self::Number {
        let product = self.numbers.mul(&a.0, &b.0);
        let by = |factor: &C::Number| Partial::By(factor.clone());
        self.with(product, &[(by(&b.0), &a.1), (by(&a.0), &b.1)])
    }

    fn div(&mut self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number> {
        let [quotient, by_a, by_b] = self.numbers.quotient(&a.0, &b.0)?;
        let parts = [(Partial::By(by_a), &a.1), (Partial::By(by_b), &b.1)];
        Some(self.with(quotient, &parts))
    }

    fn apply(
        &mut self,
        function: Function,
        a: &Self::Number,
        form: &dyn Fn() -> Form<Self::Number>,
    ) -> Option<Self::Number> {
        let numbers = &mut self.numbers;
        let form = || -> Form<C::Number> {
            let atoms = form().into_iter();
            atoms.map(|((value, _), c)| (value, c)).collect()
        };
        let value = numbers.apply(function, &a.0, &form)?;
        if !self.slopes.moves(numbers, &a.1) {
            return Some(self.with(value, &[]));
        }
        let factor = slope(numbers, function, (&a.0, &value), &form)?;
        Some(self.with(value, &[(Partial::By(factor), &a.1)]))
    }

    /// (x y′ − y x′)/(x² + y²).
    fn atan2(&mut self, y: &Self::Number, x: &Self::Number) -> Option<Self::Number> {
        let numbers = &mut self.numbers;
        let value = numbers.atan2(&y.0, &x.0)?;
        if !self.slopes.moves(numbers, &y.1) && !self.slopes.moves(numbers, &x.1) {
            return Some(self.with(value, &[]));
        }
        let (xx, yy) = (numbers.mul(&x.0, &x.0), numbers.mul(&y.0, &y.0));
        let (square, minus) = (numbers.add(&xx, &yy), numbers.neg(&y.0));
        let (by_y, by_x) = (numbers.div(&x.0, &square)?, numbers.div(&minus, &square)?);
        let parts = [(Partial::By(by_y), &y.1), (Partial::By(by_x), &x.1)];
        Some(self.with(value, &parts))
    }

    fn is_zero(&self, a: &Self::Number) -> bool {
        self.numbers.is_zero(&a.0) && !self.slopes.moves(&self.numbers, &a.1)
    }

    /// With one inverse.
    fn quotient(&mut self, a: &Self::Number, b: &Self::Number) -> Option<[Self::Number; 3]> {
        let one = self.whole(1);
        let inverse = self.div(&one, b)?;
        let quotient = self.mul(a, &inverse);
        let by_b = self.mul(&quotient, &inverse);
        let by_b = self.neg(&by_b);
        Some([quotient, inverse, by_b])
    }
}

impl<C: Modular, S: Slopes<C>> Modular for Duals<C, S> {
    fn residue(&mut self, value: Fp) -> Self::Number {
        let value = self.numbers.residue(value);
        self.with(value, &[])
    }
}

/// Slopes along a direction in the symbols.
#[derive(Clone, Debug)]
pub struct Along<F>(pub F);

impl<C: Numbers, F: Fn(usize) -> C::Number> Slopes<C> for Along<F> {
    type Slope = C::Number;

    fn symbol(&mut self, _: &mut C, index: usize, _: &C::Number) -> C::Number {
        (self.0)(index)
    }

    fn combine(
        &mut self,
        numbers: &mut C,
        _: &C::Number,
        parts: &[(Partial<C::Number>, &C::Number)],
    ) -> C::Number {
        let mut sum = None;
        for (partial, slope) in parts {
            if !numbers.is_zero(slope) {
                let term = partial.times(numbers, slope);
                sum = Some(sum.map_or_else(|| term.clone(), |sum| numbers.add(&sum, &term)));
            }
        }
        sum.unwrap_or_else(|| numbers.whole(0))
    }

    fn neg(&mut self, numbers: &mut C, slope: &C::Number) -> C::Number {
        numbers.neg(slope)
    }

    fn moves(&self, numbers: &C, slope: &C::Number) -> bool {
        !numbers.is_zero(slope)
    }
}

/// Slopes along many directions: none where nothing moves.
#[derive(Clone, Debug)]
pub struct Across<F>(pub F);

impl<C: Numbers, F: Fn(usize) -> Vec<C::Number>> Slopes<C> for Across<F> {
    type Slope = Vec<C::Number>;

    fn symbol(&mut self, numbers: &mut C, index: usize, _: &C::Number) -> Vec<C::Number> {
        let slopes = (self.0)(index);
        let still = slopes.iter().all(|slope| numbers.is_zero(slope));
        if still { Vec::new() } else { slopes }
    }

    /// What does not move takes no part, also where its factor is infinite.
    fn combine(
        &mut self,
        numbers: &mut C,
        _: &C::Number,
        parts: &[(Partial<C::Number>, &Vec<C::Number>)],
    ) -> Vec<C::Number> {
        let width = parts.iter().map(|(_, slopes)| slopes.len()).max();
        let mut sums = vec![numbers.whole(0); width.unwrap_or(0)];
        for (partial, slopes) in parts {
            for (sum, slope) in sums.iter_mut().zip(*slopes) {
                if !numbers.is_zero(slope) {
                    let term = partial.times(numbers, slope);
                    *sum = numbers.add(sum, &term);
                }
            }
        }
        sums
    }

    fn neg(&mut self, numbers: &mut C, slopes: &Vec<C::Number>) -> Vec<C::Number> {
        slopes.iter().map(|slope| numbers.neg(slope)).collect()
    }

    fn moves(&self, _: &C, slopes: &Vec<C::Number>) -> bool {
        !slopes.is_empty()
    }
}

/// What values were made of: for each that moves, the places of what it is made of, with the
/// derivatives by these.
#[derive(Clone, Debug)]
pub struct Record<N> {
    entries: Vec<[Option<(Partial<N>, usize)>; 2]>,
    /// Symbols with their places.
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
    /// ∂f/∂xₖ of the first symbols, for f at a place.
    pub fn backwards<C: Numbers<Number = N>>(
        &self,
        numbers: &mut C,
        place: Option<usize>,
        symbols: usize,
    ) -> Vec<N> {
        let zero = numbers.whole(0);
        let mut weights = vec![zero.clone(); self.entries.len()];
        if let Some(place) = place {
            weights[place] = numbers.whole(1);
        }
        for (place, parts) in self.entries.iter().enumerate().rev() {
            let weight = weights[place].clone();
            if numbers.is_zero(&weight) {
                continue;
            }
            for (partial, place) in parts.iter().flatten() {
                let share = partial.times(numbers, &weight);
                weights[*place] = numbers.add(&weights[*place], &share);
            }
        }
        let mut row = vec![zero; symbols];
        for &(symbol, place) in &self.symbols {
            if let Some(entry) = row.get_mut(symbol) {
                *entry = weights[place].clone();
            }
        }
        row
    }

    fn push(&mut self, entry: [Option<(Partial<N>, usize)>; 2]) -> Option<usize> {
        self.entries.push(entry);
        Some(self.entries.len() - 1)
    }
}

impl<C: Numbers> Slopes<C> for Record<C::Number> {
    type Slope = Option<usize>;

    fn symbol(&mut self, _: &mut C, index: usize, _: &C::Number) -> Option<usize> {
        self.symbols.push((index, self.entries.len()));
        self.push([None, None])
    }

    fn combine(
        &mut self,
        _: &mut C,
        _: &C::Number,
        parts: &[(Partial<C::Number>, &Option<usize>)],
    ) -> Option<usize> {
        let part = |k: usize| {
            let (partial, place) = parts.get(k)?;
            Some((partial.clone(), (**place)?))
        };
        let entry = [part(0), part(1)];
        if entry.iter().all(Option::is_none) {
            return None;
        }
        self.push(entry)
    }

    fn neg(&mut self, _: &mut C, place: &Option<usize>) -> Option<usize> {
        let place = (*place)?;
        self.push([Some((Partial::MinusOne, place)), None])
    }

    fn moves(&self, _: &C, place: &Option<usize>) -> bool {
        place.is_some()
    }
}
