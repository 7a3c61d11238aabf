//! C functions that CasADi generated.

use crate::measure::INPUTS;
use libloading::Library;
use std::error::Error;
use std::ffi::{c_int, c_longlong};
use std::hint::black_box;
use std::path::Path;

type Evaluate = unsafe extern "C" fn(
    *const *const f64,
    *mut *mut f64,
    *mut c_longlong,
    *mut f64,
    c_int,
) -> c_int;
type Work = unsafe extern "C" fn(
    *mut c_longlong,
    *mut c_longlong,
    *mut c_longlong,
    *mut c_longlong,
) -> c_int;

/// Opens the library that `run.sh` compiled.
pub fn open(path: &Path) -> Result<Library, libloading::Error> {
    // SAFETY: generated functions have no constructors, so opening the library runs nothing.
    unsafe { Library::new(path) }
}

/// A function (x, ξ, u) → n numbers, with its inputs.
pub struct Function<'a> {
    evaluate: libloading::Symbol<'a, Evaluate>,
    inputs: Vec<[Vec<f64>; 3]>,
    width: usize,
    integers: usize,
    numbers: usize,
}

impl<'a> Function<'a> {
    pub fn new(
        library: &'a Library,
        name: &str,
        inputs: Vec<[Vec<f64>; 3]>,
        width: usize,
    ) -> Result<Self, Box<dyn Error>> {
        assert_eq!(inputs.len(), INPUTS);
        // SAFETY: CasADi documents these signatures for the code that it generates.
        let (evaluate, work) = unsafe {
            (
                library.get::<Evaluate>(name.as_bytes())?,
                library.get::<Work>(format!("{name}_work").as_bytes())?,
            )
        };
        let mut sizes = [0; 4];
        let [arguments, results, integers, numbers] = &mut sizes;
        // SAFETY: the function writes to these four places.
        unsafe { work(arguments, results, integers, numbers) };
        // There is room for the three arguments and the result only.
        if sizes[0] > 3 || sizes[1] > 1 {
            return Err(format!("{name} asks for {sizes:?}").into());
        }
        Ok(Self {
            evaluate,
            inputs,
            width,
            integers: usize::try_from(sizes[2])?,
            numbers: usize::try_from(sizes[3])?,
        })
    }

    pub fn results(&self) -> Vec<Vec<f64>> {
        let mut found = Vec::new();
        self.each(1, |result| found.push(result.to_vec()));
        found
    }

    /// Evaluates all inputs `count` times.
    pub fn run(&self, count: u32) {
        self.each(count, |result| {
            black_box(result);
        });
    }

    fn each(&self, count: u32, mut see: impl FnMut(&[f64])) {
        let mut result = vec![0.0; self.width];
        let (mut integers, mut numbers) = (vec![0; self.integers], vec![0.0; self.numbers]);
        let evaluate: Evaluate = black_box(*self.evaluate);
        let arguments: Vec<[*const f64; 3]> = self
            .inputs
            .iter()
            .map(|input| [0, 1, 2].map(|i: usize| input[i].as_ptr()))
            .collect();
        let mut results = [result.as_mut_ptr()];
        for _ in 0..count {
            for argument in &arguments {
                // SAFETY: the lengths are those of this function in `cases.json`, the work vectors have the lengths
                // that it requires, and the lists live until the end of this function.
                unsafe {
                    evaluate(
                        argument.as_ptr(),
                        results.as_mut_ptr(),
                        integers.as_mut_ptr(),
                        numbers.as_mut_ptr(),
                        0,
                    )
                };
                // SAFETY: `results` points to `width` numbers, to which nothing writes now.
                see(unsafe { std::slice::from_raw_parts(results[0], self.width) });
            }
        }
    }
}
