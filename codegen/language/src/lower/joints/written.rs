//! Expands one joint into equivalent statements.

use super::fields::has;
use crate::symbols::words::{AXIS, PLACE, PLANE};
use crate::syntax::ast::{
    Acting, BinaryOp, CoordKind, Declaration, Expr, ExprKind, Ident, Item, ItemKind, Joint,
    JointField, JointKind, Shape, ShapeKind, Span, Target,
};
use num_bigint::BigInt;
use num_rational::BigRational;

/// Collects the statements of one joint.
pub(super) struct JointExpansion<'a> {
    /// The joint.
    pub joint: &'a Joint,
    /// Range of its statement.
    pub span: Span,
    /// Statements so far.
    pub items: Vec<Item>,
}

impl JointExpansion<'_> {
    fn push(&mut self, kind: ItemKind) {
        let span = self.span;
        self.items.push(Item { kind, span });
    }

    /// Returns a name that starts with that of the joint.
    fn ident(&self, ending: &str) -> Ident {
        let Ident { name, span } = &self.joint.name;
        Ident {
            name: format!("{name}{ending}"),
            span: *span,
        }
    }

    /// Returns such a name as an expression.
    fn name(&self, ending: &str) -> Expr {
        let Ident { name, span } = self.ident(ending);
        Expr {
            kind: ExprKind::Name(name),
            span,
        }
    }

    /// Writes a coordinate with its velocity.
    fn moves(&mut self, ending: &str, kind: CoordKind, shape: ShapeKind) {
        let name = self.ident(ending);
        self.push(ItemKind::Coord(vec![(name, kind, None)]));
        self.velocity(&format!("{ending}_dot"), shape);
    }

    fn velocity(&mut self, ending: &str, kind: ShapeKind) {
        let (name, span) = (self.ident(ending), self.joint.kind.1);
        self.push(ItemKind::Velocity(vec![Declaration {
            name,
            shape: Shape { kind, span },
            unit: None,
            value: None,
        }]));
    }

    fn rate(&mut self, ending: &str, value: Expr) {
        let name = self.ident(ending);
        self.push(ItemKind::Rate {
            target: whole(name),
            value,
        });
    }

    /// Writes a coordinate whose rate is its velocity.
    fn simple(&mut self, ending: &str, kind: CoordKind, shape: ShapeKind) {
        self.moves(ending, kind, shape);
        let velocity = self.name(&format!("{ending}_dot"));
        self.rate(ending, velocity);
    }

    /// Writes the coordinate of a joint with one degree of freedom, or the expression that it follows.
    fn one(&mut self, kind: CoordKind) {
        match &self.joint.follows {
            Some(value) => {
                let (name, span) = (self.ident(""), value.span);
                let kind = ShapeKind::Scalar;
                self.push(ItemKind::Let(vec![Declaration {
                    name,
                    shape: Shape { kind, span },
                    unit: None,
                    value: Some(value.clone()),
                }]));
            }
            None => self.simple("", kind, ShapeKind::Scalar),
        }
    }

    fn call(&self, function: &str, arguments: Vec<Expr>) -> Expr {
        let span = self.joint.kind.1;
        let name = function.to_owned();
        Expr {
            kind: ExprKind::Call(Ident { name, span }, arguments),
            span: self.pose_span(),
        }
    }

    /// Returns the span for errors in the pose; for a joint that follows others, that of the expression it follows.
    fn pose_span(&self) -> Span {
        self.joint
            .follows
            .as_ref()
            .map_or(self.joint.kind.1, |value| value.span)
    }

    fn times(&self, left: Expr, right: Expr) -> Expr {
        let kind = ExprKind::Binary(BinaryOp::Mul, Box::new(left), Box::new(right));
        let span = self.pose_span();
        Expr { kind, span }
    }

    fn number(&self, number: i64) -> Expr {
        Expr {
            kind: ExprKind::Number(BigRational::from_integer(BigInt::from(number)).into()),
            span: self.joint.kind.1,
        }
    }

    fn origin(&self) -> Expr {
        Expr {
            kind: ExprKind::Array((0..3).map(|_| self.number(0)).collect()),
            span: self.joint.kind.1,
        }
    }

    fn pose(&self, rotation: Expr, position: Expr) -> Expr {
        self.call("pose", vec![rotation, position])
    }

    fn still(&self) -> Expr {
        self.call("identity", vec![self.number(3)])
    }

    /// Returns a call for the unit vector of an axis.
    fn axis(&self, index: usize) -> Expr {
        let axes = &self.joint.axes;
        let axis = axes.get(index).cloned().unwrap_or_else(|| self.origin());
        self.call(AXIS, vec![axis])
    }

    fn turn(&self, axis: usize, ending: &str) -> Expr {
        let turn = vec![self.axis(axis), self.name(ending)];
        self.call("axis_angle", turn)
    }

    fn shift(&self, ending: &str) -> Expr {
        self.times(self.name(ending), self.axis(0))
    }

    /// Writes coordinates, velocities and rates. Returns a chain of frames with their poses, each on the one before;
    /// the last is the frame that the joint moves.
    pub fn motion(&mut self) -> Vec<(Ident, Expr)> {
        use CoordKind::{Euclidean, Real, S1, S3, SO3};
        use ShapeKind::{Scalar, Vector};
        let pose = match self.joint.kind.0 {
            JointKind::Fixed => self.pose(self.still(), self.origin()),
            JointKind::Revolute => {
                self.one(Real);
                self.pose(self.turn(0, ""), self.origin())
            }
            JointKind::Continuous => {
                self.one(S1);
                self.pose(self.turn(0, ""), self.origin())
            }
            JointKind::Prismatic => {
                self.one(Real);
                self.pose(self.still(), self.shift(""))
            }
            JointKind::Spherical => {
                self.moves("", SO3, Vector(3));
                let spin = self.call("hat", vec![self.name("_dot")]);
                self.rate("", self.times(self.name(""), spin));
                self.pose(self.name(""), self.origin())
            }
            JointKind::SphericalS3 => {
                self.moves("", S3, Vector(3));
                let value = self.quaternion_rate();
                self.rate("", value);
                self.pose(self.call("rot", vec![self.name("")]), self.origin())
            }
            JointKind::Free => {
                let (r, rotation) = (self.ident("_r"), self.ident("_R"));
                let pair = vec![(r, Euclidean(3), None), (rotation, SO3, None)];
                self.push(ItemKind::Coord(pair));
                self.velocity("_v", Vector(3));
                self.velocity("_w", Vector(3));
                self.rate("_r", self.times(self.name("_R"), self.name("_v")));
                let spin = self.call("hat", vec![self.name("_w")]);
                self.rate("_R", self.times(self.name("_R"), spin));
                self.pose(self.name("_R"), self.name("_r"))
            }
            JointKind::Planar => {
                self.simple("_r", Euclidean(2), Vector(2));
                self.simple("", Real, Scalar);
                let axis = self.joint.axes.first().cloned();
                let normal = axis.unwrap_or_else(|| self.origin());
                let plane = self.call(PLANE, vec![normal]);
                self.pose(self.turn(0, ""), self.times(plane, self.name("_r")))
            }
            JointKind::Universal => {
                self.simple("_1", Real, Scalar);
                self.simple("_2", Real, Scalar);
                let first = self.pose(self.turn(0, "_1"), self.origin());
                let second = self.pose(self.turn(1, "_2"), self.origin());
                let cross = self.ident("_cross");
                return vec![(cross, first), (self.joint.moves.clone(), second)];
            }
            JointKind::Cylindrical => {
                self.simple("", Real, Scalar);
                self.simple("_d", Real, Scalar);
                self.pose(self.turn(0, ""), self.shift("_d"))
            }
        };
        vec![(self.joint.moves.clone(), pose)]
    }

    /// Returns q̇ = ½ q ⊗ (0, ω).
    fn quaternion_rate(&self) -> Expr {
        let span = self.joint.kind.1;
        let spin = |index: i64| Expr {
            kind: ExprKind::Index(Box::new(self.name("_dot")), vec![self.number(index)]),
            span,
        };
        let entries = vec![self.number(0), spin(1), spin(2), spin(3)];
        let kind = ExprKind::Array(entries);
        let product = self.call("qmul", vec![self.name(""), Expr { kind, span }]);
        let (product, two) = (Box::new(product), Box::new(self.number(2)));
        let kind = ExprKind::Binary(BinaryOp::Div, product, two);
        Expr { kind, span }
    }

    /// Writes the frames; the first is at the place of the joint.
    pub fn frames(&mut self, poses: Vec<(Ident, Expr)>) {
        let mut on = self.joint.on.clone();
        let mut place = self.joint.at.clone();
        for (name, pose) in poses {
            let pose = match place.take() {
                Some(place) => {
                    let place = self.call(PLACE, vec![place]);
                    self.times(place, pose)
                }
                None => pose,
            };
            let parent = on.replace(name.clone());
            self.push(ItemKind::Frame {
                name,
                on: parent,
                pose,
            });
        }
    }

    /// Appends the statements equivalent to the loads of the joint: its dampers, spring and force, as items of the syntax
    /// tree.
    pub fn push_loads(&mut self) {
        let field = |wanted| {
            let of = |(field, span, values): &(JointField, Span, Vec<Expr>)| {
                let value = values
                    .first()
                    .filter(|_| *field == wanted && has(self.joint, wanted))?;
                Some((*span, value.clone()))
            };
            self.joint.fields.iter().find_map(of)
        };
        let (damping, stiffness) = (field(JointField::Damping), field(JointField::Stiffness));
        let (rest, force) = (field(JointField::Rest), field(JointField::Force));
        if let Some((_, coefficient)) = damping {
            for rate in self.rates() {
                let coefficient = coefficient.clone();
                let acting = Acting::On(rate);
                self.push(ItemKind::Damper {
                    coefficient,
                    acting,
                });
            }
        }
        if let Some((_, stiffness)) = stiffness {
            let acting = Acting::On(self.name(""));
            self.push(ItemKind::Spring {
                stiffness,
                length: rest.map(|(_, value)| value),
                acting,
            });
        }
        if let Some((span, value)) = force {
            let name = self.ident("_dot");
            let name = Ident { span, ..name };
            self.push(ItemKind::Generalized {
                target: whole(name),
                value,
            });
        }
    }

    /// Returns the velocities of the joint, one by one.
    fn rates(&self) -> Vec<Expr> {
        let whole = self.name("_dot");
        match self.joint.kind.0 {
            JointKind::Spherical | JointKind::SphericalS3 => (1..=3)
                .map(|index| Expr {
                    span: whole.span,
                    kind: ExprKind::Index(Box::new(whole.clone()), vec![self.number(index)]),
                })
                .collect(),
            JointKind::Universal => vec![self.name("_1_dot"), self.name("_2_dot")],
            _ => vec![whole],
        }
    }
}

/// Returns the target for all of a symbol.
fn whole(name: Ident) -> Target {
    Target {
        name,
        field: None,
        entry: Vec::new(),
    }
}
