//! Times one step of every method for bodies: on the generated benchmark top at 150 rad/s, with steps of 0.075 rad, and
//! on hand-written tops, whose moments may all differ.
//!
//! Compare the rows by their ratios; a step of `Rkmk4` is listed with the four accelerations and four exponentials that
//! every method of its kind needs. Run with
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p hamel-cases --bench steps`.

use divan::{Bencher, black_box};
use hamel::flows::Flow;
use hamel::methods::{Cf4, Free, Gauss4, Gauss6, Lgvi, Rkmk4, Rkmk8, Rkmk54, Scheme, Splitting};
use hamel::{Method, State, System, so3};
use hamel_cases::bodies::benchmark_top;
use hamel_cases::by_hand::{Body, QuaternionTop, Reference, Spin, Top};
use hamel_engine::baselines::{Buss, Slide};

/// Steps of one measurement: the state advances, so that nothing is hoisted out of the loop.
const STEPS: usize = 64;
const SAMPLES: u32 = 500;

fn main() {
    divan::main();
}

/// A top without symmetry that spins at 1 rad/s about each axis.
fn body(moments: [f64; 3]) -> Body<f64> {
    let [a, b, c] = moments;
    Body {
        inertia: [a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c],
        m: 1.0,
        s: [0.1, 0.2, 0.5],
        g: [0.0, 0.0, -9.81],
        r0: so3::exp([0.3, -1.1, 0.6]),
        w0: [1.0, -1.0, 1.0],
    }
}

const ASYMMETRIC: [f64; 3] = [1.0, 1.7, 2.4];
const SYMMETRIC: [f64; 3] = [1.0, 1.0, 0.5];

fn top(moments: [f64; 3]) -> Top<f64> {
    Top(body(moments))
}

/// Step length of the hand-written tops, and of the benchmark.
const STEP: f64 = 5e-3;
const BENCHMARK_STEP: f64 = 5e-4;

fn none<X, V>(_: f64, _: &X, _: &V) -> [f64; 0] {
    []
}

/// Times the steps of a run.
fn steps<Sys: System<Inputs = [f64; 0]>>(
    bencher: Bencher,
    system: &Sys,
    start: &State<Sys>,
    step: f64,
    method: impl Method<Sys>,
) {
    let until = step * STEPS as f64;
    bencher
        .counter(STEPS)
        .with_inputs(|| start.clone())
        .bench_local_values(|mut state| {
            let step = black_box(step);
            let run = hamel::integrate(system, &method, &mut state, step, until, none, |_| {});
            black_box(run.is_ok());
            state
        });
}

/// Times the work that every method of order 4 in the chart does four times a step.
fn least<Sys>(bencher: Bencher, system: &Sys, start: &State<Sys>, step: f64)
where
    Sys: System<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3], Inputs = [f64; 0]>,
{
    bencher
        .counter(STEPS)
        .with_inputs(|| start.clone())
        .bench_local_values(|mut state| {
            let step = black_box(0.25 * step);
            for _ in 0..4 * STEPS {
                if let Ok(rate) = system.forward_dynamics(&state.x, &state.xi, &[]) {
                    state.x = so3::retract(state.x, state.xi.map(|w| step * w));
                    state.xi = std::array::from_fn(|i| state.xi[i] + step * rate[i]);
                }
            }
            state
        });
}

macro_rules! benches {
    ($($name:ident: $system:expr, |$top:ident| $method:expr;)*) => {$(
        #[divan::bench(sample_count = SAMPLES)]
        fn $name(bencher: Bencher) {
            let system = $system;
            let $top = &system;
            let _ = $top;
            let method = $method;
            steps(bencher, &system, &State::start(&system), STEP, method);
        }
    )*};
}

macro_rules! benchmark {
    ($($name:ident: |$top:ident| $method:expr;)*) => {$(
        #[divan::bench(sample_count = SAMPLES)]
        fn $name(bencher: Bencher) {
            let case = benchmark_top();
            let $top = &case.system;
            let _ = $top;
            steps(bencher, &case.system, &case.start, BENCHMARK_STEP, $method);
        }
    )*};
}

benchmark! {
    benchmark_rkmk4: |top| Rkmk4;
    benchmark_cf4: |top| Cf4;
    benchmark_rkmk54: |top| Rkmk54;
    benchmark_rkmk8: |top| Rkmk8;
    benchmark_axes: |top| Splitting::with_flow(top, Scheme::Strang, Flow::Axes);
    benchmark_symmetric: |top| Splitting::new(top, Scheme::Strang);
    benchmark_nystrom6: |top| Splitting::new(top, Scheme::Nystrom6);
    benchmark_lgvi: |top| Lgvi;
    benchmark_gauss4: |top| Gauss4;
}

#[divan::bench(sample_count = SAMPLES)]
fn benchmark_four_accelerations_and_exponentials(bencher: Bencher) {
    let case = benchmark_top();
    least(bencher, &case.system, &case.start, BENCHMARK_STEP);
}

benches! {
    rkmk4: top(ASYMMETRIC), |top| Rkmk4;
    rkmk4_on_quaternions: QuaternionTop(body(ASYMMETRIC)), |top| Rkmk4;
    strang_by_axes: top(ASYMMETRIC), |top| Splitting::with_flow(top, Scheme::Strang, Flow::Axes);
    strang_by_pair: top(ASYMMETRIC), |top| Splitting::with_flow(top, Scheme::Strang, Flow::Pair);
    strang_by_jacobi: top(ASYMMETRIC), |top| Splitting::with_flow(top, Scheme::Strang, Flow::Exact);
    nystrom4_by_jacobi: top(ASYMMETRIC), |top| Splitting::new(top, Scheme::Nystrom4);
    nystrom6_by_jacobi: top(ASYMMETRIC), |top| Splitting::new(top, Scheme::Nystrom6);
    strang_symmetric: top(SYMMETRIC), |top| Splitting::new(top, Scheme::Strang);
    strang_symmetric_quaternion: QuaternionTop(body(SYMMETRIC)),
        |top| Splitting::new(top, Scheme::Strang);
    suzuki4_symmetric: top(SYMMETRIC), |top| Splitting::new(top, Scheme::Suzuki4);
    kahan_li6_symmetric: top(SYMMETRIC), |top| Splitting::new(top, Scheme::KahanLi6);
    nystrom4_symmetric: top(SYMMETRIC), |top| Splitting::new(top, Scheme::Nystrom4);
    nystrom6_symmetric: top(SYMMETRIC), |top| Splitting::new(top, Scheme::Nystrom6);
    lgvi: top(ASYMMETRIC), |top| Lgvi;
    gauss4: top(ASYMMETRIC), |top| Gauss4;
    gauss6: top(ASYMMETRIC), |top| Gauss6;
    slide: top(ASYMMETRIC), |top| Slide;
    buss_augmented: top(ASYMMETRIC), |top| Buss::AugmentedSecond;
    buss4: top(ASYMMETRIC), |top| Buss::Fourth;
    free_one_step: Spin(top(ASYMMETRIC)), |top| Free;
}

/// Evaluates the closed form over 100 s.
#[divan::bench(sample_count = SAMPLES)]
fn free_at_100(bencher: Bencher) {
    let spin = Spin(top(ASYMMETRIC));
    let start = State::start(&spin);
    bencher.bench_local(|| hamel::methods::free::at(&spin, black_box(&start), 100.0).is_ok());
}

/// Times whole runs with a final error of R below 1e-9; the runtime's tests of bodies assert the errors.
fn to_nine_digits(bencher: Bencher, case: &str, until: f64, n: u32) {
    let top = Top(Reference::read(case).body());
    let method = Splitting::new(&top, Scheme::Nystrom6);
    let h = until / f64::from(n);
    bencher.bench_local(|| {
        let mut state = State::start(&top);
        let h = black_box(h);
        let outcome = hamel::integrate(&top, method, &mut state, h, until, none, |_| {});
        black_box(outcome.is_ok());
        state
    });
}

/// Takes 199 evaluations of the torque.
#[divan::bench(sample_count = SAMPLES)]
fn heavy_top_benchmark_to_1e_9(bencher: Bencher) {
    to_nine_digits(bencher, "heavy-top-benchmark-150", 1.0, 18);
}

/// Takes 1541 evaluations.
#[divan::bench(sample_count = SAMPLES)]
fn fast_top_to_1e_9(bencher: Bencher) {
    to_nine_digits(bencher, "lagrange-fast-top", 5.0, 140);
}

/// Takes 1321 evaluations.
#[divan::bench(sample_count = SAMPLES)]
fn kovalevskaya_top_to_1e_9(bencher: Bencher) {
    to_nine_digits(bencher, "kovalevskaya-top", 20.0, 120);
}

#[divan::bench(sample_count = SAMPLES)]
fn four_accelerations_and_exponentials(bencher: Bencher) {
    let top = top(ASYMMETRIC);
    least(bencher, &top, &State::start(&top), STEP);
}
