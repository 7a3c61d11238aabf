//! Compares all functions of the test models: machine code with interpreted tapes bit by bit, and with the graph up to
//! 10⁻¹³ of the scale and the rounding of arguments and statements.

use crate::thinning::thin_out;
use hamel_codegen::algebra::rounding::evaluate_rounded;
use hamel_codegen::generate::{Generated, from_file};
use hamel_codegen::model::states::states;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::tape::Tapes;
use hamel_codegen::program::{Cause, Function, Program};
use hamel_codegen::render::render;
use hamel_native::Compiled;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Largest accepted error, relative to the largest entry of a result.
const CLOSE: f64 = 1e-13;
/// A change of the arguments, and the ratio of their rounding to it.
const CHANGE: f64 = 1e-8;
const ROUNDED: f64 = 1e-7;
/// Accepted error in multiples of the interpreter's error, which is measured in doubled precision: products are added
/// in another order.
const ERRORS: f64 = 8.0;

/// π, the parameters and a state as symbols of the graph, and the arguments x, ξ with z, u, ξ̇ and p.
struct State {
    symbols: Vec<f64>,
    arguments: [Vec<f64>; 5],
}

impl State {
    fn new(program: &Program, numbers: &[f64]) -> Self {
        let [first, x, xi, u, z, xi_dot, p, end] = program.symbols();
        let mut symbols = vec![std::f64::consts::PI];
        symbols.extend_from_slice(&program.defaults);
        assert_eq!(symbols.len(), first + program.defaults.len());
        symbols.extend_from_slice(&numbers[x..end]);
        let part = |range: std::ops::Range<usize>| numbers[range].to_vec();
        let xi = [part(xi..u), part(z..xi_dot)].concat();
        let (u, p) = (part(u..z), part(p..end));
        let more = vec![0.0; program.n_z];
        let xi_dot = [part(xi_dot..program.symbols()[6]), more].concat();
        State {
            arguments: [part(x..program.symbols()[2]), xi, u, xi_dot, p],
            symbols,
        }
    }
}

/// States on X, and the start, in which everything without an initial value is 0.
fn known(of: &Generated) -> Vec<State> {
    let program = &of.program;
    let [_, x, xi, u, z, _, _, end] = program.symbols();
    let mut all: Vec<State> = states(&of.active)
        .iter()
        .filter(|numbers| numbers.len() == end)
        .map(|numbers| State::new(program, numbers))
        .collect();
    let mut start = vec![0.0; end];
    start[x..xi].copy_from_slice(&program.start_x);
    start[xi..u].copy_from_slice(&program.start_xi[..program.n]);
    start[z..z + program.n_z].copy_from_slice(&program.start_xi[program.n..]);
    all.push(State::new(program, &start));
    all
}

/// Evaluates a function step by step in the graph.
fn interpreted(program: &Program, function: &Function, state: &State) -> Result<Vec<f64>, Cause> {
    let interpreter = Interpreter::new(program, function, &program.defaults);
    let value = interpreter.call_with(state.arguments.each_ref().map(Vec::as_slice));
    value.map_err(|guard| program.cause(function.guards[guard]))
}

/// The largest change of the result under a change of the arguments.
fn doubt(program: &Program, function: &Function, state: &State, value: &[f64]) -> f64 {
    let mut most = 0.0_f64;
    for turn in 0..3 {
        let arguments = state.arguments.each_ref().map(|list| -> Vec<f64> {
            let entries = list.iter().enumerate();
            let sign = |i: usize| {
                if (i + turn).is_multiple_of(3) {
                    -1.0
                } else {
                    1.0
                }
            };
            entries.map(|(i, entry)| entry + CHANGE * sign(i)).collect()
        });
        let changed = State {
            symbols: Vec::new(),
            arguments,
        };
        let near = interpreted(program, function, &changed).unwrap_or_default();
        let apart = value.iter().zip(&near).map(|(a, b)| (a - b).abs());
        most = apart.filter(|apart| apart.is_finite()).fold(most, f64::max);
    }
    most
}

/// The largest error of the graph's results, and whether a pivot is lost in rounding.
fn rounding(program: &Program, function: &Function, state: &State) -> (f64, bool) {
    let roots = [function.outputs.as_slice(), &function.guards].concat();
    let values = evaluate_rounded(&program.graph, &roots, &state.symbols);
    let (outputs, guards) = values.split_at(function.outputs.len());
    let error = outputs
        .iter()
        .map(|value| value.rounding_error())
        .fold(0.0, f64::max);
    let lost = |pivot: &hamel_codegen::algebra::rounding::RoundedValue| {
        pivot.exact.to_f64().abs() <= 16.0 * pivot.rounding_error()
    };
    (error, guards.iter().any(lost))
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

fn models() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/models");
    let mut all = Vec::new();
    for folder in [folder.join("multibody"), folder.join("reuse"), folder] {
        for entry in std::fs::read_dir(folder).expect("models are in the repository") {
            let path = entry.expect("a file").path();
            if path.extension().is_some_and(|extension| extension == "eom") {
                all.push(path);
            }
        }
    }
    all.sort();
    assert!(all.len() >= 70, "the models have gone");
    all
}

fn generated(path: &Path) -> Generated {
    let text = std::fs::read_to_string(path).expect("a text");
    let folder = path.parent().expect("a folder");
    let open = &mut |name: &str| std::fs::read_to_string(folder.join(name));
    from_file(&text, open)
        .unwrap_or_else(|errors| panic!("{}", render(&errors, "a model", &text, false)))
}

#[test]
fn code_of_models_gives_what_their_graphs_give() {
    let some = thin_out(models());
    let least = 200 * some.len();
    let counts = some.into_par_iter().map(|path| {
        let (mut compared, mut ended) = (0, 0);
        let of = generated(&path);
        let program = &of.program;
        let functions: Vec<&Function> = program.functions.iter().collect();
        let code = match Tapes::new(program, &functions) {
            Ok(tapes) => Compiled::verified(tapes),
            // The model has a function in Rust.
            Err(foreign) => {
                assert!(!foreign.name.is_empty(), "{path:?}");
                return (0, 0);
            }
        };
        assert!(code.interpreted_because().is_none());
        let steps = Compiled::interpreted(code.tapes().clone());
        let constants = code.constants(&program.defaults);
        let others = steps.constants(&program.defaults);
        for state in known(&of) {
            let arguments = state.arguments.each_ref().map(Vec::as_slice);
            for (place, function) in functions.iter().enumerate() {
                let what = format!("{} of {path:?}", function.name);
                let mut out = vec![0.0; function.outputs.len()];
                let mut slow = out.clone();
                let result = code.call(place, &constants, arguments, &mut out);
                let slowly = steps.call(place, &others, arguments, &mut slow);
                assert_eq!(result, slowly, "{what}");
                let (error, lost) = rounding(program, function, &state);
                let expected = match interpreted(program, function, &state) {
                    Ok(expected) if result.is_ok() => expected,
                    Ok(_) => {
                        assert!(lost, "{what}: {result:?}");
                        continue;
                    }
                    Err(cause) => {
                        assert!(
                            lost || result == Err(cause),
                            "{what}: {result:?}, {cause:?}"
                        );
                        ended += 1;
                        continue;
                    }
                };
                assert!(out.iter().zip(&slow).all(|(a, b)| same(*a, *b)), "{what}");
                let finite = expected.iter().filter(|entry| entry.is_finite());
                let scale = finite.fold(0.0, |most: f64, entry| most.max(entry.abs()));
                let doubt = doubt(program, function, &state, &expected);
                let bound = CLOSE * scale + ERRORS * error + ROUNDED * doubt;
                for (a, b) in out.iter().zip(&expected) {
                    let near = same(*a, *b) || a == b || (a - b).abs() <= bound;
                    assert!(
                        near,
                        "{what}: {a} by code, {b} by the graph, {bound} apart at most"
                    );
                    compared += 1;
                }
            }
        }
        (compared, ended)
    });
    let (compared, ended) = counts.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    assert!(compared > least, "{compared} numbers, {ended} ends");
}
