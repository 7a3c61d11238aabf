//! Matches the fields of a reference solution with coordinates and velocities.

use crate::failure::Failure;
use hamel_codegen::model::layout::entry_names;
use hamel_codegen::program::Program;
use hamel_engine::State;
use hamel_report::solution::{Solution, largest, relative};

/// A field and its place in (x, ξ).
struct Field {
    name: String,
    offset: usize,
    len: usize,
    velocity: bool,
}

/// The matched fields.
pub struct Fields<'a> {
    solution: &'a Solution,
    fields: Vec<Field>,
}

/// The values of the matched fields at the end.
pub struct End(Vec<(bool, usize, Vec<f64>)>);

impl<'a> Fields<'a> {
    /// Matches by name and number of entries.
    pub fn of(solution: &'a Solution, program: &Program) -> Result<Self, Failure> {
        let coordinates = program
            .coordinates
            .iter()
            .map(|coordinate| (coordinate.name.as_str(), coordinate.offset, false));
        let moving = program.moving();
        let velocities = moving
            .iter()
            .map(|group| (group.name.as_str(), group.offset, true));
        let places: Vec<(&str, usize, bool)> = coordinates.chain(velocities).collect();
        let velocity = |name: &str| moving.iter().find(|group| group.name == name);
        let coordinate = |name: &str| program.coordinates.iter().find(|other| other.name == name);
        let mut fields = Vec::new();
        for name in solution.fields() {
            let Some(values) = solution.initial(&name) else {
                continue;
            };
            // Angular velocities are called ω in the literature, and often w in descriptions.
            let other = name.replacen("omega", "w", 1);
            let found = places
                .iter()
                .find(|place| place.0 == name || place.0 == other);
            let Some(&(known, offset, is_velocity)) = found else {
                continue;
            };
            let len = if is_velocity {
                velocity(known).map(|group| group.len)
            } else {
                coordinate(known).map(|known| entry_names(&known.name, known.kind).len())
            };
            if len == Some(values.len()) {
                fields.push(Field {
                    name,
                    offset,
                    len: values.len(),
                    velocity: is_velocity,
                });
            }
        }
        if fields.is_empty() {
            let known: Vec<&str> = places.iter().map(|place| place.0).collect();
            return Err(Failure::usage(format!(
                "no field of the reference ({}) is a coordinate or velocity of {} ({})",
                solution.fields().join(", "),
                program.name,
                known.join(", ")
            )));
        }
        Ok(Fields { solution, fields })
    }

    /// Returns the names of the fields.
    pub fn names(&self) -> String {
        let names: Vec<&str> = self
            .fields
            .iter()
            .map(|field| field.name.as_str())
            .collect();
        names.join(", ")
    }

    /// Sets the start to the initial values of the fields.
    pub fn start(&self, state: &mut State) -> Result<(), Failure> {
        for field in &self.fields {
            let values = self.solution.initial(&field.name);
            let list = if field.velocity {
                &mut state.xi
            } else {
                &mut state.x
            };
            let place = list.get_mut(field.offset..field.offset + field.len);
            match (place, values) {
                (Some(place), Some(values)) => place.copy_from_slice(&values),
                _ => return Err(missing(&field.name, 0.0)),
            }
        }
        Ok(())
    }

    /// Returns the values of the fields at a listed time.
    pub fn end(&self, until: f64) -> Result<End, Failure> {
        let value = |field: &Field| {
            let values = self.solution.sample(until, &field.name);
            let values = values.filter(|values| values.len() == field.len);
            let values = values.ok_or_else(|| missing(&field.name, until))?;
            Ok((field.velocity, field.offset, values))
        };
        self.fields
            .iter()
            .map(value)
            .collect::<Result<_, _>>()
            .map(End)
    }
}

impl End {
    /// Returns the largest error of all fields.
    pub fn error(&self, x: &[f64], xi: &[f64]) -> f64 {
        largest(self.0.iter().map(|(velocity, offset, values)| {
            let list = if *velocity { xi } else { x };
            let here = list.get(*offset..offset + values.len());
            here.map_or(f64::NAN, |here| relative(here, values))
        }))
    }
}

fn missing(name: &str, t: f64) -> Failure {
    Failure::usage(format!("the reference has no field {name} at t = {t}"))
}
