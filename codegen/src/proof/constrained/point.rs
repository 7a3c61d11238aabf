//! One point of a system with constraints: numbers of the full frame, power, and slopes of the linearisation.

use super::Full;
use crate::algebra::fp::Fp;
use crate::algebra::graph::Edge;
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::tangent::tangent_at;
use crate::derive::reduction::Reduction;
use crate::model::class;
use crate::program::{FunctionId, Program};
use crate::proof::kernel::{in_kernel, places};

/// A point with everything that is needed to move ξ on it.
pub(super) struct At<'a> {
    pub(super) full: &'a Full,
    pub(super) reduction: &'a Reduction,
    pub(super) program: &'a Program,
    pub(super) lane: &'a Lane,
    pub(super) c: &'a [Fp],
    pub(super) shift: &'a [Fp],
}

/// Numbers of the full frame.
pub(super) struct Values {
    pub(super) mass: Vec<Fp>,
    pub(super) bias: Vec<Fp>,
    pub(super) slope: Vec<Fp>,
    pub(super) force: Vec<Fp>,
    pub(super) drift: Vec<Fp>,
    pub(super) kinetic: Fp,
    pub(super) potential: Fp,
    pub(super) dissipation: Fp,
    pub(super) change: Fp,
    pub(super) xi: Vec<Fp>,
}

impl Values {
    /// ξ̇ = C ξ̇ₐ + Ċ ξₐ.
    pub(super) fn lift(&self, c: &[Fp], xi_dot: &[Fp]) -> Vec<Fp> {
        let rows = c.chunks(xi_dot.len()).zip(&self.drift);
        rows.map(|(row, &drift)| dot(row, xi_dot) + drift).collect()
    }
}

impl At<'_> {
    /// The point with ξ = C ξₐ, and the same for the reduced model.
    pub(super) fn lanes(&self, xi_active: &[Fp]) -> (Lane, Lane) {
        let graph = &self.full.reference.model.graph;
        let velocities = places(graph, class::VELOCITY);
        let others = [class::ACCEL, class::MOMENTUM].map(|class| places(graph, class));
        let mut point = self.lane.clone();
        let rows = self.c.chunks(xi_active.len()).zip(self.shift);
        for (&symbol, (row, &shift)) in velocities.iter().zip(rows) {
            point.set_symbol(symbol, dot(row, xi_active) + shift);
        }
        let mut inner = point.fresh();
        for index in 0..graph.symbols().len() {
            let solved = others.iter().chain([&velocities]).any(|list| {
                let found = list.iter().position(|&symbol| symbol == index);
                found.is_some_and(|i| !self.reduction.active.contains(&i))
            });
            if !solved {
                inner.push_symbol(point.symbol(index));
            }
        }
        (point, inner)
    }

    pub(super) fn values(&self, point: &Lane) -> Option<Values> {
        let reference = &self.full.reference;
        let (graph, n) = (&reference.model.graph, reference.model.n());
        let mut roots: Vec<Edge> = reference.mass.concat();
        for part in [
            &reference.bias,
            &reference.slope,
            &reference.force,
            &self.full.drift,
            &reference.model.xi,
        ] {
            roots.extend(part);
        }
        roots.extend([
            reference.kinetic,
            reference.potential,
            reference.dissipation,
            self.full.change,
        ]);
        let all = evaluate_at(graph, &roots, &mut point.clone())?;
        let (mass, rest) = all.split_at(n * n);
        let part = |i: usize| rest[i * n..(i + 1) * n].to_vec();
        let [kinetic, potential, dissipation, change] = rest[5 * n..] else {
            return None;
        };
        Some(Values {
            mass: mass.to_vec(),
            bias: part(0),
            slope: part(1),
            force: part(2),
            drift: part(3),
            xi: part(4),
            kinetic,
            potential,
            dissipation,
            change,
        })
    }

    /// d/dt (T + V) = f ξ at a ξₐ that satisfies the rows that are kept. With time, the row of ξ⁰ takes part by the
    /// power that it would need: −∂L/∂t, and that of the drives.
    pub(super) fn power(&self, kept: (&[Fp], &[Fp]), random: &[Fp], seed: u64) -> Option<bool> {
        let Some(accel) = self.program.function(FunctionId::Accel) else {
            return Some(true);
        };
        let xi_active = in_kernel(kept.0, kept.1, random, seed)?;
        let (point, inner) = self.lanes(&xi_active);
        let values = self.values(&point)?;
        let xi_dot = evaluate_at(&self.program.graph, &accel.outputs, &mut inner.clone())?;
        let xi_dot = values.lift(self.c, &xi_dot);
        let n = xi_dot.len();
        let momentum: Vec<Fp> = (0..n)
            .map(|i| dot(&values.mass[i * n..][..n], &values.xi))
            .collect();
        let full = &self.full.reference.model;
        let mut power = dot(&values.force, &values.xi);
        if full.clock.is_none() && full.accelerated.is_empty() {
            return Some(values.change + dot(&momentum, &xi_dot) == power);
        }
        let lambda = match self.program.function(FunctionId::ConstraintForce) {
            Some(force) => evaluate_at(&self.program.graph, &force.outputs, &mut inner.clone())?,
            None if self.full.rows.is_empty() && full.accelerated.is_empty() => Vec::new(),
            // Without the forces of the drives nothing is known of their power.
            None => return Some(true),
        };
        let rows = evaluate_at(&full.graph, &self.full.rows, &mut point.clone())?;
        let drives = lambda.get(rows.len() / n..).unwrap_or(&[]);
        for ((velocity, _), &force) in full.accelerated.iter().zip(drives) {
            power = power + force * values.xi[*velocity];
        }
        if let Some(clock) = full.clock {
            let i = clock.xi;
            let inertial = dot(&values.mass[i * n..][..n], &xi_dot);
            let row = inertial + values.bias[i] + values.slope[i] - values.force[i];
            let bonds = lambda.iter().zip(rows.chunks(n));
            power = bonds.fold(power + row, |sum, (&lambda, row)| sum - row[i] * lambda);
        }
        Some(values.change + dot(&momentum, &xi_dot) == power)
    }

    /// [A B] against dual numbers: δξ̇ = DF, and A ḣ = D(ẋ)[A h] − Ȧ h.
    pub(super) fn nearby(&self, point: &Lane, inner: &Lane) -> Option<bool> {
        let (Some(linear), Some(accel)) = (
            self.program.function(FunctionId::Linearize),
            self.program.function(FunctionId::Accel),
        ) else {
            return Some(true);
        };
        let reduced = &self.full.reduced;
        let full = &self.full.reference.model;
        let (all, na, nu) = (full.n(), reduced.n(), full.nu());
        let n = all - usize::from(full.clock.is_some());
        let width = n + na + reduced.u.len();
        let table = evaluate_at(&self.program.graph, &linear.outputs, &mut inner.clone())?;
        let entry = |row: usize, column: usize| table[row * width + column];
        // The time is not displaced.
        let time = full.clock.map(|clock| clock.xi);
        let places_of: Vec<usize> = (0..full.n()).filter(|&i| Some(i) != time).collect();
        let a_edges = full.a.concat();
        let a = evaluate_at(&full.graph, &a_edges, &mut point.clone())?;
        let rate = evaluate_at(&reduced.graph, &reduced.rate, &mut inner.clone())?;
        let symbols = |class| places(&reduced.graph, class);
        let first = full.points.first;
        let (x, mut others) = (first..first + nu, symbols(class::VELOCITY));
        others.extend(symbols(class::INPUT));
        let size = reduced.graph.symbols().len();
        // How the columns of A change along the motion.
        let mut moving = vec![Fp::ZERO; full.graph.symbols().len()];
        moving[x.clone()].copy_from_slice(&rate);
        let swept = tangent_at(&full.graph, &a_edges, &mut point.clone(), &moving)?;
        for column in 0..width {
            let mut direction = vec![Fp::ZERO; size];
            if column < n {
                for (alpha, place) in x.clone().enumerate() {
                    direction[place] = a[alpha * all + places_of[column]];
                }
            } else {
                direction[others[column - n]] = Fp::ONE;
            }
            let graph = &self.program.graph;
            let slopes = tangent_at(graph, &accel.outputs, &mut inner.clone(), &direction)?;
            let ahead = tangent_at(
                &reduced.graph,
                &reduced.rate,
                &mut inner.clone(),
                &direction,
            )?;
            let bent = (0..na).any(|row| entry(n + row, column) != slopes[row].1);
            let moved = (0..nu).all(|alpha| {
                let sum = (0..n).fold(Fp::ZERO, |sum, k| {
                    sum + a[alpha * all + places_of[k]] * entry(k, column)
                });
                let swept = match column < n {
                    true => swept[alpha * all + places_of[column]].1,
                    false => Fp::ZERO,
                };
                sum == ahead[alpha].1 - swept
            });
            if bent || !moved {
                return Some(false);
            }
        }
        Some(true)
    }
}

pub(super) fn dot(a: &[Fp], b: &[Fp]) -> Fp {
    a.iter().zip(b).fold(Fp::ZERO, |sum, (&x, &y)| sum + x * y)
}
