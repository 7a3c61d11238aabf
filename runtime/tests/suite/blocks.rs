//! Bodies with other coordinates than rotations, and inputs that depend on time.

use crate::common::{FreeBody, Pendulum, Reference, distance, slopes};
use hamel::methods::{Gauss4, Gauss6, Lgvi, Rkmk4, Scheme, Splitting};
use hamel::{Energies, Method, State, StepError, System, integrate};

fn pendulum() -> Pendulum {
    Pendulum {
        g: 9.81,
        l: 0.5,
        theta0: 2.0,
        rate0: 1.0,
    }
}

/// Where the pendulum is at t = 2 s under a torque sin 3t.
fn swung<M: Method<Pendulum>>(method: M, n: u32) -> Vec<f64> {
    let system = pendulum();
    let mut state = State::start(&system);
    let torque = |t: f64, _: &_, _: &_| vec![(3.0 * t).sin()];
    let h = 2.0 / f64::from(n);
    integrate(&system, method, &mut state, h, 2.0, torque, |_| {}).expect("a run");
    assert!(system.constraint_norm(&state.x) < 1e-15);
    state.x.iter().chain(&state.xi).copied().collect()
}

fn gap(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn circles_with_a_torque_of_time() {
    let system = pendulum();
    let fine = swung(Gauss6, 1000);
    for (what, order, coarsest, run) in [
        (
            "Strang",
            2.0,
            200,
            &(|n| swung(Splitting::new(&system, Scheme::Strang), n)) as &dyn Fn(u32) -> Vec<f64>,
        ),
        ("LGVI", 2.0, 200, &|n| swung(Lgvi, n)),
        ("Suzuki", 4.0, 50, &|n| {
            swung(Splitting::new(&system, Scheme::Suzuki4), n)
        }),
        ("Nystrom 4", 4.0, 20, &|n| {
            swung(Splitting::new(&system, Scheme::Nystrom4), n)
        }),
        ("Nystrom 6", 6.0, 20, &|n| {
            swung(Splitting::new(&system, Scheme::Nystrom6), n)
        }),
        ("Kahan-Li", 6.0, 40, &|n| {
            swung(Splitting::new(&system, Scheme::KahanLi6), n)
        }),
        ("Kahan-Li 8", 8.0, 16, &|n| {
            swung(Splitting::new(&system, Scheme::KahanLi8), n)
        }),
        ("Gauss 4", 4.0, 100, &|n| swung(Gauss4, n)),
    ] {
        let errors = [1, 2, 4].map(|f| gap(&run(f * coarsest), &fine));
        println!("{what} {errors:?} {:?}", slopes(&errors));
        // The starts of the slopes are coarse.
        let last = slopes(&errors)[1];
        assert!((last - order).abs() < 0.15, "{what}: {errors:?} {last}");
    }
}

/// The offset free body under a body wrench that depends on time.
fn flown<M: Method<FreeBody>>(method: impl Fn(&FreeBody) -> M, n: u32) -> State<FreeBody> {
    let mut system = Reference::read("free-body-offset-gravity").free_body();
    system.r0 = [0.0; 3];
    let mut state = State::start(&system);
    let wrench = |t: f64, _: &_, _: &_| {
        let (s, c) = (2.0 * t).sin_cos();
        [s, 0.5, -c, 0.3 * c, 0.2 * s, -0.1]
    };
    let h = 2.0 / f64::from(n);
    integrate(&system, method(&system), &mut state, h, 2.0, wrench, |_| {}).expect("a run");
    state
}

#[test]
fn an_offset_body_under_a_wrench_of_time() {
    let fine = flown(|body| Splitting::new(body, Scheme::Nystrom6), 800);
    // Another method on the other form of the equations.
    let other = flown(|_| Rkmk4, 4000);
    assert!(
        distance(fine.x, other.x) < 1e-9,
        "{:e}",
        distance(fine.x, other.x)
    );
    assert!(distance(fine.xi, other.xi) < 1e-8);
    for (scheme, coarsest) in [
        (Scheme::Strang, 50),
        (Scheme::Nystrom4, 20),
        (Scheme::Nystrom6, 10),
    ] {
        let errors = [1, 2, 4].map(|f| {
            distance(
                flown(|body| Splitting::new(body, scheme), f * coarsest).x,
                fine.x,
            )
        });
        println!("{scheme:?} {errors:?} {:?}", slopes(&errors));
        let last = slopes(&errors)[1];
        assert!(
            (last - f64::from(scheme.order())).abs() < 0.2,
            "{scheme:?} {errors:?}"
        );
    }
    for (order, coarsest, run) in [
        (
            4.0,
            100,
            &(|n| flown(|_| Gauss4, n)) as &dyn Fn(u32) -> State<FreeBody>,
        ),
        (6.0, 25, &|n| flown(|_| Gauss6, n)),
    ] {
        let errors = [1, 2, 4].map(|f| distance(run(f * coarsest).x, fine.x));
        println!("Gauss {order} {errors:?} {:?}", slopes(&errors));
        let last = slopes(&errors)[1];
        assert!((last - order).abs() < 0.1, "Gauss {order} {errors:?}");
    }
}

#[test]
fn a_singular_inertia_is_an_error() {
    let mut system = pendulum();
    system.l = 0.0;
    let mut state = State::start(&system);
    let step = hamel::step(&system, Gauss4, &mut state, 0.1, &|_, _, _| vec![0.0]);
    assert!(
        matches!(step, Err(StepError::Singular { time: 0.0, .. })),
        "{step:?}"
    );
}

#[test]
fn collocation_starts_at_rest() {
    let mut system = pendulum();
    system.rate0 = 0.0;
    let mut state = State::start(&system);
    for _ in 0..100 {
        hamel::step(&system, Gauss6, &mut state, 0.01, &|_, _, _| vec![0.0]).expect("a step");
    }
    let energy =
        |x: &Vec<f64>, xi: &Vec<f64>| system.kinetic_energy(x, xi) + system.potential_energy(x);
    let (x, xi) = system.start();
    assert!((energy(&state.x, &state.xi) - energy(&x, &xi)).abs() < 1e-8);
}
