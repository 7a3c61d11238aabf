//! Forward dynamics of a spatial chain of 20 links with run-time parameters: more than 20,000
//! statements in one function, cut into parts that rustc bears with debug information on.

include!(concat!(env!("OUT_DIR"), "/chain.rs"));

#[cfg(test)]
mod tests {
    use super::Chain;

    /// Rounding of some ten thousand operations on accelerations of order 100.
    const ROUNDING: f64 = 1e-7;

    /// Statements of the text, one `let` each.
    #[test]
    fn it_is_a_big_model() {
        let text = include_str!(concat!(env!("OUT_DIR"), "/chain.rs"));
        assert!(text.matches("let ").count() > 20_000);
    }

    /// A chain that hangs straight down at rest with its masses on the line stays there; here the
    /// law is reflection in time: accelerations are even in the velocities, exactly.
    #[test]
    fn accelerations_are_even_in_the_velocities() {
        let chain = Chain::<f64>::default();
        let x: [f64; 40] = std::array::from_fn(|i| {
            let angle = 0.3 * (1.0 + (i / 2) as f64).sin();
            if i % 2 == 0 { angle.cos() } else { angle.sin() }
        });
        let xi: [f64; 20] = std::array::from_fn(|i| (2.0 + i as f64).cos());
        let forward = chain.accel(&x, &xi, &[]).expect("the chain has inertia");
        let backward = chain
            .accel(&x, &xi.map(|rate| -rate), &[])
            .expect("the chain has inertia");
        for (a, b) in forward.iter().zip(&backward) {
            assert!(
                a.is_finite() && (a - b).abs() <= ROUNDING * (1.0 + a.abs()),
                "{a} and {b}"
            );
        }
    }
}
