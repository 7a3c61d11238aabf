//! Implicit steps of stiff systems, with and without derivatives: ten steps of 1/100 s from the same start.
//!
//! Run with `cargo bench -p hamel-tests --bench stiff`.

use divan::{Bencher, black_box};
use hamel::methods::{BackwardEuler, Method, StiffEuler};
use hamel::{State, System, step};
use hamel_tests::linear::spring_chain::{SpringChain, SpringChainParameters};

hamel::rigid_eom! {
    /// An arm of four joints, one of them mounted at 45 degrees, with stiff springs that begin a third of a radian from rest.
    pub system StiffArm {
        gravity [0, 0, -9.81];
        param k = 1000000;
        joint a: revolute [0, 0, 1] moves base { force -k * (a - 0.2); }
        body on base { mass 5; com [0.02, 0.01, 0.1]; inertia diag(0.1, 0.12, 0.07) about com; }
        joint b: revolute [0, 1, 0] on base at pose(rotx(pi / 4), [0, 0.1, 0.3]) moves upper { force -k * (b + 0.3); }
        body on upper { mass 3; com [0.2, 0.02, 0.01]; inertia diag(0.02, 0.1, 0.1) about com; }
        joint c: revolute [0, 1, 0] on upper at [0.5, 0, 0] moves lower { force -k * (c - 0.3); }
        body on lower { mass 2; com [0.2, 0, 0.05]; inertia diag(0.01, 0.05, 0.05) about com; }
        joint d: revolute [1, 0, 0] on lower at [0.4, 0, 0] moves hand { force -k * d; }
        body on hand { mass 0.5; com [0.05, 0.03, 0]; inertia diag(0.001, 0.002, 0.002) about com; }
        generate all, linearize;
    }
}

fn main() {
    divan::main();
}

fn run<Sys: System, M: Method<Sys>>(bencher: Bencher, system: &Sys, method: M) {
    let start = State::start(system);
    bencher.bench_local(|| {
        let mut state = black_box(&start).clone();
        for _ in 0..10 {
            let inputs = |_: f64, _: &_, _: &_| system.zero_inputs();
            step(system, &method, &mut state, 0.01, &inputs).expect("a step");
        }
        state
    });
}

fn chain(k: f64) -> SpringChain<f64> {
    let parameters = SpringChainParameters {
        k,
        ..Default::default()
    };
    SpringChain::new(parameters).expect("three carts")
}

#[divan::bench(args = [1e1, 1e4, 1e8])]
fn chain_with_derivatives(bencher: Bencher, k: f64) {
    run(bencher, &chain(k), StiffEuler);
}

#[divan::bench(args = [1e1, 1e4, 1e8])]
fn chain_without(bencher: Bencher, k: f64) {
    run(bencher, &chain(k), BackwardEuler);
}

#[divan::bench(args = [1e2, 1e6])]
fn arm_with_derivatives(bencher: Bencher, k: f64) {
    let system = StiffArm::<f64>::new(StiffArmParameters { k }).expect("an arm");
    run(bencher, &system, StiffEuler);
}

#[divan::bench(args = [1e2, 1e6])]
fn arm_without(bencher: Bencher, k: f64) {
    let system = StiffArm::<f64>::new(StiffArmParameters { k }).expect("an arm");
    run(bencher, &system, BackwardEuler);
}
