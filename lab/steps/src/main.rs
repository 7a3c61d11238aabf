//! Compares steps with slopes [A_d B_d] with the emitted linearisation [A B]: operations, and times measured
//! alternately in one process.
//!
//! Started by `lab/steps/run.sh`; inputs, rounds and medians are those of `lab/casadi`.

mod operations;

use hamel::methods::{InChart, Rkmk4, SemiImplicitEuler};
use hamel::{Method, State, System, Table, Tangent, TangentSystem, step_slopes_into};
use hamel_lab::input::{Input, input};
use hamel_lab::measure;
use hamel_lab::measure::INPUTS;
use operations::{Counted, counted};
use std::hint::black_box;

mod ur5 {
    include!(concat!(env!("OUT_DIR"), "/ur5.rs"));
}
mod solo12 {
    include!(concat!(env!("OUT_DIR"), "/solo12.rs"));
}

/// Length of a step, in s.
const STEP: f64 = 1e-3;

/// A state of a system, with inputs.
fn at<S: System>(system: &S, k: usize) -> (State<S>, S::Inputs) {
    let Input { x, xi, u } = input(system, k);
    (State { t: 0.0, x, xi }, u)
}

/// Counts the operations of [A B] and of a step with [A_d B_d].
fn operations<S, M>(system: &S, method: &M) -> [u64; 2]
where
    S: Tangent<Scalar = Counted>,
    M: Method<TangentSystem<S>> + InChart,
{
    let tangent = TangentSystem::new(system);
    let (state, u) = at(system, 3);
    [
        counted(|| {
            let mut slopes = S::Slopes::zero();
            let _ = black_box(system.slopes(&state.x, &state.xi, &u, &mut slopes));
        }),
        counted(|| {
            let mut slopes = S::Slopes::zero();
            let step = step_slopes_into(method, &tangent, &state, &u, STEP, &mut slopes);
            drop(black_box(step));
        }),
    ]
}

/// Times [A B] and a step with [A_d B_d], in ns.
fn times<S, M>(system: &S, method: &M) -> (f64, f64)
where
    S: Tangent<Scalar = f64>,
    M: Method<TangentSystem<S>> + InChart,
{
    let inputs: Vec<_> = (0..INPUTS).map(|k| at(system, k)).collect();
    let tangent = TangentSystem::new(system);
    let linear = |count: u32| {
        let mut slopes = S::Slopes::zero();
        for _ in 0..count {
            for (state, u) in &inputs {
                let _ = black_box(black_box(system).slopes(&state.x, &state.xi, u, &mut slopes));
                black_box(&slopes);
            }
        }
    };
    let stepped = |count: u32| {
        let mut slopes = S::Slopes::zero();
        for _ in 0..count {
            for (state, u) in &inputs {
                let tangent = black_box(&tangent);
                let _ = black_box(step_slopes_into(
                    method,
                    tangent,
                    state,
                    u,
                    STEP,
                    &mut slopes,
                ));
                black_box(&slopes);
            }
        }
    };
    measure::by_turns(&linear, &stepped)
}

/// Prints a row of the table.
macro_rules! row {
    ($name:literal, $system:ty, $counted:ty, $method:expr) => {
        let [linear, step] = operations(&<$counted>::default(), &$method);
        let (before, after) = times(&<$system>::default(), &$method);
        println!(
            "| {} | {:?} | {linear} | {step} | {before:.0} ns | {after:.0} ns | {:.2} |",
            $name,
            $method,
            after / before
        );
    };
}

fn main() {
    println!(
        "| robot | method | [A B], operations | step with [A_d B_d] | [A B], time | step | ratio |"
    );
    println!("|---|---|---|---|---|---|---|");
    row!("UR5", ur5::Ur5<f64>, ur5::Ur5<Counted>, SemiImplicitEuler);
    row!("UR5", ur5::Ur5<f64>, ur5::Ur5<Counted>, Rkmk4);
    row!(
        "Solo12",
        solo12::Solo<f64>,
        solo12::Solo<Counted>,
        SemiImplicitEuler
    );
    row!("Solo12", solo12::Solo<f64>, solo12::Solo<Counted>, Rkmk4);
}
