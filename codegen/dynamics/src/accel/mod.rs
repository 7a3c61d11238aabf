//! ξ̇ from M ξ̇ + Γ ξ ξ + ∂V = f, KR18 (30c), by the cheapest of several routes.
//!
//! Routes differ in what they trace (bodies in some axes about some point, or the polynomials of
//! Γ ξ ξ) and in how they solve. Every candidate is built in a graph of its own and counted
//! exactly; the cheapest is kept.

pub(super) mod best;
pub mod branches;
pub mod cheapest;
mod dependent;
pub(super) mod hybrid;
pub mod parts;
pub mod polynomial;
pub mod recursive;
pub mod saddle;
pub mod setting;
pub mod solve;

use crate::care::Care;
use crate::inertia;
pub use best::Acceleration;
use best::{Best, Family};
use cheapest::{Computation, cheapest};
use hamel_algebra::graph::{Edge, Graph};
use hamel_language::functions::Needs;
use hamel_language::model::Model;
use hamel_language::syntax::ast::Axes;
use hamel_program::count::count;
use parts::{Parts, Reference, Variant, parts};
use recursive::Recursion;
use setting::Setting;
use solve::{Plan, solve};

/// Models with more velocities than this get one route and one order of elimination.
const SMALL: usize = 8;

/// Trees whose M and Γ ξ ξ take fewer operations as they are traced get all routes, however long they are.
const FEW: usize = 1000;

/// Graphs with more nodes get two orders of elimination and no further plans.
const LARGE: usize = 3000;

/// The cheapest computation of ξ̇; M and the forces as each is cheapest, in a graph where ξ̇ is, too.
pub fn accel(model: &Model, care: &Care) -> Option<(Acceleration, Computation)> {
    let mut best = Best::new(care);
    let given = Setting::given(model);
    if !model.constraints.is_empty() {
        return constrained(&given, care);
    }
    let recursions = recursions(&given, care);
    for recursion in &recursions {
        recursion.search(&mut best);
    }
    let traced = || recursions.iter().map(Recursion::parts);
    if is_long(&given, &recursions) {
        let best = best.cheapest()?;
        let computed = cheapest(traced().collect(), &best.graph, model, care)?;
        return Some((best, computed));
    }
    let mut computations = search(&given, &mut best)?;
    if model.n() <= SMALL
        && model.spans
        && let Some(twist) = Setting::twist(model)
    {
        search(&twist, &mut best);
    }
    let expands = (model.spans || model.is_affine()) && model.accelerated.is_empty();
    if model.n() <= SMALL && expands && !care.is_taken() {
        let most = best.least();
        for candidate in polynomial::candidates(model, most) {
            best.keep(Family::Polynomial, candidate);
        }
    }
    let best = best.polished(model)?;
    computations.extend(traced());
    let computed = cheapest(computations, &best.graph, model, care)?;
    Some((best, computed))
}

/// M and the forces as each is cheapest, where ξ̇ is not wanted: M may be singular, and has to be where
/// some velocity has no inertia. `None` with constraints, whose reduction inverts M, unless nothing is wanted that has to do
/// with M.
pub fn forces(model: &Model, care: &Care) -> Option<Computation> {
    let given = Setting::given(model);
    if !model.constraints.is_empty() {
        let variant = *variants(model, false).first()?;
        let unneeded = model.asked.needs() == Needs::Nothing;
        return unneeded.then(|| {
            let (Model { graph, .. }, parts) = trace(&given, variant);
            Computation { graph, parts }
        });
    }
    let recursions = recursions(&given, care);
    let mut computations = Vec::new();
    if !is_long(&given, &recursions) {
        for variant in variants(model, model.n() <= SMALL) {
            let (Model { graph, .. }, parts) = trace(&given, variant);
            computations.push(Computation { graph, parts });
        }
    }
    computations.extend(recursions.iter().map(Recursion::parts));
    cheapest(computations, &model.graph, model, care)
}

/// The recursions over links, where bodies are a tree of them.
pub fn recursions(given: &Setting, care: &Care) -> Vec<Recursion> {
    let placements = care.placements().iter();
    placements
        .filter_map(|&placement| Recursion::of(given, placement, care))
        .collect()
}

/// Whether the tree is so long that the recursions are certainly cheapest.
fn is_long(given: &Setting, recursions: &[Recursion]) -> bool {
    let Some(recursion) = recursions.first() else {
        return false;
    };
    // What moves in a plane is short for longer.
    let plain = |variant: &Variant| {
        let (traced, parts) = trace(given, *variant);
        let roots = [parts.mass.concat(), parts.inertia].concat();
        count(&traced.graph, &roots).flops() < FEW
    };
    let model = &given.model;
    let short = || !recursion.is_long() || variants(model, false).iter().any(plain);
    model.n() > SMALL || !short()
}

/// The cheapest computation with multipliers.
fn constrained(setting: &Setting, care: &Care) -> Option<(Acceleration, Computation)> {
    let n = setting.model.n();
    let rows = hybrid::rows(&setting.model);
    let constraints = &setting.model.constraints;
    let raising = dependent::raising(constraints, rows.len() - constraints.len());
    let raising = setting.model.overconstrained.then_some(&raising[..]);
    let mut best: Option<(Acceleration, Parts)> = None;
    for variant in variants(&setting.model, n <= SMALL) {
        let (mut traced, parts) = trace(setting, variant);
        let mut right = saddle::right_side(&mut traced, &mut setting.calculus.clone());
        right.extend(traced.accelerated.iter().map(|(_, rate)| *rate));
        let mut solved = parts.clone();
        if traced.augmented {
            let augmented = inertia::augmented(&mut traced.graph, &parts.mass, &rows, &right)?;
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
            let Some(factored) = saddle::factored(&mut graph, &solved, &rows, &order, raising)
            else {
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
            let loss = care.loss(&graph, &solution.xi_dot, &pivots);
            let cost = (loss, count.weight(), depth);
            if best.as_ref().is_some_and(|(best, _)| best.cost() <= cost) {
                continue;
            }
            let route = format!(
                "{}, constraints by multipliers",
                route(&traced, &order, &variant)
            );
            let projections = saddle::projections(&mut graph, &traced, &factored);
            let multipliers = match raising.filter(|_| traced.augmented) {
                None => solution.multipliers,
                Some(_) => {
                    let weight = inertia::weight(&mut graph, &parts.mass, &rows)?;
                    saddle::plain(&mut graph, weight, (&rows, &right), &solution)
                }
            };
            let acceleration = Acceleration {
                other: None,
                graph,
                xi_dot: hybrid::exact(&setting.model, solution.xi_dot),
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
    Some((best, Computation { graph, parts }))
}

/// Counts the candidates of a setting; what was traced, that of the best of them first, and for systems
/// that are not small alone.
fn search(setting: &Setting, best: &mut Best) -> Option<Vec<Computation>> {
    let family = |variant: &Variant| Family::Traced {
        twist: setting.back.is_some(),
        axes: variant.axes,
    };
    let small = setting.model.n() <= SMALL;
    let mut chosen: Option<(usize, Variant)> = None;
    let mut computations = Vec::new();
    for variant in variants(&setting.model, small) {
        let (traced, parts) = trace(setting, variant);
        let before = chosen;
        let (traced, free) = hybrid::free(traced, &parts);
        for plan in first_plans(&traced.graph, &free, small) {
            if let Some(candidate) = attempt(setting, &traced, &free, &plan, &variant) {
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
        computations.insert(place, Computation { graph, parts });
    }
    let (_, chosen) = chosen?;
    if small {
        for shift in [None, Some(0), Some(1), Some(2)] {
            let variant = Variant { shift, ..chosen };
            let (traced, parts) = trace(setting, variant);
            let (traced, free) = hybrid::free(traced, &parts);
            for plan in all_plans(&traced.graph, &free) {
                if let Some(candidate) = attempt(setting, &traced, &free, &plan, &variant) {
                    best.keep(family(&variant), candidate);
                }
            }
        }
    }
    computations.truncate(if small { computations.len() } else { 1 });
    Some(computations)
}

fn variants(model: &Model, small: bool) -> Vec<Variant> {
    let mut variants = Vec::new();
    for axes in [Axes::Body, Axes::World] {
        for reference in [Reference::Com, Reference::Origin] {
            variants.push(Variant {
                axes,
                reference,
                shift: None,
            });
        }
    }
    if model.bodies.is_empty() {
        variants.truncate(1);
    } else if !small {
        variants.retain(|variant| variant.reference == Reference::Com);
    }
    variants
}

fn trace(setting: &Setting, variant: Variant) -> (Model, Parts) {
    let mut traced = setting.model.clone();
    let parts = parts(&mut traced, &mut setting.calculus.clone(), variant);
    (traced, parts)
}

fn attempt(
    setting: &Setting,
    traced: &Model,
    parts: &Parts,
    plan: &Plan,
    variant: &Variant,
) -> Option<Acceleration> {
    let mut graph = traced.graph.clone();
    let solution = solve(&mut graph, parts, plan)?;
    let xi_dot = hybrid::all_rates(&setting.model, solution.xi_dot);
    let xi_dot = setting.leave(&mut graph, xi_dot);
    let pivots = hybrid::pivots(&setting.model, solution.pivots);
    let mut roots = xi_dot.clone();
    roots.extend(pivots.iter().filter(|pivot| !graph.is_free(pivot.node())));
    let (count, depth) = (count(&graph, &roots), graph.depth(&roots));
    let mut route = route(traced, &plan.order, variant);
    if setting.back.is_some() {
        route = route.replacen("traced", "traced in its own twist", 1);
    }
    Some(Acceleration {
        other: None,
        graph,
        xi_dot,
        pivots,
        twist: setting.back.is_some(),
        multipliers: Vec::new(),
        projections: None,
        loss: 0,
        count,
        depth,
        route,
    })
}

/// What is traced and eliminated, in words.
fn route(traced: &Model, order: &[usize], variant: &Variant) -> String {
    let axes = match variant.axes {
        Axes::Body => "body",
        Axes::World => "world",
    };
    let point = match variant.reference {
        Reference::Com => "centres of mass",
        Reference::Origin => "frame origins",
    };
    let order = elimination(traced, order);
    if traced.bodies.is_empty() {
        format!("masses traced, {order}")
    } else {
        format!("bodies traced about their {point} in {axes} axes, {order}")
    }
}

/// The order of elimination in words.
fn elimination(model: &Model, order: &[usize]) -> String {
    if order.windows(2).all(|pair| pair[0] < pair[1]) {
        return "velocities eliminated in their order".into();
    }
    let name = |i: &usize| {
        model
            .graph
            .symbols()
            .iter()
            .find(|s| s.node == model.xi[*i].node())
            .map_or("", |s| s.name.as_str())
    };
    let names: Vec<String> = order.iter().map(|i| format!("`{}`", name(i))).collect();
    format!("velocities eliminated in the order {}", names.join(", "))
}

/// Few plans, to choose what to trace.
fn first_plans(graph: &Graph, parts: &Parts, small: bool) -> Vec<Plan> {
    let n = parts.mass.len();
    let order: Vec<usize> = (0..n).collect();
    let mut plans = vec![Plan {
        order: constant_first(graph, parts),
        apart: 0,
        scale: false,
        inverse: false,
    }];
    if small && n > 3 {
        plans.push(Plan {
            order,
            apart: 3,
            scale: false,
            inverse: false,
        });
    }
    plans
}

/// All plans worth counting for a small system.
pub(crate) fn all_plans(graph: &Graph, parts: &Parts) -> Vec<Plan> {
    let n = parts.mass.len();
    if graph.len() > LARGE {
        return [(0..n).collect(), (0..n).rev().collect()]
            .map(|order| Plan {
                order,
                apart: 0,
                scale: false,
                inverse: false,
            })
            .to_vec();
    }
    // A constant M is factored when parameters are set: its order of elimination costs nothing.
    let constant = parts
        .mass
        .iter()
        .flatten()
        .all(|edge| graph.is_free(edge.node()));
    let mut orders: Vec<Vec<usize>> = match constant {
        true => vec![(0..n).collect()],
        false => vec![
            (0..n).collect(),
            (0..n).rev().collect(),
            constant_first(graph, parts),
        ],
    };
    orders.sort();
    orders.dedup();
    // Bodies come with three linear velocities first; else all or nothing.
    let mut aparts = if parts.groups.len() > 1 {
        vec![0, 3.min(n), n]
    } else {
        vec![0]
    };
    aparts.dedup();
    let mut plans = Vec::new();
    for order in orders {
        for &apart in &aparts {
            for scale in [false, true] {
                for inverse in [false, true] {
                    if apart < n || !(scale || inverse) {
                        plans.push(Plan {
                            order: order.clone(),
                            apart,
                            scale,
                            inverse,
                        });
                    }
                }
            }
        }
    }
    plans
}

/// Velocities with constant inertia first, others in their order.
fn constant_first(graph: &Graph, parts: &Parts) -> Vec<usize> {
    let constant = |i: &usize| graph.is_free(parts.mass[*i][*i].node());
    let (first, last): (Vec<usize>, Vec<usize>) = (0..parts.mass.len()).partition(constant);
    first.into_iter().chain(last).collect()
}
