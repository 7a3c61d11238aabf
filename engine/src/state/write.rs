//! Writes a state as the JSON that commands read, with all digits.

use super::State;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Group;
use hamel_codegen::syntax::ast::{CoordKind, ShapeKind};
use serde_json::{Map, Value};

impl State {
    /// Returns the state as JSON, with the velocities ξ of the full frame.
    pub fn to_json(&self, generated: &Generated, full: &[f64]) -> Value {
        let model = &generated.active;
        let coordinates = model.coordinates.iter().map(|coordinate| {
            let entries = &self.x[coordinate.offset..];
            let value = match coordinate.kind {
                CoordKind::Real => entries[0].into(),
                CoordKind::Euclidean(n) => entries[..n].into(),
                CoordKind::S1 => entries[..2].into(),
                CoordKind::S3 => entries[..4].into(),
                CoordKind::SO3 => rows(&entries[..9], 3),
                CoordKind::SE3 => {
                    let pose = [("p", entries[..3].into()), ("R", rows(&entries[3..12], 3))];
                    Value::Object(
                        pose.map(|(name, part)| (name.to_string(), part))
                            .into_iter()
                            .collect(),
                    )
                }
            };
            (coordinate.name.clone(), value)
        });
        let clock = generated.model.clock.map(|clock| clock.xi);
        let moving = generated.model.velocities.iter();
        let moving: Vec<Group> = moving
            .filter(|group| Some(group.offset) != clock)
            .cloned()
            .collect();
        let all = [
            ("coord", coordinates.collect()),
            ("velocity", groups(&moving, full)),
            ("state", groups(&model.states_behind(), &self.xi)),
            ("input", groups(&model.inputs, &self.u)),
            ("param", groups(&model.params, &self.params)),
        ];
        let there = all
            .into_iter()
            .filter(|(_, part): &(_, Map<_, _>)| !part.is_empty());
        Value::Object(
            there
                .map(|(name, part)| (name.to_string(), part.into()))
                .collect(),
        )
    }
}

fn groups(groups: &[Group], values: &[f64]) -> Map<String, Value> {
    let value = |group: &Group| -> Value {
        let values = &values[group.offset..group.offset + group.len];
        match group.shape {
            ShapeKind::Scalar => values[0].into(),
            ShapeKind::Vector(_) => values.into(),
            ShapeKind::Matrix(n) => rows(values, n),
            ShapeKind::Symmetric(n) => {
                // The upper triangle by rows.
                let place = |i: usize, j: usize| i * n - i * (i + 1) / 2 + j;
                let all = (0..n * n).map(|k| values[place((k / n).min(k % n), (k / n).max(k % n))]);
                rows(&all.collect::<Vec<f64>>(), n)
            }
        }
    };
    groups
        .iter()
        .map(|group| (group.name.clone(), value(group)))
        .collect()
}

fn rows(values: &[f64], n: usize) -> Value {
    values.chunks(n).map(Value::from).collect()
}
