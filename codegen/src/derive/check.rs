//! The identities that every derivation has to satisfy, evaluated left and right.
//!
//! Both sides are compared at exact points of X modulo p ("checked modulo p"). Where they are small
//! enough they are derived once more in the graph with free coordinates, where nothing is merged
//! modulo φ, expanded over the rationals, and compared by normal forms modulo φ ("proved").

use super::calculus::Calculus;
use super::commutation::gamma_from_rows;
use super::normal::NormalForms;
use super::reduction::reduce;
use super::tables::Geometry;
use super::virtual_power;
use super::{constrained, invariants};
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::multiply;
use crate::algebra::numeric::evaluate_at;
use crate::algebra::transplant::rebuild;
use crate::model::Model;
use crate::program::Program;

/// How an identity fared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Both sides have the same normal form modulo φ over the rationals.
    Proved,
    /// Both sides agree at random points of X modulo p.
    Checked,
    /// They differ.
    Failed(String),
}

/// One identity with its verdict.
#[derive(Clone, Debug)]
pub struct Identity {
    /// KR18's number, or a name.
    pub label: &'static str,
    /// The equation.
    pub equation: String,
    /// How it fared.
    pub verdict: Verdict,
}

/// Fresh points for every identity.
const POINTS: u64 = 4;
/// Points tried where square roots have no value.
const TRIES: u64 = 300;
/// Models with more velocities are only checked modulo p.
const MOST_PROVED: usize = 6;
/// Expressions of more nodes are not expanded for a proof.
const MOST_NODES: usize = 20_000;

/// Left and right sides of an identity.
struct Sides {
    label: &'static str,
    equation: &'static str,
    left: Vec<Edge>,
    right: Vec<Edge>,
}

/// Checks all identities of a model and its program.
pub fn check(model: &Model, program: &Program) -> Vec<Identity> {
    let Some(mut geometry) = Geometry::new(model) else {
        let verdict = Verdict::Failed("Y could not be derived".into());
        return vec![Identity {
            label: "(6)",
            equation: "Y A = I".into(),
            verdict,
        }];
    };
    let mut all = geometric(&mut geometry);
    if model.constraints.is_empty() {
        all.extend(motion(&mut geometry, program));
    }
    let mut proofs = Proofs::new(model);
    let graph = &geometry.model.graph;
    let mut identities: Vec<Identity> = all
        .iter()
        .enumerate()
        .map(|(index, sides)| {
            let verdict = match at_points(model, graph, sides) {
                Some(difference) => Verdict::Failed(difference),
                None if proofs.hold(index) => Verdict::Proved,
                None => Verdict::Checked,
            };
            Identity {
                label: sides.label,
                equation: sides.equation.into(),
                verdict,
            }
        })
        .collect();
    if model.constraints.is_empty() {
        identities.extend(invariants::identities(model));
    } else {
        identities.extend(with_constraints(model, program));
    }
    identities
}

/// The identities of motion where there are constraints on ξ.
fn with_constraints(model: &Model, program: &Program) -> Vec<Identity> {
    match reduce(model) {
        Ok(None) => Vec::new(),
        Ok(Some(reduction)) => {
            let mut all = constrained::identities(model, &reduction, program);
            all.extend(invariants::constrained::identities(
                &reduction.model,
                program,
            ));
            all
        }
        Err(error) => vec![Identity {
            label: "C",
            equation: "B C = 0".into(),
            verdict: Verdict::Failed(error.message),
        }],
    }
}

/// The identities of kinematics and inertia.
fn geometric(geometry: &mut Geometry) -> Vec<Sides> {
    let mut all = kinematic(geometry);
    all.extend(jacobi(geometry));
    all.extend(metric(geometry));
    all
}

/// The same identities with free coordinates, for normal forms.
struct Proofs {
    graph: Graph,
    forms: NormalForms,
    sides: Vec<Sides>,
}

impl Proofs {
    fn new(model: &Model) -> Self {
        let mut proofs = Proofs {
            graph: model.graph.clone(),
            forms: NormalForms::new(&model.points),
            sides: Vec::new(),
        };
        if model.n() > MOST_PROVED {
            return proofs;
        }
        let Some(mut geometry) = Geometry::unreduced(model) else {
            return proofs;
        };
        proofs.sides = geometric(&mut geometry);
        proofs.graph = geometry.model.graph;
        proofs
    }

    /// Whether every difference of an identity lies in the ideal of φ.
    fn hold(&mut self, index: usize) -> bool {
        let Some(sides) = self.sides.get(index) else {
            return false;
        };
        let roots: Vec<Edge> = sides.left.iter().chain(&sides.right).copied().collect();
        if self.graph.reachable(&roots).len() > MOST_NODES {
            return false;
        }
        sides.left.iter().zip(&sides.right).all(|(&left, &right)| {
            let (Some(a), Some(b)) = (
                self.forms.expand(&self.graph, left),
                self.forms.expand(&self.graph, right),
            ) else {
                return false;
            };
            self.forms.reduce(&self.graph, &a.sub(&b)).is_zero()
        })
    }
}

/// (6), (7), (12) = (13).
fn kinematic(geometry: &mut Geometry) -> Vec<Sides> {
    let n = geometry.model.n();
    let (mut left, mut right) = (Vec::new(), Vec::new());
    for i in 0..n {
        for j in 0..n {
            let graph = &mut geometry.model.graph;
            let column: Vec<Edge> = geometry.model.a.iter().map(|row| row[j]).collect();
            left.push(graph.dot(&geometry.y[i], &column));
            right.push(if i == j { graph.one() } else { graph.zero() });
        }
    }
    let inverse = Sides {
        label: "(6)",
        equation: "Y A = I",
        left,
        right,
    };
    let from_rows = gamma_from_rows(&mut geometry.model, &geometry.y);
    let same = Sides {
        label: "(12) = (13)",
        equation: "γ from A and γ from Y agree",
        left: flat(&geometry.gamma),
        right: flat(&from_rows),
    };
    let mut all = vec![inverse, tangent(geometry), same];
    all.extend(inverses(geometry));
    all
}

/// Φ Ψ = I, Y Ψ = 0, A Y + Ψ Φ = I.
fn inverses(geometry: &mut Geometry) -> Vec<Sides> {
    let complement = &geometry.complement;
    // Without constraints there is no Φ, and Y is A⁻¹.
    let (phi, psi) = (&complement.phi, &complement.psi);
    let graph = &mut geometry.model.graph;
    let (one, zero) = (graph.one(), graph.zero());
    let unit = |rows: usize, columns: usize| -> Vec<Edge> {
        let entry = |place: usize| {
            if place / columns == place % columns {
                one
            } else {
                zero
            }
        };
        (0..rows * columns).map(entry).collect()
    };
    let (rank, nu) = (phi.len(), geometry.model.x.len());
    let along = multiply(graph, &geometry.model.a, &geometry.y);
    let across = multiply(graph, psi, phi);
    let across = across.iter().flat_map(|row| {
        let rest = if rank == 0 { nu } else { 0 };
        row.iter().copied().chain(std::iter::repeat_n(zero, rest))
    });
    let across: Vec<Edge> = across.collect();
    let both = along
        .concat()
        .into_iter()
        .zip(across)
        .map(|(a, b)| graph.add(a, b))
        .collect();
    let completed = Sides {
        label: "(6)",
        equation: "A Y + Ψ Φ = I",
        left: both,
        right: unit(nu, nu),
    };
    if rank == 0 {
        return vec![completed];
    }
    let left = multiply(graph, &geometry.y, psi).concat();
    let apart = Sides {
        label: "(6)",
        equation: "Y Ψ = 0",
        right: vec![zero; left.len()],
        left,
    };
    let inverse = Sides {
        label: "(6)",
        equation: "Φ Ψ = I",
        left: multiply(graph, phi, psi).concat(),
        right: unit(rank, rank),
    };
    vec![inverse, apart, completed]
}

/// (∂φ/∂x) A = 0: the derivatives are taken with free coordinates and compared on X.
fn tangent(geometry: &mut Geometry) -> Sides {
    let mut free = geometry.model.points.free.clone();
    let first = geometry.model.points.first;
    let x: Vec<Edge> = (first..first + geometry.model.nu())
        .map(|i| Edge::of(free.symbols()[i].node))
        .collect();
    let mut left = Vec::new();
    for (row, _) in geometry.model.phi.clone() {
        let slopes: Vec<Edge> = x
            .iter()
            .map(|x| Derivation::new([(x.node(), free.one())]).of(&mut free, row))
            .collect();
        let slopes = rebuild(&free, &mut geometry.model.graph, &slopes);
        for i in 0..geometry.model.n() {
            let column: Vec<Edge> = geometry.model.a.iter().map(|row| row[i]).collect();
            left.push(geometry.model.graph.dot(&slopes, &column));
        }
    }
    let right = vec![geometry.model.graph.zero(); left.len()];
    Sides {
        label: "(6)",
        equation: "Φ A = 0",
        left,
        right,
    }
}

/// Σ over cyclic i, j, k of ∂ᵢγⱼₖˡ + γⱼₖˢ γᵢₛˡ = 0.
fn jacobi(geometry: &mut Geometry) -> Vec<Sides> {
    let n = geometry.model.n();
    let graph = &mut geometry.model.graph;
    let gamma = &geometry.gamma;
    let (mut left, mut right) = (Vec::new(), Vec::new());
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                for l in 0..n {
                    let mut sum = graph.zero();
                    for (a, b, c) in [(i, j, k), (j, k, i), (k, i, j)] {
                        let change = geometry.calculus.along(graph, a, gamma[b][c][l]);
                        sum = graph.add(sum, change);
                        for s in 0..n {
                            let product = graph.mul(gamma[b][c][s], gamma[a][s][l]);
                            sum = graph.add(sum, product);
                        }
                    }
                    left.push(sum);
                    right.push(graph.zero());
                }
            }
        }
    }
    vec![Sides {
        label: "Jacobi",
        equation: "Σ cyclic ∂ᵢγⱼₖˡ + γⱼₖˢ γᵢₛˡ = 0",
        left,
        right,
    }]
}

/// (21a) and (21b).
fn metric(geometry: &mut Geometry) -> Vec<Sides> {
    let n = geometry.model.n();
    let graph = &mut geometry.model.graph;
    let (mass, gamma, connection) = (&geometry.mass, &geometry.gamma, &geometry.connection);
    let mut sides = [
        Sides {
            label: "(21a)",
            equation: "∂ₖM_ij = Γᵢⱼₖ + Γⱼᵢₖ",
            left: Vec::new(),
            right: Vec::new(),
        },
        Sides {
            label: "(21b)",
            equation: "γₖⱼˢ M_si = Γᵢⱼₖ − Γᵢₖⱼ",
            left: Vec::new(),
            right: Vec::new(),
        },
    ];
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                sides[0]
                    .left
                    .push(geometry.calculus.along(graph, k, mass[i][j]));
                sides[0]
                    .right
                    .push(graph.add(connection[i][j][k], connection[j][i][k]));
                sides[1].left.push(graph.dot(&gamma[k][j], &mass[i]));
                sides[1]
                    .right
                    .push(graph.sub(connection[i][j][k], connection[i][k][j]));
            }
        }
    }
    sides.into()
}

/// The emitted ξ̇ in (30c), (30a) = (30c), and d/dt (T + V) = fᵢ ξⁱ.
fn motion(geometry: &mut Geometry, program: &Program) -> Vec<Sides> {
    let Some(accel) = program.function("accel") else {
        return Vec::new();
    };
    let n = geometry.model.n();
    let xi = geometry.model.xi.clone();
    let xi_dot = rebuild(&program.graph, &mut geometry.model.graph, &accel.outputs);
    let mut calculus = Calculus::new(&geometry.model);
    let applied = super::assemble::applied_force(&mut geometry.model, &mut calculus);
    let hamel = super::connection::quadratic(
        &mut geometry.model,
        &mut calculus,
        &geometry.mass,
        &geometry.gamma,
    );
    let graph = &mut geometry.model.graph;
    let (mut literal, mut forces) = (Vec::new(), Vec::new());
    for i in 0..n {
        let mut contracted = graph.zero();
        for j in 0..n {
            let row = graph.dot(&geometry.connection[i][j], &xi);
            let product = graph.mul(row, xi[j]);
            contracted = graph.add(contracted, product);
        }
        literal.push(contracted);
        let inertial = graph.dot(&geometry.mass[i], &xi_dot);
        let slope = calculus.along(graph, i, geometry.potential);
        let sum = graph.add(inertial, contracted);
        forces.push(graph.add(sum, slope));
    }
    // Ė = Dᵗ(T + V) at ξ̇ = 0, plus p·ξ̇.
    let momentum: Vec<Edge> = geometry
        .mass
        .iter()
        .map(|row| graph.dot(row, &xi))
        .collect();
    let twice = graph.dot(&momentum, &xi);
    let half = graph.ratio(1, 2);
    let kinetic = graph.mul(half, twice);
    let energy = graph.add(kinetic, geometry.potential);
    let drift = calculus.rate(graph, energy);
    let gain = graph.dot(&momentum, &xi_dot);
    let change = graph.add(drift, gain);
    let power = graph.dot(&applied, &xi);
    let mut all = vec![
        Sides {
            label: "(30a) = (30c)",
            equation: "ṗᵢ + γᵢⱼᵏ ξʲ pₖ − ∂ᵢT = Γᵢⱼₖ ξʲ ξᵏ at ξ̇ = 0",
            left: hamel,
            right: literal,
        },
        Sides {
            label: "(30c)",
            equation: "M ξ̇ + Γ ξ ξ + ∂V = f for the emitted ξ̇",
            left: forces,
            right: applied,
        },
        Sides {
            label: "power",
            equation: "d/dt (T + V) = fᵢ ξⁱ for the emitted ξ̇",
            left: vec![change],
            right: vec![power],
        },
    ];
    all.extend(virtual_power(geometry, program));
    all
}

/// (28): the emitted forces, 2 D, and the motions of points, each on the route of single particles.
fn virtual_power(geometry: &mut Geometry, program: &Program) -> Vec<Sides> {
    let mut graph = geometry.model.graph.clone();
    let graph = &mut graph;
    let model = &geometry.model;
    let mut calculus = Calculus::new(model);
    let calculus = &mut calculus;
    let mut all = Vec::new();
    let mut side = |label, equation, (left, right): (Vec<Edge>, Vec<Edge>)| {
        all.push(Sides {
            label,
            equation,
            left,
            right,
        });
    };
    let emitted = |graph: &mut Graph, name: &str| {
        let function = program.function(name)?;
        Some(rebuild(&program.graph, graph, &function.outputs))
    };
    if let Some(force) = emitted(graph, "generalized_force") {
        let virtual_force = virtual_power::applied(model, graph, calculus);
        let equation = "fᵢ = Σ ⟨F_p, ∂ᵢr_p⟩ for the emitted f";
        side("(28)", equation, (force, virtual_force));
    }
    if let Some(slope) = emitted(graph, "potential_force") {
        let force = virtual_power::conservative(model, graph, calculus);
        let force = force.into_iter().map(|edge| -edge).collect();
        let equation = "−∂ᵢV = Σ ⟨F_p, ∂ᵢr_p⟩ of weights and springs";
        side("(28)", equation, (slope, force));
    }
    if let Some(dissipation) = emitted(graph, "dissipation") {
        let twice = dissipation
            .iter()
            .map(|&edge| graph.add(edge, edge))
            .collect();
        let power = vec![virtual_power::dissipated(model, graph, calculus)];
        side("Rayleigh", "2 D = −fᵢ ξⁱ of dampers", (twice, power));
    }
    let lengths = virtual_power::lengths(model, graph);
    side(
        "lines",
        "ℓ² = d·d of springs and forces along lines",
        lengths,
    );
    let motions = virtual_power::motions(model, graph, calculus);
    let equation = "ṙ and r̈ of points from ∂ᵢr and ∂ᵢ∂ⱼr";
    side("motion", equation, motions);
    let zero = graph.zero();
    let says = |sides: &Sides| {
        sides
            .left
            .iter()
            .chain(&sides.right)
            .any(|&edge| edge != zero)
    };
    all.retain(says);
    geometry.model.graph = graph.clone();
    all
}

fn flat(table: &[Vec<Vec<Edge>>]) -> Vec<Edge> {
    table.iter().flatten().flatten().copied().collect()
}

/// Where both sides differ at a point of X, if they do.
fn at_points(model: &Model, graph: &Graph, sides: &Sides) -> Option<String> {
    let roots: Vec<Edge> = sides.left.iter().chain(&sides.right).copied().collect();
    let (mut found, mut seed) = (0, 0);
    while found < POINTS && seed < TRIES {
        seed += 1;
        let Some(mut lane) = model.points.lane(0xc4ec + seed) else {
            continue;
        };
        let Some(values) = evaluate_at(graph, &roots, &mut lane) else {
            continue;
        };
        let (left, right) = values.split_at(sides.left.len());
        if let Some(entry) = (0..left.len()).find(|&entry| left[entry] != right[entry]) {
            return Some(format!("entry {} of {} differs", entry + 1, left.len()));
        }
        found += 1;
    }
    (found == 0).then(|| "no point was found at which both sides have a value".into())
}
