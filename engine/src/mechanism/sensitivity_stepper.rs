//! Steps with their derivatives: tapes evaluated in dual numbers, with as many directions at a time as such a number
//! has.

use super::tape_system::{TapeEvaluator, TapeIndices, TapeSystem};
use super::{block, missing};
use crate::error::Error;
use hamel::methods::General;
use hamel::{Dual, State, StepError, step};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::{Cause, Function};
use hamel_native::{Compiled, Constants, evaluate, evaluate_in};

/// Number of directions of a dual number.
const WIDTH: usize = 8;

/// The functions that a step needs.
const NEEDED: &[&str] = &[
    "rate",
    "chart_rate",
    "accel",
    "correction",
    "constraint",
    "kinetic_energy",
    "potential_energy",
    "displacement_frame",
    "displacement_coframe",
    "project_position",
    "project_velocity",
];

/// Number with its derivatives.
type Number = Dual<f64, WIDTH>;

/// Stepper that also computes the derivatives of a step by state and inputs.
pub struct SensitivityStepper {
    compiled: Compiled,
    params: Vec<f64>,
    constants: Constants,
    indices: TapeIndices,
    frame: usize,
    coframe: usize,
}

/// x and ξ at the end of a step, and the derivatives of the step, by rows of (η, ξ, z) and columns of (η, ξ, z, u).
pub type StepWithSensitivities = (Vec<f64>, Vec<f64>, Vec<Vec<f64>>);

impl SensitivityStepper {
    /// Prepares a system that was derived with its linearisation, for these parameters.
    pub fn new(generated: &Generated, params: &[f64]) -> Result<Self, Error> {
        let program = &generated.program;
        let all = NEEDED.iter().filter_map(|name| program.function(name));
        let all: Vec<&Function> = all.collect();
        let known = all.iter().map(|function| function.name.clone());
        let known: Vec<String> = known.collect();
        let tapes =
            hamel_native::Tapes::new(program, &all).map_err(|foreign| Error::ForeignFunction {
                name: foreign.name,
                missing: "slopes",
            })?;
        let compiled = Compiled::interpreted(tapes);
        let find = |name: &str| known.iter().position(|known| known == name);
        let place = |name: &str| find(name).ok_or_else(|| missing(program, name));
        let [x, xi, u, ..] = compiled.tapes().lengths;
        Ok(SensitivityStepper {
            params: params.to_vec(),
            constants: compiled.constants(params),
            indices: TapeIndices {
                blocks: program.blocks.iter().copied().map(block).collect(),
                chart: program.blocks.iter().map(|block| block.dimension()).sum(),
                lengths: [x, xi, u],
                rate: place("rate")?,
                chart_rate: place("chart_rate")?,
                accel: place("accel")?,
                correction: place("correction")?,
                constraint: place("constraint")?,
                kinetic: place("kinetic_energy")?,
                potential: place("potential_energy")?,
                embedded: program.embedded,
                project_position: find("project_position"),
                project_velocity: find("project_velocity"),
            },
            frame: place("displacement_frame")?,
            coframe: place("displacement_coframe")?,
            compiled,
        })
    }

    /// Returns the parameters.
    pub fn params(&self) -> &[f64] {
        &self.params
    }

    /// Takes a step of length h from a state with inputs held constant; returns its end and its derivatives.
    ///
    /// # Errors
    /// The step fails.
    pub fn step(
        &self,
        method: &General,
        [x, xi, u]: [&[f64]; 3],
        h: f64,
    ) -> Result<StepWithSensitivities, StepError> {
        let [nu, moving, inputs] = self.indices.lengths;
        let frame = self.matrix(self.frame, x, nu);
        let displacements = frame.first().map_or(0, Vec::len);
        let rows = displacements + moving;
        let columns = rows + inputs;
        let mut slopes = vec![vec![0.0; columns]; rows];
        let (mut end_x, mut end_xi) = (x.to_vec(), xi.to_vec());
        // At least one pass, even without directions.
        for first in (0..columns.max(1)).step_by(WIDTH) {
            let along = |value: f64, column: usize| Number {
                value,
                slopes: std::array::from_fn(|d| f64::from(u8::from(first + d == column))),
            };
            let varied = x.iter().zip(&frame).map(|(&value, row)| Number {
                value,
                slopes: std::array::from_fn(|d| row.get(first + d).copied().unwrap_or(0.0)),
            });
            let mut state = State::<TapeSystem<&SensitivityStepper>> {
                t: 0.0,
                x: varied.collect(),
                xi: list(xi, |i, value| along(value, displacements + i)),
            };
            let held = list(u, |i, value| along(value, rows + i));
            let given = |_, _: &_, _: &_| held.clone();
            step(&TapeSystem(self), method, &mut state, h, &given)?;
            end_x = state.x.iter().map(|number| number.value).collect();
            end_xi = state.xi.iter().map(|number| number.value).collect();
            let coframe = self.matrix(self.coframe, &end_x, displacements);
            for d in 0..WIDTH.min(columns - first.min(columns)) {
                for (row, factors) in slopes.iter_mut().zip(&coframe) {
                    let moved = factors.iter().zip(&state.x);
                    row[first + d] = moved.map(|(y, number)| y * number.slopes[d]).sum();
                }
                let of_xi = slopes.iter_mut().skip(displacements);
                for (row, number) in of_xi.zip(&state.xi) {
                    row[first + d] = number.slopes[d];
                }
            }
        }
        Ok((end_x, end_xi, slopes))
    }

    /// Evaluates a matrix with `rows` rows that depends on x.
    fn matrix(&self, function: usize, x: &[f64], rows: usize) -> Vec<Vec<f64>> {
        let tapes = self.compiled.tapes();
        let mut flat = vec![f64::NAN; tapes.functions[function].outputs.len()];
        let arguments = [x, &[], &[], &[], &[]];
        let constants = self.constants.known();
        // Its only pivots are those of A.
        let tape = &tapes.functions[function];
        if evaluate(tape, false, constants, arguments, &mut flat).is_err() {
            flat.fill(f64::NAN);
        }
        let columns = flat.len() / rows.max(1);
        flat.chunks(columns.max(1)).map(<[f64]>::to_vec).collect()
    }
}

fn list(values: &[f64], number: impl Fn(usize, f64) -> Number) -> Vec<Number> {
    let values = values.iter().enumerate();
    values.map(|(i, &value)| number(i, value)).collect()
}

impl TapeEvaluator for &SensitivityStepper {
    type Number = Number;

    fn indices(&self) -> &TapeIndices {
        &self.indices
    }

    fn call(&self, function: usize, [x, xi, u]: [&[Number]; 3]) -> Result<Vec<Number>, Cause> {
        let tape = &self.compiled.tapes().functions[function];
        let mut out = vec![Number::constant(f64::NAN); tape.outputs.len()];
        let constants = self.constants.known();
        evaluate_in(tape, constants, [x, xi, u, &[], &[]], &mut out)?;
        Ok(out)
    }
}
