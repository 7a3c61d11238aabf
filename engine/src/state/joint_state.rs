//! Reads states by the names of joints: `{"configuration": {…}, "velocity": {…}, "force": […]}`.

use super::State;
use super::joints::{Joint, JointCoordinates, joints};
use super::problem::StateProblem;
use super::read::{StateReader, kind, put};
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Model;
use serde_json::{Map, Value};

/// Members of a file that are read.
const READ: [&str; 4] = ["configuration", "velocity", "force", "param"];
/// Members with results in files of reference values; they are ignored.
const RESULTS: [&str; 6] = [
    "mass_matrix",
    "bias",
    "gravity_force",
    "acceleration",
    "kinetic_energy",
    "potential_energy",
];
/// Member with the order of a list of forces, by joint.
pub const VELOCITY_ORDER: &str = "velocity_order";

/// State that was given by joints, with the generalised force that acts on it.
#[derive(Clone, Debug)]
pub struct JointState {
    /// The state; its inputs are zero.
    pub state: State,
    /// The joints.
    pub joints: Vec<Joint>,
    /// The whole generalised force, in the order of ξ; `None` for that of the description.
    pub force: Option<Vec<f64>>,
}

/// Returns whether a JSON text gives a state by joints, rather than by coordinates.
pub fn is_by_joints(json: &Value) -> bool {
    let Value::Object(parts) = json else {
        return false;
    };
    ["configuration", "force", "samples"]
        .iter()
        .any(|part| parts.contains_key(*part))
}

impl JointState {
    /// Reads a state as changes of a start, and collects all errors. `order` is the order of lists of forces, unless
    /// the state contains one.
    pub fn parse(
        start: State,
        json: &Value,
        order: Option<&Value>,
        (generated, text): (&Generated, &str),
        names: &[(String, String)],
    ) -> Result<Self, Vec<StateProblem>> {
        let model = &generated.active;
        let mut sample = JointState {
            state: start.clone(),
            joints: joints(model, names),
            force: None,
        };
        let mut reader = StateReader::new(generated, text);
        match json {
            Value::Object(parts) => {
                let all = joints(&generated.model, names);
                let clock = generated.model.clock.map(|clock| clock.xi);
                let moving = all.into_iter().filter(|j| clock != Some(j.velocities.0));
                reader.sample(
                    (parts, order),
                    &moving.collect::<Vec<_>>(),
                    model,
                    &mut sample,
                );
            }
            other => reader.error("", format!("expected an object, found {}", kind(other))),
        }
        reader.finish(generated, &mut sample.state, &start)?;
        Ok(sample)
    }
}

impl StateReader {
    fn sample(
        &mut self,
        (parts, order): (&Map<String, Value>, Option<&Value>),
        all: &[Joint],
        model: &Model,
        sample: &mut JointState,
    ) {
        let known: Vec<&str> = READ
            .iter()
            .chain(&RESULTS)
            .copied()
            .chain([VELOCITY_ORDER])
            .collect();
        self.known("", parts, &known);
        let groups = model.params.iter();
        let groups: Vec<&str> = groups.map(|group| group.name.as_str()).collect();
        if let Some(given) = self.part(parts, "param", &groups) {
            for group in &model.params {
                let at = format!("param.{}", group.name);
                if let Some(value) = given.get(&group.name)
                    && let Some(values) = self.shape(&at, value, group.shape)
                {
                    put(&mut sample.state.params, group.offset, &values);
                }
            }
        }
        let names: Vec<&str> = all.iter().map(|joint| joint.name.as_str()).collect();
        let x = &mut sample.state.x;
        if let Some(given) = self.part(parts, "configuration", &names) {
            for joint in all {
                if let Some(value) = given.get(&joint.name) {
                    self.configuration(&format!("configuration.{}", joint.name), value, joint, x);
                }
            }
        }
        if let Some(given) = self.part(parts, "velocity", &names) {
            for joint in all {
                if let Some(value) = given.get(&joint.name) {
                    let at = format!("velocity.{}", joint.name);
                    for (offset, values) in self.motion(&at, value, joint) {
                        self.put_xi(offset, &values);
                    }
                }
            }
        }
        // Forces correspond to the velocities that constraints leave.
        let joints = sample.joints.clone();
        let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        let mut force = vec![0.0; model.n()];
        match parts.get("force") {
            None => return,
            Some(Value::Array(_)) => {
                let order = parts.get(VELOCITY_ORDER).or(order);
                self.forces(parts, order, &joints, &mut force);
            }
            Some(_) => {
                if let Some(given) = self.part(parts, "force", &names) {
                    for joint in &joints {
                        if let Some(value) = given.get(&joint.name) {
                            let at = format!("force.{}", joint.name);
                            for (offset, values) in self.motion(&at, value, joint) {
                                put(&mut force, offset, &values);
                            }
                        }
                    }
                }
            }
        }
        sample.force = Some(force);
    }

    /// Reads a list in the order of ξ, or in the order of joints that the file gives for its entries.
    fn forces(
        &mut self,
        parts: &Map<String, Value>,
        order: Option<&Value>,
        joints: &[Joint],
        force: &mut [f64],
    ) {
        let Some(list) = parts
            .get("force")
            .and_then(|value| self.vector("force", value, force.len()))
        else {
            return;
        };
        let Some(order) = order else {
            force.copy_from_slice(&list);
            return;
        };
        let order: Vec<&str> = match order {
            Value::Array(names) => names.iter().filter_map(Value::as_str).collect(),
            _ => Vec::new(),
        };
        let mut placed = 0;
        for joint in joints {
            let (first, count) = joint.velocities;
            let entries = order
                .iter()
                .zip(&list)
                .filter(|(name, _)| **name == joint.name);
            for (offset, (_, entry)) in entries.take(count).enumerate() {
                if let Some(place) = force.get_mut(first + offset) {
                    *place = *entry;
                    placed += 1;
                }
            }
        }
        if placed != force.len() || order.len() != force.len() {
            let message =
                "expected each row by the name of its joint, as in `velocities` of the output";
            self.error(VELOCITY_ORDER, message.into());
        }
    }

    fn configuration(&mut self, at: &str, value: &Value, joint: &Joint, x: &mut [f64]) {
        let count = joint.velocities.1;
        match joint.place {
            JointCoordinates::Plain(offset) if count == 1 => {
                let number = self.number(at, value);
                self.put_x(x, offset, &number.into_iter().collect::<Vec<_>>());
            }
            JointCoordinates::Plain(offset) => {
                let read = self.vector(at, value, count).unwrap_or_default();
                self.put_x(x, offset, &read);
            }
            JointCoordinates::Circle(offset) => {
                if let Some(angle) = self.number(at, value) {
                    self.put_x(x, offset, &[angle.cos(), angle.sin()]);
                }
            }
            JointCoordinates::Quaternion(offset) => {
                let read = self.vector(at, value, 4).unwrap_or_default();
                self.put_x(x, offset, &read);
            }
            JointCoordinates::Rotation(offset) => {
                let read = self.matrix(at, value, 3).unwrap_or_default();
                self.put_x(x, offset, &read.concat());
            }
            JointCoordinates::Free(position, rotation) => {
                let Some(given) = self.members(at, value, &["position", "rotation"]) else {
                    return;
                };
                if let Some(value) = given.get("position") {
                    let read = self.vector(&format!("{at}.position"), value, 3);
                    self.put_x(x, position, &read.unwrap_or_default());
                }
                if let Some(value) = given.get("rotation") {
                    let read = self.matrix(&format!("{at}.rotation"), value, 3);
                    self.put_x(x, rotation, &read.unwrap_or_default().concat());
                }
            }
            JointCoordinates::Planar(position, angle) => {
                let Some(given) = self.members(at, value, &["position", "angle"]) else {
                    return;
                };
                if let Some(value) = given.get("position") {
                    let read = self.vector(&format!("{at}.position"), value, 2);
                    self.put_x(x, position, &read.unwrap_or_default());
                }
                if let Some(value) = given.get("angle") {
                    let read = self.number(&format!("{at}.angle"), value);
                    self.put_x(x, angle, &read.into_iter().collect::<Vec<_>>());
                }
            }
        }
    }

    /// Reads rates or forces, with their indices in ξ.
    fn motion(&mut self, at: &str, value: &Value, joint: &Joint) -> Vec<(usize, Vec<f64>)> {
        let (first, count) = joint.velocities;
        let mut found = self.moving(at, value, count, joint.place.linear());
        for (place, _) in &mut found {
            *place += first;
        }
        found
    }

    /// Reads `count` rates or forces of a joint, each with its index among them: a number, a list, or `linear`, for the
    /// first ones, and `angular`.
    pub(super) fn moving(
        &mut self,
        at: &str,
        value: &Value,
        count: usize,
        linear: Option<usize>,
    ) -> Vec<(usize, Vec<f64>)> {
        if let (Some(linear), Value::Object(_)) = (linear, value) {
            let Some(given) = self.members(at, value, &["linear", "angular"]) else {
                return Vec::new();
            };
            let parts = [("linear", 0, linear), ("angular", linear, count - linear)];
            let mut found = Vec::new();
            for (part, place, count) in parts {
                if let Some(value) = given.get(part) {
                    found.extend(self.numbers(&format!("{at}.{part}"), value, count, place));
                }
            }
            return found;
        }
        self.numbers(at, value, count, 0).into_iter().collect()
    }

    /// Reads a number, or a list if several are expected, with the index at which they begin.
    fn numbers(
        &mut self,
        at: &str,
        value: &Value,
        count: usize,
        place: usize,
    ) -> Option<(usize, Vec<f64>)> {
        let read = match count {
            1 => self.number(at, value).map(|number| vec![number]),
            _ => self.vector(at, value, count),
        };
        Some((place, read?))
    }

    fn members<'a>(
        &mut self,
        at: &str,
        value: &'a Value,
        names: &[&str],
    ) -> Option<&'a Map<String, Value>> {
        let Value::Object(given) = value else {
            let names: Vec<String> = names.iter().map(|name| format!("\"{name}\": …")).collect();
            let expected = names.join(", ");
            self.error(
                at,
                format!("expected {{{expected}}}, found {}", kind(value)),
            );
            return None;
        };
        self.known(at, given, names);
        Some(given)
    }
}
