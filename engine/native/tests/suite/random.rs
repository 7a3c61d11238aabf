//! Compares machine code of random tapes, alone and in two lanes, with interpretation: the same bits, the same pivots.

use crate::size::size;
use hamel_codegen::algebra::graph::Function;
use hamel_codegen::program::Cause;
use hamel_codegen::program::tape::{ARGUMENTS, Operand, Source, Step, Tape, Tapes};
use hamel_native::{Compiled, Constants, Paired, evaluate};

const PARAMETERS: usize = 3;
const LENGTHS: [usize; 5] = [7, 5, 2, 5, 4];

/// The upper bits of the linear congruential generator of Knuth's MMIX.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    fn below(&mut self, most: usize) -> usize {
        (self.next() % most as u64) as usize
    }

    fn number(&mut self) -> f64 {
        let number = self.next() as f64 / f64::from(1u32 << 30) - 1.0;
        match self.below(40) {
            0 => 0.0,
            1 => -0.0,
            2 => 1.0,
            3 => f64::INFINITY,
            4 => f64::NAN,
            5 => 1e7 * number,
            6 => 1e-110 * number,
            _ => number,
        }
    }
}

/// Returns the functions of one argument; sine and cosine have steps of their own.
fn functions() -> Vec<Function> {
    let all = Function::ALL.iter().copied();
    all.filter(|function| function.row().rust.ends_with("()"))
        .collect()
}

fn operand(random: &mut Random, values: usize, kept: usize) -> Operand {
    let source = match random.below(12) {
        0 => Source::Number(random.number()),
        1 => Source::Constant(random.below(PARAMETERS + kept)),
        2 | 3 => {
            let place = random.below(5);
            Source::Argument(ARGUMENTS[place], random.below(LENGTHS[place]))
        }
        // A recent value, or any one.
        4..8 if values > 0 => Source::Value(values - 1 - random.below(values.min(6))),
        _ if values > 0 => Source::Value(random.below(values)),
        _ => Source::Number(random.number()),
    };
    Operand {
        source,
        negative: random.below(3) == 0,
    }
}

fn tape(random: &mut Random, name: &str, kept: usize, outputs: usize, checked: bool) -> Tape {
    let mut steps = Vec::new();
    let mut values = 0;
    let length = match random.below(20) {
        0 => 300,
        1 => 0,
        _ => 5 + random.below(60),
    };
    for _ in 0..length {
        let mut of = || operand(random, values, kept);
        let (a, b, c) = (of(), of(), of());
        let step = match random.below(60) {
            0..12 => Step::Add(a, b),
            12..24 => Step::Multiply(a, b),
            24..48 => Step::Fused(a, b, c),
            48 | 49 => Step::Divide(a, b),
            50..53 => Step::SinCos(a),
            53..56 => Step::Apply(functions()[random.below(functions().len())], a),
            56 => Step::Atan2(a, b),
            57 => Step::Select(a, b, c),
            58 if checked => Step::Check(Cause::Velocity(random.below(3)), a),
            _ => Step::Fused(a, a, a),
        };
        values += step.results();
        steps.push(step);
    }
    Tape {
        name: name.into(),
        steps,
        outputs: (0..outputs)
            .map(|_| operand(random, values, kept))
            .collect(),
    }
}

/// Returns bits, with a canonical NaN: its sign and payload are unspecified.
fn bits(numbers: &[f64]) -> Vec<u64> {
    let bits = |number: &f64| match number.is_nan() {
        true => f64::NAN.to_bits(),
        false => number.to_bits(),
    };
    numbers.iter().map(bits).collect()
}

/// Whether to test everything: code for sines and cosines takes the longest to compile.
fn everything() -> bool {
    std::env::var_os("HAMEL_ATTACK").is_some()
}

#[test]
fn code_gives_the_bits_of_tapes() {
    let tapes = size(if everything() { 2_500 } else { 250 }, 100_000) as usize;
    let halves = std::thread::scope(|scope| {
        let halves = [42, 43].map(|seed| scope.spawn(move || Met::by(seed, tapes as u64 / 2)));
        halves.map(|half| half.join().expect("every tape gives its bits"))
    });
    // Each case occurred often enough to be meaningful.
    for Met {
        well,
        ended,
        far,
        pairs,
    } in halves
    {
        assert!(
            well > tapes && ended > tapes / 40 && far < well / 2 && pairs > tapes / 2,
            "{well} {ended} {far} {pairs}"
        );
    }
}

/// Counts of the cases that random tapes covered.
struct Met {
    /// Calls with results, and how many of them contain NaN.
    well: usize,
    far: usize,
    /// Calls that ended in an error.
    ended: usize,
    /// Calls of two lanes with results.
    pairs: usize,
}

impl Met {
    /// Compares the code of random tapes with interpretation.
    fn by(seed: u64, count: u64) -> Self {
        let mut random = Random(seed);
        let (mut well, mut ended, mut far, mut pairs) = (0, 0, 0, 0);
        let mut made = 0;
        while made < count {
            let kept = random.below(4);
            let constants = tape(&mut random, "constants", 0, kept, false);
            let count = 1 + random.below(3);
            let functions: Vec<Tape> = (0..count)
                .map(|_| {
                    let outputs = random.below(9);
                    tape(&mut random, "f", kept, outputs, true)
                })
                .collect();
            made += count as u64;
            let tapes = Tapes {
                parameters: PARAMETERS,
                lengths: LENGTHS,
                constants,
                pivots: Vec::new(),
                functions,
            };
            let code = match everything() || made % 5 == 0 {
                true => Compiled::verified(tapes.clone()),
                false => Compiled::of(tapes.clone()),
            };
            assert!(code.interpreted_because().is_none());
            let steps = Compiled::interpreted(tapes.clone());
            let paired = Paired::new(&code).expect("code for two lanes");
            let mut before: Option<Lane> = None;
            for _ in 0..4 {
                let parameters: Vec<f64> = (0..PARAMETERS).map(|_| random.number()).collect();
                let arguments = LENGTHS
                    .map(|length| -> Vec<f64> { (0..length).map(|_| random.number()).collect() });
                let lists = arguments.clone();
                let arguments = [0, 1, 2, 3, 4].map(|i| arguments[i].as_slice());
                let (own, others) = (code.constants(&parameters), steps.constants(&parameters));
                assert_eq!(bits(own.known()), bits(others.known()));
                let mut results = Vec::new();
                for (place, tape) in tapes.functions.iter().enumerate() {
                    let mut out = vec![1.0; tape.outputs.len()];
                    let mut expected = out.clone();
                    let result = code.call(place, &own, arguments, &mut out);
                    assert_eq!(
                        result,
                        steps.call(place, &others, arguments, &mut expected),
                        "{tape:?}"
                    );
                    match result {
                        Ok(()) => {
                            assert_eq!(bits(&out), bits(&expected), "{tape:#?}");
                            well += 1;
                            far += usize::from(expected.iter().any(|value| value.is_nan()));
                        }
                        Err(_) => ended += 1,
                    }
                    results.push(result.ok().map(|()| out));
                }
                let lane = (own, lists, results);
                if let Some(before) = before.replace(lane.clone()) {
                    pairs += together(&paired, &before, &lane);
                }
            }
        }
        Self {
            well,
            far,
            ended,
            pairs,
        }
    }
}

/// Constants, arguments, and the results of all functions that succeed.
type Lane = (Constants, [Vec<f64>; 5], Vec<Option<Vec<f64>>>);

/// Calls functions for two lanes, and compares each result with that of its lane alone; returns the number of results.
fn together(paired: &Paired, first: &Lane, second: &Lane) -> usize {
    let pairs = |first: &[f64], second: &[f64]| -> Vec<f64> {
        let both = first.iter().zip(second);
        both.flat_map(|(&a, &b)| [a, b]).collect()
    };
    let constants = paired.constants([&first.0, &second.0]);
    let arguments = [0, 1, 2, 3, 4].map(|i| pairs(&first.1[i], &second.1[i]));
    let arguments = [0, 1, 2, 3, 4].map(|i| arguments[i].as_slice());
    let mut well = 0;
    for (place, alone) in first.2.iter().zip(&second.2).enumerate() {
        let (Some(a), Some(b)) = alone else {
            let length = [alone.0, alone.1].into_iter().flatten().map(Vec::len).max();
            let mut out = vec![0.0; 2 * length.unwrap_or(9)];
            assert!(!paired.call(place, &constants, arguments, &mut out));
            continue;
        };
        let mut out = vec![1.0; 2 * a.len()];
        // If an angle is too large for the code, both lanes are evaluated step by step.
        if paired.call(place, &constants, arguments, &mut out) {
            assert_eq!(bits(&out), bits(&pairs(a, b)));
            well += 1;
        }
    }
    well
}

/// The reference is the runtime's number type, which is independent of tapes.
#[test]
fn sine_and_cosine_are_those_of_the_runtime() {
    let tape = Tape {
        name: "turned".into(),
        steps: vec![Step::SinCos(Operand {
            source: Source::Argument(ARGUMENTS[0], 0),
            negative: false,
        })],
        outputs: [0, 1]
            .map(|value| Operand {
                source: Source::Value(value),
                negative: false,
            })
            .into(),
    };
    let mut random = Random(7);
    for size in [1e-300, 1e-9, 0.5, 1.0, 3.0, 50.0, 1e4, 9.9e5, 1e7, 1e300] {
        for _ in 0..2_000 {
            let angle = size * random.number();
            let (sine, cosine) = hamel::Scalar::sin_cos(angle);
            let of = |fused| {
                let mut out = [0.0; 2];
                let arguments: [&[f64]; 5] = [&[angle], &[], &[], &[], &[]];
                evaluate(&tape, fused, &[], arguments, &mut out).map(|()| out)
            };
            assert_eq!(
                of(cfg!(target_feature = "fma")).map(|out| bits(&out)),
                Ok(bits(&[sine, cosine])),
                "{angle}"
            );
            for (out, exact) in of(true).into_iter().flatten().zip([sine, cosine]) {
                // Near its zeros, a value is as accurate as the angle.
                let close = (out - exact).abs() <= 2.3e-16 * exact.abs() + 1e-26;
                assert!(
                    close || out.is_nan() && exact.is_nan(),
                    "{angle}: {out} {exact}"
                );
            }
        }
    }
}

/// A tape that is too long for one function; its numbers stay near 1. It succeeds if the first input is positive.
fn long_tape(random: &mut Random, steps: usize) -> Tape {
    let positive = |source| Operand {
        source,
        negative: false,
    };
    let mut tape = Tape {
        name: "long".into(),
        steps: Vec::with_capacity(steps + 4),
        outputs: Vec::new(),
    };
    let mut values = 0;
    let mut known: Vec<Source> = vec![Source::Number(0.75), Source::Constant(0)];
    for (&argument, length) in ARGUMENTS.iter().zip(LENGTHS) {
        known.extend((0..length).map(|place| Source::Argument(argument, place)));
    }
    while tape.steps.len() < steps {
        // A value of the last part, or of any part before it.
        let mut of = || Operand {
            source: match random.below(3) {
                0 => known[known.len() - 1 - random.below(20)],
                _ => known[random.below(known.len())],
            },
            negative: random.below(3) == 0,
        };
        let (a, b, c) = (of(), of(), of());
        tape.steps.push(match random.below(4) {
            0 => Step::Add(a, b),
            1 => Step::Multiply(a, b),
            _ => Step::Fused(a, b, c),
        });
        let size = positive(Source::Value(values));
        values += 1;
        tape.steps.push(match random.below(9) {
            0 => Step::Apply(Function::Tanh, size),
            1 => Step::Check(Cause::Velocity(1), positive(Source::Number(0.5))),
            2 => Step::SinCos(size),
            _ if everything() => Step::SinCos(size),
            _ => Step::Apply(Function::Tanh, size),
        });
        let results = tape.steps.last().map_or(0, Step::results);
        known.extend((values..values + results).map(Source::Value));
        values += results;
    }
    let last = positive(Source::Argument(ARGUMENTS[2], 0));
    tape.steps.push(Step::Check(Cause::Velocity(2), last));
    tape.outputs = (0..500)
        .map(|_| Operand {
            source: known[random.below(known.len())],
            negative: random.below(2) == 0,
        })
        .collect();
    tape
}

#[test]
fn long_tapes_are_several_functions_with_the_same_bits() {
    let mut random = Random(5);
    // Two parts, or three with `HAMEL_ATTACK`.
    let steps = if everything() { 20_001 } else { 11_000 };
    let tapes = Tapes {
        parameters: PARAMETERS,
        lengths: LENGTHS,
        constants: tape(&mut random, "constants", 0, 0, false),
        pivots: Vec::new(),
        functions: vec![long_tape(&mut random, steps)],
    };
    let code = Compiled::verified(tapes.clone());
    assert!(code.interpreted_because().is_none());
    let steps = Compiled::interpreted(tapes);
    let paired = Paired::new(&code).expect("code for two lanes");
    let lanes = [0, 1].map(|_| -> Lane {
        let parameters = [0.0; PARAMETERS].map(|_| random.next() as f64 / 1e10);
        let lists =
            LENGTHS.map(|length| (0..length).map(|_| random.next() as f64 / 1e10).collect());
        let arguments: [&[f64]; 5] = std::array::from_fn(|i| Vec::as_slice(&lists[i]));
        let (own, others) = (code.constants(&parameters), steps.constants(&parameters));
        let (mut out, mut expected) = (vec![1.0; 500], vec![1.0; 500]);
        assert_eq!(code.call(0, &own, arguments, &mut out), Ok(()));
        assert_eq!(steps.call(0, &others, arguments, &mut expected), Ok(()));
        assert!(expected.iter().all(|value| value.abs() < 10.0));
        assert_eq!(bits(&out), bits(&expected));
        // The failure is in the last part.
        let failing = [
            arguments[0],
            arguments[1],
            &[-1.0, 0.0],
            arguments[3],
            arguments[4],
        ];
        let failed = code.call(0, &own, failing, &mut vec![1.0; 500]);
        assert_eq!(failed, steps.call(0, &others, failing, &mut expected));
        assert!(failed.is_err());
        (own, lists, vec![Some(out)])
    });
    assert_eq!(together(&paired, &lanes[0], &lanes[1]), 1);
}
