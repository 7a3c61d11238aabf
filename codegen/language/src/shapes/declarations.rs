//! Shapes of all names, determined in the order in which the names become known.

use super::infer::Inference;
use super::shape::{Shape, Shaped};
use crate::diagnostics::Diagnostic;
use crate::symbols::{Kind, Order, Relation, Step};
use crate::syntax::ast::{Declaration, ItemKind, ShapeKind, Source, System};

impl<'a> Inference<'a> {
    /// Determines the shapes of all declarations, and checks their values.
    pub fn declarations(&mut self, system: &'a System, order: &Order<'a>) {
        for item in &system.items {
            if let ItemKind::Const(list) = &item.kind {
                list.iter().for_each(|one| self.valued(one, Kind::Const));
            }
        }
        for item in &system.items {
            match &item.kind {
                ItemKind::Table(table) => {
                    let points = match &table.source {
                        Source::Points(points, _) => points.as_slice(),
                        Source::File(..) => &[],
                    };
                    for number in points.iter().flat_map(|(a, b)| [a, b]) {
                        self.wants(number, "an entry of a table", Shape::Scalar);
                    }
                }
                ItemKind::Param(list) => self.symbols_of(list, Kind::Param),
                ItemKind::Velocity(list) => self.symbols_of(list, Kind::Velocity),
                ItemKind::Input(list) => self.symbols_of(list, Kind::Input),
                ItemKind::State(list) => self.symbols_of(list, Kind::State),
                ItemKind::Coord(list) => {
                    for (name, kind, _) in list {
                        let shape = Shaped::of(Shape::of_coordinate(*kind));
                        self.define(name, Kind::Coord(*kind), Some(shape));
                    }
                }
                _ => {}
            }
        }
        for step in order.before.iter().chain(&order.after) {
            match step {
                Step::Let(declaration) => self.valued(declaration, Kind::Let),
                Step::Frame(relation, back) => self.frame(relation, *back),
            }
        }
    }

    /// Defines names that have exactly their declared shape: parameters, velocities, inputs and states.
    fn symbols_of(&mut self, list: &'a [Declaration], kind: Kind) {
        for declaration in list {
            let shape = Shape::declared(declaration.shape.kind);
            self.define(&declaration.name, kind, Some(Shaped::of(shape)));
        }
    }

    /// Defines a constant or a named expression, which takes the shape of its value if none was written.
    fn valued(&mut self, declaration: &'a Declaration, kind: Kind) {
        let found = declaration.value.as_ref().and_then(|value| self.of(value));
        let declared = match declaration.shape.kind {
            ShapeKind::Scalar => None,
            kind => Some(Shape::declared(kind)),
        };
        let shaped = match declared {
            Some(shape) => found
                .clone()
                .filter(|found| found.shape == shape)
                .or(Some(Shaped::of(shape))),
            None => found.clone(),
        };
        self.define(&declaration.name, kind, shaped);
        if let (Some(_), Some(found)) = (declared, found) {
            self.fits(declaration, found.shape);
        }
    }

    /// Checks that a value has the declared shape, and reports an error otherwise.
    fn fits(&mut self, declaration: &'a Declaration, found: Shape) -> Option<()> {
        let (name, shape) = (&declaration.name, declaration.shape);
        if found == Shape::declared(shape.kind) {
            return Some(());
        }
        let value = declaration.value.as_ref();
        let message = format!(
            "`{}` was declared as {}, but its value is {}",
            name.name,
            shape.kind.describe(),
            found.describe()
        );
        self.error(
            Diagnostic::new(value.map_or(name.span, |value| value.span), message)
                .help("make the shape and the value agree")
                .note(shape.span, "declared here"),
        )
    }

    /// Checks the default value of a parameter.
    pub fn default_of(&mut self, declaration: &'a Declaration) -> Option<()> {
        let value = declaration.value.as_ref()?;
        let found = self.of(value)?.shape;
        if declaration.shape.kind != ShapeKind::Scalar || found == Shape::Scalar {
            return self.fits(declaration, found);
        }
        let name = &declaration.name.name;
        let message = format!(
            "`{name}` was declared as a scalar, but its value is {}",
            found.describe()
        );
        let help = match found {
            Shape::Vector(n) => format!("write `{name}: vec{n}`"),
            Shape::Matrix(n, m) if n == m => format!("write `{name}: mat{n}` or `{name}: sym{n}`"),
            _ => "parameters are scalars, vectors and square matrices".into(),
        };
        self.error(Diagnostic::new(value.span, message).help(help))
    }

    /// Checks the initial value of a state.
    pub fn state(&mut self, declaration: &'a Declaration) -> Option<()> {
        let value = declaration.value.as_ref()?;
        let found = self.of(value)?.shape;
        match declaration.shape.kind {
            ShapeKind::Scalar => {
                let what = format!("the start of `{}`", declaration.name.name);
                self.agree(value, &what, Shape::Scalar, found)
            }
            _ => self.fits(declaration, found),
        }
    }

    /// Checks the definition of a velocity by rates.
    pub fn definition(&mut self, declaration: &'a Declaration) -> Option<()> {
        let value = declaration.value.as_ref()?;
        let found = self.of(value)?.shape;
        let name = &declaration.name.name;
        let (message, help) = match (declaration.shape.kind, found) {
            (ShapeKind::Scalar, Shape::Scalar) => return Some(()),
            (ShapeKind::Scalar, _) => (
                format!(
                    "velocity `{name}` is a scalar, but its definition is {}",
                    found.describe()
                ),
                match found {
                    Shape::Vector(n) => {
                        format!("declare its shape: `velocity {name}: vec{n} = …;`")
                    }
                    _ => "take an entry of it, or its `vee(…)` where it is a skew matrix".into(),
                },
            ),
            (ShapeKind::Symmetric(_), _) => (
                format!("a symmetric velocity such as `{name}` has no definition by rates"),
                "declare it `vecN` and define its entries one by one".into(),
            ),
            _ => return self.fits(declaration, found),
        };
        self.error(Diagnostic::new(value.span, message).help(help))
    }

    /// Defines a frame. It is a pose even if its definition is in error.
    fn frame(&mut self, relation: &Relation<'a>, back: bool) {
        let Relation { name, on, pose, .. } = *relation;
        let placed = on.filter(|_| back).unwrap_or(name);
        let found = self.of(pose).map(|found| found.shape);
        self.define(placed, Kind::Frame, Some(Shaped::of(Shape::Pose)));
        if let Some(found) = found
            && !matches!(found, Shape::Pose | Shape::Vector(3))
        {
            let message = format!("a frame has to be a pose, but this is {}", found.describe());
            let help = match found {
                Shape::TURN => format!("write `frame {} = pose(R, [0, 0, 0]);`", name.name),
                _ => format!("write `frame {} = pose(R, p);`", name.name),
            };
            self.error::<()>(Diagnostic::new(pose.span, message).help(help));
        }
    }
}
