//! Repeated calls of functions whose result is the next (x, ξ), such as a step of a method: for one state, or for two
//! in the lanes of one code.

use crate::{CallOutcome, Code, Compiled, Constants, Target};

impl Compiled {
    /// Calls a function `times` times, or until it fails or its result is not finite. `state` holds x followed by ξ; u
    /// is constant, and in place of the accelerations call number k, counted from 1, takes `given(k)`. Returns the
    /// number of results, the last of which is then in `state`.
    pub fn repeat(
        &self,
        function: usize,
        constants: &Constants,
        state: &mut [f64],
        u: &[f64],
        given: impl FnMut(u64) -> f64,
        times: u64,
    ) -> u64 {
        self.repeat_watched(function, constants, (state, u), given, times, |_| ())
    }

    /// Like [`Self::repeat`], for a function with further results: `see` gets the numbers that follow each of these
    /// states.
    pub fn repeat_watched(
        &self,
        function: usize,
        constants: &Constants,
        (state, u): (&mut [f64], &[f64]),
        mut given: impl FnMut(u64) -> f64,
        times: u64,
        see: impl FnMut(&[f64]),
    ) -> u64 {
        let [length, ..] = self.tapes().lengths;
        let tape = self.tapes().functions.get(function);
        let results = tape.map_or(0, |tape| tape.outputs.len());
        let mut number = 0;
        let call = |state: &[f64], next: &mut [f64]| {
            let (x, xi) = state.split_at_checked(length).unwrap_or((state, &[]));
            number += 1;
            let given = [given(number)];
            let arguments = [x, xi, u, &given, &[]];
            self.call(function, constants, arguments, next).is_ok()
        };
        repeated(state, results, times, call, see)
    }
}

/// The same functions for two sets of arguments at once: every number of a lane is that of [`Compiled`], bit by bit.
#[derive(Debug)]
pub struct Paired {
    code: Code,
    numbers: Vec<f64>,
    length: usize,
}

impl Paired {
    /// Compiles for two lanes; `None` if this machine has no such code.
    pub fn new(compiled: &Compiled) -> Option<Self> {
        let tapes = compiled.tapes();
        let target = Target {
            fused: compiled.is_fused(),
            paired: true,
            verified: compiled.0.verified,
        };
        compiled.interpreted_because().is_none().then_some(())?;
        let (code, numbers) = Code::new(tapes, target).ok()?;
        let [length, ..] = tapes.lengths;
        Some(Paired {
            code,
            numbers,
            length,
        })
    }

    /// Pairs the constants of both lanes.
    pub fn constants(&self, of: [&Constants; 2]) -> Vec<f64> {
        let [first, second] = of.map(Constants::known);
        let mut pairs = paired(first, second);
        pairs.extend(paired(&self.numbers, &self.numbers));
        pairs
    }

    /// Calls a function; every list holds pairs. Returns whether both lanes have a result; otherwise one of them failed
    /// or has to be evaluated step by step, and `out` has no meaning.
    pub fn call(
        &self,
        function: usize,
        constants: &[f64],
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> bool {
        self.code.call(function, constants, arguments, out) == CallOutcome::Success
    }

    /// Like [`Compiled::repeat`] for two states, with constants of [`Paired::constants`]. Both lanes end when one has
    /// no next result.
    pub fn repeat(
        &self,
        function: usize,
        constants: &[f64],
        [first, second]: [&mut [f64]; 2],
        u: [&[f64]; 2],
        mut given: impl FnMut(u64) -> [f64; 2],
        times: u64,
    ) -> u64 {
        let mut states = paired(first, second);
        let u = paired(u[0], u[1]);
        let length = states.len();
        let mut number = 0;
        let call = |states: &[f64], next: &mut [f64]| {
            let (x, xi) = states
                .split_at_checked(2 * self.length)
                .unwrap_or((states, &[]));
            number += 1;
            let given = given(number);
            let arguments = [x, xi, &u, &given, &[]];
            self.call(function, constants, arguments, next)
        };
        let done = repeated(&mut states, length, times, call, |_| ());
        let lanes = first.iter_mut().zip(second);
        for ((first, second), pair) in lanes.zip(states.chunks_exact(2)) {
            (*first, *second) = (pair[0], pair[1]);
        }
        done
    }
}

/// Interleaves two lists of the same length.
fn paired(first: &[f64], second: &[f64]) -> Vec<f64> {
    let pairs = first.iter().zip(second);
    pairs
        .flat_map(|(&first, &second)| [first, second])
        .collect()
}

/// Replaces `state` by its successor `times` times, or until there is no finite one; returns how often. A result has
/// `results` numbers, and `see` gets the results after each accepted state.
fn repeated(
    state: &mut [f64],
    results: usize,
    times: u64,
    mut call: impl FnMut(&[f64], &mut [f64]) -> bool,
    mut see: impl FnMut(&[f64]),
) -> u64 {
    let length = state.len();
    let mut room = state.to_vec();
    room.resize(results.max(length), f64::NAN);
    let (mut last, mut here, mut next) = (room.clone(), room.clone(), room);
    let mut done = 0;
    while done < times {
        let ended = call(&here[..length], &mut next);
        // A result is read only after the next call: reading numbers that were just written has to wait for the stores.
        if !are_finite(&here[..length]) || !ended {
            break;
        }
        if done > 0 {
            see(&here[length..]);
        }
        std::mem::swap(&mut last, &mut here);
        std::mem::swap(&mut here, &mut next);
        done += 1;
    }
    if done > 0 {
        match are_finite(&here[..length]) {
            // If the loop ended without a next state, this state has not been shown yet.
            true => see(&here[length..]),
            false => {
                here = last;
                done -= 1;
            }
        }
    }
    state.copy_from_slice(&here[..length]);
    done
}

/// Returns whether all numbers are finite: zero times any other number is NaN. Four sums at a time take less than a
/// branch for each number.
fn are_finite(numbers: &[f64]) -> bool {
    let mut fours = numbers.chunks_exact(4);
    let mut sums = [0.0; 4];
    for four in &mut fours {
        for (sum, number) in sums.iter_mut().zip(four) {
            *sum += 0.0 * number;
        }
    }
    let rest: f64 = fours.remainder().iter().map(|number| 0.0 * number).sum();
    sums.iter().sum::<f64>() + rest == 0.0
}

#[cfg(test)]
mod tests {
    use super::{are_finite, repeated};

    /// A state that doubles with every step ends before the next one would overflow, or if there is none.
    #[test]
    fn the_last_state_that_is_a_number_stays() {
        for (start, last) in [(1.0, 1023), (f64::MAX / 4.0, 2), (-f64::MAX, 0)] {
            for times in [0, 1, 2, last, last + 1, last + 2, last + 100] {
                let mut state = [0.5, 1.0, 1.0, 1.0, start];
                let done = repeated(
                    &mut state,
                    5,
                    times,
                    |here, next| {
                        next.copy_from_slice(here);
                        next[4] *= 2.0;
                        true
                    },
                    |_| (),
                );
                assert_eq!(done, times.min(last), "{start} {times}");
                let doubled = (0..done).fold(start, |number, _| 2.0 * number);
                assert_eq!(state, [0.5, 1.0, 1.0, 1.0, doubled]);
            }
        }
        assert_eq!(repeated(&mut [f64::NAN], 1, 3, |_, _| true, |_| ()), 0);
        let mut state = [1.0];
        let mut seen = Vec::new();
        let next = |here: &[f64], next: &mut [f64]| {
            next[0] = here[0] + 1.0;
            next[1] = 10.0 * next[0];
            here[0] < 5.0
        };
        let done = repeated(&mut state, 2, 9, next, |more| seen.push(more.to_vec()));
        assert_eq!((done, state), (4, [5.0]));
        // The numbers that follow every state except the first, once.
        assert_eq!(seen, [[20.0], [30.0], [40.0], [50.0]]);
        // A state that is not finite is not shown.
        let mut seen = 0;
        let next = |here: &[f64], next: &mut [f64]| {
            next.fill(here[0] * 1e200);
            true
        };
        assert_eq!(repeated(&mut [1.0], 2, 9, next, |_| seen += 1), 1);
        assert_eq!(seen, 1);
    }

    #[test]
    fn every_place_is_looked_at() {
        for length in 0..10 {
            assert!(are_finite(&vec![-f64::MAX; length]));
            for place in 0..length {
                for odd in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
                    let mut numbers = vec![1.0; length];
                    numbers[place] = odd;
                    assert!(!are_finite(&numbers));
                }
            }
        }
    }
}
