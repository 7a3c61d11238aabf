//! One member: its state, its run, and the row that is kept of it.

use super::vary::Vary;
use super::watch::{Keeping, Watch};
use crate::failure::Failure;
use crate::mechanism::{Instance, Mechanism};
use crate::simulate::balance::Balance;
use crate::simulate::inputs::Inputs;
use crate::simulate::record::{Early, Plan, advance, ended};
use crate::state::State;
use hamel_codegen::generate::Generated;
use serde_json::{Map, Value};
use std::cell::Cell;
use std::sync::Arc;

/// What systems of all members are made of.
pub struct Family {
    /// The system, with outputs for what is kept.
    pub generated: Generated,
    /// Its functions, compiled.
    pub mechanism: Arc<Mechanism>,
    /// The text of the description, for states and for messages.
    pub text: String,
    /// What acts on members from outside.
    pub given: Option<Inputs>,
}

/// All that members share.
pub struct Sweep {
    /// Their systems.
    pub family: Family,
    /// What is varied.
    pub vary: Vary,
    /// What is kept.
    pub keeping: Keeping,
    /// How members are run, by the method of the first one.
    pub plan: Plan,
    /// The state that members are changes of, in JSON.
    pub base: Map<String, Value>,
}

/// What is kept of a member.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its number.
    pub index: u64,
    /// What was varied.
    pub varied: Vec<f64>,
    /// What was kept; empty where it failed.
    pub kept: Vec<Option<f64>>,
    /// Why it failed.
    pub error: Option<String>,
}

impl Sweep {
    /// Runs a member.
    pub fn row(&self, index: u64) -> Row {
        let varied = self.vary.values(index);
        let run = self.run(&varied);
        let (kept, error) = match run {
            Ok(kept) => (kept, None),
            Err(Early { kind, why }) => (Vec::new(), Some(format!("{kind}: {why}"))),
        };
        Row {
            index,
            varied,
            kept,
            error,
        }
    }

    fn run(&self, varied: &[f64]) -> Result<Vec<Option<f64>>, Early> {
        let system = self.family.member(&self.vary.state(varied, &self.base))?;
        let plan = Plan {
            method: self.plan.method.of_another(&system),
            ..self.plan.clone()
        };
        let mut state = hamel::State::start(&system);
        let balance = Cell::new(Balance::new(&system, &state));
        let mut watch = Watch::new(&self.keeping, &system, &plan.method.stepper);
        let outcome = advance(&system, &plan, &mut state, &balance, |state, place| {
            if plan.tolerance.is_some() {
                balance.set(balance.get().after(&system, state));
            }
            watch.see(state, place);
        });
        let early = ended(&system, &plan, outcome, &state, balance.get());
        match early.map_err(|failure| of_start(&failure))? {
            Some(early) => Err(early),
            None => Ok(watch.finish(&state)),
        }
    }
}

impl Family {
    /// The system of a member whose state is this: the only place where one is made.
    pub fn member(&self, state: &Value) -> Result<Instance, Early> {
        let state = State::of(&self.generated, &self.text, state).map_err(|errors| Early {
            kind: "start",
            why: errors.join("; "),
        })?;
        let system = Instance::of(&self.mechanism, &state);
        let system = system.map_err(|failure| of_start(&failure))?;
        let given = self.given.clone();
        let system = system.with(given.map(|given| given.with_params(&state.params)));
        let singular = |failure: Failure| Early {
            kind: "singular",
            why: said(&failure),
        };
        system.check_parameters(&state.x).map_err(singular)?;
        Ok(system)
    }
}

fn of_start(failure: &Failure) -> Early {
    Early {
        kind: "start",
        why: said(failure),
    }
}

/// A failure in one line, without what it has for a terminal.
fn said(failure: &Failure) -> String {
    let text = match failure {
        Failure::Failed(text) | Failure::Usage(text) => text.as_str(),
        Failure::Closed => "",
    };
    let plain = anstream::adapter::strip_str(text).to_string();
    let line = plain.trim().trim_start_matches("error: ");
    line.split_whitespace().collect::<Vec<&str>>().join(" ")
}
