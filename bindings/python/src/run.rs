//! Runs: their options, and their results as arrays.

use crate::failure::{HamelError, raised};
use crate::function::axes;
use crate::law::{Raised, gauge, law, stop};
use hamel::adaptive::Direction;
use hamel_cli::read_series;
use hamel_codegen::program::Shape;
use hamel_engine::run::{Event, EventOccurrences, EventQuantity, Every};
use hamel_engine::{
    InputOptions, InputSource, RunArrays, Samples, Session, Simulation, State, Stepping,
};
use numpy::ndarray::IxDyn;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// An event from Python: name, expression or function, sign of the changes that count or zero for both, and whether the
/// run ends there.
type Given = (String, Py<PyAny>, i8, bool);

/// Converts events from Python; the first exception of a function is kept in `raised`.
fn watched(py: Python<'_>, given: Vec<Given>, raised: &Raised) -> PyResult<Vec<Event>> {
    let event = |(name, of, direction, terminal): Given| {
        let of = match of.extract::<String>(py) {
            Ok(text) => EventQuantity::Expression(text),
            Err(_) => EventQuantity::Function(gauge(&name, of, raised)),
        };
        Ok(Event {
            name,
            of,
            direction: match direction {
                1.. => Direction::Rising,
                0 => Direction::Any,
                _ => Direction::Falling,
            },
            terminal,
        })
    };
    given.into_iter().map(event).collect()
}

/// Converts `count` rows, each of shape `own`, to an array.
fn rows<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    count: usize,
    own: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let shape = [&[count], own].concat();
    PyArray1::from_vec(py, numbers).reshape(IxDyn(&shape))
}

/// Integrates the motion from a state, and returns the fields of `hamel.Run`.
pub fn simulate<'py>(
    py: Python<'py>,
    session: &Session,
    state: &State,
    options: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyDict>> {
    let get = |name: &str| -> PyResult<Option<Bound<'py, PyAny>>> {
        Ok(options.get_item(name)?.filter(|value| !value.is_none()))
    };
    let number = |name: &str| -> PyResult<Option<f64>> {
        get(name)?.map(|value| value.extract()).transpose()
    };
    let stepping = Stepping {
        until: number("until")?.unwrap_or(f64::NAN),
        step: number("step")?,
        tol: number("tol")?,
        lambda: number("rate")?,
        method: match get("method")? {
            Some(name) => name.extract()?,
            None => "auto".into(),
        },
    };
    let every = match get("every")? {
        Some(steps) => match steps.extract::<i64>()? {
            steps @ 1.. => Some(Every::Steps(steps.unsigned_abs())),
            _ => {
                return Err(HamelError::new_err(
                    "`every` is a number of steps, 1 or greater",
                ));
            }
        },
        None => match number("spacing")? {
            Some(time) if !(time.is_finite() && time > 0.0) => {
                return Err(HamelError::new_err("`spacing` is a time greater than zero"));
            }
            spacing => spacing.map(Every::Time),
        },
    };
    let times: Option<Vec<f64>> = get("times")?.map(|times| times.extract()).transpose()?;
    let asked = InputOptions {
        series: match get("file")? {
            Some(path) => Some(
                read_series(&path.extract::<PathBuf>()?)
                    .map_err(|error| HamelError::new_err(error.to_string()))?,
            ),
            None => None,
        },
        hold: get("hold")?.is_some(),
        expressions: match get("expressions")? {
            Some(all) => all.extract()?,
            None => Vec::new(),
        },
    };
    let thrown = Raised::default();
    let own = get("law")?.map(|function| law(function.unbind(), &thrown));
    let events = match get("events")? {
        Some(all) => watched(py, all.extract()?, &thrown)?,
        None => Vec::new(),
    };
    let simulation = Simulation {
        stepping,
        samples: match (times, every) {
            (Some(times), _) => Samples::At(times),
            (None, Some(every)) => Samples::Every(every),
            (None, None) => Samples::Usual,
        },
        inputs: match own {
            Some(law) => InputSource::ControlLaw(law),
            None => InputSource::Options(asked),
        },
        events,
        stop: Some(stop(&thrown)),
    };
    let run = py.detach(|| {
        let run = session.simulate(state, &simulation)?;
        Ok(RunArrays::of(&run))
    });
    if let Some(error) = thrown.take() {
        return Err(error);
    }
    let run = run.map_err(raised)?;
    let all = PyDict::new(py);
    let samples = run.t.len();
    let list = |numbers: Vec<f64>, own: &[usize]| rows(py, numbers, samples, own);
    let parts = |parts: Vec<(String, Shape, Vec<f64>)>| -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (name, shape, numbers) in parts {
            all.set_item(name, list(numbers, &axes(shape))?)?;
        }
        Ok(all)
    };
    all.set_item("t", list(run.t, &[])?)?;
    all.set_item("x", list(run.x, &[state.x.len()])?)?;
    all.set_item("xi", list(run.xi, &[state.xi.len()])?)?;
    all.set_item("energy", list(run.energy, &[])?)?;
    all.set_item("outputs", parts(run.outputs)?)?;
    all.set_item("invariants", parts(run.invariants)?)?;
    all.set_item("method", run.method)?;
    all.set_item("reason", run.reason)?;
    all.set_item("steps", run.steps)?;
    all.set_item("evaluations", run.evaluations)?;
    all.set_item("energy_deviation", run.energy_deviation)?;
    all.set_item("constraint", run.constraint)?;
    all.set_item("failure", run.failure.map(|why| why.to_string()))?;
    let happened = PyDict::new(py);
    for EventOccurrences { name, t, x, xi } in run.events {
        let times = t.len();
        let parts = (
            rows(py, t, times, &[])?,
            rows(py, x, times, &[state.x.len()])?,
            rows(py, xi, times, &[state.xi.len()])?,
        );
        happened.set_item(name, parts)?;
    }
    all.set_item("events", happened)?;
    all.set_item("stopped_by", run.stopped_by)?;
    Ok(all)
}
