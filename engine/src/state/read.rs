//! Reads JSON values as numbers of a state, and collects all errors with their paths.

use super::State;
use super::dependent_velocities::dependent_velocities;
use super::given_entries::{GivenEntries, joints, velocities};
use super::problem::StateProblem;
use crate::names::{advice_on_rate, rates};
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Group;
use hamel_codegen::syntax::ast::{CoordKind, ShapeKind};
use hamel_codegen::syntax::suggest::closest;
use serde_json::{Map, Value};

/// Largest relative difference of the entries (i, j) and (j, i) of a symmetric matrix.
const SYMMETRY_TOLERANCE: f64 = 1e-12;

/// Reader of a state in JSON: the entries given so far, and the errors found so far.
#[derive(Debug)]
pub struct StateReader {
    /// Each with its path.
    errors: Vec<StateProblem>,
    /// Given entries.
    given: GivenEntries,
    /// Velocities that are not part of states, with the reason.
    solved: Vec<(String, String)>,
    /// Coordinates whose rate is a velocity, each with the name of that velocity.
    rates: Vec<(String, String)>,
}

impl StateReader {
    /// Prepares to read; `text` is that of the description.
    pub fn new(generated: &Generated, text: &str) -> Self {
        StateReader {
            errors: Vec::new(),
            given: GivenEntries::none(generated),
            solved: dependent_velocities(generated, text),
            rates: rates(&generated.model),
        }
    }

    /// Computes the entries of `state` that were not given, starting from those of `from`, so that loops close and
    /// constraints hold; returns all errors of reading instead if there are any.
    pub fn finish(
        self,
        generated: &Generated,
        state: &mut State,
        from: &State,
    ) -> Result<(), Vec<StateProblem>> {
        match self.errors.is_empty() {
            true => state.complete(generated, &self.given, from),
            false => Err(self.errors),
        }
    }

    /// Sets entries of x from an index on.
    pub(super) fn put_x(&mut self, x: &mut [f64], offset: usize, values: &[f64]) {
        put(x, offset, values);
        self.given.x[offset..offset + values.len()].fill(true);
    }

    /// Sets entries of ξ of the full frame from an index on.
    pub(super) fn put_xi(&mut self, offset: usize, values: &[f64]) {
        let places = self.given.xi.iter_mut().skip(offset);
        places
            .zip(values)
            .for_each(|(place, value)| *place = Some(*value));
    }

    /// Sets an entry of z, which follows ξ.
    pub(super) fn put_z(&mut self, xi: &mut [f64], place: usize, value: f64) {
        let n = xi.len() - self.given.z.len();
        xi[n + place] = value;
        self.given.z[place] = true;
    }

    /// Sets the parameters, coordinates, velocities, states and inputs that a JSON object gives; [`finish`](Self::finish)
    /// computes the others and returns errors. `names` are pairs of a joint's names in the robot's file and in the
    /// description.
    pub fn state(
        &mut self,
        json: &Value,
        generated: &Generated,
        names: &[(String, String)],
        state: &mut State,
    ) {
        let model = &generated.active;
        let Value::Object(parts) = json else {
            let expected =
                "{\"param\": …, \"coord\": …, \"velocity\": …, \"state\": …, \"input\": …}";
            return self.error("", format!("expected {expected}, found {}", kind(json)));
        };
        self.known("", parts, &["param", "coord", "velocity", "state", "input"]);
        let (states, velocities) = (model.states_behind(), velocities(generated));
        let groups = [
            ("param", &model.params),
            ("velocity", &velocities),
            ("state", &states),
            ("input", &model.inputs),
        ];
        for (part, groups) in groups {
            let numbers = match part {
                "param" => &mut state.params,
                "input" => &mut state.u,
                // The states that follow ξ.
                _ => &mut state.xi,
            };
            let joints = if part == "velocity" {
                joints(&generated.model, names)
            } else {
                Vec::new()
            };
            let mut known: Vec<&str> = joints.iter().map(|joint| joint.name).collect();
            // If the file's name of a joint is the description's name of another velocity, the joint is meant.
            let groups = groups.iter();
            let groups = groups.filter(|group| !joints.iter().any(|one| one.name == group.name));
            let groups: Vec<&Group> = groups.collect();
            known.extend(groups.iter().map(|group| group.name.as_str()));
            let Some(given) = self.part(parts, part, &known) else {
                continue;
            };
            for joint in &joints {
                let Some(value) = given.get(joint.name) else {
                    continue;
                };
                let at = format!("{part}.{}", joint.name);
                let places = &joint.places;
                if places.iter().any(|&place| self.given.xi[place].is_some()) {
                    self.twice(&at);
                    continue;
                }
                for (first, values) in self.moving(&at, value, places.len(), joint.linear) {
                    for (&place, value) in places.iter().skip(first).zip(values) {
                        self.put_xi(place, &[value]);
                    }
                }
            }
            for group in groups {
                let at = format!("{part}.{}", group.name);
                if let Some(value) = given.get(&group.name)
                    && let Some(values) = self.shape(&at, value, group.shape)
                {
                    let places = group.offset..group.offset + group.len;
                    if part != "velocity" {
                        put(numbers, group.offset, &values);
                        if part == "state" {
                            let behind = group.offset - model.n();
                            self.given.z[behind..behind + group.len].fill(true);
                        }
                    } else if self.given.xi[places].iter().any(Option::is_some) {
                        self.twice(&at);
                    } else {
                        self.put_xi(group.offset, &values);
                    }
                }
            }
        }
        let names: Vec<&str> = model
            .coordinates
            .iter()
            .map(|coordinate| coordinate.name.as_str())
            .collect();
        let Some(given) = self.part(parts, "coord", &names) else {
            return;
        };
        for coordinate in &model.coordinates {
            let Some(value) = given.get(&coordinate.name) else {
                continue;
            };
            let offset = coordinate.offset;
            for (part, values) in self.coordinate(
                &format!("coord.{}", coordinate.name),
                value,
                coordinate.kind,
            ) {
                self.put_x(&mut state.x, offset + part, &values);
            }
        }
    }

    /// Reads an object with at most one member for each name.
    pub(super) fn part<'a>(
        &mut self,
        parts: &'a Map<String, Value>,
        part: &str,
        names: &[&str],
    ) -> Option<&'a Map<String, Value>> {
        match parts.get(part)? {
            Value::Object(given) => {
                self.known(part, given, names);
                Some(given)
            }
            other => {
                self.error(part, format!("expected an object, found {}", kind(other)));
                None
            }
        }
    }

    /// Reports members with unknown names.
    pub(super) fn known(&mut self, at: &str, given: &Map<String, Value>, names: &[&str]) {
        for name in given.keys().filter(|name| !names.contains(&name.as_str())) {
            let path = if at.is_empty() {
                name.clone()
            } else {
                format!("{at}.{name}")
            };
            let reason = self.solved.iter().find(|(solved, _)| solved == name);
            let reason = reason.filter(|_| matches!(at, "velocity" | "configuration" | "force"));
            let rate = advice_on_rate(&self.rates, name);
            let rate = rate.filter(|_| at == "velocity");
            let message = match (reason, closest(name, names.iter().copied()), names) {
                (Some((_, why)), ..) => why.clone(),
                _ if let Some(rate) = rate => format!("unknown name; {rate}"),
                (None, Some(meant), _) => format!("unknown name; did you mean `{meant}`?"),
                (None, None, []) => "unknown name; the description has none".into(),
                (None, None, _) => format!("unknown name; known are {}", names.join(", ")),
            };
            self.error(&path, message);
        }
    }

    /// Reads the numbers of a coordinate, with the index in it at which they begin.
    fn coordinate(&mut self, at: &str, value: &Value, kind: CoordKind) -> Vec<(usize, Vec<f64>)> {
        let whole = match kind {
            CoordKind::Real => self.number(at, value).map(|number| vec![number]),
            CoordKind::Euclidean(n) => self.vector(at, value, n),
            CoordKind::S1 => match value {
                Value::Number(_) => self
                    .number(at, value)
                    .map(|angle| vec![angle.cos(), angle.sin()]),
                Value::Array(_) => self.vector(at, value, 2),
                other => {
                    self.error(
                        at,
                        format!(
                            "expected an angle or [cos, sin], found {}",
                            self::kind(other)
                        ),
                    );
                    None
                }
            },
            CoordKind::S3 => self.vector(at, value, 4),
            CoordKind::SO3 => self.matrix(at, value, 3).map(|rows| rows.concat()),
            CoordKind::SE3 => return self.pose(at, value),
        };
        whole.map(|values| (0, values)).into_iter().collect()
    }

    /// Reads `{"p": [3], "R": [3 × 3]}`; missing members keep their values.
    fn pose(&mut self, at: &str, value: &Value) -> Vec<(usize, Vec<f64>)> {
        let Value::Object(parts) = value else {
            self.error(
                at,
                format!("expected {{\"p\": …, \"R\": …}}, found {}", kind(value)),
            );
            return Vec::new();
        };
        self.known(at, parts, &["p", "R"]);
        let position = parts
            .get("p")
            .and_then(|p| self.vector(&format!("{at}.p"), p, 3));
        let rotation = parts
            .get("R")
            .and_then(|r| self.matrix(&format!("{at}.R"), r, 3));
        position
            .map(|p| (0, p))
            .into_iter()
            .chain(rotation.map(|rows| (3, rows.concat())))
            .collect()
    }

    /// Numbers of a declared shape, in the order of its symbols.
    pub(super) fn shape(&mut self, at: &str, value: &Value, shape: ShapeKind) -> Option<Vec<f64>> {
        match shape {
            ShapeKind::Scalar => self.number(at, value).map(|number| vec![number]),
            ShapeKind::Vector(n) => self.vector(at, value, n),
            ShapeKind::Matrix(n) => self.matrix(at, value, n).map(|rows| rows.concat()),
            ShapeKind::Symmetric(n) => {
                let rows = self.matrix(at, value, n)?;
                let before = self.errors.len();
                for i in 0..n {
                    for j in 0..i {
                        let scale = rows[i][j].abs().max(rows[j][i].abs());
                        if (rows[i][j] - rows[j][i]).abs() > SYMMETRY_TOLERANCE * scale {
                            let message = format!(
                                "has to be symmetric: {} here, {} at [{j}][{i}]",
                                rows[i][j], rows[j][i]
                            );
                            self.error(&format!("{at}[{i}][{j}]"), message);
                        }
                    }
                }
                let upper = (0..n).flat_map(|i| rows[i][i..].iter().copied());
                (self.errors.len() == before).then(|| upper.collect())
            }
        }
    }

    pub(super) fn matrix(&mut self, at: &str, value: &Value, n: usize) -> Option<Vec<Vec<f64>>> {
        let rows = self.list(
            at,
            value,
            n,
            &format!("a {n}×{n} matrix as a list of its rows"),
        )?;
        let rows: Vec<_> = rows
            .iter()
            .enumerate()
            .map(|(i, row)| self.vector(&format!("{at}[{i}]"), row, n))
            .collect();
        rows.into_iter().collect()
    }

    pub(super) fn vector(&mut self, at: &str, value: &Value, n: usize) -> Option<Vec<f64>> {
        let list = self.list(at, value, n, &format!("a list of {n} numbers"))?;
        let numbers: Vec<_> = list
            .iter()
            .enumerate()
            .map(|(i, entry)| self.number(&format!("{at}[{i}]"), entry))
            .collect();
        numbers.into_iter().collect()
    }

    fn list<'a>(
        &mut self,
        at: &str,
        value: &'a Value,
        n: usize,
        expected: &str,
    ) -> Option<&'a [Value]> {
        match value {
            Value::Array(list) if list.len() == n => return Some(list),
            Value::Array(list) => self.error(
                at,
                format!("expected {expected}, found a list of {}", list.len()),
            ),
            other => self.error(at, format!("expected {expected}, found {}", kind(other))),
        }
        None
    }

    pub(super) fn number(&mut self, at: &str, value: &Value) -> Option<f64> {
        match value.as_f64() {
            Some(number) if number.is_finite() => return Some(number),
            Some(_) => self.error(at, "the number is not finite".into()),
            None => self.error(at, format!("expected a number, found {}", kind(value))),
        }
        None
    }

    fn twice(&mut self, at: &str) {
        self.error(at, "given twice, also by another of its names".into());
    }

    pub(super) fn error(&mut self, at: &str, message: String) {
        self.errors.push(StateProblem::new(at, message));
    }
}

/// Sets values from an index on.
pub(super) fn put(target: &mut [f64], offset: usize, values: &[f64]) {
    for (place, value) in target.iter_mut().skip(offset).zip(values) {
        *place = *value;
    }
}

/// Names the type of a JSON value, for messages.
pub(super) fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a Boolean value",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}
