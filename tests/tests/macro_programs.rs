//! A correct description expands to a system that runs.

hamel::rigid_eom! {
    /// A particle on a line.
    pub system Particle {
        param m = 2;
        coord x;
        velocity v;
        rate x = v;
        particle mass m at [x, 0, 0];
        input f;
        generalized force v = f;
    }
}

#[test]
fn right_descriptions_expand_to_systems() {
    let particle = Particle::<f64>::default();
    let rate = particle.rate(&[1.0], &[3.0]);
    assert_eq!(rate, [3.0]);
}
