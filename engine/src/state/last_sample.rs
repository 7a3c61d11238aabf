//! Reads the last of the samples that `hamel simulate --out` writes as JSON, as a state.

use super::State;
use super::given_entries::full_frame_indices;
use super::problem::StateProblem;
use super::read::{StateReader, kind};
use crate::names;
use hamel_codegen::generate::Generated;
use hamel_codegen::syntax::path::plain;
use serde_json::Value;

/// Changes all coordinates, velocities and states of first order to those of the last sample; `text` is that of the
/// description.
pub fn read_last_sample(
    start: State,
    list: &[Value],
    (generated, text): (&Generated, &str),
) -> Result<State, Vec<StateProblem>> {
    let model = &generated.active;
    let mut state = start.clone();
    let mut reader = StateReader::new(generated, text);
    let place = format!("[{}]", list.len().saturating_sub(1));
    let sample = match list.last() {
        Some(Value::Object(sample)) => sample,
        Some(other) => {
            let message = format!("expected a sample, found {}", kind(other));
            return Err(vec![StateProblem::new(place, message)]);
        }
        None => return Err(vec![StateProblem::new("", "a list without a sample")]),
    };
    let mut number = |name: &String| {
        let found = sample.iter().find(|(key, _)| plain(key) == plain(name));
        match found {
            Some((_, value)) => reader.number(&format!("{place}.{name}"), value),
            None => {
                reader.error(
                    &place,
                    format!("`{name}` is missing: the last sample of a list, as `hamel simulate --out` writes it, has to give all coordinates and velocities"),
                );
                None
            }
        }
    };
    let x: Vec<Option<f64>> = names::coordinates(model).iter().map(&mut number).collect();
    let xi: Vec<Option<f64>> = names::velocities_and_states(model)
        .iter()
        .map(&mut number)
        .collect();
    for (place, value) in x.into_iter().enumerate() {
        if let Some(value) = value {
            reader.put_x(&mut state.x, place, &[value]);
        }
    }
    let places = full_frame_indices(generated);
    for (place, value) in xi.into_iter().enumerate() {
        match (value, places.get(place)) {
            (Some(value), Some(&full)) if place < model.n() => reader.put_xi(full, &[value]),
            (Some(value), _) => reader.put_z(&mut state.xi, place - model.n(), value),
            (None, _) => {}
        }
    }
    reader.finish(generated, &mut state, &start)?;
    Ok(state)
}
