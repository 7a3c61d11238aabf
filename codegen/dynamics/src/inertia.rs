//! The mass matrix M_ij = Σ m_p ⟨∂ᵢr_p, ∂ⱼr_p⟩, KR18 (20), for bodies, particles and a given T.

use super::calculus::{Calculus, into_frame};
use super::inertialess_motion;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{apply3, cross};
use hamel_algebra::numeric::{evaluate, rank};
use hamel_language::diagnostics::Diagnostic;
use hamel_language::functions::Needs;
use hamel_language::model::loop_closure::normalise;
use hamel_language::model::twists::KinematicExpressions;
use hamel_language::model::{Body, Model, Particle};

/// Relative size, with respect to the diagonal, up to which a pivot is a rounded zero.
const ZERO_PIVOT: f64 = 1e-13;
/// Largest number of velocities for which the rank of M is also determined exactly.
const MAX_EXACT_VELOCITIES: usize = 8;
/// Relative size up to which a pivot may be a rounded zero if it was computed in another way.
const DOUBTFUL_PIVOT: f64 = 1e-11;
/// Relative size above which a pivot is not zero even if nothing is exact.
const NONZERO_PIVOT: f64 = 1e-9;

/// Returns the mass matrix M, n × n, as expressions, computed in the axes and about the origins of the bodies' frames.
///
/// For the free body this is [[m I, m ŝᵀ], [m ŝ, Θ]], KR18 (42).
pub fn mass_matrix(model: &mut Model, calculus: &mut Calculus) -> Vec<Vec<Edge>> {
    let n = model.n();
    let mut mass = vec![vec![model.graph.zero(); n]; n];
    for body in model.bodies.clone() {
        let part = body_mass(model, calculus, &body);
        add_matrix(&mut model.graph, &mut mass, &part);
    }
    for particle in model.particles.clone() {
        let part = particle_mass(&mut model.graph, calculus, &particle);
        add_matrix(&mut model.graph, &mut mass, &part);
    }
    let part = written_mass_matrix(model);
    add_matrix(&mut model.graph, &mut mass, &part);
    mass
}

/// Adds the matrix `part` to `sum`, entry by entry.
pub fn add_matrix(graph: &mut Graph, sum: &mut [Vec<Edge>], part: &[Vec<Edge>]) {
    for (row, other) in sum.iter_mut().zip(part) {
        for (entry, &term) in row.iter_mut().zip(other) {
            *entry = graph.add(*entry, term);
        }
    }
}

/// Returns m vᵢ·vⱼ + m (vᵢ·(ωⱼ × s) + vⱼ·(ωᵢ × s)) + ωᵢ·Θ ωⱼ, in body axes and about the frame's
/// origin.
fn body_mass(model: &mut Model, calculus: &mut Calculus, body: &Body) -> Vec<Vec<Edge>> {
    let n = model.n();
    let frame = model.frames[body.frame].clone();
    let graph = &mut model.graph;
    let spins = calculus.spin_jacobian(graph, &frame.rotation);
    let velocities: Vec<_> = calculus
        .point_jacobian(graph, frame.position)
        .into_iter()
        .map(|v| into_frame(graph, &frame.rotation, v))
        .collect();
    let first_moment = body.com.map(|entry| graph.mul(body.mass, entry));
    let lever: Vec<_> = spins
        .iter()
        .map(|&w| cross(graph, w, first_moment))
        .collect();
    let spun: Vec<_> = spins
        .iter()
        .map(|&w| apply3(graph, &body.inertia_origin, w))
        .collect();
    build_symmetric(n, |i, j| {
        let linear = graph.dot(&velocities[i], &velocities[j]);
        let terms = [
            graph.mul(body.mass, linear),
            graph.dot(&velocities[i], &lever[j]),
            graph.dot(&velocities[j], &lever[i]),
            graph.dot(&spins[i], &spun[j]),
        ];
        graph.sum(&terms)
    })
}

fn particle_mass(
    graph: &mut Graph,
    calculus: &mut Calculus,
    particle: &Particle,
) -> Vec<Vec<Edge>> {
    let columns = calculus.point_jacobian(graph, particle.position);
    build_symmetric(columns.len(), |i, j| {
        let product = graph.dot(&columns[i], &columns[j]);
        graph.mul(particle.mass, product)
    })
}

/// Returns the part of M that belongs to the kinetic energy that the user wrote, ∂²T/∂ξⁱ∂ξʲ.
pub fn written_mass_matrix(model: &mut Model) -> Vec<Vec<Edge>> {
    let graph = &mut model.graph;
    let mut by: Vec<Derivation> = model
        .xi
        .iter()
        .map(|xi| Derivation::new([(xi.node(), graph.one())]))
        .collect();
    let energy = model.kinetic;
    let momentum: Vec<Edge> = by.iter_mut().map(|d| d.of(graph, energy)).collect();
    build_symmetric(momentum.len(), |i, j| by[j].of(graph, momentum[i]))
}

/// Builds a symmetric matrix from its lower triangle.
pub fn build_symmetric(n: usize, mut entry: impl FnMut(usize, usize) -> Edge) -> Vec<Vec<Edge>> {
    let mut rows: Vec<Vec<Edge>> = Vec::with_capacity(n);
    for i in 0..n {
        let row = (0..=i).map(|j| entry(i, j)).collect();
        rows.push(row);
    }
    (0..n)
        .map(|i| {
            (0..n)
                .map(|j| if j <= i { rows[i][j] } else { rows[j][i] })
                .collect()
        })
        .collect()
}

/// Returns whether M is singular because some velocities have no inertia, so that constraints have to determine them.
///
/// That is the case if M is singular on all of X, or so close to singular at the start, with the
/// default parameters, that rounding may decide.
pub fn is_mass_matrix_singular(model: &Model) -> bool {
    if model.n() <= MAX_EXACT_VELOCITIES && is_rank_deficient(model) {
        return true;
    }
    let numbers = start_values(model, &model.start_x);
    let first = 1 + model.defaults.len();
    let moving = KinematicExpressions {
        graph: &model.graph,
        a: &model.a,
        first,
        velocity: first + model.x.len(),
        n: model.n(),
    };
    let terms = model.kinetic_terms.as_ref();
    let kinetic = terms.map_or(model.kinetic, |_| model.graph.zero());
    let inertia = (&model.bodies[..], &model.particles[..], kinetic);
    let mut mass = moving.mass(&model.frames, inertia, &numbers).concat();
    if let Some(terms) = terms {
        let more = evaluate(&model.graph, &terms.mass.concat(), &numbers);
        mass.iter_mut()
            .zip(more)
            .for_each(|(sum, more)| *sum += more);
    }
    failing_pivot(&mass, model.n(), DOUBTFUL_PIVOT).is_some()
}

/// Returns whether M is rank-deficient at a random point of X and of the parameters.
fn is_rank_deficient(model: &Model) -> bool {
    let mut model = model.clone();
    let mut calculus = Calculus::new(&model);
    let terms = model.kinetic_terms.take();
    if terms.is_some() {
        model.kinetic = model.graph.zero();
    }
    let mut mass = mass_matrix(&mut model, &mut calculus);
    if let Some(terms) = terms {
        add_matrix(&mut model.graph, &mut mass, &terms.mass);
    }
    let value = |entry: &Edge| model.graph.value(*entry);
    let rows = mass.iter().map(|row| row.iter().map(value).collect());
    rank(rows.collect()) < model.n()
}

/// Returns the numbers of the start, with the given x.
fn start_values(model: &Model, x: &[f64]) -> Vec<f64> {
    let (m, n) = (model.u.len(), model.n());
    model.numbers(
        &model.defaults,
        x,
        &model.start_xi,
        &vec![0.0; m],
        &vec![0.0; n],
    )
}

/// Returns a configuration near the start at which no angle is special; `None` if there are
/// constraints between coordinates that charts alone do not satisfy.
fn generic_configuration(model: &Model) -> Option<Vec<f64>> {
    let displaced = model.start_x.iter().zip(1..);
    let displaced =
        displaced.map(|(entry, place)| entry + 0.1 + 0.2 * (1.7 * f64::from(place)).sin());
    let mut x: Vec<f64> = displaced.collect();
    normalise(&model.blocks, &mut x);
    let rows: Vec<Edge> = model.phi.iter().map(|(edge, _)| *edge).collect();
    let residuals = evaluate(&model.points.free, &rows, &start_values(model, &x));
    residuals
        .iter()
        .all(|residual| residual.abs() < NONZERO_PIVOT)
        .then_some(x)
}

/// Returns the rows of B in B ξ̇ = b, one list of n expressions each: those of the constraints, then one for each given
/// rate.
pub fn constraint_rows(model: &Model) -> Vec<Vec<Edge>> {
    let (zero, one, n) = (model.graph.zero(), model.graph.one(), model.n());
    let constraints = model.constraints.iter().map(|c| c.row.clone());
    let given = model.accelerated.iter().map(move |(place, _)| {
        let mut row = vec![zero; n];
        row[*place] = one;
        row
    });
    constraints.chain(given).collect()
}

/// Returns M + w BᵀB and the force w Bᵀ b for M ξ̇ = f + Bᵀ λ with B ξ̇ = b.
///
/// Using this matrix, and adding this force to f, changes neither ξ̇ nor λ, and provides pivots for
/// velocities that only constraints determine.
pub fn augment_mass_matrix(
    graph: &mut Graph,
    mass: &[Vec<Edge>],
    rows: &[Vec<Edge>],
    right: &[Edge],
) -> Option<(Vec<Vec<Edge>>, Vec<Edge>)> {
    let n = mass.len();
    let weight = augmentation_weight(graph, mass, rows)?;
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
    let weighed: Vec<Vec<Edge>> = (0..n)
        .map(|i| {
            let column = column(i).into_iter();
            column.map(|entry| graph.mul(weight, entry)).collect()
        })
        .collect();
    let sum = build_symmetric(n, |i, j| {
        let part = graph.dot(&weighed[i], &column(j));
        graph.add(mass[i][j], part)
    });
    let force = weighed.iter().map(|column| graph.dot(column, right));
    Some((sum, force.collect()))
}

/// Returns w = tr M / tr BᵀB, which makes M and w BᵀB comparable in size.
///
/// If M is 0, so that constraints alone determine the motion, it is 1 / tr BᵀB.
pub fn augmentation_weight(
    graph: &mut Graph,
    mass: &[Vec<Edge>],
    rows: &[Vec<Edge>],
) -> Option<Edge> {
    let diagonal: Vec<Edge> = (0..mass.len()).map(|i| mass[i][i]).collect();
    let (entries, mut trace) = (rows.concat(), graph.sum(&diagonal));
    if trace == graph.zero() {
        trace = graph.one();
    }
    let squares = graph.dot(&entries, &entries);
    graph.div(trace, squares)
}

/// Checks that M is positive definite with the default parameters, as far as it has to be inverted.
///
/// M is in `graph`, which has the model's symbols. It has to be positive definite at the start or,
/// if nobody has chosen the start, at least near it. If constraints determine velocities without
/// inertia, M + w BᵀB has to be positive definite instead.
///
/// # Errors
/// Returns a diagnostic that names the first velocity whose pivot is not positive.
pub fn check_positive_definite(
    model: &Model,
    graph: &Graph,
    mass: &[Vec<Edge>],
) -> Result<(), Diagnostic> {
    let n = model.n();
    let (mut graph, mut mass) = (graph.clone(), mass.to_vec());
    if model.augmented {
        let rows = constraint_rows(model);
        let right = vec![graph.zero(); rows.len()];
        if let Some((sum, _)) = augment_mass_matrix(&mut graph, &mass, &rows, &right) {
            mass = sum;
        }
    }
    let mass_at = |x: &[f64]| {
        let mut values = evaluate(&graph, &mass.concat(), &start_values(model, x));
        // A velocity whose rate is prescribed, and on which no constraint acts, is not solved for.
        for &(place, _) in model
            .accelerated
            .iter()
            .filter(|_| model.constraints.is_empty())
        {
            for i in 0..n {
                let entry = f64::from(u8::from(i == place));
                (values[place * n + i], values[i * n + place]) = (entry, entry);
            }
        }
        values
    };
    let pivot_at = |x: &[f64], least: f64| failing_pivot(&mass_at(x), n, least);
    let Some(pivot) = pivot_at(&model.start_x, ZERO_PIVOT) else {
        return Ok(());
    };
    let elsewhere = generic_configuration(model).filter(|_| model.starts_anywhere);
    if elsewhere.is_some_and(|x| pivot_at(&x, NONZERO_PIVOT).is_none()) {
        return Ok(());
    }
    let name = model
        .graph
        .symbols()
        .iter()
        .find(|s| s.node == model.xi[pivot].node())
        .map_or("", |s| s.name.as_str());
    let help = inertialess_motion::advise_on_singular_mass(model, &mass_at(&model.start_x), pivot);
    let help = help.unwrap_or_else(|| {
        "every velocity needs inertia: check masses, inertias and their default values; `generate inverse_dynamics, mass_matrix;` and similar selections do not need its inverse".into()
    });
    Err(Diagnostic::new(
        model.velocity_spans.get(pivot).copied().unwrap_or(model.span),
        format!("the mass matrix is not positive definite at the start: pivot {} (`{name}`) is not positive", pivot + 1),
    )
    .help(help)
    .lacking(Needs::Inverse))
}

/// Returns the first velocity whose pivot in Cholesky's factorisation is at most `least`, relative
/// to the diagonal; `None` if no pivot fails in an elimination that takes the largest one first.
///
/// The order of elimination determines how far rounding hides that a pivot is 0: with the largest
/// first, the remainder for the last one is a few units of the diagonal.
fn failing_pivot(m: &[f64], n: usize, least: f64) -> Option<usize> {
    let idle = velocities_without_pivots(m, n, least);
    if idle.is_empty() {
        return None;
    }
    first_failing_pivot(m, n, least).or(idle.first().copied())
}

/// Eliminates velocities, the one with the largest pivot relative to the diagonal first, and
/// returns those that remain, in ascending order, when no relative pivot is larger than `least`.
fn velocities_without_pivots(m: &[f64], n: usize, least: f64) -> Vec<usize> {
    let mut rest = m.to_vec();
    let mut left: Vec<usize> = (0..n).collect();
    let ratio = |rest: &[f64], i: usize| rest[i * n + i] / m[i * n + i].abs();
    while let Some(place) = (0..left.len())
        .filter(|&place| ratio(&rest, left[place]) > least)
        .max_by(|&a, &b| ratio(&rest, left[a]).total_cmp(&ratio(&rest, left[b])))
    {
        let k = left.remove(place);
        let pivot = rest[k * n + k];
        for &i in &left {
            for &j in &left {
                rest[i * n + j] -= rest[i * n + k] * rest[k * n + j] / pivot;
            }
        }
    }
    left
}

/// Returns the first pivot, in the order of the velocities, that is at most `least`, relative to
/// the diagonal.
fn first_failing_pivot(m: &[f64], n: usize, least: f64) -> Option<usize> {
    let mut l = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = m[i * n + j] - (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum::<f64>();
            if i != j {
                l[i * n + j] = sum / l[j * n + j];
            } else if sum.is_nan() || sum <= least * m[i * n + i].abs() {
                return Some(i);
            } else {
                l[i * n + i] = sum.sqrt();
            }
        }
    }
    None
}
