//! Validation of the motion nearby, [A B], and of invariants, at a point modulo p.
//!
//! Slopes are taken by dual numbers from M, h, ∂V and f of the independent derivation, and M ξ̇ = F
//! is solved in numbers: no derivative of the generator's own takes part.

use super::calculus::Calculus;
use super::invariants::quantity;
use super::reference::Reference;
use super::{energy, hamel_form};
use crate::algebra::fp::{Fp, Random};
use crate::algebra::graph::{Edge, Node};
use crate::algebra::lane::Lane;
use crate::algebra::numeric::{evaluate_at, solve};
use crate::algebra::tangent::tangent_at;
use crate::model::Model;
use crate::program::Program;

/// What is compared at every point.
pub struct Slopes {
    /// Names of the invariants with their entries in the graph of a model.
    invariants: Vec<(String, Vec<Edge>)>,
    model: Model,
    /// What slopes are taken of, where the motion nearby is wanted.
    reference: Option<Reference>,
}

/// M, F = f − h − ∂V, A and Aξ of one point, or their slopes.
struct Numbers {
    mass: Vec<Vec<Fp>>,
    force: Vec<Fp>,
    a: Vec<Vec<Fp>>,
    rate: Vec<Fp>,
}

impl Numbers {
    fn roots(reference: &Reference) -> Vec<Edge> {
        let mut roots = reference.mass.concat();
        for part in [&reference.force, &reference.bias, &reference.slope] {
            roots.extend(part);
        }
        roots.extend(reference.model.a.concat());
        roots.extend(&reference.model.rate);
        roots
    }

    fn new(reference: &Reference, values: &[Fp]) -> Self {
        let (n, nu) = (reference.model.n(), reference.model.nu());
        let (mass, rest) = values.split_at(n * n);
        let (forces, rest) = rest.split_at(3 * n);
        let (a, rate) = rest.split_at(nu * n);
        let rows = |flat: &[Fp]| flat.chunks(n.max(1)).map(<[Fp]>::to_vec).collect();
        Numbers {
            mass: rows(mass),
            force: (0..n)
                .map(|i| forces[i] - forces[n + i] - forces[2 * n + i])
                .collect(),
            a: rows(a),
            rate: rate.to_vec(),
        }
    }
}

impl Slopes {
    /// Prepares for a program; `None` where AᵀA is singular.
    pub fn new(model: &Model, program: &Program) -> Option<Self> {
        let claims: Vec<_> = model
            .invariants
            .iter()
            .filter(|claim| program.function(&claim.name).is_some())
            .collect();
        let linear = program.function("linearize").is_some();
        let mut own = model.clone();
        let mut invariants = Vec::new();
        if !claims.is_empty() {
            let mut calculus = Calculus::new(&own);
            let kinetic = hamel_form::kinetic_energy(&mut own, &mut calculus);
            let energies = (kinetic, energy::potential(&mut own));
            for claim in claims {
                let value = quantity::value(&mut own, &mut calculus, energies, &claim.quantity);
                invariants.push((claim.name.clone(), value.entries()));
            }
        }
        Some(Slopes {
            invariants,
            model: own,
            reference: if linear {
                Some(Reference::new(model)?)
            } else {
                None
            },
        })
    }

    /// Compares at one point; `None` where it cannot be evaluated there.
    pub fn at_point(&self, program: &Program, lane: &Lane) -> Option<Result<(), String>> {
        let value = |name: &str| {
            let function = program.function(name)?;
            evaluate_at(&program.graph, &function.outputs, &mut lane.clone())
        };
        for (name, entries) in &self.invariants {
            if value(name)? != evaluate_at(&self.model.graph, entries, &mut lane.clone())? {
                return Some(Err("an invariant".into()));
            }
        }
        let Some(reference) = &self.reference else {
            return Some(Ok(()));
        };
        let graph = &reference.model.graph;
        let roots = Numbers::roots(reference);
        let here = Numbers::new(reference, &evaluate_at(graph, &roots, &mut lane.clone())?);
        let symbol = |edges: &[Edge]| -> Vec<usize> {
            edges
                .iter()
                .filter_map(|edge| match graph.node(edge.node()) {
                    Node::Symbol(index) => Some(index as usize),
                    _ => None,
                })
                .collect()
        };
        let model = &reference.model;
        let (x, xi, u) = (symbol(&model.x), symbol(&model.xi), symbol(&model.u));
        // The slopes of everything along a direction in the symbols.
        let size = graph.symbols().len();
        let slope = |moved: &[(usize, Fp)]| -> Option<Numbers> {
            let mut direction = vec![Fp::ZERO; size];
            moved.iter().for_each(|&(index, by)| direction[index] = by);
            let duals = tangent_at(graph, &roots, &mut lane.clone(), &direction)?;
            let slopes: Vec<Fp> = duals.into_iter().map(|dual| dual.1).collect();
            Some(Numbers::new(reference, &slopes))
        };
        let along = |column: &[Fp]| -> Vec<(usize, Fp)> {
            x.iter().copied().zip(column.iter().copied()).collect()
        };
        let moving = slope(&along(&here.rate))?;
        let n = model.n();
        let xi_dot = solve(here.mass.clone(), here.force.clone())?;
        // All columns at once, (h, δξ, δu) of random numbers: one wrong entry goes unnoticed with
        // probability 1/p.
        let columns = 2 * n + u.len();
        let mut random = Random::new(here.rate.iter().fold(columns as u64, |seed, rate| {
            seed.rotate_left(7) ^ rate.bits()
        }));
        let nearby: Vec<Fp> = (0..columns).map(|_| random.element()).collect();
        let linear = value("linearize")?;
        let rows: Vec<Vec<Fp>> = linear.chunks(columns.max(1)).map(<[Fp]>::to_vec).collect();
        let found = product(&rows, &nearby);
        let (h, rest) = nearby.split_at(n);
        let mut moved = along(&product(&here.a, h));
        moved.extend(xi.iter().chain(&u).copied().zip(rest.iter().copied()));
        let changed = slope(&moved)?;
        // A ḣ = D(A ξ)[A h, δξ] − Ȧ h.
        let turned = product(&moving.a, h);
        let left: Vec<Fp> = changed
            .rate
            .iter()
            .zip(&turned)
            .map(|(&a, &b)| a - b)
            .collect();
        if product(&here.a, &found[..n]) != left {
            return Some(Err("ḣ of the motion nearby".into()));
        }
        // M δξ̇ = δF − δM ξ̇.
        let held = product(&changed.mass, &xi_dot);
        let right: Vec<Fp> = changed
            .force
            .iter()
            .zip(&held)
            .map(|(&a, &b)| a - b)
            .collect();
        if product(&here.mass, &found[n..]) != right {
            return Some(Err("δξ̇ of the motion nearby".into()));
        }
        Some(Ok(()))
    }
}

fn product(rows: &[Vec<Fp>], vector: &[Fp]) -> Vec<Fp> {
    let terms = |row: &Vec<Fp>| row.iter().zip(vector).map(|(&a, &b)| a * b).collect();
    rows.iter()
        .map(|row| {
            let terms: Vec<Fp> = terms(row);
            terms.into_iter().fold(Fp::ZERO, |sum, term| sum + term)
        })
        .collect()
}
