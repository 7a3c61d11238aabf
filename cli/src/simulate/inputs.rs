//! Inputs of a run: columns of a file over time, and expressions in time and state.

mod expressions;
mod file;

use crate::failure::Failure;
use crate::names;
use crate::state::State;
use clap::Args;
use expressions::Expressions;
use file::Table;
use hamel_codegen::generate::Generated;
use hamel_codegen::syntax::path::plain;
use hamel_codegen::syntax::suggest::closest;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Options for the inputs of a run.
#[derive(Args, Clone, Debug, Default)]
pub struct Asked {
    /// Read inputs over time: a column `t` and columns with names of inputs, as in `t,F,tau[2]`; linear between two
    /// rows. Inputs without a column keep their values. If the description declares a time, `t` is that time, as in
    /// --input.
    #[arg(long, value_name = "F.csv")]
    pub inputs: Option<PathBuf>,
    /// Hold the values of --inputs until the next row, and after the last.
    #[arg(long, requires = "inputs")]
    pub hold: bool,
    /// Set an input to an expression in `t`, parameters, coordinates, velocities and states.
    #[arg(long, value_name = "NAME = EXPR")]
    pub input: Vec<String>,
}

/// u as a function of t, x and ξ.
#[derive(Clone, Debug)]
pub struct Inputs {
    table: Option<Table>,
    expressions: Option<Expressions>,
    law: Option<Law>,
    /// Index in x of the time that the description declares.
    clock: Option<usize>,
    /// The description's time at the start of a run.
    begin: f64,
}

/// A function of t, x and ξ that sets entries of u: an external controller.
#[derive(Clone)]
pub struct Law(pub Arc<Control>);

/// Signature of a controller.
pub type Control = dyn Fn(f64, &[f64], &[f64], &mut [f64]) + Send + Sync;

impl fmt::Debug for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Law")
    }
}

impl From<Law> for Inputs {
    fn from(law: Law) -> Self {
        Inputs {
            table: None,
            expressions: None,
            law: Some(law),
            clock: None,
            begin: 0.0,
        }
    }
}

impl Inputs {
    /// Reads the requested inputs of a run of this length; `None` if all inputs are constant.
    pub fn new(
        asked: &Asked,
        until: f64,
        generated: &Generated,
        state: &State,
    ) -> Result<Option<Self>, Failure> {
        let model = &generated.active;
        let entries: Vec<String> = model.inputs.iter().flat_map(names::group).collect();
        let table = match &asked.inputs {
            Some(path) => Some(Table::read(path, &entries, asked.hold, until)?),
            None => None,
        };
        let expressions = Expressions::new(&asked.input, model, &state.params)?;
        if let (Some(table), Some(expressions)) = (&table, &expressions) {
            let both = expressions.places().find(|place| table.has(*place));
            if let Some(place) = both {
                let name = &entries[place];
                return Err(Failure::usage(format!(
                    "`{name}` is given by a column of --inputs and by --input: remove one of the two"
                )));
            }
        }
        if table.is_none() && expressions.is_none() {
            return Ok(None);
        }
        let inputs = Inputs {
            table,
            expressions,
            law: None,
            clock: model.clock.map(|clock| clock.x),
            begin: 0.0,
        };
        inputs.started(state).map(Some).map_err(|why| {
            let path = asked.inputs.as_deref().unwrap_or(Path::new(""));
            Failure::usage(format!("{}: {why}", path.display()))
        })
    }

    /// Times at which inputs jump.
    pub fn jumps(&self) -> &[f64] {
        self.table.as_ref().map_or(&[], Table::jumps)
    }

    /// The known reason why forces depend on velocities: an expression that mentions one.
    pub fn moving(&self) -> Option<String> {
        let name = self.expressions.as_ref()?.moving()?;
        Some(format!("the input `{name}`"))
    }

    /// Whether an external controller sets inputs, whose dependence is unknown.
    pub fn is_law(&self) -> bool {
        self.law.is_some()
    }

    /// The inputs for a run from another state; fails if they do not cover it.
    pub fn started(mut self, state: &State) -> Result<Self, String> {
        self.begin = begin(self.clock, state);
        if let Some(expressions) = &mut self.expressions {
            expressions.set_params(&state.params);
        }
        if let Some(table) = self.table {
            self.table = Some(table.from(self.begin)?);
        }
        Ok(self)
    }

    /// Whether an entry of u has a column or an expression.
    pub fn has(&self, place: usize) -> bool {
        let expressions = self.expressions.iter();
        self.table.as_ref().is_some_and(|table| table.has(place))
            || expressions
                .flat_map(Expressions::places)
                .any(|known| known == place)
    }

    /// Sets the varying entries of u at time t of a run; the others keep their values.
    pub fn set(&self, t: f64, x: &[f64], xi: &[f64], u: &mut [f64]) {
        if let Some(table) = &self.table {
            table.set(t, u);
        }
        if let Some(expressions) = &self.expressions {
            expressions.set(self.begin + t, x, xi, u);
        }
        if let Some(Law(law)) = &self.law {
            law(t, x, xi, u);
        }
    }
}

/// The value of an expression in parameters alone.
pub fn constant(
    expression: &str,
    generated: &Generated,
    params: &[f64],
) -> Result<Vec<f64>, String> {
    expressions::constant(expression, &generated.active, params)
}

/// The times of samples of a run from a state, from the column `t` of a file.
pub fn times(
    path: &Path,
    until: f64,
    generated: &Generated,
    state: &State,
) -> Result<Vec<f64>, Failure> {
    let clock = generated.active.clock.map(|clock| clock.x);
    file::times(path, begin(clock, state), until)
}

/// The description's time at a state; 0 if it declares none.
fn begin(clock: Option<usize>, state: &State) -> f64 {
    clock
        .and_then(|place| state.x.get(place))
        .copied()
        .unwrap_or(0.0)
}

/// The index of an input entry, by its written or plain name.
fn place(name: &str, entries: &[String]) -> Result<usize, String> {
    let found = |entry: &String| entry == name || plain(entry) == plain(name);
    entries.iter().position(found).ok_or_else(|| {
        let message = format!("no input is called `{name}`");
        match closest(name, entries.iter().map(String::as_str)) {
            Some(close) => format!("{message}: did you mean `{close}`?"),
            None if entries.is_empty() => format!("{message}: the description has no inputs"),
            None => format!("{message}: the inputs are {}", entries.join(", ")),
        }
    })
}
