//! Expressions to values: names looked up, shapes checked, exact numbers folded.

use super::scope::{NameKind, Scope};
use super::value::Value;
use crate::algebra::graph::{Edge, Function, Graph};
use crate::algebra::linear::{add3, apply3, multiply, multiply3, transpose};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{BinaryOp, CoordKind, Expr, ExprKind, Ident, Span};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// Largest size in bits of an exact number.
const LARGEST_NUMBER: u64 = 20_000;
/// Largest whole exponent.
const LARGEST_EXPONENT: i64 = 1000;

/// Evaluates expressions; `None` means that an error has been reported.
pub struct Evaluator<'a> {
    /// The graph that values live in.
    pub graph: &'a mut Graph,
    /// The names.
    pub scope: &'a Scope,
    /// Where errors go.
    pub report: &'a mut Report,
}

impl Evaluator<'_> {
    /// The value of an expression.
    pub fn value(&mut self, expr: &Expr) -> Option<Value> {
        match &expr.kind {
            ExprKind::Number(number) => Some(Value::Scalar(self.graph.rational(number))),
            ExprKind::Name(name) => self.name(name, expr.span),
            ExprKind::Field(base, field) => self.field(base, field),
            ExprKind::Index(base, indices) => self.index(base, indices, expr.span),
            ExprKind::Call(function, arguments) => self.call(function, arguments, expr.span),
            ExprKind::Neg(inner) => Some(self.value(inner)?.map(|edge| -edge)),
            ExprKind::Binary(op, left, right) => {
                let (a, b) = (self.value(left), self.value(right));
                self.binary(*op, a?, b?, left, right, expr.span)
            }
            ExprKind::Array(items) => self.array(items, expr.span),
        }
    }

    /// The value of an expression that has to be a scalar.
    pub fn scalar(&mut self, expr: &Expr, what: &str) -> Option<Edge> {
        match self.value(expr)? {
            Value::Scalar(edge) => Some(edge),
            other => self.wrong_shape(expr.span, what, "a scalar", &other),
        }
    }

    /// The value of an expression that has to be a vector of three.
    pub fn vec3(&mut self, expr: &Expr, what: &str) -> Option<[Edge; 3]> {
        let value = self.value(expr)?;
        match value.as_vec3() {
            Some(v) => Some(v),
            None => self.wrong_shape(expr.span, what, "a vector of 3", &value),
        }
    }

    /// Reports a wrong shape.
    pub fn wrong_shape<T>(
        &mut self,
        span: Span,
        what: &str,
        wanted: &str,
        found: &Value,
    ) -> Option<T> {
        self.error(Diagnostic::new(
            span,
            format!("{what} has to be {wanted}, this is {}", found.shape()),
        ))
    }

    /// Reports an error.
    pub fn error<T>(&mut self, error: Diagnostic) -> Option<T> {
        self.report.push(error);
        None
    }

    fn name(&mut self, name: &str, span: Span) -> Option<Value> {
        match self.scope.get(name) {
            Some(entry) if entry.kind == NameKind::Output => self.error(
                Diagnostic::new(
                    span,
                    format!("`{name}` is an output, which other expressions cannot use"),
                )
                .help(format!(
                    "name the expression with `let` and use that, also in `output {name}`"
                )),
            ),
            Some(entry) => entry.value.clone(),
            None if name == "world" => {
                let graph = &*self.graph;
                Some(Value::Pose(
                    crate::algebra::linear::identity3(graph),
                    [graph.zero(); 3],
                ))
            }
            None if name == "pi" => {
                let known = self
                    .graph
                    .symbols()
                    .iter()
                    .find(|s| s.name == "pi")
                    .map(|s| s.node);
                known.map(|node| Value::Scalar(Edge::of(node)))
            }
            None => {
                let error = self.scope.unknown(
                    span,
                    name,
                    "parameter, constant, coordinate, velocity, input or expression",
                    |_| true,
                );
                self.error(error)
            }
        }
    }

    fn field(&mut self, base: &Expr, field: &Ident) -> Option<Value> {
        if let ExprKind::Name(name) = &base.kind
            && let Some(entry) = self.scope.get(name)
            && entry.kind == NameKind::Coord(CoordKind::S1)
        {
            let entries = entry.value.as_ref()?.entries();
            match field.name.as_str() {
                "c" => return Some(Value::Scalar(entries[0])),
                "s" => return Some(Value::Scalar(entries[1])),
                _ => {}
            }
        }
        let value = self.value(base)?;
        match (&value, field.name.as_str()) {
            (Value::Matrix(m), "T") => Some(Value::Matrix(transpose(m))),
            (Value::Pose(r, _), "R") => Some(Value::from_mat3(r)),
            (Value::Pose(_, p), "p") => Some(Value::Vector(p.to_vec())),
            _ => self.error(
                Diagnostic::new(field.span, format!("{} has no part `.{}`", value.shape(), field.name))
                    .help("parts are `.R` and `.p` of a pose, `.c` and `.s` of an S1 coordinate, `.T` of a matrix"),
            ),
        }
    }

    fn index(&mut self, base: &Expr, indices: &[Expr], span: Span) -> Option<Value> {
        let value = self.value(base)?;
        let places: Vec<Option<usize>> = indices.iter().map(|index| self.place(index)).collect();
        let places = places.into_iter().collect::<Option<Vec<usize>>>()?;
        let out_of_range = |this: &mut Self, place: usize, length: usize| {
            this.error(
                Diagnostic::new(
                    span,
                    format!(
                        "index {place} is out of range, {} has {length}",
                        value.shape()
                    ),
                )
                .help(format!("indices run from 1 to {length}, as in the paper")),
            )
        };
        match (&value, places.as_slice()) {
            (Value::Vector(v), [i]) => match v.get(i.wrapping_sub(1)) {
                Some(&edge) => Some(Value::Scalar(edge)),
                None => out_of_range(self, *i, v.len()),
            },
            (Value::Matrix(m), [i]) => match m.get(i.wrapping_sub(1)) {
                Some(row) => Some(Value::Vector(row.clone())),
                None => out_of_range(self, *i, m.len()),
            },
            (Value::Matrix(m), [i, j]) => match m.get(i.wrapping_sub(1)) {
                Some(row) => match row.get(j.wrapping_sub(1)) {
                    Some(&edge) => Some(Value::Scalar(edge)),
                    None => out_of_range(self, *j, row.len()),
                },
                None => out_of_range(self, *i, m.len()),
            },
            _ => self.error(
                Diagnostic::new(
                    span,
                    format!("{} cannot take {} indices", value.shape(), places.len()),
                )
                .help("a vector takes one index, a matrix one (a row) or two"),
            ),
        }
    }

    fn place(&mut self, index: &Expr) -> Option<usize> {
        let edge = self.scalar(index, "an index")?;
        let number = self
            .graph
            .as_rational(edge)
            .filter(|n| n.is_integer())
            .and_then(|n| n.to_integer().to_usize());
        match number {
            Some(place) => Some(place),
            None => self.error(
                Diagnostic::new(
                    index.span,
                    "an index has to be a whole number known at build time",
                )
                .help("indices start at 1"),
            ),
        }
    }

    fn array(&mut self, items: &[Expr], span: Span) -> Option<Value> {
        let values: Vec<Option<Value>> = items.iter().map(|item| self.value(item)).collect();
        let values = values.into_iter().collect::<Option<Vec<Value>>>()?;
        let first = values.first()?;
        if let Some((item, other)) = items
            .iter()
            .zip(&values)
            .find(|(_, v)| !v.same_shape(first))
        {
            return self.error(
                Diagnostic::new(
                    item.span,
                    format!(
                        "this entry is {}, the first is {}",
                        other.shape(),
                        first.shape()
                    ),
                )
                .help(
                    "entries of a vector are scalars, entries of a matrix are rows of equal length",
                ),
            );
        }
        match first {
            Value::Scalar(_) => Some(Value::Vector(
                values.iter().flat_map(Value::entries).collect(),
            )),
            Value::Vector(_) => Some(Value::Matrix(values.iter().map(Value::entries).collect())),
            _ => self.error(
                Diagnostic::new(
                    span,
                    format!(
                        "an array of {} is no vector and no matrix",
                        first.shape().trim_start_matches("a ")
                    ),
                )
                .help(
                    "entries of a vector are scalars, entries of a matrix are rows of equal length",
                ),
            ),
        }
    }

    fn binary(
        &mut self,
        op: BinaryOp,
        a: Value,
        b: Value,
        left: &Expr,
        right: &Expr,
        span: Span,
    ) -> Option<Value> {
        let graph = &mut *self.graph;
        let result = match op {
            BinaryOp::Add | BinaryOp::Sub => {
                if !a.same_shape(&b) || matches!(a, Value::Pose(..)) {
                    let (verb, word) = if op == BinaryOp::Add {
                        ("add", "to")
                    } else {
                        ("subtract", "from")
                    };
                    let (first, second) = if op == BinaryOp::Add {
                        (&a, &b)
                    } else {
                        (&b, &a)
                    };
                    return self.error(
                        Diagnostic::new(
                            span,
                            format!("cannot {verb} {} {word} {}", first.shape(), second.shape()),
                        )
                        .help("both sides need the same shape"),
                    );
                }
                if op == BinaryOp::Add {
                    a.zip(&b, |x, y| graph.add(x, y))
                } else {
                    a.zip(&b, |x, y| graph.sub(x, y))
                }
            }
            BinaryOp::Mul => return self.product(a, b, span),
            BinaryOp::Div => {
                let Value::Scalar(divisor) = b else {
                    return self.error(
                        Diagnostic::new(right.span, format!("cannot divide by {}", b.shape()))
                            .help("divide by a scalar"),
                    );
                };
                if divisor == graph.zero() {
                    return self.error(
                        Diagnostic::new(
                            right.span,
                            "division by something that is identically zero",
                        )
                        .help("this is 0 for every configuration that satisfies the constraint"),
                    );
                }
                a.map(|edge| graph.div(edge, divisor).unwrap_or(edge))
            }
            BinaryOp::Pow => return self.power(a, b, left, right),
        };
        self.bounded(result, span)
    }

    /// The value, unless one of its numbers has grown beyond all use.
    fn bounded(&mut self, value: Value, span: Span) -> Option<Value> {
        let large = |edge: &Edge| {
            self.graph
                .as_rational(*edge)
                .is_some_and(|n| n.numer().bits().max(n.denom().bits()) > LARGEST_NUMBER)
        };
        if value.entries().iter().any(large) {
            return self.error(
                Diagnostic::new(span, "this number has too many digits")
                    .help("scale the units of the model"),
            );
        }
        Some(value)
    }

    fn product(&mut self, a: Value, b: Value, span: Span) -> Option<Value> {
        let graph = &mut *self.graph;
        let columns = |m: &[Vec<Edge>]| m.first().map_or(0, Vec::len);
        let result = match (&a, &b) {
            (Value::Scalar(k), Value::Scalar(_) | Value::Vector(_) | Value::Matrix(_)) => {
                b.map(|edge| graph.mul(*k, edge))
            }
            (Value::Vector(_) | Value::Matrix(_), Value::Scalar(k)) => {
                a.map(|edge| graph.mul(edge, *k))
            }
            (Value::Matrix(m), Value::Vector(v)) if columns(m) == v.len() => {
                Value::Vector(m.iter().map(|row| graph.dot(row, v)).collect())
            }
            (Value::Matrix(m), Value::Matrix(n)) if columns(m) == n.len() => {
                Value::Matrix(multiply(graph, m, n))
            }
            (Value::Pose(r, p), Value::Pose(r2, p2)) => {
                let moved = apply3(graph, r, *p2);
                Value::Pose(multiply3(graph, r, r2), add3(graph, *p, moved))
            }
            (Value::Pose(r, p), Value::Vector(_)) if b.as_vec3().is_some() => {
                let point = b.as_vec3()?;
                let moved = apply3(graph, r, point);
                Value::Vector(add3(graph, *p, moved).to_vec())
            }
            _ => {
                let help = match (&a, &b) {
                    (Value::Vector(_), Value::Vector(_)) => {
                        "write `dot(a, b)`, `cross(a, b)` or `outer(a, b)`"
                    }
                    (Value::Vector(_), Value::Matrix(_)) => {
                        "write the matrix first, transposed: `M.T * v`"
                    }
                    _ => "the columns of the left have to be as many as the rows of the right",
                };
                return self.error(
                    Diagnostic::new(
                        span,
                        format!("cannot multiply {} by {}", a.shape(), b.shape()),
                    )
                    .help(help),
                );
            }
        };
        self.bounded(result, span)
    }

    fn power(&mut self, a: Value, b: Value, left: &Expr, right: &Expr) -> Option<Value> {
        let Value::Scalar(base) = a else {
            return self.error(
                Diagnostic::new(left.span, format!("cannot raise {} to a power", a.shape()))
                    .help("powers are of scalars; write `dot(v, v)` or `M * M`"),
            );
        };
        let exponent = match &b {
            Value::Scalar(edge) => self.graph.as_rational(*edge),
            _ => None,
        };
        let Some(exponent) = exponent else {
            return self.error(
                Diagnostic::new(
                    right.span,
                    "an exponent has to be a rational number known at build time",
                )
                .help("for other powers write `exp(b * log(a))`"),
            );
        };
        let whole = exponent
            .is_integer()
            .then(|| exponent.to_integer().to_i64())
            .flatten();
        if base == self.graph.zero() && !exponent.is_positive() {
            return self.error(
                Diagnostic::new(left.span, "division by something that is identically zero")
                    .help("a power of 0 needs a positive exponent"),
            );
        }
        let twice = &exponent + &exponent;
        let result = if let Some(n) = whole.filter(|n| n.abs() <= LARGEST_EXPONENT) {
            let bits = self
                .graph
                .as_rational(base)
                .map_or(0, |n| n.numer().bits().max(n.denom().bits()));
            if bits.saturating_mul(n.unsigned_abs()) > 2 * LARGEST_NUMBER {
                return self.error(
                    Diagnostic::new(left.span, "this power has too many digits")
                        .help("scale the units of the model"),
                );
            }
            self.graph.powi(base, n)
        } else if let Some(n) = twice
            .is_integer()
            .then(|| twice.to_integer().to_i64())
            .flatten()
            .filter(|n| n.abs() <= LARGEST_EXPONENT)
        {
            let root = self.graph.apply(Function::Sqrt, base);
            self.graph.powi(root, n)
        } else if exponent.is_zero() {
            Some(self.graph.one())
        } else if exponent.abs()
            > BigRational::one() * BigRational::from_integer(LARGEST_EXPONENT.into())
        {
            return self.error(
                Diagnostic::new(right.span, "this exponent is too large")
                    .help(format!("exponents reach to {LARGEST_EXPONENT}")),
            );
        } else {
            let factor = self.graph.rational(&exponent);
            let log = self.graph.apply(Function::Log, base);
            let product = self.graph.mul(factor, log);
            Some(self.graph.apply(Function::Exp, product))
        };
        self.bounded(Value::Scalar(result?), left.span.to(right.span))
    }
}
