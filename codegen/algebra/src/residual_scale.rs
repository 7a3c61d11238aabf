//! Scales of equations, relative to which residuals are large or small, whatever the units.

use super::graph::{Edge, Graph};
use super::numbers::{Arithmetic, Step};
use super::numeric::{Floats, evaluate};
use super::slopes::slopes;
use super::walk;
use std::ops::Range;

/// Values, with the sizes of the terms that they are sums of.
struct Sized<'a>(Floats<'a>);

impl Arithmetic for Sized<'_> {
    type Number = (f64, f64);

    fn make(&mut self, step: Step<(f64, f64)>) -> Option<(f64, f64)> {
        let mut value = |step: Step<f64>| self.0.make(step);
        let plain = |value: f64| (value, value.abs());
        Some(match step {
            Step::Neg(a) => (-a.0, a.1),
            Step::Add(a, b) => (a.0 + b.0, a.1 + b.1),
            Step::Sub(a, b) => (a.0 - b.0, a.1 + b.1),
            Step::Mul(a, b) => (a.0 * b.0, a.1 * b.1),
            Step::Div(a, b) => (a.0 / b.0, a.1 / b.0.abs()),
            Step::Select(c, a, b) => {
                if c.0 > 0.0 {
                    *a
                } else {
                    *b
                }
            }
            Step::Whole(number) => plain(value(Step::Whole(number))?),
            Step::Constant(number) => plain(value(Step::Constant(number))?),
            Step::Symbol(index) => plain(value(Step::Symbol(index))?),
            Step::Apply(function, a, form) => {
                let form = || {
                    form()
                        .into_iter()
                        .map(|(a, factor)| (a.0, factor))
                        .collect()
                };
                plain(value(Step::Apply(function, &a.0, &form))?)
            }
            Step::Atan2(y, x) => plain(value(Step::Atan2(&y.0, &x.0))?),
            Step::Listed(..) | Step::External(..) => (f64::NAN, f64::NAN),
        })
    }

    fn is_positive(&self, a: &(f64, f64)) -> Option<bool> {
        self.0.is_positive(&a.0)
    }
}

/// Returns the sizes of equations, given the value of every symbol: the effect of a change of 1 along the
/// symbols at these places, plus the size of the terms that cancel, to which rounding errors are
/// proportional. A size that would not be finite is 0.
pub fn residual_scales(
    graph: &Graph,
    equations: &[Edge],
    symbols: &[f64],
    places: Range<usize>,
) -> Vec<f64> {
    let directions = places.map(|place| {
        let mut direction = vec![0.0; place + 1];
        direction[place] = 1.0;
        direction
    });
    let directions: Vec<Vec<f64>> = directions.collect();
    let slopes = slopes(graph, equations, symbols, &directions);
    let terms = walk::evaluate(graph, equations, &mut Sized(Floats(symbols))).unwrap_or_default();
    let size = |place: usize| {
        let slopes = slopes.get(place).map_or(&[][..], |row| &row.along);
        let moved: f64 = slopes.iter().map(|slope| slope.abs()).sum();
        let size = moved + terms.get(place).map_or(0.0, |(_, size)| *size);
        if size.is_finite() { size } else { 0.0 }
    };
    (0..equations.len()).map(size).collect()
}

/// Returns each equation's residual divided by its [scale](residual_scales): the size of its terms plus the effect of a
/// change of 1 along the symbols at `places`.
pub fn relative_residuals(
    graph: &Graph,
    equations: &[Edge],
    symbols: &[f64],
    places: Range<usize>,
) -> Vec<f64> {
    let sizes = residual_scales(graph, equations, symbols, places);
    let left = evaluate(graph, equations, symbols).into_iter().zip(sizes);
    left.map(|(left, size)| relative_residual(left, size))
        .collect()
}

/// Returns the residual of an equation relative to its size, or the residual itself if the size is 0.
pub fn relative_residual(left: f64, size: f64) -> f64 {
    left / if size > 0.0 { size } else { 1.0 }
}
