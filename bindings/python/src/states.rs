//! A function at many states: two at once in the lanes of one code where they are many, else one after the other. The numbers
//! are the same to the bit.

use crate::rows::{Rows, next};
use hamel_codegen::program::{Argument, Cause};
use hamel_engine::Function;
use hamel_native::{ARGUMENTS, Constants, Paired};

/// The states of one call.
pub struct States<'a> {
    function: &'a Function,
    /// Parameters that all states have.
    constants: &'a Result<Constants, Cause>,
    /// The arguments that are taken, which the first rows are of.
    taken: Vec<Argument>,
    /// Behind the arguments may be parameters of each state.
    rows: Vec<Rows<'a>>,
    axes: &'a [usize],
    /// Two states at once: pairs of entries of each argument, and of the result.
    pairs: [Vec<f64>; 5],
    results: Vec<f64>,
}

/// A state by its number and its place along the axes.
type At<'p> = (usize, &'p [usize]);

impl<'a> States<'a> {
    /// The states that rows have.
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

    /// The results of all states, one behind the other. Where there is none it is NaN, or the first such state ends it with
    /// its place, where that is an error.
    pub fn evaluate(&mut self, out: &mut [f64], raise: bool) -> Option<(Cause, Vec<usize>)> {
        let count: usize = self.axes.iter().product();
        let entries = self.function.shape.entries();
        let function = self.function;
        let paired = function.paired(count as u64);
        // The same for all states, where they have no parameters of their own.
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
                // The next two may do.
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

    /// The result of one state.
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

    /// The results of two states, as pairs; whether both have one.
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
            // There is no result with these parameters.
            (None, None) => false,
        }
    }
}

/// The place of an argument among all of them.
fn slot(argument: Argument) -> Option<usize> {
    ARGUMENTS.iter().position(|of| *of == argument)
}
