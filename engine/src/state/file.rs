//! Reads the file of a state, in either of its forms: by coordinates, or by joints.

use super::problem::StateProblem;
use super::sample::{Sample, is_sample};
use super::samples;
use super::strict;
use super::values::State;
use super::written::plainly;
use crate::error::Error;
use crate::source::Source;
use hamel_codegen::generate::Generated;
use serde_json::Value;
use std::path::Path;

/// Members that only `hamel eval` takes, with the errors of other commands.
const OF_EVAL: [(&str, &str); 2] = [
    (
        "force",
        "only `hamel eval` takes a force; here the loads of the description act, with zero inputs",
    ),
    (
        "samples",
        "only `hamel eval` takes several states; expected one",
    ),
];

/// A file that was parsed as JSON.
pub struct File {
    /// Path as given, or `<stdin>`.
    pub path: String,
    /// Contents.
    pub json: Value,
}

impl File {
    /// Reads a file for a description, or standard input if the path is `-`.
    pub fn read(path: &Path, description: &Source) -> Result<Self, Error> {
        let Source { path, text, .. } = description.beside(path, "state")?;
        File::of(path, &text, description)
    }

    /// Parses a text for a description; messages call it `path`.
    pub fn of(path: String, text: &str, description: &Source) -> Result<Self, Error> {
        // Joints of a robot may have any names.
        let json = strict::parse(text).and_then(|json| match description.robot {
            None => plainly(json),
            Some(_) => Ok(json),
        });
        match json {
            Ok(json) => Ok(File { path, json }),
            Err(error) => Err(Error::State {
                path,
                problems: vec![StateProblem::new("", error.to_string())],
            }),
        }
    }

    /// Whether the state is given by joints.
    pub fn is_by_joints(&self) -> bool {
        is_sample(&self.json)
    }

    /// The state, in either form; a force, or a list of states, is refused.
    pub fn state(&self, source: &Source, generated: &Generated) -> Result<State, Error> {
        self.changes(State::start(&generated.active), source, generated)
    }

    /// Another state, changed by the file.
    pub fn changes(
        &self,
        start: State,
        source: &Source,
        generated: &Generated,
    ) -> Result<State, Error> {
        let state = match (self.is_by_joints(), &self.json) {
            (true, _) => self.by_joints(start, source, generated),
            (false, Value::Array(list)) => samples::last(start, list, (generated, &source.text)),
            (false, _) => start.changed((generated, &source.text), source.joints(), &self.json),
        };
        state.map_err(|problems| Error::State {
            path: self.path.clone(),
            problems,
        })
    }

    fn by_joints(
        &self,
        start: State,
        source: &Source,
        generated: &Generated,
    ) -> Result<State, Vec<StateProblem>> {
        let refused = OF_EVAL
            .iter()
            .filter(|(part, _)| self.json.get(part).is_some());
        let refused: Vec<StateProblem> = refused
            .map(|(part, why)| StateProblem::new(*part, *why))
            .collect();
        match refused.is_empty() {
            true => Sample::parse(
                start,
                &self.json,
                None,
                (generated, &source.text),
                source.joints(),
            )
            .map(|read| read.state),
            false => Err(refused),
        }
    }
}
