//! Writes `joint j: kind AXIS on f at POSE moves g { … };`.

use super::Writer;
use crate::angle::Angle;
use crate::decimal::{Decimal, vector};
use crate::plan::{Linear, Mobility};
use crate::robot::{Joint, Kind};
use crate::tree::Edge;
use hamel_language::expression::{call, ident, named};
use hamel_language::syntax::ast::{
    self, Acting, BinaryOp, Components, Expr, ExprKind, ItemKind, JointField, JointKind, Load,
    Span, Target,
};

impl Writer<'_> {
    pub(super) fn joint(&mut self, edge: &Edge) {
        let robot = self.robot;
        let joint = &robot.joints[edge.joint];
        let motion = &self.plan.motions[edge.joint];
        let name = &self.names.joints[edge.joint];
        let range = &joint.name.range;
        for comment in self.comments(joint, motion) {
            self.draft.comment(comment);
        }
        let rooted = edge.parent == self.tree.root && !self.options.floating;
        let on = (!rooted).then(|| self.names.links[edge.parent].as_str());
        let (kind, axes) = self.kind(edge.joint);
        let at = match motion {
            Mobility::Locked(value) => locked(joint, value),
            _ => pose(joint.origin.rotation.expr(), &joint.origin.position, None),
        };
        let follows = match motion {
            Mobility::Follows(source, steps) => {
                Some(linear(Expr::name(&self.names.joints[*source]), steps))
            }
            _ => None,
        };
        let statement = ast::Joint {
            name: ident(name),
            kind: (kind, Span::NOWHERE),
            axes,
            on: on.map(ident),
            at,
            moves: ident(&self.names.links[edge.child]),
            follows,
            fields: fields(joint, motion, name),
        };
        self.draft
            .statement(range, ItemKind::Joint(Box::new(statement)));
        for statement in self.loads(edge) {
            self.draft.statement(range, statement);
        }
    }

    /// Returns the loads of a joint that its braces cannot hold: those of several freedoms, and those of a joint that
    /// follows another, which act on the leader's rate.
    fn loads(&self, edge: &Edge) -> Vec<ItemKind> {
        let joint = &self.robot.joints[edge.joint];
        let name = &self.names.joints[edge.joint];
        let symbol = |suffix: &str| Expr::name(&format!("{name}_{suffix}"));
        let force = |velocity: String, value: Expr| ItemKind::Generalized {
            target: Target {
                name: ident(&velocity),
                field: None,
                entry: Vec::new(),
            },
            value,
        };
        match (&self.plan.motions[edge.joint], joint.kind) {
            (Mobility::Follows(source, steps), _) => {
                let rate = Expr::name(&format!("{}_dot", self.names.joints[*source]));
                let factors = steps
                    .iter()
                    .map(|(factor, _)| (factor.clone(), Decimal::zero()));
                let rate = linear(rate, &factors.collect::<Vec<_>>());
                let damper = joint.damping.as_ref().map(|damping| ItemKind::Damper {
                    coefficient: damping.into(),
                    acting: Acting::On(rate.clone()),
                });
                let inerter = armature(joint).map(|inertance| ItemKind::Inerter {
                    inertance,
                    acting: Acting::On(rate.clone()),
                });
                damper.into_iter().chain(inerter).collect()
            }
            (Mobility::Free, Kind::Floating) => {
                let rooted = edge.parent == self.tree.root && !self.options.floating;
                let from = match rooted {
                    true => "world",
                    false => &self.names.links[edge.parent],
                };
                vec![ItemKind::Load {
                    load: Load::Wrench {
                        force: symbol("force"),
                        torque: symbol("torque"),
                        at: None,
                    },
                    frame: ident(&self.names.links[edge.child]),
                    from: Some(ident(from)),
                    axes: Components::Body,
                }]
            }
            (Mobility::Free, Kind::Universal) => [1, 2]
                .map(|axis| force(format!("{name}_{axis}_dot"), symbol("tau").entry(axis)))
                .into(),
            (Mobility::Free, Kind::Planar) => vec![
                force(format!("{name}_r_dot"), symbol("force")),
                force(format!("{name}_dot"), symbol("tau")),
            ],
            _ => Vec::new(),
        }
    }

    /// Returns the joint's kind in the description, and its axes.
    fn kind(&self, index: usize) -> (JointKind, Vec<Expr>) {
        let joint = &self.robot.joints[index];
        let motion = &self.plan.motions[index];
        let along = |kind| (kind, vec![vector(&axis(joint))]);
        match joint.kind {
            _ if matches!(motion, Mobility::Locked(_)) => (JointKind::Fixed, Vec::new()),
            Kind::Fixed => (JointKind::Fixed, Vec::new()),
            Kind::Floating => (JointKind::Free, Vec::new()),
            Kind::Spherical => (JointKind::Spherical, Vec::new()),
            Kind::Universal => (
                JointKind::Universal,
                vec![[1, 0, 0].into(), [0, 1, 0].into()],
            ),
            Kind::Planar => along(JointKind::Planar),
            Kind::Prismatic => along(JointKind::Prismatic),
            // Joints that follow this one need its angle as a coordinate, which `revolute` has and `continuous` has
            // not.
            Kind::Continuous if *motion == Mobility::Free && !self.is_followed(index) => {
                along(JointKind::Continuous)
            }
            Kind::Revolute | Kind::Continuous => along(JointKind::Revolute),
        }
    }

    /// Returns comments about properties that the statement does not express.
    fn comments(&self, joint: &Joint, motion: &Mobility) -> Vec<String> {
        let mut comments = Vec::new();
        if let Mobility::Locked(_) = motion {
            comments.push("Locked.".to_string());
            return comments;
        }
        let moving = joint.kind != Kind::Fixed;
        let directed = joint.kind.is_single() || joint.kind == Kind::Planar;
        if directed && joint.axis.is_none() {
            comments.push("No axis is given: URDF's default.".to_string());
        }
        if let Some(friction) = joint.friction.as_ref().filter(|_| moving) {
            comments.push(format!(
                "Coulomb friction {} is not modelled.",
                friction.text
            ));
        }
        if let (Some(damping), Kind::Planar | Kind::Floating) = (&joint.damping, joint.kind) {
            let text = &damping.text;
            comments.push(format!(
                "Damping {text} of several degrees of freedom is not modelled."
            ));
        }
        if let (Some(mimic), Mobility::Free) = (&joint.mimic, motion) {
            let steps = [(mimic.multiplier.clone(), mimic.offset.clone())];
            // The name in the file need not be one of the language.
            let expression = linear(named(&mimic.source.name), &steps);
            comments.push(format!("In the URDF it follows {expression}."));
        }
        comments
    }
}

/// Returns the axis, or URDF's default if none is given.
fn axis(joint: &Joint) -> [Decimal; 3] {
    let default = || [Decimal::one(), Decimal::zero(), Decimal::zero()];
    joint.axis.clone().unwrap_or_else(default)
}

/// Returns `pose(R, p + shift)`; `None` for the identity.
pub(super) fn pose(
    rotation: Option<Expr>,
    position: &[Decimal; 3],
    shift: Option<Expr>,
) -> Option<Expr> {
    let is_zero = position.iter().all(Decimal::is_zero);
    let place = match (is_zero, shift) {
        (true, None) if rotation.is_none() => return None,
        (_, None) => vector(position),
        (true, Some(shift)) => shift,
        (false, Some(shift)) => vector(position) + shift,
    };
    let rotation = rotation.unwrap_or_else(|| call("identity", [3.into()]));
    Some(hamel_language::expression::pose(rotation, place))
}

/// Returns the pose of a joint that is locked at an angle or a length.
fn locked(joint: &Joint, value: &Linear) -> Option<Expr> {
    let axis = axis(joint);
    let own = joint.origin.rotation.expr();
    let position = &joint.origin.position;
    let plain = value.steps.is_empty();
    if plain && value.value.is_zero() {
        return pose(own, position, None);
    }
    let number = linear((&value.value).into(), &value.steps);
    let nonzero: Vec<usize> = (0..3).filter(|&i| !axis[i].is_zero()).collect();
    let after = |own: Option<Expr>, factor: Expr| match own {
        Some(own) => own * factor,
        None => factor,
    };
    let norm = || call("norm", [vector(&axis)]);
    if joint.kind == Kind::Prismatic {
        let shift = match nonzero.as_slice() {
            [only] => {
                let sign = if axis[*only].value < 0.0 { -1 } else { 1 };
                let direction = [0, 1, 2].map(|i| if i == *only { sign } else { 0 });
                after(own.clone(), direction.into())
            }
            _ => after(own.clone(), vector(&axis)) / norm(),
        };
        return pose(own, position, Some(shift * number));
    }
    let turn = match nonzero.as_slice() {
        [only] => {
            let is_negative = axis[*only].value < 0.0;
            let angle = match (plain, is_negative) {
                (true, false) => Angle::read(&value.value, 0.0).expr(),
                (true, true) => Angle::read(&value.value.negated(), 0.0).expr(),
                (false, false) => number,
                (false, true) => -number,
            };
            call(["rotx", "roty", "rotz"][*only], [angle])
        }
        _ => call("axis_angle", [vector(&axis) / norm(), number]),
    };
    pose(Some(after(own, turn)), position, None)
}

/// Returns `a * q + b` for each step in turn.
fn linear(start: Expr, steps: &[(Decimal, Decimal)]) -> Expr {
    let mut value = start;
    for (factor, offset) in steps {
        value = match factor.text.as_str() {
            "1" | "1.0" => value,
            "-1" | "-1.0" => first_factor(value, &|first| -first),
            _ => first_factor(value, &|first| Expr::from(factor) * first),
        };
        if !offset.is_zero() {
            value = match offset.value < 0.0 {
                true => value - &offset.negated(),
                false => value + offset,
            };
        }
    }
    value
}

/// Applies a function to the first factor of a product, so that `a * (b * c)` becomes `a * b * c`.
fn first_factor(product: Expr, apply: &dyn Fn(Expr) -> Expr) -> Expr {
    match product.kind {
        ExprKind::Binary(BinaryOp::Mul, left, right) => first_factor(*left, apply) * *right,
        _ => apply(product),
    }
}

/// Returns the fields in the braces of the statement.
fn fields(joint: &Joint, motion: &Mobility, name: &str) -> Vec<(JointField, Span, Vec<Expr>)> {
    let one = joint.kind.is_single();
    let damped = one || matches!(joint.kind, Kind::Spherical | Kind::Universal);
    if !damped || matches!(motion, Mobility::Fixed | Mobility::Locked(_)) {
        return Vec::new();
    }
    let is_free = *motion == Mobility::Free;
    let mut fields = Vec::new();
    let mut add = |field, values: Vec<Expr>| fields.push((field, Span::NOWHERE, values));
    if is_free && joint.kind != Kind::Universal {
        let force = Expr::name(&format!("{name}_tau"));
        add(JointField::Force, vec![force]);
    }
    // Damping and armature of a joint that follows another act on the leader's rate, see `Writer::loads`.
    if let (Some(damping), true) = (&joint.damping, is_free) {
        add(JointField::Damping, vec![damping.into()]);
    }
    if !one {
        return fields;
    }
    if let (Some(armature), true) = (armature(joint), is_free) {
        add(JointField::Armature, vec![armature]);
    }
    if let Some((stiffness, rest)) = &joint.spring {
        add(JointField::Stiffness, vec![stiffness.into()]);
        if !rest.is_zero() {
            add(JointField::Rest, vec![rest.into()]);
        }
    }
    if let (true, Some(limits)) = (joint.kind != Kind::Continuous, limits(joint)) {
        add(JointField::Limit, limits.each_ref().map(Expr::from).into());
    }
    // A bound of 0 means that it is unknown.
    let is_bound = |bound: &&Decimal| bound.value > 0.0;
    if let Some(velocity) = joint.velocity.as_ref().filter(is_bound) {
        add(JointField::MaxSpeed, vec![velocity.into()]);
    }
    if let Some(effort) = joint.effort.as_ref().filter(is_bound) {
        add(JointField::MaxForce, vec![effort.into()]);
    }
    fields
}

/// Returns the armature, Σ inertia · ratio² of the rotors; `None` without rotors.
fn armature(joint: &Joint) -> Option<Expr> {
    let terms = joint.rotors.iter().map(|(inertia, ratio)| {
        let size = match ratio.value < 0.0 {
            true => ratio.negated(),
            false => ratio.clone(),
        };
        match size.text.as_str() {
            "1" | "1.0" => Expr::from(inertia),
            _ => Expr::from(inertia) * Expr::from(&size).pow(2),
        }
    });
    terms.reduce(|sum, term| sum + term)
}

/// Returns both limits, where a missing one is 0; `None` if there are none or the interval is empty.
fn limits(joint: &Joint) -> Option<[Decimal; 2]> {
    if joint.lower.is_none() && joint.upper.is_none() {
        return None;
    }
    let or_zero = |bound: &Option<Decimal>| bound.clone().unwrap_or_else(Decimal::zero);
    let (lower, upper) = (or_zero(&joint.lower), or_zero(&joint.upper));
    (lower.value < upper.value).then_some([lower, upper])
}
