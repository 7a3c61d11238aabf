//! Evaluates frames: pose, twist, Jacobian, bias acceleration.

use super::value::{Value, by_name};
use crate::error::Error;
use crate::mechanism::function;
use crate::state::State;
use hamel_codegen::functions::{FrameFunction, Jacobian};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Shape;
use serde::{Serialize, Serializer};

/// Name of a frame as requested, and in the description.
pub type NamedFrame = (String, String);

/// Values for frames by their requested names, each by the names of the functions without that of the frame.
#[derive(Clone, Debug)]
pub struct Kinematics(pub Vec<(String, Vec<(String, Value)>)>);

impl Kinematics {
    /// Returns whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let mut all = self.0.iter().flat_map(|(_, values)| values);
        all.all(|(_, value)| value.is_finite())
    }
}

impl Serialize for Kinematics {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        /// The numbers of one frame.
        #[derive(Serialize)]
        struct Frame<'a>(#[serde(serialize_with = "by_name")] &'a [(String, Value)]);
        let frames = self.0.iter();
        serializer.collect_map(frames.map(|(name, values)| (name, Frame(values))))
    }
}

/// Returns the Jacobians of a frame, in world axes and in the frame's axes.
fn both(frame: &str) -> [Jacobian; 2] {
    [false, true].map(|own| Jacobian {
        frame: frame.into(),
        own,
    })
}

/// Returns the Jacobians of all requested frames.
pub fn requested_jacobians(frames: &[NamedFrame]) -> Vec<Jacobian> {
    frames.iter().flat_map(|(_, frame)| both(frame)).collect()
}

/// Evaluates frames at a state; `None` without frames.
///
/// # Errors
/// A function of a frame was not derived.
pub fn kinematics(
    generated: &Generated,
    state: &State,
    asked: &[NamedFrame],
) -> Result<Option<Kinematics>, Error> {
    let program = &generated.program;
    let mut frames = Vec::new();
    for (written, frame) in asked {
        let mut values: Vec<(String, Value)> = Vec::new();
        for one in both(frame) {
            for &of in FrameFunction::ALL {
                let name = one.name_of(of);
                let short = name[one.frame.len() + 1..].to_string();
                if values.iter().any(|(known, _)| *known == short) {
                    continue;
                }
                let shape = program.function(&name).map(|function| function.shape);
                let entries = function(program, &name, &state.params)?
                    .call(&state.x, &state.xi, &state.u, &[])
                    .unwrap_or_default();
                let shape = match shape {
                    Some(matrix @ Shape::Matrix(..)) => matrix,
                    _ => Shape::Vector(entries.len()),
                };
                values.push((short, Value::new(shape, &entries)));
            }
        }
        frames.push((written.clone(), values));
    }
    Ok((!frames.is_empty()).then_some(Kinematics(frames)))
}
