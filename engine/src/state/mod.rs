//! States: those of a description, changed by a JSON file.
//!
//! `{"param": {…}, "coord": {…}, "velocity": {…}, "state": {…}, "input": {…}}`, all optional, or, by joints,
//! `{"configuration": {…}, "velocity": {…}, "param": {…}}`; or a list of samples, of which the last counts. All errors
//! are reported at once, each with its path in the file. Values that a file does not give are completed like the start
//! of a description, so that loops are closed and constraints on velocities are satisfied; given values are kept, and
//! refused if they contradict these.

mod complete;
mod coupling;
pub(crate) mod dependent_velocities;
mod file;
pub(crate) mod given_entries;
mod joint_state;
mod joints;
mod json;
mod last_sample;
mod plain_names;
mod problem;
mod read;
#[cfg(test)]
mod tests;
mod write;

pub use dependent_velocities::constraint_lines;
pub use file::StateFile;
pub use joint_state::{JointState, VELOCITY_ORDER};
pub use joints::{Joint, joints, rows};
pub use json::{JsonError, parse};
pub use problem::StateProblem;

use crate::error::Error;
use crate::source::Source;
use hamel_codegen::algebra::graph::{Edge, Graph};
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::algebra::residual_scale::relative_residuals;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::Model;
use hamel_codegen::model::layout::Block;
use read::StateReader;
use serde_json::Value;
use std::path::Path;

/// State of a system, with its parameters and inputs.
#[derive(Clone, Debug)]
pub struct State {
    /// Parameters, in order of their symbols.
    pub params: Vec<f64>,
    /// x.
    pub x: Vec<f64>,
    /// ξ, followed by the states of first order.
    pub xi: Vec<f64>,
    /// The inputs u.
    pub u: Vec<f64>,
}

/// Largest |φ(x)| that counts as rounding in a state that was written down.
const MANIFOLD_TOLERANCE: f64 = 1e-6;

impl State {
    /// Returns the start of a description, with default parameters and zero inputs.
    pub fn start(model: &Model) -> Self {
        State {
            params: model.defaults.clone(),
            x: model.start_x.clone(),
            xi: [&model.start_xi[..], &model.start_z].concat(),
            u: vec![0.0; model.m()],
        }
    }

    /// Reads the start of a description, changed by a file if one is given.
    pub fn read(source: &Source, generated: &Generated, at: Option<&Path>) -> Result<Self, Error> {
        match at {
            Some(path) => StateFile::read(path, source)?.state(source, generated),
            None => Ok(State::start(&generated.active)),
        }
    }

    /// Reads a state: the start of a description, changed by a JSON value with coordinates; `text` is that of the
    /// description.
    pub fn of(generated: &Generated, text: &str, json: &Value) -> Result<Self, Vec<StateProblem>> {
        State::start(&generated.active).changed((generated, text), &[], json)
    }

    /// Like [`of`](Self::of) for another state; `names` are those of joints in the robot's file, with those in the
    /// description.
    pub fn changed(
        self,
        (generated, text): (&Generated, &str),
        names: &[(String, String)],
        json: &Value,
    ) -> Result<Self, Vec<StateProblem>> {
        let mut state = self.clone();
        let mut reader = StateReader::new(generated, text);
        reader.state(json, generated, names, &mut state);
        reader.finish(generated, &mut state, &self)?;
        Ok(state)
    }

    /// Returns the violations of the configuration manifold, from the residuals.
    fn violations(&self, model: &Model, residuals: &[f64]) -> Vec<StateProblem> {
        let mut errors: Vec<StateProblem> = Vec::new();
        let differences = self.phi(model, evaluate);
        for (((_, text), residual), difference) in model.phi.iter().zip(residuals).zip(differences)
        {
            // NaN is a violation, too.
            if residual.is_nan() || residual.abs() > MANIFOLD_TOLERANCE {
                errors.push(StateProblem::new(
                    self.place(model, text),
                    format!("violates {text}, the difference is {difference:.2e}"),
                ));
            }
        }
        let mut offset = 0;
        for &block in &model.blocks {
            let entries = &self.x[offset..offset + block.len()];
            if block == Block::Rotation && errors.is_empty() && determinant(entries) < 0.0 {
                let name = model
                    .coordinates
                    .iter()
                    .rfind(|c| c.offset <= offset)
                    .map_or("", |c| c.name.as_str());
                errors.push(StateProblem::new(
                    format!("coord.{name}"),
                    "a reflection: its determinant is -1",
                ));
            }
            offset += block.len();
        }
        errors
    }

    /// φ(x) relative to its terms.
    fn residuals(&self, model: &Model) -> Vec<f64> {
        let places = model.points.places();
        self.phi(model, |graph, phi, numbers| {
            relative_residuals(graph, phi, numbers, places.clone())
        })
    }

    fn phi(&self, model: &Model, of: impl Fn(&Graph, &[Edge], &[f64]) -> Vec<f64>) -> Vec<f64> {
        let (xi, u) = (vec![0.0; model.n()], vec![0.0; model.u.len()]);
        let numbers = model.numbers(&self.params, &self.x, &xi, &u, &xi);
        let rows: Vec<_> = model.phi.iter().map(|(edge, _)| *edge).collect();
        of(&model.points.free, &rows, &numbers)
    }

    /// Returns the coordinates that a constraint mentions, as paths.
    fn place(&self, model: &Model, text: &str) -> String {
        let words: Vec<&str> = text
            .split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .collect();
        let names = model
            .coordinates
            .iter()
            .filter(|c| words.contains(&c.name.as_str()));
        let paths: Vec<String> = names.map(|c| format!("coord.{}", c.name)).collect();
        if paths.is_empty() {
            "coord".into()
        } else {
            paths.join(", ")
        }
    }
}

fn determinant(r: &[f64]) -> f64 {
    let minor = |a: usize, b: usize| r[3 + a] * r[6 + b] - r[3 + b] * r[6 + a];
    r[0] * minor(1, 2) - r[1] * minor(0, 2) + r[2] * minor(0, 1)
}
