//! Linearisation without redundant directions: with δx = A(x) h and ξ̇ = F(x, ξ, u),
//!
//! ḣᵏ = δξᵏ − γᵢⱼᵏ ξⁱ hʲ, δξ̇ = (∂ⱼF) hʲ + (∂F/∂ξ) δξ + (∂F/∂u) δu.
//!
//! If constraints leave ξ = C(x) ξₐ, there are still n displacements h, but only ξₐ varies of ξ,
//! and the matrices have n + nₐ rows: ḣᵏ = Cᵏₐ δξᵃ + (∂ⱼCᵏₐ ξᵃ − γᵢⱼᵏ ξⁱ) hʲ. States of first order
//! add rows and columns.

use super::accel::best::MAX_POLISHED_COST_RATIO;
use super::accel::context::DerivationContext;
use super::accel::recursive::{AccelerationDerivatives, TreeRecursion};
use super::accel::tree_recursions;
use super::calculus::Calculus;
use super::multipliers::with_accelerations;
use super::numerical_loss::NumericalLoss;
use super::reduction::Reduction;
use super::{commutation, kinematics};
use crate::normal::{NormalForms, build_expression};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph, NodeId};
use hamel_algebra::linear::solve_symmetric;
use hamel_algebra::resubstitute::resubstitute;
use hamel_algebra::transplant::{map_symbols, rebuild};
use hamel_language::model::Model;
use hamel_program::Cause;
use hamel_program::count::count;
use hamel_program::provenance::Quantity;

/// Largest number of velocities for which entries are expanded.
const MAX_EXPANDED_VELOCITIES: usize = 8;
/// Largest number of terms of an expanded entry.
const MAX_TERMS: usize = 40;
/// Largest number of terms of an intermediate polynomial in an expansion.
///
/// Cancellation modulo φ leaves at least a tenth of them.
const MAX_INTERMEDIATE_TERMS: usize = 400;
/// Number of products and sums of terms after which the expansion is given up, in favour of the
/// traced entries.
const MAX_TERM_OPERATIONS: usize = 200_000;

/// Forward dynamics ξ̇ = F, as edges of a graph that extends the model's.
pub struct ForwardDynamics<'a> {
    /// Graph of F.
    pub graph: &'a Graph,
    /// F, with one entry for each active velocity.
    pub xi_dot: &'a [Edge],
    /// Varying pivots that have to be positive for F to exist, and their meaning.
    pub guards: &'a [(Edge, Cause)],
    /// Frame of the displacements.
    pub displacements: Displacements,
    /// M and f − Γ ξ ξ − ∂V of the active velocities, if M F equals this right-hand side.
    pub implicit: Option<(&'a [Vec<Edge>], &'a [Edge])>,
}

/// Linearisation `[A B]`: n + nₐ rows, and n + nₐ + m columns for (h, δξ, δu).
pub struct Linearization {
    /// Graph of its entries.
    pub graph: Graph,
    /// Rows of `[A B]`.
    pub rows: Vec<Vec<Edge>>,
    /// Pivots of F in this graph, and their meaning.
    pub guards: Vec<(Edge, Cause)>,
    /// F, if it is obtained along with the derivatives; empty otherwise.
    pub rates: Vec<Edge>,
}

impl Linearization {
    /// Creates a linearisation whose rows are derived from F as it is.
    fn of(motion: &ForwardDynamics, graph: Graph, rows: Vec<Vec<Edge>>) -> Self {
        Linearization {
            graph,
            rows,
            guards: motion.guards.to_vec(),
            rates: Vec::new(),
        }
    }

    /// Returns the entries of the rows, then the guards.
    fn results(&self) -> Vec<Edge> {
        let guards = self.guards.iter().map(|(guard, _)| *guard);
        self.rows.iter().flatten().copied().chain(guards).collect()
    }

    /// Returns the weight and the number of its operations.
    pub fn cost(&self) -> (usize, usize) {
        let count = count(&self.graph, &self.results());
        (count.weight(), count.flops())
    }

    /// Returns all computed edges: rows, guards, F.
    pub fn roots(&self) -> Vec<Edge> {
        [self.results(), self.rates.clone()].concat()
    }

    /// Splits edges of another graph that correspond to [`Linearization::roots`] into rows, guards and F.
    pub fn separate_roots(&self, mut roots: Vec<Edge>) -> SeparatedRoots {
        let columns = self.rows.first().map_or(1, |row| row.len().max(1));
        let rates = roots.split_off(roots.len() - self.rates.len());
        let guards = roots.split_off(roots.len() - self.guards.len());
        let causes = self.guards.iter().map(|&(_, cause)| cause);
        let rows = roots.chunks(columns).map(<[Edge]>::to_vec).collect();
        (rows, guards.into_iter().zip(causes).collect(), rates)
    }
}

/// Rows, guards and F of a linearisation.
type SeparatedRoots = (Vec<Vec<Edge>>, Vec<(Edge, Cause)>, Vec<Edge>);

/// Frame in which displacements are measured, as edges of the graph of F.
pub struct Displacements {
    /// A of the full frame, ν × n, without the column of ξ⁰.
    pub a: Vec<Vec<Edge>>,
    /// Y of the full frame, n × ν, without the row of ξ⁰.
    pub y: Vec<Vec<Edge>>,
    /// Indices of the displacements in ξ: all but that of ξ⁰, since time is not displaced.
    places: Vec<usize>,
    /// ξ = C ξₐ.
    xi: Vec<Edge>,
    /// γ of the full frame.
    gamma: Vec<Vec<Vec<Edge>>>,
}

impl Displacements {
    /// Derives the frame A(x) of the displacements h, δx = A h, for a model in the graph of its program.
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

    /// Returns the number of displacements.
    pub fn n(&self) -> usize {
        self.places.len()
    }
}

/// Moves the columns of the states z before those of u, and appends the rows of ż: (h, δξ, δz).
///
/// `xi_dot` (F) is given in the graph of the rows.
pub fn append_states(
    model: &Model,
    displacements: &Displacements,
    (graph, mut rows): (&mut Graph, Vec<Vec<Edge>>),
    xi_dot: &[Edge],
) -> Vec<Vec<Edge>> {
    let inputs = displacements.n() + model.n();
    for row in &mut rows {
        row[inputs..].rotate_left(model.m());
    }
    let changes = rows[displacements.n()..].to_vec();
    let below = output_derivatives(
        model,
        displacements,
        graph,
        &model.state_rates,
        (&changes, xi_dot),
    );
    rows.extend(below);
    rows
}

/// Returns the derivatives of outputs, or of other expressions of the model, by (h, δξ, δz, δu), by rows: `[C D]`.
///
/// The graph extends the model's. ξ̇ is F there, and `changes` are the rows of δξ̇.
pub fn output_derivatives(
    model: &Model,
    displacements: &Displacements,
    graph: &mut Graph,
    expressions: &[Edge],
    (changes, xi_dot): (&[Vec<Edge>], &[Edge]),
) -> Vec<Vec<Edge>> {
    let expressions = rebuild(&model.graph, graph, expressions);
    let n = displacements.n();
    let one = graph.one();
    // In the model's inputs, z comes after u; here it precedes it.
    let (u, z) = model.u.split_at(model.m());
    let moved: Vec<Edge> = [&model.xi, z, u].concat();
    let columns: Vec<Vec<Edge>> = (0..n + moved.len())
        .map(|j| {
            let mut seeds: Vec<(NodeId, Edge)> = match j.checked_sub(n) {
                None => {
                    let x = model.x.iter().zip(&displacements.a);
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

/// Derives `[A B]` of ḣ and δξ̇ for (h, δξ, δu), δx = A h, by the cheapest of four ways; `model` is that of the active
/// velocities.
///
/// The cheapest of four ways is chosen:
///
/// - for a tree of links, recursion, which also yields F;
/// - F itself differentiated;
/// - M⁻¹ (∂(f − Γ ξ ξ − ∂V) − (∂M) F) with one factorisation for all columns;
/// - the entries expanded, with their coefficients computed when parameters are set.
pub fn linearize(
    model: &Model,
    motion: &ForwardDynamics,
    numerical_loss: &NumericalLoss,
) -> Linearization {
    let upper = displacement_rows(model, motion);
    let recursions = tree_recursions(
        &DerivationContext::in_given_velocities(model),
        numerical_loss,
    );
    // For more than a few links the recursion is certainly the cheapest.
    let long = recursions.first().is_some_and(TreeRecursion::is_long);
    let plain = motion.displacements.n() == model.n() && motion.implicit.is_some();
    let traced = recursions.iter().filter(|_| plain);
    let mut candidates: Vec<Linearization> = traced
        .filter_map(|recursion| linearize_tree(recursion, &upper))
        .collect();
    if candidates.is_empty() || !(long || model.n() > MAX_EXPANDED_VELOCITIES) {
        let explicit = differentiate(model, motion, &upper);
        if model.n() <= MAX_EXPANDED_VELOCITIES && !numerical_loss.is_compared_first() {
            candidates.extend(expand_entries(model, &explicit, motion));
        }
        candidates.extend(differentiate_implicitly(model, motion, &upper));
        candidates.push(explicit);
    }
    let cost = |linear: &Linearization| {
        let loss = numerical_loss.loss(&linear.graph, &linear.rows.concat(), &[]);
        let (weight, number) = linear.cost();
        (loss, weight, number)
    };
    let costs: Vec<_> = candidates.iter().map(cost).collect();
    let (loss, weight, _) = costs.iter().min().copied().unwrap_or_default();
    // Candidates that are far more expensive before polishing remain so afterwards.
    let most = (
        loss,
        weight * MAX_POLISHED_COST_RATIO.0 / MAX_POLISHED_COST_RATIO.1,
        usize::MAX,
    );
    let near = candidates.into_iter().zip(costs);
    let near = near.filter(|(_, cost)| *cost <= most);
    let polished = near.map(|(linear, before)| match polish(&linear, model, motion) {
        Some(linear) if cost(&linear) < before => (cost(&linear), linear),
        _ => (before, linear),
    });
    // The first of equal ones; there is always at least one.
    let best = polished.min_by_key(|(cost, _)| *cost);
    let mut best = best.map_or_else(
        || differentiate(model, motion, &upper),
        |(_, linear)| linear,
    );
    for (place, row) in best.rows.iter().enumerate() {
        let label = match place.checked_sub(motion.displacements.n()) {
            None => Quantity::DisplacementDerivative.of(0),
            Some(velocity) => Quantity::AccelerationDerivative.of(velocity),
        };
        best.graph.label(row, label);
    }
    best
}

/// Returns the linearisation after resubstitution, if that finds anything.
///
/// The base is the graph of F, or the model's graph if F is obtained along with the derivatives.
fn polish(
    linear: &Linearization,
    model: &Model,
    motion: &ForwardDynamics,
) -> Option<Linearization> {
    let base = match linear.rates.is_empty() {
        true => motion.graph,
        false => &model.graph,
    };
    let (graph, roots) = resubstitute(&linear.graph, &linear.roots(), base)?;
    let (rows, guards, rates) = linear.separate_roots(roots);
    Some(Linearization {
        graph,
        rows,
        guards,
        rates,
    })
}

/// Returns the rows of ḣ.
fn displacement_rows(model: &Model, motion: &ForwardDynamics) -> Linearization {
    let mut graph = motion.graph.clone();
    let displacements = &motion.displacements;
    let mut columns = derivations_of_columns(model, &mut graph, displacements);
    let rows = (displacements.places.iter())
        .map(|&k| {
            let mut row: Vec<Edge> = columns
                .iter_mut()
                .map(|column| column.of(&mut graph, displacements.xi[k]))
                .collect();
            for (entry, &j) in row.iter_mut().zip(&displacements.places) {
                for i in 0..displacements.xi.len() {
                    let product = graph.mul(displacements.gamma[i][j][k], displacements.xi[i]);
                    *entry = graph.sub(*entry, product);
                }
            }
            row
        })
        .collect();
    Linearization::of(motion, graph, rows)
}

/// Returns the derivations of all columns: ∂ⱼ, ∂/∂ξₐ, ∂/∂u.
fn derivations_of_columns(
    model: &Model,
    graph: &mut Graph,
    displacements: &Displacements,
) -> Vec<Derivation> {
    let one = graph.one();
    let along = |j: usize| {
        let seeds = model.x.iter().zip(&displacements.a);
        Derivation::new(seeds.map(|(x, row)| (x.node(), row[j])))
    };
    let by = |symbol: &Edge| Derivation::new([(symbol.node(), one)]);
    (0..displacements.n())
        .map(along)
        .chain(model.xi.iter().map(by))
        .chain(model.u.iter().map(by))
        .collect()
}

/// Differentiates F as it is.
fn differentiate(model: &Model, motion: &ForwardDynamics, upper: &Linearization) -> Linearization {
    let mut graph = motion.graph.clone();
    let mut columns = derivations_of_columns(model, &mut graph, &motion.displacements);
    let mut rows = copy_rows(upper, &mut graph);
    rows.extend(motion.xi_dot.iter().map(|&rate| {
        let entries = columns.iter_mut().map(|column| column.of(&mut graph, rate));
        entries.collect::<Vec<Edge>>()
    }));
    Linearization::of(motion, graph, rows)
}

/// Solves M δξ̇ = ∂(M F) − (∂M) F for all columns with one factorisation.
fn differentiate_implicitly(
    model: &Model,
    motion: &ForwardDynamics,
    upper: &Linearization,
) -> Option<Linearization> {
    let (mass, right) = motion.implicit?;
    let mut graph = motion.graph.clone();
    let mut columns = derivations_of_columns(model, &mut graph, &motion.displacements);
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
    for (velocity, row) in changes.iter().enumerate() {
        graph.label(row, Quantity::ForceDerivative.of(velocity));
    }
    let solved = solve_symmetric(&mut graph, mass, &changes)?;
    let mut rows = copy_rows(upper, &mut graph);
    rows.extend(solved);
    Some(Linearization::of(motion, graph, rows))
}

/// Linearises a tree of links by recursion, with M factored from the leaves to the root.
fn linearize_tree(recursion: &TreeRecursion, upper: &Linearization) -> Option<Linearization> {
    let AccelerationDerivatives {
        mut graph,
        xi_dot,
        pivots,
        rows: below,
    } = recursion.acceleration_derivatives()?;
    let mut rows = copy_rows(upper, &mut graph);
    rows.extend(below);
    let guards = pivots.into_iter().enumerate();
    let guards = guards.filter(|(_, pivot)| !graph.is_free(pivot.node()));
    Some(Linearization {
        guards: guards
            .map(|(i, pivot)| (pivot, Cause::Velocity(i)))
            .collect(),
        graph,
        rows,
        rates: xi_dot,
    })
}

/// Writes every entry as a sum of monomials whose coefficients depend on parameters alone; `None`
/// if one of them is long.
fn expand_entries(
    model: &Model,
    explicit: &Linearization,
    motion: &ForwardDynamics,
) -> Option<Linearization> {
    let mut forms = NormalForms::with_budget(&model.points, MAX_TERM_OPERATIONS)
        .with_max_terms(MAX_INTERMEDIATE_TERMS)
        .keeping_powers();
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
        if shorter.terms().len() > MAX_TERMS {
            return None;
        }
        polynomials.push(shorter);
    }
    let built: Vec<Edge> = polynomials
        .iter()
        .map(|polynomial| build_expression(&mut source, polynomial))
        .collect();
    let mut graph = motion.graph.clone();
    let entries = rebuild(&source, &mut graph, &built);
    let columns = explicit.rows.first().map_or(1, |row| row.len().max(1));
    let rows = entries.chunks(columns).map(<[Edge]>::to_vec).collect();
    Some(Linearization::of(motion, graph, rows))
}

/// Copies the rows of ḣ to another graph.
fn copy_rows(upper: &Linearization, graph: &mut Graph) -> Vec<Vec<Edge>> {
    let rows = upper.rows.iter();
    rows.map(|row| rebuild(&upper.graph, graph, row)).collect()
}
