//! A start that closes all loops and keeps all constraints on the velocities.
//!
//! What the description gives is kept; what it does not give is solved for, as close as possible to
//! the identity and to rest. Where everything is given it only has to hold, but for rounding.

use super::declare::Declared;
use super::kinematics::Kinematics;
use super::layout::{Block, blocks};
use super::pfaffian::{Kind, Pfaffian};
use super::start::Start;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::{evaluate, least_norm};
use crate::diagnostics::Diagnostic;

/// Steps of Newton's method.
const STEPS: usize = 60;
/// Largest residual of a solution.
const SOLVED: f64 = 1e-12;
/// Largest residual that counts as rounding of the numbers given, which are then polished.
const ROUNDING: f64 = 1e-6;

/// The equations φ(x) = 0 of loops and B(x) ξ = 0, with numbers for the parameters.
pub struct Closure<'a> {
    graph: &'a Graph,
    blocks: Vec<Block>,
    a: Vec<Edge>,
    n: usize,
    constraints: &'a [Pfaffian],
    defaults: &'a [f64],
}

impl<'a> Closure<'a> {
    /// The equations of a description.
    pub fn new(
        graph: &'a Graph,
        declared: &Declared,
        kinematics: &Kinematics,
        constraints: &'a [Pfaffian],
        defaults: &'a [f64],
    ) -> Self {
        Closure {
            graph,
            blocks: declared
                .coordinates
                .iter()
                .flat_map(|coordinate| blocks(coordinate.kind))
                .collect(),
            a: kinematics.a.concat(),
            n: declared.xi.len(),
            constraints,
            defaults,
        }
    }

    /// Solves for what was not given.
    pub fn close(&mut self, start: &mut Start) -> Result<(), Diagnostic> {
        if self.constraints.is_empty() || self.defaults.iter().any(|number| number.is_nan()) {
            return Ok(());
        }
        let loops: Vec<&Pfaffian> = self.loops();
        if !loops.is_empty() {
            self.close_loops(start)?;
        }
        self.settle_velocities(start)
    }

    fn loops(&self) -> Vec<&'a Pfaffian> {
        let is_loop = |c: &&Pfaffian| c.kind == Kind::Loop;
        self.constraints.iter().filter(is_loop).collect()
    }

    fn close_loops(&self, start: &mut Start) -> Result<(), Diagnostic> {
        let given: Vec<bool> = start.given_x.iter().map(Option::is_some).collect();
        let all = vec![false; given.len()];
        let before = self.residuals(&start.x);
        let close = worst(&before).is_none_or(|(_, size)| size <= ROUNDING);
        let attempts = [Some(given), close.then_some(all)];
        for fixed in attempts.into_iter().flatten() {
            if let Some(x) = self.newton(&start.x, &fixed) {
                start.x = x;
                return Ok(());
            }
        }
        let Some((which, size)) = worst(&before) else {
            return Ok(());
        };
        let error = Diagnostic::new(
            self.loops()[which].span,
            format!("no configuration near the start closes this loop: it is open by {size:.3e}"),
        );
        Err(error.help(
            "give a `start` closer to a closed loop; coordinates without a `start` are solved for, those with one are kept",
        ))
    }

    /// x with all loops closed, moved along A where not fixed; `None` where Newton's method fails.
    fn newton(&self, from: &[f64], fixed: &[bool]) -> Option<Vec<f64>> {
        let mut x = from.to_vec();
        let (loops, n) = (self.loops(), self.n);
        let rows: Vec<Edge> = loops.iter().flat_map(|l| l.row.iter().copied()).collect();
        let mut best = f64::INFINITY;
        for _ in 0..STEPS {
            let residuals = self.residuals(&x);
            let (_, size) = worst(&residuals)?;
            if !size.is_finite() {
                return None;
            }
            if size <= SOLVED && size >= best {
                return Some(x);
            }
            best = best.min(size);
            let numbers = self.numbers(&x);
            let b = evaluate(self.graph, &rows, &numbers);
            let a = evaluate(self.graph, &self.a, &numbers);
            // A velocity that moves a fixed coordinate stays zero.
            let free: Vec<usize> = (0..n)
                .filter(|i| (0..x.len()).all(|alpha| !fixed[alpha] || a[alpha * n + i] == 0.0))
                .collect();
            let jacobian: Vec<Vec<f64>> = b
                .chunks(n)
                .map(|row| free.iter().map(|&i| row[i]).collect())
                .collect();
            let target: Vec<f64> = residuals.iter().map(|r| -r).collect();
            let step = least_norm(&jacobian, &target)?;
            for (alpha, entry) in x.iter_mut().enumerate() {
                *entry += free
                    .iter()
                    .zip(&step)
                    .map(|(&i, h)| a[alpha * n + i] * h)
                    .sum::<f64>();
            }
            normalise(&self.blocks, &mut x);
        }
        let (_, size) = worst(&self.residuals(&x))?;
        (size <= SOLVED).then_some(x)
    }

    fn settle_velocities(&self, start: &mut Start) -> Result<(), Diagnostic> {
        let n = self.n;
        let rows: Vec<Edge> = self
            .constraints
            .iter()
            .flat_map(|c| c.row.iter().copied())
            .collect();
        let b = evaluate(self.graph, &rows, &self.numbers(&start.x));
        let speeds = |xi: &[f64]| -> Vec<f64> {
            b.chunks(n)
                .map(|row| row.iter().zip(xi).map(|(b, v)| b * v).sum())
                .collect()
        };
        let given: Vec<bool> = start.given_xi.iter().map(Option::is_some).collect();
        let close = worst(&speeds(&start.xi)).is_none_or(|(_, size)| size <= ROUNDING);
        for fixed in [Some(given), close.then(|| vec![false; n])]
            .into_iter()
            .flatten()
        {
            let mut xi = start.xi.clone();
            let free: Vec<usize> = (0..n).filter(|&i| !fixed[i]).collect();
            let jacobian: Vec<Vec<f64>> = b
                .chunks(n)
                .map(|row| free.iter().map(|&i| row[i]).collect())
                .collect();
            for _ in 0..3 {
                let target: Vec<f64> = speeds(&xi).iter().map(|r| -r).collect();
                let Some(step) = least_norm(&jacobian, &target) else {
                    break;
                };
                free.iter().zip(step).for_each(|(&i, h)| xi[i] += h);
            }
            let scale = xi.iter().fold(1.0f64, |m, v| m.max(v.abs()));
            if worst(&speeds(&xi)).is_none_or(|(_, size)| size <= SOLVED * scale) {
                start.xi = xi;
                return Ok(());
            }
        }
        let Some((which, size)) = worst(&speeds(&start.xi)) else {
            return Ok(());
        };
        let error = Diagnostic::new(
            self.constraints[which].span,
            format!("the start velocities violate this constraint by {size:.3e}"),
        );
        Err(error.help(
            "leave out the `start` of velocities that follow from the others: they are solved for",
        ))
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let edges: Vec<Edge> = self.loops().iter().map(|l| l.residual).collect();
        evaluate(self.graph, &edges, &self.numbers(x))
    }

    fn numbers(&self, x: &[f64]) -> Vec<f64> {
        let mut numbers = vec![std::f64::consts::PI];
        numbers.extend(self.defaults.iter().chain(x));
        numbers.resize(self.graph.symbols().len(), 0.0);
        numbers
    }
}

/// The largest entry by size, and where it is.
fn worst(values: &[f64]) -> Option<(usize, f64)> {
    let sizes = values.iter().map(|v| v.abs()).enumerate();
    sizes.fold(None, |worst, (index, size)| match worst {
        Some((_, most)) if size <= most => worst,
        _ => Some((index, size)),
    })
}

/// Puts x back on its blocks: unit norm, or Newton's polar iteration for a rotation.
fn normalise(blocks: &[Block], x: &mut [f64]) {
    let mut place = 0;
    for &block in blocks {
        let entries = &mut x[place..place + block.len()];
        match block {
            Block::Flat(_) => {}
            Block::Circle | Block::Quaternion => {
                let length = entries.iter().map(|e| e * e).sum::<f64>().sqrt();
                entries.iter_mut().for_each(|e| *e /= length);
            }
            Block::Rotation => {
                for _ in 0..8 {
                    polar_step(entries);
                }
            }
        }
        place += block.len();
    }
}

/// R ← R (3 I − RᵀR) / 2.
fn polar_step(r: &mut [f64]) {
    let old: Vec<f64> = r.to_vec();
    for i in 0..3 {
        for j in 0..3 {
            let mut value = 3.0 * old[3 * i + j];
            for k in 0..3 {
                let gram: f64 = (0..3).map(|l| old[3 * l + k] * old[3 * l + j]).sum();
                value -= old[3 * i + k] * gram;
            }
            r[3 * i + j] = value / 2.0;
        }
    }
}
