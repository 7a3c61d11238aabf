//! Values of A, γ, M and Γ at a state. No table is derived symbolically: A and M are differentiated numerically, along
//! the columns of A.

use crate::error::Error;
use crate::state::State;
use hamel_codegen::algebra::graph::{Edge, Graph};
use hamel_codegen::algebra::slopes::{ValueWithSlopes, slopes};
use hamel_codegen::derive::calculus::Calculus;
use hamel_codegen::derive::{inertia, kinematics};
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Model;

/// Bound on the rounding error of a sum, relative to its terms.
const SUM_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Numbers of a table with three indices, `table[i][j][k]`.
pub type Cube = Vec<Vec<Vec<f64>>>;

/// Numbers of A, γ, M, Γ of the full frame at one state.
pub struct Geometry {
    pub a: Vec<Vec<f64>>,
    /// `None` if the system has no inertia.
    pub mass: Option<Vec<Vec<f64>>>,
    /// γ and Γ, if requested; Γ only if the system has inertia.
    pub tables: Option<(Cube, Option<Cube>)>,
}

impl Geometry {
    /// Evaluates A and M at a state, and, only with `tables`, γ and Γ, which have n³ entries each.
    pub fn new(generated: &Generated, state: &State, tables: bool) -> Result<Self, Error> {
        let model = &generated.model;
        let n = model.n();
        let flat = model.a.concat();
        let numbers = numbers(model, state);
        let still = slopes(&model.graph, &flat, &numbers, &[]);
        let a: Vec<Vec<f64>> = still
            .chunks(n.max(1))
            .map(|row| row.iter().map(|entry| entry.value).collect())
            .collect();
        let directions: Vec<Vec<f64>> = match tables {
            true => (0..n).map(|i| direction(model, &a, i)).collect(),
            false => Vec::new(),
        };
        let mass = match model.has_inertia {
            true => Some(mass(generated, state, &directions)?),
            false => None,
        };
        let tables = match tables {
            true => {
                let moving = slopes(&model.graph, &flat, &numbers, &directions);
                let gamma = gamma(model, &numbers, &moving)?;
                let connection = mass.as_ref().map(|mass| connection(n, mass, &gamma));
                Some((gamma, connection))
            }
            false => None,
        };
        Ok(Geometry {
            a,
            mass: mass.map(|mass| {
                let rows = mass.chunks(n.max(1));
                rows.map(|row| row.iter().map(|entry| entry.value).collect())
                    .collect()
            }),
            tables,
        })
    }
}

/// Returns the values of the symbols of the full model; the tables depend on x alone.
fn numbers(model: &Model, state: &State) -> Vec<f64> {
    let still = vec![0.0; model.n()];
    model.numbers(&state.params, &state.x, &still, &state.u, &still)
}

/// Returns the i-th column of A, as a direction in all symbols.
fn direction(model: &Model, a: &[Vec<f64>], i: usize) -> Vec<f64> {
    let mut direction = vec![0.0; 1 + model.defaults.len()];
    direction.extend(a.iter().map(|row| row[i]));
    direction
}

/// M by rows, with its derivatives: the mass matrix of the program, or that of the full frame if constraints have been
/// solved.
fn mass(
    generated: &Generated,
    state: &State,
    directions: &[Vec<f64>],
) -> Result<Vec<ValueWithSlopes>, Error> {
    let full = &generated.model;
    let of =
        |graph: &Graph, roots: &[Edge]| slopes(graph, roots, &numbers(full, state), directions);
    if !full.is_constrained()
        && let Some(emitted) = generated.program.function("mass_matrix")
    {
        return Ok(of(&generated.program.graph, &emitted.outputs));
    }
    let mut model = full.clone();
    let mut calculus = Calculus::new(&model);
    let mass = inertia::mass_matrix(&mut model, &mut calculus).concat();
    Ok(of(&model.graph, &mass))
}

/// γᵢⱼᵏ = (∂ᵢAⱼ^β − ∂ⱼAᵢ^β) Y_β^k, KR18 (12).
fn gamma(model: &Model, numbers: &[f64], a: &[ValueWithSlopes]) -> Result<Cube, Error> {
    let (n, nu) = (model.n(), model.nu());
    let mut model = model.clone();
    let rows = kinematics::left_inverse(&mut model).ok_or(Error::NoLeftInverse)?;
    let y = slopes(&model.graph, &rows.concat(), numbers, &[]);
    let mut gamma = vec![vec![vec![0.0; n]; n]; n];
    for i in 0..n {
        for j in i + 1..n {
            let commutator = |beta: usize| {
                let terms = [a[beta * n + j].slope(i), -a[beta * n + i].slope(j)];
                (beta, sum(&terms))
            };
            let moved = (0..nu).map(commutator).filter(|(_, entry)| *entry != 0.0);
            let moved: Vec<(usize, f64)> = moved.collect();
            if moved.is_empty() {
                continue;
            }
            for k in 0..n {
                let terms = moved
                    .iter()
                    .map(|&(beta, entry)| entry * y[k * nu + beta].value);
                let entry = sum(&terms.collect::<Vec<_>>());
                gamma[i][j][k] = entry;
                gamma[j][i][k] = -entry;
            }
        }
    }
    Ok(gamma)
}

/// Γᵢⱼₖ = ½ (∂ₖM_ij + ∂ⱼM_ik − ∂ᵢM_jk + γᵢⱼˢ M_sk + γᵢₖˢ M_sj − γⱼₖˢ M_si), KR18 (23).
fn connection(n: usize, mass: &[ValueWithSlopes], gamma: &Cube) -> Cube {
    let change = |k: usize, i: usize, j: usize| mass[i * n + j].slope(k);
    let lowered: Cube = gamma
        .iter()
        .map(|plane| plane.iter().map(|row| lower(n, row, mass)).collect())
        .collect();
    let entry = |i: usize, j: usize, k: usize| {
        let terms = [
            change(k, i, j),
            change(j, i, k),
            -change(i, j, k),
            lowered[i][j][k],
            lowered[i][k][j],
            -lowered[j][k][i],
        ];
        0.5 * sum(&terms)
    };
    let row = |i: usize, j: usize| (0..n).map(|k| entry(i, j, k)).collect();
    (0..n)
        .map(|i| (0..n).map(|j| row(i, j)).collect())
        .collect()
}

/// γˢ M_sk for all k.
fn lower(n: usize, gamma: &[f64], mass: &[ValueWithSlopes]) -> Vec<f64> {
    let entries = gamma.iter().enumerate().filter(|(_, entry)| **entry != 0.0);
    let entries: Vec<(usize, f64)> = entries.map(|(s, &entry)| (s, entry)).collect();
    let product = |k: usize| {
        let terms = entries
            .iter()
            .map(|&(s, entry)| entry * mass[s * n + k].value);
        sum(&terms.collect::<Vec<_>>())
    };
    (0..n).map(product).collect()
}

/// Returns a sum, rounded to 0 if it is within the rounding error of its terms.
fn sum(terms: &[f64]) -> f64 {
    let (sum, size) = terms.iter().fold((0.0, 0.0), |(sum, size), term| {
        (sum + term, size + term.abs())
    });
    if f64::abs(sum) <= SUM_ROUNDING * size {
        0.0
    } else {
        sum
    }
}
