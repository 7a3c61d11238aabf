//! The words of the language.

/// Statements, each with a sentence that shows its syntax.
const STATEMENTS: [(&str, &str); 42] = [
    (
        "param",
        "a parameter is written `param m = 1.3, s: vec3 = [0, 0, 1];`",
    ),
    ("const", "a constant is written `const k = 3/2;`"),
    ("let", "a named expression is written `let e = m * s;`"),
    (
        "fn",
        "a function is written `fn drag(v: vec3, c) = -c * norm(v) * v;`",
    ),
    (
        "extern",
        "a function in Rust is written `extern fn lift(alpha, mach) -> 2;`, with a stand-in `extern fn lift(alpha, mach) -> 2 = [alpha, 0];`",
    ),
    (
        "table",
        "a table is written `table thrust = [(0, 0), (0.2, 1.1)] linear extrapolate hold;`, or `from \"file.csv\"` for its points",
    ),
    ("coord", "coordinates are written `coord r: R3, R: SO3, q;`"),
    (
        "velocity",
        "velocities are written `velocity v: vec3, u;`, or by rates: `velocity v: vec3 = R.T * rate(r);`",
    ),
    ("constraint", "a constraint is written `constraint a = b;`"),
    ("rate", "a rate is written `rate r = R * v;`"),
    (
        "state",
        "a state of first order is written `state i = 0;`, with `rate i = (u - R * i) / L;`",
    ),
    ("time", "the time is written `time t;`"),
    (
        "prescribe",
        "a prescribed motion is written `prescribe q = 0.3 * sin(t);`, `prescribe v = 2 * t;` or `prescribe rate(v) = a;`",
    ),
    (
        "inactive",
        "velocities that stay zero are written `inactive v, w[3];`",
    ),
    (
        "independent",
        "velocities that constraints do not determine are written `independent u, w[1];`",
    ),
    (
        "nonholonomic",
        "a nonholonomic constraint is written `nonholonomic v + cross(w, p) = [0, 0, 0];`",
    ),
    (
        "loop",
        "a closed loop is written `loop a = b;` or `loop a = b stabilized 20;`",
    ),
    (
        "frame",
        "a frame is written `frame f = pose(R, p);`, `frame f on g = pose(R, p);` or `frame f on g at [x, y, z];`",
    ),
    (
        "joint",
        "a joint is written `joint j: revolute [0, 0, 1] on f at pose(R, p) moves g;`, or with `{ damping d; }` before its `;`",
    ),
    (
        "body",
        "a body is written `body on f { mass m; com s; inertia J about com; }`",
    ),
    (
        "particle",
        "a particle is written `particle mass m at p;` or `particle mass m at p on f;`",
    ),
    (
        "kinetic",
        "a kinetic energy is written `kinetic m * v^2 / 2;`",
    ),
    ("potential", "a potential is written `potential m * g * z;`"),
    ("gravity", "gravity is written `gravity [0, 0, -g];`"),
    ("input", "inputs are written `input F: vec3, u;`"),
    (
        "force",
        "a force is written `force F at p on f in body;`, `in world;` or `in g;`, or along a line `force F from p on f to q on g;`",
    ),
    (
        "torque",
        "a torque is written `torque t on f in body;`, `in world;` or `in g;`; its reaction acts on h in `torque t on f from h in body;`",
    ),
    (
        "wrench",
        "a wrench is written `wrench (F, t) at p on f in body;`, `in world;` or `in g;`",
    ),
    (
        "generalized",
        "a generalized force is written `generalized force w = -d * w;`",
    ),
    (
        "spring",
        "a spring is written `spring stiffness k length l from p on f to q on g;` or `spring stiffness k on q2 - q1;`",
    ),
    (
        "cable",
        "a cable is written `cable stiffness k length l from p on f to q on g;`",
    ),
    (
        "damper",
        "a damper is written `damper coefficient c from p on f to q on g;` or `damper coefficient c on w2 - w1;`",
    ),
    (
        "inerter",
        "an inerter is written `inerter inertance b from p on f to q on g;` or `inerter inertance b on w2 - w1;`",
    ),
    (
        "dissipation",
        "a dissipation is written `dissipation d * w^2 / 2;`",
    ),
    (
        "start",
        "an initial value is written `start w = [0.01, 1, 0];`, a guess of one `start q ~ 1.2;`",
    ),
    ("output", "an output is written `output speed = norm(v);`"),
    (
        "invariant",
        "an invariant is written `invariant energy;`, `invariant angular_momentum about p along a;` or `invariant name = expr when F = 0;`",
    ),
    (
        "generate",
        "a selection of functions is written `generate accel, energy;`, the kinematics of a frame `generate jacobian tip in world;`",
    ),
    (
        "include",
        "statements of a file are included by `include \"leg.eom\";`",
    ),
    (
        "component",
        "a component is written `component Leg(mount: frame, side = 1) { … }`",
    ),
    (
        "part",
        "a part is written `part left = Leg(hip, side = -1);` or `part leg[i in 1..6] = Leg(mount[i]);`",
    ),
    (
        "for",
        "a repetition is written `for i in 1..n { … }`, both ends included",
    ),
];

/// Words that end an expression and cannot be names.
pub(super) const CONNECTIVES: [&str; 5] = ["at", "on", "in", "about", "stabilized"];

/// Words that may follow an expression and can also be names.
pub(super) const CLAUSES: [&str; 7] = ["length", "from", "to", "moves", "follows", "along", "when"];

/// Words that cannot be names of items in the generated code.
pub(super) const RUST_WORDS: [&str; 53] = [
    "_", "Self", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue",
    "crate", "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if",
    "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub",
    "ref", "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Returns the words that start statements.
pub(super) fn statements() -> impl Iterator<Item = &'static str> {
    STATEMENTS.iter().map(|(word, _)| *word)
}

/// Returns the words that start statements, each with a sentence that shows the syntax.
pub(crate) fn forms() -> impl Iterator<Item = (&'static str, &'static str)> {
    STATEMENTS.into_iter()
}

/// Returns whether a word starts a statement.
pub(super) fn is_statement(word: &str) -> bool {
    form(word).is_some()
}

/// Returns the sentence that shows the syntax of a statement.
pub(super) fn form(word: &str) -> Option<&'static str> {
    STATEMENTS
        .iter()
        .find(|(statement, _)| *statement == word)
        .map(|(_, form)| *form)
}
