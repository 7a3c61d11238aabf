//! A quarter of a million steps, or a million with `HAMEL_ATTACK`: energy, momentum and orthonormality do not drift.
//!
//! The bounds come from measurements of independent prototypes, with some margin.

#[path = "../../../codegen/tests/suite/common/size.rs"]
mod size;

use hamel::flows::Flow;
use hamel::methods::{Gauss4, Gauss6, Lgvi, Rkmk4, Scheme, Splitting};
use hamel::{Energies, Method, State, so3};
use hamel_cases::by_hand::{Body, QuaternionTop, Reference, Spin, Top};
use size::size;

/// Returns the number of steps of a run.
fn steps() -> u32 {
    size(250_000, 1_000_000) as u32
}

/// Bound of the largest energy error of the last quarter relative to that of the first.
const MAX_GROWTH: f64 = 1.05;
/// Smaller energy errors are rounding, which may grow: a random walk of a million steps of ten operations each.
const ENERGY_ROUNDING: f64 = 1e-11;
/// Bound of the relative error of the vertical or total momentum.
const MOMENTUM_TOLERANCE: f64 = 1e-10;
/// Bound of |RᵀR − I| after every step.
const ORTHONORMALITY_TOLERANCE: f64 = 1e-14;

/// Bound of the largest energy error relative to that of the prototypes, which are known to two digits.
const PROTOTYPE_MARGIN: f64 = 1.1;

/// The errors of a run. Energies are relative to T₀ + m |g| |s|, an upper bound of a top's kinetic and potential
/// energies at its start.
#[derive(Debug)]
struct Drift {
    /// Largest energy error in each quarter of the run.
    energy: [f64; 4],
    momentum: f64,
    orthonormality: f64,
}

/// The quantities that differ between bodies.
trait WatchedBody: Energies<Scalar = f64> {
    fn body(&self) -> &Body<f64>;
    fn rotation(x: &Self::Coordinates) -> so3::Matrix<f64>;
    fn velocity(xi: &Self::Velocities) -> so3::Vector<f64>;
}

impl WatchedBody for Top<f64> {
    fn body(&self) -> &Body<f64> {
        &self.0
    }
    fn rotation(x: &[f64; 9]) -> so3::Matrix<f64> {
        *x
    }
    fn velocity(xi: &[f64; 3]) -> so3::Vector<f64> {
        *xi
    }
}

impl WatchedBody for Spin<Top<f64>> {
    fn body(&self) -> &Body<f64> {
        &self.0.0
    }
    fn rotation(x: &[f64; 9]) -> so3::Matrix<f64> {
        *x
    }
    fn velocity(xi: &[f64; 3]) -> so3::Vector<f64> {
        *xi
    }
}

impl WatchedBody for QuaternionTop<f64> {
    fn body(&self) -> &Body<f64> {
        &self.0
    }
    fn rotation(x: &[f64; 4]) -> so3::Matrix<f64> {
        hamel::s3::to_matrix(*x)
    }
    fn velocity(xi: &[f64; 3]) -> so3::Vector<f64> {
        *xi
    }
}

fn run<Sys: WatchedBody, M: Method<Sys>>(system: &Sys, method: M, h: f64, steps: u32) -> Drift {
    let body = system.body();
    let energy = |state: &State<Sys>| {
        let kinetic = system.kinetic_energy(&state.x, &state.xi);
        (kinetic + system.potential_energy(&state.x), kinetic)
    };
    let momentum = |state: &State<Sys>| {
        so3::apply(
            Sys::rotation(&state.x),
            body.momentum(Sys::velocity(&state.xi)),
        )
    };
    let mut state = State::start(system);
    let ((e0, t0), l0) = (energy(&state), momentum(&state));
    let size = |v: so3::Vector<f64>| so3::dot(v, v).sqrt();
    let scale = t0 + body.m * size(body.g) * size(body.s);
    let length = size(l0);
    let heavy = body.m > 0.0;
    let none = |_, _: &_, _: &_| system.zero_inputs();
    let mut drift = Drift {
        energy: [0.0; 4],
        momentum: 0.0,
        orthonormality: 0.0,
    };
    for index in 0..steps {
        hamel::step(system, &method, &mut state, h, &none).expect("a step");
        let quarter = (4 * u64::from(index) / u64::from(steps)) as usize;
        let error = (energy(&state).0 - e0).abs() / scale;
        drift.energy[quarter] = drift.energy[quarter].max(error);
        let l = momentum(&state);
        let error = if heavy {
            (l[2] - l0[2]).abs()
        } else {
            (so3::dot(l, l).sqrt() - length).abs()
        };
        drift.momentum = drift.momentum.max(error / length);
        let defect = system.constraint_norm(&state.x);
        drift.orthonormality = drift.orthonormality.max(defect);
    }
    assert!(state.is_finite());
    drift
}

/// Asserts that the energy error does not grow, and that it is close to the expected one, if given.
fn assert_steady(what: &str, drift: &Drift, expected: Option<f64>) {
    println!("{what}: {drift:?}");
    let [first, .., last] = drift.energy;
    assert!(
        last <= (MAX_GROWTH * first).max(ENERGY_ROUNDING),
        "{what}: {drift:?}"
    );
    assert!(drift.momentum <= MOMENTUM_TOLERANCE, "{what}: {drift:?}");
    assert!(
        drift.orthonormality <= ORTHONORMALITY_TOLERANCE,
        "{what}: {drift:?}"
    );
    if let Some(expected) = expected {
        let largest = first.max(last);
        assert!(
            (0.9..PROTOTYPE_MARGIN).contains(&(largest / expected)),
            "{what}: {largest:e}"
        );
    }
}

fn top(case: &str) -> Top<f64> {
    Top(Reference::read(case).body())
}

const BC: &str = "heavy-top-benchmark-150";
const KOV: &str = "kovalevskaya-top";
const DZ: &str = "free-dzhanibekov-1e-3";

#[test]
fn splitting_by_the_exact_flow() {
    for (case, h, expected) in [(BC, 5e-4, 3.7e-8), (KOV, 0.02, 8.4e-5)] {
        let top = top(case);
        let method = Splitting::with_flow(&top, Scheme::Strang, Flow::Exact);
        assert_steady(case, &run(&top, method, h, steps()), Some(expected));
    }
    let spin = Spin(top(DZ));
    let method = Splitting::with_flow(&spin, Scheme::Strang, Flow::Exact);
    // Rounding errors, amplified at every flip.
    let drift = run(&spin, method, 0.1, steps());
    println!("{drift:?}");
    assert!(drift.energy.iter().all(|error| *error < 1e-10), "{drift:?}");
    assert!(
        drift.momentum <= MOMENTUM_TOLERANCE && drift.orthonormality <= ORTHONORMALITY_TOLERANCE,
        "{drift:?}"
    );
}

#[test]
fn splitting_by_turns_about_axes() {
    for (case, h) in [(BC, 5e-4), (KOV, 0.02)] {
        let top = top(case);
        for scheme in [Scheme::Strang, Scheme::Suzuki4] {
            let method = Splitting::with_flow(&top, scheme, Flow::Axes);
            let steps = steps() / scheme.drifts() as u32;
            assert_steady(case, &run(&top, method, h, steps), None);
        }
    }
    let spin = Spin(top(DZ));
    let method = Splitting::new(&spin, Scheme::Strang);
    assert_steady(DZ, &run(&spin, method, 0.1, steps()), None);
}

#[test]
fn splitting_by_quaternions() {
    let top = QuaternionTop(Reference::read(KOV).body());
    let method = Splitting::new(&top, Scheme::Strang);
    assert_steady(KOV, &run(&top, method, 0.02, steps()), Some(8.4e-5));
}

#[test]
fn steps_of_six_radians() {
    // |ω| = 150 rad/s.
    let top = top(BC);
    for (scheme, expected) in [(Scheme::Nystrom4, 4.5e-10), (Scheme::Suzuki4, 1.7e-7)] {
        let drift = run(&top, Splitting::new(&top, scheme), 0.04, steps());
        assert_steady("6 rad", &drift, Some(expected));
    }
}

#[test]
fn the_variational_integrator() {
    for (case, h, expected) in [(BC, 5e-4, 1.2e-6), (KOV, 0.02, 2.6e-4)] {
        assert_steady(case, &run(&top(case), Lgvi, h, steps()), Some(expected));
    }
    assert_steady(DZ, &run(&Spin(top(DZ)), Lgvi, 0.1, steps()), None);
}

#[test]
fn collocation() {
    // p is not R P: Gauss methods conserve quadratic invariants exactly, but the vertical momentum is not quadratic in
    // it.
    for (case, h, steps, momentum) in [(BC, 5e-4, 200_000, 1e-6), (KOV, 0.02, steps(), 4e-9)] {
        let drift = run(&top(case), Gauss4, h, steps);
        let [first, .., last] = drift.energy;
        assert!(
            last <= MAX_GROWTH * first && first < 1.2e-9,
            "{case}: {drift:?}"
        );
        assert!(drift.momentum < momentum, "{case}: {drift:?}");
        assert!(
            drift.orthonormality <= ORTHONORMALITY_TOLERANCE,
            "{case}: {drift:?}"
        );
        assert_steady(case, &run(&top(case), Gauss6, h, steps), None);
    }
}

#[test]
fn a_method_that_is_not_symplectic_drifts() {
    let drift = run(&top(BC), Rkmk4, 5e-4, 100_000);
    assert!(drift.energy[3] > 2.0 * drift.energy[0], "{drift:?}");
}
