//! Comparisons at one point of a system with constraints.

use super::Claim;
use super::frame::FullFrameQuantities;
use super::point::{ConstrainedPoint, FullFrameValues};
use crate::charts::ChartComparison;
use crate::kernel::{dot, virtual_velocity};
use crate::{centroidal, derivatives, frames, outputs, states};
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_dynamics::accel::kkt::{self, KktValues};
use hamel_dynamics::reduction::Reduction;
use hamel_program::{FunctionId, Program};

/// A point with the numbers that several comparisons need.
pub(super) struct PointComparison<'a> {
    full: &'a FullFrameQuantities,
    reduction: &'a Reduction,
    program: &'a Program,
    charts: &'a ChartComparison,
    at: ConstrainedPoint<'a>,
    values: FullFrameValues,
    /// B of the full frame, by rows.
    rows: Vec<ResiduePair>,
    /// Kept rows in terms of ξₐ, and the B ξ̇ₐ that they demand.
    kept: Vec<ResiduePair>,
    right: Vec<ResiduePair>,
    /// Active velocities whose rates are given, with these rates.
    driven: Vec<(usize, ResiduePair)>,
    /// Cᵀ M C.
    mass: Vec<ResiduePair>,
    /// Γ ξ ξ + M (Ċ ξₐ + ċ), in the full frame.
    bias: Vec<ResiduePair>,
    /// Emitted ξ̇ₐ, and the emitted rates of states.
    xi_dot: Option<Vec<ResiduePair>>,
    state_rates: Vec<ResiduePair>,
}

impl<'a> PointComparison<'a> {
    /// Evaluates the numbers at a point; `None` if something has no value there.
    pub(super) fn new(
        full: &'a FullFrameQuantities,
        reduction: &'a Reduction,
        (program, charts): (&'a Program, &'a ChartComparison),
        point: &FieldPoint,
    ) -> Option<Self> {
        let (n, na) = (full.reference.model.n(), reduction.active.len());
        let at = ConstrainedPoint::new(full, reduction, program, point)?;
        let values = at.values()?;
        let rows = evaluate_at(&full.reference.model.graph, &full.rows, &mut point.clone())?;
        let reduced = &full.reduced;
        let inner = |edges: &[Edge]| evaluate_at(&reduced.graph, edges, &mut at.inner.clone());
        let constraints = reduced.constraints.iter();
        let kept: Vec<Edge> = constraints.flat_map(|c| c.row.iter().copied()).collect();
        let (kept, right) = (inner(&kept)?, inner(&full.right)?);
        let given: Vec<Edge> = reduced.accelerated.iter().map(|(_, rate)| *rate).collect();
        let places = reduced.accelerated.iter().map(|(place, _)| *place);
        let driven = places.zip(inner(&given)?).collect();
        let column = |j: usize| -> Vec<ResiduePair> { (0..n).map(|i| at.c[i * na + j]).collect() };
        let columns: Vec<Vec<ResiduePair>> = (0..na).map(column).collect();
        let product = |v: &[ResiduePair]| -> Vec<ResiduePair> {
            let rows = values.mass.chunks(n.max(1));
            rows.map(|row| dot(row, v)).collect()
        };
        let mass = columns.iter().flat_map(|column| {
            let moved = product(column);
            columns.iter().map(move |other| dot(other, &moved))
        });
        let mass = mass.collect();
        let moved = product(&values.drift);
        let bias = values.bias.iter().zip(moved);
        let bias = bias.map(|(&bias, moved)| bias + moved).collect();
        let accel = match program.function(FunctionId::Accel) {
            None => None,
            Some(f) => Some(evaluate_at(
                &program.graph,
                &f.outputs,
                &mut at.inner.clone(),
            )?),
        };
        let mut xi_dot = accel;
        let state_rates = xi_dot.as_mut().map(|rates| rates.split_off(na));
        Some(PointComparison {
            full,
            reduction,
            program,
            charts,
            at,
            values,
            rows,
            kept,
            right,
            driven,
            mass,
            bias,
            xi_dot,
            state_rates: state_rates.unwrap_or_default(),
        })
    }

    /// Returns whether a claim holds here; `None` if something has no value.
    pub(super) fn holds(&self, claim: Claim) -> Option<bool> {
        let (full, program, inner) = (self.full, self.program, &self.at.inner);
        Some(match claim {
            Claim::Complement => self.solved_rows_vanish(),
            Claim::Rate => {
                let rate = self.at.rate()?;
                self.equal("rate", &rate)? && self.charts.hold(&rate, inner)?
            }
            Claim::Balance => self.balances()?,
            Claim::Constraint => self.is_kept()?,
            Claim::Mass => {
                let momentum: Vec<ResiduePair> = (self.values.mass.chunks(self.n().max(1)))
                    .map(|row| dot(row, &self.values.xi))
                    .collect();
                self.equal("mass_matrix", &self.mass)?
                    && self.equal("momentum", &self.project(&momentum))?
            }
            Claim::Bias => self.equal("bias", &self.project(&self.bias))?,
            Claim::Loads => self.loads()?,
            // Compared at points of its own.
            Claim::Power => true,
            Claim::Projection => self.leads_back()?,
            Claim::Linearisation => self.at.linear()?,
            Claim::Slopes => {
                derivatives::hold(&full.reference.model, program, [&self.at.point, inner])?
            }
            Claim::States => match &self.xi_dot {
                Some(xi_dot) => states::rates(&full.reduced, xi_dot, inner)? == self.state_rates,
                None => true,
            },
            Claim::Outputs => outputs::values_hold(&self.reduction.model, program, inner)?,
            Claim::Invariants => self.invariants()?,
            Claim::Frames => frames::hold(&full.reduced, program, inner)?,
            Claim::Momentum => centroidal::holds(&full.reduced, program, inner)?,
            Claim::FullFrame => full.frame != Some(false),
        })
    }

    fn n(&self) -> usize {
        self.full.reference.model.n()
    }

    /// Returns Cᵀ v.
    fn project(&self, v: &[ResiduePair]) -> Vec<ResiduePair> {
        let na = self.reduction.active.len();
        let entry = |j: usize| {
            let rows = v.iter().enumerate();
            rows.fold(ResiduePair::ZERO, |sum, (i, &v)| {
                sum + self.at.c[i * na + j] * v
            })
        };
        (0..na).map(entry).collect()
    }

    /// Returns the values of an emitted function; `Some(None)` if it is not emitted, `None` if it has no value.
    fn emitted_values(&self, name: &str) -> Option<Option<Vec<ResiduePair>>> {
        match self.program.function(name) {
            None => Some(None),
            Some(f) => {
                let values =
                    evaluate_at(&self.program.graph, &f.outputs, &mut self.at.inner.clone());
                values.map(Some)
            }
        }
    }

    fn equal(&self, name: &str, expected: &[ResiduePair]) -> Option<bool> {
        Some(
            self.emitted_values(name)?
                .is_none_or(|found| found == expected),
        )
    }

    /// Returns whether B C = 0 and B c = 0 for the solved rows.
    fn solved_rows_vanish(&self) -> bool {
        let n = self.n();
        self.reduction.solved.iter().all(|&(row, _)| {
            let row = &self.rows[row * n..][..n];
            let moves = (self
                .at
                .c
                .chunks(self.reduction.active.len().max(1))
                .zip(row))
            .fold(
                vec![ResiduePair::ZERO; self.reduction.active.len()],
                |sum, (c, &b)| sum.iter().zip(c).map(|(&sum, &c)| sum + b * c).collect(),
            );
            moves.iter().all(|entry| entry.is_zero()) && dot(row, &self.at.shift).is_zero()
        })
    }

    /// Solves Cᵀ M C ξ̇ₐ = force + Bᵀ λ, B ξ̇ₐ = right for ξ̇ₐ and λ by elimination in numbers; for steps `force` is
    /// `None`.
    fn solution(
        &self,
        force: Option<&[ResiduePair]>,
        right: &[ResiduePair],
        driven: &[(usize, ResiduePair)],
    ) -> Option<KktValues> {
        let none = vec![ResiduePair::ZERO; self.reduction.active.len()];
        let parts = [&self.mass[..], force.unwrap_or(&none), &self.kept, right];
        kkt::solve_at(
            &self.full.reduced,
            parts,
            driven,
            force.is_some(),
            &self.at.inner,
        )
    }

    /// Returns the ξ̇ₐ and λ that the forces imply.
    fn solve_implied(&self) -> Option<KktValues> {
        let FullFrameValues { force, slope, .. } = &self.values;
        let rest = (0..self.n()).map(|k| force[k] - slope[k] - self.bias[k]);
        let rest: Vec<ResiduePair> = rest.collect();
        self.solution(Some(&self.project(&rest)), &self.right, &self.driven)
    }

    /// Returns M ξ̇ + h + ∂V of the full frame for rates of the active velocities.
    fn required_force(&self, xi_dot: &[ResiduePair]) -> Vec<ResiduePair> {
        self.values
            .required_force(&self.values.lift(&self.at.c, xi_dot))
    }

    /// Compares every row of the full frame with the emitted multipliers, and the power along virtual velocities
    /// without them.
    ///
    /// If ξ̇ is not emitted, multipliers are compared with the ξ̇ that the forces imply.
    fn balances(&self) -> Option<bool> {
        let force = &self.values.force;
        let lambda = self.emitted_values("constraint_force")?;
        let lambda = lambda.map(|lambda| self.full.of_all_rows(lambda));
        let xi_dot = match (&self.xi_dot, &lambda) {
            (None, Some(_)) => Some(self.solve_implied()?.xi_dot),
            (emitted, _) => emitted.clone(),
        };
        if let (Some(xi_dot), Some(lambda)) = (&xi_dot, &lambda)
            && !(self.bonds_balance(xi_dot, lambda)? && self.dependent_multipliers_hold(lambda)?)
        {
            return Some(false);
        }
        // A virtual velocity v has B v = 0 and moves no drive: neither multipliers nor drives do work along v.
        if let Some(xi_dot) = &xi_dot {
            let needed = self.required_force(xi_dot);
            let left = needed.iter().zip(force).map(|(&needed, &f)| needed - f);
            let left = self.project(&left.collect::<Vec<_>>());
            let v = virtual_velocity(&self.full.reduced, &self.kept, &self.values.xi)?;
            if !dot(&v, &left).is_zero() {
                return Some(false);
            }
        }
        // Inverse dynamics holds for any ξ̇.
        let reduced = &self.full.reduced;
        let rates = evaluate_at(&reduced.graph, &reduced.xi_dot, &mut self.at.inner.clone())?;
        self.equal(
            "inverse_dynamics",
            &self.project(&self.required_force(&rates)),
        )
    }

    /// Returns whether the rows of the full frame balance with the multipliers of all constraints and the forces of
    /// drives; `None` if some have no value.
    fn bonds_balance(&self, xi_dot: &[ResiduePair], lambda: &[ResiduePair]) -> Option<bool> {
        let model = &self.full.reference.model;
        let (n, force) = (self.n(), &self.values.force);
        let needed = self.required_force(xi_dot);
        let time = model.clock.map(|clock| clock.xi);
        // The row of ξ⁰ is not an equation of motion.
        let compared = (0..n).filter(|&i| Some(i) != time && !self.contradicts(i));
        let mut balanced = compared.map(|i| {
            let bonds = lambda.iter().zip(self.rows.chunks(n));
            let bond = bonds.fold(ResiduePair::ZERO, |sum, (&lambda, row)| {
                sum + row[i] * lambda
            });
            // The multipliers of constraint rows are followed by the forces of drives whose rates are given.
            let drives = model.accelerated.iter();
            let drives = drives.zip(lambda.get(self.rows.len() / n..)?);
            let drive = drives.filter(|((velocity, _), _)| *velocity == i);
            let drive = drive.fold(ResiduePair::ZERO, |sum, (_, &force)| sum + force);
            Some(needed[i] == force[i] + bond + drive)
        });
        balanced.try_fold(true, |all, row| Some(all & row?))
    }

    /// Returns whether rates are given and constraint rows depend on one another. Where loops are not closed, such rows
    /// contradict one another and the given rates, which hold exactly.
    fn has_dependent_rows(&self) -> bool {
        let reduced = &self.full.reduced;
        reduced.overconstrained && !reduced.accelerated.is_empty()
    }

    /// Returns whether the row of a velocity balances only where the loops are closed: that of an active velocity whose
    /// rate is not given, if [`Self::has_dependent_rows`].
    fn contradicts(&self, velocity: usize) -> bool {
        let model = &self.full.reference.model;
        let driven = model
            .accelerated
            .iter()
            .any(|&(place, _)| place == velocity);
        self.has_dependent_rows() && !driven && self.reduction.active.contains(&velocity)
    }

    /// Returns whether the multipliers of kept rows are those of the elimination in numbers, if [`Self::has_dependent_rows`], so
    /// that some rows of the balance are not compared. The compared rows determine all other multipliers.
    fn dependent_multipliers_hold(&self, lambda: &[ResiduePair]) -> Option<bool> {
        if !self.has_dependent_rows() {
            return Some(true);
        }
        let implied = self.solve_implied()?.multipliers;
        let mut kept = self.reduction.kept.iter().zip(&implied);
        Some(kept.all(|(&row, implied)| lambda.get(row) == Some(implied)))
    }

    /// Returns whether the emitted ξ̇ satisfies the constraints.
    fn is_kept(&self) -> Option<bool> {
        let Some(xi_dot) = &self.xi_dot else {
            return Some(true);
        };
        if self.full.reduced.overconstrained {
            return Some(self.solve_implied()?.xi_dot == *xi_dot);
        }
        let mut driven = self.driven.iter();
        let mut rows = (self.right.iter()).zip(self.kept.chunks(xi_dot.len().max(1)));
        Some(
            driven.all(|&(place, rate)| xi_dot[place] == rate)
                && rows.all(|(&right, row)| dot(row, xi_dot) == right),
        )
    }

    fn loads(&self) -> Option<bool> {
        let values = &self.values;
        let all = [
            ("generalized_force", self.project(&values.force)),
            ("potential_force", self.project(&values.slope)),
            ("kinetic_energy", vec![values.in_energy]),
            ("potential_energy", vec![values.potential]),
            ("energy", vec![values.in_energy + values.potential]),
            ("dissipation", vec![values.dissipation]),
        ];
        for (name, expected) in all {
            if !self.equal(name, &expected)? {
                return Some(false);
            }
        }
        Some(true)
    }

    /// Compares φ of the loops, and the steps back to φ = 0 and to B ξ + b = 0.
    ///
    /// A step is the δ with B δ = −φ, or B δ = −(B ξ + b), that has the form M⁻¹ Bᵀ μ and moves no drive.
    fn leads_back(&self) -> Option<bool> {
        let (reduced, na) = (&self.full.reduced, self.reduction.active.len());
        let inner = |edges: &[Edge]| evaluate_at(&reduced.graph, edges, &mut self.at.inner.clone());
        let constraints = &reduced.constraints;
        let residuals: Vec<Edge> = constraints.iter().map(|c| c.residual).collect();
        let residuals = inner(&residuals)?;
        let shifts: Vec<Edge> = constraints.iter().map(|c| c.shift).collect();
        let xi = inner(&reduced.xi)?;
        let held: Vec<(usize, ResiduePair)> = self
            .driven
            .iter()
            .map(|&(i, _)| (i, ResiduePair::ZERO))
            .collect();
        let back = |left: &[ResiduePair]| {
            let right: Vec<ResiduePair> = left.iter().map(|&left| -left).collect();
            let solution = self.solution(None, &right, &held)?;
            Some(solution.xi_dot)
        };
        if let Some(found) = self.emitted_values("project_position")?
            && found[..na] != back(&residuals)?
        {
            return Some(false);
        }
        if let Some(found) = self.emitted_values("project_velocity")? {
            let rows = self.kept.chunks(na.max(1)).zip(inner(&shifts)?);
            let speeds: Vec<ResiduePair> = rows.map(|(row, shift)| dot(row, &xi) + shift).collect();
            let step = back(&speeds)?;
            let mut moved = xi.iter().zip(&step).map(|(&xi, &step)| xi + step);
            let states = inner(reduced.z())?;
            if !found[..na].iter().all(|&found| moved.next() == Some(found))
                || found[na..] != states
            {
                return Some(false);
            }
        }
        // Before the loops come the rows of φ of coordinates, which vanish on X; they are proved off X by `correction`.
        let zero = reduced.graph.zero();
        let loops = constraints.iter().zip(residuals);
        let loops = loops.filter(|(constraint, _)| constraint.residual != zero);
        let loops: Vec<ResiduePair> = loops.map(|(_, residual)| residual).collect();
        let emitted = self.emitted_values("constraint")?;
        Some(emitted.is_none_or(|found| found.ends_with(&loops)))
    }

    fn invariants(&self) -> Option<bool> {
        for (name, entries) in &self.full.claims {
            if let Some(found) = self.emitted_values(name)? {
                let graph = &self.full.reference.model.graph;
                if found != evaluate_at(graph, entries, &mut self.at.point.clone())? {
                    return Some(false);
                }
            }
        }
        Some(true)
    }
}
