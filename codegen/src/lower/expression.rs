//! Expressions become shaped values of the graph.

use super::scope::Scope;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{identity3, transpose};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::syntax::ast::{Expr, ExprKind, Ident, Span};
use num_traits::ToPrimitive;
use std::collections::BTreeMap;

/// Largest graph of one description: what grows beyond is a mistake, such as products of large
/// matrices of parameters.
const MOST_NODES: usize = 200_000;

/// The deepest nesting of expressions, functions written out: one expression alone is never so deep.
const MOST_LEVELS: usize = 640;

/// Largest number of entries of an array.
const MOST_ENTRIES: usize = 64;

/// Evaluates expressions; `None` means that an error has been reported.
pub struct Evaluator<'a> {
    /// The graph that values live in.
    pub graph: &'a mut Graph,
    /// The names.
    pub scope: &'a Scope<'a>,
    /// Where errors go.
    pub report: &'a mut Report,
    /// Values of the parameters of the function whose value is wanted; none outside of functions.
    locals: BTreeMap<&'a str, Value>,
    /// How deep expressions are nested here, those of the functions around included.
    level: usize,
}

impl<'a> Evaluator<'a> {
    /// An evaluator outside of functions.
    pub fn new(graph: &'a mut Graph, scope: &'a Scope<'a>, report: &'a mut Report) -> Self {
        Evaluator {
            graph,
            scope,
            report,
            locals: BTreeMap::new(),
            level: 0,
        }
    }

    /// An evaluator of the value of a function, where its parameters have these values.
    pub fn within<'b>(
        &'b mut self,
        report: &'b mut Report,
        locals: BTreeMap<&'b str, Value>,
    ) -> Evaluator<'b> {
        Evaluator {
            graph: self.graph,
            scope: self.scope,
            report,
            locals,
            level: self.level,
        }
    }
    /// The value of an expression.
    pub fn value(&mut self, expr: &Expr) -> Option<Value> {
        if self.graph.len() > MOST_NODES {
            // Reported where it was crossed.
            return None;
        }
        if self.level >= MOST_LEVELS {
            let error = Diagnostic::new(expr.span, "functions call one another too deeply here");
            return self.error(error.help("write some of them out, or name parts with `let`"));
        }
        self.level += 1;
        let value = self.evaluated(expr);
        self.level -= 1;
        if self.graph.len() > MOST_NODES && value.is_some() {
            return self.error(
                Diagnostic::new(
                    expr.span,
                    "the description grows too large with this expression",
                )
                .help("use smaller matrices, or write out the entries that matter"),
            );
        }
        value.map(|value| value.unsigned_zeros(self.graph))
    }

    fn evaluated(&mut self, expr: &Expr) -> Option<Value> {
        match &expr.kind {
            ExprKind::Number(number) => {
                let edge = self.graph.rational(number);
                self.bounded(Value::Scalar(edge), expr.span)
            }
            ExprKind::Name(name) => self.name(name),
            ExprKind::Field(base, field) => self.field(base, field),
            ExprKind::Index(base, indices) => self.index(base, indices, expr.span),
            ExprKind::Call(function, arguments) => self.call(function, arguments, expr.span),
            ExprKind::InAxes(call, frame) => self.in_axes(call, frame),
            ExprKind::Neg(inner) => Some(self.value(inner)?.map(|edge| -edge)),
            ExprKind::Binary(op, left, right) => {
                let (a, b) = (self.value(left), self.value(right));
                self.binary(*op, a?, b?, left, right, expr.span)
            }
            ExprKind::If(choice) => self.choice(choice),
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
        let help = match (wanted, found) {
            ("a scalar", Value::Vector(_)) => {
                "an entry is written `v[1]`, a length `norm(v)`, a product `dot(a, b)`"
            }
            ("a scalar", Value::Matrix(_)) => "an entry is written `M[1, 2]`",
            ("a vector of 3", Value::Scalar(_)) => "a vector is written `[a, b, c]`",
            ("a vector of 3", Value::Vector(v)) if v.len() == 2 => {
                "in the plane, write `[v[1], v[2], 0]`"
            }
            (_, Value::Pose(..)) => "its parts are `.R` and `.p`",
            _ => "a vector is written `[a, b, c]`, a matrix by rows `[[a, b], [c, d]]`",
        };
        let message = format!("{what} has to be {wanted}, this is {}", found.shape());
        self.error(Diagnostic::new(span, message).help(help))
    }

    /// Reports an error.
    pub fn error<T>(&mut self, error: Diagnostic) -> Option<T> {
        self.report.push(error);
        None
    }

    /// The pose of the world in itself.
    pub fn world(&self) -> Value {
        Value::Pose(identity3(self.graph), [self.graph.zero(); 3])
    }

    fn name(&mut self, name: &str) -> Option<Value> {
        if let Some(value) = self.locals.get(name) {
            return Some(value.clone());
        }
        if self.scope.symbols.get(name).is_some() {
            let value = self.scope.value(name).cloned();
            self.scope
                .missed
                .set(self.scope.missed.get() || value.is_none());
            return value;
        }
        match name {
            "world" => Some(self.world()),
            "pi" => {
                let mut symbols = self.graph.symbols().iter();
                let pi = symbols.find(|symbol| symbol.name == "pi")?;
                Some(Value::Scalar(Edge::of(pi.node)))
            }
            // A name that stands for nothing is an error already.
            _ => None,
        }
    }

    fn field(&mut self, base: &Expr, field: &Ident) -> Option<Value> {
        let value = self.value(base)?;
        let circle =
            matches!(&base.kind, ExprKind::Name(name) if self.scope.symbols.is_circle(name));
        let help = match (&value, field.name.as_str()) {
            (Value::Vector(v), "c") if circle => return v.first().copied().map(Value::Scalar),
            (Value::Vector(v), "s") if circle => return v.get(1).copied().map(Value::Scalar),
            (Value::Matrix(m), "T") => return Some(Value::Matrix(transpose(m))),
            (Value::Pose(r, _), "R") => return Some(Value::from_mat3(r)),
            (Value::Pose(_, p), "p") => return Some(Value::Vector(p.to_vec())),
            (Value::Vector(_), _) if circle => {
                "an S1 coordinate has `.c` and `.s`, its cosine and sine"
            }
            (Value::Vector(_), "T") => "write `dot(a, b)` or `outer(a, b)`",
            (Value::Vector(_), _) => "entries are written `v[1]`, `v[2]`, …",
            (Value::Matrix(_), _) => {
                "a matrix has `.T`, its transpose; entries are written `M[1, 2]`"
            }
            (Value::Pose(..), _) => "a pose has `.R` and `.p`",
            (Value::Scalar(_), _) => "a scalar has no parts",
        };
        let message = format!("{} has no part `.{}`", value.shape(), field.name);
        self.error(Diagnostic::new(field.span, message).help(help))
    }

    fn index(&mut self, base: &Expr, indices: &[Expr], span: Span) -> Option<Value> {
        let value = self.value(base);
        let places: Vec<Option<usize>> = indices.iter().map(|index| self.place(index)).collect();
        let value = value?;
        let places = places.into_iter().collect::<Option<Vec<usize>>>()?;
        let entry = |this: &mut Self, length: usize, which: usize| {
            let place = places[which];
            if (1..=length).contains(&place) {
                return Some(place - 1);
            }
            let message = format!(
                "index {place} is out of range, {} has {length}",
                value.shape()
            );
            let what = match (&value, which) {
                (Value::Matrix(_), 0) => " rows",
                (Value::Matrix(_), _) => " columns",
                _ => " entries",
            };
            this.error(
                Diagnostic::new(indices[which].span, message + what)
                    .help(format!("indices run from 1 to {length}")),
            )
        };
        match (&value, places.len()) {
            (Value::Vector(v), 1) => Some(Value::Scalar(v[entry(self, v.len(), 0)?])),
            (Value::Matrix(m), 1) => Some(Value::Vector(m[entry(self, m.len(), 0)?].clone())),
            (Value::Matrix(m), 2) => {
                let row = entry(self, m.len(), 0);
                let column = entry(self, m.first().map_or(0, Vec::len), 1);
                Some(Value::Scalar(m[row?][column?]))
            }
            (Value::Pose(..), _) => self.error(
                Diagnostic::new(span, "a pose cannot be indexed")
                    .help("its parts are `.R` and `.p`, as in `f.p[1]`"),
            ),
            (_, count) => {
                let plural = if count == 1 { "index" } else { "indices" };
                let message = format!("{} cannot take {count} {plural}", value.shape());
                self.error(
                    Diagnostic::new(span, message)
                        .help("a vector takes one index, a matrix one (for a row) or two"),
                )
            }
        }
    }

    fn place(&mut self, index: &Expr) -> Option<usize> {
        let edge = self.scalar(index, "an index")?;
        let number = self.graph.as_rational(edge).filter(|n| n.is_integer());
        match number.and_then(|n| n.to_integer().to_usize()) {
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
        const HELP: &str =
            "entries of a vector are scalars, entries of a matrix are rows of equal length";
        let values: Vec<Option<Value>> = items.iter().map(|item| self.value(item)).collect();
        let values = values.into_iter().collect::<Option<Vec<Value>>>()?;
        let first = values.first()?;
        if items.len() > MOST_ENTRIES {
            return self.error(
                Diagnostic::new(span, format!("an array of {} entries", items.len())).help(
                    format!("vectors and matrices reach to {MOST_ENTRIES} rows and columns"),
                ),
            );
        }
        let other = items
            .iter()
            .zip(&values)
            .find(|(_, v)| !v.same_shape(first));
        if let Some((item, other)) = other {
            let message = format!(
                "this entry is {}, the first is {}",
                other.shape(),
                first.shape()
            );
            return self.error(Diagnostic::new(item.span, message).help(HELP));
        }
        match first {
            Value::Scalar(_) => Some(Value::Vector(
                values.iter().flat_map(Value::entries).collect(),
            )),
            Value::Vector(_) => Some(Value::Matrix(values.iter().map(Value::entries).collect())),
            Value::Matrix(_) | Value::Pose(..) => self.error(
                Diagnostic::new(
                    span,
                    format!("an array whose entries are each {}", first.shape()),
                )
                .help(HELP),
            ),
        }
    }
}
