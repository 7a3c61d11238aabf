//! Targets of statements, such as coordinates, velocities and states or parts of them, and the shapes that they
//! require.

use super::infer::Inference;
use super::rates::{rate_help, velocity_for};
use super::shape::Shape;
use crate::diagnostics::Diagnostic;
use crate::symbols::Kind;
use crate::syntax::ast::{
    BinaryOp, CoordKind, Expr, ExprKind, Ident, ItemKind, ShapeKind, System, Target,
};
use crate::syntax::written;

impl<'a> Inference<'a> {
    /// Returns the shape of a velocity or state, or of an entry of one. These have no fields; in the error for a field,
    /// `begins` is the first word of the statement.
    fn whole(&mut self, target: &Target, begins: &str) -> Option<Shape> {
        let name = &target.name.name;
        let shape = self.named(name)?.shape;
        let Some(field) = &target.field else {
            return self.entry(target, shape);
        };
        let message = format!("`{name}` has no part `.{}`", field.name);
        let error = Diagnostic::new(field.span, message);
        self.error(error.help(format!("give all of it: `{begins} {name} = …;`")))
    }

    /// Returns the shape of a coordinate, or of a part of it.
    fn part(&mut self, target: &Target, kind: CoordKind) -> Option<Shape> {
        let shape = self.named(&target.name.name)?.shape;
        let field = target.field.as_ref();
        let shape = match (field.map(|field| field.name.as_str()), kind) {
            (None, _) => shape,
            (Some("p"), CoordKind::SE3) => Shape::Vector(3),
            (Some("R"), CoordKind::SE3) => Shape::TURN,
            (Some("c" | "s"), CoordKind::S1) => Shape::Scalar,
            (Some(_), _) => return self.error(no_part(&target.name, field?, kind)),
        };
        let help = match (kind, shape) {
            _ if target.entry.is_empty() => return Some(shape),
            (CoordKind::S1, Shape::Vector(_)) => "give the angle, as in `start q = 0.3;`",
            (CoordKind::S3, _) => "give a unit quaternion, scalar first",
            (_, Shape::Matrix(..)) => {
                "give all of the rotation, by `rotx(angle)`, `rpy(…)`, `axis_angle(…)`"
            }
            _ => return self.entry(target, shape),
        };
        let message = format!(
            "`{}` is tied to the other entries and cannot be given alone",
            written::target(target)
        );
        self.error(Diagnostic::new(target.span(), message).help(help))
    }

    /// Returns the shape of a target in a vector: the whole vector or an entry.
    fn entry(&mut self, target: &Target, whole: Shape) -> Option<Shape> {
        let length = match (target.entry.as_slice(), whole) {
            ([], _) => return Some(whole),
            ([_], Shape::Vector(length)) => length,
            _ => {
                let name = written::target(&Target {
                    entry: Vec::new(),
                    ..target.clone()
                });
                let message = format!("`{name}` is {} and has no such entry", whole.describe());
                let help = match whole {
                    Shape::Vector(_) => format!("an entry is written `{name}[1]`"),
                    _ => format!("write `{name}` alone"),
                };
                return self.error(Diagnostic::new(target.span(), message).help(help));
            }
        };
        if target.place(length).is_some() {
            return Some(Shape::Scalar);
        }
        let message = format!(
            "index {} is out of range: {} has {length} entries",
            target.entry[0],
            whole.describe()
        );
        self.error(
            Diagnostic::new(target.span(), message).help(format!("indices run from 1 to {length}")),
        )
    }

    /// Refuses a target with an index, since rates must be given for all entries at once.
    fn all_entries(&mut self, target: &Target) -> Option<()> {
        if target.entry.is_empty() {
            return Some(());
        }
        let name = written::target(&Target {
            entry: Vec::new(),
            ..target.clone()
        });
        let message = format!("the rate of `{name}` is given as a whole");
        let help = format!("write its entries in one statement, as in `rate {name} = [a, b, c];`");
        self.error(Diagnostic::new(target.span(), message).help(help))
    }

    /// Checks `rate q = …;` for a coordinate or a state.
    pub fn rate_of(&mut self, system: &System, target: &Target, value: &'a Expr) -> Option<()> {
        let found = self.of(value);
        let name = &target.name.name;
        self.all_entries(target)?;
        let kind = match self.symbols.kind(name)? {
            Kind::Coord(kind) => kind,
            Kind::State => {
                let wanted = self.whole(target, "rate")?;
                let found = found?.shape;
                let what = format!("the rate of `{}`", written::target(target));
                return self.agree(value, &what, wanted, found);
            }
            _ => return None,
        };
        let wanted = self.part(target, kind)?;
        let found = found?.shape;
        // A scalar rate of an S1 coordinate is its angular velocity.
        let turns = kind == CoordKind::S1 && target.field.is_none() && found == Shape::Scalar;
        if found == wanted || turns {
            return Some(());
        }
        let message = format!(
            "the rate of `{}` has to be {}, but this is {}",
            written::target(target),
            wanted.describe(),
            found.describe()
        );
        let turning = match found {
            Shape::Vector(3) => factor_of(name, value),
            _ => None,
        };
        let velocities = velocities(system).filter(|(name, _)| self.named(name).is_some());
        let velocity = turning.unwrap_or_else(|| velocity_for(kind, Some(value), velocities));
        let help = rate_help(name, kind, velocity);
        self.error(Diagnostic::new(value.span, message).help(help))
    }

    /// Checks `start q = …;` or `start q ~ …;` for a coordinate or a velocity.
    pub fn start_of(&mut self, target: &Target, value: &'a Expr) -> Option<()> {
        let found = self.of(value);
        let (wanted, kind) = match self.symbols.kind(&target.name.name)? {
            Kind::Coord(kind) => (self.part(target, kind)?, Some(kind)),
            Kind::Velocity => (self.whole(target, "start")?, None),
            _ => return None,
        };
        let found = found?.shape;
        let circle = kind == Some(CoordKind::S1) && target.field.is_none();
        if found == wanted || circle && found == Shape::Scalar {
            return Some(());
        }
        let what = format!("the start of `{}`", written::target(target));
        let help = match (kind, wanted) {
            (Some(CoordKind::S1), Shape::Vector(_)) => "give the angle, as in `start q = 0.3;`",
            (Some(CoordKind::S3), _) => "give a unit quaternion, scalar first",
            (Some(CoordKind::SO3 | CoordKind::SE3), Shape::Matrix(..) | Shape::Pose) => {
                "build the rotation by `rotx(angle)`, `rpy(…)`, `axis_angle(…)`, and a pose by `pose(R, p)`"
            }
            _ => return self.wrong(value.span, &what, &wanted.describe(), found),
        };
        let (wanted, found) = (wanted.describe(), found.describe());
        let message = format!("{what} has to be {wanted}, but this is {found}");
        self.error(Diagnostic::new(value.span, message).help(help))
    }

    /// Checks that the value of `prescribe q = …;` or `prescribe rate(v) = …;` has the shape of its target; the target
    /// itself is checked with the symbols.
    pub fn prescribed(&mut self, target: &Target, rate: bool, value: &'a Expr) -> Option<()> {
        let found = self.of(value);
        let name = &target.name.name;
        let what = |what: &str| format!("the {what} of `{}`", written::target(target));
        match self.symbols.kind(name)? {
            Kind::Velocity if target.field.is_none() => {
                let wanted = self.whole(target, "prescribe")?;
                let what = what(if rate { "rate" } else { "motion" });
                self.agree(value, &what, wanted, found?.shape)
            }
            Kind::Coord(kind) if !rate => {
                let given = match kind {
                    CoordKind::Real | CoordKind::Euclidean(_) => target.clone(),
                    _ => Target {
                        entry: Vec::new(),
                        ..target.clone()
                    },
                };
                let wanted = self.part(&given, kind)?;
                let found = found?.shape;
                match kind {
                    // Parts and entries that cannot be prescribed are refused later, as a whole.
                    _ if target.field.is_some() || given != *target => Some(()),
                    CoordKind::S1 if found == Shape::Scalar => Some(()),
                    CoordKind::S1 => self.wrong(value.span, &what("motion"), "an angle", found),
                    CoordKind::Real | CoordKind::Euclidean(_) => {
                        self.agree(value, &what("motion"), wanted, found)
                    }
                    _ => Some(()),
                }
            }
            _ => None,
        }
    }

    /// Checks `generalized force v = …;`.
    pub fn force_of(&mut self, target: &Target, value: &'a Expr) -> Option<()> {
        let found = self.of(value);
        if self.symbols.kind(&target.name.name) != Some(Kind::Velocity) {
            return None;
        }
        let wanted = self.whole(target, "generalized force")?;
        let what = format!("the generalized force of `{}`", written::target(target));
        self.agree(value, &what, wanted, found?.shape)
    }

    /// Checks that a value has the required shape, and reports an error otherwise.
    pub fn agree(&mut self, value: &Expr, what: &str, wanted: Shape, found: Shape) -> Option<()> {
        match found == wanted {
            true => Some(()),
            false => self.wrong(value.span, what, &wanted.describe(), found),
        }
    }
}

fn no_part(name: &Ident, field: &Ident, kind: CoordKind) -> Diagnostic {
    let message = format!("`{}` has no part `.{}`", name.name, field.name);
    let error = Diagnostic::new(field.span, message);
    match kind {
        CoordKind::SE3 => error.help("its parts are `.p` and `.R`"),
        CoordKind::S1 => error.help("its parts are `.c` and `.s`"),
        _ => error.help(format!(
            "write `{}` alone: it is given as a whole",
            name.name
        )),
    }
}

/// Returns all velocities with their shapes, in the order of the text.
fn velocities(system: &System) -> impl Iterator<Item = (&str, ShapeKind)> {
    let lists = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Velocity(list) => Some(list),
        _ => None,
    });
    let all = lists.flatten();
    all.map(|declaration| (declaration.name.name.as_str(), declaration.shape.kind))
}

/// Returns the w of a rate `R * w` that lacks its `hat`.
fn factor_of<'a>(coordinate: &str, rate: &'a Expr) -> Option<&'a str> {
    let ExprKind::Binary(BinaryOp::Mul, left, right) = &rate.kind else {
        return None;
    };
    match (&left.kind, &right.kind) {
        (ExprKind::Name(left), ExprKind::Name(right)) if left == coordinate => Some(right),
        _ => None,
    }
}
