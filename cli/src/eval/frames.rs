//! Numbers of frames that `--frame` names: pose, twist, Jacobian, bias acceleration.

use crate::failure::Failure;
use crate::json::Json;
use crate::mechanism::function;
use crate::state::State;
use hamel_codegen::functions::{FrameFunction, Jacobian};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Shape;

/// What is asked for of frames: everything, in axes of the world and in their own.
pub fn asked(names: &[String]) -> Vec<Jacobian> {
    let both = |name: &String| {
        [false, true].map(|own| Jacobian {
            frame: name.clone(),
            own,
        })
    };
    names.iter().flat_map(both).collect()
}

/// An object for every frame, whose members are named as the functions are without the frame's name; nothing where no
/// frame is asked for.
pub fn kinematics(generated: &Generated, state: &State) -> Result<Option<Json>, Failure> {
    let asked = &generated.active.asked.jacobians;
    let mut frames: Vec<(&str, Json)> = Vec::new();
    for jacobian in asked.iter().filter(|jacobian| !jacobian.own) {
        let of_frame = asked.iter().filter(|other| other.frame == jacobian.frame);
        let mut members = Vec::new();
        for one in of_frame {
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
        frames.push((&jacobian.frame, Json::Object(members)));
    }
    Ok((!frames.is_empty()).then(|| Json::object(frames)))
}
