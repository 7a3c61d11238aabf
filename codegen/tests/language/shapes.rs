//! Shapes inferred from the text equal those of computed values, in all descriptions of the repository and in random
//! expressions.

use hamel_language::algebra::residue_pair::Random;
use hamel_language::lower::inspect::{CALLS as OF_JOINTS, Found, inspect};
use hamel_language::model::value::Value;
use hamel_language::syntax::ast::visit::{Visit, visit};
use hamel_language::syntax::ast::{
    BinaryOp, Choice, Comparison, Expr, ExprKind, Ident, ItemKind, Span, System, Target,
};
use hamel_language::syntax::parse_text;
use hamel_language::vocabulary;
use num_bigint::BigInt;
use num_rational::BigRational;
use std::path::Path;

/// Returns the shape of a value in words, and checks that its rows have equal lengths.
fn shape(value: &Value) -> String {
    match value {
        Value::Scalar(_) => "a scalar".into(),
        Value::Vector(v) => format!("a vector of {}", v.len()),
        Value::Matrix(m) => {
            let columns = m.first().map_or(0, Vec::len);
            assert!(m.iter().all(|row| row.len() == columns), "{value:?}");
            format!("a {}×{columns} matrix", m.len())
        }
        Value::Pose(..) => "a pose".into(),
    }
}

/// Returns whether text and graph agree about an expression. An expression with a shape has a value of that shape, with
/// the inferred numbers, or a mathematical reason why not; one without a shape has an error.
fn agrees(found: &Found) -> bool {
    let value = found.value.as_ref();
    let value = value.map(|(value, entries)| (shape(value), entries));
    match (&found.inferred, &value) {
        (Some((inferred, numbers)), Some((shape, entries))) => {
            let same = |numbers: &Vec<BigRational>| {
                let numbers = numbers.iter().map(|number| Some(number.clone()));
                numbers.eq(entries.iter().cloned())
            };
            inferred == shape && numbers.as_ref().is_none_or(same)
        }
        (Some(_), None) => found.failed,
        (None, _) => found.refused || found.failed,
    }
}

/// Collects the expressions of statements.
struct Expressions(Vec<Expr>);

impl Visit for Expressions {
    fn declares(&mut self, _: &mut Ident, _: bool) {}
    fn uses(&mut self, _: &mut Ident) {}
    fn target(&mut self, _: &mut Target) {}
    fn expr(&mut self, expr: &mut Expr) {
        self.0.push(expr.clone());
    }
    fn place(&mut self, _: &mut Span) {}
}

/// Returns all expressions of a description and their parts, except for the values of functions, which have parameters.
fn expressions(system: &System) -> Vec<Expr> {
    let mut all = Expressions(Vec::new());
    for item in &system.items {
        if !matches!(item.kind, ItemKind::Function(_) | ItemKind::External(_)) {
            visit(&mut item.clone(), &mut all);
        }
    }
    let (mut open, mut found) = (all.0, Vec::new());
    while let Some(expr) = open.pop() {
        // `in body` is not an expression.
        let parts = expr.parts().into_iter();
        let body = |part: &&Expr| matches!(&part.kind, ExprKind::Name(name) if name == "body");
        open.extend(parts.filter(|part| !body(part)).cloned());
        found.push(expr);
    }
    found
}

#[test]
fn the_shapes_of_all_descriptions_are_those_of_their_values() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = [
        "tests/models",
        "tests/models/reuse",
        "tests/models/external",
        "tests/models/multibody",
        "examples",
        "examples/gallery",
    ];
    let files = folders.map(|folder| std::fs::read_dir(root.join(folder)).expect(folder));
    let (mut files_read, mut count) = (0, 0);
    for entry in files.into_iter().flatten() {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "eom") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("readable");
        // Descriptions with included files or tables in files cannot be read alone.
        if text.contains("include \"") || text.contains("from \"") {
            continue;
        }
        let system = parse_text(&text).expect("a description");
        let expressions_read = inspect(&system, |system, find| {
            let expressions = expressions(system);
            for expr in &expressions {
                let found = find(expr);
                let whole = found.inferred.is_some() && found.value.is_some() || found.failed;
                assert!(
                    agrees(&found) && whole,
                    "{}: {found:?}: {expr:?}",
                    path.display()
                );
            }
            expressions.len()
        });
        count += expressions_read.unwrap_or_else(|errors| panic!("{}: {errors:?}", path.display()));
        files_read += 1;
    }
    assert!(
        files_read > 80 && count > 5_000,
        "{files_read} files, {count} expressions"
    );
}

/// Names of every shape, and functions from the description, from Rust and from tables.
const NAMES: &str = "system A {
    param a = 1, u: vec2 = [1, 2], v: vec3 = [1, 2, 3], M: mat3 = [[1, 2, 3], [4, 5, 6], [7, 8, 9]], S: sym2 = [[1, 0], [0, 1]];
    const k = 3 / 2, n = 2, K = [1, 2, 3], T = [[1, 2], [3, 4], [2, 1]];
    coord q, c: S1, z: S3, R: SO3, X: SE3, r: R2;
    velocity w, s: vec3;
    input F;
    state i = 0;
    let l = a * v;
    frame f = X;
    frame g on f = pose(rotx(q), l);
    fn twice(b) = b + b;
    fn drag(v: vec3, c) = -c * norm(v) * v;
    fn pick(A, i) = A[i];
    fn turned(P, c) = P.R.T * c;
    extern fn lift(alpha, mach) -> 2;
    extern fn side(alpha) -> 1 = twice(alpha);
    table thrust = [(0, 0), (1, k), (2, 1)] linear extrapolate hold;
}";

const LEAVES: [&str; 25] = [
    "a", "u", "v", "M", "S", "k", "n", "K", "T", "q", "c", "z", "R", "X", "r", "w", "s", "F", "i",
    "l", "f", "g", "pi", "world", "K",
];

const CALLS: [&str; 7] = ["twice", "drag", "pick", "turned", "lift", "side", "thrust"];

struct Maker {
    random: Random,
    /// Expressions with a shape.
    known: Vec<Expr>,
}

impl Maker {
    fn below(&mut self, count: usize) -> usize {
        (self.random.bits() >> 16) as usize % count
    }

    fn of(kind: ExprKind) -> Expr {
        let span = Span::NOWHERE;
        Expr { kind, span }
    }

    fn ident(name: &str) -> Ident {
        let (name, span) = (name.into(), Span::NOWHERE);
        Ident { name, span }
    }

    fn leaf(&mut self) -> Expr {
        Maker::of(match self.below(3) {
            0 => {
                let (n, d) = (self.below(5) as i64, 1 + (self.below(8) / 7) as i64);
                ExprKind::Number(BigRational::new(BigInt::from(n), BigInt::from(d)).into())
            }
            _ => ExprKind::Name(LEAVES[self.below(LEAVES.len())].into()),
        })
    }

    /// Returns a known expression, or a new leaf.
    fn part(&mut self) -> Expr {
        match self.below(4) {
            0 => self.leaf(),
            _ => {
                let which = self.below(self.known.len());
                self.known[which].clone()
            }
        }
    }

    fn boxed(&mut self) -> Box<Expr> {
        Box::new(self.part())
    }

    fn parts(&mut self, count: usize) -> Vec<Expr> {
        (0..count).map(|_| self.part()).collect()
    }

    /// Returns a new expression of known ones.
    fn expr(&mut self) -> Expr {
        Maker::of(match self.below(10) {
            0 => {
                let field = ["c", "s", "T", "R", "p", "x"][self.below(6)];
                ExprKind::Field(self.boxed(), Maker::ident(field))
            }
            1 => {
                let count = 1 + self.below(2);
                ExprKind::Index(self.boxed(), self.parts(count))
            }
            2 => ExprKind::Neg(self.boxed()),
            3 => {
                let count = 1 + self.below(3);
                ExprKind::Array(self.parts(count))
            }
            4 => {
                let signs = [
                    Comparison::Less,
                    Comparison::AtMost,
                    Comparison::Greater,
                    Comparison::AtLeast,
                ];
                ExprKind::If(Box::new(Choice {
                    left: self.part(),
                    comparison: signs[self.below(4)],
                    right: self.part(),
                    then: self.part(),
                    otherwise: self.part(),
                }))
            }
            5 | 6 => {
                let ops = [
                    BinaryOp::Add,
                    BinaryOp::Sub,
                    BinaryOp::Mul,
                    BinaryOp::Div,
                    BinaryOp::Pow,
                ];
                let op = ops[self.below(5)];
                ExprKind::Binary(op, self.boxed(), self.boxed())
            }
            7 => ExprKind::InAxes(self.boxed(), self.boxed()),
            _ => {
                let own = CALLS.iter().copied().chain(["rate"]);
                let joints = OF_JOINTS;
                let names = vocabulary::functions().map(|(name, _)| name);
                let all: Vec<&str> = names.chain(own).chain(joints).collect();
                let name = all[self.below(all.len())];
                // Functions of joints take one axis or point.
                let count = match joints.contains(&name) {
                    true => 1,
                    false => self.below(4),
                };
                ExprKind::Call(Maker::ident(name), self.parts(count))
            }
        })
    }
}

/// Returns the depth of an expression.
fn depth(expr: &Expr) -> usize {
    1 + expr.parts().into_iter().map(depth).max().unwrap_or(0)
}

/// Random expressions consist of expressions with shapes, so that long correct ones occur, and all kinds of mistakes.
#[test]
fn the_shapes_of_random_expressions_are_those_of_their_values() {
    let system = parse_text(NAMES).expect("a description");
    let looked = inspect(&system, |_, find| the_random_expressions_agree(find));
    looked.unwrap_or_else(|errors| panic!("{errors:?}"));
}

/// Checks the expressions by a function that analyses one.
fn the_random_expressions_agree(find: &dyn Fn(&Expr) -> Found) {
    let (mut right, mut wrong, mut failed, mut numbers, mut deepest) = (0, 0, 0, 0, 0);
    for seed in 0..20 {
        let mut maker = Maker {
            random: Random::new(seed),
            known: Vec::new(),
        };
        for _ in 0..12 {
            let leaf = maker.leaf();
            maker.known.push(leaf);
        }
        for _ in 0..600 {
            let expr = maker.expr();
            let found = find(&expr);
            assert!(agrees(&found), "seed {seed}: {found:?}: {expr:?}");
            wrong += usize::from(found.refused);
            failed += usize::from(found.failed && !found.refused);
            let Some((_, given)) = &found.inferred else {
                continue;
            };
            right += 1;
            numbers += usize::from(given.is_some());
            let depth = depth(&expr);
            deepest = deepest.max(depth);
            if found.value.is_some() && depth < 7 {
                maker.known.push(expr);
            }
        }
    }
    let counts = (right, wrong, failed, numbers, deepest);
    assert!(
        right > 2_000 && wrong > 2_000 && failed > 20 && numbers > 200 && deepest > 5,
        "{counts:?}"
    );
}
