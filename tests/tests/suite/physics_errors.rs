//! Singular mass, by parameters or by configuration, is a typed error and never gives NaN.

use hamel::methods::Rkmk4;
use hamel::{Singular, State, StepError, integrate};
use hamel_tests::cart_pole::{CartPole, CartPoleParameters};
use hamel_tests::free_body::{FreeBody, FreeBodyParameters};
use hamel_tests::heavy_top::{HeavyTop, HeavyTopParameters};
use hamel_tests::hoop_bead::{HoopBead, HoopBeadParameters};
use hamel_tests::principal_axes::{PrincipalAxes, PrincipalAxesParameters};
use hamel_tests::two_bodies::TwoBodies;

/// Numbers that are neither a mass nor a moment of inertia.
const INVALID_NUMBERS: [f64; 5] = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn a_refused_mass_leaves_everything_unchanged() {
    let mut system: FreeBody<f64> = FreeBody::default();
    let mut state = State::start(&system);
    state.xi = [0.3, -0.2, 0.5, 1.0, -2.0, 0.7];
    let inputs = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3];
    let before = system.accel(&state.x, &state.xi, &inputs);
    assert!(before.is_ok());
    for refused in INVALID_NUMBERS {
        assert_eq!(
            system.set_m(refused),
            Err(Singular::Inertia { velocity: "v[1]" }),
            "{refused}"
        );
        assert_eq!(system.m(), 1.3);
        // Bit by bit: the constants derived from the parameters are unchanged, too.
        assert_eq!(system.accel(&state.x, &state.xi, &inputs), before);
    }
    system.set_m(1.4).expect("a mass");
    assert_eq!(system.m(), 1.4);
    assert_ne!(system.accel(&state.x, &state.xi, &inputs), before);
}

#[test]
fn a_refused_inertia_names_its_velocity() {
    for (place, (axis, velocity)) in [("J1", "w[1]"), ("J2", "w[2]"), ("J3", "w[3]")]
        .into_iter()
        .enumerate()
    {
        for refused in INVALID_NUMBERS {
            let mut j = [1.0, 2.0, 3.0];
            j[place] = refused;
            let result = PrincipalAxes::new(PrincipalAxesParameters {
                j1: j[0],
                j2: j[1],
                j3: j[2],
            });
            assert_eq!(
                result.err(),
                Some(Singular::Inertia { velocity }),
                "{axis} = {refused}"
            );
        }
    }
    let mut system: PrincipalAxes<f32> = PrincipalAxes::default();
    let refused = Err(Singular::Inertia { velocity: "w[2]" });
    assert_eq!(system.set_j2(-1.0), refused);
    assert_eq!(system.j2(), 2.0);
}

/// An inertia about the origin that leaves nothing about the centre of mass belongs to no body, even with a positive
/// diagonal.
#[test]
fn an_inertia_smaller_than_its_offset_is_refused() {
    let mut system: FreeBody<f64> = FreeBody::default();
    let kept = system.theta();
    let m_s_s = 1.3 * (0.1 * 0.1 + 0.3 * 0.3);
    let mut theta = kept;
    theta[1] = [0.0, 0.99 * m_s_s, 0.0];
    theta[0][1] = 0.0;
    let refused = system.set_theta(theta);
    assert!(
        matches!(
            refused,
            Err(Singular::Inertia {
                velocity: "w[1]" | "w[2]" | "w[3]"
            })
        ),
        "{refused:?}"
    );
    assert_eq!(system.theta(), kept);

    let refused = system.set_s([0.0, 0.0, 2.0]);
    assert!(
        matches!(
            refused,
            Err(Singular::Inertia {
                velocity: "w[1]" | "w[2]" | "w[3]"
            })
        ),
        "{refused:?}"
    );
    assert_eq!(system.s(), [0.1, -0.2, 0.3]);
}

#[test]
fn an_indefinite_inertia_with_a_positive_diagonal_is_refused() {
    let mut system: HeavyTop<f64> = HeavyTop::default();
    let kept = system.theta();
    let indefinite = [[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(
        system.set_theta(indefinite),
        Err(Singular::Inertia { velocity: "w[2]" })
    );
    assert_eq!(system.theta(), kept);
    assert!(
        HeavyTop::new(HeavyTopParameters {
            m: 1.0,
            g: 9.81,
            s: [0.0; 3],
            theta: indefinite
        })
        .is_err()
    );
}

/// Without a separate inertia, the hoop has none while the bead is on its axis.
#[test]
fn a_mass_matrix_singular_in_places_is_an_error_there() {
    let system = HoopBead::new(HoopBeadParameters {
        m: 0.2,
        a: 0.4,
        j: 0.0,
        g: 9.81,
    })
    .expect("regular elsewhere");
    let xi = [3.0, 1.0];
    let on_axis = [1.0, 0.0, 1.0, 0.0];
    let beside = [1.0, 0.0, 0.6, 0.8];
    let singular = Singular::Inertia { velocity: "W" };
    assert_eq!(system.accel(&on_axis, &xi, &[0.5]), Err(singular));
    let regular = system.accel(&beside, &xi, &[0.5]).expect("M is regular");
    assert!(regular.into_iter().all(f64::is_finite));

    // A run ends there with the time, and keeps its last valid state.
    let mut state = State {
        t: 2.0,
        x: on_axis,
        xi,
    };
    let step = hamel::step(&system, Rkmk4, &mut state, 0.1, &|_, _, _| [0.0]);
    assert_eq!(
        step,
        Err(StepError::Singular {
            cause: singular,
            time: 2.0
        })
    );
    assert_eq!((state.t, state.x, state.xi), (2.0, on_axis, xi));
}

#[test]
fn a_cart_without_mass_is_an_error_where_the_pole_stands() {
    // M is regular while the pole is inclined: with m_c = 0 it is singular at θ = 0.
    match CartPole::new(CartPoleParameters {
        mc: 0.0,
        mp: 0.3,
        l: 0.5,
        g: 9.81,
    }) {
        Err(singular) => assert!(matches!(singular, Singular::Inertia { .. })),
        Ok(system) => {
            let accel = system.accel(&[0.0, 0.0], &[0.0, 1.0], &[1.0]);
            assert!(accel.is_err(), "{accel:?}");
            let accel = system.accel(&[0.0, 0.5], &[0.0, 1.0], &[1.0]);
            assert!(accel.is_ok_and(|a| a.into_iter().all(f64::is_finite)));
        }
    }
}

/// A body of points on a line through the joint has no inertia about the line.
#[test]
fn a_chain_with_a_thin_rod_is_an_error() {
    let default: TwoBodies<f64> = TwoBodies::default();
    let mut system = default.clone();
    let rod = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
    let state = State::start(&default);
    // Refused at once or, if the generator's pivots depend on x, at the state.
    match system.set_theta2(rod) {
        Err(_) => assert_eq!(system.theta2(), default.theta2()),
        Ok(()) => assert!(system.accel(&state.x, &state.xi, &[]).is_err()),
    }
}

#[test]
fn states_that_are_not_numbers_are_errors() {
    let system: HeavyTop<f64> = HeavyTop::default();
    let mut state = State::start(&system);
    state.xi[1] = f64::NAN;
    let run = integrate(&system, Rkmk4, &mut state, 1e-3, 1.0, |_, _, _| [], |_| {});
    assert_eq!(run, Err(StepError::NonFinite { time: 0.0 }));

    let hoop: HoopBead<f64> = HoopBead::default();
    let accel = hoop.accel(&[1.0, 0.0, f64::NAN, f64::NAN], &[1.0; 2], &[0.0]);
    assert_eq!(accel, Err(Singular::Inertia { velocity: "W" }));
}

/// Setters update the constants derived from parameters: the system equals the one made by `new`.
#[test]
fn setters_keep_the_constants_in_step() {
    let theta = [[3.0, 0.2, -0.1], [0.2, 2.5, 0.3], [-0.1, 0.3, 2.2]];
    let fresh = FreeBody::new(FreeBodyParameters {
        m: 1.7,
        g: 3.7,
        s: [0.2, 0.1, -0.3],
        theta,
    })
    .expect("a body");
    let mut set: FreeBody<f64> = FreeBody::default();
    set.set_theta(theta).expect("an inertia");
    set.set_g(3.7).expect("gravity");
    set.set_m(1.7).expect("a mass");
    set.set_s([0.2, 0.1, -0.3]).expect("a centre of mass");
    let x = State::start(&fresh).x;
    let (xi, u) = ([0.3, -0.2, 0.5, 1.0, -2.0, 0.7], [1.0; 6]);
    assert_eq!(set.accel(&x, &xi, &u), fresh.accel(&x, &xi, &u));
    assert_eq!(set.bias(&x, &xi), fresh.bias(&x, &xi));
    assert_eq!(set.potential_force(&x), fresh.potential_force(&x));
    assert_eq!(set.energy(&x, &xi), fresh.energy(&x, &xi));
}

/// Symmetric parameters are read from the upper triangle, and returned symmetric.
#[test]
fn symmetric_parameters_stay_symmetric() {
    let mut system: HeavyTop<f64> = HeavyTop::default();
    let upper = [[2.0, 0.1, 0.2], [9.0, 2.0, 0.3], [9.0, 9.0, 2.0]];
    system.set_theta(upper).expect("an inertia");
    let whole = [[2.0, 0.1, 0.2], [0.1, 2.0, 0.3], [0.2, 0.3, 2.0]];
    assert_eq!(system.theta(), whole);
    let made = HeavyTop::new(HeavyTopParameters {
        m: 1.0,
        g: 9.81,
        s: [0.0; 3],
        theta: upper,
    })
    .expect("a top");
    assert_eq!(made.theta(), whole);
}
