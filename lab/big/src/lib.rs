//! Forward dynamics of a spatial chain of 16 links with run-time parameters, and its derivatives: more than 20,000
//! statements, split into parts that rustc compiles easily with debug information. Also a tree of the size of a
//! humanoid robot.

include!(concat!(env!("OUT_DIR"), "/chain.rs"));

/// A floating trunk with four legs, whose slopes are computed in short parts.
pub mod quadruped {
    include!(concat!(env!("OUT_DIR"), "/quadruped.rs"));
}

/// A floating trunk with a waist, two legs, two arms and a head.
pub mod humanoid {
    include!(concat!(env!("OUT_DIR"), "/humanoid.rs"));
}

#[cfg(test)]
mod tests {
    use super::Chain;

    /// Rounding of about ten thousand operations on accelerations of order 100.
    const ROUNDING: f64 = 1e-7;

    /// Counts the statements of the text, one `let` each.
    #[test]
    fn it_is_a_big_model() {
        let text = include_str!(concat!(env!("OUT_DIR"), "/chain.rs"));
        assert!(text.matches("let ").count() > 20_000);
    }

    fn state() -> ([f64; 32], [f64; 16]) {
        let x = std::array::from_fn(|i| {
            let angle = 0.3 * (1.0 + (i / 2) as f64).sin();
            if i % 2 == 0 { angle.cos() } else { angle.sin() }
        });
        (x, std::array::from_fn(|i| (2.0 + i as f64).cos()))
    }

    fn accel(x: &[f64; 32], xi: &[f64; 16]) -> [f64; 16] {
        let found = Chain::<f64>::default().accel(x, xi, &[]);
        found.expect("the chain has inertia")
    }

    fn is_near(a: f64, b: f64) -> bool {
        a.is_finite() && (a - b).abs() <= ROUNDING * (1.0 + a.abs())
    }

    /// Time reversal: accelerations are even in the velocities, exactly.
    #[test]
    fn accelerations_are_even_in_the_velocities() {
        let (x, xi) = state();
        let (forward, backward) = (accel(&x, &xi), accel(&x, &xi.map(|rate| -rate)));
        for (&a, &b) in forward.iter().zip(&backward) {
            assert!(is_near(a, b), "{a} and {b}");
        }
    }

    /// Accelerations are quadratic in the velocities, so that half the difference of two states is exactly the
    /// derivative; ξ̇ and ξ are the second halves of rows and columns.
    #[test]
    fn derivatives_by_velocities_are_differences() {
        let (x, xi) = state();
        let found = Chain::<f64>::default().linearize(&x, &xi, &[]);
        let found = found.expect("the chain has inertia");
        for column in 0..16 {
            let moved = |step: f64| {
                let mut xi = xi;
                xi[column] += step;
                accel(&x, &xi)
            };
            let (ahead, behind) = (moved(1.0), moved(-1.0));
            for row in 0..16 {
                let difference = 0.5 * (ahead[row] - behind[row]);
                let derivative = found[16 + row][16 + column];
                assert!(
                    is_near(difference, derivative),
                    "{difference} and {derivative}"
                );
            }
        }
    }
}
