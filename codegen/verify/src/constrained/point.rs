//! One point at which a system with constraints is compared: numbers of the full frame, balance of power,
//! linearisation.

use super::frame::FullFrameQuantities;
use crate::kernel::{dot, places};
use crate::outputs::slopes_hold;
use crate::slopes::measured_at;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tangent::tangent_at;
use hamel_dynamics::reduction::Reduction;
use hamel_language::model::class;
use hamel_program::{FunctionId, Program};

/// A point with ξ = C ξₐ + c, as a point of the full model and of the reduced one.
pub(super) struct ConstrainedPoint<'a> {
    full: &'a FullFrameQuantities,
    program: &'a Program,
    /// C, by rows.
    pub(super) c: Vec<ResiduePair>,
    /// c.
    pub(super) shift: Vec<ResiduePair>,
    /// Values of the symbols of the full model.
    pub(super) point: FieldPoint,
    /// Values of the symbols of the reduced model.
    pub(super) inner: FieldPoint,
}

/// Numbers of the full frame at a point.
pub(super) struct FullFrameValues {
    pub(super) mass: Vec<ResiduePair>,
    pub(super) bias: Vec<ResiduePair>,
    pub(super) slope: Vec<ResiduePair>,
    pub(super) force: Vec<ResiduePair>,
    pub(super) drift: Vec<ResiduePair>,
    pub(super) in_energy: ResiduePair,
    pub(super) potential: ResiduePair,
    pub(super) dissipation: ResiduePair,
    pub(super) change: ResiduePair,
    pub(super) xi: Vec<ResiduePair>,
}

impl FullFrameValues {
    /// Returns ξ̇ = C ξ̇ₐ + Ċ ξₐ + ċ.
    pub(super) fn lift(&self, c: &[ResiduePair], xi_dot: &[ResiduePair]) -> Vec<ResiduePair> {
        let na = xi_dot.len();
        let rows = self.drift.iter().enumerate();
        rows.map(|(i, &drift)| dot(&c[i * na..][..na], xi_dot) + drift)
            .collect()
    }

    /// Returns M ξ̇ + h + ∂V, the force that a motion of the full frame needs.
    pub(super) fn required_force(&self, xi_dot: &[ResiduePair]) -> Vec<ResiduePair> {
        let rows = self
            .mass
            .chunks(xi_dot.len())
            .zip(&self.bias)
            .zip(&self.slope);
        rows.map(|((row, &bias), &slope)| dot(row, xi_dot) + bias + slope)
            .collect()
    }
}

impl<'a> ConstrainedPoint<'a> {
    /// Creates the point with the active velocities of a point of the full model.
    pub(super) fn new(
        full: &'a FullFrameQuantities,
        reduction: &Reduction,
        program: &'a Program,
        point: &FieldPoint,
    ) -> Option<Self> {
        let graph = &full.reference.model.graph;
        let mut c = evaluate_at(graph, &full.complement, &mut point.clone())?;
        let shift = c.split_off(full.reference.model.n() * reduction.active.len());
        let velocities = places(graph, class::VELOCITY);
        let active = reduction.active.iter();
        let active: Vec<ResiduePair> = active.map(|&i| point.symbol(velocities[i])).collect();
        let others = [class::ACCEL, class::MOMENTUM].map(|class| places(graph, class));
        let mut point = point.clone();
        let na = active.len();
        for (i, (&symbol, &shift)) in velocities.iter().zip(&shift).enumerate() {
            point.set_symbol(symbol, dot(&c[i * na..][..na], &active) + shift);
        }
        let mut inner = point.without_symbols();
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
            point.set_linear_form(point.symbol(*symbol), form);
        }
        Some(ConstrainedPoint {
            full,
            program,
            c,
            shift,
            point,
            inner,
        })
    }

    /// Returns ẋ = A ξ of the full frame.
    pub(super) fn rate(&self) -> Option<Vec<ResiduePair>> {
        let model = &self.full.reference.model;
        let a = evaluate_at(&model.graph, &model.a.concat(), &mut self.point.clone())?;
        let xi = evaluate_at(&model.graph, &model.xi, &mut self.point.clone())?;
        Some(a.chunks(xi.len()).map(|row| dot(row, &xi)).collect())
    }

    /// Returns the numbers of the full frame.
    pub(super) fn values(&self) -> Option<FullFrameValues> {
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
            self.full.in_energy,
            reference.potential,
            reference.dissipation,
            self.full.change,
        ]);
        let all = evaluate_at(graph, &roots, &mut self.point.clone())?;
        let (mass, rest) = all.split_at(n * n);
        let part = |i: usize| rest[i * n..(i + 1) * n].to_vec();
        let [in_energy, potential, dissipation, change] = rest[5 * n..] else {
            return None;
        };
        Some(FullFrameValues {
            mass: mass.to_vec(),
            bias: part(0),
            slope: part(1),
            force: part(2),
            drift: part(3),
            xi: part(4),
            in_energy,
            potential,
            dissipation,
            change,
        })
    }

    /// Returns whether d/dt (T + V) = f ξ, which holds where B ξ + b = 0.
    ///
    /// The power of drives is added to the right side. With time, so is the power that the row of ξ⁰ needs: −∂L/∂t, and
    /// that of prescribed motion.
    pub(super) fn power(&self) -> Option<bool> {
        let Some(xi_dot) = self
            .program
            .xi_dot()
            .filter(|_| self.full.power_is_known(self.program))
        else {
            return Some(true);
        };
        let values = self.values()?;
        let xi_dot = evaluate_at(&self.program.graph, xi_dot, &mut self.inner.clone())?;
        let xi_dot = values.lift(&self.c, &xi_dot);
        let n = xi_dot.len();
        let momentum: Vec<ResiduePair> = (0..n)
            .map(|i| dot(&values.mass[i * n..][..n], &values.xi))
            .collect();
        let full = &self.full.reference.model;
        let mut power = dot(&values.force, &values.xi);
        if full.clock.is_none() && full.accelerated.is_empty() {
            return Some(values.change + dot(&momentum, &xi_dot) == power);
        }
        let lambda = match self.program.function(FunctionId::ConstraintForce) {
            Some(force) => {
                evaluate_at(&self.program.graph, &force.outputs, &mut self.inner.clone())?
            }
            None => Vec::new(),
        };
        let lambda = self.full.of_all_rows(lambda);
        let rows = evaluate_at(&full.graph, &self.full.rows, &mut self.point.clone())?;
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

    /// Compares [A B] with dual numbers: δξ̇ = DF, and A ḣ = D(ẋ)[A h] − Ȧ h.
    pub(super) fn linear(&self) -> Option<bool> {
        let (Some(linear), Some(accel)) = (
            self.program.function(FunctionId::Linearize),
            self.program.function(FunctionId::Accel),
        ) else {
            return Some(true);
        };
        let reduced = &self.full.reduced;
        let full = &self.full.reference.model;
        if !measured_at(full, self.program, [&self.point, &self.inner])? {
            return Some(false);
        }
        let (all, na, nu) = (full.n(), reduced.n(), full.nu());
        // Time is not displaced.
        let time = full.clock.map(|clock| clock.xi);
        let displaced: Vec<usize> = (0..all).filter(|&i| Some(i) != time).collect();
        let n = displaced.len();
        let width = n + na + reduced.u.len();
        let n_z = reduced.state_rates.len();
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
        let first = full.points.first;
        let (x, mut others) = (first..first + nu, symbols(class::VELOCITY));
        // z follows u among the symbols, but precedes it in the columns of [A B].
        let mut given = symbols(class::INPUT);
        given.rotate_right(n_z);
        others.extend(given);
        let size = reduced.graph.symbols().len();
        // Rates of the columns of A along the motion.
        let mut moving = vec![ResiduePair::ZERO; full.graph.symbols().len()];
        moving[x.clone()].copy_from_slice(&rate);
        let swept = tangent_at(&full.graph, &a_edges, &mut self.point.clone(), &moving)?;
        let given = |alpha: usize| full.prescribed.iter().any(|(place, _)| *place == alpha);
        for column in 0..width {
            let mut direction = vec![ResiduePair::ZERO; size];
            if column < n {
                for (alpha, place) in x.clone().enumerate() {
                    direction[place] = a[alpha * all + displaced[column]];
                }
            } else {
                direction[others[column - n]] = ResiduePair::ONE;
            }
            let graph = &self.program.graph;
            let slopes = tangent_at(graph, &accel.outputs, &mut self.inner.clone(), &direction)?;
            let ahead = tangent_at(
                &reduced.graph,
                &reduced.rate,
                &mut self.inner.clone(),
                &direction,
            )?;
            let bent = (0..na + n_z).any(|row| entry(n + row, column) != slopes[row].1);
            let left = (0..nu).map(|alpha| {
                let sum = (0..n).fold(ResiduePair::ZERO, |sum, k| {
                    sum + a[alpha * all + displaced[k]] * entry(k, column)
                });
                let swept = match column < n {
                    true => swept[alpha * all + displaced[column]].1,
                    false => ResiduePair::ZERO,
                };
                sum + swept - ahead[alpha].1
            });
            let left: Vec<ResiduePair> = left.collect();
            // Prescribed coordinates are not read by the functions, so that their ẋ stays the same when they are
            // displaced; on a circle it is then no longer tangent. Their rows are only compared along the columns of A,
            // where ḣ determines them.
            let moved = (0..nu).all(|alpha| given(alpha) || left[alpha].is_zero())
                && displaced.iter().all(|&j| {
                    let along = (0..nu).filter(|&alpha| given(alpha));
                    let along = along.map(|alpha| a[alpha * all + j] * left[alpha]);
                    along
                        .fold(ResiduePair::ZERO, |sum, part| sum + part)
                        .is_zero()
                });
            let rates: Vec<ResiduePair> = slopes[..na].iter().map(|slope| slope.0).collect();
            let changes: Vec<ResiduePair> = slopes[..na].iter().map(|slope| slope.1).collect();
            let mut unit = vec![ResiduePair::ZERO; width];
            unit[column] = ResiduePair::ONE;
            let along = (&direction[..], &unit[..]);
            let observed = slopes_hold(
                reduced,
                self.program,
                (&rates, &changes),
                &self.inner,
                along,
            )?;
            if bent || !moved || !observed {
                return Some(false);
            }
        }
        Some(true)
    }
}
