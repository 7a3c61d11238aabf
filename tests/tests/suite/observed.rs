//! Frames, momenta, slopes of outputs and of the dynamics, and base parameters of a compiled type, compared with closed
//! forms and differences of its poses; also single precision, and a mass that the base parameters leave out.

hamel::rigid_eom! {
    /// A turret on a mount at 45°, and a slide almost parallel to its axis.
    system Turret {
        param m = 1.5, k = 0.5;
        joint turn: revolute [0, 0, 1] at pose(rotx(pi / 4), [0.1, 0.2, 0.3]) moves head;
        joint slide: prismatic [0, 1e-7, 1] on head at pose(identity(3), [0.4, 0, 0]) moves barrel;
        body on head { mass m; com [0.1, 0, 0]; inertia diag(0.1, 0.2, 0.3) about com; }
        body on barrel { mass k; com [0, 0, 0.2]; inertia diag(0.1, 0.1, 0.05) about com; }
        gravity [0, 0, -9.81];
        input u;
        generalized force slide_dot = u;
        output height = position(barrel, [0, 0, 0.5])[3];
        output felt = acceleration(barrel);
        generate all, jacobian barrel, jacobian barrel in barrel, centroidal_map, centroidal_bias, centre_of_mass,
            height_slopes, felt_slopes, regressor, inverse_dynamics_slopes, parameter_slopes;
    }
}

hamel::rigid_eom! {
    /// Nothing but the centre of mass: M is not asked for.
    system Weight {
        param m = 1;
        joint q: revolute [0, 0, 1] moves f;
        body on f { mass m; com [1, 0, 0]; inertia diag(1, 1, 1) about com; }
        generate centre_of_mass;
    }
}

/// d/dh of f at 0, to fourth order
fn slope<const N: usize>(f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let h = 1e-3;
    let [p, m, pp, mm] = [h, -h, 2.0 * h, -2.0 * h].map(f);
    std::array::from_fn(|i| (8.0 * (p[i] - m[i]) - (pp[i] - mm[i])) / (12.0 * h))
}

fn close<const N: usize>(what: &str, found: [f64; N], wanted: [f64; N]) {
    for (a, b) in found.iter().zip(wanted) {
        assert!(
            (a - b).abs() < 1e-9 * (1.0 + b.abs()),
            "{what}: {found:?}, {wanted:?}"
        );
    }
}

fn product<const N: usize, const M: usize>(rows: [[f64; N]; M], v: [f64; N]) -> [f64; M] {
    rows.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
}

#[test]
fn compiled_functions_are_what_their_definitions_say() {
    let turret = Turret::<f64>::default();
    let (x, xi, u) = ([0.7, 0.3], [1.3, -0.4], [0.2]);
    let later = |h: f64| [x[0] + h * xi[0], x[1] + h * xi[1]];
    let pose = turret.barrel_pose(&x);
    // The mount is rotated by 45° about the first axis, then by the angle; the slide is tilted by 1e-7.
    let (sin, cos) = 0.7_f64.sin_cos();
    let half = 0.5_f64.sqrt();
    let out = |v: [f64; 3]| {
        let (a, b) = (cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]);
        [a, half * (b - v[2]), half * (b + v[2])]
    };
    let arm = out([0.4, 0.3e-7, 0.3]);
    let place = [0.1 + arm[0], 0.2 + arm[1], 0.3 + arm[2]];
    close("the place", [0, 1, 2].map(|i| pose[i][3]), place);
    let flat = |h: f64| {
        let pose = turret.barrel_pose(&later(h));
        std::array::from_fn::<f64, 12, _>(|i| pose[i / 4][i % 4])
    };
    let rate = slope(flat);
    let spin = |i: usize, j: usize| (0..3).map(|k| rate[4 * i + k] * pose[j][k]).sum::<f64>();
    let twist = [
        rate[3],
        rate[7],
        rate[11],
        spin(2, 1),
        spin(0, 2),
        spin(1, 0),
    ];
    close("the twist", turret.barrel_twist(&x, &xi), twist);
    close("J ξ", product(turret.barrel_jacobian(&x), xi), twist);
    let bias = slope(|h| turret.barrel_twist(&later(h), &xi));
    close("the bias", turret.barrel_bias_acceleration(&x, &xi), bias);
    let own = |v: [f64; 3]| [0, 1, 2].map(|j| (0..3).map(|i| pose[i][j] * v[i]).sum::<f64>());
    let (v, w) = (
        own([twist[0], twist[1], twist[2]]),
        own([twist[3], twist[4], twist[5]]),
    );
    let body = [v[0], v[1], v[2], w[0], w[1], w[2]];
    close("the body twist", turret.barrel_body_twist(&x, &xi), body);
    close(
        "the body J ξ",
        product(turret.barrel_body_jacobian(&x), xi),
        body,
    );
    let bias = slope(|h| turret.barrel_body_twist(&later(h), &xi));
    close(
        "the body bias",
        turret.barrel_body_bias_acceleration(&x, &xi),
        bias,
    );
    let momentum = turret.centroidal_momentum(&x, &xi);
    close("A_G ξ", product(turret.centroidal_map(&x), xi), momentum);
    let speed = slope(|h| turret.centre_of_mass(&later(h)));
    close(
        "m ċ",
        speed.map(|v| 2.0 * v),
        [momentum[0], momentum[1], momentum[2]],
    );
    let bias = slope(|h| turret.centroidal_momentum(&later(h), &xi));
    close("its bias", turret.centroidal_bias(&x, &xi), bias);
    let force = turret.inverse_dynamics(&x, &xi, &[0.3, 0.9]);
    let regressor = turret.regressor(&x, &xi, &[0.3, 0.9]);
    close("Y β", product(regressor, turret.base_parameters()), force);
    // Columns: h along the coordinates, δξ, δu.
    let felt = |x: [f64; 2], xi: [f64; 2], u: [f64; 1]| {
        let xi_dot = turret.accel(&x, &xi, &u).expect("regular");
        turret.felt(&x, &xi, &xi_dot)
    };
    let slopes = turret.felt_slopes(&x, &xi, &u).expect("regular");
    let height = turret.height_slopes(&x, &xi, &u);
    for column in 0..5 {
        let moved = |h: f64| {
            let (mut x, mut xi, mut u) = (x, xi, u);
            match column {
                0 | 1 => x[column] += h,
                2 | 3 => xi[column - 2] += h,
                _ => u[0] += h,
            }
            (x, xi, u)
        };
        let of_felt = slope(|h| {
            let (x, xi, u) = moved(h);
            felt(x, xi, u)
        });
        close(
            "slopes of felt",
            [0, 1, 2].map(|i| slopes[i][column]),
            of_felt,
        );
        let of_height = slope(|h| [turret.height(&moved(h).0)]);
        close("slopes of height", [height[0][column]], of_height);
    }
}

/// Lagrange's equations by hand: T = ½ a q̇² + ½ k ṡ² + 0.4 k ε q̇ ṡ with a = 0.35 + 0.01 m + k (0.16 + ε² s²), ε the
/// slant of the slide, and V = g/√2 (0.1 m sin q + k (0.4 sin q + ε s cos q + s)).
#[test]
fn slopes_of_the_dynamics_are_those_of_lagrange() {
    let turret = Turret::<f64>::default();
    let ([q, s], [v, w], u) = ([0.7, 0.3], [1.3, -0.4], [0.2]);
    let ((sin, cos), slant) = (f64::sin_cos(q), 1e-7 / f64::hypot(1.0, 1e-7));
    let (m, k, weight) = (1.5, 0.5, 9.81 * 0.5_f64.sqrt());
    let forces = |[a, b]: [f64; 2]| {
        let turning = 0.35 + 0.01 * m + k * (0.16 + slant * slant * s * s);
        let swing = 2.0 * k * slant * slant * s * w * v;
        let pull = weight * (0.1 * m * cos + k * (0.4 * cos - slant * s * sin));
        [
            turning * a + 0.4 * k * slant * b + swing + pull,
            k * b + 0.4 * k * slant * a - k * slant * slant * s * v * v
                + weight * k * (slant * cos + 1.0),
        ]
    };
    let (x, xi, rates) = ([q, s], [v, w], [0.3, 0.9]);
    close("f", turret.inverse_dynamics(&x, &xi, &rates), forces(rates));
    let [turn, slide] = turret.inverse_dynamics_slopes(&x, &xi, &rates);
    let twice = 2.0 * k * slant * slant;
    let turned = -weight * ((0.1 * m + 0.4 * k) * sin + k * slant * s * cos);
    let slid = twice * (s * rates[0] + w * v) - weight * k * slant * sin;
    close("∂f₁", turn, [turned, slid, twice * s * w, twice * s * v]);
    let lifted = -weight * k * slant * sin;
    let thrown = -k * slant * slant * v * v;
    close("∂f₂", slide, [lifted, thrown, -twice * s * v, 0.0]);
    // M ∂ξ̇/∂p = −∂f/∂p at constant ξ̇.
    let [a, b] = turret.accel(&x, &xi, &u).expect("regular");
    let by_mass = [0.01 * a + weight * 0.1 * cos, 0.0];
    let by_load = {
        let [one, other] = forces([a, b]);
        [
            (one - (0.35 + 0.01 * m) * a - weight * 0.1 * m * cos) / k,
            other / k,
        ]
    };
    let mass = turret.mass_matrix(&x);
    let slopes = turret.parameter_slopes(&x, &xi, &u).expect("regular");
    for (column, by) in [by_mass, by_load].into_iter().enumerate() {
        let moved = product(mass, [slopes[0][column], slopes[1][column]]);
        close("M ∂ξ̇/∂p", moved, by.map(|f| -f));
    }
}

#[test]
fn single_precision_keeps_its_digits() {
    let (turret, exact) = (Turret::<f32>::default(), Turret::<f64>::default());
    let found = turret.barrel_jacobian(&[0.7, 0.3]);
    let wanted = exact.barrel_jacobian(&[0.7, 0.3]);
    for (a, b) in found.iter().flatten().zip(wanted.iter().flatten()) {
        assert!((f64::from(*a) - b).abs() < 2e-7, "{a} {b}");
    }
}

#[test]
fn without_mass_there_is_a_typed_error() {
    assert!(Weight::<f64>::new(WeightParameters { m: 0.0 }).is_err());
    let mut weight = Weight::<f64>::default();
    assert!(weight.set_m(-1.0).is_err());
}
