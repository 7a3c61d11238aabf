//! Linearises the motion at a state, and computes eigenvalues.

pub(crate) mod eigenvalues;
pub(crate) mod minimal;

use crate::error::Error;
use crate::mechanism::{Instance, function};
use crate::names;
use crate::state::State;
use eigenvalues::eigenvalues;
use hamel_codegen::functions::SLOPES;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Shape;

/// Linearisation at a state.
#[derive(Clone, Debug)]
pub struct Linearization {
    /// Name of the system.
    pub system: String,
    /// Names of h and δξ.
    pub states: Vec<String>,
    /// Names of u.
    pub inputs: Vec<String>,
    /// A, by rows.
    pub a: Vec<Vec<f64>>,
    /// B, by rows.
    pub b: Vec<Vec<f64>>,
    /// Names of the entries of y.
    pub outputs: Vec<String>,
    /// C, by rows.
    pub c: Vec<Vec<f64>>,
    /// D, by rows.
    pub d: Vec<Vec<f64>>,
    /// Number of displacements and velocities that constraints determine from these; 0 in the full form.
    pub given: usize,
    /// Real and imaginary parts, the fastest growing first; `None` if they were not found.
    pub eigenvalues: Option<Vec<(f64, f64)>>,
    /// Whether there are states of first order.
    pub with_states: bool,
    /// ξ̇ at the state.
    pub xi_dot: Vec<f64>,
}

/// Linearises the motion at a state, in all displacements and velocities if `full`; `shown` is the text whose line
/// numbers messages give.
///
/// # Errors
/// If the motion has no value at the state.
pub fn linearize(
    generated: &Generated,
    state: &State,
    shown: &str,
    full: bool,
) -> Result<Linearization, Error> {
    let program = &generated.program;
    let State { params, x, xi, u } = state;
    let system = Instance::new(generated, state, shown)?;
    let xi_dot = system.motion(x, xi, u).map_err(Error::NoLinearization)?;
    let flat = function(program, "linearize", params)?
        .call(x, xi, u, &[])
        .map_err(|_| Error::NoLinearization(system.state_message(x)))?;
    let inputs: Vec<String> = generated
        .model
        .inputs
        .iter()
        .flat_map(names::group)
        .collect();
    // Displacements along the full frame, and changes of the velocities that constraints leave.
    let mut frame = names::velocities(&generated.model);
    if let Some(clock) = generated.model.clock {
        // The time is not displaced.
        frame.remove(clock.xi);
    }
    let velocities = names::velocities_and_states(&generated.active);
    let displacements = frame.iter().map(|name| format!("h({name})"));
    let changes = velocities.iter().map(|name| format!("d({name})"));
    let states: Vec<String> = displacements.chain(changes).collect();
    if let Some(entry) = flat.iter().position(|value| !value.is_finite()) {
        return Err(Error::LinearizationNotFinite {
            row: entry / (states.len() + inputs.len()).max(1) + 1,
        });
    }
    let split = |flat: &[f64]| -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let rows = flat.chunks((states.len() + inputs.len()).max(1));
        let rows = rows.map(|row| row.split_at(states.len()));
        rows.map(|(left, right)| (left.to_vec(), right.to_vec()))
            .unzip()
    };
    let (a, b) = split(&flat);
    let (mut outputs, mut slopes) = (Vec::new(), Vec::new());
    for (name, _) in &generated.model.outputs {
        let Ok(function) = function(program, &format!("{name}{SLOPES}"), params) else {
            continue;
        };
        slopes.extend(
            function
                .call(x, xi, u, &[])
                .map_err(|_| Error::NoLinearization(system.state_message(x)))?,
        );
        let shape = program.function(name).map_or(Shape::Scalar, |f| f.shape);
        outputs.extend(names::entries(name, shape));
    }
    let (c, d) = split(&slopes);
    let mut linear = Linearization {
        system: generated.model.name.clone(),
        eigenvalues: None,
        with_states: !generated.model.states.is_empty(),
        states,
        inputs,
        a,
        b,
        outputs,
        c,
        d,
        given: 0,
        xi_dot,
    };
    if !full {
        let flat = function(program, "displacement_frame", params)?
            .call(x, &[], &[], &[])
            .map_err(|_| Error::NoLinearization(system.state_message(x)))?;
        let columns = flat.len() / x.len().max(1);
        let rows: Vec<Vec<f64>> = flat.chunks(columns.max(1)).map(<[f64]>::to_vec).collect();
        if let Some(tangent) = minimal::tangent(generated, state, &rows) {
            linear.given = linear.states.len() - tangent.kept.len();
            linear.a = tangent.of_square(&linear.a);
            linear.b = tangent.of_list(&linear.b);
            linear.c = tangent.of_columns(&linear.c);
            linear.states = tangent.of_list(&linear.states);
        }
    }
    linear.eigenvalues = eigenvalues(&linear.a);
    Ok(linear)
}
