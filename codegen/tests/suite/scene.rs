//! Scenes: printing and parsing are inverse, and a built scene equals the parsed one.

use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::emit::rust_items;
use hamel_codegen::scene::{
    Body, CoordKind, Element, Expr, Extrapolation, Interpolation, Joint, Load, Parameter, Point,
    Scene, SceneError, ShapeKind, WORLD, call, cos, diagonal, if_less, in_axes, pose, shifted, sin,
};
use std::path::Path;

/// Returns all correct descriptions of the repository.
fn descriptions() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = [
        "tests/models",
        "tests/models/reuse",
        "tests/models/external",
        "examples/models",
        "examples",
    ];
    let files = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(root.join(folder)));
    let paths = files.flatten().map(|entry| entry.expect("an entry").path());
    let mut all: Vec<(String, String)> = paths
        .filter(|path| path.extension().is_some_and(|extension| extension == "eom"))
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("readable");
            (path.display().to_string(), text)
        })
        .collect();
    all.sort();
    all
}

#[test]
fn what_is_printed_reads_back() {
    let all = descriptions();
    assert!(all.len() > 50, "{} descriptions", all.len());
    for (name, text) in all {
        let scene = Scene::parse(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let printed = scene.to_string();
        let again = Scene::parse(&printed).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(again, scene, "{name}");
        assert_eq!(again.to_string(), printed, "{name}");
    }
}

/// Statements of all kinds, with all of their options.
const EVERYTHING: &str = "
/// All statements.
///
///   Indented.
system Everything {
    param m = 1.3e-7, k: vec2 = [1, -2], J: sym2 = [[1, 0], [0, 2]], N: mat2 = [[1, 0], [0, 2]];
    const c = 3 / 2;
    param mass: [kg] = 2, arm: vec3 [mm] = [250, 0, -3e-2], turn = -30 [deg], spin: [rpm] = 30;
    let e: vec3 = [0, 0, 0.000000000000000001];
    fn drag(a: vec3, b) = -b * norm(a) * a;
    table lift = [(-0.5, -1), (0, c), (2e-3, 1 - (2 - 3))] pchip extrapolate error;
    table polar from \"polar.csv\" linear extrapolate linear;
    coord q_1: [rad], r_1: R3 [m];
    velocity v_1: vec3 [m/s];
    input F_1: [N], F_2: vec3 [N];
    state z_1: [A] = 0;
    output work: [J] = 2.5 [kN*mm] + 3 [m^(1/2)/s^-1];
    coord q, r: R3, a: S1, b: S3, R: SO3, X: SE3;
    velocity u, v: vec3, w = a.c * rate(a.s) - a.s * rate(a.c);
    input F: vec3, t;
    constraint q^2 = 4 * (m - 1);
    rate q = u;
    rate X.p = X.R * v;
    state i = 0, n: vec2 = [m, 1];
    rate i = F[1] - i;
    time t;
    prescribe u = 3 * t;
    prescribe rate(v) = 2 * v;
    inactive u, v[2];
    independent u, v[1];
    nonholonomic u = m * v[1] stabilized 20;
    nonholonomic u = v[1];
    loop q = r[1] stabilized 2 * m;
    frame f on g = pose(R, r);
    frame g = world;
    joint j: universal [1, 0, 0], [0, 1, 0] on f at pose(R, r) moves h { damping 1; limit -pi to pi; max_force 3; }
    joint i: spherical S3 moves n;
    joint o: revolute [0, 0, 1] moves s follows 2 * q - 1;
    body on f { mass m; com e; inertia diag(1, 2, 3) about origin; }
    body on f { }
    particle mass m at r;
    particle mass m at e on f;
    kinetic m * u^2 / 2;
    potential -m * (q - 1)^2;
    gravity [0, 0, -9.81];
    force F at e on f from g in world;
    torque F on f in body;
    wrench (F, [0, t, 0]) at e on f in g;
    force t from e on f to world;
    spring stiffness m length 2 from f to e on g;
    spring stiffness m on q - 1;
    cable stiffness m length 2 from f to e on g;
    damper coefficient m on u;
    inerter inertance m from f to e on g;
    inerter inertance 2 * m on u;
    dissipation m * u^2;
    generalized force v = -m * v;
    start X.p = [0, 0, 1], q = 2, u ~ 1.2;
    start X.R ~ rotx(1);
    rate r = v, b = 2 * b;
    frame k_0 on f at [0, 0, 1], k_1 = translation(e);
    output spin = angular_velocity(f) in body, push = 2 * (acceleration(f, e, g) in world)[2];
    output speed = norm(v) - (1 - (2 - 3)) / (4 / 5) * (6 * 7);
    output branch = 2 * (if q < 1 { r[1] } else if q >= 2 { -r[2] } else { min(q, 1) })^2;
    invariant energy when F = 0, k[1] = 2;
    invariant e_0 = energy;
    invariant linear_momentum of f along [0, 0, 1];
    invariant angular_momentum of f about r along e;
    invariant l = angular_momentum;
    invariant i_0 = (-m)^2 + -m^2 - (-2);
    generate accel, energy;
    include \"parts/leg.eom\";
    component Foot { body on sole[2] { mass 1; } }
    component Leg(mount: frame = world, side = -1, l) {
        joint knee[1]: revolute [0, side, 0] on mount moves shin[1];
        for i in 1..2 * n { for k in i - 1..3 { param a[i, k] = l * i^2; } }
        part foot[2] = Foot();
    }
    part left = Leg(f, l = 2 - (1 - m));
    part leg[i in 1..n - 1] = Leg(left.shin[1], l = left.a[i, 2] * leg[2].foot[2].x[1]);
    start leg[n - 1].knee[1] = 1, leg[2].knee[1]_dot = 2, left.X.p = 1;
    output tip[2] = leg[2].knee[1]_r[1] + left.knee[1]_dot;
    spring stiffness 1 from left.shin[1] to m on leg[2].shin[1];
    invariant k = linear_momentum of leg[1].shin[1] when left.F[2] = 0;
    generate left.tip, tip[2];
}";

#[test]
fn every_statement_reads_back() {
    let scene = Scene::parse(EVERYTHING).expect("a description");
    let printed = scene.to_string();
    assert_eq!(Scene::parse(&printed).expect("a description"), scene);
    insta::assert_snapshot!(printed);
}

#[test]
fn units_are_those_of_the_text() {
    let mut built = Scene::builder("Units");
    built.param("m", 1.3);
    built.param("l", -250);
    built.constant("a", 30);
    built.coordinate("r", CoordKind::Euclidean(3));
    built.output("y", 2);
    for (name, unit) in [
        ("m", "kg"),
        ("l", "mm"),
        ("a", "deg"),
        ("r", "m"),
        ("y", "N*m"),
    ] {
        built.unit(name, unit).expect("a unit");
    }
    let text = "pub system Units {
    param m: [kg] = 1.3;
    param l: [mm] = -250;
    const a: [deg] = 30;
    coord r: R3 [m];
    output y: [N*m] = 2;
}
";
    let scene = built.build().expect("a description");
    assert_eq!(scene.to_string(), text);
    assert_eq!(scene, Scene::parse(text).expect("a description"));
    for (name, unit, message) in [
        ("n", "kg", "`n` is not declared"),
        ("m", "kgs", "unknown unit `kgs`"),
        ("r", "mm", "`r` is computed in SI, not in `mm`"),
        ("m", "kg] = 1, n: [m", "expected"),
    ] {
        let error = built.unit(name, unit).expect_err(unit);
        assert!(error.to_string().contains(message), "{error}");
    }
    assert_eq!(built.build().expect("unchanged"), scene);
}

#[test]
fn units_are_documented() {
    let text = "pub system Cart {
    param m: [g] = 250, k = 3;
    coord x: [m], q;
    velocity v, w;
    input F: [N];
    rate x = v, q = w;
    kinetic m * v^2 / 2 + 1 [kg*m^2] * w^2 / 2;
    spring stiffness k on x;
    generalized force v = F;
    generate accel;
}";
    let scene = Scene::parse(text).expect("a description");
    let generated = scene.generate().expect("right");
    let code = rust_items(&generated.program, &Default::default());
    for line in [
        "/// Parameter `m` in `kg`, a number.",
        "/// Parameter `k` in `N/m`, a number.",
        "/// Sets parameter `k` in `N/m`;",
        "/// Velocity `v` in `m/s`, a number.",
        "/// Velocity `w` in `rad/s`, a number.",
        "/// Input `F` in `N`, a number.",
    ] {
        assert!(code.contains(line), "{line}\n{code}");
    }
    let plain = text
        .replace(": [g] = 250", " = 0.25")
        .replace(": [m]", "")
        .replace(": [N]", "");
    let plain = Scene::parse(&plain.replace("1 [kg*m^2]", "1")).expect("a description");
    let plain = plain.generate().expect("right");
    assert_eq!(plain.program.defaults, generated.program.defaults);
    let plain = rust_items(&plain.program, &Default::default());
    let without = ["kg", "N/m", "m/s", "rad/s", "N"]
        .iter()
        .fold(code, |code, unit| {
            code.replace(&format!(" in `{unit}`"), "")
        });
    assert_eq!(without, plain);
}

#[test]
fn scenes_that_say_something_else_are_not_equal() {
    let scene = Scene::parse(EVERYTHING).expect("a description");
    for (from, to) in [
        ("1.3e-7", "1.3e-8"),
        ("m - 1", "m + 1"),
        ("about origin", "about com"),
        ("in world", "in body"),
        ("stabilized 20", ""),
        ("    body on f { }\n", ""),
        ("/// All statements.", "///"),
        ("[rpm]", "[rad/s]"),
        ("F_1: [N]", "F_1"),
    ] {
        let changed = EVERYTHING.replacen(from, to, 1);
        assert_ne!(changed, EVERYTHING);
        assert_ne!(
            Scene::parse(&changed).expect("a description"),
            scene,
            "{from}"
        );
    }
}

/// Builds a cart with a pole on a spring, which is also given as text.
fn cart() -> Result<Scene, SceneError> {
    let mut cart = Scene::builder("Cart");
    cart.doc("A cart with a pole.");
    let (m, l) = (cart.param("m", 0.2), cart.param("l", 0.5));
    let big = cart.param("big", 1.5);
    let u = cart.input("u");
    let base = cart.joint(
        Joint::prismatic("rail", [1, 0, 0])
            .moves("base")
            .force(&u)
            .damping(0.1),
    );
    let pole = cart.joint(
        Joint::revolute("hinge", [0, 1, 0])
            .on(&base)
            .at(shifted([0.0, 0.0, 0.1]))
            .moves("pole"),
    );
    cart.body(Body::on(&base).mass(&big));
    cart.particle_on(&pole, &m, [0.into(), 0.into(), l.clone()]);
    cart.gravity([0.0, 0.0, -9.81]);
    let anchor = Point::of(WORLD, [-1, 0, 0]);
    cart.element(Element::spring_of_length(
        20,
        0.9,
        (anchor, Point::origin(&base)),
    ));
    cart.load(
        Load::force([0.0, 0.0, 0.3], &pole)
            .at([0.into(), 0.into(), &l / 2])
            .in_axes_of(WORLD),
    );
    cart.start("hinge", 0.3);
    cart.output(
        "height",
        pole.pose().part("p").entry(3) + &l * cos(Expr::name("hinge")),
    );
    cart.build()
}

const CART: &str = "
/// A cart with a pole.
pub system Cart {
    param m = 0.2;
    param l = 0.5;
    param big = 1.5;
    input u;
    joint rail: prismatic [1, 0, 0] moves base { force u; damping 0.1; };
    joint hinge: revolute [0, 1, 0] on base at pose(identity(3), [0, 0, 0.1]) moves pole;
    body on base { mass big; }
    particle mass m at [0, 0, l] on pole;
    gravity [0, 0, -9.81];
    spring stiffness 20 length 0.9 from [-1, 0, 0] on world to base;
    force [0, 0, 0.3] at [0, 0, l / 2] on pole in world;
    start hinge = 0.3;
    output height = pole.p[3] + l * cos(hinge);
}";

#[test]
fn what_is_built_is_what_the_text_says() {
    let built = cart().expect("a scene");
    assert_eq!(built, Scene::parse(CART).expect("a description"));
    assert_eq!(built.name(), "Cart");
    let ours = built.generate().expect("correct");
    let text = hamel_codegen::generate::from_text(CART).expect("correct");
    assert_eq!(ours.hash, text.hash);
    assert_eq!(
        built.rust(&ours).expect("Rust"),
        Scene::parse(CART)
            .and_then(|scene| scene.rust(&text))
            .expect("Rust")
    );
}

/// A rolling disk in user-defined coordinates: rates, a nonholonomic constraint, a circle.
/// Choices and tables, built and as text.
/// Repetition and components, built as in the text.
#[test]
fn components_are_built() {
    let mut arm = Scene::builder("Arm");
    let n = arm.constant("n", 3);
    arm.component(
        "Link",
        [
            Parameter::frame("base"),
            Parameter::value("l"),
            Parameter::value("m").or(1),
        ],
        |link| {
            let rod = link.joint(Joint::revolute("q", [0, 1, 0]).on("base").moves("rod"));
            let (l, m) = (Expr::name("l"), Expr::name("m"));
            link.frame("end", &rod, shifted([l.clone(), 0.into(), 0.into()]));
            link.body(Body::on(&rod).mass(m).com([l / 2, 0.into(), 0.into()]));
        },
    );
    arm.frame("place[0]", WORLD, Expr::name("world"));
    arm.repeat("i", 1, &n, |round| {
        let base = [("base", Expr::name("place[i - 1]")), ("l", 0.5.into())];
        round.part("link[i]", "Link", base);
        let end = Expr::name("link[ i ].end");
        round.frame("place[i]", WORLD, end);
    });
    arm.parts(
        "further",
        ("k", 1, 2),
        "Link",
        [
            ("base", Expr::name("link[k].end")),
            ("l", Expr::name("k") / 2),
            ("m", 2.into()),
        ],
    );
    arm.gravity([0.0, 0.0, -9.81]);
    arm.start("link[2].q", 0.5);
    arm.output("speed", Expr::name("further[1].q_dot"));
    arm.load(Load::force([0.0, 0.0, 1.0], "link[n].rod"));
    let scene = arm.build().expect("a scene");
    assert_eq!(
        Scene::parse(&scene.to_string()).expect("it was printed"),
        scene
    );
    let generated = scene.generate().expect("correct");
    let names = generated
        .model
        .joints
        .iter()
        .map(|joint| joint.name.as_str());
    let names: Vec<&str> = names.collect();
    assert_eq!(
        names,
        [
            "link_1_q",
            "link_2_q",
            "link_3_q",
            "further_1_q",
            "further_2_q"
        ]
    );
    // Errors point to the component, and mention the part.
    arm.part(
        "wrong",
        "Link",
        [
            ("base", Expr::name("world")),
            ("l", call("sin", [[1].into()])),
        ],
    );
    let scene = arm.build().expect("a scene");
    let error = scene.generate().expect_err("an angle is no vector");
    assert_eq!(messages(&error)[0], "`sin` cannot take a vector of 1");
    assert!(error.to_string().contains("in the part `wrong`, made here"));
    // There is no folder for files here.
    arm.include("legs.eom");
    let error = arm
        .build()
        .expect("a scene")
        .generate()
        .expect_err("no folder");
    assert_eq!(messages(&error), ["the folder of `legs.eom` is not known"]);
}

#[test]
fn branches_are_built() {
    let mut scene = Scene::builder("Contact");
    let z = scene.coordinate("z", CoordKind::Real);
    let w = scene.velocity("w", ShapeKind::Scalar);
    scene.rate("z", &w);
    scene.table(
        "stiff",
        &[(0.0, 0.0), (0.1, 25.5)],
        Interpolation::Pchip,
        Extrapolation::Linear,
    );
    scene.kinetic(w.pow(2));
    let push = if_less(&z, 0.0, call("stiff", [-&z]), 0.0);
    scene.generalized_force("w", push);
    let built = scene.build().expect("a scene");
    let text = "pub system Contact { coord z; velocity w; rate z = w; \
        table stiff = [(0, 0), (0.1, 25.5)] pchip extrapolate linear; kinetic w^2; \
        generalized force w = if z < 0 { stiff(-z) } else { 0 }; }";
    assert_eq!(built, Scene::parse(text).expect("a description"));
    assert!(built.generate().is_ok());
}

#[test]
fn coordinates_rates_and_constraints_are_built() {
    let mut sleigh = Scene::builder("Sleigh");
    let (m, j) = (sleigh.param("m", 1), sleigh.param("J", 0.3));
    sleigh.coordinate("r", CoordKind::Euclidean(2));
    let heading = sleigh.coordinate("a", CoordKind::S1);
    let v = sleigh.velocity("v", ShapeKind::Vector(2));
    let w = sleigh.velocity("w", ShapeKind::Scalar);
    sleigh.rate("r", &v);
    sleigh.rate("a", &w);
    let across = heading.part("c") * v.entry(2) - heading.part("s") * v.entry(1);
    sleigh.nonholonomic(across, 0);
    sleigh.kinetic(&m / 2 * call("dot", [v.clone(), v]) + &j / 2 * w.pow(2));
    let scene = sleigh.build().expect("a scene");
    let generated = scene.generate().expect("correct");
    assert_eq!(generated.model.constraints.len(), 1);
    assert_eq!(
        generated.model.constraints[0].written,
        "a.c * v[2] - a.s * v[1] = 0"
    );
}

fn messages(error: &SceneError) -> Vec<String> {
    let one = |error: &Diagnostic| error.message.clone();
    error.errors.iter().map(one).collect()
}

#[test]
fn errors_show_the_statement_that_they_are_about() {
    let mut arm = Scene::builder("Arm");
    let rod = arm.joint(Joint::revolute("hinge", [0, 0, 0]).moves("rod"));
    arm.body(
        Body::on(&rod)
            .mass("m".len() as f64)
            .com([0.into(), Expr::name("high"), 1.into()]),
    );
    arm.body(Body::on("upper").inertia_about_com(diagonal([1, 1, 1])));
    let error = arm
        .build()
        .expect("names are words")
        .generate()
        .expect_err("wrong");
    insta::assert_snapshot!(error.to_string());

    let mut arm = Scene::builder("Arm");
    arm.param("two words", 1);
    let error = arm.build().expect_err("no name");
    assert!(
        error.to_string().contains("param two words = 1;"),
        "{error}"
    );
    let mut arm = Scene::builder("Arm");
    arm.param("a = 1, b", 1);
    let error = arm.build().expect_err("no name");
    assert!(
        messages(&error)[0].contains("more than one word"),
        "{error}"
    );
    let mut arm = Scene::builder("Arm");
    assert!(arm.text("param k = 2; param l = 3;").is_ok());
    assert!(arm.text("parm k = 2;").is_err());
}

/// Numbers are exactly the given decimals, with their signs.
#[test]
fn numbers_are_exact() {
    for (value, text) in [
        (0.1, "0.1"),
        (-2.5, "-2.5"),
        (1e-9, "1e-9"),
        (12345.678, "12345.678"),
        (1.25e22, "12500000000000000000000"),
        (f64::MIN_POSITIVE, "2.2250738585072014e-308"),
        (-0.0, "0"),
    ] {
        assert_eq!(Expr::from(value).to_string(), text);
    }
    let turned = pose(call("rotx", [0.5.into()]), [1, 0, 0]) * -sin(2.0 * Expr::name("q"));
    assert_eq!(
        turned.to_string(),
        "pose(rotx(0.5), [1, 0, 0]) * -sin(2 * q)"
    );
}

#[test]
fn scenes_and_errors_can_be_sent_to_other_threads() {
    fn sent<T: Send + Sync + 'static>() {}
    sent::<Scene>();
    sent::<SceneError>();
    sent::<Diagnostic>();
}

/// Guesses, independent velocities and components in axes have separate methods.
#[test]
fn starts_that_are_near_and_velocities_that_stay_are_built() -> Result<(), SceneError> {
    let mut sleigh = Scene::builder("Sleigh");
    let (x, q) = (
        sleigh.coordinate("x", CoordKind::Real),
        sleigh.coordinate("q", CoordKind::Real),
    );
    let (v, w) = (
        sleigh.velocity("v", ShapeKind::Scalar),
        sleigh.velocity("w", ShapeKind::Scalar),
    );
    sleigh.rate("x", &v);
    sleigh.rate("q", &w);
    let blade = sleigh.frame(
        "blade",
        WORLD,
        pose(call("rotz", [q]), [x, 0.into(), 0.into()]),
    );
    sleigh.body(
        Body::on(&blade)
            .mass(2)
            .inertia_about_com(diagonal([1.0, 1.0, 1.0])),
    );
    sleigh.nonholonomic(&v, w * 2);
    sleigh.independent([v.clone()]);
    sleigh.guess("v", 3);
    sleigh.output("slip", in_axes(call("velocity", [blade.pose()]), "blade"));
    let scene = sleigh.build()?;
    let text = scene.to_string();
    for statement in [
        "independent v;",
        "start v ~ 3;",
        "output slip = velocity(blade) in blade;",
    ] {
        assert!(text.contains(statement), "{text}");
    }
    let generated = scene.generate()?;
    // Minimises 2 (v - 3)² + w² with v = 2 w.
    assert!((generated.model.start_xi[0] - 8.0 / 3.0).abs() < 1e-8);
    assert_eq!(generated.solved, [(1, 0)]);
    Ok(())
}
