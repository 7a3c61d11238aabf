//! Writes `joint j: kind AXIS on f at POSE moves g { … };`.

use super::Writer;
use crate::angle::Angle;
use crate::decimal::{Decimal, vector};
use crate::plan::{Linear, Mobility};
use crate::robot::{Joint, Kind};
use crate::tree::Edge;

impl Writer<'_> {
    pub(super) fn joint(&mut self, edge: &Edge) {
        let robot = self.robot;
        let joint = &robot.joints[edge.joint];
        let motion = self.plan.motions[edge.joint].clone();
        let name = self.names.joints[edge.joint].clone();
        let frame = self.names.links[edge.child].clone();
        let range = Some(&joint.name.range);
        for comment in self.comments(joint, &motion) {
            self.page.comment(&joint.name.range, &comment);
        }
        let rooted = edge.parent == self.tree.root && !self.options.floating;
        let on = match rooted {
            true => String::new(),
            false => format!(" on {}", self.names.links[edge.parent]),
        };
        let (kind, pose) = match &motion {
            Mobility::Locked(value) => ("fixed".to_string(), locked(joint, value)),
            _ => {
                let kind = self.kind(edge.joint);
                let rotation = joint.origin.rotation.text();
                (kind, pose(rotation, &joint.origin.position, None))
            }
        };
        let at = pose.map_or_else(String::new, |pose| format!(" at {pose}"));
        let follows = match &motion {
            Mobility::Follows(source, steps) => {
                let source = self.names.joints[*source].clone();
                format!(" follows {}", linear(source, steps))
            }
            _ => String::new(),
        };
        let mut head = format!("joint {name}: {kind}{on}{at} moves {frame}{follows}");
        let fields = fields(joint, &motion, &name);
        if fields.is_empty() {
            head.push(';');
            self.page.line(range, &head);
        } else {
            head.push_str(" {");
            self.page.line(range, &head);
            for field in fields {
                self.page.line(range, &format!("    {field}"));
            }
            self.page.line(range, "};");
        }
        if let Mobility::Follows(source, steps) = &motion {
            let rate = format!("{}_dot", self.names.joints[*source]);
            let factors: Vec<_> = steps
                .iter()
                .map(|(factor, _)| (factor.clone(), Decimal::zero()))
                .collect();
            let rate = linear(rate, &factors);
            if let Some(damping) = &joint.damping {
                let damper = format!("damper coefficient {} on {rate};", damping.text);
                self.page.line(range, &damper);
            }
            if let Some(armature) = armature(joint) {
                let inerter = format!("inerter inertance {armature} on {rate};");
                self.page.line(range, &inerter);
            }
        }
        if motion == Mobility::Free {
            match joint.kind {
                Kind::Floating => {
                    let from = if rooted {
                        "world"
                    } else {
                        &self.names.links[edge.parent]
                    };
                    let load = format!(
                        "wrench ({name}_force, {name}_torque) on {frame} from {from} in body;"
                    );
                    self.page.line(range, &load);
                }
                Kind::Universal => {
                    for axis in [1, 2] {
                        let force =
                            format!("generalized force {name}_{axis}_dot = {name}_tau[{axis}];");
                        self.page.line(range, &force);
                    }
                }
                Kind::Planar => {
                    self.page.line(
                        range,
                        &format!("generalized force {name}_r_dot = {name}_force;"),
                    );
                    self.page.line(
                        range,
                        &format!("generalized force {name}_dot = {name}_tau;"),
                    );
                }
                _ => {}
            }
        }
    }

    /// Returns the joint's kind with its axis.
    fn kind(&self, index: usize) -> String {
        let joint = &self.robot.joints[index];
        let axis = || vector(&axis(joint));
        match joint.kind {
            Kind::Fixed => "fixed".into(),
            Kind::Floating => "free".into(),
            Kind::Spherical => "spherical".into(),
            Kind::Universal => "universal [1, 0, 0], [0, 1, 0]".into(),
            Kind::Planar => format!("planar {}", axis()),
            Kind::Prismatic => format!("prismatic {}", axis()),
            // Joints that follow this one need its angle as a coordinate, which `revolute` has and `continuous` has
            // not.
            Kind::Continuous
                if self.plan.motions[index] == Mobility::Free && !self.is_followed(index) =>
            {
                format!("continuous {}", axis())
            }
            Kind::Revolute | Kind::Continuous => format!("revolute {}", axis()),
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
            let expression = linear(mimic.source.name.clone(), &steps);
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

/// Writes `pose(R, p)`; `None` for the identity.
pub(super) fn pose(
    rotation: Option<String>,
    position: &[Decimal; 3],
    shift: Option<String>,
) -> Option<String> {
    let still = position.iter().all(Decimal::is_zero);
    let place = match (still, shift) {
        (true, None) if rotation.is_none() => return None,
        (_, None) => vector(position),
        (true, Some(shift)) => shift,
        (false, Some(shift)) => format!("{} + {shift}", vector(position)),
    };
    let rotation = rotation.unwrap_or_else(|| "identity(3)".into());
    Some(format!("pose({rotation}, {place})"))
}

/// Writes the pose of a joint that is locked at an angle or a length.
fn locked(joint: &Joint, value: &Linear) -> Option<String> {
    let axis = axis(joint);
    let own = joint.origin.rotation.text();
    let position = &joint.origin.position;
    let plain = value.steps.is_empty();
    if plain && value.value.is_zero() {
        return pose(own, position, None);
    }
    let number = linear(value.value.text.clone(), &value.steps);
    let nonzero: Vec<usize> = (0..3).filter(|&i| !axis[i].is_zero()).collect();
    let product = |left: Option<String>, right: String| match left {
        Some(left) => format!("{left} * {right}"),
        None => right,
    };
    let norm = format!("{} / norm({})", vector(&axis), vector(&axis));
    if joint.kind == Kind::Prismatic {
        let direction = match nonzero.as_slice() {
            [only] => {
                let mut unit: [Decimal; 3] = std::array::from_fn(|_| Decimal::zero());
                let one = Decimal::one();
                unit[*only] = if axis[*only].value < 0.0 {
                    one.negated()
                } else {
                    one
                };
                vector(&unit)
            }
            _ => norm,
        };
        let number = if plain { number } else { format!("({number})") };
        let shift = product(own.clone(), format!("{direction} * {number}"));
        return pose(own, position, Some(shift));
    }
    let turn = match nonzero.as_slice() {
        [only] => {
            let sign = axis[*only].value < 0.0;
            let angle = match (plain, sign) {
                (true, false) => Angle::read(&value.value, 0.0).text(),
                (true, true) => Angle::read(&value.value.negated(), 0.0).text(),
                (false, false) => number,
                (false, true) => format!("-({number})"),
            };
            format!("rot{}({angle})", ["x", "y", "z"][*only])
        }
        _ => format!("axis_angle({norm}, {number})"),
    };
    pose(Some(product(own, turn)), position, None)
}

/// Writes `a * q + b` for each step in turn.
fn linear(start: String, steps: &[(Decimal, Decimal)]) -> String {
    let mut text = start;
    let mut sum = false;
    for (factor, offset) in steps {
        let inner = if sum { format!("({text})") } else { text };
        text = match factor.text.as_str() {
            "1" | "1.0" => inner,
            "-1" | "-1.0" => format!("-{inner}"),
            other => format!("{other} * {inner}"),
        };
        sum = false;
        if !offset.is_zero() {
            sum = true;
            text = match offset.text.strip_prefix('-') {
                Some(positive) => format!("{text} - {positive}"),
                None => format!("{text} + {}", offset.text),
            };
        }
    }
    text
}

/// Returns the fields in the braces of the statement.
fn fields(joint: &Joint, motion: &Mobility, name: &str) -> Vec<String> {
    let one = joint.kind.is_single();
    let damped = one || matches!(joint.kind, Kind::Spherical | Kind::Universal);
    if !damped || matches!(motion, Mobility::Fixed | Mobility::Locked(_)) {
        return Vec::new();
    }
    let free = *motion == Mobility::Free;
    let mut fields = Vec::new();
    if free && joint.kind != Kind::Universal {
        fields.push(format!("force {name}_tau;"));
    }
    // Damping of a joint that follows another acts on the leader's rate, see `Writer::joint`.
    if let (Some(damping), true) = (&joint.damping, free) {
        fields.push(format!("damping {};", damping.text));
    }
    if !one {
        return fields;
    }
    if let (Some(armature), true) = (armature(joint), free) {
        fields.push(format!("armature {armature};"));
    }
    if let Some((stiffness, rest)) = &joint.spring {
        fields.push(match rest.is_zero() {
            true => format!("stiffness {};", stiffness.text),
            false => format!("stiffness {}; rest {};", stiffness.text, rest.text),
        });
    }
    let mut bounds = Vec::new();
    if joint.kind != Kind::Continuous
        && let (Some(lower), Some(upper)) = limits(joint)
    {
        bounds.push(format!("limit {} to {};", lower.text, upper.text));
    }
    // A bound of 0 means that it is unknown.
    let positive = |bound: &Option<Decimal>| bound.clone().filter(|bound| bound.value > 0.0);
    if let Some(velocity) = positive(&joint.velocity) {
        bounds.push(format!("max_speed {};", velocity.text));
    }
    if let Some(effort) = positive(&joint.effort) {
        bounds.push(format!("max_force {};", effort.text));
    }
    if !bounds.is_empty() {
        fields.push(bounds.join(" "));
    }
    fields
}

/// Writes the armature, Σ inertia · ratio² of the rotors.
fn armature(joint: &Joint) -> Option<String> {
    let terms = joint.rotors.iter().map(|(inertia, ratio)| {
        let size = ratio.text.trim_start_matches('-');
        match size {
            "1" | "1.0" => inertia.text.clone(),
            size => format!("{} * {size}^2", inertia.text),
        }
    });
    let terms: Vec<String> = terms.collect();
    (!terms.is_empty()).then(|| terms.join(" + "))
}

/// Returns both limits; a missing one is 0. Returns none if the interval would be empty.
fn limits(joint: &Joint) -> (Option<Decimal>, Option<Decimal>) {
    let (lower, upper) = match (&joint.lower, &joint.upper) {
        (None, None) => return (None, None),
        (lower, upper) => (
            lower.clone().unwrap_or_else(Decimal::zero),
            upper.clone().unwrap_or_else(Decimal::zero),
        ),
    };
    if lower.value < upper.value {
        (Some(lower), Some(upper))
    } else {
        (None, None)
    }
}
