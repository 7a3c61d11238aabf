//! Compares a light aircraft with a textbook: the Newton-Euler equations in Euler angles, the trim, and the linear
//! equations about it.
//!
//! R. C. Nelson, *Flight Stability and Automatic Control*, 2nd ed., McGraw-Hill 1998: the derivatives of chapter 3, the
//! longitudinal motion of chapter 4 and the lateral motion of chapter 5 with the modes of the Navion in their examples.

use hamel::State;
use hamel::methods::Rkmk4;
use hamel_tests::navion::{Navion, NavionParameters, NavionState};
use nalgebra::{DMatrix, Matrix3, Matrix4, Rotation3, SMatrix, SVector, Vector3};

const INERTIA: [f64; 3] = [1048.0, 3000.0, 3530.0];

/// [ẋ; ξ̇] by hand, of [r, φ, θ, ψ, v, ω] and [elevator, throttle, aileron, rudder].
fn by_hand(
    of: &NavionParameters<f64>,
    s: &SVector<f64, 12>,
    u: &SVector<f64, 4>,
) -> SVector<f64, 12> {
    let [phi, theta, psi] = [s[3], s[4], s[5]];
    let (v, w) = (
        Vector3::new(s[6], s[7], s[8]),
        Vector3::new(s[9], s[10], s[11]),
    );
    let hull = Rotation3::from_euler_angles(phi, theta, psi);
    let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), -of.trim_angle);
    let weight = (hull * tilt).inverse() * Vector3::new(0.0, 0.0, of.g);

    let speed = v.norm();
    let (alpha, beta) = (v.z.atan2(v.x), (v.y / speed).asin());
    let area = 0.5 * of.rho * speed * speed * of.s;
    let lift = area * (of.lift + of.lift_alpha * alpha + of.lift_elevator * u[0]);
    let drag = area * (of.drag + of.drag_alpha * alpha);
    // Drag is along the flow in the plane of symmetry, lift is perpendicular to it.
    let flow = Vector3::new(alpha.cos(), 0.0, alpha.sin());
    let up = Vector3::new(alpha.sin(), 0.0, -alpha.cos());
    let side = area * (of.side_beta * beta + of.side_rudder * u[3]);
    let force = lift * up - drag * flow + Vector3::new(u[1], side, 0.0);
    let v_dot = force / of.m + weight - w.cross(&v);

    let alpha_dot = (v.x * v_dot.z - v.z * v_dot.x) / (v.x * v.x + v.z * v.z);
    let hat = |length: f64, rate: f64| length * rate / (2.0 * speed);
    let (p, q, r) = (hat(of.b, w.x), hat(of.c, w.y), hat(of.b, w.z));
    let torque = area
        * Vector3::new(
            of.b * (of.roll_beta * beta
                + of.roll_p * p
                + of.roll_r * r
                + of.roll_aileron * u[2]
                + of.roll_rudder * u[3]),
            of.c * (of.pitch_alpha * alpha
                + of.pitch_alpha_dot * hat(of.c, alpha_dot)
                + of.pitch_q * q
                + of.pitch_elevator * u[0]),
            of.b * (of.yaw_beta * beta
                + of.yaw_p * p
                + of.yaw_r * r
                + of.yaw_aileron * u[2]
                + of.yaw_rudder * u[3]),
        );
    let j = Matrix3::from_diagonal(&Vector3::from(INERTIA));
    let w_dot = (torque - w.cross(&(j * w))).component_div(&Vector3::from(INERTIA));

    let r_dot = hull * tilt * v;
    let turn = tilt * w;
    let along = turn.y * phi.sin() + turn.z * phi.cos();
    let angles = Vector3::new(
        turn.x + along * theta.tan(),
        turn.y * phi.cos() - turn.z * phi.sin(),
        along / theta.cos(),
    );
    let mut rates = SVector::<f64, 12>::zeros();
    for (k, part) in [r_dot, angles, v_dot, w_dot].iter().enumerate() {
        rates.fixed_rows_mut::<3>(3 * k).copy_from(part);
    }
    rates
}

fn arrays(s: &SVector<f64, 12>) -> ([f64; 6], [f64; 6]) {
    let all: [f64; 12] = (*s).into();
    let (x, xi) = all.split_at(6);
    (
        x.try_into().expect("six coordinates"),
        xi.try_into().expect("six velocities"),
    )
}

/// Returns the generated [A B].
fn linear(
    aircraft: &Navion<f64>,
    s: &SVector<f64, 12>,
    u: &SVector<f64, 4>,
) -> SMatrix<f64, 12, 16> {
    let (x, xi) = arrays(s);
    let rows = aircraft.linearize(&x, &xi, &(*u).into()).expect("regular");
    SMatrix::from_fn(|i, j| rows[i][j])
}

fn rates(aircraft: &Navion<f64>, s: &SVector<f64, 12>, u: &SVector<f64, 4>) -> SVector<f64, 12> {
    let (x, xi) = arrays(s);
    let x_dot = aircraft.rate(&x, &xi);
    let xi_dot = aircraft.accel(&x, &xi, &(*u).into()).expect("regular");
    SVector::from_iterator(x_dot.into_iter().chain(xi_dot))
}

/// Finds level flight at a speed by Newton's method with the generated slopes: the angle of attack with the
/// corresponding pitch, elevator and throttle for which v₁, v₃ and ω₂ are constant.
fn trimmed(aircraft: &Navion<f64>, speed: f64) -> (SVector<f64, 12>, SVector<f64, 4>) {
    let mut alpha = 0.02_f64;
    let mut u = SVector::<f64, 4>::zeros();
    let tilt = aircraft.trim_angle();
    let at = |alpha: f64| {
        let state = NavionState {
            theta: tilt + alpha,
            v: [speed * alpha.cos(), 0.0, speed * alpha.sin()],
            w: [0.0; 3],
            r: [0.0, 0.0, -1000.0],
            phi: 0.0,
            psi: 0.3,
        };
        let (x, xi) = state.to_arrays();
        SVector::from_iterator(x.into_iter().chain(xi))
    };
    let mut steps = 0;
    loop {
        let s: SVector<f64, 12> = at(alpha);
        let off = rates(aircraft, &s, &u);
        let rest = Vector3::new(off[6], off[8], off[10]);
        if rest.norm() < 1e-11 {
            return (s, u);
        }
        steps += 1;
        assert!(steps < 8, "quadratic: {rest}");
        let ab = linear(aircraft, &s, &u);
        let slopes = Matrix3::from_fn(|i, j| {
            let row = [6, 8, 10][i];
            match j {
                0 => {
                    ab[(row, 4)] + speed * (alpha.cos() * ab[(row, 8)] - alpha.sin() * ab[(row, 6)])
                }
                _ => ab[(row, 11 + j)],
            }
        });
        let step = slopes.lu().solve(&rest).expect("a trim");
        alpha -= step[0];
        u[0] -= step[1];
        u[1] -= step[2];
    }
}

/// The speed at which the lift of the reference balances the weight; 176 ft/s in the book.
fn reference_speed(of: &NavionParameters<f64>) -> f64 {
    (2.0 * of.m * of.g / (of.rho * of.s * of.lift)).sqrt()
}

#[test]
fn flight_obeys_newton_and_euler_at_any_attitude() {
    let (aircraft, of) = (Navion::default(), NavionParameters::default());
    for k in 0..40 {
        let wave = |i: usize| (1.3 * f64::from(k) + 0.7 * i as f64 * i as f64).sin();
        let s = SVector::<f64, 12>::from_fn(|i, _| match i {
            4 => 1.2 * wave(i),
            3 | 5 => 3.0 * wave(i),
            6 => 200.0 + 60.0 * wave(i),
            7 | 8 => 40.0 * wave(i),
            _ => wave(i),
        });
        let u = SVector::<f64, 4>::new(
            0.2 * wave(12),
            300.0 * wave(13),
            0.3 * wave(14),
            0.3 * wave(15),
        );
        let (found, expected) = (rates(&aircraft, &s, &u), by_hand(&of, &s, &u));
        let off = (found - expected).amax() / expected.amax();
        assert!(off < 1e-13, "{k}: {off:.1e}");
    }
}

/// At the reference flight of the coefficients nothing is deflected, and thrust equals drag.
#[test]
fn the_trim_of_the_reference_is_that_of_the_book() {
    let (aircraft, of) = (Navion::default(), NavionParameters::default());
    let speed = reference_speed(&of);
    assert!((speed - 176.0).abs() < 1.0, "{speed}");
    let (s, u) = trimmed(&aircraft, speed);
    let drag = of.m * of.g * of.drag / of.lift;
    assert!((s[4] - of.trim_angle).abs() < 1e-12, "{}", s[4]);
    assert!(u[0].abs() < 1e-12, "{}", u[0]);
    assert!((u[1] - drag).abs() < 1e-9 * drag, "{} {drag}", u[1]);
    // At a higher speed the nose is lower and the elevator down, and the equations by hand are still in balance.
    let (s, u) = trimmed(&aircraft, 220.0);
    assert!(s[4] < of.trim_angle && u[0] > 0.0, "{} {}", s[4], u[0]);
    let expected = by_hand(&of, &s, &u);
    assert!(expected.fixed_rows::<6>(6).amax() < 1e-10, "{expected}");
    assert!(expected[2].abs() < 1e-10, "level: {expected}");
}

/// T of δs = T δ, for displacements along the columns of A and of velocities, by hand: rates are linear in (v, ω).
fn displacements(of: &NavionParameters<f64>, s: &SVector<f64, 12>) -> SMatrix<f64, 12, 12> {
    SMatrix::from_fn(|i, j| {
        let mut unit = *s;
        unit.fixed_rows_mut::<6>(6).fill(0.0);
        unit[6 + j % 6] = 1.0;
        match (i < 6, j < 6) {
            (true, true) => by_hand(of, &unit, &SVector::zeros())[i],
            _ => f64::from(i == j),
        }
    })
}

/// Fourth-order difference
fn derivative<const N: usize, const M: usize>(
    at: impl Fn(f64) -> SMatrix<f64, N, M>,
    h: f64,
) -> SMatrix<f64, N, M> {
    let centred = |h: f64| (at(h) - at(-h)) / (2.0 * h);
    (4.0 * centred(h / 2.0) - centred(h)) / 3.0
}

/// Compares [A B] with differences of the equations by hand, in level flight and in a banked turn: δṡ = J δs + L δu
/// with δs = T δ gives δ̇ = T⁻¹ ((J T − Ṫ) δ + L δu).
#[test]
fn slopes_are_those_of_the_equations_by_hand() {
    let (aircraft, of) = (Navion::default(), NavionParameters::default());
    let (level, u) = trimmed(&aircraft, 220.0);
    let mut turning = level;
    for (k, by) in [
        (3, 0.9),
        (4, 0.2),
        (7, 6.0),
        (9, -0.1),
        (10, 0.2),
        (11, 0.15),
    ] {
        turning[k] += by;
    }
    for s in [level, turning] {
        let mut slopes = SMatrix::<f64, 12, 16>::zeros();
        for j in 0..16 {
            let h = if (6..9).contains(&j) || j == 13 {
                1.0
            } else {
                1e-2
            };
            let moved = |by: f64| {
                let (mut s, mut u) = (s, u);
                match j {
                    0..12 => s[j] += by,
                    _ => u[j - 12] += by,
                }
                by_hand(&of, &s, &u)
            };
            slopes.set_column(j, &derivative(moved, h));
        }
        let t = displacements(&of, &s);
        let rates = by_hand(&of, &s, &u);
        let t_dot = derivative(|h| displacements(&of, &(s + h * rates)), 1e-3);
        let by_states = slopes.fixed_columns::<12>(0) * t - t_dot;
        let inverse = t.try_inverse().expect("a chart");
        let found = linear(&aircraft, &s, &u);
        let (a, b) = (found.fixed_columns::<12>(0), found.fixed_columns::<4>(12));
        let off = (a - inverse * by_states).amax() / a.amax();
        assert!(off < 1e-8, "A: {off:.1e}");
        let off = (b - inverse * slopes.fixed_columns::<4>(12)).amax() / b.amax();
        assert!(off < 1e-8, "B: {off:.1e}");
    }
}

/// Compares Nelson's derivatives at the reference in stability axes, and the matrices formed from them.
#[test]
fn linear_equations_are_those_of_the_book() {
    let (aircraft, of) = (Navion::default(), NavionParameters::default());
    let u0 = reference_speed(&of);
    let (s, u) = trimmed(&aircraft, u0);
    let found = linear(&aircraft, &s, &u);
    let qs = of.m * of.g / of.lift;
    let [ix, iy, iz] = INERTIA;
    let (chord, span) = (qs * of.c, qs * of.b);
    let (half_chord, half_span) = (of.c / (2.0 * u0), of.b / (2.0 * u0));
    let per_speed = qs / (of.m * u0);
    // Derivatives of chapter 3.
    let x_u = -2.0 * of.drag * per_speed;
    let x_w = -(of.drag_alpha - of.lift) * per_speed;
    let z_u = -2.0 * of.lift * per_speed;
    let z_w = -(of.lift_alpha + of.drag) * per_speed;
    let z_elevator = -of.lift_elevator * qs / of.m;
    let m_w = of.pitch_alpha * chord / (u0 * iy);
    let m_w_dot = of.pitch_alpha_dot * half_chord * chord / (u0 * iy);
    let m_q = of.pitch_q * half_chord * chord / iy;
    let m_elevator = of.pitch_elevator * chord / iy;
    // Chapter 4: u, w, q, θ; the elevator.
    let longitudinal = Matrix4::new(
        x_u,
        x_w,
        0.0,
        -of.g, //
        z_u,
        z_w,
        u0,
        0.0, //
        m_w_dot * z_u,
        m_w + m_w_dot * z_w,
        m_q + m_w_dot * u0,
        0.0, //
        0.0,
        0.0,
        1.0,
        0.0,
    );
    let elevator = [0.0, z_elevator, m_elevator + m_w_dot * z_elevator, 0.0];
    let y_v = of.side_beta * per_speed;
    let l = |k: f64| k * span / ix;
    let n = |k: f64| k * span / iz;
    // Chapter 5: v, p, r, φ.
    let lateral = Matrix4::new(
        y_v,
        0.0,
        -u0,
        of.g, //
        l(of.roll_beta) / u0,
        l(of.roll_p) * half_span,
        l(of.roll_r) * half_span,
        0.0, //
        n(of.yaw_beta) / u0,
        n(of.yaw_p) * half_span,
        n(of.yaw_r) * half_span,
        0.0, //
        0.0,
        1.0,
        0.0,
        0.0,
    );
    let aileron = [0.0, l(of.roll_aileron), n(of.yaw_aileron), 0.0];
    let rudder = [
        of.side_rudder * qs / of.m,
        l(of.roll_rudder),
        n(of.yaw_rudder),
        0.0,
    ];

    let (long, lat) = ([6, 8, 10, 4], [7, 9, 11, 3]);
    let block = |rows: [usize; 4], columns: [usize; 4]| {
        Matrix4::from_fn(|i, j| found[(rows[i], columns[j])])
    };
    let near = |what: &str, found: Matrix4<f64>, expected: Matrix4<f64>| {
        let off = (found - expected).amax() / expected.amax().max(1.0);
        assert!(off < 1e-12, "{what}: {found} {expected}");
    };
    near("longitudinal", block(long, long), longitudinal);
    near("lateral", block(lat, lat), lateral);
    near(
        "lateral by longitudinal",
        block(long, lat),
        Matrix4::zeros(),
    );
    near(
        "longitudinal by lateral",
        block(lat, long),
        Matrix4::zeros(),
    );
    for (rows, column, expected) in [(long, 12, elevator), (lat, 14, aileron), (lat, 15, rudder)] {
        for (row, expected) in rows.into_iter().zip(expected) {
            let entry = found[(row, column)];
            assert!(
                (entry - expected).abs() < 1e-11,
                "{row} {column}: {entry} {expected}"
            );
        }
    }

    // The published modes; the coefficients have two or three digits.
    let modes =
        |m: Matrix4<f64>| DMatrix::from_iterator(4, 4, m.iter().copied()).complex_eigenvalues();
    for (matrix, published) in [
        (block(long, long), [(-2.5, 2.59), (-0.0171, 0.213)]),
        (block(lat, lat), [(-8.435, 0.0), (-0.487, 2.335)]),
    ] {
        let modes = modes(matrix);
        for (re, im) in published {
            let off = modes.iter().map(|mode| (mode.re - re).hypot(mode.im - im));
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off < 0.01 * f64::hypot(re, im), "{re} {im}: {modes}");
        }
    }
}

/// After a small gust the aircraft follows exp(A t), through two periods of its phugoid.
#[test]
fn a_small_gust_is_answered_by_the_linear_equations() {
    let (aircraft, of) = (Navion::default(), NavionParameters::default());
    let (s, u) = trimmed(&aircraft, reference_speed(&of));
    let mut gust = SVector::<f64, 12>::zeros();
    gust[6] = 1e-4;
    gust[7] = 1e-4;
    let (x, xi) = arrays(&(s + gust));
    let mut state = State::<Navion<f64>> { t: 0.0, x, xi };
    let inputs: [f64; 4] = u.into();
    let h = 0.02;
    for _ in 0..3000 {
        hamel::step(&aircraft, Rkmk4, &mut state, h, &|_, _, _| inputs).expect("a step");
    }
    let a = linear(&aircraft, &s, &u)
        .fixed_columns::<12>(0)
        .into_owned();
    let expected = displacements(&of, &s) * (a * state.t).exp() * gust;
    let (still, _) = arrays(&s);
    for (k, still) in [3, 4].map(|k| (k, still[k])) {
        let off = state.x[k] - still - expected[k];
        assert!(off.abs() < 1e-4 * gust.norm(), "angle {k}: {off:.1e}");
    }
    let start = s.fixed_rows::<6>(6);
    for k in 0..6 {
        let off = state.xi[k] - start[k] - expected[6 + k];
        assert!(off.abs() < 1e-3 * gust.norm(), "velocity {k}: {off:.1e}");
    }
}
