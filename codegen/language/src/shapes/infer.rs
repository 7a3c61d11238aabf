//! Inference of the shape of an expression from those of its parts.

use super::shape::{MOST_ENTRIES, Shape, Shaped};
use crate::diagnostics::{Diagnostic, Report};
use crate::symbols::{Kind, Symbols};
use crate::syntax::ast::{
    Choice, Comparison, Expr, ExprKind, External, Ident, ItemKind, Span, System,
};
use std::collections::{BTreeMap, BTreeSet};

/// Largest nesting depth of expressions, including the bodies of called functions. A single expression never reaches
/// it.
pub const MOST_LEVELS: usize = 640;

/// A function with the shapes of its arguments.
type Called<'a> = (&'a str, Vec<Shaped>);

/// State of the shape inference. Its methods return `None` if there is an error, here or elsewhere.
pub struct Inference<'a> {
    /// Symbol table.
    pub symbols: &'a Symbols<'a>,
    /// The errors so far.
    pub report: Report,
    /// The tables of the description.
    pub tables: BTreeSet<&'a str>,
    /// The functions in Rust.
    pub externals: BTreeMap<&'a str, &'a External>,
    /// Results of calls, by function and argument shapes.
    pub called: BTreeMap<Called<'a>, Option<Shaped>>,
    /// Parameters of the function whose body is being checked. Empty outside of functions.
    pub locals: BTreeMap<&'a str, Shaped>,
    /// By symbol number: `None` before the definition, `Some(None)` if the definition is in error, otherwise the shape.
    values: Vec<Option<Option<Shaped>>>,
    /// Current nesting depth of expressions, including those of the enclosing functions.
    level: usize,
}

impl<'a> Inference<'a> {
    /// Creates a state in which no names are defined.
    pub fn new(system: &'a System, symbols: &'a Symbols<'a>) -> Self {
        let mut inference = Inference {
            symbols,
            report: Report::new(),
            tables: BTreeSet::new(),
            externals: BTreeMap::new(),
            called: BTreeMap::new(),
            locals: BTreeMap::new(),
            values: vec![None; symbols.len()],
            level: 0,
        };
        for item in &system.items {
            match &item.kind {
                ItemKind::Table(table) => _ = inference.tables.insert(&table.name.name),
                ItemKind::External(function) => {
                    let name = function.name.name.as_str();
                    inference.externals.entry(name).or_insert(function);
                }
                _ => {}
            }
        }
        inference
    }

    /// Defines the shape of a name. Returns whether this is its first declaration.
    pub fn define(&mut self, name: &Ident, kind: Kind, value: Option<Shaped>) -> bool {
        let Some(symbol) = self.symbols.get(&name.name) else {
            return false;
        };
        let place = &mut self.values[symbol.id.index()];
        if symbol.kind != kind || place.is_some() {
            return false;
        }
        *place = Some(value.filter(|_| !symbol.refused));
        true
    }

    /// Returns the shape of a declared name.
    pub fn named(&self, name: &str) -> Option<&Shaped> {
        let symbol = self.symbols.get(name)?;
        self.values[symbol.id.index()].as_ref()?.as_ref()
    }

    /// Reports an error, once per place.
    pub fn error<T>(&mut self, error: Diagnostic) -> Option<T> {
        self.report.push_once(error);
        None
    }

    /// Returns the shape of an expression.
    pub fn of(&mut self, expr: &'a Expr) -> Option<Shaped> {
        if self.level >= MOST_LEVELS {
            // Excessive nesting is reported on evaluation.
            return None;
        }
        self.level += 1;
        let found = self.inferred(expr);
        self.level -= 1;
        found
    }

    fn inferred(&mut self, expr: &'a Expr) -> Option<Shaped> {
        match &expr.kind {
            ExprKind::Number(number) => Some(Shaped::number(number.value.clone())),
            ExprKind::Quantity(quantity) => self.of(&quantity.value),
            ExprKind::Name(name) => self.name(name),
            ExprKind::Field(base, field) => self.field(base, field),
            ExprKind::Index(base, indices) => self.index(base, indices, expr.span),
            ExprKind::Call(function, arguments) => self.call(function, arguments, expr.span),
            ExprKind::InAxes(call, frame) => self.in_axes(call, frame),
            ExprKind::Neg(inner) => Some(self.of(inner)?.map(|number| -number)),
            ExprKind::Binary(op, left, right) => {
                let (a, b) = (self.of(left), self.of(right));
                self.binary(*op, &a?, &b?, (left, right), expr.span)
            }
            ExprKind::If(choice) => self.choice(choice),
            ExprKind::Array(items) => self.array(items, expr.span),
        }
    }

    /// Returns the shapes of all expressions of a list.
    pub fn all(&mut self, list: &'a [Expr]) -> Option<Vec<Shaped>> {
        let found: Vec<Option<Shaped>> = list.iter().map(|expr| self.of(expr)).collect();
        found.into_iter().collect()
    }

    /// Returns whether an expression is the name of an S1 coordinate.
    pub fn is_circle(&self, expr: &Expr) -> bool {
        matches!(&expr.kind, ExprKind::Name(name) if self.symbols.is_circle(name) && !self.locals.contains_key(name.as_str()))
    }

    /// Checks that an expression has the wanted shape, and reports an error otherwise.
    pub fn wants(&mut self, expr: &'a Expr, what: &str, wanted: Shape) -> Option<()> {
        let found = self.of(expr)?.shape;
        match found == wanted {
            true => Some(()),
            false => self.wrong(expr.span, what, &wanted.describe(), found),
        }
    }

    /// Reports a wrong shape.
    pub fn wrong<T>(&mut self, span: Span, what: &str, wanted: &str, found: Shape) -> Option<T> {
        let help = match (wanted, found) {
            ("a scalar", Shape::Vector(_)) => {
                "an entry is written `v[1]`, a length `norm(v)`, a product `dot(a, b)`"
            }
            ("a scalar", Shape::Matrix(..)) => "an entry is written `M[1, 2]`",
            ("a vector of 3", Shape::Scalar) => "a vector is written `[a, b, c]`",
            ("a vector of 3", Shape::Vector(2)) => "in the plane, write `[v[1], v[2], 0]`",
            (_, Shape::Pose) => "its parts are `.R` and `.p`",
            _ => "a vector is written `[a, b, c]`, a matrix by rows `[[a, b], [c, d]]`",
        };
        let message = format!(
            "{what} has to be {wanted}, but this is {}",
            found.describe()
        );
        self.error(Diagnostic::new(span, message).help(help))
    }

    fn name(&self, name: &str) -> Option<Shaped> {
        if let Some(local) = self.locals.get(name) {
            return Some(local.clone());
        }
        if self.symbols.get(name).is_some() {
            return self.named(name).cloned();
        }
        match name {
            "world" => Some(Shaped::of(Shape::Pose)),
            "pi" => Some(Shaped::of(Shape::Scalar)),
            // An unknown name has been reported already.
            _ => None,
        }
    }

    fn array(&mut self, items: &'a [Expr], span: Span) -> Option<Shaped> {
        const HELP: &str =
            "entries of a vector are scalars, entries of a matrix are rows of equal length";
        let all = self.all(items)?;
        let first = all.first()?.shape;
        let count = all.len();
        if count > MOST_ENTRIES {
            return self.error(
                Diagnostic::new(span, format!("this array has {count} entries")).help(format!(
                    "vectors and matrices have at most {MOST_ENTRIES} rows and columns"
                )),
            );
        }
        let mut pairs = items.iter().zip(&all);
        if let Some((item, other)) = pairs.find(|(_, one)| one.shape != first) {
            let (other, first) = (other.shape.describe(), first.describe());
            let message = format!("this entry is {other}, but the first is {first}");
            return self.error(Diagnostic::new(item.span, message).help(HELP));
        }
        let shape = match first {
            Shape::Scalar => Shape::Vector(count),
            Shape::Vector(n) => Shape::Matrix(count, n),
            Shape::Matrix(..) | Shape::Pose => {
                let message = format!("an array whose entries are each {}", first.describe());
                return self.error(Diagnostic::new(span, message).help(HELP));
            }
        };
        let numbers = all.into_iter().map(|one| one.numbers);
        let numbers = numbers.collect::<Option<Vec<_>>>().map(|all| all.concat());
        Some(Shaped { shape, numbers })
    }

    /// Returns the shape of a choice, whose branches must have the same shape.
    fn choice(&mut self, choice: &'a Choice) -> Option<Shaped> {
        let mut side = |side: &'a Expr| {
            let found = self.of(side)?;
            match found.shape {
                Shape::Scalar => Some(found),
                other => self.wrong(side.span, "what is compared", "a scalar", other),
            }
        };
        let (left, right) = (side(&choice.left), side(&choice.right));
        let (then, otherwise) = (self.of(&choice.then), self.of(&choice.otherwise));
        let (left, right, then, otherwise) = (left?, right?, then?, otherwise?);
        if then.shape != otherwise.shape {
            let (first, second) = (then.shape.describe(), otherwise.shape.describe());
            let message = format!("this branch is {second}, but the one before is {first}");
            return self.error(
                Diagnostic::new(choice.otherwise.span, message)
                    .help("both branches need the same shape")
                    .note(choice.then.span, "the one before"),
            );
        }
        let (Some(left), Some(right)) = (left.as_number(), right.as_number()) else {
            return Some(Shaped::of(then.shape));
        };
        let holds = match choice.comparison {
            Comparison::Less => left < right,
            Comparison::AtMost => left <= right,
            Comparison::Greater => left > right,
            Comparison::AtLeast => left >= right,
        };
        Some(if holds { then } else { otherwise })
    }
}
