//! Reads the file of a state, in either of its forms: by coordinates, or by joints.

use super::State;
use super::joint_state::{JointState, is_by_joints};
use super::json;
use super::last_sample;
use super::plain_names::with_plain_names;
use super::problem::StateProblem;
use crate::error::Error;
use crate::source::Source;
use hamel_codegen::generate::Generated;
use serde_json::Value;
use std::path::Path;

/// Members that only `hamel eval` accepts, with the messages of other commands.
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

/// File of a state, parsed as JSON.
pub struct StateFile {
    /// Path as given, or `<stdin>`.
    pub path: String,
    /// Contents.
    pub json: Value,
}

impl StateFile {
    /// Reads the JSON file of a state of a described system, or standard input if the path is `-`.
    pub fn read(path: &Path, description: &Source) -> Result<Self, Error> {
        let Source { path, text, .. } = description.read_related(path, "state")?;
        StateFile::of(path, &text, description)
    }

    /// Parses a text for a description; messages call it `path`.
    pub fn of(path: String, text: &str, description: &Source) -> Result<Self, Error> {
        // Joints of a robot may have any names.
        let json = json::parse(text).and_then(|json| match description.robot {
            None => with_plain_names(json),
            Some(_) => Ok(json),
        });
        match json {
            Ok(json) => Ok(StateFile { path, json }),
            Err(error) => Err(Error::State {
                path,
                problems: vec![StateProblem::new("", error.to_string())],
            }),
        }
    }

    /// Returns whether the state is given by joints.
    pub fn is_by_joints(&self) -> bool {
        is_by_joints(&self.json)
    }

    /// Reads the state, in either form; a force, or a list of states, is refused.
    pub fn state(&self, source: &Source, generated: &Generated) -> Result<State, Error> {
        self.changes(State::start(&generated.active), source, generated)
    }

    /// Changes another state by the file.
    pub fn changes(
        &self,
        start: State,
        source: &Source,
        generated: &Generated,
    ) -> Result<State, Error> {
        let state = match (self.is_by_joints(), &self.json) {
            (true, _) => self.by_joints(start, source, generated),
            (false, Value::Array(list)) => {
                last_sample::read_last_sample(start, list, (generated, &source.text))
            }
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
            true => JointState::parse(
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
