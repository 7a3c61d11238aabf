//! One point at which a system with constraints is compared: numbers of the full frame, its power, its
//! slopes.

use super::{Full, dot};
use crate::algebra::fp::Fp;
use crate::algebra::graph::Edge;
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::tangent::tangent_at;
use crate::derive::reduction::Reduction;
use crate::model::class;
use crate::program::{FunctionId, Program};
use crate::proof::kernel::places;

/// A point with ξ = C ξₐ, and the same for the reduced model.
pub(super) struct At<'a> {
    full: &'a Full,
    program: &'a Program,
    /// C, by rows.
    pub(super) c: Vec<Fp>,
    /// The point of the full model.
    point: Lane,
    /// That of the reduced one.
    pub(super) inner: Lane,
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

impl<'a> At<'a> {
    /// The point with the active velocities of a lane.
    pub(super) fn new(
        full: &'a Full,
        reduction: &Reduction,
        program: &'a Program,
        lane: &Lane,
    ) -> Option<Self> {
        let graph = &full.reference.model.graph;
        let c = evaluate_at(graph, &full.complement, &mut lane.clone())?;
        let velocities = places(graph, class::VELOCITY);
        let active = reduction.active.iter();
        let active: Vec<Fp> = active.map(|&i| lane.symbol(velocities[i])).collect();
        let others = [class::ACCEL, class::MOMENTUM].map(|class| places(graph, class));
        let mut point = lane.clone();
        for (&symbol, row) in velocities.iter().zip(c.chunks(active.len())) {
            point.set_symbol(symbol, dot(row, &active));
        }
        let mut inner = point.fresh();
        for index in 0..graph.symbols().len() {
            let solved = others.iter().chain([&velocities]).any(|list| {
                let found = list.iter().position(|&symbol| symbol == index);
                found.is_some_and(|i| !reduction.active.contains(&i))
            });
            if !solved {
                inner.push_symbol(point.symbol(index));
            }
        }
        for ((symbol, _), form) in full.solved.iter().zip(&full.forms) {
            let atoms: Vec<Edge> = form.iter().map(|(atom, _)| *atom).collect();
            let atoms = evaluate_at(&full.reduced.graph, &atoms, &mut inner.clone())?;
            let coefficients = form.iter().map(|(_, c)| c.clone());
            let form = atoms.into_iter().zip(coefficients).collect();
            point.write_out(point.symbol(*symbol), form);
        }
        Some(At {
            full,
            program,
            c,
            point,
            inner,
        })
    }

    /// What the full model has there.
    pub(super) fn values(&self) -> Option<Values> {
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
        let all = evaluate_at(graph, &roots, &mut self.point.clone())?;
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

    /// Whether d/dt (T + V) = f ξ, which holds where B ξ = 0.
    pub(super) fn power(&self) -> Option<bool> {
        let Some(accel) = self.program.function(FunctionId::Accel) else {
            return Some(true);
        };
        let values = self.values()?;
        let outputs = &accel.outputs;
        let xi_dot = evaluate_at(&self.program.graph, outputs, &mut self.inner.clone())?;
        let xi_dot = values.lift(&self.c, &xi_dot);
        let n = xi_dot.len();
        let momentum: Vec<Fp> = (0..n)
            .map(|i| dot(&values.mass[i * n..][..n], &values.xi))
            .collect();
        Some(values.change + dot(&momentum, &xi_dot) == dot(&values.force, &values.xi))
    }

    /// [A B] against dual numbers: δξ̇ = DF, and A ḣ = D(ẋ)[A h] − Ȧ h.
    pub(super) fn nearby(&self) -> Option<bool> {
        let (Some(linear), Some(accel)) = (
            self.program.function(FunctionId::Linearize),
            self.program.function(FunctionId::Accel),
        ) else {
            return Some(true);
        };
        let reduced = &self.full.reduced;
        let full = &self.full.reference.model;
        let (n, na, nu) = (full.n(), reduced.n(), full.nu());
        let width = n + na + reduced.u.len();
        let table = evaluate_at(
            &self.program.graph,
            &linear.outputs,
            &mut self.inner.clone(),
        )?;
        let entry = |row: usize, column: usize| table[row * width + column];
        let a_edges = full.a.concat();
        let a = evaluate_at(&full.graph, &a_edges, &mut self.point.clone())?;
        let rate = evaluate_at(&reduced.graph, &reduced.rate, &mut self.inner.clone())?;
        let symbols = |class| places(&reduced.graph, class);
        let (x, mut others) = (symbols(class::COORD), symbols(class::VELOCITY));
        others.extend(symbols(class::INPUT));
        let size = reduced.graph.symbols().len();
        // How the columns of A change along the motion.
        let mut moving = vec![Fp::ZERO; full.graph.symbols().len()];
        for (&place, &slope) in places(&full.graph, class::COORD).iter().zip(&rate) {
            moving[place] = slope;
        }
        let swept = tangent_at(&full.graph, &a_edges, &mut self.point.clone(), &moving)?;
        for column in 0..width {
            let mut direction = vec![Fp::ZERO; size];
            if column < n {
                for (alpha, &place) in x.iter().enumerate() {
                    direction[place] = a[alpha * n + column];
                }
            } else {
                direction[others[column - n]] = Fp::ONE;
            }
            let graph = &self.program.graph;
            let slopes = tangent_at(graph, &accel.outputs, &mut self.inner.clone(), &direction)?;
            let ahead = tangent_at(
                &reduced.graph,
                &reduced.rate,
                &mut self.inner.clone(),
                &direction,
            )?;
            let bent = (0..na).any(|row| entry(n + row, column) != slopes[row].1);
            let moved = (0..nu).all(|alpha| {
                let sum = (0..n).fold(Fp::ZERO, |sum, k| sum + a[alpha * n + k] * entry(k, column));
                let swept = match column < n {
                    true => swept[alpha * n + column].1,
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
