//! The KKT system of constrained motion: ξ̇ and multipliers λ of M ξ̇ = f − h + Bᵀ λ, B ξ̇ = b, by M = L D Lᵀ and the Schur complement
//! S = B M⁻¹ Bᵀ, both unrolled.

use super::dependent::{
    CLEARING_POWER, SERIES_COEFFICIENTS, multipliers_at, regularization_rows, regularize,
};
use super::parts::EquationTerms;
use crate::calculus::Calculus;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Function, Graph};
use hamel_algebra::residue_pair::ResiduePair;
use hamel_language::model::Model;

/// Solution ξ̇, λ of the constrained equations of motion, as expressions.
#[derive(Clone, Debug)]
pub struct KktSolution {
    /// Accelerations ξ̇.
    pub xi_dot: Vec<Edge>,
    /// Multipliers λ, one for each row of B.
    pub multipliers: Vec<Edge>,
}

/// Returns the right-hand side of B ξ̇ = …, for constraints with the rate s = B ξ + b.
///
/// It is −Ḃ ξ − ḃ, plus the terms of a stabilised constraint that make a violation decay like exp(−λ t): −λ s, or
/// −2 λ s − λ² φ if s is the rate of an equation φ = 0 between coordinates.
pub fn constraint_accelerations(model: &mut Model, calculus: &mut Calculus) -> Vec<Edge> {
    let constraints = model.constraints.clone();
    constraints
        .iter()
        .map(|constraint| {
            let graph = &mut model.graph;
            let speed = constraint.speed(graph, &model.xi);
            let mut sum = calculus.rate(graph, speed);
            if let Some(lambda) = constraint.stabilized {
                let order = if constraint.is_holonomic() { 2 } else { 1 };
                let order = graph.ratio(order, 1);
                let damping = graph.mul(order, lambda);
                let damped = graph.mul(damping, speed);
                let stiffness = graph.mul(lambda, lambda);
                let pulled = graph.mul(stiffness, constraint.residual);
                sum = graph.sum(&[sum, damped, pulled]);
            }
            -sum
        })
        .collect()
}

/// Factors L D Lᵀ of M and of S = B M⁻¹ Bᵀ, with which the KKT system is solved.
#[derive(Clone, Debug)]
pub struct KktFactors {
    order: Vec<usize>,
    mass: Factors,
    /// Columns of L⁻¹ Bᵀ, and (in `scaled`) the same divided by D.
    bonds: Vec<Vec<Edge>>,
    scaled: Vec<Vec<Edge>>,
    inner: Factors,
    /// Diagonal that was added to S before it was factored, if S is singular; else empty.
    raised: Vec<Edge>,
}

/// Factors M, in a given elimination order, and S; `None` if a pivot vanishes identically.
pub fn factorize(
    graph: &mut Graph,
    parts: &EquationTerms,
    rows: &[Vec<Edge>],
    order: &[usize],
    raising: Option<&[Vec<usize>]>,
) -> Option<KktFactors> {
    let m = rows.len();
    let ordered = |row: &[Edge]| order.iter().map(|&i| row[i]).collect::<Vec<_>>();
    let mut matrix: Vec<Vec<Edge>> = order.iter().map(|&i| ordered(&parts.mass[i])).collect();
    let mass = factor(graph, &mut matrix)?;
    let mut bonds: Vec<Vec<Edge>> = rows.iter().map(|row| ordered(row)).collect();
    for bond in &mut bonds {
        forward(graph, &mass, bond);
    }
    let scaled: Vec<Vec<Edge>> = bonds
        .iter()
        .map(|bond| {
            let entries = bond.iter().zip(&mass.inverses);
            entries.map(|(&b, &d)| graph.mul(b, d)).collect()
        })
        .collect();
    let mut schur: Vec<Vec<Edge>> = vec![vec![graph.zero(); m]; m];
    for i in 0..m {
        for j in 0..=i {
            let entry = graph.dot(&scaled[i], &bonds[j]);
            (schur[i][j], schur[j][i]) = (entry, entry);
        }
    }
    let mut matrix = schur;
    let raised = raising.map_or(Vec::new(), |rows| regularize(graph, &mut matrix, rows));
    Some(KktFactors {
        order: order.to_vec(),
        inner: factor(graph, &mut matrix)?,
        mass,
        bonds,
        scaled,
        raised,
    })
}

impl KktFactors {
    /// Returns the pivots of M in the order of velocities, then those of S in the order of rows.
    ///
    /// A pivot of S vanishes where the rows of B become dependent, at a singular configuration.
    pub fn pivots(&self) -> Vec<Edge> {
        let mut pivots = self.mass.pivots.clone();
        for (&i, &pivot) in self.order.iter().zip(&self.mass.pivots) {
            pivots[i] = pivot;
        }
        pivots.extend(&self.inner.pivots);
        pivots
    }

    /// Solves M ξ̇ = f + Bᵀ λ, B ξ̇ = right for ξ̇ and λ.
    pub fn solve(&self, graph: &mut Graph, force: &[Edge], right: &[Edge]) -> KktSolution {
        let mut force: Vec<Edge> = self.order.iter().map(|&i| force[i]).collect();
        forward(graph, &self.mass, &mut force);
        let wanted: Vec<Edge> = right
            .iter()
            .zip(&self.scaled)
            .map(|(&right, scaled)| {
                let free = graph.dot(scaled, &force);
                graph.sub(right, free)
            })
            .collect();
        let multipliers = self.multipliers(graph, wanted);
        let mut solution: Vec<Edge> = (0..force.len())
            .map(|k| {
                let column: Vec<Edge> = self.bonds.iter().map(|bond| bond[k]).collect();
                let pull = graph.dot(&column, &multipliers);
                let sum = graph.add(force[k], pull);
                graph.mul(sum, self.mass.inverses[k])
            })
            .collect();
        backward(graph, &self.mass, &mut solution);
        let mut xi_dot = vec![graph.zero(); solution.len()];
        for (&i, value) in self.order.iter().zip(solution) {
            xi_dot[i] = value;
        }
        KktSolution {
            xi_dot,
            multipliers,
        }
    }

    /// Returns S⁻¹ r, or S⁺ r if S is singular.
    fn multipliers(&self, graph: &mut Graph, wanted: Vec<Edge>) -> Vec<Edge> {
        if self.raised.is_empty() {
            return self.divided(graph, wanted);
        }
        let mut left = wanted;
        for _ in 0..CLEARING_POWER {
            let step = self.divided(graph, left.clone());
            for ((left, &raised), step) in left.iter_mut().zip(&self.raised).zip(step) {
                let kept = graph.mul(raised, step);
                *left = graph.sub(*left, kept);
            }
        }
        let mut solution = vec![graph.zero(); left.len()];
        for factor in SERIES_COEFFICIENTS {
            let factor = graph.ratio(factor, 1);
            let step = self.divided(graph, left.clone());
            for (place, &step) in step.iter().enumerate() {
                let more = graph.mul(factor, step);
                solution[place] = graph.add(solution[place], more);
                left[place] = graph.mul(self.raised[place], step);
            }
        }
        solution
    }

    /// Solves with the factors L D Lᵀ of S, or of the matrix with the raised diagonal.
    fn divided(&self, graph: &mut Graph, mut right: Vec<Edge>) -> Vec<Edge> {
        forward(graph, &self.inner, &mut right);
        for (entry, &inverse) in right.iter_mut().zip(&self.inner.inverses) {
            *entry = graph.mul(*entry, inverse);
        }
        backward(graph, &self.inner, &mut right);
        right
    }
}

/// Returns λ of M ξ̇ = f + Bᵀ λ from a solution with w BᵀB added to M and w Bᵀ b added to f.
///
/// With the multipliers λ' of that solution, λ = λ' − w (B ξ̇ − b). The correction vanishes if the rows do not
/// contradict one another.
pub fn unaugmented_multipliers(
    graph: &mut Graph,
    weight: Edge,
    (rows, right): (&[Vec<Edge>], &[Edge]),
    solution: &KktSolution,
) -> Vec<Edge> {
    let rows = rows.iter().zip(right).zip(&solution.multipliers);
    rows.map(|((row, &right), &multiplier)| {
        let reached = graph.dot(row, &solution.xi_dot);
        let left = graph.sub(reached, right);
        let part = graph.mul(weight, left);
        graph.sub(multiplier, part)
    })
    .collect()
}

/// Step of x and projected ξ by which a state returns to the constraints that multipliers enforce, as expressions.
#[derive(Clone, Debug)]
pub struct Projections {
    /// Position step −M⁻¹ Bᵀ S⁻¹ φ(x), with the velocities of given rates held: the step along A that closes the
    /// loops to first order and satisfies the nonholonomic constraints.
    pub position: Vec<Edge>,
    /// Projected velocities ξ − M⁻¹ Bᵀ S⁻¹ B ξ: the nearest in kinetic energy that satisfy B ξ = 0.
    pub velocity: Vec<Edge>,
}

/// Returns the projections of a model onto the constraints that it keeps.
pub fn projections(graph: &mut Graph, model: &Model, factored: &KktFactors) -> Projections {
    let rest = vec![graph.zero(); model.n()];
    let held = vec![graph.zero(); model.accelerated.len()];
    let residuals = model.constraints.iter().map(|c| -c.residual);
    let residuals: Vec<Edge> = residuals.chain(held.iter().copied()).collect();
    let mut position = factored.solve(graph, &rest, &residuals).xi_dot;
    let speeds: Vec<Edge> = model
        .constraints
        .iter()
        .map(|c| -c.speed(graph, &model.xi))
        .chain(held)
        .collect();
    let mut change = factored.solve(graph, &rest, &speeds).xi_dot;
    // Velocities with given rates are held exactly, even if S is raised.
    for &(place, _) in &model.accelerated {
        (position[place], change[place]) = (graph.zero(), graph.zero());
    }
    let velocity = model
        .xi
        .iter()
        .zip(change)
        .map(|(&xi, change)| graph.add(xi, change))
        .collect();
    Projections { position, velocity }
}

/// Factors of a matrix L D Lᵀ.
#[derive(Clone, Debug)]
struct Factors {
    lower: Vec<Vec<Edge>>,
    pivots: Vec<Edge>,
    inverses: Vec<Edge>,
}

fn factor(graph: &mut Graph, a: &mut [Vec<Edge>]) -> Option<Factors> {
    let (n, zero) = (a.len(), graph.zero());
    let mut lower = vec![vec![zero; n]; n];
    let (mut pivots, mut inverses) = (Vec::new(), Vec::new());
    for c in 0..n {
        let pivot = a[c][c];
        let inverse = graph.div(graph.one(), pivot)?;
        for r in c + 1..n {
            lower[r][c] = graph.mul(a[r][c], inverse);
        }
        for r in c + 1..n {
            for s in c + 1..=r {
                if lower[r][c] != zero && a[s][c] != zero {
                    let product = graph.mul(lower[r][c], a[s][c]);
                    a[r][s] = graph.sub(a[r][s], product);
                    a[s][r] = a[r][s];
                }
            }
        }
        pivots.push(pivot);
        inverses.push(inverse);
    }
    Some(Factors {
        lower,
        pivots,
        inverses,
    })
}

/// Replaces v by L⁻¹ v.
fn forward(graph: &mut Graph, factors: &Factors, v: &mut [Edge]) {
    for c in 0..v.len() {
        for r in c + 1..v.len() {
            let product = graph.mul(factors.lower[r][c], v[c]);
            v[r] = graph.sub(v[r], product);
        }
    }
}

/// Replaces v by L⁻ᵀ v.
fn backward(graph: &mut Graph, factors: &Factors, v: &mut [Edge]) {
    for c in (0..v.len()).rev() {
        for r in c + 1..v.len() {
            let product = graph.mul(factors.lower[r][c], v[r]);
            v[c] = graph.sub(v[c], product);
        }
    }
}

/// Solution ξ̇, λ of the constrained equations of motion, in numbers modulo p.
pub struct KktValues {
    /// Accelerations ξ̇.
    pub xi_dot: Vec<ResiduePair>,
    /// Multipliers λ of the constraints, then of velocities whose rates are given.
    pub multipliers: Vec<ResiduePair>,
}

/// Solves for ξ̇ and λ in numbers modulo p by plain elimination; the emitted code must agree with the result.
///
/// The arguments are M, the forces, B by rows and the right-hand side of B ξ̇, then the velocities whose rates are
/// given. The lane supplies the factor of `Raised`, if the system is overconstrained. If M is raised by w BᵀB, then
/// `balance` tells whether to add w Bᵀ b to the forces: this is right for ξ̇, but not for steps back to the
/// constraints, which have no forces.
pub fn solve_at(
    model: &Model,
    [mass, force, rows, right]: [&[ResiduePair]; 4],
    given: &[(usize, ResiduePair)],
    balance: bool,
    lane: &FieldPoint,
) -> Option<KktValues> {
    let n = force.len();
    let (mut mass, mut force) = (mass.to_vec(), force.to_vec());
    let (mut rows, mut right) = (rows.to_vec(), right.to_vec());
    for &(place, rate) in given {
        rows.extend((0..n).map(|j| {
            if j == place {
                ResiduePair::ONE
            } else {
                ResiduePair::ZERO
            }
        }));
        right.push(rate);
    }
    let m = right.len();
    let raising = regularization_rows(&model.constraints, given.len());
    let mut weight = ResiduePair::ZERO;
    if model.augmented {
        let mut trace = (0..n).fold(ResiduePair::ZERO, |sum, i| sum + mass[i * n + i]);
        if trace.is_zero() {
            trace = ResiduePair::ONE;
        }
        let squares = rows.iter().fold(ResiduePair::ZERO, |sum, &b| sum + b * b);
        weight = trace * squares.inv()?;
        for (row, &right) in rows.chunks(n).zip(&right) {
            for (i, &b) in row.iter().enumerate() {
                if balance {
                    force[i] = force[i] + weight * b * right;
                }
                (0..n).for_each(|j| mass[i * n + j] = mass[i * n + j] + weight * b * row[j]);
            }
        }
    }
    let mut columns: Vec<Vec<ResiduePair>> = vec![force];
    columns.extend(rows.chunks(n.max(1)).map(<[ResiduePair]>::to_vec));
    let solved = solve_columns(&mass, n, &columns)?;
    let (free, bonds) = solved.split_first()?;
    let dot = |a: &[ResiduePair], b: &[ResiduePair]| {
        a.iter()
            .zip(b)
            .fold(ResiduePair::ZERO, |sum, (&x, &y)| sum + x * y)
    };
    let row = |i: usize| &rows[i * n..(i + 1) * n];
    let schur: Vec<ResiduePair> = (0..m)
        .flat_map(|i| bonds.iter().map(move |bond| dot(row(i), bond)))
        .collect();
    let factor = match model.overconstrained {
        true => lane
            .clone()
            .function(Function::Raised, ResiduePair::ONE, &Vec::new()),
        false => ResiduePair::ONE,
    };
    let wanted: Vec<ResiduePair> = (0..m).map(|i| right[i] - dot(row(i), free)).collect();
    let mut multipliers = multipliers_at(&schur, &raising, wanted, factor)?;
    let moved = (0..n).map(|k| {
        let column: Vec<ResiduePair> = bonds.iter().map(|bond| bond[k]).collect();
        free[k] + dot(&column, &multipliers)
    });
    let mut xi_dot: Vec<ResiduePair> = moved.collect();
    // As in `plain`.
    for (i, multiplier) in multipliers.iter_mut().enumerate() {
        *multiplier = *multiplier - weight * (dot(row(i), &xi_dot) - right[i]);
    }
    for &(place, rate) in given {
        xi_dot[place] = rate;
    }
    Some(KktValues {
        xi_dot,
        multipliers,
    })
}

/// Returns A⁻¹ b for several b; `None` if A is singular.
pub(super) fn solve_columns(
    a: &[ResiduePair],
    n: usize,
    columns: &[Vec<ResiduePair>],
) -> Option<Vec<Vec<ResiduePair>>> {
    let mut rows: Vec<Vec<ResiduePair>> = (0..n)
        .map(|i| {
            let right = columns.iter().map(|column| column[i]);
            a[i * n..(i + 1) * n].iter().copied().chain(right).collect()
        })
        .collect();
    for c in 0..n {
        let pivot = (c..n).find(|&r| !rows[r][c].is_zero())?;
        rows.swap(c, pivot);
        let inverse = rows[c][c].inv()?;
        let scaled: Vec<ResiduePair> = rows[c].iter().map(|&entry| entry * inverse).collect();
        for (r, row) in rows.iter_mut().enumerate() {
            let factor = row[c];
            if r != c {
                row.iter_mut()
                    .zip(&scaled)
                    .for_each(|(entry, &by)| *entry = *entry - factor * by);
            }
        }
        rows[c] = scaled;
    }
    Some(
        (0..columns.len())
            .map(|j| rows.iter().map(|row| row[n + j]).collect())
            .collect(),
    )
}
