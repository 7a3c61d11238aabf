//! Evaluation of a function at many states: two at a time in SIMD lanes if there are many, otherwise one by one. The
//! results are the same to the bit.

use crate::rows::{Rows, next};
use hamel_codegen::program::{Argument, Cause};
use hamel_engine::Function;
use hamel_native::{ARGUMENTS, Constants, Paired};

/// The states of one call.
pub struct States<'a> {
    function: &'a Function,
    /// Parameters of all states, unless each has its own.
    constants: &'a Result<Constants, Cause>,
    /// Arguments of the function, to which the first `rows` belong.
    taken: Vec<Argument>,
    /// Arguments, optionally followed by parameters of each state.
    rows: Vec<Rows<'a>>,
    axes: &'a [usize],
    /// Pairs of entries of each argument and of the result, for two states at a time.
    pairs: [Vec<f64>; 5],
    results: Vec<f64>,
}

/// A state by its number and its index along the axes.
type At<'p> = (usize, &'p [usize]);

impl<'a> States<'a> {
    /// Prepares the evaluation at the states of these rows.
    pub fn new(
        function: &'a Function,
        constants: &'a Result<Constants, Cause>,
        taken: Vec<Argument>,
        rows: Vec<Rows<'a>>,
        axes: &'a [usize],
    ) -> Self {
        States {
            results: vec![f64::NAN; 2 * function.shape.entries()],
            pairs: Default::default(),
            function,
            constants,
            taken,
            rows,
            axes,
        }
    }

    /// Writes the results of all states to `out`, one after another. For a state without a result, writes NaN, or, if
    /// `raise` is set, returns its cause and index.
    pub fn evaluate(&mut self, out: &mut [f64], raise: bool) -> Option<(Cause, Vec<usize>)> {
        let count: usize = self.axes.iter().product();
        let entries = self.function.shape.entries();
        let function = self.function;
        let paired = function.paired(count as u64);
        // Shared by all states, if there are no parameters of each state.
        let shared = match (paired, self.constants) {
            (Some(paired), Ok(constants)) if self.rows.len() == self.taken.len() => {
                Some(paired.constants([constants, constants]))
            }
            _ => None,
        };
        let mut place = vec![0; self.axes.len()];
        let mut following = place.clone();
        let mut number = 0;
        while number < count {
            next(&mut following, self.axes);
            let first = number * entries;
            if let Some(paired) = paired
                && number + 1 < count
                && self.both(
                    paired,
                    shared.as_deref(),
                    [(number, &place), (number + 1, &following)],
                )
            {
                let (one, other) = out[first..first + 2 * entries].split_at_mut(entries);
                let pairs = self.results.chunks_exact(2);
                for ((one, other), pair) in one.iter_mut().zip(other).zip(pairs) {
                    (*one, *other) = (pair[0], pair[1]);
                }
                next(&mut following, self.axes);
                number += 2;
            } else {
                // The next two states may both have results.
                let own = &mut out[first..first + entries];
                if let Err(cause) = self.one((number, &place), own) {
                    if raise {
                        return Some((cause, place));
                    }
                    own.fill(f64::NAN);
                }
                number += 1;
            }
            place.copy_from_slice(&following);
        }
        None
    }

    /// Evaluates one state.
    fn one(&mut self, (number, place): At<'_>, out: &mut [f64]) -> Result<(), Cause> {
        let (own, params) = self.rows.split_at_mut(self.taken.len());
        let mut arguments: [&[f64]; 5] = [&[]; 5];
        for (argument, rows) in self.taken.iter().zip(own) {
            if let Some(slot) = slot(*argument).and_then(|slot| arguments.get_mut(slot)) {
                *slot = rows.at(number, place);
            }
        }
        match params.first_mut() {
            Some(params) => {
                let constants = self.function.constants(params.at(number, place))?;
                self.function.call(&constants, arguments, out)
            }
            None => {
                let constants = self.constants.as_ref().map_err(|cause| *cause)?;
                self.function.call(constants, arguments, out)
            }
        }
    }

    /// Evaluates two states at a time, as pairs; returns whether both have a result.
    fn both(&mut self, paired: &Paired, shared: Option<&[f64]>, two: [At<'_>; 2]) -> bool {
        let (own, params) = self.rows.split_at_mut(self.taken.len());
        for (argument, rows) in self.taken.iter().zip(own) {
            let Some(pairs) = slot(*argument).and_then(|slot| self.pairs.get_mut(slot)) else {
                continue;
            };
            for (lane, (number, place)) in two.into_iter().enumerate() {
                let row = rows.at(number, place);
                pairs.resize(2 * row.len(), f64::NAN);
                for (pair, entry) in pairs.chunks_exact_mut(2).zip(row) {
                    pair[lane] = *entry;
                }
            }
        }
        let arguments = self.pairs.each_ref().map(Vec::as_slice);
        let out = &mut self.results;
        match (shared, params.first_mut()) {
            (Some(shared), _) => self.function.both(paired, shared, arguments, out),
            (None, Some(params)) => {
                let [one, other] =
                    two.map(|(number, place)| self.function.constants(params.at(number, place)));
                let (Ok(one), Ok(other)) = (one, other) else {
                    return false;
                };
                let constants = paired.constants([&one, &other]);
                self.function.both(paired, &constants, arguments, out)
            }
            // The parameters shared by all states admit no result.
            (None, None) => false,
        }
    }
}

/// Returns the index of an argument in [`ARGUMENTS`].
fn slot(argument: Argument) -> Option<usize> {
    ARGUMENTS.iter().position(|of| *of == argument)
}
