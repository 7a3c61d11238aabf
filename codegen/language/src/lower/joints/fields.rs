//! The fields in the braces of a joint: which kinds may have which, numeric limits, armatures.

use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::evaluate;
use crate::diagnostics::{Diagnostic, Report};
use crate::lower::declare::Declared;
use crate::lower::expression::Evaluator;
use crate::lower::reader::Dynamics;
use crate::lower::scope::Scope;
use crate::model::class;
use crate::syntax::ast::{Expr, ItemKind, Joint, JointField, JointKind, System};
use crate::syntax::{joint_field, joint_kind};
use JointField::{Armature, Damping, Force, Limit, MaxForce, MaxSpeed, Rest, Stiffness};
use num_traits::Signed;

/// Returns the fields that a joint may have, and why it may have no others.
fn allowed(joint: &Joint) -> (&'static [JointField], &'static str) {
    const OWN: &str = "a joint that follows others takes no force: give damping, armature and force to the joint that it follows";
    const CIRCLE: &str = "a continuous joint has no limits: use `revolute` for a joint with limits";
    const FOLLOWING: &str = "a continuous joint that follows others has no angle: use `revolute`, or give the spring to the joint that it follows";
    const SEVERAL: &str = "it has several velocities: write `damper coefficient d on …;`, `spring …` or `generalized force … = …;` with the names of its coordinates and velocities";
    match joint.kind.0 {
        JointKind::Fixed => (&[], "a fixed joint does not move"),
        JointKind::Revolute | JointKind::Prismatic if joint.follows.is_some() => {
            (&[Stiffness, Rest, Limit, MaxSpeed, MaxForce], OWN)
        }
        JointKind::Continuous if joint.follows.is_some() => (&[MaxSpeed, MaxForce], FOLLOWING),
        JointKind::Revolute | JointKind::Prismatic => (
            &[
                Damping, Armature, Stiffness, Rest, Force, Limit, MaxSpeed, MaxForce,
            ],
            "",
        ),
        JointKind::Continuous => (
            &[
                Damping, Armature, Stiffness, Rest, Force, MaxSpeed, MaxForce,
            ],
            CIRCLE,
        ),
        JointKind::Spherical | JointKind::SphericalS3 => {
            (&[Damping, Force, MaxSpeed, MaxForce], SEVERAL)
        }
        JointKind::Universal => (&[Damping], SEVERAL),
        JointKind::Free | JointKind::Planar | JointKind::Cylindrical => (&[], SEVERAL),
    }
}

/// Returns whether a field takes part; a field that the kind cannot have is ignored.
pub(super) fn has(joint: &Joint, field: JointField) -> bool {
    allowed(joint).0.contains(&field)
}

/// Reports fields that the joint cannot have, and joints of kinds that cannot follow others.
pub(super) fn check(joint: &Joint, report: &mut Report) {
    let (kind, place) = joint.kind;
    let single = [
        JointKind::Revolute,
        JointKind::Continuous,
        JointKind::Prismatic,
    ];
    if let (Some(value), false) = (&joint.follows, single.contains(&kind)) {
        let message = format!("a {} joint cannot follow", joint_kind(kind));
        report.push(
            Diagnostic::new(value.span, message)
                .help("a joint that follows has one degree of freedom: `revolute`, `continuous` or `prismatic`; write what moves by another law as a `frame`")
                .note(place, "its kind"),
        );
    }
    let (known, why) = allowed(joint);
    for (field, span, _) in &joint.fields {
        let name = joint_field(*field);
        if !known.contains(field) {
            let message = format!("this {} joint cannot have `{name}`", joint_kind(kind));
            report.push(Diagnostic::new(*span, message).help(why));
        }
    }
    let given = |wanted| joint.fields.iter().find(|(field, ..)| *field == wanted);
    if let (Some((_, span, _)), None) = (given(Rest), given(Stiffness)) {
        report.push(
            Diagnostic::new(*span, "this joint has `rest` without a spring")
                .help("add `stiffness k;`"),
        );
    }
}

/// Returns the expressions of a field, if the joint may have it.
fn values(joint: &Joint, wanted: JointField) -> Option<&[Expr]> {
    let field = joint.fields.iter().find(|(field, ..)| *field == wanted)?;
    has(joint, wanted).then_some(field.2.as_slice())
}

/// Returns the values of a field that is documented in the generated code.
pub(super) fn numbers(
    joint: &Joint,
    field: JointField,
    graph: &mut Graph,
    scope: &Scope,
    report: &mut Report,
) -> Option<Vec<f64>> {
    let what = match field {
        Limit => "a limit of a joint",
        MaxSpeed => "the largest speed of a joint",
        _ => "the largest force of a joint",
    };
    let mut list = Vec::new();
    let mut complete = true;
    let values = values(joint, field)?;
    for expr in values {
        let mut evaluator = Evaluator::new(graph, scope, report);
        let Some(edge) = evaluator.scalar(expr) else {
            complete = false;
            continue;
        };
        let number = number(graph, edge);
        match number.filter(|&number| field == Limit || number >= 0.0) {
            Some(number) => list.push(number),
            None => {
                complete = false;
                let message = match number {
                    Some(_) => format!("{what} cannot be negative"),
                    None => format!("{what} has to be a finite number"),
                };
                report.push(Diagnostic::new(expr.span, message).help(
                    "make it of numbers and constants: it is a constant in the generated code",
                ));
            }
        }
    }
    if let ([lower, upper], [first, last]) = (list.as_slice(), values)
        && lower > upper
    {
        report.push(
            Diagnostic::new(
                first.span.to(last.span),
                format!("no value is between {lower} and {upper}"),
            )
            .help("write the smaller limit first: `limit LOWER to UPPER;`"),
        );
    }
    complete.then_some(list)
}

/// Evaluates an expression of numbers and constants.
pub(super) fn number(graph: &Graph, edge: Edge) -> Option<f64> {
    if graph.class(edge.node()) != 0 {
        return None;
    }
    let mut symbols = vec![f64::NAN; graph.symbols().len()];
    if let Some(first) = symbols.first_mut() {
        *first = std::f64::consts::PI;
    }
    let value = evaluate(graph, &[edge], &symbols).first().copied();
    value.filter(|value| value.is_finite())
}

/// Returns the armature J of every velocity, and adds ½ J ξⁱ² to the kinetic energy.
pub(crate) fn armature(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    dynamics: &mut Dynamics,
    report: &mut Report,
) -> Vec<Edge> {
    let mut all = vec![graph.zero(); declared.xi.len()];
    for item in &system.items {
        let ItemKind::Joint(joint) = &item.kind else {
            continue;
        };
        let Some([expr]) = values(joint, Armature) else {
            continue;
        };
        let mut evaluator = Evaluator::new(graph, scope, report);
        let Some(inertia) = evaluator.scalar(expr) else {
            continue;
        };
        let error = if graph.class(inertia.node()) & !class::PARAM != 0 {
            Some("the armature of a joint has to be constant")
        } else if graph.as_rational(inertia).is_some_and(|n| n.is_negative()) {
            Some("the armature of a joint cannot be negative")
        } else {
            None
        };
        if let Some(message) = error {
            report.push(
                Diagnostic::new(expr.span, message)
                    .help("it is the inertia of the drive, reflected to the joint: J of ½ J q̇², made of parameters and constants"),
            );
            continue;
        }
        let name = format!("{}_dot", joint.name.name);
        let group = declared.velocities.iter().find(|group| group.name == name);
        if let Some(place) = group.map(|group| group.offset) {
            if let Some(entry) = all.get_mut(place) {
                *entry = inertia;
            }
            let half = graph.ratio(1, 2);
            let twice = graph.dot(&[inertia], &[declared.xi[place]]);
            let energy = graph.mul(twice, declared.xi[place]);
            let energy = graph.mul(half, energy);
            dynamics.kinetic = graph.add(dynamics.kinetic, energy);
        }
    }
    all
}
