//! Functions whose result is the next (x, ξ), as a step of a method is, called again and again: for one state, or for two
//! of them in the lanes of one code.

use crate::code::{Code, Ended};
use crate::target::Target;
use crate::{Compiled, Constants};

impl Compiled {
    /// Calls a function as often as is asked for, or until it has no result or one that is not finite. `state` holds x and
    /// behind it ξ; u stays as it is. Returns how many results there were; `state` is then the last of them.
    pub fn repeat(
        &self,
        function: usize,
        constants: &Constants,
        state: &mut [f64],
        u: &[f64],
        times: u64,
    ) -> u64 {
        let [length, ..] = self.tapes().lengths;
        repeated(state, times, |state, next| {
            let (x, xi) = state.split_at_checked(length).unwrap_or((state, &[]));
            let arguments = [x, xi, u, &[], &[]];
            self.call(function, constants, arguments, next).is_ok()
        })
    }
}

/// The same functions for two sets of arguments at once: every number of one lane is that of [`Compiled`], to the bit.
#[derive(Debug)]
pub struct Paired {
    code: Code,
    numbers: Vec<f64>,
    length: usize,
}

impl Paired {
    /// The functions of these tapes; `None` where this machine has no code for two lanes.
    pub fn new(compiled: &Compiled) -> Option<Self> {
        let tapes = compiled.tapes();
        let target = Target {
            fused: compiled.is_fused(),
            paired: true,
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

    /// What both lanes are called with besides their arguments.
    pub fn constants(&self, of: [&Constants; 2]) -> Vec<f64> {
        let [first, second] = of.map(Constants::known);
        let mut pairs = paired(first, second);
        pairs.extend(paired(&self.numbers, &self.numbers));
        pairs
    }

    /// Calls a function; every list holds pairs. Whether both lanes have a result: else one of them has none, or has to be
    /// evaluated step by step, and `out` has no meaning.
    pub fn call(
        &self,
        function: usize,
        constants: &[f64],
        arguments: [&[f64]; 5],
        out: &mut [f64],
    ) -> bool {
        self.code.call(function, constants, arguments, out) == Ended::Well
    }

    /// As [`Compiled::repeat`] for two states, for constants of [`Paired::constants`]. Both lanes end where one has no next
    /// result.
    pub fn repeat(
        &self,
        function: usize,
        constants: &[f64],
        [first, second]: [&mut [f64]; 2],
        u: [&[f64]; 2],
        times: u64,
    ) -> u64 {
        let mut states = paired(first, second);
        let u = paired(u[0], u[1]);
        let done = repeated(&mut states, times, |states, next| {
            let (x, xi) = states
                .split_at_checked(2 * self.length)
                .unwrap_or((states, &[]));
            let arguments = [x, xi, &u, &[], &[]];
            self.call(function, constants, arguments, next)
        });
        let lanes = first.iter_mut().zip(second);
        for ((first, second), pair) in lanes.zip(states.chunks_exact(2)) {
            (*first, *second) = (pair[0], pair[1]);
        }
        done
    }
}

/// Two lists of one length as one of pairs.
fn paired(first: &[f64], second: &[f64]) -> Vec<f64> {
    let pairs = first.iter().zip(second);
    pairs
        .flat_map(|(&first, &second)| [first, second])
        .collect()
}

/// Takes `next` from `state` so many times, or until there is no next one that is finite; how many there were.
fn repeated(
    state: &mut [f64],
    times: u64,
    mut call: impl FnMut(&[f64], &mut [f64]) -> bool,
) -> u64 {
    let mut here = state.to_vec();
    let mut next = vec![f64::NAN; state.len()];
    let mut done = 0;
    while done < times && call(&here, &mut next) && are_finite(&next) {
        std::mem::swap(&mut here, &mut next);
        done += 1;
    }
    state.copy_from_slice(&here);
    done
}

/// Whether all numbers are finite. Zero times one that is not is NaN, and four sums at a time take less than a branch for
/// each number.
fn are_finite(numbers: &[f64]) -> bool {
    let mut sums = [0.0; 4];
    for four in numbers.chunks(4) {
        for (sum, number) in sums.iter_mut().zip(four) {
            *sum += 0.0 * number;
        }
    }
    sums == [0.0; 4]
}
