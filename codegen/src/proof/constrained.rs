//! The proof for systems with constraints: at points of X, with ξ = C ξₐ, the emitted ξ̇ₐ and
//! multipliers satisfy M ξ̇ + h + ∂V = f + Bᵀ λ in every row of the full frame, and d/dt (B ξ) is what
//! the constraints ask for; M, h, V and f come from T and γ of the full frame.

use super::confidence::Confidence;
use super::kernel::{in_kernel, places};
use super::points::{POINTS, at_fresh_points};
use super::reference::Reference;
use super::verdict::{Identity, Verdict, failure};
use crate::algebra::fp::Fp;
use crate::algebra::graph::Edge;
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::tangent::tangent_at;
use crate::algebra::transplant::substitute;
use crate::derive::accel::saddle;
use crate::derive::calculus::Calculus;
use crate::derive::reduction::{Reduction, drift};
use crate::diagnostics::Diagnostic;
use crate::model::{Model, class};
use crate::program::{FunctionId, Program};

/// What is compared, with the label and equation that `check` prints.
const IDENTITIES: [(&str, &str); 8] = [
    ("C", "B C = 0 for the rows that were solved"),
    (
        "(30c)",
        "M ξ̇ + Γ ξ ξ + ∂V = f + Bᵀ λ for the emitted ξ̇ and λ",
    ),
    (
        "B",
        "d/dt (B ξ) = −2 λ B ξ − λ² φ for the emitted ξ̇, and rates that are given",
    ),
    ("M", "the emitted mass matrix is Cᵀ M C"),
    ("(30a)", "the emitted bias is Cᵀ (Γ ξ ξ + M Ċ ξ)"),
    ("(28)", "the emitted forces are Cᵀ f and Cᵀ ∂V"),
    (
        "power",
        "d/dt (T + V) = fᵢ ξⁱ for the emitted ξ̇ where B ξ + b = 0",
    ),
    (
        "nearby",
        "the emitted [A B] are the slopes of ẋ and ξ̇ along δx = A h",
    ),
];

/// Everything of the full frame that is compared with.
struct Full {
    reference: Reference,
    /// Ċ ξₐ + ċ.
    drift: Vec<Edge>,
    /// C by rows, then c.
    complement: Vec<Edge>,
    /// B, all rows.
    rows: Vec<Edge>,
    /// d/dt (T + V) at ξ̇ = 0.
    change: Edge,
    /// Kept rows in ξₐ and their right sides, in the reduced graph.
    reduced: Model,
    right: Vec<Edge>,
}

impl Full {
    fn new(model: &Model, reduction: &Reduction) -> Option<Self> {
        let full = Model {
            graph: reduction.graph.clone(),
            ..model.clone()
        };
        let mut reference = Reference::new(&full)?;
        let full = &mut reference.model;
        let xi: Vec<Edge> = reduction.active.iter().map(|&i| full.xi[i]).collect();
        let drift = drift(full, &xi, &reduction.section);
        let section = &reduction.section;
        let section = [section.complement.concat(), section.shift.clone()].concat();
        let mut calculus = Calculus::new(full);
        let energy = full.graph.add(reference.kinetic, reference.potential);
        let change = calculus.rate(&mut full.graph, energy);
        let mut reduced = reduction.model.clone();
        let mut calculus = Calculus::new(&reduced);
        let right = saddle::right_side(&mut reduced, &mut calculus);
        let mut full = Full {
            drift,
            complement: section,
            rows: model
                .constraints
                .iter()
                .flat_map(|c| c.row.clone())
                .collect(),
            change,
            reduced,
            right,
            reference,
        };
        full.prescribe();
        Some(full)
    }

    /// Puts prescribed coordinates in, now that all derivatives are taken: at a point, sin q of a symbol q and sin f
    /// of a sum f with the same value would differ.
    fn prescribe(&mut self) {
        let reference = &mut self.reference;
        let model = &mut reference.model;
        let first = model.points.first;
        let given = model.prescribed.iter();
        let set: Vec<(usize, Edge)> = given.map(|(place, edge)| (first + place, *edge)).collect();
        let graph = &mut model.graph;
        let rows = [&mut reference.mass, &mut model.a];
        let rows = rows.into_iter().flatten();
        let lists = [
            &mut reference.bias,
            &mut reference.slope,
            &mut reference.force,
            &mut self.drift,
            &mut self.complement,
            &mut self.rows,
        ];
        for list in rows.chain(lists) {
            *list = substitute(graph, list, &set);
        }
        let single = [
            &mut reference.kinetic,
            &mut reference.potential,
            &mut reference.dissipation,
            &mut self.change,
        ];
        for edge in single {
            *edge = substitute(graph, &[*edge], &set)[0];
        }
    }
}

/// Validates the functions of a program with constraints; an error is a fault of the generator.
pub fn validate(model: &Model, reduction: &Reduction, program: &Program) -> Result<(), Diagnostic> {
    let full = Full::new(model, reduction);
    let failed = full.and_then(|full| compare(&full, model, reduction, program));
    let Some(failed) = failed else {
        return Err(failure(
            model,
            "that the equations have values at some points",
        ));
    };
    let mut rows = IDENTITIES.iter().zip(&failed);
    match rows.find(|((label, _), failed)| failed.is_some() && is_there(label, reduction, program))
    {
        Some(((_, equation), _)) => Err(failure(model, equation)),
        None => Ok(()),
    }
}

/// What fails at fresh points; `None` where there are none.
fn compare(
    full: &Full,
    model: &Model,
    reduction: &Reduction,
    program: &Program,
) -> Option<[Option<String>; IDENTITIES.len()]> {
    let mut failed: [Option<String>; IDENTITIES.len()] = Default::default();
    let compared = at_fresh_points(
        |number| model.points.lane(0xb0d5 + number),
        |lane, number| {
            let results = at_point(full, reduction, program, lane, number)?;
            for (failed, result) in failed.iter_mut().zip(results) {
                *failed = failed.take().or(result.err());
            }
            Some(Ok::<(), ()>(()))
        },
    );
    compared.is_ok().then_some(failed)
}

/// Nothing is said of what is not there.
fn is_there(label: &str, reduction: &Reduction, program: &Program) -> bool {
    match label {
        "C" => !reduction.solved.is_empty(),
        "B" => !reduction.kept.is_empty() || !reduction.model.accelerated.is_empty(),
        "nearby" => program.function(FunctionId::Linearize).is_some(),
        _ => true,
    }
}

/// What agreement at all points says: all that is evaluated, in sums and solutions of n + rows terms.
fn confidence(full: &Full, model: &Model, program: &Program) -> Confidence {
    let reference = &full.reference;
    let mut roots = reference.mass.concat();
    let lists = [
        &reference.force,
        &reference.bias,
        &reference.slope,
        &reference.model.rate,
        &full.complement,
        &full.rows,
        &full.drift,
    ];
    lists.iter().for_each(|list| roots.extend(list.iter()));
    roots.push(full.change);
    let emitted: Vec<Edge> = program
        .functions
        .iter()
        .flat_map(|function| function.outputs.clone())
        .collect();
    let expressions = [
        (&reference.model.graph, &roots[..]),
        (&full.reduced.graph, &full.right[..]),
        (&program.graph, &emitted[..]),
    ];
    let terms = 4 * (model.n() + full.rows.len() + 1);
    Confidence::new(model, &expressions, terms, POINTS, terms * terms)
}

/// The identities with their verdicts.
pub fn identities(model: &Model, reduction: &Reduction, program: &Program) -> Vec<Identity> {
    let full = Full::new(model, reduction);
    let failed = full
        .as_ref()
        .and_then(|full| compare(full, model, reduction, program));
    let confidence = full.map(|full| confidence(&full, model, program));
    let verdict = |index: usize| match (&failed, confidence) {
        (Some(failed), Some(confidence)) => match &failed[index] {
            Some(message) => Verdict::Failed(message.clone()),
            None => Verdict::Checked(confidence),
        },
        _ => Verdict::Failed("no point was found to compare at".into()),
    };
    IDENTITIES
        .iter()
        .enumerate()
        .filter(|(_, (label, _))| is_there(label, reduction, program))
        .map(|(index, &(label, equation))| Identity {
            label,
            equation: equation.into(),
            verdict: verdict(index),
        })
        .collect()
}

type Comparison = Result<(), String>;

/// All comparisons at one point; `None` where something has no value there.
fn at_point(
    full: &Full,
    reduction: &Reduction,
    program: &Program,
    lane: &Lane,
    seed: u64,
) -> Option<[Comparison; IDENTITIES.len()]> {
    let (n, na) = (full.reference.model.n(), reduction.active.len());
    let graph = &full.reference.model.graph;
    let section = evaluate_at(graph, &full.complement, &mut lane.clone())?;
    let (c, shift) = section.split_at(n * na);
    let time = full.reference.model.clock.map(|clock| clock.xi);
    let column = |j: usize| -> Vec<Fp> { (0..n).map(|i| c[i * na + j]).collect() };
    let project = |v: &[Fp]| -> Vec<Fp> { (0..na).map(|j| dot(&column(j), v)).collect() };
    let rows = evaluate_at(graph, &full.rows, &mut lane.clone())?;
    let vanish = reduction.solved.iter().all(|&(row, _)| {
        let row = &rows[row * n..][..n];
        (0..na).all(|j| dot(row, &column(j)).is_zero()) && dot(row, shift).is_zero()
    });
    let place = places(graph, class::VELOCITY);
    let random: Vec<Fp> = reduction
        .active
        .iter()
        .map(|&i| lane.symbol(place[i]))
        .collect();
    let at = At {
        full,
        reduction,
        program,
        lane,
        c,
        shift,
    };
    let (point, inner) = at.lanes(&random);
    let values = at.values(&point)?;
    let [mass, bias, slope, force] = [&values.mass, &values.bias, &values.slope, &values.force];
    let emitted = |name: &str| -> Option<Option<Vec<Fp>>> {
        match program.function(name) {
            None => Some(None),
            Some(f) => evaluate_at(&program.graph, &f.outputs, &mut inner.clone()).map(Some),
        }
    };
    let balanced = match (emitted("accel")?, emitted("constraint_force")?) {
        (Some(xi_dot), Some(lambda)) => {
            let xi_dot = values.lift(c, &xi_dot);
            // The row of ξ⁰ is no equation of motion.
            (0..n).filter(|&i| Some(i) != time).all(|i| {
                let inertial = dot(&mass[i * n..][..n], &xi_dot);
                let bonds = lambda.iter().zip(rows.chunks(n));
                let bond = bonds.fold(Fp::ZERO, |sum, (&lambda, row)| sum + row[i] * lambda);
                // Beyond the rows of constraints stand the forces of drives whose rates are given.
                let drives = full.reference.model.accelerated.iter();
                let drives = drives.zip(lambda.get(rows.len() / n..).unwrap_or(&[]));
                let drive = drives.filter(|((velocity, _), _)| *velocity == i);
                let drive = drive.fold(Fp::ZERO, |sum, (_, &force)| sum + force);
                inertial + bias[i] + slope[i] == force[i] + bond + drive
            })
        }
        _ => true,
    };
    let kept: Vec<Edge> = full
        .reduced
        .constraints
        .iter()
        .flat_map(|constraint| constraint.row.iter().copied())
        .collect();
    let inner_graph = &full.reduced.graph;
    let kept = evaluate_at(inner_graph, &kept, &mut inner.clone())?;
    let right = evaluate_at(inner_graph, &full.right, &mut inner.clone())?;
    let reduced_mass: Vec<Fp> = (0..na)
        .flat_map(|i| {
            let moved: Vec<Fp> = (0..n)
                .map(|k| dot(&mass[k * n..][..n], &column(i)))
                .collect();
            project(&moved)
        })
        .collect();
    let carried: Vec<Fp> = (0..n)
        .map(|k| bias[k] + dot(&mass[k * n..][..n], &values.drift))
        .collect();
    let held = match emitted("accel")? {
        None => true,
        Some(xi_dot) if full.reduced.overconstrained => {
            let rest: Vec<Fp> = (0..n).map(|k| force[k] - slope[k] - carried[k]).collect();
            saddle::solve_at(&reduced_mass, &project(&rest), &kept, &right)? == xi_dot
        }
        Some(xi_dot) => {
            let given: Vec<Edge> = full.reduced.accelerated.iter().map(|(_, e)| *e).collect();
            let given = evaluate_at(inner_graph, &given, &mut inner.clone())?;
            let driven = full.reduced.accelerated.iter().zip(&given);
            let mut driven = driven.map(|((place, _), &rate)| xi_dot[*place] == rate);
            let mut held = right.iter().zip(kept.chunks(na));
            driven.all(|holds| holds) && held.all(|(&right, row)| dot(row, &xi_dot) == right)
        }
    };
    let equal = |name: &str, expected: Vec<Fp>| -> Option<bool> {
        Some(emitted(name)?.is_none_or(|found| found == expected))
    };
    let same_mass = equal("mass_matrix", reduced_mass.clone())?;
    let same_bias = equal("bias", project(&carried))?;
    let same_loads = equal("generalized_force", project(force))?
        && equal("potential_force", project(slope))?
        && equal("kinetic_energy", vec![values.kinetic])?
        && equal("potential_energy", vec![values.potential])?
        && equal("dissipation", vec![values.dissipation])?;
    let shifts: Vec<Edge> = full.reduced.constraints.iter().map(|c| c.shift).collect();
    let shifts = evaluate_at(inner_graph, &shifts, &mut inner.clone())?;
    let momentum: Vec<Fp> = (0..n)
        .map(|i| dot(&mass[i * n..][..n], &values.xi))
        .collect();
    let same_mass = same_mass && equal("momentum", project(&momentum))?;
    let power = at.power((&kept, &shifts), &random, seed)?;
    let nearby = at.nearby(&point, &inner)?;
    let result = |holds: bool, what: &str| if holds { Ok(()) } else { Err(what.to_string()) };
    Some([
        result(vanish, "a row does not vanish"),
        result(balanced, "the forces do not balance"),
        result(held, "the constraint is left"),
        result(same_mass, "M or p differs"),
        result(same_bias, "the bias differs"),
        result(same_loads, "a force or energy differs"),
        result(power, "the power differs"),
        result(nearby, "a slope differs"),
    ])
}

/// A point with everything that is needed to move ξ on it.
struct At<'a> {
    full: &'a Full,
    reduction: &'a Reduction,
    program: &'a Program,
    lane: &'a Lane,
    c: &'a [Fp],
    shift: &'a [Fp],
}

/// Numbers of the full frame.
struct Values {
    mass: Vec<Fp>,
    bias: Vec<Fp>,
    slope: Vec<Fp>,
    force: Vec<Fp>,
    drift: Vec<Fp>,
    kinetic: Fp,
    potential: Fp,
    dissipation: Fp,
    change: Fp,
    xi: Vec<Fp>,
}

impl Values {
    /// ξ̇ = C ξ̇ₐ + Ċ ξₐ.
    fn lift(&self, c: &[Fp], xi_dot: &[Fp]) -> Vec<Fp> {
        let rows = c.chunks(xi_dot.len()).zip(&self.drift);
        rows.map(|(row, &drift)| dot(row, xi_dot) + drift).collect()
    }
}

impl At<'_> {
    /// The point with ξ = C ξₐ, and the same for the reduced model.
    fn lanes(&self, xi_active: &[Fp]) -> (Lane, Lane) {
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

    fn values(&self, point: &Lane) -> Option<Values> {
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
    fn power(&self, kept: (&[Fp], &[Fp]), random: &[Fp], seed: u64) -> Option<bool> {
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
}

impl At<'_> {
    /// [A B] against dual numbers: δξ̇ = DF, and A ḣ = D(ẋ)[A h] − Ȧ h.
    fn nearby(&self, point: &Lane, inner: &Lane) -> Option<bool> {
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

fn dot(a: &[Fp], b: &[Fp]) -> Fp {
    a.iter().zip(b).fold(Fp::ZERO, |sum, (&x, &y)| sum + x * y)
}
