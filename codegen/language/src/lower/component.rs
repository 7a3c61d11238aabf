//! Finds the component of X that contains the start, if the user's constraints have several and no factor tells them
//! apart. For example, a parallelogram of bars folds into a crossed one, and x² = y² are two lines.
//!
//! Points of X are followed from the start in small steps, while the parameters vary, too. Equations of low degree
//! that hold at all of these points, but not everywhere on X, are added to the constraints, so that the points used
//! in proofs lie on that component. An equation that holds only near the start, such as x = 2 y where x = 2 y + z²⁰,
//! ceases to hold gradually on the way from there; at a crossing of components it ceases at once. The generated code
//! contains the constraints as they were written.

use crate::algebra::graph::{Edge, Function, Graph};
use crate::algebra::newton::Newton;
use crate::algebra::residue_pair::Random;
use crate::model::class;
use crate::model::points::Points;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Signed;

/// Length of a step: absolute for coordinates, relative for parameters.
const STEP: f64 = 0.12;
/// Largest deviation from the predicted point; beyond it, another component may have been reached.
const JUMP: f64 = 0.3;
/// Largest number of terms that are fitted.
const MOST_TERMS: usize = 120;
/// Bounds for what elimination leaves of a column: below the first the column depends on others, above the second it
/// does not.
const DEPENDENT: (f64, f64) = (1e-8, 1e-6);
/// Largest error of a coefficient.
const CLOSE: f64 = 1e-6;
/// Largest denominator of a coefficient.
const DENOMINATORS: i64 = 64;
/// Smallest value of an equation at a point of X where it does not hold.
const APART: f64 = 1e-3;
/// Number of points of X that are looked at elsewhere.
const ELSEWHERE: usize = 24;
/// Number of walks away from the start, and number of steps of each.
const WALKS: usize = 16;
const STEPS: usize = 40;
/// A walk ends where the volume of the rows of φ falls below this fraction of its value at the start: the rows become
/// dependent where components meet.
const MEETING: f64 = 0.05;
/// Largest residual, on such a walk, of an equation that holds; and the residual one step before above which an
/// equation counts as ceasing gradually rather than at once.
const HOLDS: f64 = 1e-7;
const CEASING: f64 = 1e-10;

/// A term: a product of symbols, given by their indices.
type Term = Vec<usize>;

/// Adds equations that distinguish the component of the start from others; `near` are the values of all symbols at
/// the start.
pub fn separate(points: &mut Points, phi: &[(Edge, String)], near: &[f64]) {
    let equations = points.equations(phi);
    let (coordinates, parameters) = symbols(points);
    let mut walk = Walk {
        equations: &equations,
        coordinates: (points.first, points.dimension()),
        parameters: &parameters,
        random: Random::new(0xc03b),
    };
    for terms in [linear(&coordinates, &parameters), quadratic(&coordinates)] {
        if terms.len() > MOST_TERMS {
            continue;
        }
        let Some(path) = walk.follow(near, 2 * terms.len() + 10) else {
            return;
        };
        let rows = path.iter().map(|at| values(&terms, at)).collect();
        let fits = dependent(rows, terms.len());
        let found: Vec<Vec<(Number, &Term)>> = fits
            .iter()
            .filter_map(|fit| recognised(fit, &terms))
            .collect();
        if found.is_empty() {
            continue;
        }
        let walks = walk.away(near);
        let found: Vec<_> = found
            .into_iter()
            .filter(|equation| !walks.iter().any(|walk| ceases(equation, walk)))
            .collect();
        let elsewhere = walk.elsewhere(near);
        let mut tells = false;
        for equation in found {
            let fails = |at: &Vec<f64>| value(&equation, at).abs() > APART;
            if elsewhere.iter().any(fails) {
                let edge = written(&mut points.free, &equation);
                points.constraints.push(edge);
                tells = true;
            }
        }
        if tells {
            return;
        }
    }
}

/// Returns the coordinates and the parameters in the constraints, as indices of symbols.
fn symbols(points: &Points) -> (Vec<usize>, Vec<usize>) {
    let graph = &points.free;
    let mut all: Vec<usize> = graph
        .reachable(&points.constraints)
        .into_iter()
        .filter(|&id| graph.class(id) & (class::COORD | class::PARAM) != 0)
        .filter_map(|id| graph.as_symbol(Edge::of(id)))
        .collect();
    all.sort_unstable();
    // π is the first symbol, and parameters come before coordinates.
    all.retain(|&index| index > 0);
    all.into_iter().partition(|&index| index >= points.first)
}

/// Returns the terms 1, each coordinate and parameter, and the products of a coordinate and a parameter.
fn linear(coordinates: &[usize], parameters: &[usize]) -> Vec<Term> {
    let single = coordinates.iter().chain(parameters).map(|&a| vec![a]);
    let pairs = coordinates
        .iter()
        .flat_map(|&a| parameters.iter().map(move |&b| vec![a, b]));
    std::iter::once(Vec::new())
        .chain(single)
        .chain(pairs)
        .collect()
}

/// Returns the terms 1, each coordinate, and the products of two coordinates.
fn quadratic(coordinates: &[usize]) -> Vec<Term> {
    let single = coordinates.iter().map(|&a| vec![a]);
    let pairs = coordinates.iter().enumerate();
    let pairs = pairs.flat_map(|(i, &a)| coordinates[i..].iter().map(move |&b| vec![a, b]));
    std::iter::once(Vec::new())
        .chain(single)
        .chain(pairs)
        .collect()
}

fn values(terms: &[Term], at: &[f64]) -> Vec<f64> {
    let product = |term: &Term| term.iter().map(|&symbol| at[symbol]).product();
    terms.iter().map(product).collect()
}

/// Takes steps on X.
struct Walk<'a> {
    equations: &'a Newton,
    /// Index of the first coordinate, and number of coordinates.
    coordinates: (usize, usize),
    parameters: &'a [usize],
    random: Random,
}

impl Walk<'_> {
    /// Returns a random number between −1 and 1.
    fn number(&mut self) -> f64 {
        (self.random.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Returns the point of X near the given values.
    fn close(&self, mut numbers: Vec<f64>) -> Option<Vec<f64>> {
        let (first, count) = self.coordinates;
        let x = self.equations.solve_near(&numbers)?;
        numbers[first..first + count].copy_from_slice(&x);
        numbers.iter().all(|a| a.is_finite()).then_some(numbers)
    }

    /// Returns a path of `count` points from the start; `None` if steps fail too often.
    fn follow(&mut self, start: &[f64], count: usize) -> Option<Vec<Vec<f64>>> {
        let (first, dimension) = self.coordinates;
        let mut at = self.close(start.to_vec())?;
        let mut path = Vec::new();
        for _ in 0..3 * count {
            let mut guess = at.clone();
            for x in &mut guess[first..first + dimension] {
                *x += STEP * self.number();
            }
            for &parameter in self.parameters {
                guess[parameter] += STEP * self.number() * start[parameter].abs().max(0.1);
            }
            let Some(next) = self.close(guess.clone()) else {
                continue;
            };
            let apart = next.iter().zip(&guess).map(|(a, b)| (a - b).abs());
            if apart.fold(0.0, f64::max) > JUMP {
                continue;
            }
            at = next;
            path.push(at.clone());
            if path.len() == count {
                return Some(path);
            }
        }
        None
    }

    /// Walks on X from the start towards random points, which need not lie on X.
    fn away(&mut self, start: &[f64]) -> Vec<Vec<Vec<f64>>> {
        let (first, dimension) = self.coordinates;
        let least = MEETING * self.equations.volume(start);
        let walk = |walk: &mut Self| {
            let target: Vec<f64> = (0..dimension).map(|_| 2.0 * walk.number()).collect();
            let mut at = start.to_vec();
            let mut path = Vec::new();
            for _ in 0..STEPS {
                let mut guess = at.clone();
                for (x, target) in guess[first..first + dimension].iter_mut().zip(&target) {
                    *x += (target - *x).clamp(-STEP, STEP);
                }
                let Some(next) = walk.close(guess) else {
                    break;
                };
                let moved = next.iter().zip(&at).map(|(a, b)| (a - b).abs());
                let apart = walk.equations.volume(&next) > least;
                if moved.fold(0.0, f64::max) > JUMP || !apart {
                    break;
                }
                at.clone_from(&next);
                path.push(next);
            }
            path
        };
        (0..WALKS).map(|_| walk(self)).collect()
    }

    /// Returns points of X found from random guesses.
    fn elsewhere(&mut self, start: &[f64]) -> Vec<Vec<f64>> {
        let (first, dimension) = self.coordinates;
        let mut found = Vec::new();
        for _ in 0..ELSEWHERE {
            let mut guess = start.to_vec();
            for x in &mut guess[first..first + dimension] {
                *x = 2.0 * self.number();
            }
            found.extend(self.close(guess));
        }
        found
    }
}

/// Returns coefficients with which the columns sum to 0 in all rows, by elimination; none if it is not clear which
/// columns depend on others.
fn dependent(mut rows: Vec<Vec<f64>>, columns: usize) -> Vec<Vec<f64>> {
    let size = |k: usize| {
        rows.iter()
            .fold(0.0, |most: f64, row| most.max(row[k].abs()))
    };
    let sizes: Vec<f64> = (0..columns).map(|k| size(k).max(1e-3)).collect();
    for row in &mut rows {
        row.iter_mut().zip(&sizes).for_each(|(a, size)| *a /= size);
    }
    let mut open: Vec<usize> = (0..columns).collect();
    let mut pivots = Vec::new();
    while pivots.len() < rows.len() {
        let done = pivots.len();
        let places = (done..rows.len()).flat_map(|i| open.iter().map(move |&k| (i, k)));
        let largest = places.max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs()));
        let Some((i, k)) = largest.filter(|&(i, k)| rows[i][k].abs() > DEPENDENT.0) else {
            break;
        };
        if rows[i][k].abs() < DEPENDENT.1 {
            return Vec::new();
        }
        rows.swap(done, i);
        let own: Vec<f64> = rows[done].iter().map(|a| a / rows[done][k]).collect();
        for (other, row) in rows.iter_mut().enumerate() {
            let factor = row[k];
            if other == done {
                row.copy_from_slice(&own);
            } else if factor != 0.0 {
                row.iter_mut().zip(&own).for_each(|(a, b)| *a -= factor * b);
            }
        }
        pivots.push(k);
        open.retain(|&other| other != k);
    }
    let fit = |&free: &usize| {
        let mut fit = vec![0.0; columns];
        fit[free] = 1.0 / sizes[free];
        for (row, &pivot) in rows.iter().zip(&pivots) {
            fit[pivot] = -row[free] / sizes[pivot];
        }
        let largest = fit.iter().fold(
            0.0_f64,
            |most, a| if a.abs() > most.abs() { *a } else { most },
        );
        fit.iter().map(|a| a / largest).collect()
    };
    open.iter().map(fit).collect()
}

/// A number n/d or ±√(n/d).
#[derive(Clone, Copy)]
struct Number {
    ratio: (i64, i64),
    root: bool,
}

impl Number {
    fn value(&self) -> f64 {
        let value = self.ratio.0 as f64 / self.ratio.1 as f64;
        if self.root {
            value.signum() * value.abs().sqrt()
        } else {
            value
        }
    }

    /// Returns the simplest such number that is close.
    fn near(value: f64) -> Option<Number> {
        let ratio = |value: f64| {
            let found = (1..=DENOMINATORS).find(|&d| {
                let n = value * d as f64;
                (n - n.round()).abs() < CLOSE
            });
            found.map(|d| ((value * d as f64).round() as i64, d))
        };
        let plain = ratio(value).map(|ratio| Number { ratio, root: false });
        plain.or_else(|| ratio(value * value.abs()).map(|ratio| Number { ratio, root: true }))
    }
}

/// Replaces the coefficients of a fit by simple numbers; `None` if one of them is not close to any.
fn recognised<'a>(fit: &[f64], terms: &'a [Term]) -> Option<Vec<(Number, &'a Term)>> {
    let pairs = fit.iter().zip(terms).filter(|(a, _)| a.abs() > CLOSE);
    pairs
        .map(|(&a, term)| Some((Number::near(a)?, term)))
        .collect()
}

fn value(equation: &[(Number, &Term)], at: &[f64]) -> f64 {
    let terms = equation.iter();
    terms
        .map(|(number, term)| number.value() * term.iter().map(|&i| at[i]).product::<f64>())
        .sum()
}

/// Returns whether an equation ceases to hold gradually on a walk, rather than at once, as it does beyond a crossing.
fn ceases(equation: &[(Number, &Term)], walk: &[Vec<f64>]) -> bool {
    let sizes: Vec<f64> = walk.iter().map(|at| value(equation, at).abs()).collect();
    let first = sizes.windows(2).find(|pair| pair[1] > HOLDS);
    first.is_some_and(|pair| pair[0] > CEASING)
}

fn written(graph: &mut Graph, equation: &[(Number, &Term)]) -> Edge {
    let mut sum = graph.zero();
    for (number, term) in equation {
        let (n, d) = number.ratio;
        let ratio = BigRational::new(BigInt::from(n), BigInt::from(d));
        let mut product = graph.rational(&ratio.abs());
        if number.root {
            product = graph.apply(Function::Sqrt, product);
        }
        for &symbol in *term {
            let symbol = Edge::of(graph.symbols()[symbol].node);
            product = graph.mul(product, symbol);
        }
        sum = if n < 0 {
            graph.sub(sum, product)
        } else {
            graph.add(sum, product)
        };
    }
    sum
}
