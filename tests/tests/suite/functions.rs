//! Functions with branches: random expressions compared with another evaluator, their slopes with differences, and
//! expressions that must not be identified.

use crate::size::size;
use hamel_codegen::algebra::residue_pair;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::interpret::Interpreter;
use rayon::prelude::*;

/// Pseudo-random choices.
struct Random(residue_pair::Random);

impl Random {
    fn below(&mut self, n: u64) -> usize {
        (self.0.bits() % n) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.0.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// An expression that can be printed and evaluated.
enum Tree {
    Number(i32),
    Name(usize),
    One(&'static str, Box<Tree>),
    Two(&'static str, Box<Tree>, Box<Tree>),
    Clamp(Box<Tree>, Box<Tree>, Box<Tree>),
    If(&'static str, Box<[Tree; 4]>),
}

const NAMES: [&str; 5] = ["x", "y", "v", "w", "u"];
const KNOTS: [(f64, f64); 4] = [(-1.0, 0.5), (0.0, -0.25), (0.5, 1.0), (2.0, 0.0)];
const FUNCTIONS_OF_ONE: [&str; 9] = [
    "abs", "sign", "tanh", "sin", "-", "square", "root", "inverse", "line",
];
const FUNCTIONS_OF_TWO: [&str; 7] = ["+", "-", "*", "min", "max", "hypot", "/"];
const COMPARISONS: [&str; 4] = ["<", "<=", ">", ">="];

impl Tree {
    fn random(random: &mut Random, depth: usize) -> Self {
        if depth == 0 || random.below(9) == 0 {
            return match random.below(4) {
                0 => Tree::Number(random.below(7) as i32 - 3),
                _ => Tree::Name(random.below(5)),
            };
        }
        let kind = random.below(10);
        let mut next = || Tree::random(random, depth - 1);
        match kind {
            0..=2 => {
                let inner = Box::new(next());
                Tree::One(FUNCTIONS_OF_ONE[random.below(9)], inner)
            }
            3..=6 => {
                let (a, b) = (Box::new(next()), Box::new(next()));
                Tree::Two(FUNCTIONS_OF_TWO[random.below(7)], a, b)
            }
            7 => {
                let inner = Box::new(next());
                let low = Tree::Number(-(random.below(3) as i32));
                let high = Tree::random(random, 1);
                let high = Tree::One("abs", Box::new(high));
                Tree::Clamp(inner, Box::new(low), Box::new(high))
            }
            _ => {
                let parts = [next(), next(), next(), next()];
                Tree::If(COMPARISONS[random.below(4)], Box::new(parts))
            }
        }
    }

    fn text(&self) -> String {
        match self {
            Tree::Number(n) => format!("({n})"),
            Tree::Name(k) => NAMES[*k].into(),
            Tree::One("-", a) => format!("(-{})", a.text()),
            Tree::One("square", a) => format!("({})^2", a.text()),
            Tree::One("root", a) => format!("sqrt(abs({}) + 1)", a.text()),
            Tree::One("inverse", a) => format!("(1 / (2 + abs({})))", a.text()),
            Tree::One(name, a) => format!("{name}({})", a.text()),
            Tree::Two("/", a, b) => format!("({} / (3 + ({})^2))", a.text(), b.text()),
            Tree::Two(name @ ("+" | "-" | "*"), a, b) => {
                format!("({} {name} {})", a.text(), b.text())
            }
            Tree::Two(name, a, b) => format!("{name}({}, {})", a.text(), b.text()),
            Tree::Clamp(a, low, high) => {
                format!("clamp({}, {}, {})", a.text(), low.text(), high.text())
            }
            Tree::If(sign, parts) => {
                let [a, b, c, d] = parts.each_ref().map(Tree::text);
                format!("(if {a} {sign} {b} {{ {c} }} else {{ {d} }})")
            }
        }
    }

    fn value(&self, at: &[f64; 5]) -> f64 {
        match self {
            Tree::Number(n) => f64::from(*n),
            Tree::Name(k) => at[*k],
            Tree::One(name, a) => {
                let a = a.value(at);
                match *name {
                    "abs" => a.abs(),
                    "sign" if a == 0.0 => 0.0,
                    "sign" => a.signum(),
                    "tanh" => a.tanh(),
                    "sin" => a.sin(),
                    "-" => -a,
                    "square" => a * a,
                    "root" => (a.abs() + 1.0).sqrt(),
                    "inverse" => 1.0 / (2.0 + a.abs()),
                    _ => line(a),
                }
            }
            Tree::Two(name, a, b) => {
                let (a, b) = (a.value(at), b.value(at));
                match *name {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "min" => a.min(b),
                    "max" => a.max(b),
                    "hypot" => a.hypot(b),
                    _ => a / (3.0 + b * b),
                }
            }
            Tree::Clamp(a, low, high) => a.value(at).max(low.value(at)).min(high.value(at)),
            Tree::If(sign, parts) => {
                let [a, b, c, d] = parts.each_ref().map(|part| part.value(at));
                let holds = match *sign {
                    "<" => a < b,
                    "<=" => a <= b,
                    ">" => a > b,
                    _ => a >= b,
                };
                if holds { c } else { d }
            }
        }
    }
}

/// The table `line`, constant beyond its points.
fn line(a: f64) -> f64 {
    let place = KNOTS.windows(2).find(|pair| a < pair[1].0);
    match place {
        _ if a <= KNOTS[0].0 => KNOTS[0].1,
        Some(pair) => {
            let share = (a - pair[0].0) / (pair[1].0 - pair[0].0);
            pair[0].1 + share * (pair[1].1 - pair[0].1)
        }
        None => KNOTS[3].1,
    }
}

fn system(trees: &[Tree]) -> String {
    let outputs: Vec<String> = trees[2..]
        .iter()
        .enumerate()
        .map(|(k, tree)| format!("output f{k} = {};\n", tree.text()))
        .collect();
    format!(
        "system S {{\ncoord x, y; velocity v, w; rate x = v; rate y = w; kinetic (v^2 + w^2) / 2;\ninput u;\n\
         table line = [(-1, 0.5), (0, -0.25), (0.5, 1), (2, 0)] linear extrapolate hold;\n\
         generalized force v = {};\ngeneralized force w = {};\n{}generate all, linearize;\n}}",
        trees[0].text(),
        trees[1].text(),
        outputs.concat()
    )
}

fn call(generated: &Generated, name: &str, at: &[f64; 5]) -> Vec<f64> {
    let program = &generated.program;
    let function = program.function(name).unwrap_or_else(|| panic!("{name}"));
    let interpreter = Interpreter::new(program, function, &program.defaults);
    interpreter
        .call(&at[..2], &at[2..4], &at[4..], &[0.0; 2])
        .expect("regular")
}

/// Returns the number of random systems, with five expressions each.
fn systems() -> u64 {
    size(100, 4_000)
}

#[test]
fn random_expressions_have_their_values_and_slopes() {
    let counts: Vec<[usize; 2]> = (0..systems()).into_par_iter().map(attack).collect();
    let [values, slopes] = counts.iter().fold([0, 0], |[a, b], [c, d]| [a + c, b + d]);
    println!("{values} values, {slopes} slopes");
    assert!(values as u64 > 19 * systems() && slopes as u64 > 10 * systems());
}

/// Returns the numbers of compared values and slopes of one system.
fn attack(seed: u64) -> [usize; 2] {
    let mut random = Random(residue_pair::Random::new(seed));
    let trees: Vec<Tree> = (0..5).map(|_| Tree::random(&mut random, 4)).collect();
    let text = system(&trees);
    let generated = from_text(&text).unwrap_or_else(|errors| panic!("{text}\n{errors:?}"));
    let (mut values, mut slopes) = (0, 0);
    for _ in 0..4 {
        let at: [f64; 5] = std::array::from_fn(|_| 4.0 * random.unit() - 2.0);
        let mut compare = |found: f64, tree: &Tree| {
            let expected = tree.value(&at);
            let near = (found - expected).abs() <= 1e-9 * (1.0 + expected.abs());
            // At a jump, rounding decides.
            let by = 1e-9;
            let jumps = || {
                (0..5).any(|k| {
                    let mut moved = at;
                    moved[k] += by;
                    let more = tree.value(&moved);
                    moved[k] -= 2.0 * by;
                    (more - tree.value(&moved)).abs() > 1e-5 * (1.0 + expected.abs())
                })
            };
            assert!(near || jumps(), "{text}\n{at:?}: {found}, not {expected}");
            values += 1;
        };
        let accel = call(&generated, "accel", &at);
        compare(accel[0], &trees[0]);
        compare(accel[1], &trees[1]);
        for (k, tree) in trees[2..].iter().enumerate() {
            compare(call(&generated, &format!("f{k}"), &at)[0], tree);
        }
        let matrix = call(&generated, "linearize", &at);
        for (row, tree) in trees[..2].iter().enumerate() {
            for column in 0..5 {
                let change = |h: f64| {
                    let mut moved = at;
                    moved[column] += h;
                    let more = tree.value(&moved);
                    moved[column] -= 2.0 * h;
                    (more - tree.value(&moved)) / (2.0 * h)
                };
                let (wide, narrow) = (change(2e-5), change(1e-5));
                let size = 1.0 + narrow.abs();
                if (wide - narrow).abs() > 1e-7 * size || size > 1e3 {
                    continue;
                }
                let found = matrix[(2 + row) * 5 + column];
                assert!(
                    (found - narrow).abs() <= 1e-5 * size,
                    "{text}\n{at:?}: slope {row}, {column}: {found}, not {narrow}"
                );
                slopes += 1;
            }
        }
    }
    [values, slopes]
}

/// Returns whether two expressions of x, y, p are identified.
fn equal(left: &str, right: &str) -> bool {
    let text = format!(
        "system S {{ param p = 2; coord x, y; velocity v, w; rate x = v; rate y = w; kinetic p * v^2 + w^2; \
         output difference = ({left}) - ({right}); }}"
    );
    let generated = from_text(&text).unwrap_or_else(|errors| panic!("{text}\n{errors:?}"));
    let graph = &generated.model.graph;
    let (_, value) = &generated.model.outputs[0];
    value.is_zero(graph)
}

#[test]
fn what_is_wrong_on_one_side_is_not_found_equal() {
    let wrong = [
        ("abs(x) * abs(y)", "x * y"),
        ("abs(x)", "x"),
        ("abs(x)", "-x"),
        ("abs(p)", "p"),
        ("sign(x) * sign(y)", "1"),
        ("sign(x) * sign(y)", "sign(x) + sign(y)"),
        ("sign(x)^2", "1"),
        ("sign(x)", "x / abs(x) + 0"),
        ("max(x, y)", "x"),
        ("max(x, y)", "y"),
        ("max(x, y) * min(x, y)", "x^2"),
        ("max(x, y)", "min(x, y)"),
        ("max(0, x)", "x"),
        ("max(0, x) * max(0, -x)", "x^2"),
        ("if x > 1 { 1 } else { 0 }", "if x > 0 { 1 } else { 0 }"),
        ("if x > 0 { 1 } else { 0 }", "if x >= 0 { 1 } else { 0 }"),
        (
            "(if x > 0 { 1 } else { 0 }) + (if x < 0 { 1 } else { 0 })",
            "1",
        ),
        (
            "(if x > 1 { 1 } else { 0 }) * (if x > 0 { 1 } else { 0 })",
            "if x > 0 { 1 } else { 0 }",
        ),
        ("clamp(x, -1, 1)", "x"),
        ("hypot(x, y)", "x + y"),
        ("hypot(x, 0)", "x"),
        ("if x^2 >= 0 { x } else { y }", "y"),
        ("if x < y { x } else { y }", "if y > x { y } else { x }"),
        ("abs(x + y)", "abs(x) + abs(y)"),
        ("abs(x - y)", "abs(x) - abs(y)"),
        ("tanh(abs(x))", "tanh(x)"),
        ("abs(abs(x) - 1)", "abs(x) - 1"),
    ];
    for (left, right) in wrong {
        assert!(!equal(left, right), "{left} = {right}");
    }
}

#[test]
fn what_is_right_on_both_sides_is_found_equal() {
    let right = [
        ("abs(x)", "abs(-x)"),
        ("abs(x)", "sign(x) * x"),
        ("max(x, y)", "if x > y { x } else { y }"),
        ("max(x, y) + min(y, x)", "x + y"),
        ("max(-x, -y)", "-min(x, y)"),
        ("max(x + p, y + p)", "max(x, y) + p"),
        ("if x < y { x } else { y }", "if y > x { x } else { y }"),
        (
            "if x <= y { 2 * x } else { 2 * y }",
            "2 * (if x > y { y } else { x })",
        ),
        ("min(2, 3)", "2"),
        ("abs(2 - pi)", "pi - 2"),
        ("sign(sqrt(2) - 1.4)", "1"),
        ("clamp(5, -1, 2)", "2"),
        ("if 1 < 2 { x } else { y }", "x"),
        ("if 2 < 2 { x } else { y }", "y"),
        ("if 2 <= 2 { x } else { y }", "x"),
        ("if (x + 1)^2 - x^2 - 2 * x > 0 { x } else { y }", "x"),
    ];
    for (left, right) in right {
        assert!(equal(left, right), "{left} = {right}");
    }
}
