//! Values for the frames of `--frame`: pose, twist, Jacobian, bias acceleration.

use crate::failure::Failure;
use crate::json::Json;
use crate::mechanism::function;
use crate::state::State;
use hamel_codegen::functions::{FrameFunction, Jacobian};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Shape;

/// A frame: its name as requested, and in the description.
pub type NamedFrame = (String, String);

/// The Jacobians of a frame, in world axes and in the frame's axes.
fn both(frame: &str) -> [Jacobian; 2] {
    [false, true].map(|own| Jacobian {
        frame: frame.into(),
        own,
    })
}

/// The Jacobians of all requested frames.
pub fn requested_jacobians(frames: &[NamedFrame]) -> Vec<Jacobian> {
    frames.iter().flat_map(|(_, frame)| both(frame)).collect()
}

/// An object for every frame, under its requested name, whose members have the names of the functions without the
/// frame's name; `None` if no frame is requested.
pub fn kinematics(
    generated: &Generated,
    state: &State,
    asked: &[NamedFrame],
) -> Result<Option<Json>, Failure> {
    let mut frames: Vec<(&str, Json)> = Vec::new();
    for (written, frame) in asked {
        let mut members = Vec::new();
        for one in both(frame) {
            for &of in FrameFunction::ALL {
                let name = one.name_of(of);
                let short = name[one.frame.len() + 1..].to_string();
                if members
                    .iter()
                    .any(|(known, _): &(String, Json)| *known == short)
                {
                    continue;
                }
                let program = &generated.program;
                let shape = program.function(&name).map(|function| function.shape);
                let values = function(program, &name, &state.params)?
                    .call(&state.x, &state.xi, &state.u, &[])
                    .unwrap_or_default();
                let value = match shape {
                    Some(Shape::Matrix(_, columns)) => {
                        let rows = values.chunks(columns.max(1)).map(<[f64]>::to_vec);
                        Json::matrix(&rows.collect::<Vec<_>>())
                    }
                    _ => Json::vector(&values),
                };
                members.push((short, value));
            }
        }
        frames.push((written, Json::Object(members)));
    }
    Ok((!frames.is_empty()).then(|| Json::object(frames)))
}
