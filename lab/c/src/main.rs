//! Times generated C against generated Rust for the same models, alternately in one process.
//!
//! Started by `lab/c/run.sh`; inputs, rounds and medians are those of `lab/casadi`. Results are compared before
//! they are timed. The exit status is 1 if the C takes more than 1.05 times as long as the Rust.

use hamel::{Singular, System, Table, Tangent};
use hamel_lab::input::{Input, input};
use hamel_lab::measure::INPUTS;
use hamel_lab::{input, measure};
use libloading::Library;
use std::cell::RefCell;
use std::error::Error;
use std::ffi::{c_int, c_void};
use std::hint::black_box;

mod free_body {
    include!(concat!(env!("OUT_DIR"), "/free_body.rs"));
}
mod ur5 {
    include!(concat!(env!("OUT_DIR"), "/ur5.rs"));
}
mod solo12 {
    include!(concat!(env!("OUT_DIR"), "/solo12.rs"));
}

/// The largest accepted ratio of the time of the C to that of the Rust.
const BAR: f64 = 1.05;
/// Largest accepted difference of results, relative to the largest component.
const AGREEMENT: f64 = 1e-12;
/// Room for the largest structure of parameters and constants, and for the largest result, in numbers.
const ROOM: usize = 10_000;

/// Memory for results, shared by C and Rust. It is aligned to a cache line, since writes that cross two lines take
/// longer.
#[repr(align(64))]
struct Place([f64; ROOM]);

impl Place {
    /// Views the memory as slopes.
    fn slopes<S: Tangent<Scalar = f64>>(&mut self) -> &mut S::Slopes {
        assert!(size_of::<S::Slopes>() <= size_of::<Self>());
        // SAFETY: a table consists of numbers only, and the assertion checks that there is room for it.
        unsafe { &mut *self.0.as_mut_ptr().cast() }
    }
}

type Default = unsafe extern "C" fn(*mut c_void);
type Set = unsafe extern "C" fn(*mut c_void, *const c_void) -> c_int;
/// A generated function of the constants, a state and inputs.
type Function =
    unsafe extern "C" fn(*const c_void, *const f64, *const f64, *const f64, *mut f64) -> c_int;

/// The generated C of a system, with its default parameters.
struct InC<'a> {
    library: &'a Library,
    prefix: &'a str,
    constants: Vec<f64>,
}

impl<'a> InC<'a> {
    fn new(library: &'a Library, prefix: &'a str) -> Result<Self, Box<dyn Error>> {
        // SAFETY: the signatures are those of the generated header.
        let (default, set) = unsafe {
            (
                library.get::<Default>(format!("{prefix}_default_parameters").as_bytes())?,
                library.get::<Set>(format!("{prefix}_set_parameters").as_bytes())?,
            )
        };
        let (mut parameters, mut constants) = (vec![0.0_f64; ROOM], vec![0.0_f64; ROOM]);
        // SAFETY: both structures consist of numbers, at most `ROOM` of them.
        let status = unsafe {
            default(parameters.as_mut_ptr().cast());
            set(constants.as_mut_ptr().cast(), parameters.as_ptr().cast())
        };
        match status {
            0 => Ok(InC {
                library,
                prefix,
                constants,
            }),
            _ => Err(format!("{prefix}: status {status}").into()),
        }
    }

    /// Compares both results, prints one row of the table, and returns the ratio of the time of the C to that of the
    /// Rust. `rust` is the call that is timed, `values` returns its result.
    fn row<S: System<Scalar = f64>>(
        &self,
        function: &str,
        inputs: &[Input<S>],
        rust: impl Fn(&Input<S>, &mut Place),
        values: impl Fn(&Input<S>) -> Result<Vec<f64>, Singular>,
    ) -> Result<f64, Box<dyn Error>> {
        let name = format!("{}_{function}", self.prefix);
        // SAFETY: the signature is that of the generated header.
        let c = unsafe { self.library.get::<Function>(name.as_bytes())? };
        let call = |c: Function, input: &Input<S>, place: &mut [f64]| {
            let [x, xi, u] = [input.x.as_ref(), input.xi.as_ref(), input.u.as_ref()];
            // SAFETY: lengths are those of the header, which the same program generated as the Rust.
            unsafe {
                c(
                    self.constants.as_ptr().cast(),
                    x.as_ptr(),
                    xi.as_ptr(),
                    u.as_ptr(),
                    place.as_mut_ptr(),
                )
            }
        };
        let mut place = Place([0.0; ROOM]);
        for input in inputs {
            let wanted = values(input)?;
            let status = call(*c, input, &mut place.0);
            let found = &place.0[..wanted.len()];
            let scale = wanted.iter().fold(1.0, |most: f64, v| most.max(v.abs()));
            let mut pairs = wanted.iter().zip(found);
            if status != 0 || !pairs.all(|(a, b)| (a - b).abs() <= AGREEMENT * scale) {
                return Err(format!("{name}: {wanted:?} of Rust, {found:?} of C").into());
            }
        }
        let place = RefCell::new(place);
        let in_c = |count: u32| {
            let c = black_box(*c);
            let mut place = place.borrow_mut();
            for _ in 0..count {
                for input in inputs {
                    call(c, input, &mut place.0);
                    black_box(&*place);
                }
            }
        };
        let in_rust = |count: u32| {
            let mut place = place.borrow_mut();
            for _ in 0..count {
                for input in inputs {
                    rust(input, &mut place);
                }
            }
        };
        let (c, rust) = measure::by_turns(&in_c, &in_rust);
        println!("| {name} | {c:.1} | {rust:.1} | {:.3} |", c / rust);
        Ok(c / rust)
    }

    /// Times forward dynamics and their slopes. Rust writes the slopes to the same memory in each call, as C does.
    fn rows<S: Tangent<Scalar = f64>>(&self, system: &S) -> Result<[f64; 2], Box<dyn Error>> {
        type Forward<S> = fn(
            &S,
            &<S as System>::Coordinates,
            &<S as System>::Velocities,
            &<S as System>::Inputs,
        ) -> Result<<S as System>::Velocities, Singular>;
        type Slopes<S> = fn(
            &S,
            &<S as System>::Coordinates,
            &<S as System>::Velocities,
            &<S as System>::Inputs,
            &mut <S as Tangent>::Slopes,
        ) -> Result<<S as System>::Velocities, Singular>;
        let inputs: Vec<Input<S>> = (0..INPUTS).map(|k| input(system, k)).collect();
        let accel: Forward<S> = black_box(|system, x, xi, u| system.forward_dynamics(x, xi, u));
        let slopes: Slopes<S> =
            black_box(|system, x, xi, u, slopes| system.slopes(x, xi, u, slopes));
        Ok([
            self.row(
                "accel",
                &inputs,
                |at, _| {
                    black_box(&accel(black_box(system), &at.x, &at.xi, &at.u));
                },
                |at| {
                    Ok(system
                        .forward_dynamics(&at.x, &at.xi, &at.u)?
                        .as_ref()
                        .to_vec())
                },
            )?,
            self.row(
                "linearize",
                &inputs,
                |at, place| {
                    let place = place.slopes::<S>();
                    black_box(&slopes(black_box(system), &at.x, &at.xi, &at.u, place));
                    black_box(&*place);
                },
                |at| {
                    let mut slopes = S::Slopes::zero();
                    system.slopes(&at.x, &at.xi, &at.u, &mut slopes)?;
                    let rows = (0..slopes.rows()).flat_map(|i| slopes.row(i).to_vec());
                    Ok(rows.collect())
                },
            )?,
        ])
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("the library is missing")?;
    // SAFETY: generated functions have no constructors, so opening the library runs nothing.
    let library = unsafe { Library::new(path)? };
    println!("| function | C, ns | Rust, ns | C / Rust |\n|---|---:|---:|---:|");
    let ratios = [
        InC::new(&library, "free_body")?.rows(&free_body::FreeBody::default())?,
        InC::new(&library, "ur5")?.rows(&ur5::Ur5::default())?,
        InC::new(&library, "solo")?.rows(&solo12::Solo::default())?,
    ];
    if ratios.iter().flatten().any(|&ratio| ratio > BAR) {
        return Err(format!("C takes more than {BAR} times as long").into());
    }
    Ok(())
}
