//! Inputs of a run: columns of a file over time, and expressions in time and state.

mod expressions;
mod file;

use crate::names;
use crate::state::State;
pub use expressions::ExpressionProblem;
use expressions::Expressions;
use file::Table;
pub use file::TableProblem;
use hamel_codegen::generate::Generated;
use hamel_codegen::syntax::path::plain;
use hamel_codegen::syntax::suggest::closest;
use std::error;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The inputs that are asked for in a run; all others keep their values.
#[derive(Clone, Debug, Default)]
pub struct InputOptions {
    /// A CSV file of inputs over time: a column `t`, which is the time of the description where that declares one, and
    /// columns with names of inputs, as in `t,F,tau[2]`; between two rows on a straight line.
    pub file: Option<PathBuf>,
    /// Whether values of the file hold until the next row, and after the last.
    pub hold: bool,
    /// Inputs as expressions of `t`, parameters, coordinates, velocities and states: `NAME = EXPRESSION`.
    pub expressions: Vec<String>,
}

/// Why inputs cannot be what was asked for.
#[derive(Debug)]
pub enum InputProblem {
    /// A file of numbers over time is wrong.
    File {
        /// Its path.
        path: PathBuf,
        /// The reason.
        problem: TableProblem,
    },
    /// An expression of an input is wrong.
    Expression {
        /// The text, with the name of the input.
        text: String,
        /// The reason.
        problem: ExpressionProblem,
    },
    /// An input has a column of a file and an expression.
    Twice {
        /// Name.
        name: String,
    },
}

impl fmt::Display for InputProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            InputProblem::File { path, problem } => write!(f, "{}: {problem}", path.display()),
            InputProblem::Expression { text, problem } => {
                write!(f, "--input \"{text}\": {problem}")
            }
            InputProblem::Twice { name } => write!(
                f,
                "`{name}` is given by a column of --inputs and by --input: remove one of the two"
            ),
        }
    }
}

impl error::Error for InputProblem {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            InputProblem::File { problem, .. } => Some(problem),
            InputProblem::Expression { problem, .. } => Some(problem),
            InputProblem::Twice { .. } => None,
        }
    }
}

/// An input that a description does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownInput {
    /// The name that was given.
    pub name: String,
    /// The input whose name is closest.
    pub closest: Option<String>,
    /// All entries of the inputs.
    pub known: Vec<String>,
}

impl fmt::Display for UnknownInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no input is called `{}`: ", self.name)?;
        match (&self.closest, self.known.as_slice()) {
            (Some(close), _) => write!(f, "did you mean `{close}`?"),
            (None, []) => f.write_str("the description has no inputs"),
            (None, known) => write!(f, "the inputs are {}", known.join(", ")),
        }
    }
}

impl error::Error for UnknownInput {}

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
        asked: &InputOptions,
        until: f64,
        generated: &Generated,
        state: &State,
    ) -> Result<Option<Self>, InputProblem> {
        let model = &generated.active;
        let entries: Vec<String> = model.inputs.iter().flat_map(names::group).collect();
        let of_file = |problem| InputProblem::File {
            path: asked.file.clone().unwrap_or_default(),
            problem,
        };
        let table = asked.file.as_deref();
        let table = table.map(|path| Table::read(path, &entries, asked.hold, until));
        let table = table.transpose().map_err(of_file)?;
        let expressions = Expressions::new(&asked.expressions, model, &state.params)?;
        if let (Some(table), Some(expressions)) = (&table, &expressions) {
            let both = expressions.places().find(|place| table.has(*place));
            if let Some(place) = both {
                let name = entries[place].clone();
                return Err(InputProblem::Twice { name });
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
        inputs.started(state).map(Some).map_err(of_file)
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
    pub fn started(mut self, state: &State) -> Result<Self, TableProblem> {
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
) -> Result<Vec<f64>, ExpressionProblem> {
    expressions::constant(expression, &generated.active, params)
}

/// Reads the column `t` of a file as times of samples, and returns them relative to the start of a run from `state`.
pub fn times(
    path: &Path,
    until: f64,
    generated: &Generated,
    state: &State,
) -> Result<Vec<f64>, InputProblem> {
    let clock = generated.active.clock.map(|clock| clock.x);
    file::times(path, begin(clock, state), until).map_err(|problem| InputProblem::File {
        path: path.to_path_buf(),
        problem,
    })
}

/// The description's time at a state; 0 if it declares none.
fn begin(clock: Option<usize>, state: &State) -> f64 {
    clock
        .and_then(|place| state.x.get(place))
        .copied()
        .unwrap_or(0.0)
}

/// The index of an input entry, by its written or plain name.
fn place(name: &str, entries: &[String]) -> Result<usize, UnknownInput> {
    let found = |entry: &String| entry == name || plain(entry) == plain(name);
    entries.iter().position(found).ok_or_else(|| UnknownInput {
        name: name.into(),
        closest: closest(name, entries.iter().map(String::as_str)).map(String::from),
        known: entries.to_vec(),
    })
}
