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

#[test]
fn the_scalar_is_f64_where_none_is_named() {
    let heavier = ParticleParameters { m: 4.0 };
    let particle: Particle = Particle::new(heavier).expect("a positive mass");
    let inferred = Particle::default();
    let doubled = inferred.accel(&[1.0], &[3.0], &[2.0]);
    let rate = particle.accel(&[1.0], &[3.0], &[2.0]);
    assert_eq!((doubled, rate), (Ok([1.0]), Ok([0.5])));
}
