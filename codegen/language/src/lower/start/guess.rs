//! Guesses, `start q ~ 1.2;`: checks what they are about, and finds the start that is nearest to them.

use super::Start;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::nearest_solution::find_nearest;
use crate::diagnostics::{Diagnostic, Report};
use crate::lower::declare::Declared;
use crate::lower::rate::Kinematics;
use crate::lower::reader::Dynamics;
use crate::lower::time;
use crate::model::Frame;
use crate::model::closest::Constraints;
use crate::model::layout::{Block, constraint};
use crate::model::twists::KinematicExpressions;
use crate::syntax::ast::{ExprKind, ItemKind, Span, System, Target};
use crate::syntax::written::target as written;

/// Returns the targets of all guesses.
fn guesses(system: &System) -> impl Iterator<Item = &Target> {
    system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Guess { target, .. } => Some(target),
        _ => None,
    })
}

/// Reports guesses of coordinates and velocities that are not solved for.
pub fn check(system: &System, declared: &Declared, report: &mut Report) {
    for target in guesses(system) {
        let name = target.name.name.as_str();
        let velocity = declared.velocities.iter().any(|group| group.name == name);
        if !velocity && !declared.coordinates.iter().any(|c| c.name == name) {
            continue;
        }
        if let Some((why, help, place)) = fixed(system, target, velocity) {
            let message = format!(
                "the start of `{}` cannot be a guess: {why}",
                written(target)
            );
            let error = Diagnostic::new(target.span(), message).help(help);
            report.push(match place {
                Some((span, what)) => error.note(span, what),
                None => error,
            });
        }
    }
}

/// Why a coordinate or velocity is not solved for, what to do, and where that is stated.
type Fixed = (String, String, Option<(Span, &'static str)>);

fn fixed(system: &System, guess: &Target, velocity: bool) -> Option<Fixed> {
    let name = guess.name.name.as_str();
    if time::name(system).is_some_and(|time| time.name == name) {
        let help = format!("write `start {name} = …;`");
        return Some(("it is the time".into(), help, None));
    }
    let mut constrained = false;
    for item in &system.items {
        match &item.kind {
            ItemKind::Prescribe {
                target,
                rate: false,
                ..
            } if target.overlaps(guess) => {
                let place = Some((target.span(), "prescribed here"));
                let help = "remove the guess: its start follows from its motion";
                return Some(("its motion is prescribed".into(), help.into(), place));
            }
            ItemKind::Inactive(list) => {
                let found = list.iter().find(|expr| match &expr.kind {
                    ExprKind::Name(inactive) => inactive == name,
                    _ => false,
                });
                if let Some(expr) = found {
                    let place = Some((expr.span, "inactive by this statement"));
                    let help = "remove the guess: the velocity stays 0";
                    return Some(("it is inactive".into(), help.into(), place));
                }
                constrained |= velocity;
            }
            ItemKind::Loop { .. } | ItemKind::Prescribe { rate: false, .. } => constrained = true,
            ItemKind::Constraint { .. } => constrained |= !velocity,
            ItemKind::Nonholonomic { .. } => constrained |= velocity,
            _ => {}
        }
    }
    let help = format!("write `start {name} = …;`");
    (!constrained).then(|| {
        (
            "no constraint acts on it, so its start is exact".into(),
            help,
            None,
        )
    })
}

/// Returns the x nearest to a start and its guesses that satisfies the user's constraints, in the metric of the
/// coordinates; entries with an exact start keep it. Returns `None` if no solution was found.
pub fn assembled(
    graph: &mut Graph,
    rows: &[Edge],
    blocks: &[Block],
    (first, x): (usize, &[Edge]),
    numbers: &[f64],
    start: &Start,
) -> Option<Vec<f64>> {
    let mut phi = rows.to_vec();
    let mut place = 0;
    for &block in blocks {
        let entries = &x[place..place + block.len()];
        phi.extend(
            constraint(graph, block, entries, "")
                .into_iter()
                .map(|(edge, _)| edge),
        );
        place += block.len();
    }
    let kept = |alpha: &usize| start.given_x[*alpha].is_some();
    let problem = Constraints {
        graph,
        phi,
        first,
        numbers,
        blocks,
        guess: &start.x,
        given: (0..start.x.len()).filter(kept).collect(),
        sizes: Vec::new(),
    }
    .measured();
    let mut found = find_nearest(&problem, &start.x)?;
    for &alpha in &problem.given {
        found[alpha] = start.x[alpha];
    }
    Some(found)
}

/// Returns M at a configuration, with the values of the start for all other symbols.
pub fn mass(
    graph: &Graph,
    (frames, dynamics): (&[Frame], &Dynamics),
    (declared, kinematics): (&Declared, &Kinematics),
    numbers: &[f64],
    x: &[f64],
) -> Vec<Vec<f64>> {
    let first = 1 + declared.params.iter().map(|group| group.len).sum::<usize>();
    let moving = KinematicExpressions {
        graph,
        a: &kinematics.a,
        first,
        velocity: first + declared.x.len(),
        n: declared.xi.len(),
    };
    let mut numbers = numbers.to_vec();
    numbers[first..first + x.len()].copy_from_slice(x);
    let inertia = (
        &dynamics.bodies[..],
        &dynamics.particles[..],
        dynamics.kinetic,
    );
    moving.mass(frames, inertia, &numbers)
}
