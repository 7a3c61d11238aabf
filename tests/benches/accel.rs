//! Compares the generated forward dynamics of a free body with a hand-written function.
//!
//! Both evaluate ξ̇ from R, v, ω and a body wrench with a full inertia and an off-centre mass. The hand-written
//! function has 54 multiplications and 45 additions, and gets precomputed constants. Run with
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p hamel-tests --bench accel`.

use divan::{Bencher, black_box};

hamel::rigid_eom! {
    /// A rigid body, from the macro.
    pub system MacroBody {
        param m = 1.3, g = 9.81;
        param s: vec3 = [0.1, -0.2, 0.3];
        param Theta: sym3 = [[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]];
        coord r: R3, R: SO3;
        velocity v: vec3, w: vec3;
        rate r = R * v;
        rate R = R * hat(w);
        frame hull = pose(R, r);
        body on hull { mass m; com s; inertia Theta about origin; }
        gravity [0, 0, -g];
        input F: vec3, tau: vec3;
        wrench (F, tau) on hull in body;
    }
}

const INPUTS: usize = 32;

type Case = ([f64; 12], [f64; 6], [f64; 6]);

fn main() {
    agree();
    divan::main();
}

/// Different states for every call, so that nothing is hoisted out of the loop.
fn cases() -> Vec<Case> {
    (0..INPUTS)
        .map(|k| {
            let wave = |i: usize| ((k * 37 + i * 11) as f64 * 0.618).sin();
            let rotation = hamel::so3::exp([wave(1), wave(2), wave(3)]);
            let mut x = [0.0; 12];
            x[3..].copy_from_slice(&rotation);
            (
                x,
                std::array::from_fn(|i| wave(i + 20)),
                std::array::from_fn(|i| wave(i + 40)),
            )
        })
        .collect()
}

#[divan::bench(sample_count = 1000)]
fn generated(bencher: Bencher) {
    let (body, cases) = (MacroBody::<f64>::default(), cases());
    bencher.counter(INPUTS).bench(|| {
        for (x, xi, u) in &cases {
            black_box(body.accel(black_box(x), black_box(xi), black_box(u)).ok());
        }
    });
}

#[divan::bench(sample_count = 1000)]
fn hand_written(bencher: Bencher) {
    let (body, cases) = (Hand::new(), cases());
    bencher.counter(INPUTS).bench(|| {
        for (x, xi, u) in &cases {
            black_box(body.accel(black_box(x), black_box(xi), black_box(u)));
        }
    });
}

/// Constants of the body about its centre of mass.
struct Hand {
    per_mass: f64,
    g: f64,
    s: [f64; 3],
    j: [[f64; 3]; 3],
    inverse: [[f64; 3]; 3],
}

impl Hand {
    fn new() -> Self {
        let (m, s) = (1.3, [0.1, -0.2, 0.3]);
        let theta = [[2.1, 0.1, -0.2], [0.1, 1.7, 0.15], [-0.2, 0.15, 1.2]];
        let square: f64 = s.iter().map(|x| x * x).sum();
        let j: [[f64; 3]; 3] = std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                theta[a][b] - m * (if a == b { square } else { 0.0 } - s[a] * s[b])
            })
        });
        // Columns of the inverse: cross products of rows divided by the determinant.
        let adjugate: [[f64; 3]; 3] =
            std::array::from_fn(|i| cross(j[(i + 1) % 3], j[(i + 2) % 3]));
        let determinant: f64 = (0..3).map(|i| j[0][i] * adjugate[0][i]).sum();
        Hand {
            per_mass: 1.0 / m,
            g: 9.81,
            s,
            j,
            inverse: adjugate.map(|row| row.map(|entry| entry / determinant)),
        }
    }

    /// v̇ = F/m + Rᵀg − ω × (v + ω × s) − ω̇ × s, ω̇ = J⁻¹ (τ − s × F + (J ω) × ω).
    fn accel(&self, x: &[f64; 12], xi: &[f64; 6], u: &[f64; 6]) -> [f64; 6] {
        let (v, w) = ([xi[0], xi[1], xi[2]], [xi[3], xi[4], xi[5]]);
        let (f, tau) = ([u[0], u[1], u[2]], [u[3], u[4], u[5]]);
        let lever = cross(w, self.s);
        let centre = [v[0] + lever[0], v[1] + lever[1], v[2] + lever[2]];
        let turn = cross(w, centre);
        let momentum = apply(&self.j, w);
        let gyro = cross(momentum, w);
        let arm = cross(self.s, f);
        let torque = std::array::from_fn(|i| tau[i] - arm[i] + gyro[i]);
        let alpha = apply(&self.inverse, torque);
        let sway = cross(alpha, self.s);
        let linear: [f64; 3] = std::array::from_fn(|i| {
            f[i].mul_add(self.per_mass, (-self.g).mul_add(x[9 + i], -turn[i])) - sway[i]
        });
        [
            linear[0], linear[1], linear[2], alpha[0], alpha[1], alpha[2],
        ]
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let c = |i: usize, j: usize| a[i].mul_add(b[j], -(a[j] * b[i]));
    [c(1, 2), c(2, 0), c(0, 1)]
}

fn apply(m: &[[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| m[i][2].mul_add(a[2], m[i][1].mul_add(a[1], m[i][0] * a[0])))
}

/// Checks that both functions agree before they are timed.
fn agree() {
    let (generated, hand) = (MacroBody::<f64>::default(), Hand::new());
    for (x, xi, u) in cases() {
        let a = generated
            .accel(&x, &xi, &u)
            .expect("the mass matrix is constant");
        let b = hand.accel(&x, &xi, &u);
        for i in 0..6 {
            assert!(
                (a[i] - b[i]).abs() < 1e-12,
                "row {i}: {} and {}",
                a[i],
                b[i]
            );
        }
    }
}
