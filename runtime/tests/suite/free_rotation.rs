//! The closed form of torque-free rotation against reference solutions, and where it degenerates.

use crate::common::{Body, QuaternionTop, Reference, Spin, Top, distance};
use crate::size::size;
use hamel::methods::{Free, free};
use hamel::rotor::Symmetry;
use hamel::{Energies, Rotor, State, StepError, System, flows, s3, so3};

/// ω over the largest of one and |ω₀|, at the last sample: rounding of the phase and of the period.
const VELOCITY: f64 = 1e-13;
/// R (Frobenius) at the last sample: rounding of some hundred radians about the angular momentum.
const ROTATION: f64 = 1e-11;
/// Time between flips, relative.
const PERIOD: f64 = 1e-13;

const CASES: [(&str, f64); 5] = [
    ("free-dzhanibekov-1e-3", 100.0),
    ("free-dzhanibekov-1e-8", 300.0),
    ("free-elongated-1000", 5.0),
    ("free-fast-spin-1000", 0.5),
    ("free-near-symmetric", 100.0),
];

#[test]
fn closed_form_at_the_last_sample() -> Result<(), StepError> {
    for (case, t) in CASES {
        let reference = Reference::read(case);
        let (r, w): ([f64; 9], [f64; 3]) = (reference.sample(t, "R"), reference.sample(t, "omega"));
        let body = reference.body();
        let scale = so3::dot(body.w0, body.w0).sqrt().max(1.0);

        let top = Spin(Top(body.clone()));
        let end = free::at(&top, &State::start(&top), t)?;
        let errors = (distance(end.xi, w) / scale, distance(end.x, r));
        println!("{case}: {errors:?}");
        assert_eq!(end.t, t);
        assert!(errors.0 <= VELOCITY && errors.1 <= ROTATION, "{case}");
        assert!(top.constraint_norm(&end.x) <= 1e-14, "{case}");

        let top = Spin(QuaternionTop(body));
        let end = free::at(&top, &State::start(&top), t)?;
        let error = distance(s3::to_matrix(end.x), r);
        assert!(error <= ROTATION, "{case}: {error:e}");
    }
    Ok(())
}

#[test]
fn flips_come_at_the_known_period() {
    for case in CASES.map(|(case, _)| case) {
        let reference = Reference::read(case);
        let body = reference.body();
        let rotor = Rotor::general(body.inertia);
        let period = flows::half_period(rotor.moments, body.momentum(body.w0));
        let [expected] = reference.extra("half_period_between_flips");
        println!("{case}: {:e}", period / expected - 1.0);
        assert!((period / expected - 1.0).abs() <= PERIOD, "{case}");
    }
}

fn spin(moments: [f64; 3], w0: [f64; 3]) -> Spin<Top<f64>> {
    let [a, b, c] = moments;
    Spin(Top(Body {
        inertia: [a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c],
        m: 0.0,
        s: [0.0; 3],
        g: [0.0; 3],
        r0: so3::exp([0.3, -1.1, 0.6]),
        w0,
    }))
}

/// Laws of free motion: R P and the energy constant, R a rotation, there and back again the start,
/// t₁ + t₂ like one after the other.
fn keeps_its_laws(top: &Spin<Top<f64>>, t: f64) -> Result<(), StepError> {
    let start = State::start(top);
    let end = free::at(top, &start, t)?;
    let momentum = |state: &State<_>| so3::apply(state.x, top.0.0.momentum(state.xi));
    let scale = so3::dot(momentum(&start), momentum(&start)).sqrt();
    let drift = distance(momentum(&end), momentum(&start));
    assert!(
        drift <= 1e-14 * scale,
        "{top:?} {t}: {drift:e} of {scale:e}"
    );
    let energy = |state: &State<_>| top.kinetic_energy(&state.x, &state.xi);
    let drift = (energy(&end) - energy(&start)).abs();
    assert!(
        drift <= 2e-15 * energy(&start),
        "{top:?} {t}: energy {drift:e}"
    );
    assert!(top.constraint_norm(&end.x) <= 2e-15);

    let back = free::at(top, &end, start.t)?;
    let via = free::at(top, &free::at(top, &start, 0.3 * t)?, t)?;
    // The phase about R P is known to rounding of its size; on the way it may be magnified.
    let rate = so3::dot(top.0.0.w0, top.0.0.w0).sqrt();
    let phase = 4e-15 * (1.0 + rate * t.abs());
    assert!(
        distance(back.x, start.x) <= phase,
        "{top:?} {t}: {:e}",
        distance(back.x, start.x)
    );
    assert!(
        distance(via.x, end.x) <= phase,
        "{top:?} {t}: {:e}",
        distance(via.x, end.x)
    );
    Ok(())
}

#[test]
fn laws_hold_for_every_symmetry_and_time() -> Result<(), StepError> {
    let close = 1.0 + 1e-9;
    for moments in [
        [1.0, 2.0, 2.9],
        [2.9, 2.0, 1.0],
        [2.0, 1.0, 2.9],
        [1.0, 1.0, 1.0],
        [1.0, 1.0, 1.7],
        [1.0, 1.7, 1.0],
        [0.4, 1.0, 1.0],
        [1.0, close, 1.7],
        [1.0, 1.7, close],
        [0.4, 1.0, close],
        [1.0, close, close],
        [1e-6, 2e-6, 2.5e-6],
    ] {
        for w in [
            [0.4, -0.7, 1.1],
            [-2.0, 0.3, -0.2],
            [0.1, 0.2, -3.0],
            [0.0, 0.0, 2.0],
            [-2.0, 0.0, 0.0],
        ] {
            for t in [0.0, 1e-9, 0.01, 0.09, 0.3, 1.0, -2.5, 7.0, 30.0] {
                keeps_its_laws(&spin(moments, w), t)?;
            }
        }
    }
    Ok(())
}

#[test]
fn a_steady_turn_stays_steady() -> Result<(), StepError> {
    // About each principal axis, the unstable one included, and at rest.
    for moments in [[1.0, 2.0, 2.9], [1.0, 1.0, 1.7], [1.0, 1.0, 1.0]] {
        for axis in [0, 1, 2] {
            for rate in [3.0, -3.0, 1e-160, 0.0] {
                let mut w = [0.0; 3];
                w[axis] = rate;
                let top = spin(moments, w);
                for t in [0.3, 1000.0] {
                    let end = free::at(&top, &State::start(&top), t)?;
                    assert!(distance(end.xi, w) <= 1e-15 * rate.abs(), "{end:?}");
                    let r = so3::retract(top.0.0.r0, w.map(|w| w * t));
                    assert!(
                        distance(end.x, r) <= 1e-15 * (2.0 + rate.abs() * t),
                        "{end:?}"
                    );
                }
            }
        }
    }
    Ok(())
}

#[test]
fn on_the_separatrix_the_body_comes_to_turn_about_its_middle_axis() -> Result<(), StepError> {
    // r p₃² = q p₁² for J = (1, 2, 4): r = 1/3, q = 2/3; p = (1, p₂, √2), exact to rounding only.
    let top = spin([1.0, 2.0, 4.0], [1.0, 0.5, 2.0_f64.sqrt() / 4.0]);
    let start = State::start(&top);
    for t in [1.0, 10.0, 15.0] {
        let end = free::at(&top, &start, t)?;
        assert!(end.is_finite());
        let energy = top.kinetic_energy(&end.x, &end.xi) / top.kinetic_energy(&start.x, &start.xi);
        assert!((energy - 1.0).abs() < 1e-14);
    }
    let end = free::at(&top, &start, 15.0)?;
    // Of the deviation from the middle axis e^(−λ t) is left, λ = 0.72/s.
    assert!(end.xi[0].abs() < 1e-3 && end.xi[2].abs() < 1e-3, "{end:?}");
    Ok(())
}

#[test]
fn forces_are_refused() {
    let top = Top(Reference::read("kovalevskaya-top").body());
    let refused = free::at(&top, &State::start(&top), 1.0);
    assert!(matches!(refused, Err(StepError::Forces { time: 0.0 })));
    let mut state = State::start(&top);
    let step = hamel::step(&top, Free, &mut state, 0.1, &|_, _, _| []);
    assert_eq!(step, Err(StepError::Forces { time: 0.0 }));
}

#[test]
fn principal_axes_of_a_full_inertia() {
    let moments = [0.3, 1.2, 1.4];
    for axes in [
        [0.0; 3],
        [0.3, -1.1, 0.6],
        [1e-9, 0.0, 0.0],
        [0.0, 0.0, 3.0],
    ]
    .map(so3::exp)
    {
        for moments in [moments, [1.0, 1.0, 1.7], [1.7, 1.0, 1.0], [1.0; 3]] {
            let scaled: [f64; 9] = std::array::from_fn(|k| axes[k] * moments[k % 3]);
            let transposed: [f64; 9] = std::array::from_fn(|k| axes[3 * (k % 3) + k / 3]);
            let inertia = so3::product(scaled, transposed);
            let rotor = Rotor::general(inertia);
            let found = rotor.axes.unwrap_or_else(so3::identity);
            let scaled: [f64; 9] = std::array::from_fn(|k| found[k] * rotor.moments[k % 3]);
            let transposed: [f64; 9] = std::array::from_fn(|k| found[3 * (k % 3) + k / 3]);
            assert!(distance(so3::product(scaled, transposed), inertia) < 4e-15);
            let turned = so3::cross(
                [found[0], found[3], found[6]],
                [found[1], found[4], found[7]],
            );
            assert!(distance(turned, [found[2], found[5], found[8]]) < 1e-15);
            let equal = moments.iter().filter(|m| **m == 1.0).count();
            let symmetry = match rotor.symmetry {
                Symmetry::Spherical => 3,
                Symmetry::Axial(axis) => {
                    assert!((rotor.moments[axis] - 1.7).abs() < 1e-14);
                    2
                }
                Symmetry::None => 0,
            };
            assert_eq!(symmetry, equal, "{rotor:?}");
        }
    }
}

/// R(1) for moments 1e-9, 1, 1.000000000999 and ω = (0.1, 1, 0), R(0) = I: a Taylor series with 40 digits.
const UNEQUAL: [f64; 9] = [
    0.5403023058715479,
    0.09861085763282458,
    0.8356729725357923,
    9.998096672964038e-11,
    0.9931096705876494,
    -0.11718866065149129,
    -0.8414709848057081,
    0.06331730365555048,
    0.5365794449919812,
];

#[test]
fn very_unequal_moments_keep_all_digits() -> Result<(), StepError> {
    let top = spin([1e-9, 1.0, 1.000000000999], [0.1, 1.0, 0.0]);
    let start = State::start(&top);
    let end = free::at(&top, &start, 1.0)?;
    let error = distance(end.x, so3::product(start.x, UNEQUAL));
    assert!(error < 1e-14, "{error:e}");
    Ok(())
}

/// Long times against many short ones, which are summed by Gauss points: momenta without a component
/// along one axis start where the angle is folded. Quaternions go on without a jump, so that −q in the place of
/// q is an error.
#[test]
fn long_times_are_many_short_ones_wherever_the_motion_starts() -> Result<(), StepError> {
    let mut state = 3u64;
    let mut number = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 31) as f64
    };
    for round in 0..size(60, 20_000) as usize {
        let spread = if round % 2 == 0 { 1.0 } else { 4.0 };
        let moments: [f64; 3] = std::array::from_fn(|_| 10f64.powf(spread * (number() - 0.5)));
        let mut w0: [f64; 3] = std::array::from_fn(|_| 2.0 * number() - 1.0);
        w0[round % 3] = 0.0;
        let rate = so3::dot(w0, w0).sqrt();
        let top = spin(moments, w0);
        // ω may grow by the ratio of the moments.
        let (least, most) = moments
            .iter()
            .fold((f64::MAX, 0.0f64), |(a, b), &m| (a.min(m), b.max(m)));
        let fastest = rate * most / least;
        let t = 10.0 * number() / rate;
        let start = State::start(&top);
        let end = free::at(&top, &start, t)?;
        let lifted = Spin(QuaternionTop(top.0.0.clone()));
        let mut quaternion = State::start(&lifted);
        let on_the_same_sheet = free::at(&lifted, &quaternion, t)?;
        let steps = (4.0 * fastest * t).ceil().max(1.0);
        let mut by_steps = start.clone();
        for step in 1..=steps as u64 {
            let time = t * (step as f64 / steps);
            by_steps = free::at(&top, &by_steps, time)?;
            let next = free::at(&lifted, &quaternion, time)?;
            let along: f64 = std::iter::zip(next.x, quaternion.x)
                .map(|(a, b)| a * b)
                .sum();
            assert!(
                along > 0.0,
                "q jumps to another sheet: {moments:?} {w0:?} {time}"
            );
            quaternion = next;
        }
        let error = distance(end.x, by_steps.x);
        let allowed = 1e-14 * (10.0 + steps) * (1.0 + fastest * t);
        assert!(
            error <= allowed.min(1e-3),
            "{moments:?} {w0:?} {t}: {error:e} of {allowed:e}"
        );
        let error = distance(on_the_same_sheet.x, quaternion.x);
        assert!(
            error <= allowed.min(1e-3),
            "{moments:?} {w0:?} {t}: q {error:e} of {allowed:e}"
        );
    }
    Ok(())
}
