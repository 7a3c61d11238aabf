//! Solves M ξ̇ + Γ ξ ξ + ∂V = f, KR18 (30c), for ξ̇ by the cheapest of several routes.
//!
//! The routes differ in how they set up the equation (by tracing the bodies in some axes about some reference
//! point, by recursion over a tree of links, or by expanding Γ ξ ξ into polynomials) and in how they solve it. Each
//! candidate is built in its own graph and its operations are counted exactly; the cheapest one is kept.

pub(super) mod best;
pub mod branches;
pub mod cheapest;
pub mod context;
mod dependent;
pub(super) mod hybrid;
pub mod kkt;
pub mod parts;
pub mod polynomial;
pub mod recursive;
pub mod solve;

use crate::candidates::MAX_SEARCHED_VELOCITIES;
use crate::inertia;
use crate::numerical_loss::NumericalLoss;
pub use best::AccelerationCandidate;
use best::{BestCandidates, CandidateFamily};
use cheapest::{MassAndForces, cheapest_of_each_function};
use context::DerivationContext;
use hamel_algebra::graph::{Edge, Graph};
use hamel_language::functions::Needs;
use hamel_language::model::Model;
use hamel_language::syntax::ast::Axes;
use hamel_program::count::count;
use parts::{EquationTerms, ReferencePoint, TracingVariant, trace_terms};
use recursive::TreeRecursion;
use solve::{EliminationPlan, all_plans, constant_first, describe_order, solve};

/// Number of operations of the traced M and Γ ξ ξ below which all routes are tried, however long the tree is.
const MAX_TRACED_OPERATIONS: usize = 1000;

/// Returns the cheapest computation of ξ̇, and the cheapest computations of M and of the forces, which share the
/// graph of ξ̇.
pub fn forward_dynamics(
    model: &Model,
    numerical_loss: &NumericalLoss,
) -> Option<(AccelerationCandidate, MassAndForces)> {
    let mut best = BestCandidates::new(numerical_loss);
    let given = DerivationContext::in_given_velocities(model);
    if !model.constraints.is_empty() {
        return constrained(&given, numerical_loss);
    }
    let recursions = tree_recursions(&given, numerical_loss);
    for recursion in &recursions {
        recursion.search(&mut best);
    }
    let traced = || recursions.iter().map(TreeRecursion::mass_and_forces);
    if is_long(&given, &recursions) {
        let best = best.cheapest()?;
        let computed =
            cheapest_of_each_function(traced().collect(), &best.graph, model, numerical_loss)?;
        return Some((best, computed));
    }
    let mut computations = search(&given, &mut best)?;
    if model.n() <= MAX_SEARCHED_VELOCITIES
        && model.spans
        && let Some(twist) = DerivationContext::in_body_twist(model)
    {
        search(&twist, &mut best);
    }
    let expands = (model.spans || model.is_affine()) && model.accelerated.is_empty();
    if model.n() <= MAX_SEARCHED_VELOCITIES && expands && !numerical_loss.is_compared_first() {
        let most = best.min_operations();
        for candidate in polynomial::polynomial_candidates(model, most) {
            best.keep(CandidateFamily::Polynomial, candidate);
        }
    }
    let best = best.into_polished(model)?;
    computations.extend(traced());
    let computed = cheapest_of_each_function(computations, &best.graph, model, numerical_loss)?;
    Some((best, computed))
}

/// Returns the cheapest computations of M and of the forces of a model for which ξ̇ is not needed.
///
/// M may be singular here, and it is where some velocity has no inertia. Returns `None` for a model with
/// constraints, because their reduction inverts M, unless no requested function needs M.
pub fn mass_and_forces(model: &Model, numerical_loss: &NumericalLoss) -> Option<MassAndForces> {
    let given = DerivationContext::in_given_velocities(model);
    if !model.constraints.is_empty() {
        let variant = *tracing_variants(model, false).first()?;
        let unneeded = model.asked.needs() == Needs::Nothing;
        return unneeded.then(|| {
            let (Model { graph, .. }, parts) = trace(&given, variant);
            MassAndForces { graph, parts }
        });
    }
    let recursions = tree_recursions(&given, numerical_loss);
    let mut computations = Vec::new();
    if !is_long(&given, &recursions) {
        for variant in tracing_variants(model, model.n() <= MAX_SEARCHED_VELOCITIES) {
            let (Model { graph, .. }, parts) = trace(&given, variant);
            computations.push(MassAndForces { graph, parts });
        }
    }
    computations.extend(recursions.iter().map(TreeRecursion::mass_and_forces));
    cheapest_of_each_function(computations, &model.graph, model, numerical_loss)
}

/// Returns the recursions over links, one for each frame placement; empty if the bodies do not form a tree of
/// links.
pub fn tree_recursions(
    given: &DerivationContext,
    numerical_loss: &NumericalLoss,
) -> Vec<TreeRecursion> {
    let placements = numerical_loss.link_placements().iter();
    placements
        .filter_map(|&placement| TreeRecursion::of(given, placement, numerical_loss))
        .collect()
}

/// Returns whether the tree is so long that the recursions are certainly the cheapest route.
fn is_long(given: &DerivationContext, recursions: &[TreeRecursion]) -> bool {
    let Some(recursion) = recursions.first() else {
        return false;
    };
    // Planar mechanisms have cheap traced equations, so they count as short up to a larger number of links.
    let plain = |variant: &TracingVariant| {
        let (traced, parts) = trace(given, *variant);
        let roots = [parts.mass.concat(), parts.inertia].concat();
        count(&traced.graph, &roots).flops() < MAX_TRACED_OPERATIONS
    };
    let model = &given.model;
    let short = || !recursion.is_long() || tracing_variants(model, false).iter().any(plain);
    model.n() > MAX_SEARCHED_VELOCITIES || !short()
}

/// Returns the cheapest computation of ξ̇ and the multipliers of a model that keeps constraints.
fn constrained(
    context: &DerivationContext,
    numerical_loss: &NumericalLoss,
) -> Option<(AccelerationCandidate, MassAndForces)> {
    let n = context.model.n();
    let rows = inertia::constraint_rows(&context.model);
    let constraints = &context.model.constraints;
    let raising = dependent::regularization_rows(constraints, rows.len() - constraints.len());
    let raising = context.model.overconstrained.then_some(&raising[..]);
    let mut best: Option<(AccelerationCandidate, EquationTerms)> = None;
    for variant in tracing_variants(&context.model, n <= MAX_SEARCHED_VELOCITIES) {
        let (mut traced, parts) = trace(context, variant);
        let mut right = kkt::constraint_accelerations(&mut traced, &mut context.calculus.clone());
        right.extend(traced.accelerated.iter().map(|(_, rate)| *rate));
        let mut solved = parts.clone();
        if traced.augmented {
            let augmented =
                inertia::augment_mass_matrix(&mut traced.graph, &parts.mass, &rows, &right)?;
            solved.mass = augmented.0;
            solved.groups.push(augmented.1);
        }
        let orders = [
            (0..n).collect(),
            (0..n).rev().collect(),
            constant_first(&traced.graph, &solved),
        ];
        for order in orders {
            let mut graph = traced.graph.clone();
            let Some(factored) = kkt::factorize(&mut graph, &solved, &rows, &order, raising) else {
                continue;
            };
            let force: Vec<Edge> = (0..n)
                .map(|i| {
                    let column: Vec<Edge> = solved.groups.iter().map(|group| group[i]).collect();
                    graph.sum(&column)
                })
                .collect();
            let solution = factored.solve(&mut graph, &force, &right);
            let pivots = factored.pivots();
            let varying = |edge: &&Edge| !graph.is_free(edge.node());
            let mut roots = solution.xi_dot.clone();
            roots.extend(pivots.iter().filter(varying));
            let (count, depth) = (count(&graph, &roots), graph.depth(&roots));
            let loss = numerical_loss.loss(&graph, &solution.xi_dot, &pivots);
            let cost = (loss, count.weight(), depth);
            if best.as_ref().is_some_and(|(best, _)| best.cost() <= cost) {
                continue;
            }
            let route = format!(
                "{}, constraints by multipliers",
                describe_route(&traced, &order, &variant)
            );
            let projections = kkt::projections(&mut graph, &traced, &factored);
            let multipliers = match raising.filter(|_| traced.augmented) {
                None => solution.multipliers,
                Some(_) => {
                    let weight = inertia::augmentation_weight(&mut graph, &parts.mass, &rows)?;
                    kkt::unaugmented_multipliers(&mut graph, weight, (&rows, &right), &solution)
                }
            };
            let acceleration = AccelerationCandidate {
                other: None,
                graph,
                xi_dot: hybrid::insert_given_rates(&context.model, solution.xi_dot),
                pivots,
                twist: false,
                multipliers,
                projections: Some(projections),
                loss,
                count,
                depth,
                route,
            };
            best = Some((acceleration, parts.clone()));
        }
    }
    let (best, parts) = best?;
    let graph = best.graph.clone();
    Some((best, MassAndForces { graph, parts }))
}

/// Offers all candidates of a setting to `best` and returns the traced computations of M and the forces.
///
/// The computation that led to the cheapest candidate comes first; for models that are not small it is the only
/// one.
fn search(context: &DerivationContext, best: &mut BestCandidates) -> Option<Vec<MassAndForces>> {
    let family = |variant: &TracingVariant| CandidateFamily::Traced {
        twist: context.back.is_some(),
        axes: variant.axes,
    };
    let small = context.model.n() <= MAX_SEARCHED_VELOCITIES;
    let mut chosen: Option<(usize, TracingVariant)> = None;
    let mut computations = Vec::new();
    for variant in tracing_variants(&context.model, small) {
        let (traced, parts) = trace(context, variant);
        let before = chosen;
        let (traced, free) = hybrid::restrict_to_free(traced, &parts);
        for plan in first_plans(&traced.graph, &free, small) {
            if let Some(candidate) = candidate(context, &traced, &free, &plan, &variant) {
                let weight = candidate.count.weight();
                if chosen.is_none_or(|(least, _)| weight < least) {
                    chosen = Some((weight, variant));
                }
                best.keep(family(&variant), candidate);
            }
        }
        let graph = traced.graph;
        let place = if chosen == before {
            computations.len()
        } else {
            0
        };
        computations.insert(place, MassAndForces { graph, parts });
    }
    let (_, chosen) = chosen?;
    if small {
        for shift in [None, Some(0), Some(1), Some(2)] {
            let variant = TracingVariant { shift, ..chosen };
            let (traced, parts) = trace(context, variant);
            let (traced, free) = hybrid::restrict_to_free(traced, &parts);
            for plan in all_plans(&traced.graph, &free) {
                if let Some(candidate) = candidate(context, &traced, &free, &plan, &variant) {
                    best.keep(family(&variant), candidate);
                }
            }
        }
    }
    computations.truncate(if small { computations.len() } else { 1 });
    Some(computations)
}

fn tracing_variants(model: &Model, small: bool) -> Vec<TracingVariant> {
    let mut variants = Vec::new();
    for axes in [Axes::Body, Axes::World] {
        for reference in [ReferencePoint::Com, ReferencePoint::Origin] {
            variants.push(TracingVariant {
                axes,
                reference,
                shift: None,
            });
        }
    }
    if model.bodies.is_empty() {
        variants.truncate(1);
    } else if !small {
        variants.retain(|variant| variant.reference == ReferencePoint::Com);
    }
    variants
}

fn trace(context: &DerivationContext, variant: TracingVariant) -> (Model, EquationTerms) {
    let mut traced = context.model.clone();
    let parts = trace_terms(&mut traced, &mut context.calculus.clone(), variant);
    (traced, parts)
}

fn candidate(
    context: &DerivationContext,
    traced: &Model,
    parts: &EquationTerms,
    plan: &EliminationPlan,
    variant: &TracingVariant,
) -> Option<AccelerationCandidate> {
    let mut graph = traced.graph.clone();
    let solution = solve(&mut graph, parts, plan)?;
    let xi_dot = hybrid::expand_rates(&context.model, solution.xi_dot);
    let xi_dot = context.to_given_velocities(&mut graph, xi_dot);
    let pivots = hybrid::expand_pivots(&context.model, solution.pivots);
    let mut roots = xi_dot.clone();
    roots.extend(pivots.iter().filter(|pivot| !graph.is_free(pivot.node())));
    let (count, depth) = (count(&graph, &roots), graph.depth(&roots));
    let mut route = describe_route(traced, &plan.order, variant);
    if context.back.is_some() {
        route = route.replacen("traced", "traced in its own twist", 1);
    }
    Some(AccelerationCandidate {
        other: None,
        graph,
        xi_dot,
        pivots,
        twist: context.back.is_some(),
        multipliers: Vec::new(),
        projections: None,
        loss: 0,
        count,
        depth,
        route,
    })
}

/// Describes in words what is traced and in which order velocities are eliminated.
fn describe_route(traced: &Model, order: &[usize], variant: &TracingVariant) -> String {
    let axes = match variant.axes {
        Axes::Body => "body",
        Axes::World => "world",
    };
    let point = match variant.reference {
        ReferencePoint::Com => "centres of mass",
        ReferencePoint::Origin => "frame origins",
    };
    let order = describe_order(traced, order);
    if traced.bodies.is_empty() {
        format!("masses traced, {order}")
    } else {
        format!("bodies traced about their {point} in {axes} axes, {order}")
    }
}

/// Returns the few plans that are used to choose what to trace.
fn first_plans(graph: &Graph, parts: &EquationTerms, small: bool) -> Vec<EliminationPlan> {
    let n = parts.mass.len();
    let order: Vec<usize> = (0..n).collect();
    let mut plans = vec![EliminationPlan {
        order: constant_first(graph, parts),
        apart: 0,
        scale: false,
        inverse: false,
    }];
    if small && n > 3 {
        plans.push(EliminationPlan {
            order,
            apart: 3,
            scale: false,
            inverse: false,
        });
    }
    plans
}
