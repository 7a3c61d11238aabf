//! Statements about entries of vectors are equivalent to those about scalars.

use crate::common::{Random, difference, generated, value};
use hamel_codegen::generate::{Generated, from_text};

/// Returns a particle given by a vector, and by three numbers, with the same statements.
fn both(said: &str) -> [Generated; 2] {
    let forces = "accel, constraint_force, inverse_dynamics";
    let text = |declared: &str, at: &str, said: &str| {
        format!(
            "system A {{ time t; input a; {declared} particle mass 2 at {at};
                potential dot({at}, {at})^2; {said} generate {forces}; }}"
        )
    };
    let vector = text("coord r: R3; velocity v: vec3; rate r = v;", "r", said);
    let mut scalars = said.to_string();
    for (entry, scalar) in [("1", "x"), ("2", "y"), ("3", "z")] {
        scalars = scalars.replace(&format!("r[{entry}]"), scalar);
        scalars = scalars.replace(&format!("v[{entry}]"), &format!("v{scalar}"));
    }
    let declared = "coord x, y, z; velocity vx, vy, vz; rate x = vx; rate y = vy; rate z = vz;";
    [vector, text(declared, "[x, y, z]", &scalars)].map(|text| generated(&text))
}

#[test]
fn entries_are_prescribed_pushed_and_started_as_scalars_are() {
    let mut random = Random::new(3);
    for said in [
        "prescribe r[2] = 0.3 * sin(t);",
        "prescribe v[2] = 2 * t;",
        "prescribe v[2] = 2 * t; prescribe v[3] = cos(t);",
        "prescribe r[1] = t^2; prescribe rate(v[3]) = a;",
        "prescribe rate(v[2]) = a * r[1];",
        "generalized force v[3] = -0.2 * v[3]; generalized force v[1] = a;",
        "generalized force v[3] = a; generalized force v[3] = -0.2 * v[3];",
        "start r[1] = 0.4; start r[3] = 2; start v[2] = -0.1;",
        "nonholonomic v[1] = v[2]; start r[3] = 1; start v[1] ~ 0.3;",
        "loop r[1]^2 + r[2]^2 = 1; start r[1] ~ 0.5; start r[2] ~ 1.2; start r[3] = 0.1;",
        "inactive v[1]; spring stiffness 3 on r[2]; damper coefficient 2 on v[3];",
    ] {
        let [vector, scalars] = both(said);
        assert_eq!(vector.model.start_x, scalars.model.start_x, "{said}");
        assert_eq!(vector.model.start_xi, scalars.model.start_xi, "{said}");
        let (x, xi) = (vector.active.x.len(), vector.active.xi.len());
        let (x, xi, u) = (random.numbers(x), random.numbers(xi), random.numbers(1));
        for name in ["accel", "constraint_force"] {
            let Some(function) = vector.program.function(name) else {
                assert!(scalars.program.function(name).is_none());
                continue;
            };
            let dot = random.numbers(vector.active.xi.len());
            let _ = function;
            let [ours, theirs] = [&vector, &scalars].map(|of| value(of, name, [&x, &xi, &u, &dot]));
            assert!(difference(&theirs, &ours) < 1e-12, "{said}: {name}");
        }
    }
}

/// Counters can be indices, also in components and poses.
#[test]
fn entries_are_named_by_counters_and_in_parts() {
    let text = |said: &str| {
        format!(
            "system A {{ component Ball(m = 1) {{ coord X: SE3; velocity v: vec3, w: vec3;
                rate X.p = X.R * v; rate X.R = X.R * hat(w); frame f = X;
                body on f {{ mass m; inertia diag(1, 2, 3) about com; }} }}
                part one = Ball(); part ball[i in 1..2] = Ball(i); {said}
                generate accel; }}"
        )
    };
    let entries = generated(&text(
        "for i in 1..3 { generalized force ball[2].w[i] = i * one.v[i]; start one.w[i] = i / 10; }
         start ball[1].X.p[2] = 4;",
    ));
    let whole = generated(&text(
        "generalized force ball[2].w = [one.v[1], 2 * one.v[2], 3 * one.v[3]];
         start one.w = [0.1, 0.2, 0.3]; start ball[1].X.p = [0, 4, 0];",
    ));
    assert_eq!(entries.model.start_x, whole.model.start_x);
    assert_eq!(entries.model.start_xi, whole.model.start_xi);
    let state = [&whole.model.start_x[..], &[0.3; 18], &[], &[]];
    assert_eq!(
        value(&entries, "accel", state),
        value(&whole, "accel", state)
    );
}

#[test]
fn entries_that_cannot_be_meant_are_refused() {
    let text = |said: &str| {
        format!(
            "system A {{ time t; coord r: R3, y, R: SO3, q: S3, a: S1; velocity v: vec3, u, w: vec3, o: vec3, b;
                rate r = v; rate y = u; rate R = R * hat(w); rate q = rotation_rate(q, o); rate a = b;
                frame f = pose(R, r); body on f {{ mass 1; inertia identity(3) about com; }}
                kinetic u^2 + dot(o, o) + b^2; {said} generate accel; }}"
        )
        .replace("rate q = rotation_rate(q, o);", "rate q = 1/2 * [-q[2]*o[1]-q[3]*o[2]-q[4]*o[3], q[1]*o[1]+q[3]*o[3]-q[4]*o[2], q[1]*o[2]+q[4]*o[1]-q[2]*o[3], q[1]*o[3]+q[2]*o[2]-q[3]*o[1]];")
    };
    generated(&text(""));
    for (said, message) in [
        (
            "start r[4] = 1;",
            "index 4 is out of range: a vector of 3 has 3 entries",
        ),
        ("start v[0] = 1;", "index 0 is out of range"),
        ("start u[1] = 1;", "`u` is a scalar and has no such entry"),
        (
            "generalized force w[1, 2] = 1;",
            "`w` is a vector of 3 and has no such entry",
        ),
        (
            "start R[1, 1] = 1;",
            "`R[1, 1]` is tied to the other entries",
        ),
        ("start q[1] = 1;", "`q[1]` is tied to the other entries"),
        ("start a[1] = 1;", "`a[1]` is tied to the other entries"),
        (
            "prescribe R[1, 1] = 1;",
            "the value of `R[1, 1]` cannot be prescribed",
        ),
        (
            "prescribe a[1] = 1;",
            "the value of `a[1]` cannot be prescribed",
        ),
        (
            "prescribe v[1] = [t, t, t];",
            "the motion of `v[1]` has to be a scalar",
        ),
        (
            "start r[1] = 1; start r = [1, 2, 3];",
            "the start of `r` is given twice",
        ),
        (
            "start r[1] = 1; start r[1] = 2;",
            "the start of `r[1]` is given twice",
        ),
        (
            "prescribe r[1] = t; prescribe r = [t, t, t];",
            "the motion of `r` is prescribed twice",
        ),
        ("prescribe rate(r[1]) = t;", "`r[1]` is not a velocity"),
    ] {
        let errors = from_text(&text(said)).expect_err(said);
        let messages: Vec<&str> = errors.iter().map(|error| error.message.as_str()).collect();
        assert!(messages[0].contains(message), "{said}: {messages:?}");
    }
    let whole = text("").replace("rate r = v;", "rate r[1] = v[1];");
    let errors = from_text(&whole).expect_err("a part of a rate");
    assert_eq!(errors[0].message, "the rate of `r` is given as a whole");
}
