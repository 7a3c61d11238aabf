//! Systems whose outputs include the expressions of events.

use crate::error::Error;
use crate::mechanism::{Instance, Mechanism};
use crate::option_text::{Piece, invalid_option};
use crate::run::Event;
use crate::source::Source;
use crate::source::added_outputs::{self, AddedOutput};
use crate::state::State;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Shape;
use std::sync::{Arc, Mutex, PoisonError};

/// Largest number of systems that are kept.
const MAX_CACHED_SYSTEMS: usize = 8;

/// Name of the texts of all events in messages.
const EVENTS: &str = "events";

/// Cache of the most recent systems, by the texts of their events.
#[derive(Default)]
pub struct EventSystemCache(Mutex<Vec<(Vec<String>, Arc<EventSystem>)>>);

impl EventSystemCache {
    /// Returns the system for these events, derived on first use; `None` if no event is an expression.
    pub fn of(&self, source: &Source, events: &[Event]) -> Result<Option<Arc<EventSystem>>, Error> {
        let texts: Vec<&str> = events.iter().filter_map(Event::expression).collect();
        if texts.is_empty() {
            return Ok(None);
        }
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = known().iter().find(|(of, _)| *of == texts) {
            return Ok(Some(Arc::clone(found)));
        }
        let made = Arc::new(EventSystem::new(source, &texts.join("; "), &texts)?);
        let mut all = known();
        if all.len() >= MAX_CACHED_SYSTEMS {
            all.remove(0);
        }
        let own = texts.into_iter().map(str::to_owned).collect();
        all.push((own, Arc::clone(&made)));
        Ok(Some(made))
    }
}

/// Compiled description with the expressions of events as additional outputs.
pub struct EventSystem {
    pub generated: Arc<Generated>,
    mechanism: Arc<Mechanism>,
}

impl EventSystem {
    /// Adds these expressions as outputs; they follow one another in the text `said`.
    pub fn new(source: &Source, said: &str, expressions: &[&str]) -> Result<Self, Error> {
        let mut errors = Vec::new();
        let (mut outputs, mut start) = (Vec::new(), 0);
        for (index, text) in expressions.iter().enumerate() {
            let whole = Piece { text, start };
            start += text.len() + "; ".len();
            match Piece::of(text) {
                Err(error) => errors.push(whole.moved(error)),
                Ok(_) if text.trim().is_empty() => {
                    errors.push(whole.wrong("expected an expression"))
                }
                Ok(_) if whole.split(';').len() > 1 => {
                    errors.push(whole.wrong("expected one expression"));
                }
                Ok(_) => outputs.push(AddedOutput {
                    name: added_outputs::name(index),
                    whole,
                    sides: vec![whole],
                }),
            }
        }
        let generated = added_outputs::derive(
            source,
            (EVENTS, said),
            &outputs,
            errors,
            Source::try_derive_default_functions,
        )?;
        let mut errors = Vec::new();
        for AddedOutput { name, whole, .. } in &outputs {
            let function = generated.program.function(name);
            if function.is_none_or(|function| function.shape != Shape::Scalar) {
                errors.push(whole.wrong("an event is a zero of one number"));
            }
        }
        if !errors.is_empty() {
            return Err(invalid_option(EVENTS, said, &errors));
        }
        let mechanism = Arc::new(Mechanism::new(&generated, source.shown())?);
        Ok(EventSystem {
            generated: Arc::new(generated),
            mechanism,
        })
    }

    /// Creates the system of a run from a state.
    pub fn instance(&self, state: &State) -> Result<Instance, Error> {
        let instance = Instance::of(&self.mechanism, state)?;
        instance.check_parameters(&state.x)?;
        Ok(instance)
    }
}
