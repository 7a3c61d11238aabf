//! Shapes of calls.

use super::infer::Inference;
use super::shape::{MOST_ENTRIES, Shape, Shaped};
use crate::algebra::function::Function;
use crate::diagnostics::Diagnostic;
use crate::symbols::words::{AXIS, FUNCTIONS, PLACE, PLANE, usage};
use crate::syntax::ast::{Expr, ExprKind, Ident, Span};
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};

impl<'a> Inference<'a> {
    /// Returns the shape of a call. Reports wrong numbers and shapes of arguments.
    pub fn call(
        &mut self,
        function: &'a Ident,
        arguments: &'a [Expr],
        span: Span,
    ) -> Option<Shaped> {
        let name = function.name.as_str();
        if let Some(own) = self.symbols.functions.get(name).copied() {
            return self.applied(own, arguments, span);
        }
        if self.tables.contains(name) {
            return self.table(name, arguments, span);
        }
        if let Some(external) = self.externals.get(name).copied() {
            return self.external(external, arguments, span);
        }
        match (name, arguments) {
            ("rate", _) => return self.rate(arguments, span),
            (AXIS | PLANE | PLACE, [argument]) => return self.of_joint(name, argument),
            _ => {}
        }
        let found = self.all(arguments);
        // An unknown function has been reported already.
        let usage = usage(name)?;
        let found = found?;
        if FUNCTIONS.contains(&name) {
            return self.motion(name, &found, span);
        }
        if let Some(value) = value(name, &found) {
            return Some(value);
        }
        let list: Vec<String> = found.iter().map(|one| one.shape.describe()).collect();
        let list = match list.as_slice() {
            [] => "no argument".into(),
            [one] => one.clone(),
            [first @ .., last] => format!("{} and {last}", first.join(", ")),
        };
        let help = match self.circle_part(name, arguments) {
            Some(part) => format!("write `{part}`"),
            None => format!("write {usage}"),
        };
        let message = format!("`{name}` cannot take {list}");
        self.error(Diagnostic::new(span, message).help(help))
    }

    /// Returns the part of an S1 coordinate that is its sine, cosine or tangent, as advice for `sin(q)` and the like.
    fn circle_part(&self, function: &str, arguments: &[Expr]) -> Option<String> {
        let [argument] = arguments else { return None };
        let ExprKind::Name(name) = &argument.kind else {
            return None;
        };
        if !self.is_circle(argument) {
            return None;
        }
        match function {
            "sin" => Some(format!("{name}.s")),
            "cos" => Some(format!("{name}.c")),
            "tan" => Some(format!("{name}.s / {name}.c")),
            _ => None,
        }
    }

    /// Returns the shape of an internal function that a joint calls for its axis, its placement or its plane.
    fn of_joint(&mut self, name: &str, argument: &'a Expr) -> Option<Shaped> {
        let found = self.of(argument)?.shape;
        let error = |message: &str| Diagnostic::new(argument.span, message);
        match (name, found) {
            (AXIS, Shape::Vector(3)) => Some(Shaped::of(found)),
            (PLANE, Shape::Vector(3)) => Some(Shaped::of(Shape::Matrix(3, 2))),
            (PLACE, Shape::Pose | Shape::Vector(3)) => Some(Shaped::of(Shape::Pose)),
            (PLACE, _) => self.error(
                error("the place of a joint has to be a pose or a point")
                    .help("write `at pose(R, p)`, or `at p` for a place without a turn"),
            ),
            _ => self.error(
                error("the axis of a joint has to be a vector of 3")
                    .help("write a direction, such as `[0, 0, 1]`"),
            ),
        }
    }
}

/// Returns the result of a call, or `None` if the function does not take such arguments.
fn value(name: &str, arguments: &[Shaped]) -> Option<Shaped> {
    use Shape::{Matrix, Pose, Scalar, Vector};
    let shapes: Vec<Shape> = arguments.iter().map(|one| one.shape).collect();
    let numbers = arguments.iter().map(Shaped::as_number);
    let numbers = numbers.collect::<Option<Vec<&BigRational>>>();
    let known = numbers.and_then(|numbers| number(name, &numbers));
    let shape = match (name, shapes.as_slice()) {
        ("tan" | "asin" | "acos" | "atan" | "log" | "sqrt", [Scalar]) => Scalar,
        ("atan2" | "min" | "max" | "hypot", [Scalar, Scalar]) => Scalar,
        ("clamp", [Scalar, Scalar, Scalar]) => Scalar,
        ("dot", [Vector(a), Vector(b)]) if a == b => Scalar,
        ("outer", [Vector(a), Vector(b)]) => Matrix(*a, *b),
        ("norm", [Vector(_)]) => Scalar,
        ("transpose", [Matrix(rows, columns)]) => Matrix(*columns, *rows),
        ("trace", [Matrix(rows, columns)]) if rows == columns => Scalar,
        ("diag", [Vector(n)]) => Matrix(*n, *n),
        ("diag", scalars) if is_size(scalars.len()) && scalars.iter().all(|s| *s == Scalar) => {
            Matrix(scalars.len(), scalars.len())
        }
        ("identity", [Scalar]) => {
            let number = arguments[0].as_number().filter(|n| n.is_integer())?;
            let size = number.to_integer().to_usize().filter(|n| is_size(*n))?;
            Matrix(size, size)
        }
        ("rotx" | "roty" | "rotz", turn) if is_turn(turn) => Shape::TURN,
        ("rpy", [Scalar, Scalar, Scalar]) => Shape::TURN,
        ("axis_angle", [Vector(3), turn @ ..]) if is_turn(turn) => Shape::TURN,
        ("rot", [Vector(4)]) => Shape::TURN,
        ("qmul", [Vector(4), Vector(4)]) => Vector(4),
        ("pose", [Shape::TURN, Vector(3)]) => Pose,
        ("translation", [Vector(3)]) => Pose,
        ("angle", [Vector(2)]) => Scalar,
        ("inverse", [Pose]) => Pose,
        ("cross", [Vector(3), Vector(3)]) => Vector(3),
        ("hat", [Vector(3)]) => Shape::TURN,
        ("vee", [Shape::TURN]) => Vector(3),
        (name, [Scalar]) if Function::from_name(name).is_some() => Scalar,
        _ => return None,
    };
    Some(known.map_or(Shaped::of(shape), Shaped::number))
}

/// Returns whether a function can produce this many rows.
fn is_size(rows: usize) -> bool {
    (1..=MOST_ENTRIES).contains(&rows)
}

/// Returns whether the arguments specify a rotation angle: an angle, its cosine and sine, or an S1 coordinate.
fn is_turn(shapes: &[Shape]) -> bool {
    use Shape::{Scalar, Vector};
    matches!(shapes, [Scalar] | [Scalar, Scalar] | [Vector(2)])
}

/// Evaluates the functions that select one of their arguments, or its magnitude, exactly.
fn number(name: &str, numbers: &[&BigRational]) -> Option<BigRational> {
    Some(match (name, numbers) {
        ("abs", [a]) => a.abs(),
        ("min", [a, b]) => (*a).min(b).clone(),
        ("max", [a, b]) => (*a).max(b).clone(),
        ("clamp", [a, low, high]) if low <= high => (*a).max(low).min(high).clone(),
        _ => return None,
    })
}
