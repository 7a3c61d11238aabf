//! Dimensions of declared names: from their units, from their values, or unknown at first.

use super::Dimensions;
use super::form::Term;
use super::value::Value;
use super::walk::Walk;
use crate::shapes::Shape;
use crate::symbols::{Kind, Order, Step};
use crate::syntax::ast::{CoordKind, Declaration, Expr, Ident, Item, ItemKind, Source, System};
use crate::units::{Dimension, Unit};

/// Largest number of entries of a vector or matrix without a unit whose dimensions can differ.
const MOST_ENTRIES: usize = 64;

impl<'a> Walk<'a> {
    /// Declares the arguments and results of tables and of functions in Rust.
    pub fn functions_of(&mut self, system: &'a System) {
        for item in &system.items {
            let (name, arguments, shape) = match &item.kind {
                ItemKind::Table(table) => (&table.name.name, 1, Shape::Scalar),
                ItemKind::External(function) => {
                    let shape = match function.components.0 {
                        0 | 1 => Shape::Scalar,
                        count => Shape::Vector(count),
                    };
                    (&function.name.name, function.parameters.len(), shape)
                }
                _ => continue,
            };
            let arguments = (0..arguments).map(|_| self.unknowns.fresh(name)).collect();
            let value = self.open(name, shape);
            self.functions.insert(name, (arguments, value));
        }
    }

    /// Declares all names, in the order in which they become known, and checks their values.
    pub fn declarations(&mut self, system: &'a System, order: &Order<'a>) {
        for item in &system.items {
            match &item.kind {
                ItemKind::Const(list) => list.iter().for_each(|one| self.valued(one)),
                ItemKind::Param(list)
                | ItemKind::Velocity(list)
                | ItemKind::Input(list)
                | ItemKind::State(list) => {
                    for one in list {
                        let shape = Shape::declared(one.shape.kind);
                        self.declare(&one.name, shape, one.unit.as_ref());
                    }
                }
                ItemKind::Coord(list) => list.iter().for_each(|one| self.coordinate(one)),
                _ => {}
            }
        }
        for item in &system.items {
            if let ItemKind::Time(time) = &item.kind {
                self.places.insert(&time.name, time.span);
                let second = Unit::named("s").unwrap_or_else(Unit::one);
                self.fixed(&time.name, Value::scalar(Term::of(second.dimension)));
                if let Some((name, _)) = self
                    .symbols
                    .iter()
                    .find(|(name, _)| *name == format!("{}_dot", time.name))
                {
                    self.fixed(name, Value::scalar(Term::one()));
                }
            }
        }
        for item in &system.items {
            if let ItemKind::Frame { name, on, .. } = &item.kind {
                for name in [Some(name), on.as_ref()].into_iter().flatten() {
                    self.fixed(&name.name, Value::uniform(Shape::Pose, Term::one()));
                }
            }
            self.function(item);
        }
        for step in order.before.iter().chain(&order.after) {
            match step {
                Step::Let(declaration) => self.valued(declaration),
                Step::Frame(relation, _) => {
                    let value = self.of(relation.pose);
                    self.position(relation.pose, &value);
                }
            }
        }
    }

    fn fixed(&mut self, name: &'a str, value: Value) {
        self.names.insert(name, value);
    }

    /// Declares a name of which only the shape is known, and the unit if it has one.
    fn declare(&mut self, name: &'a Ident, shape: Shape, unit: Option<&Unit>) {
        if self.names.contains_key(name.name.as_str()) {
            return;
        }
        let value = match unit {
            Some(unit) => {
                self.places.insert(&name.name, unit.span);
                Value::uniform(shape, Term::of(unit.dimension.clone()))
            }
            None => self.open(&name.name, shape),
        };
        self.names.insert(&name.name, value);
    }

    /// Returns a value of unknown dimensions, which can differ from entry to entry.
    fn open(&mut self, name: &str, shape: Shape) -> Value {
        let one = Value::uniform(shape, Term::one());
        match one.len() {
            count if count <= MOST_ENTRIES => {
                let entries = (0..count).map(|_| self.unknowns.fresh(name));
                Value::of(shape, entries.collect())
            }
            _ => Value::uniform(shape, self.unknowns.fresh(name)),
        }
    }

    fn coordinate(&mut self, (name, kind, unit): &'a (Ident, CoordKind, Option<Unit>)) {
        let shape = Shape::of_coordinate(*kind);
        match kind {
            CoordKind::Real | CoordKind::Euclidean(_) => self.declare(name, shape, unit.as_ref()),
            kind => {
                self.fixed(&name.name, Value::uniform(shape, Term::one()));
                let wanted = match kind {
                    CoordKind::SE3 => Dimension::of([0, 1, 0, 0, 0]),
                    _ => Dimension::one(),
                };
                if let Some(unit) = unit.as_ref().filter(|unit| unit.dimension != wanted) {
                    self.misfit(name, unit, &wanted);
                }
            }
        }
    }

    /// Declares a name with its value. A value of plain numbers leaves the dimension unknown.
    fn valued(&mut self, declaration: &'a Declaration) {
        let name = &declaration.name;
        let Some(value) = &declaration.value else {
            return;
        };
        let found = self.of(value);
        if self.names.contains_key(name.name.as_str()) {
            return;
        }
        if let Some(unit) = &declaration.unit {
            self.declare(name, found.shape, Some(unit));
            self.value_of(name, value, &found);
            return;
        }
        let unknowns = &mut self.unknowns;
        let known = found.map(|term| match term {
            Term::Plain => unknowns.fresh(&name.name),
            term => term.clone(),
        });
        self.places.insert(&name.name, name.span);
        self.names.insert(&name.name, known);
    }

    /// Demands that a value has the dimensions of its name.
    pub fn value_of(&mut self, name: &'a Ident, expr: &'a Expr, found: &Value) {
        if let Some(wanted) = self.names.get(name.name.as_str()).cloned() {
            let what = format!("`{}`", name.name);
            self.given(expr, found, (&what, Some(&name.name)), &wanted);
        }
    }

    /// Reads the points of a table, or the stand-in of a function in Rust.
    fn function(&mut self, item: &'a Item) {
        match &item.kind {
            ItemKind::Table(table) => {
                let Source::Points(points, _) = &table.source else {
                    return;
                };
                let Some((arguments, value)) =
                    self.functions.get(table.name.name.as_str()).cloned()
                else {
                    return;
                };
                let argument = Value::scalar(arguments[0].clone());
                for (first, second) in points {
                    let found = [self.of(first), self.of(second)];
                    self.fits(first, &found[0], "the argument of this table", &argument);
                    self.fits(second, &found[1], "the value of this table", &value);
                }
            }
            ItemKind::External(function) => {
                let Some((arguments, value)) =
                    self.functions.get(function.name.name.as_str()).cloned()
                else {
                    return;
                };
                let Some(stand_in) = &function.stand_in else {
                    return;
                };
                let names = function.parameters.iter().map(|name| name.name.as_str());
                let arguments = arguments.into_iter().map(Value::scalar);
                self.locals = names.zip(arguments).collect();
                let found = self.of(stand_in);
                self.locals.clear();
                let what = format!("the value of `{}`", function.name.name);
                self.fits(stand_in, &found, &what, &value);
            }
            _ => {}
        }
    }

    /// Returns what is known of all names in the end.
    pub fn summary(&self, system: &'a System) -> Dimensions {
        let mut summary = Dimensions::default();
        let mut count = |walk: &Self, name: &Ident, unit: Option<&Unit>| {
            let Some(value) = walk.names.get(name.name.as_str()) else {
                return;
            };
            let entries = (0..value.distinct()).map(|place| match value.at(place) {
                Term::Quantity(form) => walk.unknowns.reduced(form),
                _ => super::form::Form::known(Dimension::one()),
            });
            let entries: Vec<_> = entries.collect();
            let known: Option<Vec<&Dimension>> =
                entries.iter().map(|form| form.as_known()).collect();
            match (unit, &known) {
                (Some(_), _) => summary.declared += 1,
                (None, Some(_)) => summary.inferred += 1,
                (None, None) if walk.symbols.kind(&name.name) == Some(Kind::Const) => {}
                (None, None) => summary.open.push(name.name.clone()),
            }
            if let Some([first, rest @ ..]) = known.as_deref()
                && rest.iter().all(|other| other == first)
                && value.shape != Shape::Pose
            {
                summary.units.insert(name.name.clone(), first.to_string());
            }
        };
        for item in &system.items {
            match &item.kind {
                ItemKind::Param(list)
                | ItemKind::Const(list)
                | ItemKind::Let(list)
                | ItemKind::Velocity(list)
                | ItemKind::Input(list)
                | ItemKind::State(list) => {
                    list.iter()
                        .for_each(|one| count(self, &one.name, one.unit.as_ref()));
                }
                ItemKind::Coord(list) => {
                    list.iter()
                        .for_each(|(name, _, unit)| count(self, name, unit.as_ref()));
                }
                ItemKind::Output { name, unit, .. } => count(self, name, unit.as_ref()),
                _ => {}
            }
        }
        summary
    }
}
