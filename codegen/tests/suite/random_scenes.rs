//! Random scenes are built and also written independently as text, with parentheses around every operation and numbers
//! in other spellings. Both agree, and the printed scene parses to itself.

use crate::common::Random;
use hamel_codegen::scene::{
    Body, Claim, Comparison, CoordKind, Element, Expr, Extrapolation, Interpolation, Joint, Load,
    Parameter, Point, Scene, SceneBuilder, ShapeKind, WORLD, call, choice, in_axes,
};

/// Legal names: keywords of the language where they are allowed, words of generated code, other letters.
const LEGAL_NAMES: [&str; 20] = [
    "a",
    "m",
    "θ",
    "q̇",
    "é",
    "x",
    "xi",
    "S",
    "Ok",
    "f64",
    "core",
    "along",
    "param",
    "length",
    "to",
    "from",
    "link[2]",
    "leg[1].foot",
    "grid[i, k - 1]",
    "__",
];
/// Number of names that a statement can declare.
const DECLARABLE_NAMES: usize = 16;

/// A built part with its text.
type BuiltAndWritten<T> = (T, String);

fn name(random: &mut Random) -> &'static str {
    LEGAL_NAMES[random.below(LEGAL_NAMES.len())]
}

fn word(random: &mut Random) -> &'static str {
    LEGAL_NAMES[random.below(DECLARABLE_NAMES)]
}

/// Returns an exact number in one of several spellings.
fn number(random: &mut Random) -> BuiltAndWritten<Expr> {
    let whole = random.below(2000) as i32;
    let few = random.below(3) as i32;
    match random.below(6) {
        0 => (whole.into(), format!("{whole}")),
        1 => (f64::from(whole).into(), format!("{whole}.000")),
        2 => ((f64::from(few) + 0.5).into(), format!("{few}5e-1")),
        3 => (1e-300.into(), "0.01e-298".into()),
        4 => (f64::MAX.into(), "17976931348623157e292".into()),
        _ => (
            (-whole).into(),
            if whole == 0 {
                "0".into()
            } else {
                format!("(-{whole})")
            },
        ),
    }
}

fn expression(random: &mut Random, depth: usize) -> BuiltAndWritten<Expr> {
    if depth == 0 {
        let name = name(random);
        return match random.below(2) {
            0 => (Expr::name(name), format!("({name})")),
            _ => number(random),
        };
    }
    let next = |random: &mut Random| expression(random, depth - 1);
    let (a, of_a) = next(random);
    let (b, of_b) = next(random);
    match random.below(12) {
        0 => (a + b, format!("({of_a} + {of_b})")),
        1 => (a - &b, format!("({of_a} - {of_b})")),
        2 => (&a * b, format!("({of_a} * {of_b})")),
        3 => (&a / &b, format!("({of_a} / {of_b})")),
        4 => (a.pow(b), format!("({of_a})^({of_b})")),
        5 => (-a, format!("(-{of_a})")),
        6 => (call("hypot", [a, b]), format!("hypot({of_a}, {of_b})")),
        7 => ([a, b].into(), format!("[{of_a}, {of_b}]")),
        8 => {
            let v = Expr::name("v");
            (
                v.entry(a) + v.element(b, 2),
                format!("(v[{of_a}] + v[{of_b}, 2])"),
            )
        }
        9 => {
            let (c, of_c) = next(random);
            let (d, of_d) = next(random);
            let (compared, sign) = [
                (Comparison::Less, "<"),
                (Comparison::AtMost, "<="),
                (Comparison::Greater, ">"),
                (Comparison::AtLeast, ">="),
            ][random.below(4)];
            let text = format!("(if ({of_a}) {sign} ({of_b}) {{ ({of_c}) }} else {{ ({of_d}) }})");
            (choice(a, compared, b, c, d), text)
        }
        10 => {
            let name = word(random);
            let motion = in_axes(call("velocity", [Expr::name(name), a]), "g");
            (
                motion.entry(1),
                format!("((velocity({name}, {of_a}) in g)[1])"),
            )
        }
        _ => (
            2 * Expr::name("X").part("R").part("T") - 1,
            "((2 * (X.R).T) - 1)".into(),
        ),
    }
}

/// Adds a statement of any kind.
fn statement(random: &mut Random, scene: &mut SceneBuilder) -> String {
    let kind = random.below(40);
    stated(kind, random, scene)
}

/// Adds a statement that may be nested.
fn inner(random: &mut Random, scene: &mut SceneBuilder) -> String {
    let alone = [12, 24, 35, 36, 37, 38, 39];
    let kinds: Vec<usize> = (0..40).filter(|kind| !alone.contains(kind)).collect();
    let kind = kinds[random.below(kinds.len())];
    stated(kind, random, scene)
}

fn stated(kind: usize, random: &mut Random, scene: &mut SceneBuilder) -> String {
    let (e, of_e) = expression(random, 2);
    let (f, of_f) = expression(random, 1);
    let (n, p) = (word(random), name(random));
    match kind {
        0 => {
            scene.param_of(n, ShapeKind::Symmetric(2), e);
            format!("param {n}: sym2 = {of_e};")
        }
        1 => {
            scene.constant(n, e);
            format!("const {n} = {of_e};")
        }
        2 => {
            scene.define(n, e);
            format!("let {n} = {of_e};")
        }
        3 => {
            scene.function(
                n,
                &[("b", ShapeKind::Vector(3)), ("c", ShapeKind::Scalar)],
                e,
            );
            format!("fn {n}(b: vec3, c) = {of_e};")
        }
        4 => {
            scene.external(n, &["b", "c"], 2, Some(e));
            format!("extern fn {n}(b, c) -> 2 = {of_e};")
        }
        5 => {
            let points = [(-0.5, 1e-9), (0.25, -2.0)];
            scene.table(n, &points, Interpolation::Pchip, Extrapolation::Error);
            format!("table {n} = [(-0.5, 0.1e-8), (1 / 4, -2)] pchip extrapolate error;")
                .replace("1 / 4", "0.25")
        }
        6 => {
            scene.table_from(n, "a\\\"b.csv", Interpolation::Linear, Extrapolation::Hold);
            format!("table {n} from r#\"a\\\"b.csv\"# linear extrapolate hold;")
        }
        7 => {
            scene.coordinate(n, CoordKind::Euclidean(3));
            format!("coord {n}: R3;")
        }
        8 => {
            scene.coordinate(n, CoordKind::SE3);
            scene.velocity(n, ShapeKind::Vector(2));
            scene.velocity_by(n, ShapeKind::Scalar, e);
            format!("coord {n}: SE3; velocity {n}: vec2; velocity {n} = {of_e};")
        }
        9 => {
            scene.input(n);
            scene.input_of(n, ShapeKind::Matrix(2));
            scene.state(n, ShapeKind::Vector(2), e);
            format!("input {n}; input {n}: mat2; state {n}: vec2 = {of_e};")
        }
        10 => {
            scene.rate(p, e);
            format!("rate {p} = {of_e};")
        }
        11 => {
            scene.constraint(e, f);
            format!("constraint {of_e} = {of_f};")
        }
        12 => {
            scene.time(n);
            scene.prescribe(p, e);
            scene.prescribe_rate(p, f);
            format!("time {n}; prescribe {p} = {of_e}; prescribe rate({p}) = {of_f};")
        }
        13 => {
            scene.inactive([e]);
            scene.independent([Expr::name("v").entry(1), f]);
            format!("inactive {of_e}; independent v[1], {of_f};")
        }
        14 => {
            scene.nonholonomic(&e, &f);
            scene.nonholonomic_stabilized(&e, 0, &f);
            format!("nonholonomic {of_e} = {of_f}; nonholonomic {of_e} = 0 stabilized {of_f};")
        }
        15 => {
            scene.closed_loop(&e, &f);
            scene.closed_loop_stabilized(&e, 0, &f);
            format!("loop {of_e} = {of_f}; loop {of_e} = 0 stabilized {of_f};")
        }
        16 => {
            scene.frame(n, WORLD, &e);
            scene.frame(n, p, e);
            format!("frame {n} = {of_e}; frame {n} on {p} = {of_e};")
        }
        17 => {
            scene.joint(
                Joint::universal(n, e, f)
                    .on(p)
                    .moves(n)
                    .follows(2)
                    .limit(-1, 1),
            );
            format!(
                "joint {n}: universal {of_e}, {of_f} on {p} moves {n} follows 2 {{ limit (-1) to 1; }}"
            )
        }
        18 => {
            let joint = Joint::cylindrical(n, [0, 0, 1])
                .at(e)
                .max_speed(&f)
                .max_force(f);
            scene.joint(
                joint
                    .moves("g")
                    .armature(1)
                    .stiffness(2)
                    .rest(3)
                    .damping(4)
                    .force(5),
            );
            format!(
                "joint {n}: cylindrical [0, 0, 1] at {of_e} moves g {{ max_speed {of_f}; max_force {of_f}; \
                 armature 1; stiffness 2; rest 3; damping 4; force 5; }}"
            )
        }
        19 => {
            scene.joint(Joint::spherical_quaternion(n));
            scene.joint(Joint::planar("b", [0.5, 0.0, 1.0]).moves("c"));
            format!("joint {n}: spherical S3 moves {n}_frame; joint b: planar [0.5, 0, 1] moves c;")
        }
        20 => {
            for joint in [Joint::spherical(n), Joint::free(n), Joint::fixed(n)] {
                scene.joint(joint.moves("g").on(WORLD));
            }
            format!(
                "joint {n}: spherical moves g; joint {n}: free moves g; joint {n}: fixed moves g;"
            )
        }
        21 => {
            for joint in [
                Joint::revolute(n, &e),
                Joint::continuous(n, &e),
                Joint::prismatic(n, &e),
            ] {
                scene.joint(joint.moves("g"));
            }
            let one = |kind: &str| format!("joint {n}: {kind} {of_e} moves g;");
            ["revolute", "continuous", "prismatic"].map(one).concat()
        }
        22 => {
            scene.body(Body::on(p).mass(&e).com(&f).inertia_about_origin(&e));
            scene.body(Body::on(p).inertia_about_com(e));
            format!(
                "body on {p} {{ mass {of_e}; com {of_f}; inertia {of_e} about origin; }} \
                 body on {p} {{ inertia {of_e} about com; }}"
            )
        }
        23 => {
            scene.particle(&e, &f);
            scene.particle_on(p, e, f);
            format!("particle mass {of_e} at {of_f}; particle mass {of_e} at {of_f} on {p};")
        }
        24 => {
            scene.kinetic(&e);
            scene.potential(&e);
            scene.gravity(&e);
            scene.dissipation(e);
            format!("kinetic {of_e}; potential {of_e}; gravity {of_e}; dissipation {of_e};")
        }
        25 => {
            scene.load(Load::force(e, p).at(f).from("g").in_axes_of(WORLD));
            format!("force {of_e} at {of_f} on {p} from g in world;")
        }
        26 => {
            scene.load(Load::wrench(e, f, p).in_axes_of("g"));
            format!("wrench ({of_e}, {of_f}) on {p} in g;")
        }
        27 => {
            scene.load(Load::torque(e, p).at(f));
            format!("torque {of_e} on {p} in body;")
        }
        28 => {
            let ends = || (Point::of(p, &f), Point::origin(WORLD));
            scene.element(Element::spring_of_length(&e, &f, ends()));
            scene.element(Element::cable(&e, &f, ends().0, ends().1));
            scene.element(Element::push(e, ends().0, ends().1));
            format!(
                "spring stiffness {of_e} length {of_f} from {of_f} on {p} to world; \
                 cable stiffness {of_e} length {of_f} from {of_f} on {p} to world; \
                 force {of_e} from {of_f} on {p} to world;"
            )
        }
        29 => {
            scene.element(Element::spring(&e, &f));
            scene.element(Element::damper(&e, &f));
            scene.element(Element::inerter(&e, f));
            format!(
                "spring stiffness {of_e} on {of_f}; damper coefficient {of_e} on {of_f}; \
                 inerter inertance {of_e} on {of_f};"
            )
        }
        30 => {
            scene.generalized_force(p, e);
            format!("generalized force {p} = {of_e};")
        }
        31 => {
            scene.start(p, e);
            scene.guess("X.p[3]", f);
            format!("start {p} = {of_e}; start X.p[3] ~ {of_f};")
        }
        32 => {
            scene.output(n, e);
            format!("output {n} = {of_e};")
        }
        33 => {
            scene.invariant("e", e + 1, [(Expr::name("F").entry(2), f)]);
            scene.invariant("energy", Expr::name("energy"), []);
            format!("invariant e = ({of_e} + 1) when F[2] = {of_f}; invariant energy;")
        }
        34 => {
            scene.claim(
                Claim::linear_momentum()
                    .of(p)
                    .along(&e)
                    .when(Expr::name("F"), 0),
            );
            let about = Claim::angular_momentum().of(p).about(f).along(e);
            scene.claim(about.named("l"));
            format!(
                "invariant linear_momentum of {p} along {of_e} when F = 0; \
                 invariant l = angular_momentum of {p} about {of_f} along {of_e};"
            )
        }
        35 => {
            scene.claim(Claim::energy().named("e"));
            scene.generate(&["accel", "energy"]);
            scene.generate_jacobian(p, WORLD);
            format!("invariant e = energy; generate accel, energy; generate jacobian {p} in world;")
        }
        36 => {
            scene.include("legs/a b.eom");
            "include \"legs/a b.eom\";".into()
        }
        37 => {
            let mut text = String::new();
            scene.repeat("i", 1, f, |scene| text = inner(random, scene));
            format!("for i in 1..{of_f} {{ {text} }}")
        }
        38 => {
            let mut text = String::new();
            let parameters = [
                Parameter::frame("base"),
                Parameter::shaped("s", ShapeKind::Vector(3)).or(e),
                Parameter::value("k"),
            ];
            scene.component("C", parameters, |scene| text = inner(random, scene));
            format!("component C(base: frame, s: vec3 = {of_e}, k) {{ {text} }}")
        }
        _ => {
            // Names created at run time.
            let argument = format!("k{}", random.below(9));
            scene.part(n, "C", [(argument.as_str(), e)]);
            scene.part("none", "C", []);
            scene.parts(n, ("i", 1, 3), "C", [("k", f)]);
            format!(
                "part {n} = C({argument} = {of_e}); part none = C(); part {n}[i in 1..3] = C(k = {of_f});"
            )
        }
    }
}

#[test]
fn what_is_built_at_random_is_what_the_text_says() {
    crate::common::attack(40, 4_000, |seed| {
        let random = &mut Random::new(seed);
        let mut scene = Scene::builder("Θ2");
        let doc = ["", "  two blanks  ", "\t/ tab", "\"quotes\" and \\"][random.below(4)];
        scene.doc(doc);
        scene.public(seed % 2 == 0);
        let public = if seed % 2 == 0 { "pub" } else { "" };
        let mut text = format!("#[doc = {:?}] {public} system Θ2 {{\n", format!(" {doc}"));
        for _ in 0..1 + random.below(6) {
            text += &statement(random, &mut scene);
            text += "\n";
        }
        text += "}";
        let read = match Scene::parse(&text) {
            Ok(read) => read,
            Err(error) => return vec![format!("seed {seed}: {error}")],
        };
        match scene.build() {
            Ok(built) if built != read => vec![format!("seed {seed}: {built}\nis not\n{text}")],
            Ok(built) => {
                let again = Scene::parse(&built.to_string());
                let same = again
                    .is_ok_and(|again| again == built && again.to_string() == built.to_string());
                let fault = || format!("seed {seed} does not read back:\n{built}");
                (!same).then(fault).into_iter().collect()
            }
            Err(error) => vec![format!("seed {seed}: {error}")],
        }
    });
}
