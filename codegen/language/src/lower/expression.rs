//! Evaluates expressions to shaped values of the graph.

use super::scope::Scope;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{identity3, transpose};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::shapes::{MOST_ENTRIES, MOST_LEVELS};
use crate::syntax::ast::{Expr, ExprKind, Ident};
use num_traits::ToPrimitive;
use std::collections::BTreeMap;

/// Largest graph of a description; more is a mistake, such as products of large matrices of parameters.
const MOST_NODES: usize = 200_000;

/// Evaluates expressions whose shapes are checked; `None` means that an error has been reported, here or before.
pub struct Evaluator<'a> {
    /// Graph of the values.
    pub graph: &'a mut Graph,
    /// Values of names.
    pub scope: &'a Scope<'a>,
    /// Destination of errors.
    pub report: &'a mut Report,
    /// Values of the parameters of the function that is being evaluated; empty outside of functions.
    locals: BTreeMap<&'a str, Value>,
    /// Nesting depth of expressions, including those of the calling functions.
    level: usize,
}

impl<'a> Evaluator<'a> {
    /// Creates an evaluator outside of functions.
    pub fn new(graph: &'a mut Graph, scope: &'a Scope<'a>, report: &'a mut Report) -> Self {
        Evaluator {
            graph,
            scope,
            report,
            locals: BTreeMap::new(),
            level: 0,
        }
    }

    /// Creates an evaluator for the expression of a function with given values of its parameters.
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
    /// Evaluates an expression.
    pub fn value(&mut self, expr: &Expr) -> Option<Value> {
        let value = self.limited(expr);
        value.or_else(|| self.miss())
    }

    /// Returns `None` in place of a required value, and makes the description be refused even if no error explains why.
    pub fn miss<T>(&self) -> Option<T> {
        self.scope.missed.set(true);
        None
    }

    /// Evaluates an expression, unless it is nested too deeply or the graph has become too large.
    fn limited(&mut self, expr: &Expr) -> Option<Value> {
        if self.graph.len() > MOST_NODES {
            // Reported once, where the limit was crossed.
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
                let edge = self.graph.rational(&number.value);
                self.bounded(Value::Scalar(edge), expr.span)
            }
            ExprKind::Quantity(quantity) => self.value(&quantity.value),
            ExprKind::Name(name) => self.name(name),
            ExprKind::Field(base, field) => self.field(base, field),
            ExprKind::Index(base, indices) => self.index(base, indices),
            ExprKind::Call(function, arguments) => self.call(function, arguments, expr.span),
            ExprKind::InAxes(call, frame) => self.in_axes(call, frame),
            ExprKind::Neg(inner) => Some(self.value(inner)?.map(|edge| -edge)),
            ExprKind::Binary(op, left, right) => {
                let (a, b) = (self.value(left), self.value(right));
                self.binary(*op, a?, b?, left, right, expr.span)
            }
            ExprKind::If(choice) => self.choice(choice),
            ExprKind::Array(items) => self.array(items),
        }
    }

    /// Evaluates an expression that has to be a scalar.
    pub fn scalar(&mut self, expr: &Expr) -> Option<Edge> {
        self.value(expr)?.as_scalar().or_else(|| self.miss())
    }

    /// Evaluates an expression that has to be a vector of three entries.
    pub fn vec3(&mut self, expr: &Expr) -> Option<[Edge; 3]> {
        self.value(expr)?.as_vec3().or_else(|| self.miss())
    }

    /// Returns whether an expression is the name of an S1 coordinate.
    pub fn is_circle(&self, expr: &Expr) -> bool {
        matches!(&expr.kind, ExprKind::Name(name) if self.scope.symbols.is_circle(name) && !self.locals.contains_key(name.as_str()))
    }

    /// Reports an error.
    pub fn error<T>(&mut self, error: Diagnostic) -> Option<T> {
        self.report.push(error);
        None
    }

    /// Returns the pose of the world in itself.
    pub fn world(&self) -> Value {
        Value::Pose(identity3(self.graph), [self.graph.zero(); 3])
    }

    fn name(&mut self, name: &str) -> Option<Value> {
        if let Some(value) = self.locals.get(name) {
            return Some(value.clone());
        }
        if self.scope.symbols.get(name).is_some() {
            return self.scope.value(name).cloned();
        }
        match name {
            "world" => Some(self.world()),
            "pi" => {
                let mut symbols = self.graph.symbols().iter();
                let pi = symbols.find(|symbol| symbol.name == "pi")?;
                Some(Value::Scalar(Edge::of(pi.node)))
            }
            // An undefined name has been reported already.
            _ => None,
        }
    }

    fn field(&mut self, base: &Expr, field: &Ident) -> Option<Value> {
        match (self.value(base)?, field.name.as_str()) {
            (Value::Vector(v), "c") => v.first().copied().map(Value::Scalar),
            (Value::Vector(v), "s") => v.get(1).copied().map(Value::Scalar),
            (Value::Matrix(m), "T") => Some(Value::Matrix(transpose(&m))),
            (Value::Pose(r, _), "R") => Some(Value::from_mat3(&r)),
            (Value::Pose(_, p), "p") => Some(Value::Vector(p.to_vec())),
            _ => None,
        }
    }

    fn index(&mut self, base: &Expr, indices: &[Expr]) -> Option<Value> {
        let value = self.value(base);
        let places: Vec<Option<usize>> = indices.iter().map(|index| self.place(index)).collect();
        let places = places.into_iter().collect::<Option<Vec<usize>>>()?;
        match (value?, places.as_slice()) {
            (Value::Vector(v), [entry]) => v.get(*entry).copied().map(Value::Scalar),
            (Value::Matrix(m), [row]) => m.get(*row).cloned().map(Value::Vector),
            (Value::Matrix(m), [row, column]) => {
                m.get(*row)?.get(*column).copied().map(Value::Scalar)
            }
            _ => None,
        }
    }

    /// Evaluates an index, and converts it to one that counts from 0.
    fn place(&mut self, index: &Expr) -> Option<usize> {
        let edge = self.scalar(index)?;
        let number = self.graph.as_rational(edge)?;
        number.to_integer().to_usize()?.checked_sub(1)
    }

    fn array(&mut self, items: &[Expr]) -> Option<Value> {
        let values: Vec<Option<Value>> = items.iter().map(|item| self.value(item)).collect();
        let values = values.into_iter().collect::<Option<Vec<Value>>>()?;
        let first = values.first()?;
        if values.len() > MOST_ENTRIES || !values.iter().all(|value| value.same_shape(first)) {
            return None;
        }
        let rows = values.iter().map(Value::entries);
        match first {
            Value::Scalar(_) => Some(Value::Vector(rows.flatten().collect())),
            Value::Vector(_) => Some(Value::Matrix(rows.collect())),
            Value::Matrix(_) | Value::Pose(..) => None,
        }
    }
}
