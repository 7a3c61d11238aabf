//! Dimensions of expressions, from those of their parts.

use super::form::{Form, Term};
use super::unification::Unknowns;
use super::value::Value;
use crate::diagnostics::Report;
use crate::shapes::{Inference, MOST_LEVELS, Shape, Shaped};
use crate::symbols::{Resolved, Symbols};
use crate::syntax::ast::{BinaryOp, Choice, Expr, ExprKind, Ident, Span, System};
use crate::units::Dimension;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use std::collections::BTreeMap;

/// A call of a function of the description: its name, with shapes and dimensions of its arguments.
type Called<'a> = (&'a str, Vec<(Option<Shaped>, Value)>);

/// State of the inference.
pub struct Walk<'a> {
    /// Symbol table.
    pub symbols: &'a Symbols<'a>,
    /// Shapes of names and expressions.
    pub shapes: Inference<'a>,
    /// Errors so far.
    pub report: Report,
    /// Unknown dimensions.
    pub unknowns: Unknowns,
    /// Dimensions of names; those of functions are in `functions`.
    pub names: BTreeMap<&'a str, Value>,
    /// Places where names got their units, or their values.
    pub places: BTreeMap<&'a str, Span>,
    /// Arguments and result of tables and of functions in Rust.
    pub functions: BTreeMap<&'a str, (Vec<Term>, Value)>,
    /// Parameters of the function whose body is being read. Empty outside of functions.
    pub locals: BTreeMap<&'a str, Value>,
    /// Results of calls.
    pub called: BTreeMap<Called<'a>, Value>,
    level: usize,
}

impl<'a> Walk<'a> {
    /// Creates a state in which no names are known.
    pub fn new(system: &'a System, names: &'a Resolved<'a>, shapes: Inference<'a>) -> Self {
        let mut walk = Walk {
            symbols: &names.symbols,
            shapes,
            report: Report::new(),
            unknowns: Unknowns::default(),
            names: BTreeMap::new(),
            places: BTreeMap::new(),
            functions: BTreeMap::new(),
            locals: BTreeMap::new(),
            called: BTreeMap::new(),
            level: 0,
        };
        walk.functions_of(system);
        walk
    }

    /// Returns the dimensions of an expression.
    pub fn of(&mut self, expr: &'a Expr) -> Value {
        if self.level >= MOST_LEVELS {
            // Excessive nesting is reported on evaluation.
            return self.unknown(expr);
        }
        self.level += 1;
        let value = self.inferred(expr);
        self.level -= 1;
        value
    }

    /// Returns a value of the shape of an expression about whose dimensions nothing is known.
    pub fn unknown(&mut self, expr: &'a Expr) -> Value {
        let shape = self
            .shapes
            .of(expr)
            .map_or(Shape::Scalar, |found| found.shape);
        Value::uniform(shape, self.unknowns.fresh("this expression"))
    }

    fn inferred(&mut self, expr: &'a Expr) -> Value {
        match &expr.kind {
            ExprKind::Number(number) if number.value == BigRational::default() => {
                Value::scalar(Term::Zero)
            }
            ExprKind::Number(_) => Value::scalar(Term::Plain),
            ExprKind::Quantity(quantity) => {
                let shape = self.shapes.of(&quantity.value).map(|found| found.shape);
                let term = Term::of(quantity.unit.dimension.clone());
                Value::uniform(shape.unwrap_or(Shape::Scalar), term)
            }
            ExprKind::Name(name) => self.name(name, expr),
            ExprKind::Field(base, field) => self.field(base, field),
            ExprKind::Index(base, indices) => self.index(base, indices),
            ExprKind::Call(function, arguments) => self.call(function, arguments, expr),
            ExprKind::InAxes(call, _) => self.of(call),
            ExprKind::Neg(inner) => self.of(inner),
            ExprKind::Binary(op, left, right) => self.binary(*op, left, right, expr),
            ExprKind::If(choice) => self.choice(choice),
            ExprKind::Array(items) => self.array(items, expr),
        }
    }

    fn name(&mut self, name: &str, expr: &'a Expr) -> Value {
        if let Some(value) = self.locals.get(name).or_else(|| self.names.get(name)) {
            return value.clone();
        }
        match name {
            "pi" => Value::scalar(Term::one()),
            "world" => Value::uniform(Shape::Pose, Term::one()),
            _ => self.unknown(expr),
        }
    }

    fn field(&mut self, base: &'a Expr, field: &Ident) -> Value {
        let value = self.of(base);
        match (value.shape, field.name.as_str()) {
            (Shape::Matrix(rows, columns), "T") => {
                let places = (0..columns).flat_map(|i| (0..rows).map(move |k| k * columns + i));
                let entries = places.map(|place| value.at(place).clone()).collect();
                Value::of(Shape::Matrix(columns, rows), entries)
            }
            (Shape::Pose, "p") => length(Shape::Vector(3)),
            (Shape::Pose, _) => Value::uniform(Shape::TURN, Term::one()),
            (_, field) => Value::scalar(value.at(usize::from(field == "s")).clone()),
        }
    }

    fn index(&mut self, base: &'a Expr, indices: &'a [Expr]) -> Value {
        let value = self.of(base);
        let place = |index: &'a Expr, shapes: &mut Inference<'a>| {
            let found = shapes.of(index)?;
            found.as_number()?.to_integer().to_usize()?.checked_sub(1)
        };
        let places: Option<Vec<usize>> = indices
            .iter()
            .map(|index| place(index, &mut self.shapes))
            .collect();
        match (value.shape, places.as_deref()) {
            (Shape::Matrix(_, columns), Some([row])) => {
                let entries = (0..columns).map(|k| value.at(row * columns + k).clone());
                Value::of(Shape::Vector(columns), entries.collect())
            }
            (Shape::Matrix(_, columns), Some([row, column])) => {
                Value::scalar(value.at(row * columns + column).clone())
            }
            (_, Some([place])) => Value::scalar(value.at(*place).clone()),
            _ => Value::scalar(self.unknowns.fresh("this index")),
        }
    }

    /// Returns the dimensions of a vector, or of a matrix by rows. In a vector of 3, plain numbers have the dimension of
    /// the other entries, if these have one, so that `[a, 0, 0.03]` with a length a is a point.
    fn array(&mut self, items: &'a [Expr], expr: &'a Expr) -> Value {
        let mut rows = Vec::new();
        for item in items {
            rows.push(match &item.kind {
                ExprKind::Array(entries) => Value::of(
                    Shape::Vector(entries.len()),
                    entries
                        .iter()
                        .map(|entry| self.of(entry).at(0).clone())
                        .collect(),
                ),
                _ => self.of(item),
            });
        }
        let all = |row: &Value| {
            (0..row.len())
                .map(|place| row.at(place).clone())
                .collect::<Vec<_>>()
        };
        let mut entries: Vec<Term> = rows.iter().flat_map(all).collect();
        let shape = match rows.first().map(|row| row.shape) {
            Some(Shape::Vector(n)) => Shape::Matrix(rows.len(), n),
            Some(Shape::Scalar) => Shape::Vector(rows.len()),
            _ => return self.unknown(expr),
        };
        if let (Shape::Vector(3), Some(of_others)) = (shape, self.of_others(&entries)) {
            let plain = entries.iter_mut().filter(|term| **term == Term::Plain);
            plain.for_each(|term| *term = of_others.clone());
        }
        Value::of(shape, entries)
    }

    /// Returns the dimension of the entries that are not plain numbers, if they have one and are no numbers.
    fn of_others(&self, entries: &[Term]) -> Option<Term> {
        let forms = entries.iter().filter_map(|term| match term {
            Term::Quantity(form) => Some(self.unknowns.reduced(form)),
            Term::Zero | Term::Plain => None,
        });
        let forms: Vec<Form> = forms.collect();
        let first = forms.first()?;
        let numbers = first.as_known().is_some_and(Dimension::is_one);
        let same = !numbers && forms.iter().all(|form| form == first);
        same.then(|| Term::Quantity(first.clone()))
    }

    fn choice(&mut self, choice: &'a Choice) -> Value {
        let Choice {
            left,
            right,
            then,
            otherwise,
            ..
        } = choice;
        let (a, b) = (self.of(left), self.of(right));
        self.same((&a, left), (&b, right), |a, b| {
            format!("cannot compare {b} with {a}")
        });
        let (a, b) = (self.of(then), self.of(otherwise));
        self.same((&a, then), (&b, otherwise), |a, b| {
            format!("this branch is {b}, but the one before is {a}")
        })
    }

    fn binary(&mut self, op: BinaryOp, left: &'a Expr, right: &'a Expr, expr: &'a Expr) -> Value {
        let (a, b) = (self.of(left), self.of(right));
        match op {
            BinaryOp::Add => self.same((&a, left), (&b, right), |a, b| {
                format!("cannot add {b} to {a}")
            }),
            BinaryOp::Sub => self.same((&a, left), (&b, right), |a, b| {
                format!("cannot subtract {b} from {a}")
            }),
            BinaryOp::Mul => self.product(&a, &b, expr),
            BinaryOp::Div => a.map(|term| term.quotient(b.at(0))),
            BinaryOp::Pow => self.power(&a, &b, left, right),
        }
    }

    fn power(&mut self, a: &Value, b: &Value, left: &'a Expr, right: &'a Expr) -> Value {
        self.wants(right, b, "an exponent", &Dimension::one());
        let known = self
            .shapes
            .of(right)
            .and_then(|found| found.as_number().cloned());
        match known {
            Some(exponent) => a.map(|term| term.power(&exponent)),
            None => {
                let what = "the base of a power whose exponent is no number of the text";
                self.wants(left, a, what, &Dimension::one());
                a.clone()
            }
        }
    }

    fn product(&mut self, a: &Value, b: &Value, expr: &'a Expr) -> Value {
        match (a.shape, b.shape) {
            (Shape::Pose, Shape::Pose) => Value::uniform(Shape::Pose, Term::one()),
            (Shape::Pose, shape) => {
                if let ExprKind::Binary(_, _, right) = &expr.kind {
                    self.wants(
                        right,
                        b,
                        "a point of a frame",
                        &Dimension::of([0, 1, 0, 0, 0]),
                    );
                }
                length(shape)
            }
            (Shape::Scalar, _) => b.map(|term| a.at(0).product(term)),
            (_, Shape::Scalar) => a.map(|term| term.product(b.at(0))),
            (Shape::Matrix(rows, inner), shape) => {
                let columns = b.len() / inner.max(1);
                let shape = match shape {
                    Shape::Vector(_) => Shape::Vector(rows),
                    _ => Shape::Matrix(rows, columns),
                };
                // Entries of equal rows and columns have one dimension.
                let (rows, columns) = match (a.distinct(), b.distinct()) {
                    (1, 1) => (1, 1),
                    (1, _) => (1, columns),
                    (_, 1) => (rows, 1),
                    _ => (rows, columns),
                };
                let mut entries = Vec::new();
                for (row, column) in (0..rows).flat_map(|i| (0..columns).map(move |k| (i, k))) {
                    let width = b.len() / inner.max(1);
                    let terms =
                        (0..inner).map(|k| a.at(row * inner + k).product(b.at(k * width + column)));
                    entries.push(self.sum(terms.collect(), expr));
                }
                self.spread(shape, entries, (rows, columns))
            }
            _ => self.unknown(expr),
        }
    }

    /// Returns a value whose entries are given for one row or all, and for one column or all.
    fn spread(&self, shape: Shape, entries: Vec<Term>, (rows, columns): (usize, usize)) -> Value {
        let (height, width) = match shape {
            Shape::Matrix(height, width) => (height, width),
            Shape::Vector(height) => (height, 1),
            _ => (1, 1),
        };
        let places = (0..height)
            .flat_map(|i| (0..width).map(move |k| (i.min(rows - 1), k.min(columns - 1))));
        let all = places.map(|(row, column)| entries[row * columns + column].clone());
        Value::of(shape, all.collect())
    }

    /// Demands that the terms of a sum within an operation have one dimension, and returns it.
    pub fn sum(&mut self, terms: Vec<Term>, expr: &'a Expr) -> Term {
        let mut sum = Term::Zero;
        for term in terms {
            let a = Value::scalar(sum);
            sum = self.joined(&a, &Value::scalar(term), expr, |a, b| {
                format!("this adds {b} to {a}")
            });
        }
        sum
    }
}

/// Returns a value of lengths.
pub fn length(shape: Shape) -> Value {
    Value::uniform(shape, Term::of(Dimension::of([0, 1, 0, 0, 0])))
}
