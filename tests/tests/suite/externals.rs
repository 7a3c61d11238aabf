//! Functions in Rust: a glider whose coefficients are such a function, compared with Newton's equations by hand, and
//! its slopes with differences, in both precisions and on lanes.

use hamel::methods::Rkmk8;
use hamel::wide::f64x4;
use hamel::{Scalar, State, integrate};
use hamel_tests::glider::{Glider, GliderFunctions, GliderParameters, GliderState};

/// Coefficients valid for all angles, with their slopes.
#[derive(Clone, Copy, Debug, Default)]
struct Wing;

impl<S: Scalar> GliderFunctions<S> for Wing {
    fn coefficients(&self, alpha: S, rate: S) -> [S; 3] {
        let n = S::from_f64;
        let (sin, cos) = alpha.sin_cos();
        [
            n(5.0) * sin * cos,
            n(0.03) + n(1.2) * sin * sin,
            n(-0.5) * sin - n(0.1) * rate,
        ]
    }

    fn coefficients_jacobian(&self, alpha: S, _: S) -> [[S; 2]; 3] {
        let n = S::from_f64;
        let (sin, cos) = alpha.sin_cos();
        [
            [n(5.0) * (cos * cos - sin * sin), n(0.0)],
            [n(2.4) * sin * cos, n(0.0)],
            [n(-0.5) * cos, n(-0.1)],
        ]
    }
}

const STATES: [[f64; 4]; 3] = [
    [0.1, -1.5, 11.0, 0.2],
    [-0.7, 3.0, 8.0, -1.1],
    [2.5, -4.0, -6.0, 0.6],
];

/// m (z̈ + g) and m ẍ from lift and drag in the axes of the wing, and J ω̇ from their moment, with the numbers of the
/// description.
fn by_hand([pitch, dz, dx, w]: [f64; 4]) -> [f64; 3] {
    let (m, g, j, area, rho, chord) = (1.2, 9.81, 0.04, 0.35, 1.2, 0.2);
    // The wing's first and third axes in the world's x and z.
    let (forward, up) = ([pitch.cos(), -pitch.sin()], [pitch.sin(), pitch.cos()]);
    let along = dx * forward[0] + dz * forward[1];
    let across = dx * up[0] + dz * up[1];
    let alpha = across.atan2(along);
    let q = 0.5 * rho * area * (dx * dx + dz * dz);
    let lift = 2.5 * (2.0 * alpha).sin();
    let drag = 0.63 - 0.6 * (2.0 * alpha).cos();
    let moment = -0.5 * alpha.sin() - 0.1 * w;
    let force = |k: usize| -q * (drag * forward[k] + lift * up[k]);
    [force(1) / m - g, force(0) / m, q * chord * moment / j]
}

fn glider() -> Glider<f64, Wing> {
    Glider::new(GliderParameters::default(), Wing).expect("a glider")
}

#[test]
fn forces_are_those_of_the_function() {
    let glider = glider();
    for state @ [pitch, dz, dx, w] in STATES {
        let found = glider
            .accel(&[0.3, -2.0, pitch], &[dz, dx, w], &[])
            .expect("a value");
        for (found, wanted) in found.iter().zip(by_hand(state)) {
            assert!(
                (found - wanted).abs() < 1e-10 * wanted.abs().max(1.0),
                "{found} {wanted}"
            );
        }
    }
}

/// Integrates the equations by hand with the classical Runge-Kutta method and short steps.
#[test]
fn it_flies_as_by_hand() {
    let glider = glider();
    let mut state = State::from(GliderState::default());
    let until = 2.0;
    integrate(
        &glider,
        Rkmk8,
        &mut state,
        1e-2,
        until,
        |_, _, _| [],
        |_| {},
    )
    .expect("a flight");
    let rate = |[_, _, pitch, dz, dx, w]: [f64; 6]| {
        let [ddz, ddx, dw] = by_hand([pitch, dz, dx, w]);
        [dz, dx, w, ddz, ddx, dw]
    };
    let moved = |y: [f64; 6], h: f64, k: [f64; 6]| std::array::from_fn(|i| y[i] + h * k[i]);
    let (steps, mut y) = (20_000, [0.0, 0.0, 0.0, 0.0, 12.0, 0.0]);
    let h = until / f64::from(steps);
    for _ in 0..steps {
        let k1 = rate(y);
        let k2 = rate(moved(y, h / 2.0, k1));
        let k3 = rate(moved(y, h / 2.0, k2));
        let k4 = rate(moved(y, h, k3));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    let end = GliderState::from(&state);
    let found = [
        end.path_r[0],
        end.path_r[1],
        end.path,
        end.path_r_dot[0],
        end.path_r_dot[1],
        end.path_dot,
    ];
    for (found, wanted) in found.into_iter().zip(y) {
        assert!((found - wanted).abs() < 1e-8, "{found} {wanted}");
    }
}

/// Rows of d/dt of (displacement, ξ); displacements are differences of x, since the coordinates are plain.
#[test]
fn slopes_are_those_of_the_matrix() {
    let glider = glider();
    const H: f64 = 1e-5;
    for [pitch, dz, dx, w] in STATES {
        let at = [0.3, -2.0, pitch, dz, dx, w];
        let accel = |y: [f64; 6]| {
            glider
                .accel(&[y[0], y[1], y[2]], &[y[3], y[4], y[5]], &[])
                .expect("a value")
        };
        let rows = glider
            .linearize(&[at[0], at[1], at[2]], &[dz, dx, w], &[])
            .expect("a value");
        for column in 0..6 {
            let (mut more, mut less) = (at, at);
            more[column] += H;
            less[column] -= H;
            let (more, less) = (accel(more), accel(less));
            for row in 0..3 {
                let wanted = (more[row] - less[row]) / (2.0 * H);
                let found = rows[3 + row][column];
                let error = (found - wanted).abs();
                assert!(
                    error < 1e-6 * wanted.abs().max(10.0),
                    "{row} {column}: {found} {wanted}"
                );
            }
        }
    }
}

#[test]
fn numbers_of_all_kinds() {
    let single = Glider::<f32, Wing>::default();
    let lanes = Glider::<f64x4, Wing>::default();
    for [pitch, dz, dx, w] in STATES {
        let wanted = glider()
            .accel(&[0.0, 0.0, pitch], &[dz, dx, w], &[])
            .expect("a value");
        let short = single
            .accel(
                &[0.0, 0.0, pitch as f32],
                &[dz as f32, dx as f32, w as f32],
                &[],
            )
            .expect("a value");
        let [zero, pitch, dz, dx, w] = [0.0, pitch, dz, dx, w].map(f64x4::splat);
        let wide = lanes
            .accel(&[zero, zero, pitch], &[dz, dx, w], &[])
            .expect("a value");
        for k in 0..3 {
            let size = wanted[k].abs().max(10.0);
            assert!((f64::from(short[k]) - wanted[k]).abs() < 1e-4 * size);
            assert!(
                wide[k]
                    .to_array()
                    .iter()
                    .all(|lane| (lane - wanted[k]).abs() < 1e-12 * size)
            );
        }
    }
}

/// The macro, with a function of one number that returns one, and a description without parameters.
#[test]
fn a_spring_from_elsewhere() {
    hamel::rigid_eom! {
        system Spring {
            extern fn pull(x) -> 1;
            joint rail: prismatic [1, 0, 0] moves f;
            body on f { mass 2; com [0, 0, 0]; }
            generalized force rail_dot = -pull(rail);
            generate accel, linearize;
        }
    }
    #[derive(Clone, Debug)]
    struct Hard(f64);
    impl SpringFunctions<f64> for Hard {
        fn pull(&self, x: f64) -> f64 {
            self.0 * x.powi(3)
        }
        fn pull_jacobian(&self, x: f64) -> [f64; 1] {
            [3.0 * self.0 * x.powi(2)]
        }
    }
    let spring = Spring::new(Hard(7.0)).expect("a spring");
    assert_eq!(spring.accel(&[0.5], &[0.0], &[]), Ok([-7.0 * 0.125 / 2.0]));
    let rows = spring.linearize(&[0.5], &[0.0], &[]);
    assert_eq!(rows, Ok([[0.0, 1.0], [-3.0 * 7.0 * 0.25 / 2.0, 0.0]]));
    // ½ m v² + k x⁴/4 is conserved.
    let mut state = State::start(&spring);
    state.x = [0.8];
    integrate(&spring, Rkmk8, &mut state, 1e-2, 3.0, |_, _, _| [], |_| {}).expect("a swing");
    let energy = state.xi[0].powi(2) + 7.0 * state.x[0].powi(4) / 4.0;
    assert!(
        (energy - 7.0 * 0.8_f64.powi(4) / 4.0).abs() < 1e-10,
        "{energy}"
    );
}
