//! Compares compiled functions of random descriptions with the interpreter, in f64, f32 and SIMD lanes of both, and
//! parses the code of more descriptions. `HAMEL_ATTACK=more` compiles and parses four times as many;
//! `HAMEL_ATTACK=full` compiles 500, or a fifth of them with `HAMEL_PART`, and parses 2,000.

use common::{Random, size};
use hamel::Lanes;
use hamel_codegen::builder::source;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::Function;
use hamel_codegen::program::interpret::Interpreter;
use hamel_tests_emitted::{At, CASES, Case, TRIED, Values};
use rayon::prelude::*;

#[path = "../../../codegen/tests/suite/common/mod.rs"]
mod common;
#[path = "../src/describe.rs"]
mod describe;

/// As many states as the widest lanes.
const STATE_COUNT: usize = 8;
/// Number of descriptions in the default run that are only parsed.
const PARSED_DESCRIPTIONS: u64 = 40;

/// The arguments x, ξ, ξ̇, p, u.
type State = [Vec<f64>; 5];

/// The value of a function, and its change due to rounding the arguments to f32.
struct Expected {
    value: Option<Vec<f64>>,
    doubt: f64,
}

fn states(generated: &Generated, random: &mut Random) -> Vec<State> {
    let program = &generated.program;
    let mut state = || {
        let x = random.configuration(&program.blocks);
        let [xi, xi_dot] = [(); 2].map(|()| random.numbers(program.n + program.n_z));
        let momentum = random.numbers(program.n);
        [x, xi, xi_dot, momentum, random.numbers(program.m)]
    };
    (0..STATE_COUNT).map(|_| state()).collect()
}

fn interpreted(generated: &Generated, function: &Function, state: &State) -> Expected {
    let program = &generated.program;
    let params: Vec<f64> = program.defaults.iter().map(|value| 1.5 * value).collect();
    let interpreter = Interpreter::new(program, function, &params);
    let call = |[x, xi, xi_dot, momentum, u]: [&[f64]; 5]| {
        interpreter.call_with([x, xi, u, xi_dot, momentum]).ok()
    };
    let value = call(state.each_ref().map(Vec::as_slice));
    let mut doubt = 0.0_f64;
    // Several directions, since one may have no effect.
    for turn in 0..3 {
        let near = state.each_ref().map(|list| -> Vec<f64> {
            let nudge = |i: usize| {
                f64::from(f32::EPSILON)
                    * if (i + turn).is_multiple_of(3) {
                        -1.0
                    } else {
                        1.0
                    }
            };
            let entries = list.iter().enumerate();
            entries.map(|(i, entry)| entry + nudge(i)).collect()
        });
        let near = call(near.each_ref().map(Vec::as_slice));
        doubt = match (&value, near) {
            (Some(value), Some(near)) => doubt.max(distance(value, &near)),
            _ => f64::INFINITY,
        };
    }
    Expected { value, doubt }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |most: f64, (a, b)| {
        let apart = (a - b).abs();
        // NaN differs infinitely from all other numbers.
        match apart.is_nan() {
            true if a.is_nan() && b.is_nan() => most,
            true => f64::INFINITY,
            false => most.max(apart),
        }
    })
}

/// Compares the results of lanes; panics if an error exceeds its bound.
fn compare<L: Lanes<Element: Into<f64>>>(
    what: &str,
    values: Values<L>,
    first: usize,
    expected: &[(&str, Vec<Expected>)],
    [rounding, slope]: [f64; 2],
    case: &Case,
) {
    let values = values.unwrap_or_else(|error| panic!("{what}: {error}\n{}", case.text));
    assert_eq!(values.len(), expected.len());
    for ((name, value), (wanted, expected)) in values.iter().zip(expected) {
        assert_eq!(name, wanted);
        let expected = &expected[first..first + L::COUNT];
        let Some(value) = value else {
            // A pivot that is not positive in one lane fails the call for all.
            let some = expected
                .iter()
                .any(|expected| expected.value.is_none() || expected.doubt > 1.0);
            assert!(some, "{what}: {name} has no value\n{}", case.text);
            continue;
        };
        for (lane, expected) in expected.iter().enumerate() {
            let Some(wanted) = &expected.value else {
                let near = expected.doubt.is_infinite() && slope > 0.0;
                assert!(near, "{what}: {name} has a value\n{}", case.text);
                continue;
            };
            let found: Vec<f64> = value
                .iter()
                .map(|entry| entry.lanes().as_ref()[lane].into())
                .collect();
            assert_eq!(found.len(), wanted.len(), "{what}: {name}\n{}", case.text);
            let scale = wanted
                .iter()
                .fold(1.0, |most: f64, entry| most.max(entry.abs()));
            let allowed = rounding * scale + slope * expected.doubt;
            let error = distance(wanted, &found);
            assert!(
                error <= allowed,
                "{what}: {name} is off by {error:e} of {scale:e}, {allowed:e} allowed\n{wanted:?}\n{found:?}\n{}",
                case.text
            );
        }
    }
}

#[test]
fn compiled_code_gives_what_the_interpreter_gives() {
    assert!(
        CASES.len() * 10 > TRIED * 7,
        "{} of {TRIED} were refused",
        TRIED - CASES.len()
    );
    let functions = CASES.par_iter().enumerate().map(|(number, case)| {
        let generated = from_text(case.text).expect("it was generated");
        let states = states(&generated, &mut Random::new(number as u64));
        let of = &generated.program.functions;
        let expected: Vec<(&str, Vec<Expected>)> = of
            .iter()
            .map(|function| {
                let values = states
                    .iter()
                    .map(|state| interpreted(&generated, function, state));
                (function.name.as_str(), values.collect())
            })
            .collect();
        let double = [1e-11, 1e-3];
        let single = [1e-4, 100.0];
        for first in 0..STATE_COUNT {
            let at: &At = &|lane, argument, entry| states[first + lane][argument][entry];
            compare("f64", (case.double)(at), first, &expected, double, case);
            compare("f32", (case.single)(at), first, &expected, single, case);
        }
        for first in [0, 4] {
            let at: &At = &|lane, argument, entry| states[first + lane][argument][entry];
            compare("f64x4", (case.doubles)(at), first, &expected, double, case);
        }
        let at: &At = &|lane, argument, entry| states[lane][argument][entry];
        compare("f32x8", (case.singles)(at), 0, &expected, single, case);
        expected.len()
    });
    let functions: usize = functions.sum();
    assert!(functions > 3 * CASES.len(), "{functions} functions");
}

#[test]
fn every_text_is_rust() {
    let count = size(PARSED_DESCRIPTIONS, 2_000);
    let written = (10_000..10_000 + count).into_par_iter().filter(|&seed| {
        let text = describe::description(&mut Random::new(seed), None);
        match source(&text, "random.eom") {
            Ok(code) => {
                let file = syn::parse_file(&code)
                    .unwrap_or_else(|error| panic!("{error}\n{text}\n{code}"));
                // Apart from comments, the layout is that of the pretty printer.
                let is_comment = |line: &&str| line.trim_start().split(' ').next() == Some("//");
                let items = code.lines().filter(|line| !is_comment(line));
                let items: Vec<&str> = items.collect();
                let laid_out = prettyplease::unparse(&file);
                assert!(items.join("\n").trim() == laid_out.trim(), "{text}\n{code}");
                true
            }
            Err(errors) => {
                for error in errors {
                    assert!(
                        !error.message.contains("no Rust"),
                        "{}\n{text}",
                        error.message
                    );
                }
                false
            }
        }
    });
    let written = written.count() as u64;
    assert!(written * 10 > count * 7, "{written} of {count}");
}
