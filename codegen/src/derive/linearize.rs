//! The linearisation, without redundant directions: with δx = A(x) h and ξ̇ = F(x, ξ, u)
//!
//! ḣᵏ = δξᵏ − γᵢⱼᵏ ξⁱ hʲ, δξ̇ = (∂ⱼF) hʲ + (∂F/∂ξ) δξ + (∂F/∂u) δu.
//!
//! Where constraints leave ξ = C(x) ξₐ, the n displacements h stay, of ξ only ξₐ varies, and the
//! matrices have n + nₐ rows: ḣᵏ = Cᵏₐ δξᵃ + (∂ⱼCᵏₐ ξᵃ − γᵢⱼᵏ ξⁱ) hʲ. States of first order add rows and columns.

use super::accel::best::NEAR;
use super::accel::recursive::Recursion;
use super::accel::setting::Setting;
use super::accel::solve::solve_columns;
use super::calculus::Calculus;
use super::care::Care;
use super::multipliers::with_accelerations;
use super::reduction::Reduction;
use super::{commutation, kinematics};
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph, NodeId};
use crate::algebra::linear::solve_symmetric;
use crate::algebra::resubstitute::resubstitute;
use crate::algebra::transplant::{map_symbols, rebuild};
use crate::derive::normal::{NormalForms, build};
use crate::model::Model;
use crate::program::count::count;

/// Systems with more velocities are not expanded.
const MOST_EXPANDED: usize = 8;
/// Entries with more terms are not expanded.
const MOST_TERMS: usize = 40;
/// Products and sums of terms after which the expansion is given up: the traced entries stand.
const MOST_WORK: usize = 1_000_000;

/// ξ̇ = F as edges of a graph that grew from the model's.
pub struct ForwardDynamics<'a> {
    /// The graph.
    pub graph: &'a Graph,
    /// F, one entry for each active velocity.
    pub xi_dot: &'a [Edge],
    /// Pivots that have to be positive where there is F, those that vary.
    pub guards: &'a [Edge],
    /// The displacements.
    pub nearby: Displacements,
    /// M and f − Γ ξ ξ − ∂V of the active velocities, where M F = right-hand side holds.
    pub implicit: Option<(&'a [Vec<Edge>], &'a [Edge])>,
}

/// [A B]: n + nₐ rows of n + nₐ + m, for (h, δξ, δu).
pub struct Linear {
    /// The graph that it lives in.
    pub graph: Graph,
    /// The rows.
    pub rows: Vec<Vec<Edge>>,
    /// The pivots of F in this graph.
    pub guards: Vec<Edge>,
}

impl Linear {
    /// All that is computed.
    pub fn roots(&self) -> Vec<Edge> {
        [self.rows.concat(), self.guards.clone()].concat()
    }

    /// Its operations: weight and number.
    pub fn cost(&self) -> (usize, usize) {
        let count = count(&self.graph, &self.roots());
        (count.weight(), count.flops())
    }
}

/// The frame that displacements are measured in, as edges of the graph of F.
pub struct Displacements {
    /// A of the full frame, ν rows of n; without the column of ξ⁰.
    pub a: Vec<Vec<Edge>>,
    /// Y of the full frame, n rows of ν; without the row of ξ⁰.
    pub y: Vec<Vec<Edge>>,
    /// The places of the displacements in ξ: all but that of ξ⁰, as the time is not displaced.
    places: Vec<usize>,
    /// ξ = C ξₐ.
    xi: Vec<Edge>,
    /// γ of the full frame.
    gamma: Vec<Vec<Vec<Edge>>>,
}

impl Displacements {
    /// Those of a model, in the graph of its program.
    pub fn new(full: &Model, reduction: Option<&Reduction>, graph: &mut Graph) -> Option<Self> {
        let mut own = full.clone();
        let mut calculus = Calculus::new(&own);
        let rows = kinematics::left_inverse(&mut own)?;
        let gamma = commutation::gamma(&mut own, &mut calculus, &rows);
        let images =
            reduction.map(|reduction| rebuild(&reduction.model.graph, graph, &reduction.images));
        let mut carry = |edges: &[Edge]| match &images {
            Some(images) => map_symbols(&own.graph, graph, edges, images),
            None => rebuild(&own.graph, graph, edges),
        };
        let time = full.clock.map(|clock| clock.xi);
        let places: Vec<usize> = (0..own.n()).filter(|&i| Some(i) != time).collect();
        let displaced = |row: &Vec<Edge>| places.iter().map(|&i| row[i]).collect::<Vec<_>>();
        Some(Displacements {
            a: own.a.iter().map(|row| carry(&displaced(row))).collect(),
            y: places.iter().map(|&i| carry(&rows[i])).collect(),
            places: places.clone(),
            xi: carry(&own.xi),
            gamma: gamma
                .iter()
                .map(|table| table.iter().map(|row| carry(row)).collect())
                .collect(),
        })
    }

    /// Number of displacements.
    pub fn n(&self) -> usize {
        self.places.len()
    }
}

/// The rows of a model with states of first order, (h, δξ, δz): those of ż follow, and the columns of z stand before
/// those of u. F is given in the graph of the rows.
pub fn with_states(
    model: &Model,
    nearby: &Displacements,
    (graph, mut rows): (&mut Graph, Vec<Vec<Edge>>),
    xi_dot: &[Edge],
) -> Vec<Vec<Edge>> {
    let inputs = nearby.n() + model.n();
    for row in &mut rows {
        row[inputs..].rotate_left(model.m());
    }
    let changes = rows[nearby.n()..].to_vec();
    let below = slopes(model, nearby, graph, &model.state_rates, (&changes, xi_dot));
    rows.extend(below);
    rows
}

/// The slopes of expressions of the model by (h, δξ, δz, δu), by rows, in a graph that grew from the model's: ξ̇ is F
/// there, and moves as the rows of δξ̇ say.
pub fn slopes(
    model: &Model,
    nearby: &Displacements,
    graph: &mut Graph,
    expressions: &[Edge],
    (changes, xi_dot): (&[Vec<Edge>], &[Edge]),
) -> Vec<Vec<Edge>> {
    let expressions = rebuild(&model.graph, graph, expressions);
    let n = nearby.n();
    let one = graph.one();
    // z stands before u.
    let (u, z) = model.u.split_at(model.m());
    let moved: Vec<Edge> = [&model.xi, z, u].concat();
    let columns: Vec<Vec<Edge>> = (0..n + moved.len())
        .map(|j| {
            let mut seeds: Vec<(NodeId, Edge)> = match j.checked_sub(n) {
                None => {
                    let x = model.x.iter().zip(&nearby.a);
                    x.map(|(x, row)| (x.node(), row[j])).collect()
                }
                Some(i) => vec![(moved[i].node(), one)],
            };
            let rates = model.xi_dot.iter().zip(changes);
            seeds.extend(rates.map(|(rate, row)| (rate.node(), row[j])));
            Derivation::new(seeds).all(graph, &expressions)
        })
        .collect();
    let slopes = with_accelerations(graph, &columns.concat(), xi_dot);
    let row = |i: usize| slopes.iter().skip(i).step_by(expressions.len());
    (0..expressions.len())
        .map(|i| row(i).copied().collect())
        .collect()
}

/// Linearises; `model` is that of the active velocities. The cheapest of three ways is taken: F itself
/// differentiated; M⁻¹ (∂(f − Γ ξ ξ − ∂V) − (∂M) F) with one factorisation for all columns; the
/// entries expanded, their coefficients computed when parameters are set.
pub fn linearize(model: &Model, motion: &ForwardDynamics, care: &Care) -> Linear {
    let upper = upper(model, motion);
    let placements = care.placements().iter();
    let recursions: Vec<Recursion> = placements
        .filter_map(|&placement| Recursion::of(&Setting::given(model), placement))
        .collect();
    // Beyond a few links nothing comes near the recursion.
    let long = recursions.first().is_some_and(Recursion::is_long);
    let mut candidates: Vec<Linear> = recursions
        .iter()
        .filter_map(|recursion| recursive(model, motion, recursion, &upper))
        .collect();
    if candidates.is_empty() || !(long || model.n() > MOST_EXPANDED) {
        let explicit = explicit(model, motion, &upper);
        if model.n() <= MOST_EXPANDED && !care.is_taken() {
            candidates.extend(expanded(model, &explicit, motion));
        }
        candidates.extend(implicit(model, motion, &upper));
        candidates.push(explicit);
    }
    let cost = |linear: &Linear| {
        let loss = care.loss(&linear.graph, &linear.rows.concat(), &[]);
        let (weight, number) = linear.cost();
        (loss, weight, number)
    };
    let costs: Vec<_> = candidates.iter().map(cost).collect();
    let (loss, weight, _) = costs.iter().min().copied().unwrap_or_default();
    // What is far behind before it is polished is behind afterwards.
    let most = (loss, weight * NEAR.0 / NEAR.1, usize::MAX);
    let near = candidates.into_iter().zip(costs);
    let near = near.filter(|(_, cost)| *cost <= most);
    let polished = near.map(|(linear, before)| match polished(&linear, motion) {
        Some(linear) if cost(&linear) < before => (cost(&linear), linear),
        _ => (before, linear),
    });
    // The first of equals; there is always one.
    let best = polished.min_by_key(|(cost, _)| *cost);
    best.map_or_else(|| explicit(model, motion, &upper), |(_, linear)| linear)
}

/// After resubstitution, where that finds something.
fn polished(linear: &Linear, motion: &ForwardDynamics) -> Option<Linear> {
    let (graph, mut edges) = resubstitute(&linear.graph, &linear.roots(), motion.graph)?;
    let columns = linear.rows.first().map_or(1, |row| row.len().max(1));
    let guards = edges.split_off(edges.len() - linear.guards.len());
    let rows = edges.chunks(columns).map(<[Edge]>::to_vec).collect();
    Some(Linear {
        graph,
        rows,
        guards,
    })
}

/// The rows of ḣ.
fn upper(model: &Model, motion: &ForwardDynamics) -> Linear {
    let mut graph = motion.graph.clone();
    let nearby = &motion.nearby;
    let mut columns = columns(model, &mut graph, nearby);
    let rows = (nearby.places.iter())
        .map(|&k| {
            let mut row: Vec<Edge> = columns
                .iter_mut()
                .map(|column| column.of(&mut graph, nearby.xi[k]))
                .collect();
            for (entry, &j) in row.iter_mut().zip(&nearby.places) {
                for i in 0..nearby.xi.len() {
                    let product = graph.mul(nearby.gamma[i][j][k], nearby.xi[i]);
                    *entry = graph.sub(*entry, product);
                }
            }
            row
        })
        .collect();
    let guards = motion.guards.to_vec();
    Linear {
        graph,
        rows,
        guards,
    }
}

/// The derivations of all columns: ∂ⱼ, ∂/∂ξₐ, ∂/∂u.
fn columns(model: &Model, graph: &mut Graph, nearby: &Displacements) -> Vec<Derivation> {
    let one = graph.one();
    let along = |j: usize| {
        let seeds = model.x.iter().zip(&nearby.a);
        Derivation::new(seeds.map(|(x, row)| (x.node(), row[j])))
    };
    let by = |symbol: &Edge| Derivation::new([(symbol.node(), one)]);
    (0..nearby.n())
        .map(along)
        .chain(model.xi.iter().map(by))
        .chain(model.u.iter().map(by))
        .collect()
}

/// F differentiated as it stands.
fn explicit(model: &Model, motion: &ForwardDynamics, upper: &Linear) -> Linear {
    let mut graph = motion.graph.clone();
    let mut columns = columns(model, &mut graph, &motion.nearby);
    let mut rows = carried(upper, &mut graph);
    rows.extend(motion.xi_dot.iter().map(|&rate| {
        let entries = columns.iter_mut().map(|column| column.of(&mut graph, rate));
        entries.collect::<Vec<Edge>>()
    }));
    let guards = motion.guards.to_vec();
    Linear {
        graph,
        rows,
        guards,
    }
}

/// M δξ̇ = ∂(M F) − (∂M) F, all columns with one factorisation.
fn implicit(model: &Model, motion: &ForwardDynamics, upper: &Linear) -> Option<Linear> {
    let (mass, right) = motion.implicit?;
    let mut graph = motion.graph.clone();
    let mut columns = columns(model, &mut graph, &motion.nearby);
    let changes: Vec<Vec<Edge>> = mass
        .iter()
        .zip(right)
        .map(|(row, &force)| {
            columns
                .iter_mut()
                .map(|column| {
                    let change = column.of(&mut graph, force);
                    let masses = column.all(&mut graph, row);
                    let held = graph.dot(&masses, motion.xi_dot);
                    graph.sub(change, held)
                })
                .collect()
        })
        .collect();
    let solved = solve_symmetric(&mut graph, mass, &changes)?;
    let mut rows = carried(upper, &mut graph);
    rows.extend(solved);
    let guards = motion.guards.to_vec();
    Some(Linear {
        graph,
        rows,
        guards,
    })
}

/// The same for a tree of links, by recursion; M factored from the leaves to the root.
fn recursive(
    model: &Model,
    motion: &ForwardDynamics,
    recursion: &Recursion,
    upper: &Linear,
) -> Option<Linear> {
    let (mass, _) = motion.implicit?;
    if motion.nearby.n() != model.n() {
        return None;
    }
    let mut graph = motion.graph.clone();
    let changes = recursion.slopes(&mut graph, motion.xi_dot)?;
    let solved = solve_columns(&mut graph, mass, &changes)?;
    let mut rows = carried(upper, &mut graph);
    rows.extend(solved);
    let guards = motion.guards.to_vec();
    Some(Linear {
        graph,
        rows,
        guards,
    })
}

/// Every entry as a sum of monomials with coefficients of parameters alone, where all are short.
fn expanded(model: &Model, explicit: &Linear, motion: &ForwardDynamics) -> Option<Linear> {
    let mut forms = NormalForms::within(&model.points, MOST_WORK);
    let mut source = explicit.graph.clone();
    let mut polynomials = Vec::new();
    for &edge in explicit.rows.iter().flatten() {
        let polynomial = forms.expand(&source, edge)?;
        let reduced = forms.reduce(&source, &polynomial);
        let shorter = if reduced.terms().len() <= polynomial.terms().len() {
            reduced
        } else {
            polynomial
        };
        if shorter.terms().len() > MOST_TERMS {
            return None;
        }
        polynomials.push(shorter);
    }
    let built: Vec<Edge> = polynomials
        .iter()
        .map(|polynomial| build(&mut source, polynomial))
        .collect();
    let mut graph = motion.graph.clone();
    let entries = rebuild(&source, &mut graph, &built);
    let columns = explicit.rows.first().map_or(1, |row| row.len().max(1));
    Some(Linear {
        graph,
        rows: entries.chunks(columns).map(<[Edge]>::to_vec).collect(),
        guards: motion.guards.to_vec(),
    })
}

/// The rows of ḣ in another graph.
fn carried(upper: &Linear, graph: &mut Graph) -> Vec<Vec<Edge>> {
    let rows = upper.rows.iter();
    rows.map(|row| rebuild(&upper.graph, graph, row)).collect()
}
