//! Repetition, components and parts are equivalent to the statements written out, and agree with the Newton-Euler
//! equations.

use crate::common::{Random, difference, generated, value, without_comments};
use crate::tree::{Kind, Link, Tree};
use hamel_codegen::builder::written;
use hamel_codegen::generate::{Generated, from_file, from_text};
use hamel_codegen::render::render;
use hamel_codegen::reuse::expand;
use hamel_codegen::syntax::ast::{Item, ItemKind};
use hamel_codegen::syntax::parse_text;
use std::fmt::Write;
use std::path::{Path, PathBuf};

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/models")
}

/// Returns a description with its included files.
fn model(name: &str) -> (String, Generated) {
    let folder = models().join(match name {
        "hexapod.eom" => "reuse",
        _ => "",
    });
    let text = std::fs::read_to_string(folder.join(name)).expect("readable");
    let open = &mut |file: &str| std::fs::read_to_string(folder.join(file));
    let system = from_file(&text, open);
    let system = system.unwrap_or_else(|errors| panic!("{}", render(&errors, name, &text, false)));
    (text, system)
}

/// Returns generated code without parts that depend on the spelling of the description.
fn code(system: &Generated) -> String {
    let mut system = system.clone();
    system.hash = 0;
    without_comments(&written(&system, "x.eom").expect("Rust"))
}

/// Returns the statements of a rope, written by a loop of this program.
fn rope(n: usize) -> String {
    let mut text = String::from(
        "/// A rope of `n` links that hangs from the ceiling, swings in a plane, and is stiff in bending.
pub system Rope {
    const n = {n};
    param m = 0.3, l = 0.6, g = 9.81;
    param k = 2, d = 0.05;
    frame link_0 = pose(identity(3), [0, 0, l]);
",
    )
    .replace("{n}", &n.to_string());
    for i in 1..=n {
        let before = i - 1;
        let _ = writeln!(
            text,
            "    joint q_{i}: revolute [0, 1, 0] on link_{before} at pose(identity(3), [0, 0, -l]) moves link_{i} {{ damping d; stiffness k; }}
    body on link_{i} {{ mass m; com [0, 0, -l / 2]; inertia diag(m * l^2 / 12, m * l^2 / 12, 0) about com; }}
    start q_{i} = 0.3 / {i};"
        );
    }
    let _ = writeln!(
        text,
        "    gravity [0, 0, -g];
    input F;
    force [F, 0, 0] at [0, 0, -l] on link_{n} in world;
    output tip = position(link_{n}, [0, 0, -l]);
    output bend_1 = q_{n}, bend_2 = q_{n}_dot;
}}"
    );
    text
}

#[test]
fn a_rope_is_what_is_written_out() {
    let (text, system) = model("rope.eom");
    assert!(code(&system) == code(&generated(&rope(8))), "other code");
    for n in [1, 2, 3, 17] {
        let other = text.replace("const n = 8", &format!("const n = {n}"));
        assert!(
            code(&generated(&other)) == code(&generated(&rope(n))),
            "{n}"
        );
    }
}

/// Returns the statements of the hexapod without components.
fn hexapod() -> String {
    let mut text = String::from(
        "/// A body that floats on six legs of one kind, three on each side.
pub system Hexapod {
    joint base: free moves hull;
    body on hull { mass 2; inertia diag(0.01, 0.02, 0.025) about com; }
    gravity [0, 0, -9.81];
    const coxa_length = 0.05, femur_length = 0.1, tibia_length = 0.15;
",
    );
    for place in 1..=3 {
        for side in [1, -1] {
            let i: i32 = if side == 1 { place } else { place + 3 };
            let (x, y) = (
                format!("0.12 * ({place} - 2)"),
                if side == 1 { "0.08" } else { "-0.08" },
            );
            let quarter = if side == 1 { "pi / 2" } else { "-pi / 2" };
            let rod = |mass: f64, length: f64| {
                format!(
                    "mass {mass}; com [{length} / 2, 0, 0]; inertia diag(0, {mass} * {length}^2 / 12, {mass} * {length}^2 / 12) about com;"
                )
            };
            let (coxa, femur, tibia) = (rod(0.1, 0.05), rod(0.15, 0.1), rod(0.08, 0.15));
            let _ = writeln!(
                text,
                "    frame mount_{i} on hull = pose(rotz({quarter}), [{x}, {y}, 0]);
    param leg_{i}_stance = 0.6;
    input leg_{i}_hip_tau, leg_{i}_knee_tau, leg_{i}_foot_tau;
    joint leg_{i}_hip: revolute [0, 0, {side}] on mount_{i} moves leg_{i}_coxa {{ damping 0.02; armature 0.001; force leg_{i}_hip_tau; limit -0.8 to 0.8; }}
    joint leg_{i}_knee: revolute [0, 1, 0] on leg_{i}_coxa at pose(identity(3), [0.05, 0, 0]) moves leg_{i}_femur {{ damping 0.02; armature 0.001; force leg_{i}_knee_tau; }}
    joint leg_{i}_foot: revolute [0, 1, 0] on leg_{i}_femur at pose(identity(3), [0.1, 0, 0]) moves leg_{i}_tibia {{ damping 0.02; armature 0.001; force leg_{i}_foot_tau; }}
    body on leg_{i}_coxa {{ {coxa} }}
    body on leg_{i}_femur {{ {femur} }}
    body on leg_{i}_tibia {{ {tibia} }}
    spring stiffness 0.5 on leg_{i}_foot - leg_{i}_stance;
    output leg_{i}_tip = position(leg_{i}_tibia, [0.15, 0, 0]);
    start leg_{i}_knee = -0.4, leg_{i}_foot = 1.2;"
            );
        }
    }
    text + "
    spring stiffness 40 length 0.15 from [0.02, 0, 0] on leg_1_femur to [0.02, 0, 0] on leg_2_femur;
    start base_r = [0, 0, 0.2], leg_3_hip = 0.2, leg_6_hip_dot = -0.3;
    output reach = norm(leg_1_tibia.p - leg_4_tibia.p);
}"
}

#[test]
fn a_hexapod_is_what_is_written_out() {
    let (_, system) = model("hexapod.eom");
    assert!(code(&system) == code(&generated(&hexapod())), "other code");
}

/// Compares F, M and the energy of a tree with the recursive Newton-Euler algorithm, and checks that ξ̇ solves F = 0.
fn obeys_newton(system: &Generated, links: &[Link], seed: u64, close: f64) {
    let mut random = Random::new(seed);
    let n = system.program.n;
    for _ in 0..3 {
        let x = random.configuration(&system.program.blocks);
        let [xi, dot] = [(); 2].map(|()| random.numbers(n));
        let u = vec![0.0; system.program.m];
        let tree = Tree::new(links, &x, &xi);
        let of = |name: &str, dot: &[f64]| value(system, name, [&x, &xi, &u, dot]);
        let apart = difference(&tree.needed(&dot, 1.0), &of("inverse_dynamics", &dot));
        assert!(apart < close, "inverse dynamics {apart:e}");
        let apart = difference(&[tree.energy()], &of("energy", &dot));
        assert!(apart < close, "energy {apart:e}");
        let motion = of("accel", &dot);
        let left = tree.needed(&motion, 1.0);
        let size = motion.iter().fold(1.0, |most: f64, a| most.max(a.abs()));
        let apart = left.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        assert!(apart < close * size, "motion {apart:e} of {size:e}");
    }
}

/// Returns a chain of hinges about alternating axes: links for the Newton-Euler algorithm, and a text with `for`.
fn chain(n: usize) -> (Vec<Link>, String) {
    let axes = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
    let mut links: Vec<Link> = Vec::new();
    for i in 0..n {
        let place = if i == 0 { [0.0; 3] } else { [0.1, -0.05, -0.6] };
        let (com, moments) = ([0.1, 0.02, -0.3], [0.21, 0.32, 0.27]);
        let link = Link::body(Kind::Revolute, i.checked_sub(1), place, 0.5, com, moments);
        links.push(link.about(axes[i % 2]));
    }
    let text = format!(
        "system Chain {{
    const n = {n};
    frame link[0] = pose(identity(3), [-0.1, 0.05, 0.6]);
    for i in 1..n {{
        joint q[i]: revolute [0, (1 + (-1)^i) / 2, (1 - (-1)^i) / 2] on link[i - 1] at pose(identity(3), [0.1, -0.05, -0.6]) moves link[i];
        body on link[i] {{ mass 0.5; com [0.1, 0.02, -0.3]; inertia diag(0.21, 0.32, 0.27) about com; }}
    }}
    gravity [0.5, -0.25, -9.81];
    generate accel, inverse_dynamics, energy;
}}"
    );
    (links, text)
}

#[test]
fn chains_of_any_length_obey_newton() {
    for n in [1, 2, 3, 6, 12] {
        let (links, text) = chain(n);
        obeys_newton(&generated(&text), &links, n as u64, 1e-10);
    }
}

/// A rope of a hundred links, in a plane like the ropes of the fixture, agrees with the Newton-Euler equations.
#[test]
fn a_hundred_links_obey_newton() {
    let moments = [0.02 / 12.0, 0.02 / 12.0, 0.0];
    let mut links: Vec<Link> = Vec::new();
    for i in 0..100_usize {
        let place = if i == 0 { [0.0; 3] } else { [0.0, 0.0, -0.5] };
        let com = [0.0, 0.0, -0.25];
        let link = Link::body(Kind::Revolute, i.checked_sub(1), place, 0.08, com, moments);
        links.push(link.about([0.0, 1.0, 0.0]));
    }
    let text = "system Rope {
    const n = 100, l = 0.5;
    frame link[0] = pose(identity(3), [0, 0, l]);
    for i in 1..n {
        joint q[i]: revolute [0, 1, 0] on link[i - 1] at pose(identity(3), [0, 0, -l]) moves link[i];
        body on link[i] { mass 0.08; com [0, 0, -l / 2]; inertia diag(0.02, 0.02, 0) / 12 about com; }
    }
    gravity [0.5, -0.25, -9.81];
    generate accel, inverse_dynamics, energy;
}";
    let system = generated(text);
    assert_eq!(system.program.n, 100);
    obeys_newton(&system, &links, 0x100, 1e-8);
}

/// Six legs of two joints on a floating body: parts of a component agree with the Newton-Euler equations.
#[test]
fn legs_obey_newton() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let body = |kind, parent, place, mass, com, moments| {
        Link::body(kind, parent, place, mass, com, moments)
    };
    let mut links = vec![body(
        Kind::Free,
        None,
        [0.0; 3],
        2.0,
        [0.0; 3],
        [0.01, 0.02, 0.025],
    )];
    for i in 1..=6 {
        let (x, y) = (0.1 * f64::from(i), 0.08);
        let turns = if i > 3 { -quarter } else { quarter };
        let hip = body(
            Kind::Revolute,
            Some(0),
            [x, y, 0.0],
            0.2,
            [0.02, 0.0, 0.01],
            [0.1, 0.2, 0.15],
        );
        let parent = Some(links.len());
        links.push(hip.turned(turns));
        let length = 0.1 + 0.01 * f64::from(i);
        let knee = body(
            Kind::Revolute,
            parent,
            [length, 0.0, 0.0],
            0.1,
            [0.05, 0.0, 0.0],
            [0.01, 0.02, 0.03],
        );
        links.push(knee.about([0.0, 1.0, 0.0]));
    }
    let text = "system Legs {
    component Shin(thigh: frame, length) {
        joint knee: revolute [0, 1, 0] on thigh at pose(identity(3), [length, 0, 0]) moves shin;
        body on shin { mass 0.1; com [0.05, 0, 0]; inertia diag(0.01, 0.02, 0.03) about com; }
    }
    component Leg(base: frame, x, turn = 1, y = 0.08) {
        joint hip: revolute [0, 0, 1] on base at pose(rotz(turn * pi / 2), [x, y, 0]) moves thigh;
        body on thigh { mass 0.2; com [0.02, 0, 0.01]; inertia diag(0.1, 0.2, 0.15) about com; }
        part lower = Shin(thigh, x / 10 + 0.1);
    }
    joint base: free moves hull;
    body on hull { mass 2; inertia diag(0.01, 0.02, 0.025) about com; }
    gravity [0.5, -0.25, -9.81];
    part leg[i in 1..3] = Leg(hull, 0.1 * i);
    part leg[i in 4..6] = Leg(hull, x = 0.1 * i, turn = -1);
    generate accel, inverse_dynamics, energy;
}";
    let system = generated(text);
    let names: Vec<&str> = system
        .model
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(names[..3], ["base", "leg_1_hip", "leg_1_lower_knee"]);
    obeys_newton(&system, &links, 6, 1e-10);
}

/// Descriptions without repetition are unchanged.
#[test]
fn nothing_else_is_changed() {
    let mut count = 0;
    for folder in ["", "multibody", "tabled", "external"] {
        for entry in std::fs::read_dir(models().join(folder)).expect("models") {
            let path = entry.expect("an entry").path();
            if path.extension().is_none_or(|ending| ending != "eom") {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("readable");
            let system = parse_text(&text).expect("a description");
            let repeats =
                |item: &Item| matches!(item.kind, ItemKind::Repeat(_) | ItemKind::Part(_));
            if system.items.iter().any(repeats) {
                continue;
            }
            let after = expand(&system).map_err(|errors| render(&errors, "", &text, false));
            let after = after.expect("a description");
            assert_eq!(after.system, system, "{}", path.display());
            assert!(after.warnings.is_empty());
            count += 1;
        }
    }
    assert!(count > 70, "{count} models");
}

/// Returns the code of a system with these statements.
fn of(statements: &str) -> String {
    let text = format!("system S {{ {statements} }}");
    let system = from_text(&text);
    code(&system.unwrap_or_else(|errors| panic!("{}", render(&errors, "S", &text, false))))
}

/// Pairs of equivalent statements.
#[test]
fn what_is_repeated_is_what_is_written_out() {
    for (short, long) in [
        (
            // Counters within counters, ranges by counters and constants, indices of several.
            "const n = 3, first = n - 2;
             for i in first..n {
                 for k in i..n { param a[i, k] = i + 10 * k; }
                 coord q[i]; velocity w[i]; rate q[i] = w[i];
                 kinetic a[i, n] * w[i]^2 / 2;
             }
             potential a[1, 2] * q[1] * q[2] + a[2, 2] * q[3]^2;
             output e[2 * n - 4] = q[first] + a[1, 1];",
            "const n = 3, first = n - 2;
             param a_1_1 = 1 + 10 * 1; param a_1_2 = 1 + 10 * 2; param a_1_3 = 1 + 10 * 3;
             coord q_1; velocity w_1; rate q_1 = w_1; kinetic a_1_3 * w_1^2 / 2;
             param a_2_2 = 2 + 10 * 2; param a_2_3 = 2 + 10 * 3;
             coord q_2; velocity w_2; rate q_2 = w_2; kinetic a_2_3 * w_2^2 / 2;
             param a_3_3 = 3 + 10 * 3;
             coord q_3; velocity w_3; rate q_3 = w_3; kinetic a_3_3 * w_3^2 / 2;
             potential a_1_2 * q_1 * q_2 + a_2_2 * q_3^2;
             output e_2 = q_1 + a_1_1;",
        ),
        (
            // Names of a component hide those of the description, others are visible; functions, tables and constants
            // of a component are local to it.
            "param m = 2, k = 3;
             fn twice(a) = 2 * a;
             component Mass(x0, stiff = k) {
                 const half = 1/2;
                 param m = 5;
                 fn thrice(a) = 3 * a;
                 table curve = [(0, 0), (1, x0)] linear extrapolate hold;
                 joint x: prismatic [1, 0, 0] moves cart;
                 body on cart { mass half * m; }
                 potential twice(stiff) * x^2 + thrice(k) * curve(x)^2;
                 start x = x0;
             }
             part a = Mass(1);
             part b = Mass(x0 = -2, stiff = m);
             output y = a.x * b.x_dot + m + a.m + a.half;",
            "param m = 2, k = 3;
             const a_half = 1/2;
             param a_m = 5;
             joint a_x: prismatic [1, 0, 0] moves a_cart;
             body on a_cart { mass a_half * a_m; }
             table a_curve = [(0, 0), (1, 1)] linear extrapolate hold;
             potential 2 * k * a_x^2 + 3 * k * a_curve(a_x)^2;
             start a_x = 1;
             const b_half = 1/2;
             param b_m = 5;
             joint b_x: prismatic [1, 0, 0] moves b_cart;
             body on b_cart { mass b_half * b_m; }
             table b_curve = [(0, 0), (1, -2)] linear extrapolate hold;
             potential 2 * m * b_x^2 + 3 * k * b_curve(b_x)^2;
             start b_x = -2;
             output y = a_x * b_x_dot + m + a_m + a_half;",
        ),
        (
            // A frame argument of a component, springs between parts, loads on them.
            "component Rod(tip: frame) {
                 frame tip on rod = pose(identity(3), [1, 0, 0]);
                 body on rod { mass 1; com [0.5, 0, 0]; inertia diag(0, 1, 1) / 12 about com; }
             }
             joint q: revolute [0, 1, 0] moves knee;
             frame end on knee = pose(identity(3), [0, 0, 0]);
             part one = Rod(end);
             joint p: planar [0, 1, 0] moves loose;
             frame free on loose = pose(identity(3), [0, 0, 0]);
             part two = Rod(tip = free);
             spring stiffness 3 from one.rod to [0.5, 0, 0] on two.rod;
             damper coefficient 2 from [1, 0, 0] on one.rod to two.rod;
             input F: vec3;
             force F at [0.2, 0, 0] on two.rod from one.rod in one.rod;
             torque F on one.rod in two.rod;
             output v = velocity(two.rod, [0, 1, 0], one.rod) + two.rod.R * one.rod.p;",
            "joint q: revolute [0, 1, 0] moves knee;
             frame end on knee = pose(identity(3), [0, 0, 0]);
             frame end on one_rod = pose(identity(3), [1, 0, 0]);
             body on one_rod { mass 1; com [0.5, 0, 0]; inertia diag(0, 1, 1) / 12 about com; }
             joint p: planar [0, 1, 0] moves loose;
             frame free on loose = pose(identity(3), [0, 0, 0]);
             frame free on two_rod = pose(identity(3), [1, 0, 0]);
             body on two_rod { mass 1; com [0.5, 0, 0]; inertia diag(0, 1, 1) / 12 about com; }
             spring stiffness 3 from one_rod to [0.5, 0, 0] on two_rod;
             damper coefficient 2 from [1, 0, 0] on one_rod to two_rod;
             input F: vec3;
             force F at [0.2, 0, 0] on two_rod from one_rod in one_rod;
             torque F on one_rod in two_rod;
             output v = velocity(two_rod, [0, 1, 0], one_rod) + two_rod.R * one_rod.p;",
        ),
        (
            // Joints of all kinds in an array, with the suffixes of their coordinates and velocities; parts of vectors.
            "for i in 1..2 {
                 joint a[i]: free moves f[i];
                 joint b[i]: universal [1, 0, 0], [0, 1, 0] on f[i] moves g[i];
                 joint c[i]: continuous [0, 0, 1] on g[i] moves h[i];
                 body on h[i] { mass i; inertia diag(1, 2, 3); }
                 body on f[i] { mass i; inertia diag(1, 2, 3); }
                 body on g[i] { mass i; inertia diag(1, 2, 3); }
             }
             start a[2]_r = [1, 2, 3], b[1]_2 = 0.5, c[2].c = 0.6, c[2].s = 0.8, a[1]_w = [1, 0, 0];
             generalized force b[2]_1_dot = -b[2]_1_dot * c[1].s;
             output p = a[1]_v[2] * pull;
             param pull = 1;
             potential pull * a[1]_r[3] + pull * a[2]_R[1, 2];
             prescribe rate(c[1]_dot) = pull;
             generate accel, p;",
            "joint a_1: free moves f_1;
             joint b_1: universal [1, 0, 0], [0, 1, 0] on f_1 moves g_1;
             joint c_1: continuous [0, 0, 1] on g_1 moves h_1;
             body on h_1 { mass 1; inertia diag(1, 2, 3); }
             body on f_1 { mass 1; inertia diag(1, 2, 3); }
             body on g_1 { mass 1; inertia diag(1, 2, 3); }
             joint a_2: free moves f_2;
             joint b_2: universal [1, 0, 0], [0, 1, 0] on f_2 moves g_2;
             joint c_2: continuous [0, 0, 1] on g_2 moves h_2;
             body on h_2 { mass 2; inertia diag(1, 2, 3); }
             body on f_2 { mass 2; inertia diag(1, 2, 3); }
             body on g_2 { mass 2; inertia diag(1, 2, 3); }
             start a_2_r = [1, 2, 3], b_1_2 = 0.5, c_2.c = 0.6, c_2.s = 0.8, a_1_w = [1, 0, 0];
             generalized force b_2_1_dot = -b_2_1_dot * c_1.s;
             output p = a_1_v[2] * pull;
             param pull = 1;
             potential pull * a_1_r[3] + pull * a_2_R[1, 2];
             prescribe rate(c_1_dot) = pull;
             generate accel, p;",
        ),
        (
            // Arguments are expressions, not text: signs and sums keep their precedence.
            "component A(s, t = s0) { coord q; velocity w; rate q = w; kinetic w^2; potential -s^2 * q - 2 * t * q; }
             const s0 = 4;
             param k = 2;
             part a = A(-3);
             part b = A(k + 1, -k);",
            "const s0 = 4;
             param k = 2;
             coord a_q; velocity a_w; rate a_q = a_w; kinetic a_w^2; potential -(-3)^2 * a_q - 2 * s0 * a_q;
             coord b_q; velocity b_w; rate b_q = b_w; kinetic b_w^2; potential -(k + 1)^2 * b_q - 2 * (-k) * b_q;",
        ),
    ] {
        let (found, wanted) = (of(short), of(long));
        let mut lines = found.lines().zip(wanted.lines());
        let other = lines.find(|(found, wanted)| found != wanted);
        assert!(found == wanted, "{other:?} of\n{short}");
    }
}

/// Names are independent of other statements.
#[test]
fn names_stay_when_something_is_added() {
    let text = "component Leg(m) { joint x: prismatic [1, 0, 0] moves f; body on f { mass m; } output y = x; }
        part leg[i in 1..2] = Leg(i);
        param k = 1; potential k * leg[1].x * leg[2].x;";
    let names = |text: &str| {
        let system = generated(&format!("system S {{ {text} }}"));
        let model = system.model;
        let coordinates = model.coordinates.iter().map(|c| c.name.clone());
        let outputs = model.outputs.iter().map(|output| output.0.clone());
        coordinates.chain(outputs).collect::<Vec<String>>()
    };
    let before = names(text);
    assert_eq!(before, ["leg_1_x", "leg_2_x", "leg_1_y", "leg_2_y"]);
    let after = names(&format!(
        "part first = Leg(3); param a = 1; potential a * first.x; {text}"
    ));
    assert!(before.iter().all(|name| after.contains(name)), "{after:?}");
}

/// The example of the book is correct.
#[test]
fn the_book_shows_a_description() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/book/src/mechanisms.md");
    let page = std::fs::read_to_string(path).expect("a page");
    let mut blocks = page.split("```eom\n").skip(1);
    let block = blocks
        .find(|block| block.contains("component Rope"))
        .expect("the swing");
    let text = block.split("```").next().expect("its text");
    let system = generated(text);
    assert_eq!(system.program.n, 8);
    let warnings = &system.model.warnings;
    assert!(warnings.is_empty(), "{warnings:?}");
    let name = |at: usize| system.model.joints[at].name.as_str();
    assert_eq!((name(0), name(5)), ("rope_1_q_1", "rope_2_q_2"));
}
