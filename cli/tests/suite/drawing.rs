//! Drawn parts are placed as the mechanism's functions compute them.

use hamel_engine::drawing::{LineKind, Scene, Vector};
use hamel_engine::{Grip, OpenOptions, Quiet, RunArrays, Session, Simulation, Stepping};
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn session(path: &Path) -> Session {
    let opened = Session::open(path, &OpenOptions::default(), Arc::new(Quiet));
    opened.unwrap_or_else(|error| panic!("{error}"))
}

fn read(text: &str) -> Session {
    let read = Session::read(
        text.into(),
        "text.eom",
        &OpenOptions::default(),
        Arc::new(Quiet),
    );
    read.unwrap_or_else(|error| panic!("{error}"))
}

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models")
}

/// The scene at a state given as text.
fn scene(session: &Session, state: &str) -> (Scene, Vec<f64>) {
    let start = session.start();
    let state = session.state(&start.params, state, "state.json");
    let state = state.unwrap_or_else(|error| panic!("{error}"));
    let drawing = session.drawing();
    let drawing = drawing.unwrap_or_else(|error| panic!("{error}"));
    (
        drawing.with_parameters(&state.params).scene(&state.x),
        state.x,
    )
}

/// The value of a function at the start's parameters, with u = 0 and ξ = 0.
fn value(session: &Session, name: &str, x: &[f64]) -> Vec<f64> {
    let function = session.function(name);
    let function = function.unwrap_or_else(|error| panic!("{error}"));
    let constants = function
        .constants(&session.start().params)
        .expect("constants");
    let mut out = vec![f64::NAN; function.shape.entries()];
    let none = vec![0.0; session.start().xi.len()];
    let called = function.call(&constants, [x, &none, &[], &[], &[]], &mut out);
    called.expect("a value");
    out
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs()), "{a} is not {b}");
}

fn distance(a: Vector, b: Vector) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

#[test]
fn frames_are_where_their_pose_functions_say() {
    let cases = [
        (
            "ship_arm_joints.eom",
            r#"{"coord": {"pan": 0.4, "lift": -0.8}}"#,
        ),
        ("satellite.eom", "{}"),
        ("bricard.eom", "{}"),
    ];
    for (file, state) in cases {
        let session = session(&models().join(file));
        let (scene, x) = scene(&session, state);
        assert!(!scene.frames.is_empty(), "{file}");
        for frame in &scene.frames {
            let pose = value(&session, &format!("{}_pose", frame.name), &x);
            for (k, row) in pose.chunks(4).enumerate() {
                for i in 0..3 {
                    close(frame.rotation[k][i], row[i]);
                }
                close(frame.position[k], row[3]);
            }
        }
    }
}

#[test]
fn the_kinetic_energy_of_the_ellipsoids_is_that_of_the_body() {
    let session = session(&models().join("free_body.eom"));
    let (scene, x) = scene(&session, "{}");
    let body = &scene.bodies[0];
    // About each world axis through the origin of the frame, which is at rest.
    let mass = value(&session, "mass_matrix", &x);
    let n = session.start().xi.len();
    let origin = scene.frames[body.frame].position;
    let arm: Vector = std::array::from_fn(|k| body.centre[k] - origin[k]);
    let squares: f64 = body.radii.iter().map(|r| r * r).sum();
    for i in 0..3 {
        for j in 0..3 {
            let about_centre: f64 = (0..3)
                .map(|k| {
                    let moment = body.mass / 5.0 * (squares - body.radii[k] * body.radii[k]);
                    moment * body.axes[k][i] * body.axes[k][j]
                })
                .sum();
            let same = if i == j {
                arm.iter().map(|a| a * a).sum()
            } else {
                0.0
            };
            let moved = body.mass * (same - arm[i] * arm[j]);
            // R is the identity at the start, so that body axes coincide with world axes.
            close(about_centre + moved, mass[(3 + i) * n + 3 + j]);
        }
    }
}

#[test]
fn a_spring_is_as_long_as_its_potential_says() {
    let text = "pub system Sprung {
        param k = 70, l = 0.4;
        joint a: revolute [0, 1, 0] moves upper;
        joint b: spherical on upper at [0, 0, -0.7] moves lower;
        body on upper { mass 1; com [0, 0, -0.3]; inertia diag(1, 1, 0.1) about com; }
        body on lower { mass 2; com [0.1, 0, -0.3]; inertia diag(1, 1.1, 0.4) about com; }
        frame hook = pose(identity(3), [0.8, 0.1, 0]);
        spring stiffness k length l from hook to [0.2, 0, -0.5] on lower;
        damper coefficient 2 from [0.1, 0, 0] on upper to [0.5, 1, 0] on world;
    }";
    let session = read(text);
    let (scene, x) = scene(&session, r#"{"coord": {"a": 0.7}}"#);
    let spring = &scene.lines[0];
    let length = distance(spring.points[0], spring.points[1]);
    let potential = value(&session, "potential_energy", &x);
    close(35.0 * (length - 0.4) * (length - 0.4), potential[0]);
    let lower = scene.frames.iter().position(|frame| frame.name == "lower");
    assert_eq!(
        (spring.acts, spring.frames),
        (LineKind::Spring, [None, lower])
    );
    let upper = scene.frames.iter().position(|frame| frame.name == "upper");
    assert_eq!(scene.lines[1].acts, LineKind::Damper);
    assert_eq!(scene.lines[1].frames, [upper, None]);
    assert!(scene.frames.iter().all(|frame| frame.attached));
}

#[test]
fn joints_have_their_axes_and_the_place_from_which_they_slide() {
    let text = "pub system Joints {
        joint lift: prismatic [0, 3, 4] at [1, 0, 0] moves carriage;
        joint cardan: universal [1, 0, 0], [0, 1, 0] on carriage moves wheel;
        body on carriage { mass 1; inertia identity(3) about com; }
        body on wheel { mass 1; inertia identity(3) about com; }
    }";
    let session = read(text);
    let (scene, _) = scene(
        &session,
        r#"{"coord": {"lift": 0.5, "cardan_1": 0.3, "cardan_2": 1.1}}"#,
    );
    let [lift, cardan] = &scene.joints[..] else {
        panic!("two joints");
    };
    assert_eq!((lift.kind, cardan.kind), ("prismatic", "universal"));
    let expected = [
        [1.0, 0.0, 0.0],
        [0.0, 0.6, 0.8],
        [1.0, 0.0, 0.0],
        [0.0, 0.3_f64.cos(), 0.3_f64.sin()],
    ];
    let found = [lift.place, lift.axes[0], cardan.axes[0], cardan.axes[1]];
    for (found, expected) in found.into_iter().zip(expected) {
        assert!(distance(found, expected) < 1e-14, "{found:?}, {expected:?}");
    }
    close(distance(scene.frames[lift.frame].position, lift.place), 0.5);
    assert!(!scene.frames[lift.frame].attached);
}

#[test]
fn rods_and_loops_are_found() {
    let bobs = "pub system Bobs {
        param m = 1, l = 0.5;
        coord p: S1, q: S1;
        velocity v, w;
        rate p = v, q = w;
        let first = [l * p.s, 0, -l * p.c];
        let second = first + [l * q.s, 0, -l * q.c];
        particle mass m at first;
        particle mass m at second;
        gravity [0, 0, -9.81];
    }";
    let (drawn, _) = scene(&read(bobs), r#"{"coord": {"p": 0.3, "q": 0.9}}"#);
    assert_eq!(drawn.rods.len(), 2);
    for [from, to] in &drawn.rods {
        close(distance(*from, *to), 0.5);
    }
    let (closed, _) = scene(&session(&models().join("bricard.eom")), "{}");
    assert!(!closed.loops.is_empty());
    for [one, other] in &closed.loops {
        assert!(distance(*one, *other) < 1e-10, "{one:?} {other:?}");
    }
    // In a plane, component by component.
    let (planar, _) = scene(&session(&models().join("five_bar.eom")), "{}");
    let [[one, other]] = planar.loops[..] else {
        panic!("{:?}", planar.loops);
    };
    assert!(distance(one, other) < 1e-10 && distance(one, [0.0; 3]) > 0.1);
    // A rail closes one component of two points that differ in another one: they do not coincide.
    let rail = "pub system Rail {
        joint a: revolute [0, 1, 0] moves upper;
        joint b: revolute [0, 1, 0] on upper at [0, 0, -0.7] moves lower;
        body on upper { mass 1; inertia diag(1, 1, 0.1) about com; }
        body on lower { mass 2; inertia diag(1, 1.1, 0.4) about com; }
        let tip = position(lower, [0, 0, -0.7]), place = [1, 0, -1];
        loop tip[3] = place[3];
        start a = 0.3, b ~ 1;
    }";
    assert!(scene(&read(rail), "{}").0.loops.is_empty());
}

#[test]
fn scenes_are_plain_data() {
    let session = session(&models().join("cart_pole.eom"));
    let (scene, _) = scene(&session, "{}");
    let json = serde_json::to_value(&scene).expect("json");
    let names: Vec<&String> = json.as_object().expect("an object").keys().collect();
    let expected = [
        "bodies",
        "centre",
        "frames",
        "gravity",
        "joints",
        "lines",
        "loops",
        "particles",
        "rods",
    ];
    assert_eq!(names, expected);
}

/// The position of a point of a frame.
fn at(scene: &Scene, frame: usize, point: Vector) -> Vector {
    let Scene { frames, .. } = scene;
    std::array::from_fn(|k| {
        let row = frames[frame].rotation[k];
        let arm: f64 = row.iter().zip(point).map(|(a, b)| a * b).sum();
        frames[frame].position[k] + arm
    })
}

#[test]
fn a_point_that_is_pulled_comes_to_where_it_can_be() {
    // Two joints, a free body, six joints, a particle on a spring, and loops closed by multipliers; each is pulled to
    // where its motion would take the point.
    for name in [
        "double_pendulum",
        "wing_nut",
        "ur5",
        "elastic_pendulum",
        "four_bar",
        "peaucellier",
    ] {
        let session = session(&models().join(format!("../../examples/gallery/{name}.eom")));
        let start = session.start();
        let drawing = session.drawing();
        let drawing = drawing.unwrap_or_else(|error| panic!("{error}"));
        let drawn = drawing.with_parameters(&start.params);
        let scene = drawn.scene(&start.x);
        let grip = match scene.bodies.last() {
            Some(body) => Grip::Frame(body.frame, [0.02, 0.01, -0.1]),
            None => Grip::Particle(0),
        };
        let place = |scene: &Scene| match grip {
            Grip::Frame(frame, point) => at(scene, frame, point),
            Grip::Particle(particle) => scene.particles[particle].position,
        };
        let run = session.simulate(&start, &Simulation::new(Stepping::until(0.1)));
        let run = RunArrays::of(&run.unwrap_or_else(|error| panic!("{error}")));
        let end = &run.x[run.x.len() - start.x.len()..];
        let target = place(&drawn.scene(end));
        let pulled = session.pull(&start, grip, (target, None));
        let pulled = pulled.unwrap_or_else(|error| panic!("{error}"));
        let there = drawn.scene(&pulled.x);
        let before = distance(place(&scene), target);
        let after = distance(place(&there), target);
        assert!(before > 1e-4, "{name} does not move");
        assert!(after < 1e-2 * before, "{name}: {before} becomes {after}");
        // The reached state is a state of the description: no loop is open.
        let gaps = there.loops.iter().map(|[a, b]| distance(*a, *b));
        let gap = gaps.fold(0.0, f64::max);
        assert!(gap < 1e-9, "{name}: {gap}");
    }
    // A rolling wheel does not move sideways.
    let session = session(&models().join("../../examples/gallery/sleigh.eom"));
    let start = session.start();
    let drawn = session
        .drawing()
        .expect("a drawing")
        .with_parameters(&start.params);
    let from = drawn.scene(&start.x).frames[0].position;
    let target = [from[0] + 0.3, from[1] + 0.2, from[2] + 1.0];
    let pulled = session.pull(&start, Grip::Frame(0, [0.0; 3]), (target, None));
    let to = drawn.scene(&pulled.expect("a state").x).frames[0].position;
    close(to[2], from[2]);
    assert!(distance(to, target) < 1.02, "{to:?}");
    // Seen from above it moves as far as it can roll: the height of the target does not count.
    let seen = session.pull(
        &start,
        Grip::Frame(0, [0.0; 3]),
        (target, Some([0.0, 0.0, 1.0])),
    );
    let seen = drawn.scene(&seen.expect("a state").x).frames[0].position;
    assert!(
        distance(seen, [target[0], target[1], seen[2]]) < 0.25,
        "{seen:?}"
    );
}

#[test]
fn what_has_no_place_is_named() {
    let missing = |session: &Session| {
        session
            .drawing()
            .expect("a drawing")
            .unplaced_parts()
            .to_vec()
    };
    assert_eq!(
        missing(&session(
            &models().join("../../examples/gallery/furuta.eom")
        )),
        [""; 0]
    );
    assert_eq!(
        missing(&session(
            &models().join("../../examples/gallery/four_bar.eom")
        )),
        [""; 0]
    );
    let numbers = read(
        "pub system Numbers {
            param a = 1.2;
            joint p: revolute [0, 1, 0] moves crank { armature 0.1; }
            joint q: revolute [0, 1, 0] at [1.5, 0, 0] moves rocker;
            body on crank { mass 1; com [0, 0, 0.2]; inertia diag(0.1, 0.1, 0.1) about com; }
            kinetic q_dot^2 / 2;
            loop sin(p) = a * sin(q);
        }",
    );
    let said = missing(&numbers);
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said[0].contains("`kinetic`"), "{said:?}");
    assert!(said[1].contains("sin(p) = a * sin(q)"), "{said:?}");
}
