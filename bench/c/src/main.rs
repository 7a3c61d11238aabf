//! Times generated C against generated Rust for the same models, by turns in one process.
//!
//! Started by `bench/c/run.sh`; inputs, rounds and medians are those of `bench/casadi`. Both have to agree before they are
//! timed. Ends with 1 where the C takes more than 1.05 times as long as the Rust.

mod input;
#[path = "../../casadi/src/measure.rs"]
mod measure;

use hamel::{Singular, System};
use input::{Input, input};
use libloading::Library;
use measure::INPUTS;
use std::error::Error;
use std::ffi::{c_int, c_void};
use std::hint::black_box;

mod free_body {
    include!(concat!(env!("OUT_DIR"), "/free_body.rs"));
}
mod ur5 {
    include!(concat!(env!("OUT_DIR"), "/ur5_robot.rs"));
}
mod solo12 {
    include!(concat!(env!("OUT_DIR"), "/solo12.rs"));
}

/// The most that the C may take, over the Rust.
const BAR: f64 = 1.05;
/// Largest difference of results, relative to the largest component.
const AGREEMENT: f64 = 1e-12;
/// Numbers of the largest structure of parameters and constants.
const ROOM: usize = 100_000;

type Default = unsafe extern "C" fn(*mut c_void);
type Set = unsafe extern "C" fn(*mut c_void, *const c_void) -> c_int;
type Accel =
    unsafe extern "C" fn(*const c_void, *const f64, *const f64, *const f64, *mut f64) -> c_int;

/// One row of the table; what the C takes over the Rust.
fn row<S: System<Scalar = f64>>(
    library: &Library,
    prefix: &str,
    system: &S,
) -> Result<f64, Box<dyn Error>> {
    type Forward<S> = fn(
        &S,
        &<S as System>::Coordinates,
        &<S as System>::Velocities,
        &<S as System>::Inputs,
    ) -> Result<<S as System>::Velocities, Singular>;
    let inputs: Vec<Input<S>> = (0..INPUTS).map(|k| input(system, k)).collect();
    // SAFETY: the signatures are those of the generated header.
    let (default, set, accel) = unsafe {
        (
            library.get::<Default>(format!("{prefix}_default_parameters").as_bytes())?,
            library.get::<Set>(format!("{prefix}_set_parameters").as_bytes())?,
            library.get::<Accel>(format!("{prefix}_accel").as_bytes())?,
        )
    };
    let (mut parameters, mut constants) = (vec![0.0_f64; ROOM], vec![0.0_f64; ROOM]);
    // SAFETY: both structures consist of numbers, fewer than there is room for.
    let status = unsafe {
        default(parameters.as_mut_ptr().cast());
        set(constants.as_mut_ptr().cast(), parameters.as_ptr().cast())
    };
    if status != 0 {
        return Err(format!("{prefix}: status {status}").into());
    }
    let mut out = system.zero_velocities();
    let call = |accel: Accel, input: &Input<S>, out: &mut S::Velocities| {
        let [x, xi, u] = [input.x.as_ref(), input.xi.as_ref(), input.u.as_ref()];
        // SAFETY: lengths are those of the header, which come from the same program as the Rust.
        unsafe {
            accel(
                constants.as_ptr().cast(),
                x.as_ptr(),
                xi.as_ptr(),
                u.as_ptr(),
                out.as_mut().as_mut_ptr(),
            )
        }
    };
    for input in &inputs {
        let wanted = system.accel(&input.x, &input.xi, &input.u)?;
        let status = call(*accel, input, &mut out);
        let scale = wanted
            .as_ref()
            .iter()
            .fold(1.0, |most: f64, v| most.max(v.abs()));
        let mut pairs = wanted.as_ref().iter().zip(out.as_ref());
        if status != 0 || !pairs.all(|(a, b)| (a - b).abs() <= AGREEMENT * scale) {
            return Err(format!(
                "{prefix}: {:?} of Rust, {:?} of C",
                wanted.as_ref(),
                out.as_ref()
            )
            .into());
        }
    }
    let c = |count: u32| {
        let accel = black_box(*accel);
        let mut out = system.zero_velocities();
        for _ in 0..count {
            for input in &inputs {
                call(accel, input, &mut out);
                black_box(&out);
            }
        }
    };
    let rust = |count: u32| {
        let accel: Forward<S> = black_box(|system, x, xi, u| system.accel(x, xi, u));
        for _ in 0..count {
            let system = black_box(system);
            for input in &inputs {
                black_box(&accel(system, &input.x, &input.xi, &input.u));
            }
        }
    };
    let (c, rust) = measure::by_turns(&c, &rust);
    println!("| {prefix} | {c:.1} | {rust:.1} | {:.3} |", c / rust);
    Ok(c / rust)
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("the library is missing")?;
    // SAFETY: generated functions without constructors; nothing runs when it is opened.
    let library = unsafe { Library::new(path)? };
    println!("| forward dynamics | C, ns | Rust, ns | C / Rust |\n|---|---:|---:|---:|");
    let ratios = [
        row(&library, "free_body", &free_body::FreeBody::default())?,
        row(&library, "ur5", &ur5::Ur5::default())?,
        row(&library, "solo", &solo12::Solo::default())?,
    ];
    if ratios.iter().any(|&ratio| ratio > BAR) {
        return Err(format!("C takes more than {BAR} times as long").into());
    }
    Ok(())
}
