//! What acts on a run from outside: columns of a file over time, and expressions of time and state.

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

/// What inputs are in a run.
#[derive(Args, Clone, Debug, Default)]
pub struct Asked {
    /// Inputs over time: a column `t` and columns with names of inputs, as in `t,F,tau[2]`; between two rows on a
    /// straight line. Inputs without a column keep their values.
    #[arg(long, value_name = "F.csv")]
    pub inputs: Option<PathBuf>,
    /// Values of --inputs hold until the next row, and behind the last.
    #[arg(long, requires = "inputs")]
    pub hold: bool,
    /// An input as an expression of `t`, parameters, coordinates, velocities and states.
    #[arg(long, value_name = "NAME = EXPR")]
    pub input: Vec<String>,
}

/// u as a function of t, x and ξ.
#[derive(Clone, Debug)]
pub struct Inputs {
    table: Option<Table>,
    expressions: Option<Expressions>,
    law: Option<Law>,
}

/// A function of t, x and ξ that sets entries of u: a controller of another program.
#[derive(Clone)]
pub struct Law(pub Arc<Control>);

/// What such a function is.
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
        }
    }
}

impl Inputs {
    /// Reads what was asked for in a run of this length; none where all inputs keep their values.
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
                    "`{name}` has a column of --inputs and an --input: one of the two is needed"
                )));
            }
        }
        Ok(
            (table.is_some() || expressions.is_some()).then_some(Inputs {
                table,
                expressions,
                law: None,
            }),
        )
    }

    /// Times at which inputs jump.
    pub fn jumps(&self) -> &[f64] {
        self.table.as_ref().map_or(&[], Table::jumps)
    }

    /// The same with other values of the parameters.
    pub fn with_params(mut self, params: &[f64]) -> Self {
        if let Some(expressions) = &mut self.expressions {
            expressions.set_params(params);
        }
        self
    }

    /// Whether an entry of u has a column or an expression.
    pub fn has(&self, place: usize) -> bool {
        let expressions = self.expressions.iter();
        self.table.as_ref().is_some_and(|table| table.has(place))
            || expressions
                .flat_map(Expressions::places)
                .any(|known| known == place)
    }

    /// Sets the entries of u that change; the others keep their values.
    pub fn set(&self, t: f64, x: &[f64], xi: &[f64], u: &mut [f64]) {
        if let Some(table) = &self.table {
            table.set(t, u);
        }
        if let Some(expressions) = &self.expressions {
            expressions.set(t, x, xi, u);
        }
        if let Some(Law(law)) = &self.law {
            law(t, x, xi, u);
        }
    }
}

/// The numbers of an expression that mentions parameters alone.
pub fn constant(
    expression: &str,
    generated: &Generated,
    params: &[f64],
) -> Result<Vec<f64>, String> {
    expressions::constant(expression, &generated.active, params)
}

/// The times of samples, from the column `t` of a file.
pub fn times(path: &Path, until: f64) -> Result<Vec<f64>, Failure> {
    file::times(path, until)
}

/// The place of an entry of the inputs, as it is written or plainly; why there is none.
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
