//! Warns of legal input that cannot be meant: inertias that no body has, a start beyond a joint's limits, loads that
//! never do work. All of this is checked numerically, at the start and at some other states.

use crate::algebra::graph::Edge;
use crate::algebra::numeric::evaluate;
use crate::diagnostics::Diagnostic;
use crate::model::states::states;
use crate::model::twists::{KinematicExpressions, Placed, apply, back, cross, dot};
use crate::model::{Model, Wrench};
use crate::syntax::ast::{self, Axes, Ident, ItemKind, Span, System};

/// Relative size below which a number counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Returns warnings about a description that is correct, in the order of the text.
pub fn plausibility_warnings(system: &System, model: &Model) -> Vec<Diagnostic> {
    let wanted = |item: &ast::Item| matches!(item.kind, ItemKind::Body(_) | ItemKind::Load { .. });
    let mut warnings = limits(system, model);
    if !system.items.iter().any(wanted) || model.defaults.iter().any(|number| number.is_nan()) {
        return warnings;
    }
    let seen = Seen::new(model);
    let (mut bodies, mut wrenches) = (0, 0);
    for item in &system.items {
        warnings.extend(match &item.kind {
            ItemKind::Body(body) => {
                bodies += 1;
                seen.body(bodies - 1, body, item.span)
            }
            ItemKind::Load { frame, from, .. } => {
                let count = 1 + usize::from(from.as_ref().is_some_and(|f| f.name != "world"));
                wrenches += count;
                let load = model.elements.wrenches.get(wrenches - count..wrenches);
                load.and_then(|load| seen.load(load, frame, item.span))
            }
            _ => None,
        });
    }
    warnings
}

/// Warns of joints that start beyond their limits.
fn limits(system: &System, model: &Model) -> Vec<Diagnostic> {
    let joints = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Joint(joint) => Some(&joint.name),
        _ => None,
    });
    let mut warnings = Vec::new();
    for (joint, name) in model.joints.iter().zip(joints) {
        let (Some([low, high]), [coordinate]) = (joint.limit, &joint.coordinates[..]) else {
            continue;
        };
        let Some(place) = model.coordinates.iter().find(|c| c.name == *coordinate) else {
            continue;
        };
        let start = model.start_x[place.offset];
        let room = ROUNDING * (1.0 + low.abs().max(high.abs()));
        if start >= low - room && start <= high + room {
            continue;
        }
        let given = system.items.iter().find_map(|item| match &item.kind {
            ItemKind::Start { target, .. } | ItemKind::Guess { target, .. } => {
                (target.name.name == *coordinate).then_some(item.span)
            }
            _ => None,
        });
        let message =
            format!("the start of `{coordinate}` is {start}, beyond its limits {low} to {high}");
        warnings.push(
            Diagnostic::new(given.unwrap_or(name.span), message).help(format!(
                "write `start {coordinate} = …;` with a value between them"
            )),
        );
    }
    warnings
}

/// A system at some states, with the motion of its frames.
struct Seen<'a> {
    model: &'a Model,
    states: Vec<(Vec<f64>, Vec<Placed>)>,
}

impl<'a> Seen<'a> {
    fn new(model: &'a Model) -> Self {
        let moving = KinematicExpressions {
            graph: &model.graph,
            a: &model.a,
            first: model.points.first,
            velocity: model.points.first + model.nu(),
            n: model.n(),
        };
        // Constraints are dropped, so that states with open loops count, too.
        let mut free = model.clone();
        free.constraints.clear();
        let at = |numbers: Vec<f64>| {
            let frames = moving.frames(&model.frames, &numbers);
            (numbers, frames)
        };
        let states = states(&free).into_iter().map(at).collect();
        Seen { model, states }
    }

    fn body(&self, index: usize, text: &ast::Body, span: Span) -> Option<Diagnostic> {
        let body = self.model.bodies.get(index)?;
        let (numbers, _) = self.states.first()?;
        let mut entries = vec![body.mass];
        entries.extend(body.inertia_com.concat());
        let values = evaluate(&self.model.graph, &entries, numbers);
        if values.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let with = match self.model.graph.class(body.mass.node()) {
            0 => "",
            _ => ", with the default parameters",
        };
        if values[0] < 0.0 {
            let place = text.mass.as_ref().map_or(span, |mass| mass.span);
            let message = format!("the mass of this body is negative{with}: {}", values[0]);
            return Some(Diagnostic::new(place, message).help("a mass is a positive number (kg)"));
        }
        let inertia: [[f64; 3]; 3] =
            std::array::from_fn(|i| std::array::from_fn(|j| values[1 + 3 * i + j]));
        let spins = self.states.iter().flat_map(|(_, frames)| {
            let frame = &frames[body.frame];
            frame
                .twists
                .iter()
                .map(|twist| back(&frame.rotation, twist.spin))
        });
        let axes = Turns::of(spins);
        let place = text
            .inertia
            .as_ref()
            .map_or(span, |(inertia, _)| inertia.span);
        let varies = entries[1..]
            .iter()
            .any(|e| self.model.graph.class(e.node()) != 0);
        let with = if varies {
            ", with the default parameters"
        } else {
            ""
        };
        let (message, help) = match axes {
            Turns::None => return None,
            // For a body that turns about one axis, only the moment about that axis matters.
            Turns::One(axis) => {
                let moment = dot(&axis, &apply(&inertia, axis));
                let positive = moment >= -ROUNDING * largest(&inertia);
                let message =
                    "the moment of inertia about the axis that this body turns about is negative";
                (!positive).then_some((
                    message,
                    "about its centre of mass it is at least 0: check the numbers, and `about`",
                ))?
            }
            Turns::Several => {
                let trace = inertia[0][0] + inertia[1][1] + inertia[2][2];
                let second = std::array::from_fn(|i| {
                    std::array::from_fn(|j| f64::from(i == j) * trace / 2.0 - inertia[i][j])
                });
                if !not_negative(&inertia) {
                    (
                        "the inertia of this body is not positive",
                        "about its centre of mass no moment is negative: check the numbers, and `about`",
                    )
                } else if !not_negative(&second) && !is_rotor(&inertia) {
                    (
                        "the inertia of this body violates the triangle inequality",
                        "no principal moment about the centre of mass may be larger than the sum of the other two: check the numbers, and `about`",
                    )
                } else {
                    return None;
                }
            }
        };
        Some(Diagnostic::new(place, format!("{message}{with}")).help(help))
    }

    /// Warns of a load whose virtual work is 0 in every state, though the load itself is not 0.
    fn load(&self, wrenches: &[Wrench], frame: &Ident, span: Span) -> Option<Diagnostic> {
        let mut size = 0.0;
        let mut work = 0.0;
        for (numbers, frames) in &self.states {
            let mut all = vec![0.0; self.model.n()];
            for wrench in wrenches {
                let entries: Vec<Edge> = [wrench.force, wrench.torque, wrench.at].concat();
                let values = evaluate(&self.model.graph, &entries, numbers);
                let placed = &frames[wrench.frame];
                let part = |k: usize| [values[k], values[k + 1], values[k + 2]];
                let world = |a: [f64; 3]| match wrench.axes {
                    Axes::World => a,
                    Axes::Body => apply(&placed.rotation, a),
                };
                let (force, torque) = (world(part(0)), world(part(3)));
                let arm = apply(&placed.rotation, part(6));
                for (sum, twist) in all.iter_mut().zip(&placed.twists) {
                    let turning = cross(twist.spin, arm);
                    let speed: [f64; 3] = std::array::from_fn(|k| twist.speed[k] + turning[k]);
                    *sum += dot(&force, &speed) + dot(&torque, &twist.spin);
                }
                size += [force, torque]
                    .concat()
                    .iter()
                    .map(|v| v.abs())
                    .sum::<f64>();
            }
            work += all.iter().map(|v| v.abs()).sum::<f64>();
        }
        // With NaN nothing is known.
        if !(size > 0.0 && work <= ROUNDING * size) {
            return None;
        }
        let message = format!(
            "this load can never do work: no motion of `{}` has a component along it",
            frame.name
        );
        Some(Diagnostic::new(span, message).help("check its frame, its axes and its direction"))
    }
}

/// The axes about which a body turns, in its own axes.
enum Turns {
    None,
    One([f64; 3]),
    Several,
}

impl Turns {
    fn of(spins: impl Iterator<Item = [f64; 3]>) -> Turns {
        let mut axis: Option<[f64; 3]> = None;
        for spin in spins {
            let length = dot(&spin, &spin).sqrt();
            if length.is_nan() || length <= ROUNDING {
                continue;
            }
            let unit = spin.map(|entry| entry / length);
            match axis {
                None => axis = Some(unit),
                Some(axis) => {
                    let across = cross(axis, unit);
                    if dot(&across, &across) > ROUNDING {
                        return Turns::Several;
                    }
                }
            }
        }
        axis.map_or(Turns::None, Turns::One)
    }
}

/// Returns whether there is a moment about one axis alone, as for a wheel or drum whose other moments are left out.
fn is_rotor(m: &[[f64; 3]; 3]) -> bool {
    let size = largest(m);
    let pairs = [(0, 1), (0, 2), (1, 2)];
    let minor =
        |(i, j): (usize, usize), (k, l): (usize, usize)| m[i][k] * m[j][l] - m[i][l] * m[j][k];
    let mut minors = pairs
        .iter()
        .flat_map(|&a| pairs.iter().map(move |&b| (a, b)));
    minors.all(|(a, b)| minor(a, b).abs() <= ROUNDING * size * size)
}

fn largest(m: &[[f64; 3]; 3]) -> f64 {
    m.concat()
        .iter()
        .fold(0.0, |most, entry| most.max(entry.abs()))
}

/// Returns whether a symmetric matrix has no negative eigenvalue, up to rounding: no principal minor is negative.
fn not_negative(m: &[[f64; 3]; 3]) -> bool {
    let size = largest(m);
    let second = |i: usize, j: usize| m[i][i] * m[j][j] - m[i][j] * m[j][i];
    let minors = [second(0, 1), second(0, 2), second(1, 2)];
    let third = dot(&m[0], &cross(m[1], m[2]));
    (0..3).all(|i| m[i][i] >= -ROUNDING * size)
        && minors.iter().all(|minor| *minor >= -ROUNDING * size * size)
        && third >= -ROUNDING * size * size * size
}
