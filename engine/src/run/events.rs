//! Events of a run: sign changes of a watched quantity.

use super::sample::Sample;
use crate::mechanism::{Instance, Numbers};
use crate::method::Stepper;
use hamel::adaptive::{self, Direction};
use hamel::{State, StepError, step};
use std::cell::Cell;
use std::fmt;
use std::sync::Arc;

/// Largest number of bisections of a step that contains an event: more are below rounding.
const MAX_BISECTIONS: usize = 60;

/// Function of t, x and ξ, supplied by another program, whose sign changes are events.
pub type EventFunction = dyn Fn(f64, &[f64], &[f64]) -> f64 + Send + Sync;

/// Quantity whose sign changes are events.
#[derive(Clone)]
pub enum EventQuantity {
    /// An expression in names of the description.
    Expression(String),
    /// A function.
    Function(Arc<EventFunction>),
}

/// Event of a run: a sign change of a quantity.
#[derive(Clone, Debug)]
pub struct Event {
    /// Name.
    pub name: String,
    /// The watched quantity.
    pub of: EventQuantity,
    /// Sign changes that count.
    pub direction: Direction,
    /// Whether the run ends there.
    pub terminal: bool,
}

impl fmt::Debug for EventQuantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EventQuantity::Expression(text) => write!(f, "Expression({text:?})"),
            EventQuantity::Function(_) => f.write_str("Function"),
        }
    }
}

impl Event {
    /// Returns the expression, unless the quantity is a function.
    pub fn expression(&self) -> Option<&str> {
        match &self.of {
            EventQuantity::Expression(text) => Some(text),
            EventQuantity::Function(_) => None,
        }
    }

    /// Converts the event for runs with steps chosen by a tolerance.
    pub fn to_adaptive<'g>(
        &self,
        gauge: &'g dyn Fn(&State<Instance>) -> f64,
    ) -> adaptive::Event<'g, Instance> {
        let event = adaptive::Event::new(gauge);
        let event = match self.direction {
            Direction::Any => event,
            Direction::Rising => event.rising(),
            Direction::Falling => event.falling(),
        };
        match self.terminal {
            true => event.stopping(),
            false => event,
        }
    }

    /// Returns the sign of a change from one value to another if it counts; leaving a zero is not an event.
    fn sign(&self, from: f64, to: f64) -> Option<f64> {
        let rises = from < 0.0 && to >= 0.0 && self.direction != Direction::Falling;
        let falls = from > 0.0 && to <= 0.0 && self.direction != Direction::Rising;
        match (rises, falls) {
            (true, _) => Some(1.0),
            (_, true) => Some(-1.0),
            _ => None,
        }
    }
}

/// Events of one run, and their occurrences.
#[derive(Default)]
pub struct Events {
    list: Vec<Event>,
    /// Index of each expression among the outputs of the system.
    outputs: Vec<Option<usize>>,
    /// The last state, with the values of all events.
    last: Option<(State<Instance>, Vec<f64>)>,
    /// The states at each event, in order of time.
    pub happened: Vec<Vec<Sample>>,
    /// The event that ended the run.
    pub stopped_by: Option<usize>,
    /// An event without a value.
    undefined: Cell<Option<usize>>,
}

impl Events {
    /// Prepares the events of a system; expressions are outputs of the system, in this order with the names `name(i)`.
    pub fn new(list: Vec<Event>, system: &Instance, name: impl Fn(usize) -> String) -> Self {
        let mut expressions = 0..;
        let outputs = list.iter().map(|event| match event.of {
            EventQuantity::Function(_) => None,
            EventQuantity::Expression(_) => {
                let name = name(expressions.next().unwrap_or(0));
                let mut all = system.outputs().iter();
                all.position(|output| output.name == name)
            }
        });
        Events {
            outputs: outputs.collect(),
            happened: vec![Vec::new(); list.len()],
            list,
            ..Events::default()
        }
    }

    /// Returns all events.
    pub fn list(&self) -> &[Event] {
        &self.list
    }

    /// Returns the name of the event that last had no value (NaN) at a state of the run so far, if any.
    pub fn undefined(&self) -> Option<&str> {
        let event = self.list.get(self.undefined.get()?)?;
        Some(&event.name)
    }

    /// Evaluates the quantity of an event.
    pub fn value(&self, index: usize, system: &Instance, state: &State<Instance>) -> f64 {
        let output = self.outputs.get(index).copied().flatten();
        let value = match (self.list.get(index).map(|event| &event.of), output) {
            (Some(EventQuantity::Function(gauge)), _) => gauge(state.t, &state.x, &state.xi),
            (_, Some(output)) => {
                let output = &system.outputs()[output];
                let value = system.output(output, state.t, &state.x, &state.xi);
                value.first().copied().unwrap_or(f64::NAN)
            }
            _ => f64::NAN,
        };
        if value.is_nan() {
            self.undefined.set(Some(index));
        }
        value
    }

    /// Begins watching at a state.
    ///
    /// # Errors
    /// If an event has no value there.
    pub fn begin(&mut self, system: &Instance, state: &State<Instance>) -> Result<(), StepError> {
        if !self.list.is_empty() {
            let values = self.values(system, state)?;
            self.last = Some((state.clone(), values));
        }
        Ok(())
    }

    /// Observes the end of a step; returns the final state if the run ends within the step.
    ///
    /// # Errors
    /// If an event has no value.
    pub fn see(
        &mut self,
        system: &Instance,
        stepper: &Stepper,
        state: &State<Instance>,
    ) -> Result<Option<State<Instance>>, StepError> {
        let Some((before, values)) = self.last.take() else {
            return Ok(None);
        };
        let now = self.values(system, state)?;
        let mut found: Vec<(usize, State<Instance>)> = Vec::new();
        for (index, event) in self.list.iter().enumerate() {
            let Some(sign) = event.sign(values[index], now[index]) else {
                continue;
            };
            let holds = |state: &State<Instance>| sign * self.value(index, system, state) >= 0.0;
            found.push((
                index,
                locate_event(system, stepper, (&before, state), &holds),
            ));
        }
        if self.undefined.get().is_some() {
            return Err(StepError::NonFinite { time: state.t });
        }
        found.sort_by(|(_, a), (_, b)| a.t.total_cmp(&b.t));
        for (index, at) in found {
            self.happened[index].push(Sample::of(system, &at));
            if self.list[index].terminal {
                self.stopped_by = Some(index);
                return Ok(Some(at));
            }
        }
        self.last = Some((state.clone(), now));
        Ok(None)
    }

    fn values(&self, system: &Instance, state: &State<Instance>) -> Result<Vec<f64>, StepError> {
        let all = 0..self.list.len();
        let values = all.map(|index| self.value(index, system, state)).collect();
        match self.undefined.get() {
            Some(_) => Err(StepError::NonFinite { time: state.t }),
            None => Ok(values),
        }
    }
}

/// Locates, by bisection with steps of the method, the first state between two others at which a condition begins to
/// hold; it is false at the former and true at the latter.
pub fn locate_event(
    system: &Instance,
    stepper: &Stepper,
    (from, end): (&State<Instance>, &State<Instance>),
    holds: &dyn Fn(&State<Instance>) -> bool,
) -> State<Instance> {
    let inputs = |t, x: &Numbers, xi: &Numbers| system.inputs(t, x, xi);
    let (mut before, mut after) = (from.t, end.clone());
    for _ in 0..MAX_BISECTIONS {
        let middle = before + 0.5 * (after.t - before);
        if middle <= before || middle >= after.t {
            break;
        }
        let mut state = from.clone();
        match step(system, stepper, &mut state, middle - from.t, &inputs) {
            Ok(()) => {
                state.t = middle;
                match holds(&state) {
                    true => after = state,
                    false => before = middle,
                }
            }
            // A step that fails cannot be divided.
            Err(_) => break,
        }
    }
    after
}
