//! Inputs of a run: time series, expressions in time and state, and functions of other programs.

mod expressions;
mod series;

use crate::names;
use crate::state::State;
pub use expressions::ExpressionProblem;
use expressions::Expressions;
use hamel_codegen::generate::Generated;
use hamel_codegen::syntax::path::plain;
use hamel_codegen::syntax::suggest::closest;
use series::InputColumns;
pub use series::{SeriesProblem, TimeSeries};
use std::error;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// Inputs that vary in a run; all others keep the values of the state.
#[derive(Clone, Debug, Default)]
pub struct InputOptions {
    /// Inputs over time: a column `t`, which is the time of the description if it declares one, and columns with names
    /// of inputs, as in `t`, `F`, `tau[2]`; linear between two rows.
    pub series: Option<TimeSeries>,
    /// Whether values of the series hold until the next row, and after the last.
    pub hold: bool,
    /// Inputs as expressions of `t`, parameters, coordinates, velocities and states: `NAME = EXPRESSION`.
    pub expressions: Vec<String>,
}

/// Error in the inputs of a run.
#[derive(Debug)]
pub enum InputProblem {
    /// A time series has an error.
    Series {
        /// Path of its file.
        path: PathBuf,
        /// The error.
        problem: SeriesProblem,
    },
    /// The expression of an input has an error.
    Expression {
        /// The text, with the name of the input.
        text: String,
        /// The error.
        problem: ExpressionProblem,
    },
    /// An input has both a column of a time series and an expression.
    Twice {
        /// Name of the input.
        name: String,
    },
}

impl fmt::Display for InputProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            InputProblem::Series { path, problem } => write!(f, "{}: {problem}", path.display()),
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
            InputProblem::Series { problem, .. } => Some(problem),
            InputProblem::Expression { problem, .. } => Some(problem),
            InputProblem::Twice { .. } => None,
        }
    }
}

/// Name that no input of a description has.
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

/// Inputs u as a function of t, x and ξ.
#[derive(Clone, Debug)]
pub struct Inputs {
    columns: Option<InputColumns>,
    expressions: Option<Expressions>,
    law: Option<ControlLaw>,
    /// Index in x of the time that the description declares.
    clock: Option<usize>,
    /// The description's time at the start of a run.
    begin: f64,
}

/// A function of t, x and ξ that sets entries of u: an external controller.
#[derive(Clone)]
pub struct ControlLaw(pub Arc<ControlFunction>);

/// Signature of a controller.
pub type ControlFunction = dyn Fn(f64, &[f64], &[f64], &mut [f64]) + Send + Sync;

impl fmt::Debug for ControlLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ControlLaw")
    }
}

impl From<ControlLaw> for Inputs {
    fn from(law: ControlLaw) -> Self {
        Inputs {
            columns: None,
            expressions: None,
            law: Some(law),
            clock: None,
            begin: 0.0,
        }
    }
}

impl Inputs {
    /// Checks the inputs of a run of length `until`, and prepares them; `None` if all inputs are constant.
    pub fn new(
        asked: &InputOptions,
        until: f64,
        generated: &Generated,
        state: &State,
    ) -> Result<Option<Self>, InputProblem> {
        let model = &generated.active;
        let entries: Vec<String> = model.inputs.iter().flat_map(names::group).collect();
        let path = asked.series.as_ref().map(|series| series.path.clone());
        let of_series = |problem| InputProblem::Series {
            path: path.clone().unwrap_or_default(),
            problem,
        };
        let columns = asked.series.as_ref();
        let columns = columns.map(|series| InputColumns::new(series, &entries, asked.hold, until));
        let columns = columns.transpose().map_err(of_series)?;
        let expressions = Expressions::new(&asked.expressions, model, &state.params)?;
        if let (Some(columns), Some(expressions)) = (&columns, &expressions) {
            let both = expressions.places().find(|place| columns.has(*place));
            if let Some(place) = both {
                let name = entries[place].clone();
                return Err(InputProblem::Twice { name });
            }
        }
        if columns.is_none() && expressions.is_none() {
            return Ok(None);
        }
        let inputs = Inputs {
            columns,
            expressions,
            law: None,
            clock: model.clock.map(|clock| clock.x),
            begin: 0.0,
        };
        inputs.started(state).map(Some).map_err(of_series)
    }

    /// Returns the times at which inputs jump.
    pub fn jumps(&self) -> &[f64] {
        self.columns.as_ref().map_or(&[], InputColumns::jumps)
    }

    /// Names the input whose expression depends on velocities; `None` if there is none.
    pub fn moving(&self) -> Option<String> {
        let name = self.expressions.as_ref()?.moving()?;
        Some(format!("the input `{name}`"))
    }

    /// Returns whether an external controller sets inputs, so that it is not known what they depend on.
    pub fn is_law(&self) -> bool {
        self.law.is_some()
    }

    /// Prepares the inputs for a run from another state; fails if the time series does not cover it.
    pub fn started(mut self, state: &State) -> Result<Self, SeriesProblem> {
        self.begin = begin(self.clock, state);
        if let Some(expressions) = &mut self.expressions {
            expressions.set_params(&state.params);
        }
        if let Some(columns) = self.columns {
            self.columns = Some(columns.from(self.begin)?);
        }
        Ok(self)
    }

    /// Returns whether an entry of u has a column or an expression.
    pub fn has(&self, place: usize) -> bool {
        let expressions = self.expressions.iter();
        self.columns
            .as_ref()
            .is_some_and(|columns| columns.has(place))
            || expressions
                .flat_map(Expressions::places)
                .any(|known| known == place)
    }

    /// Sets the varying entries of u at time t of a run; the others keep their values.
    pub fn set(&self, t: f64, x: &[f64], xi: &[f64], u: &mut [f64]) {
        if let Some(columns) = &self.columns {
            columns.set(t, u);
        }
        if let Some(expressions) = &self.expressions {
            expressions.set(self.begin + t, x, xi, u);
        }
        if let Some(ControlLaw(law)) = &self.law {
            law(t, x, xi, u);
        }
    }
}

/// Evaluates an expression of parameters and constants, entry by entry.
pub fn constant(
    expression: &str,
    generated: &Generated,
    params: &[f64],
) -> Result<Vec<f64>, ExpressionProblem> {
    expressions::constant(expression, &generated.active, params)
}

/// Returns the times of the rows of a time series, relative to the start of a run of length `until` from `state`, to
/// take samples at them.
pub fn times(
    series: &TimeSeries,
    until: f64,
    generated: &Generated,
    state: &State,
) -> Result<Vec<f64>, InputProblem> {
    let clock = generated.active.clock.map(|clock| clock.x);
    let times = series.sample_times(begin(clock, state), until);
    times.map_err(|problem| InputProblem::Series {
        path: series.path.clone(),
        problem,
    })
}

/// Returns the description's time at a state; 0 if it declares none.
fn begin(clock: Option<usize>, state: &State) -> f64 {
    clock
        .and_then(|place| state.x.get(place))
        .copied()
        .unwrap_or(0.0)
}

/// Finds the index of an input entry by its written or plain name.
fn place(name: &str, entries: &[String]) -> Result<usize, UnknownInput> {
    let found = |entry: &String| entry == name || plain(entry) == plain(name);
    entries.iter().position(found).ok_or_else(|| UnknownInput {
        name: name.into(),
        closest: closest(name, entries.iter().map(String::as_str)).map(String::from),
        known: entries.to_vec(),
    })
}
