//! Reference of every build: the left sides of the three forms (30a), (30b), (30c) at points of X, in numbers modulo p.
//!
//! | file | owns |
//! |---|---|
//! | `space` | vectors of numbers |
//! | `motion` | poses with first and second derivatives |
//! | `inertia` | contributions of bodies and particles |
//! | `loads` | forces on points |
//! | `expressions` | the expressions of a model that are evaluated |
//!
//! Nothing is derived as an expression here: the absolute poses of bodies, V, and a kinetic energy that the user wrote
//! are differentiated by hyper-dual numbers, so that the cost is that of the poses times n, and no rule of the
//! generator is used. The forms are
//!
//! - (30a) d/dt ∂T/∂ξⁱ − ∂ᵢT + γᵢⱼᵏ ξʲ ∂T/∂ξᵏ + ∂ᵢV, with γ by (12),
//! - (30b) Σ m ⟨r̈, ∂ᵢr⟩ + ⟨Θα + ω × Θω, ωᵢ⟩ − Σ m ⟨g, ∂ᵢr⟩ + ∂ᵢV of all other potentials,
//! - (30c) M_ij ξ̇ʲ + Ṁ_ij ξʲ − ½ ∂ᵢM_jk ξʲ ξᵏ + γᵢⱼˢ ξʲ M_sk ξᵏ + ∂ᵢV, with γ by (13): Γ of (23) contracted.
//!
//! For a kinetic energy that the user wrote, (30b) is taken from its M, as it belongs to no particles.

mod expressions;
mod inertia;
mod loads;
mod motion;
mod space;

use crate::kernel::dot;
use crate::violation::Violation;
use expressions::{FormTapes, TapeValueReader};
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::jets::{Jet, Seeds};
use hamel_algebra::residue_pair::ResiduePair;
use hamel_language::model::Model;
use hamel_language::model::elements::Along;
use inertia::{BodyInertia, FormSums};
use loads::GeneralizedForces;
use motion::{MotionJet, MovingFrame, point};
use rustc_hash::FxHashMap;
use space::{Vec3, scale, sub};

/// Evaluator of the left sides of (30a), (30b) and (30c) of a model at points of X, in numbers modulo p, without the
/// rules of the generator.
pub struct FormEvaluator {
    expressions: FormTapes,
}

/// Left sides of (30a), (30b), (30c) at one point (x, ξ, ξ̇, u), and the quantities in them, as numbers modulo p.
pub struct PointValues {
    /// Left sides of (30a), (30b), (30c).
    pub left: [Vec<ResiduePair>; 3],
    /// Mass matrix M.
    pub mass: Vec<Vec<ResiduePair>>,
    /// Bias forces h = Γ ξ ξ.
    pub bias: Vec<ResiduePair>,
    /// Derivatives ∂ᵢV of the potential energy.
    pub slope: Vec<ResiduePair>,
    /// Generalised forces f.
    pub force: Vec<ResiduePair>,
    /// Generalised momenta p = ∂T/∂ξ.
    pub momentum: Vec<ResiduePair>,
    /// Ṁ ξ.
    pub mass_rate: Vec<ResiduePair>,
    /// Rates of the coordinates, ẋ.
    pub rate: Vec<ResiduePair>,
    /// Kinetic energy T.
    pub kinetic: ResiduePair,
    /// Potential energy V.
    pub potential: ResiduePair,
    /// Dissipation D.
    pub dissipation: ResiduePair,
}

/// A, Y and ẋ with their derivatives at one point.
struct Kinematics {
    n: usize,
    nu: usize,
    a: Vec<Jet>,
    rate: Vec<Jet>,
    y: Vec<Jet>,
}

impl Kinematics {
    fn column(&self, i: usize, of: impl Fn(&Jet) -> ResiduePair) -> Vec<ResiduePair> {
        self.a
            .iter()
            .skip(i)
            .step_by(self.n.max(1))
            .map(of)
            .collect()
    }

    /// Returns ∂ᵢẋ at constant ξ.
    fn drift(&self, i: usize) -> Vec<ResiduePair> {
        self.rate.iter().map(|jet| jet.across(i)).collect()
    }

    fn rows(&self) -> std::slice::Chunks<'_, Jet> {
        self.y.chunks(self.nu.max(1))
    }

    /// Returns whether Y A = I.
    fn inverse(&self) -> bool {
        self.rows().enumerate().all(|(k, row)| {
            let mut product = vec![ResiduePair::ZERO; self.n];
            for (y, of_a) in row.iter().zip(self.a.chunks(self.n.max(1))) {
                if y.value.is_zero() {
                    continue;
                }
                for (sum, a) in product.iter_mut().zip(of_a) {
                    *sum = *sum + y.value * a.value;
                }
            }
            let mut entries = product.into_iter().enumerate();
            entries.all(|(i, entry)| {
                entry
                    == if i == k {
                        ResiduePair::ONE
                    } else {
                        ResiduePair::ZERO
                    }
            })
        })
    }

    /// Returns γᵢⱼᵏ ξʲ p_k by (12), (∂ᵢẋ − Ȧᵢ) Y p.
    fn turn(&self, p: &[ResiduePair]) -> Vec<ResiduePair> {
        let weighted = self.transposed_product(p, |jet| jet.value);
        let turn = |i: usize| {
            let moved = self.column(i, |jet| jet.along);
            dot(&weighted, &self.drift(i)) - dot(&weighted, &moved)
        };
        (0..self.n).map(turn).collect()
    }

    /// Returns γᵢⱼᵏ ξʲ p_k by (13), (Ẏ Aᵢ − ∂ᵢY ẋ) p.
    fn turn_of_rows(&self, p: &[ResiduePair]) -> Vec<ResiduePair> {
        let rate: Vec<ResiduePair> = self.rate.iter().map(|jet| jet.value).collect();
        let moved = self.transposed_product(p, |jet| jet.along);
        // Entries Y_α^k that are not constant, weighted by p_k ẋ^α; in large frames there are few of them.
        let mut moving: Vec<(&Jet, ResiduePair)> = Vec::new();
        for (row, &p) in self.rows().zip(p) {
            let entries = row.iter().zip(&rate).filter(|(jet, _)| !jet.is_constant());
            moving.extend(entries.map(|(jet, &rate)| (jet, p * rate)));
        }
        let turn = |i: usize| {
            let own = self.column(i, |jet| jet.value);
            let changes = moving
                .iter()
                .fold(ResiduePair::ZERO, |sum, &(jet, weight)| {
                    sum + jet.across(i) * weight
                });
            dot(&moved, &own) - changes
        };
        (0..self.n).map(turn).collect()
    }

    /// Returns Y_α^k p_k, or the same with derivatives of Y.
    fn transposed_product(
        &self,
        p: &[ResiduePair],
        of: impl Fn(&Jet) -> ResiduePair,
    ) -> Vec<ResiduePair> {
        let mut sum = vec![ResiduePair::ZERO; self.nu];
        for (row, &p) in self.rows().zip(p) {
            for (sum, jet) in sum.iter_mut().zip(row) {
                *sum = *sum + of(jet) * p;
            }
        }
        sum
    }
}

impl FormEvaluator {
    /// Prepares the evaluation for a model; `None` if AᵀA is singular, or a number has no image modulo p.
    pub fn new(model: &Model) -> Option<Self> {
        Some(FormEvaluator {
            expressions: FormTapes::new(model)?,
        })
    }

    /// Evaluates the three forms and the quantities in them at a point (x, ξ, ξ̇, u); `None` if something has no value
    /// there.
    ///
    /// # Errors
    /// If Y A is not I.
    pub fn at(&self, field_point: &FieldPoint) -> Option<Result<PointValues, Violation>> {
        let all = &self.expressions;
        let model = &all.model;
        let (n, nu) = (model.n(), model.nu());
        let constants = all.constants.values(field_point)?;
        let mut reader = TapeValueReader::new(&constants);
        let (xi, xi_dot) = (reader.read_list(n)?, reader.read_list(n)?);
        let start = all.kinematics.values(field_point)?;
        let (a, rest) = start.split_at_checked(n * nu)?;
        let rate = rest.get(..nu)?;
        let columns: Vec<Vec<ResiduePair>> = (0..n)
            .map(|i| {
                all.direction_of_x(
                    &a.iter()
                        .skip(i)
                        .step_by(n.max(1))
                        .copied()
                        .collect::<Vec<_>>(),
                )
            })
            .collect();
        let moving = all.direction_of_x_and_xi(rate, &xi_dot);
        let seeds = Seeds {
            along: moving.clone(),
            across: columns.clone(),
            mixed: Vec::new(),
        };
        let mut jets = all.kinematics.jets(field_point, &seeds)?;
        let y = jets.split_off(n * nu + nu);
        let rates = jets.split_off(n * nu);
        let kinematics = Kinematics {
            n,
            nu,
            a: jets,
            rate: rates,
            y,
        };
        if !kinematics.inverse() {
            return Some(Err(Violation::Identity("(6), Y A = I")));
        }
        // Columns (x₂ with x₁₂): Aᵢ with Ȧᵢ, Aᵢ with ∂ᵢẋ, ẋ with ẍ.
        let second: Vec<ResiduePair> = kinematics.rate.iter().map(|jet| jet.along).collect();
        let following = (0..n).map(|i| all.direction_of_x(&kinematics.column(i, |jet| jet.along)));
        let drifting = (0..n).map(|i| all.direction_of_x(&kinematics.drift(i)));
        let seeds = Seeds {
            along: moving.clone(),
            across: columns
                .iter()
                .chain(&columns)
                .chain([&moving])
                .cloned()
                .collect(),
            mixed: following
                .chain(drifting)
                .chain([all.direction_of_x(&second)])
                .collect(),
        };
        let poses = all.poses.jets(field_point, &seeds)?;
        let (potentials, rest) = poses.split_at_checked(3)?;
        let (frames, points) = rest.split_at_checked(12 * all.frames.len())?;
        let frames: FxHashMap<usize, MovingFrame> = all
            .frames
            .iter()
            .zip(frames.chunks_exact(12))
            .map(|(&index, jets)| Some((index, MovingFrame::new(n, jets)?)))
            .collect::<Option<_>>()?;
        let mut points = points
            .chunks_exact(3)
            .map(|jets| point(n, &std::array::from_fn(|i| jets[i].clone())));
        let mut sums = FormSums::new(n);
        let gravity = reader.read_vec3()?;
        for body in &model.bodies {
            let inertia = BodyInertia {
                mass: reader.read_number()?,
                com: reader.read_vec3()?,
                inertia_com: reader.read_mat3()?,
                inertia_origin: reader.read_mat3()?,
            };
            sums.add_body(&inertia, gravity, frames.get(&body.frame)?, &xi);
        }
        for _ in &model.particles {
            sums.add_particle(reader.read_number()?, gravity, &points.next()?, &xi);
        }
        let along = |jet: &Jet| (0..n).map(|i| jet.across(i)).collect::<Vec<ResiduePair>>();
        let [potential, beside, written] = potentials else {
            return None;
        };
        let slope = along(potential);
        let mut left_of_written = vec![ResiduePair::ZERO; n];
        if all.has_written_kinetic_energy() {
            left_of_written = self.add_written_kinetic(
                field_point,
                &kinematics,
                &mut sums,
                (rate, &xi, &xi_dot),
                written,
            )?;
        }
        let turn = kinematics.turn(&sums.momentum);
        let hamel = (0..n).map(|i| sums.momentum_rate[i] - sums.slope[i] + turn[i] + slope[i]);
        let beside = along(beside);
        let gibbs = (0..n).map(|i| sums.gibbs[i] - sums.weight[i] + beside[i] + left_of_written[i]);
        let momentum: Vec<ResiduePair> = sums.mass.iter().map(|row| dot(row, &xi)).collect();
        let turn = kinematics.turn_of_rows(&momentum);
        let bias: Vec<ResiduePair> = (0..n)
            .map(|i| sums.mass_rate[i] - sums.centrifugal[i] + turn[i])
            .collect();
        let levi_civita = (0..n).map(|i| dot(&sums.mass[i], &xi_dot) + bias[i] + slope[i]);
        let left = [hamel.collect(), gibbs.collect(), levi_civita.collect()];
        let (force, dissipation) =
            self.forces(field_point, &mut reader, &frames, &mut points, &xi)?;
        Some(Ok(PointValues {
            left,
            bias,
            slope,
            force,
            rate: rate.to_vec(),
            mass: sums.mass,
            momentum: sums.momentum,
            mass_rate: sums.mass_rate,
            kinetic: sums.kinetic,
            potential: potential.value,
            dissipation,
        }))
    }

    /// Adds the kinetic energy that the user wrote to the sums, and returns its contribution to (30b).
    fn add_written_kinetic(
        &self,
        field_point: &FieldPoint,
        kinematics: &Kinematics,
        sums: &mut FormSums,
        (rate, xi, xi_dot): (&[ResiduePair], &[ResiduePair], &[ResiduePair]),
        written: &Jet,
    ) -> Option<Vec<ResiduePair>> {
        let all = &self.expressions;
        let n = xi.len();
        let by_velocity: Vec<Vec<ResiduePair>> =
            (0..n).map(|i| all.direction_of_xi(&unit(n, i))).collect();
        let by = |along: Vec<ResiduePair>| -> Option<Jet> {
            let seeds = Seeds {
                along,
                across: by_velocity.clone(),
                mixed: Vec::new(),
            };
            all.velocity.jets(field_point, &seeds)?.into_iter().next()
        };
        let driven = by(all.direction_of_x_and_xi(rate, xi_dot))?;
        let coasting = by(all.direction_of_x(rate))?;
        let momentum: Vec<ResiduePair> = (0..n).map(|i| driven.across(i)).collect();
        let turn = kinematics.turn_of_rows(&momentum);
        let mut left = Vec::with_capacity(n);
        sums.kinetic = sums.kinetic + written.value;
        for i in 0..n {
            let hessian_row = all
                .velocity
                .second_derivative(field_point, &all.direction_of_xi(&unit(n, i)))?;
            let row = all.xi_entries(&hessian_row);
            let slope = written.across(i);
            left.push(dot(&row, xi_dot) + coasting.mixed(i) - slope + turn[i]);
            for (sum, entry) in [
                (&mut sums.momentum[i], momentum[i]),
                (&mut sums.momentum_rate[i], driven.mixed(i)),
                (&mut sums.slope[i], slope),
                (&mut sums.mass_rate[i], coasting.mixed(i)),
                (&mut sums.centrifugal[i], slope),
            ] {
                *sum = *sum + entry;
            }
            for (sum, entry) in sums.mass[i].iter_mut().zip(row) {
                *sum = *sum + entry;
            }
        }
        Some(left)
    }

    /// Returns f, and D of dampers and dissipation.
    fn forces(
        &self,
        field_point: &FieldPoint,
        reader: &mut TapeValueReader,
        frames: &FxHashMap<usize, MovingFrame>,
        points: &mut dyn Iterator<Item = MotionJet<Vec3>>,
        xi: &[ResiduePair],
    ) -> Option<(Vec<ResiduePair>, ResiduePair)> {
        let all = &self.expressions;
        let elements = &all.model.elements;
        let n = xi.len();
        let none = || GeneralizedForces {
            sum: vec![ResiduePair::ZERO; n],
        };
        let mut applied = none();
        applied.add(reader.read_list(n)?);
        for wrench in &elements.wrenches {
            let entries = [
                reader.read_vec3()?,
                reader.read_vec3()?,
                reader.read_vec3()?,
            ];
            applied.add_wrench(wrench.axes, entries, frames.get(&wrench.frame)?);
        }
        for push in &elements.pushes {
            if let Along::Line {
                length: Some(_), ..
            } = push.along
            {
                let (from, to) = (points.next()?, points.next()?);
                let tension = reader.read_number()? * reader.read_number()?.inv()?;
                applied.add_along_line(scale(tension, sub(to.value, from.value)), &from, &to);
            }
        }
        let mut resisting = none();
        let across = (0..n).map(|i| all.direction_of_xi(&unit(n, i))).collect();
        let seeds = Seeds {
            along: all.direction_of_xi(xi),
            across,
            mixed: Vec::new(),
        };
        let velocity = all.velocity.jets(field_point, &seeds)?;
        let (dissipation, mut rates) = match velocity.as_slice() {
            [_, dissipation, rates @ ..] => (dissipation, rates.iter()),
            _ => return None,
        };
        for damper in &elements.dampers {
            let coefficient = reader.read_number()?;
            match damper.along {
                Along::Line { .. } => {
                    let (from, to) = (points.next()?, points.next()?);
                    resisting.add_damper(coefficient, &from, &to)?;
                }
                Along::Scalar(_) => {
                    let rate = rates.next()?;
                    let pull = -(coefficient * rate.value);
                    resisting.add((0..n).map(|i| pull * rate.across(i)));
                }
            }
        }
        resisting.add((0..n).map(|i| -dissipation.mixed(i)));
        let power = dot(&resisting.sum, xi);
        applied.add(resisting.sum);
        Some((applied.sum, -(power * ResiduePair::new(2).inv()?)))
    }
}

/// Returns the i-th of n unit vectors.
fn unit(n: usize, i: usize) -> Vec<ResiduePair> {
    (0..n)
        .map(|j| {
            if i == j {
                ResiduePair::ONE
            } else {
                ResiduePair::ZERO
            }
        })
        .collect()
}
