//! Dimensions: descriptions of the gallery with units, wrong ones made from them, conversions, and random expressions.

use hamel_language::algebra::residue_pair::Random;
use hamel_language::lower::build;
use hamel_language::model::Model;
use hamel_language::syntax::ast::{Item, ItemKind, System};
use hamel_language::syntax::{parse_text, parse_tokens, print, read_files};
use hamel_language::units::Unit;
use std::path::Path;

/// Units of the parameters of each mechanism in the gallery.
const GALLERY: &[(&str, &str)] = &[
    ("acrobot", "m1 kg, m2 kg, l1 m, l2 m, g m/s^2, tau N*m"),
    (
        "balancing_robot",
        "m kg, h m, mw kg, a m, b m, g m/s^2, left N*m, right N*m",
    ),
    ("beam", "m kg, l m, k N*m/rad, g m/s^2"),
    (
        "bicycle",
        "w m, c m, lambda rad, g m/s^2, rr m, mr kg, Irx kg*m^2, Iry kg*m^2, mb kg, xb m, zb m, Ibx kg*m^2, Iby kg*m^2, \
         Ibz kg*m^2, Ibxz kg*m^2, mh kg, xh m, zh m, Ihx kg*m^2, Ihy kg*m^2, Ihz kg*m^2, Ihxz kg*m^2, rf m, mf kg, \
         Ifx kg*m^2, Ify kg*m^2, steer N*m",
    ),
    ("biped", "l m, m kg, M kg, g m/s^2"),
    (
        "cart_pendulums",
        "m0 kg, m1 kg, m2 kg, l1 m, l2 m, g m/s^2, F N",
    ),
    ("double_pendulum", "m1 kg, m2 kg, l1 m, l2 m, g m/s^2"),
    ("elastic_pendulum", "m kg, g m/s^2, l m"),
    ("five_bar", "a m, b m, d m, g m/s^2, ma kg, mb kg, tau N*m"),
    ("foucault", "m kg, l m, g m/s^2, Omega rad/s, latitude rad"),
    ("four_bar", "l1 m, l2 m, l3 m, d m, k N/m, g m/s^2"),
    ("furuta", "m1 kg, l1 m, L1 m, m2 kg, l2 m, g m/s^2, tau N*m"),
    (
        "gimbals",
        "C kg*m^2, A kg*m^2, ring kg*m^2, m kg, l m, g m/s^2",
    ),
    ("governor", "m kg, M kg, l m, b m, J kg*m^2, g m/s^2"),
    (
        "gyrocompass",
        "C kg*m^2, A kg*m^2, n rad/s, Omega rad/s, latitude rad, a m",
    ),
    ("heavy_top", "m kg, g m/s^2, l m, A kg*m^2, C kg*m^2"),
    ("hoop_bead", "m kg, a m, M kg, g m/s^2"),
    ("hopper", "M kg, m kg, l m, k N/m, ground N/m, g m/s^2"),
    ("kapitza", "m kg, l m, g m/s^2, a m, Omega rad/s, work J"),
    ("peaucellier", "a m, b m, c m, m kg, g m/s^2"),
    ("pendulum_wave", "m kg, g m/s^2, T s"),
    (
        "quadrotor",
        "m kg, a m, mr kg, J kg*m^2, kappa m, g m/s^2, thrust N",
    ),
    (
        "rattleback",
        "m kg, g m/s^2, h m, a m, b m, c m, Theta kg*m^2",
    ),
    ("reaction_wheels", "M kg, j kg*m^2, u N*m"),
    ("rolling_disk", "m kg, a m, g m/s^2"),
    ("sleigh", "m kg, J kg*m^2, a m"),
    ("slider_crank", "r m, l m, mr kg, mp kg, g m/s^2, gas N"),
    (
        "slung_load",
        "m kg, mL kg, l m, g m/s^2, Jx kg*m^2, Jy kg*m^2, Jz kg*m^2, JL kg*m^2, thrust N, tau N*m",
    ),
    (
        "snakeboard",
        "m kg, l m, J kg*m^2, Jr kg*m^2, Jw kg*m^2, twist rad, steer rad, W rad/s",
    ),
    ("solo12", "tau N*m"),
    ("stewart", "m kg, b m, k N/m, l m, g m/s^2, f N"),
    ("tether", "mu m^3/s^2, m1 kg, m2 kg, k N/m, l m"),
    (
        "tippe_top",
        "m kg, a m, e m, g m/s^2, A kg*m^2, C kg*m^2, mu N*s/m",
    ),
    (
        "trebuchet",
        "M kg, mb kg, m kg, a m, b m, c m, s m, H m, g m/s^2",
    ),
    ("turntable_ball", "m kg, a m, Omega rad/s"),
    ("ur5", "tau N*m, right rad"),
    ("wing_nut", "m kg, J1 kg*m^2, J2 kg*m^2, J3 kg*m^2"),
];

/// Returns a unit from its text, by the parser.
fn unit(text: &str) -> Unit {
    let system = parse_text(&format!("system S {{ param a: [{text}] = 1; }}")).expect("a unit");
    match &system.items[0].kind {
        ItemKind::Param(list) => list[0].unit.clone().expect("declared"),
        _ => panic!("no parameter"),
    }
}

/// Gives a declared name its unit. Returns whether it was found.
fn annotate(items: &mut [Item], name: &str, unit: &Unit) -> bool {
    let mut found = false;
    for item in items {
        match &mut item.kind {
            ItemKind::Param(list)
            | ItemKind::Const(list)
            | ItemKind::Input(list)
            | ItemKind::State(list) => {
                for one in list.iter_mut().filter(|one| one.name.name == name) {
                    one.unit = Some(unit.clone());
                    found = true;
                }
            }
            ItemKind::Repeat(repeat) => found |= annotate(&mut repeat.items, name, unit),
            _ => {}
        }
    }
    found
}

/// Returns a mechanism of the gallery as text, with the units of its parameters.
fn with_units(name: &str, units: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/gallery");
    let text = std::fs::read_to_string(folder.join(format!("{name}.eom"))).expect("readable");
    let mut system = parse_text(&text).expect("right");
    for pair in units.split(", ") {
        let (name, text) = pair.split_once(' ').expect("a name and a unit");
        assert!(annotate(&mut system.items, name, &unit(text)), "{name}");
    }
    print::print_description(&system)
}

fn built(text: &str) -> Result<Model, Vec<hamel_language::diagnostics::Diagnostic>> {
    let system: System = parse_text(text)?;
    build(&system)
}

/// Quantities that the gallery writes as plain factors, with their units.
const FACTORS: &[(&str, &str, &str)] = &[
    ("bicycle", "-5 / rr", "-5 [m/s] / rr"),
    ("four_bar", "0.3 * l2", "0.3 [kg] * l2"),
    ("four_bar", "0.25 * l3", "0.25 [kg] * l3"),
];

/// Returns a mechanism of the gallery with units of its parameters, and of quantities that are plain factors.
fn consistent(name: &str) -> String {
    let units = GALLERY.iter().find(|(other, _)| *other == name);
    let mut text = with_units(name, units.expect("in the table").1);
    for (_, from, to) in FACTORS.iter().filter(|(other, ..)| *other == name) {
        text = edited(&text, from, to);
    }
    text
}

fn edited(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "no {from} in\n{text}");
    text.replacen(from, to, 1)
}

#[test]
fn the_gallery_has_consistent_dimensions() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/gallery");
    let files = std::fs::read_dir(folder).expect("a folder").count();
    assert_eq!(files, GALLERY.len());
    for (name, _) in GALLERY {
        let text = consistent(name);
        let model = built(&text).unwrap_or_else(|errors| panic!("{name}: {errors:#?}"));
        let dimensions = model.dimensions.expect("has units");
        assert_eq!(dimensions.open, [""; 0], "{name}");
        println!(
            "{name}: {} declared, {} inferred",
            dimensions.declared, dimensions.inferred
        );
        let mut read = parse_text(&text).expect("right");
        assert_eq!(print::print_description(&read), text, "{name}");
        read.items.iter_mut().for_each(strip);
        let plain = build(&read).expect("right without units");
        assert_eq!(plain.dimensions, None);
        assert_eq!(plain.defaults, model.defaults, "{name}");
        assert_eq!(plain.start_x, model.start_x, "{name}");
    }
}

/// Removes the units of declarations and of numbers.
fn strip(item: &mut Item) {
    use hamel_language::syntax::ast::visit::{Visit, parts, visit};
    use hamel_language::syntax::ast::{Expr, ExprKind, Ident, Span, Target};
    struct Plain;
    impl Visit for Plain {
        fn declares(&mut self, _: &mut Ident, _: bool) {}
        fn uses(&mut self, _: &mut Ident) {}
        fn target(&mut self, _: &mut Target) {}
        fn place(&mut self, _: &mut Span) {}
        fn expr(&mut self, expr: &mut Expr) {
            if let ExprKind::Quantity(quantity) = &expr.kind {
                *expr = quantity.value.clone();
            }
            parts(expr).into_iter().for_each(|part| self.expr(part));
        }
    }
    visit(item, &mut Plain);
    match &mut item.kind {
        ItemKind::Param(list)
        | ItemKind::Const(list)
        | ItemKind::Input(list)
        | ItemKind::State(list) => list.iter_mut().for_each(|one| one.unit = None),
        ItemKind::Repeat(repeat) => repeat.items.iter_mut().for_each(strip),
        _ => {}
    }
}

#[test]
fn tokens_and_texts_say_the_same() {
    for (name, _) in GALLERY {
        let text = consistent(name);
        let tokens = text.parse().expect("tokens");
        let (_, read) = parse_tokens(tokens);
        assert_eq!(
            read.expect("right"),
            parse_text(&text).expect("right"),
            "{name}"
        );
    }
}

/// Units of random tokens, in all places of units, are read or refused, and print as they read.
#[test]
fn no_unit_panics() {
    const TOKENS: [&str; 22] = [
        "kg", "m", "s", "deg", "rpm", "in", "x", "1", "2", "99", "-", "*", "/", "^", "(", ")", ",",
        "[m]", "0", ";", "fs", "_",
    ];
    let mut random = Random::new(11);
    let mut below = |n: usize| random.bits() as usize % n;
    let mut right = 0;
    for _ in 0..20_000 {
        let mut unit: Vec<&str> = (0..1 + below(7))
            .map(|_| TOKENS[below(TOKENS.len())])
            .collect();
        if below(2) == 0 {
            unit = (0..1 + below(3))
                .flat_map(|_| [TOKENS[below(6)], ["*", "/", "^2 /", "^-1 *"][below(4)]])
                .collect();
            unit.push("m^(2/3)");
        }
        let unit = unit.join(" ");
        let statement = match below(6) {
            0 => format!("param a: [{unit}] = -2 * pi;"),
            1 => format!("coord a: R3 [{unit}];"),
            2 => format!("output a: [{unit}] = 3;"),
            3 => format!("let a = 3 [{unit}] + 2;"),
            4 => format!("const a: vec2 [{unit}] = [1, 2];"),
            _ => format!("velocity a: [{unit}] = rate(q);"),
        };
        let text = format!("system S {{ coord q; {statement} }}");
        if let Ok(system) = parse_text(&text) {
            right += 1;
            let printed = print::print_description(&system);
            let read =
                parse_text(&printed).unwrap_or_else(|errors| panic!("{errors:?}\n{printed}"));
            assert_eq!(read, system, "{printed}");
        }
    }
    assert!(right > 1000, "{right}");
}

/// Small changes of the gallery's mechanisms that make their dimensions wrong.
const TWINS: &[(&str, &str, &str)] = &[
    ("acrobot", "m1: [kg]", "m1: [m]"),
    ("acrobot", "g: [m/s^2]", "g: [m/s]"),
    ("acrobot", "tau: [N*m]", "tau: [N]"),
    ("balancing_robot", "a * wl", "m * wl"),
    ("balancing_robot", "speed - b * turn", "speed - turn"),
    ("balancing_robot", "[x, y, a]", "[x, y, mw]"),
    ("balancing_robot", "mw * a^2 / 4", "mw * a / 4"),
    ("beam", "k: [N*m/rad]", "k: [N/m]"),
    ("beam", "com [l / 2, 0, 0]", "com [l^2 / 2, 0, 0]"),
    ("bicycle", "[w + c, 0, rr]", "[w + mr, 0, rr]"),
    ("bicycle", "sqrt(dr[1]^2 + dr[3]^2)", "sqrt(dr[1]^2 + rr^2)"),
    ("bicycle", "[0, wr, 0], cr)", "[0, rr, 0], cr)"),
    ("bicycle", "roty(lambda)", "roty(w)"),
    (
        "bicycle",
        "generalized force wd = steer",
        "generalized force wd = steer / rr",
    ),
    ("cart_pendulums", "F: [N]", "F: [N*m]"),
    ("elastic_pendulum", "3 * m * g / l", "3 * m * g * l"),
    ("five_bar", "tau: vec2 [N*m]", "tau: vec2 [W]"),
    (
        "foucault",
        "-2 * m * cross(Earth, velocity(bob))",
        "-2 * m * cross(Earth, acceleration(bob))",
    ),
    ("foucault", "cos(latitude)", "cos(l)"),
    ("four_bar", "k: [N/m]", "k: [N*m]"),
    (
        "governor",
        "follows -2 * l * cos(arm)",
        "follows -2 * cos(arm)",
    ),
    ("governor", "diag(3, 3, 1) * J", "diag(3, 3, 1) * m"),
    (
        "gyrocompass",
        "roty(-latitude) * [a, 0, 0]",
        "roty(-latitude) * [C, 0, 0]",
    ),
    ("gyrocompass", "spin_dot = n", "spin_dot = latitude"),
    ("hopper", "min(foot.p[3], 0)", "min(foot.p[3], 1 [s])"),
    ("hopper", "ground * depth^2 / 2", "ground * depth / 2"),
    ("hopper", "stiffness 900", "stiffness 900 [N/m]"),
    ("kapitza", "a * cos(Omega * t)", "a * cos(t)"),
    ("kapitza", "m * g * bob.p[3] - work", "m * g - work"),
    ("kapitza", "dot(v, v) / 2", "norm(v) / 2"),
    ("kapitza", "work: [J] = 0", "work: [J] = 3 [W]"),
    ("pendulum_wave", "T: [s]", "T: [m]"),
    ("quadrotor", "kappa * thrust[i]", "thrust[i]"),
    ("quadrotor", "rotz(pi / 2 * i)", "rotz(a * i)"),
    ("rattleback", "rate r = R * v", "rate r = R * w"),
    ("rattleback", "cross(w, p) = 0", "cross(w, n) = 0"),
    ("rattleback", "k = sqrt(", "k = norm([a, h]) + ("),
    ("reaction_wheels", "[0, 0.55, 0]", "[0, 0.55 [kg], 0]"),
    ("rolling_disk", "[-a * R[3, 1] / h", "[-R[3, 1] / h"),
    ("sleigh", "J: [kg*m^2]", "J: [kg*m]"),
    (
        "slung_load",
        "wrench ([0, 0, thrust], tau)",
        "wrench (tau, [0, 0, thrust])",
    ),
    ("snakeboard", "v + l * w", "v + w"),
    ("snakeboard", "twist * sin(W * t)", "twist * sin(W / t)"),
    ("tether", "mu: [m^3/s^2]", "mu: [m^2/s^2]"),
    ("tether", "mu * m1 / norm(r1)", "mu * m1 / norm(r1)^2"),
    ("tether", "length l", "length m1"),
    ("tippe_top", "mu: [N*s/m]", "mu: [N]"),
    ("tippe_top", "e * R * [0, 0, 1]", "A * R * [0, 0, 1]"),
    ("turntable_ball", "Omega: [rad/s]", "Omega: [m/s]"),
];

#[test]
fn wrong_twins_are_refused_with_both_places() {
    for (name, from, to) in TWINS {
        let text = edited(&consistent(name), from, to);
        let errors = built(&text)
            .err()
            .unwrap_or_else(|| panic!("{name}: {from} → {to} was accepted"));
        let placed = errors.iter().filter(|error| {
            // Errors about dimensions name units in brackets.
            error.message.contains('[')
                && error.span.range().is_some()
                && error.help.is_some()
                && !error.notes.is_empty()
        });
        assert!(placed.count() > 0, "{name}: {from} → {to}: {errors:#?}");
    }
}

/// Descriptions without units, checked by themselves: what they say of masses, lengths and times is consistent, except
/// where quantities are hidden in plain factors, as the angular frequency 2 in `sin(2 * t)`.
#[test]
fn most_descriptions_are_consistent_without_units() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut open = vec![root.join("tests/models"), root.join("examples")];
    let (mut right, mut wrong) = (0, vec![]);
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).expect("a folder");
            open.extend(entries.map(|entry| entry.expect("readable").path()));
        }
        if path.extension().is_none_or(|ending| ending != "eom") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("readable");
        let Some(brace) = text
            .find("system ")
            .and_then(|at| Some(at + text[at..].find('{')?))
        else {
            continue;
        };
        let text = format!("{{ param _unit: [kg] = 1;{}", &text[brace + 1..]);
        let mut system = parse_text(&format!("system S {text}")).expect("right");
        let folder = path.parent().expect("a folder").to_owned();
        let mut open = |name: &str| std::fs::read_to_string(folder.join(name));
        if read_files(&mut system, &mut open).is_err() {
            continue;
        }
        let errors = build(&system).err().unwrap_or_default();
        match errors
            .iter()
            .any(|error| error.site.file().contains("dimensions"))
        {
            true => wrong.push(path),
            false => right += 1,
        }
    }
    assert!(
        right > 100 && 6 * wrong.len() < right,
        "{right} are right, not {wrong:#?}"
    );
}

/// Every kind of statement, with the units of all names that have none in the text, found by hand.
#[test]
fn dimensions_follow_from_every_kind_of_statement() {
    let text = "system All {
    param m: [kg] = 2, gravity_on_site = 9.81, k = 3, d = 0.1, b = 0.2, k_angle = 5, d_angle = 0.3, J = 0.01;
    param length = 0.4, F0 = 2, T0 = 0.3, E0 = 1, P0 = 0.2, decay = 2, chord = 0.3, Theta: sym3 = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    param s: vec3 = [0, 0, 0.1], reach = 0.2, gain = 4, R0 = 3, L0 = 0.2, km = 0.5, Omega = 3, a0 = 0.1, c_air = 0.02;
    const side = 0.3;
    time t;
    fn drag(c, v) = -c * norm(v) * v;
    fn half(a) = a / 2;
    table torque = [(0, 0.4), (100, 0.3)] linear extrapolate hold;
    extern fn lift(alpha, speed) -> 2 = [2 * alpha * speed^2 * chord, 0.1 * speed^2 * chord];
    coord X: SE3, Q: S3, x, y, a: S1;
    velocity v: vec3, w: vec3, o: vec3, x_dot, y_dot, turn;
    rate X.p = X.R * v;
    rate X.R = X.R * hat(w);
    rate Q = qmul(Q, [0, o[1], o[2], o[3]]) / 2;
    rate x = x_dot, y = y_dot, a = turn;
    input u, tau;
    state i = 2 [mA];
    rate i = (5 [V] - R0 * i - km * turn) / L0;
    frame hull = X;
    frame wheel on hull = pose(rot(Q), [side, 0, 0.2]);
    frame slider on hull at [x, y, 0];
    component Rod(mount: frame, long = 250 [mm], heavy) {
        joint turn: revolute [0, 1, 0] on mount at [long, 0, 0] moves rod { damping d_angle; stiffness k_angle; armature J; limit -90 [deg] to 1; }
        particle mass heavy at [0, 0, -long] on rod;
    }
    part rod[n in 1..2] = Rod(slider, heavy = n * 0.1 [kg]);
    joint slide: prismatic [0, 0, 1] on slider moves knob { damping d; max_force 3 [N]; max_speed 2 [m/s]; }
    body on hull { mass m; com s; inertia Theta about com; }
    body on wheel { mass m; inertia m * reach^2 * identity(3) / 2 + outer(s, s) * m about origin; }
    particle mass m / 2 at position(slider);
    particle mass half(m) at position(knob);
    kinetic m * turn^2 * reach^2;
    gravity [0, 0, -gravity_on_site];
    potential E0 * cos(x / reach) + half(k) * y^2;
    dissipation P0 * (turn * t)^2;
    force drag(c_air, velocity(hull)) on hull in world;
    force [lift(X.p[1] / length, velocity(hull)[1])[1], 0, F0] at [0, length, 0] on hull in body;
    torque [0, tau, T0] on hull in body;
    generalized force turn = torque(turn) + km * i, x_dot = gain * u;
    spring stiffness k length length from hull to slider;
    damper coefficient d from hull to [0, 0, 0.1] on slider;
    inerter inertance b from hull to world;
    output angular = vee(X.R.T * rate(X.R)), far = if x < length { x } else { reach };
    output share: [N] = u, thrown = m * velocity(slider), drift = acceleration(slider)[1] - a0 * exp(-decay * t) * sin(Omega * t);
    start X = pose(rotx(20 [deg]), [0, 0, 30 [cm]]), x = 10 [mm], turn = 30 [rpm];
    prescribe rate(y_dot) = a0 * sin(Omega * t);
    loop x = y stabilized decay;
}";
    let model = built(text);
    let dimensions = match model {
        Ok(model) => model.dimensions.expect("has units"),
        Err(errors) => {
            let errors: Vec<String> = errors
                .iter()
                .map(|error| {
                    format!(
                        "{} «{}»",
                        error.message,
                        &text[error.span.range().unwrap_or_default()]
                    )
                })
                .collect();
            panic!("{errors:#?}");
        }
    };
    let of = |names: &str, unit: &str| {
        for name in names.split(' ') {
            assert_eq!(
                dimensions.units.get(name).map(String::as_str),
                Some(unit),
                "{name}"
            );
        }
    };
    of("gravity_on_site a0 drift", "m/s^2");
    of("k", "N/m");
    of("d", "N*s/m");
    of("b", "kg");
    of("k_angle T0 E0 tau", "N*m");
    of("d_angle", "kg*m^2/s");
    of("J Theta", "kg*m^2");
    of("length s reach side x y far", "m");
    of("F0 u share", "N");
    of("gain", "1");
    of("decay Omega w o turn angular", "rad/s");
    of("chord c_air", "kg/m");
    of("v x_dot y_dot", "m/s");
    of("R0", "ohm");
    of("L0", "H");
    of("km", "Wb");
    of("i", "A");
    of("thrown", "kg*m/s");
    assert!(dimensions.open.is_empty(), "{:?}", dimensions.open);
}
