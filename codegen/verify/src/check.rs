//! Identities that every derivation has to satisfy, with both sides evaluated.
//!
//! Both sides are compared at exact points of X in two fields ("checked"). Where they are small enough, they are
//! derived again in the graph with free coordinates, where nothing is merged modulo φ, expanded over the rationals, and
//! compared by normal forms modulo φ ("proved").

use super::confidence::{Confidence, ConfidenceBounds};
use super::forms::ComparedQuantities;
use super::points::{COMPARED_POINTS, Disagreement, compare_at_fresh_points};
use super::verdict::Sides;
pub use super::verdict::{Identity, Verdict};
use super::{constrained, invariants, motion};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::multiply;
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::transplant::rebuild;
use hamel_dynamics::normal::NormalForms;
use hamel_dynamics::reduction::reduce;
use hamel_dynamics::tables::EquationTables;
use hamel_language::model::{Model, class};
use hamel_program::Program;

/// Largest number of velocities of a model whose identities are proved; those of larger models are only checked.
const MAX_PROVED_VELOCITIES: usize = 8;
/// Largest number of nodes of expressions that are expanded for a proof.
const MAX_EXPANDED_NODES: usize = 20_000;
/// Largest number of nodes of expressions in which ξ̇ occurs: in free coordinates, second derivatives of rotations are
/// long polynomials.
const MAX_NODES_WITH_RATES: usize = 640;

/// Compares both sides of every identity of a model, and the emitted functions with them, at random points modulo p,
/// tries to prove the small ones by normal forms, and returns one verdict for each, for `hamel check`.
pub fn check(model: &Model, program: &Program) -> Vec<Identity> {
    match ComparedQuantities::new(model) {
        Some(symbols) => verdicts(model, program, symbols, Some(Proofs::new(model))),
        None => vec![Identity {
            label: "(6)",
            equation: "Y A = I".into(),
            verdict: Verdict::Failed("Y could not be derived".into()),
        }],
    }
}

/// Returns the identities that do not hold at random points modulo p if these quantities, which a test may have
/// changed, stand for those of the model; no proof is tried.
pub fn failed_identities(
    model: &Model,
    program: &Program,
    symbols: ComparedQuantities,
) -> Vec<Identity> {
    let mut identities = verdicts(model, program, symbols, None);
    identities.retain(|identity| matches!(identity.verdict, Verdict::Failed(_)));
    identities
}

/// Returns the verdicts on all identities; proofs are attempted if `proofs` is given.
fn verdicts(
    model: &Model,
    program: &Program,
    mut symbols: ComparedQuantities,
    mut proofs: Option<Proofs>,
) -> Vec<Identity> {
    let mut all = description_sides(&mut symbols);
    if !model.is_constrained() {
        all.extend(motion::emitted_sides(&mut symbols, program));
    }
    // Identities without entries are not reported.
    all.retain(|sides| !sides.left.is_empty());
    let graph = &symbols.geometry.model.graph;
    let mut compared = ConfidenceBounds::new(model, graph);
    let mut identities: Vec<Identity> = all
        .iter()
        .map(|sides| {
            let mut proved = || proofs.as_mut().is_some_and(|proofs| proofs.hold(sides));
            let verdict = match at_points(model, graph, sides) {
                Some(difference) => Verdict::Failed(difference),
                None if proved() => Verdict::Proved,
                None => Verdict::Checked(confidence(&mut compared, graph, sides)),
            };
            Identity {
                label: sides.label,
                equation: sides.equation.into(),
                verdict,
            }
        })
        .collect();
    if !model.is_constrained() {
        identities.extend(invariants::check_invariants(model));
    } else {
        identities.extend(with_constraints(model, program));
    }
    identities
}

/// Returns the identities of motion for a model with constraints on ξ.
fn with_constraints(model: &Model, program: &Program) -> Vec<Identity> {
    match reduce(model) {
        Ok(None) => Vec::new(),
        Ok(Some(reduction)) => {
            let mut all = constrained::check_constrained(model, &reduction, program);
            all.extend(invariants::constrained::check_constrained_invariants(
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

/// Returns the identities that do not involve the emitted program.
fn description_sides(symbols: &mut ComparedQuantities) -> Vec<Sides> {
    let mut all = kinematic(symbols);
    all.extend(jacobi(&mut symbols.geometry));
    if !symbols.geometry.model.has_inertia {
        all.push(motion::loads(symbols));
        return all;
    }
    all.extend(metric(&mut symbols.geometry));
    all.extend(motion::forms(symbols));
    all
}

/// The same identities in free coordinates, to be proved by normal forms.
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
        if model.n() > MAX_PROVED_VELOCITIES {
            return proofs;
        }
        let Some(mut symbols) = ComparedQuantities::unreduced(model) else {
            return proofs;
        };
        proofs.sides = description_sides(&mut symbols);
        proofs.graph = symbols.geometry.model.graph;
        proofs
    }

    /// Returns whether every difference between the sides of an identity, in free coordinates, lies in the ideal of φ.
    fn hold(&mut self, on_x: &Sides) -> bool {
        let same = |sides: &&Sides| (sides.label, sides.equation) == (on_x.label, on_x.equation);
        let Some(sides) = self.sides.iter().find(same) else {
            return false;
        };
        if [sides.left.len(), sides.right.len()] != [on_x.left.len(); 2] {
            return false;
        }
        let roots: Vec<Edge> = sides.left.iter().chain(&sides.right).copied().collect();
        let moving = |root: &Edge| self.graph.class(root.node()) & class::ACCEL != 0;
        let most = match roots.iter().any(moving) {
            true => MAX_NODES_WITH_RATES,
            false => MAX_EXPANDED_NODES,
        };
        if self.graph.reachable(&roots).len() > most {
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

/// Returns the sides of (6), (7), (12) = (13).
fn kinematic(symbols: &mut ComparedQuantities) -> Vec<Sides> {
    let geometry = &mut symbols.geometry;
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
    let same = Sides {
        label: "(12) = (13)",
        equation: "γ from A and γ from Y agree",
        left: flat(&geometry.gamma),
        right: flat(&symbols.gamma_of_rows),
    };
    let mut all = vec![inverse, tangent(geometry), same];
    all.extend(inverses(geometry));
    all
}

/// Returns the sides of Φ Ψ = I, Y Ψ = 0, A Y + Ψ Φ = I.
fn inverses(geometry: &mut EquationTables) -> Vec<Sides> {
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

/// Returns the sides of (∂φ/∂x) A = 0: the derivatives are taken with free coordinates and compared on X.
fn tangent(geometry: &mut EquationTables) -> Sides {
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

/// Returns the sides of the Jacobi identity: Σ over cyclic i, j, k of ∂ᵢγⱼₖˡ + γⱼₖˢ γᵢₛˡ = 0.
fn jacobi(geometry: &mut EquationTables) -> Vec<Sides> {
    let n = geometry.model.n();
    let graph = &mut geometry.model.graph;
    let gamma = &geometry.gamma;
    let (mut left, mut right) = (Vec::new(), Vec::new());
    let zero = graph.zero();
    let nonzero = nonzero(graph, gamma);
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let cycle = [(i, j, k), (j, k, i), (k, i, j)];
                if cycle.iter().all(|&(_, b, c)| nonzero[b][c].is_empty()) {
                    continue;
                }
                for l in 0..n {
                    let mut sum = zero;
                    for (a, b, c) in cycle {
                        let change = geometry.calculus.along(graph, a, gamma[b][c][l]);
                        sum = graph.add(sum, change);
                        for &s in &nonzero[b][c] {
                            let product = graph.mul(gamma[b][c][s], gamma[a][s][l]);
                            sum = graph.add(sum, product);
                        }
                    }
                    left.push(sum);
                    right.push(zero);
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

/// Returns for each j and k the s with γⱼₖˢ ≠ 0. In large systems most pairs have none, and sums over all s would take
/// most of the time.
fn nonzero(graph: &Graph, gamma: &[Vec<Vec<Edge>>]) -> Vec<Vec<Vec<usize>>> {
    let places = |row: &Vec<Edge>| {
        let places = row.iter().enumerate();
        let places = places.filter(|(_, entry)| **entry != graph.zero());
        places.map(|(s, _)| s).collect()
    };
    let rows = gamma.iter();
    rows.map(|rows| rows.iter().map(places).collect()).collect()
}

/// Returns the sides of (21a) and (21b).
fn metric(geometry: &mut EquationTables) -> Vec<Sides> {
    let n = geometry.model.n();
    let graph = &mut geometry.model.graph;
    let (mass, gamma, connection) = (&geometry.mass, &geometry.gamma, &geometry.connection);
    let nonzero = nonzero(graph, gamma);
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
                let terms = nonzero[k][j].iter();
                let terms: Vec<Edge> = terms
                    .map(|&s| graph.mul(gamma[k][j][s], mass[s][i]))
                    .collect();
                sides[1].left.push(graph.sum(&terms));
                sides[1]
                    .right
                    .push(graph.sub(connection[i][j][k], connection[i][k][j]));
            }
        }
    }
    sides.into()
}

fn flat(table: &[Vec<Vec<Edge>>]) -> Vec<Edge> {
    table.iter().flatten().flatten().copied().collect()
}

/// Bounds the chance that both sides agree at all points although they differ.
fn confidence(compared: &mut ConfidenceBounds<'_>, graph: &Graph, sides: &Sides) -> Confidence {
    let merged = |(left, right): (&Edge, &Edge)| left == right && left.abs() != graph.zero();
    let mut pairs = sides.left.iter().zip(&sides.right);
    if pairs.any(merged) {
        // The graph has merged both sides into one node because their values agree at its own point; merged nodes are
        // sums or products of its nodes.
        return compared.merging();
    }
    let roots: Vec<Edge> = sides.left.iter().chain(&sides.right).copied().collect();
    compared.at_points(&roots, COMPARED_POINTS, sides.left.len())
}

/// Describes where both sides differ at a point of X; `None` if they agree.
fn at_points(model: &Model, graph: &Graph, sides: &Sides) -> Option<String> {
    let roots: Vec<Edge> = sides.left.iter().chain(&sides.right).copied().collect();
    let compared = compare_at_fresh_points(
        |number| model.points.lane(0xc4ec + number),
        |point, _| {
            let values = evaluate_at(graph, &roots, &mut point.clone())?;
            let (left, right) = values.split_at(sides.left.len());
            let differs = (0..left.len()).find(|&entry| left[entry] != right[entry]);
            Some(differs.map_or(Ok(()), Err))
        },
    );
    match compared {
        Ok(()) => None,
        Err(Disagreement::Differs(entry)) => {
            let count = sides.left.len();
            Some(format!("entry {} of {count} differs", entry + 1))
        }
        Err(Disagreement::Nowhere) => {
            Some("too few points were found at which both sides have a value".into())
        }
    }
}
