//! Dimensions of calls.

use super::form::Term;
use super::value::Value;
use super::walk::{Walk, length};
use crate::diagnostics::Report;
use crate::shapes::{Shape, Shaped};
use crate::symbols::words::{AXIS, FUNCTIONS, PLACE, PLANE};
use crate::syntax::ast::{Expr, Function, Ident};
use crate::units::Dimension;
use num_rational::BigRational;

/// Dimension of a time.
pub const TIME: [i32; 5] = [0, 0, 1, 0, 0];

impl<'a> Walk<'a> {
    /// Returns the dimensions of the result of a call.
    pub fn call(&mut self, function: &'a Ident, arguments: &'a [Expr], expr: &'a Expr) -> Value {
        let name = function.name.as_str();
        if let Some(own) = self.symbols.functions.get(name).copied() {
            return self.applied(own, arguments, expr);
        }
        let values: Vec<Value> = arguments.iter().map(|argument| self.of(argument)).collect();
        if let Some((wanted, result)) = self.functions.get(name).cloned() {
            for ((argument, value), wanted) in arguments.iter().zip(&values).zip(wanted) {
                let wanted = Value::uniform(value.shape, wanted);
                self.fits(
                    argument,
                    value,
                    &format!("the argument of `{name}`"),
                    &wanted,
                );
            }
            return result;
        }
        let shape = self
            .shapes
            .of(expr)
            .map_or(Shape::Scalar, |found| found.shape);
        if FUNCTIONS.contains(&name) {
            return self.motion(name, arguments, &values);
        }
        match (name, values.as_slice()) {
            ("rate", [value]) => {
                let time = Term::of(Dimension::of(TIME));
                let of_angle = arguments
                    .iter()
                    .any(|argument| self.shapes.is_circle(argument));
                let value = match of_angle {
                    true => &Value::scalar(Term::one()),
                    false => value,
                };
                value.map(|term| term.quotient(&time))
            }
            ("abs" | "transpose", [value]) => self.rearranged(name, value, shape),
            ("sqrt", [value]) => {
                value.map(|term| term.power(&BigRational::new(1.into(), 2.into())))
            }
            ("sign", _) | ("identity", _) => self.of_numbers(name, shape),
            ("min" | "max" | "clamp" | "hypot", [first, rest @ ..]) => {
                let mut joined = first.clone();
                for (value, argument) in rest.iter().zip(&arguments[1..]) {
                    joined = self.same((&joined, &arguments[0]), (value, argument), |a, b| {
                        format!("`{name}` has {b} beside {a}")
                    });
                }
                joined
            }
            ("atan2", [y, x]) => {
                self.same((y, &arguments[0]), (x, &arguments[1]), |a, b| {
                    format!("`atan2` has {b} beside {a}")
                });
                Value::scalar(Term::one())
            }
            ("norm" | "angle", [value]) => {
                let entries = (0..value.distinct()).map(|place| value.at(place).clone());
                let joined = self.sum(entries.collect(), expr);
                match name {
                    "norm" => Value::scalar(joined),
                    _ => Value::scalar(Term::one()),
                }
            }
            ("dot" | "cross" | "outer" | "qmul", [a, b]) => self.bilinear(name, a, b, shape, expr),
            ("trace", [value]) => {
                let Shape::Matrix(rows, columns) = value.shape else {
                    return self.unknown(expr);
                };
                let diagonal = (0..rows).map(|place| value.at(place * (columns + 1)).clone());
                Value::scalar(self.sum(diagonal.collect(), expr))
            }
            ("diag", _) => {
                let all = |value: &Value| {
                    (0..value.len())
                        .map(|k| value.at(k).clone())
                        .collect::<Vec<_>>()
                };
                diagonal(values.iter().flat_map(all).collect(), shape)
            }
            ("hat", [w]) => {
                let entry = |place: usize| w.at(place).clone();
                let (x, y, z) = (entry(0), entry(1), entry(2));
                let (zero, xx, yy, zz) = (Term::Zero, x.clone(), y.clone(), z.clone());
                let rows = [zero.clone(), z, y, zz, zero.clone(), x, yy, xx, zero];
                Value::of(shape, rows.to_vec())
            }
            ("vee", [value]) => {
                let pairs = [(7, 5), (2, 6), (3, 1)];
                let entries = pairs
                    .map(|(a, b)| self.sum(vec![value.at(a).clone(), value.at(b).clone()], expr));
                Value::of(shape, entries.to_vec())
            }
            (AXIS | PLANE, _) => Value::uniform(shape, Term::one()),
            ("pose", [rotation, position]) => {
                self.wants(
                    &arguments[0],
                    rotation,
                    "a rotation matrix",
                    &Dimension::one(),
                );
                self.position(&arguments[1], position);
                Value::uniform(shape, Term::one())
            }
            ("translation" | PLACE, [value]) => {
                self.position(&arguments[0], value);
                Value::uniform(shape, Term::one())
            }
            ("inverse", _) => Value::uniform(shape, Term::one()),
            _ => {
                for (argument, value) in arguments.iter().zip(&values) {
                    self.wants(
                        argument,
                        value,
                        &format!("the argument of `{name}`"),
                        &Dimension::one(),
                    );
                }
                Value::uniform(shape, Term::one())
            }
        }
    }

    /// Demands that a vector has lengths; a pose has them already.
    pub fn position(&mut self, expr: &'a Expr, value: &Value) {
        if value.shape != Shape::Pose {
            self.fits(expr, value, "a position", &length(value.shape));
        }
    }

    fn rearranged(&self, name: &str, value: &Value, shape: Shape) -> Value {
        match (name, value.shape) {
            ("transpose", Shape::Matrix(rows, columns)) => {
                let places = (0..columns).flat_map(|i| (0..rows).map(move |k| k * columns + i));
                Value::of(shape, places.map(|place| value.at(place).clone()).collect())
            }
            _ => value.clone(),
        }
    }

    fn of_numbers(&self, name: &str, shape: Shape) -> Value {
        match (name, shape) {
            ("identity", Shape::Matrix(n, _)) => diagonal(vec![Term::Plain; n], shape),
            _ => Value::uniform(shape, Term::one()),
        }
    }

    /// Returns the dimensions of a product of two vectors.
    fn bilinear(
        &mut self,
        name: &str,
        a: &Value,
        b: &Value,
        shape: Shape,
        expr: &'a Expr,
    ) -> Value {
        let product = |(i, k): (usize, usize)| a.at(i).product(b.at(k));
        let entries: Vec<Vec<(usize, usize)>> = match name {
            "dot" => vec![(0..a.len()).map(|i| (i, i)).collect()],
            "outer" => (0..a.len())
                .flat_map(|i| (0..b.len()).map(move |k| vec![(i, k)]))
                .collect(),
            "cross" => vec![
                vec![(1, 2), (2, 1)],
                vec![(2, 0), (0, 2)],
                vec![(0, 1), (1, 0)],
            ],
            _ => vec![
                vec![(0, 0), (1, 1), (2, 2), (3, 3)],
                vec![(0, 1), (1, 0), (2, 3), (3, 2)],
                vec![(0, 2), (2, 0), (3, 1), (1, 3)],
                vec![(0, 3), (3, 0), (1, 2), (2, 1)],
            ],
        };
        let terms = entries
            .into_iter()
            .map(|pairs| pairs.into_iter().map(product).collect());
        let sums = terms
            .map(|terms: Vec<Term>| self.sum(terms, expr))
            .collect();
        Value::of(shape, sums)
    }

    /// Returns the dimensions of the motion of a frame or of a point of it.
    fn motion(&mut self, name: &str, arguments: &'a [Expr], values: &[Value]) -> Value {
        for (argument, value) in arguments.iter().zip(values).skip(1) {
            self.position(argument, value);
        }
        let dimension = match name {
            "position" => [0, 1, 0, 0, 0],
            "velocity" => [0, 1, -1, 0, 0],
            "acceleration" => [0, 1, -2, 0, 0],
            "angular_velocity" => [0, 0, -1, 0, 0],
            _ => [0, 0, -2, 0, 0],
        };
        Value::uniform(Shape::Vector(3), Term::of(Dimension::of(dimension)))
    }

    /// Returns the dimensions of a call of a function of the description: those of its body for these arguments.
    fn applied(&mut self, function: &'a Function, arguments: &'a [Expr], expr: &'a Expr) -> Value {
        let values: Vec<(Option<Shaped>, Value)> = arguments
            .iter()
            .map(|argument| (self.shapes.of(argument), self.of(argument)))
            .collect();
        let call = (function.name.name.as_str(), values);
        if let Some(known) = self.called.get(&call) {
            return known.clone();
        }
        let names = || {
            function
                .parameters
                .iter()
                .map(|(name, _)| name.name.as_str())
        };
        let shapes = names()
            .zip(&call.1)
            .filter_map(|(name, (shape, _))| Some((name, shape.clone()?)));
        let outer_shapes = std::mem::replace(&mut self.shapes.locals, shapes.collect());
        let locals = names()
            .zip(call.1.iter().map(|(_, value)| value.clone()))
            .collect();
        let outer = std::mem::replace(&mut self.locals, locals);
        let report = std::mem::replace(&mut self.report, Report::new());
        let found = self.of(&function.value);
        self.locals = outer;
        self.shapes.locals = outer_shapes;
        let inner = std::mem::replace(&mut self.report, report);
        for error in inner.finish().err().unwrap_or_default() {
            self.report.push_once(error.in_call(expr.span));
        }
        self.called.insert(call, found.clone());
        found
    }
}

/// Returns a square matrix with these dimensions on its diagonal.
fn diagonal(entries: Vec<Term>, shape: Shape) -> Value {
    let n = entries.len();
    let places = (0..n).flat_map(|i| (0..n).map(move |k| (i, k)));
    let all = places.map(|(i, k)| {
        if i == k {
            entries[i].clone()
        } else {
            Term::Zero
        }
    });
    Value::of(shape, all.collect())
}
