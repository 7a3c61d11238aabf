//! Compares the throughput of lanes with that of single numbers, and measures ensembles.
//!
//! Every row handles the same 64 states; compare the column of items per second. Run with
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p hamel-tests --bench lanes`.

use divan::{Bencher, black_box};
use hamel::ensemble::{self, quietly};
use hamel::methods::Rkmk4;
use hamel::wide::{f32x8, f64x4, f64x8};
use hamel::{Lanes, State, System, integrate};
use hamel_tests::cart_pole::CartPole;
use hamel_tests::double_pendulum_angles::DoublePendulum;
use hamel_tests::drone::Drone;
use hamel_tests::free_body::FreeBody;
use hamel_tests::two_bodies::TwoBodies;

/// Number of states of one measurement.
const STATES: usize = 64;
const SAMPLES: u32 = 1000;

fn main() {
    divan::main();
}

type Case<Sys> = (
    <Sys as System>::Coordinates,
    <Sys as System>::Velocities,
    <Sys as System>::Inputs,
);

/// Different states in every lane and call, near the start.
fn cases<Sys: System<Scalar: Lanes>>(system: &Sys) -> Vec<Case<Sys>> {
    let wave = |k: usize, i: usize| {
        Sys::Scalar::from_lanes(|lane| {
            hamel::Scalar::from_f64((((k + lane) * 37 + i * 11) as f64 * 0.618).sin())
        })
    };
    let case = |k: usize| {
        let (mut x, mut xi) = system.start();
        let mut chart = system.zero_chart();
        let mut u = system.zero_inputs();
        for (i, chart) in chart.as_mut().iter_mut().enumerate() {
            *chart = wave(k, i);
        }
        hamel::manifold::retract(system.blocks(), x.as_mut(), chart.as_ref());
        for (i, xi) in xi.as_mut().iter_mut().enumerate() {
            *xi += wave(k, i + 20);
        }
        for (i, u) in u.as_mut().iter_mut().enumerate() {
            *u = wave(k, i + 40);
        }
        (x, xi, u)
    };
    (0..STATES).step_by(Sys::Scalar::COUNT).map(case).collect()
}

fn accel<Sys: System<Scalar: Lanes>>(bencher: Bencher, system: &Sys) {
    let cases = cases(system);
    bencher.counter(STATES).bench_local(|| {
        for (x, xi, u) in &cases {
            let _ = black_box(system.forward_dynamics(black_box(x), black_box(xi), black_box(u)));
        }
    });
}

macro_rules! accel {
    ($($name:ident: $system:ident,)*) => {$(
        mod $name {
            use super::*;

            #[divan::bench(sample_count = SAMPLES)]
            fn f64_alone(bencher: Bencher) {
                accel(bencher, &$system::<f64>::default());
            }
            #[divan::bench(sample_count = SAMPLES)]
            fn f64_by_4(bencher: Bencher) {
                accel(bencher, &$system::<f64x4>::default());
            }
            #[divan::bench(sample_count = SAMPLES)]
            fn f64_by_8(bencher: Bencher) {
                accel(bencher, &$system::<f64x8>::default());
            }
            #[divan::bench(sample_count = SAMPLES)]
            fn f32_alone(bencher: Bencher) {
                accel(bencher, &$system::<f32>::default());
            }
            #[divan::bench(sample_count = SAMPLES)]
            fn f32_by_8(bencher: Bencher) {
                accel(bencher, &$system::<f32x8>::default());
            }
        }
    )*};
}

accel! {
    accel_cart_pole: CartPole,
    accel_double_pendulum: DoublePendulum,
    accel_drone: Drone,
    accel_free_body: FreeBody,
    accel_two_bodies: TwoBodies,
}

/// 512 double pendulums with 200 steps each.
mod ensemble_of_double_pendulums {
    use super::*;

    const MEMBERS: usize = 512;
    const STEPS: usize = 200;
    const H: f64 = 0.01;
    const UNTIL: f64 = STEPS as f64 * H;

    fn members() -> Vec<State<DoublePendulum<f64>>> {
        (0..MEMBERS)
            .map(|member| State {
                t: 0.0,
                x: [2.0 + 1e-3 * member as f64, 2.5],
                xi: [0.0; 2],
            })
            .collect()
    }

    #[divan::bench(sample_count = 20)]
    fn one_by_one(bencher: Bencher) {
        let system = DoublePendulum::<f64>::default();
        bencher
            .counter(MEMBERS * STEPS)
            .with_inputs(members)
            .bench_local_values(|mut states| {
                for state in &mut states {
                    let _ = black_box(integrate(
                        &system,
                        Rkmk4,
                        state,
                        H,
                        UNTIL,
                        |_, _, _| [],
                        |_| {},
                    ));
                }
                states
            });
    }

    #[divan::bench(sample_count = 20, types = [f64, f64x4, f64x8])]
    fn together<L: Lanes<Element = f64> + Sync>(bencher: Bencher) {
        let system = DoublePendulum::<L>::default();
        bencher
            .counter(MEMBERS * STEPS)
            .with_inputs(members)
            .bench_local_values(|mut states| {
                let none = |_: &_, _: f64, _: &_, _: &_| [];
                let _ = black_box(ensemble::integrate(
                    &system,
                    &Rkmk4,
                    &mut states,
                    H,
                    UNTIL,
                    none,
                    quietly,
                ));
                states
            });
    }
}
