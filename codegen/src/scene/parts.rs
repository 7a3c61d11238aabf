//! Components of statements of a scene: frames, points, joints, bodies, loads, springs and dampers.

use crate::syntax::ast::{
    self, About, Acting, Components, End, Expr, Ident, ItemKind, JointField, JointKind, Span,
};
use hamel_language::expression::ident;

/// A frame of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame(String);

/// Name of the frame that does not move.
pub const WORLD: &str = "world";

impl Frame {
    /// Returns the pose of the frame in the world, an expression with the parts `R` and `p`.
    pub fn pose(&self) -> Expr {
        Expr::name(&self.0)
    }

    pub(super) fn ident(&self) -> Ident {
        ident(&self.0)
    }

    /// Returns the frame's name, or `None` for the world.
    fn moving(&self) -> Option<Ident> {
        (self.0 != WORLD).then(|| self.ident())
    }
}

impl From<&str> for Frame {
    fn from(name: &str) -> Frame {
        Frame(name.to_string())
    }
}

impl From<&Frame> for Frame {
    fn from(frame: &Frame) -> Frame {
        frame.clone()
    }
}

/// A point fixed to a frame.
#[derive(Clone, Debug)]
pub struct Point(pub(super) End);

impl Point {
    /// Creates the point with these components in the frame's axes (m).
    pub fn of(frame: impl Into<Frame>, at: impl Into<Expr>) -> Point {
        Point(End {
            at: Some(at.into()),
            frame: frame.into().ident(),
        })
    }

    /// Creates the point at the origin of a frame.
    pub fn origin(frame: impl Into<Frame>) -> Point {
        Point(End {
            at: None,
            frame: frame.into().ident(),
        })
    }
}

/// A joint, which carries a new frame. That frame has the name of the joint followed by `_frame`, unless
/// [`moves`](Self::moves) names it.
#[derive(Clone, Debug)]
pub struct Joint(pub(super) ast::Joint);

impl Joint {
    fn new(name: &str, kind: JointKind, axes: Vec<Expr>) -> Joint {
        Joint(ast::Joint {
            name: ident(name),
            kind: (kind, Span::NOWHERE),
            axes,
            on: None,
            at: None,
            moves: ident(&format!("{name}_frame")),
            follows: None,
            fields: Vec::new(),
        })
    }

    /// Creates a revolute joint about an axis; its coordinate is the angle (rad).
    pub fn revolute(name: &str, axis: impl Into<Expr>) -> Joint {
        Joint::new(name, JointKind::Revolute, vec![axis.into()])
    }

    /// Creates an unlimited revolute joint about an axis; its coordinate is the pair (cos, sin).
    pub fn continuous(name: &str, axis: impl Into<Expr>) -> Joint {
        Joint::new(name, JointKind::Continuous, vec![axis.into()])
    }

    /// Creates a prismatic joint along an axis (m).
    pub fn prismatic(name: &str, axis: impl Into<Expr>) -> Joint {
        Joint::new(name, JointKind::Prismatic, vec![axis.into()])
    }

    /// Creates a spherical joint; its coordinate is a rotation matrix.
    pub fn spherical(name: &str) -> Joint {
        Joint::new(name, JointKind::Spherical, Vec::new())
    }

    /// Creates a spherical joint; its coordinate is a unit quaternion.
    pub fn spherical_quaternion(name: &str) -> Joint {
        Joint::new(name, JointKind::SphericalS3, Vec::new())
    }

    /// Creates a joint with six degrees of freedom.
    pub fn free(name: &str) -> Joint {
        Joint::new(name, JointKind::Free, Vec::new())
    }

    /// Creates a planar joint: it slides in the plane with this normal, and turns about the normal.
    pub fn planar(name: &str, normal: impl Into<Expr>) -> Joint {
        Joint::new(name, JointKind::Planar, vec![normal.into()])
    }

    /// Creates a universal joint: it turns about two axes, one after the other.
    pub fn universal(name: &str, first: impl Into<Expr>, second: impl Into<Expr>) -> Joint {
        let axes = vec![first.into(), second.into()];
        Joint::new(name, JointKind::Universal, axes)
    }

    /// Creates a cylindrical joint: it turns about an axis and slides along it.
    pub fn cylindrical(name: &str, axis: impl Into<Expr>) -> Joint {
        Joint::new(name, JointKind::Cylindrical, vec![axis.into()])
    }

    /// Creates a fixed joint, which does not move.
    pub fn fixed(name: &str) -> Joint {
        Joint::new(name, JointKind::Fixed, Vec::new())
    }

    /// Sets the frame to which it is fixed; the world by default.
    pub fn on(mut self, frame: impl Into<Frame>) -> Joint {
        self.0.on = frame.into().moving();
        self
    }

    /// Sets its pose in that frame; at the frame's origin by default.
    pub fn at(mut self, pose: impl Into<Expr>) -> Joint {
        self.0.at = Some(pose.into());
        self
    }

    /// Sets the name of the frame that it carries.
    pub fn moves(mut self, frame: &str) -> Joint {
        self.0.moves = ident(frame);
        self
    }

    /// Couples the joint: its coordinate has this value, and is not a coordinate of the system.
    pub fn follows(mut self, value: impl Into<Expr>) -> Joint {
        self.0.follows = Some(value.into());
        self
    }

    fn field<const N: usize>(mut self, field: JointField, values: [Expr; N]) -> Joint {
        let values = values.into();
        self.0.fields.push((field, Span::NOWHERE, values));
        self
    }

    /// Sets the viscous friction d of the force −d q̇ (N s/m, N m s).
    pub fn damping(self, coefficient: impl Into<Expr>) -> Joint {
        self.field(JointField::Damping, [coefficient.into()])
    }

    /// Sets the inertia of its drive, J in ½ J q̇² (kg, kg m²).
    pub fn armature(self, inertia: impl Into<Expr>) -> Joint {
        self.field(JointField::Armature, [inertia.into()])
    }

    /// Adds a spring with the force −k (q − q₀) (N/m, N m); [`rest`](Self::rest) sets q₀.
    pub fn stiffness(self, stiffness: impl Into<Expr>) -> Joint {
        self.field(JointField::Stiffness, [stiffness.into()])
    }

    /// Sets the coordinate q₀ at which its spring exerts no force.
    pub fn rest(self, coordinate: impl Into<Expr>) -> Joint {
        self.field(JointField::Rest, [coordinate.into()])
    }

    /// Adds a force or torque of the joint (N, N m).
    pub fn force(self, force: impl Into<Expr>) -> Joint {
        self.field(JointField::Force, [force.into()])
    }

    /// Sets its limits, as information for users of the generated code.
    pub fn limit(self, lower: impl Into<Expr>, upper: impl Into<Expr>) -> Joint {
        self.field(JointField::Limit, [lower.into(), upper.into()])
    }

    /// Sets the largest rate of its coordinate, as information (m/s, rad/s).
    pub fn max_speed(self, speed: impl Into<Expr>) -> Joint {
        self.field(JointField::MaxSpeed, [speed.into()])
    }

    /// Sets the largest force or torque of its drive, as information (N, N m).
    pub fn max_force(self, force: impl Into<Expr>) -> Joint {
        self.field(JointField::MaxForce, [force.into()])
    }
}

/// A rigid body fixed to a frame.
#[derive(Clone, Debug)]
pub struct Body(pub(super) ast::Body);

impl Body {
    /// Creates a body on a frame, without mass so far.
    pub fn on(frame: impl Into<Frame>) -> Body {
        Body(ast::Body {
            frame: frame.into().ident(),
            mass: None,
            com: None,
            inertia: None,
        })
    }

    /// Sets its mass m (kg).
    pub fn mass(mut self, mass: impl Into<Expr>) -> Body {
        self.0.mass = Some(mass.into());
        self
    }

    /// Sets its centre of mass, frame axes (m); the origin by default.
    pub fn com(mut self, com: impl Into<Expr>) -> Body {
        self.0.com = Some(com.into());
        self
    }

    /// Sets its inertia about its centre of mass, frame axes, 3×3 (kg m²).
    pub fn inertia_about_com(mut self, inertia: impl Into<Expr>) -> Body {
        self.0.inertia = Some((inertia.into(), Some(About::Com)));
        self
    }

    /// Sets its inertia about the origin of the frame, frame axes, 3×3 (kg m²).
    pub fn inertia_about_origin(mut self, inertia: impl Into<Expr>) -> Body {
        self.0.inertia = Some((inertia.into(), Some(About::Origin)));
        self
    }
}

/// A force, torque or wrench on a frame; its components are in the axes of that frame unless
/// [`in_axes_of`](Self::in_axes_of) says otherwise.
#[derive(Clone, Debug)]
pub struct Load {
    load: ast::Load,
    frame: Frame,
    from: Option<Frame>,
    axes: Components,
}

impl Load {
    fn new(load: ast::Load, frame: impl Into<Frame>) -> Load {
        Load {
            load,
            frame: frame.into(),
            from: None,
            axes: Components::Body,
        }
    }

    /// Creates a force (N) at the origin of a frame.
    pub fn force(force: impl Into<Expr>, on: impl Into<Frame>) -> Load {
        let force = force.into();
        Load::new(ast::Load::Force { force, at: None }, on)
    }

    /// Creates a torque (N m) on a frame.
    pub fn torque(torque: impl Into<Expr>, on: impl Into<Frame>) -> Load {
        let torque = torque.into();
        Load::new(ast::Load::Torque { torque }, on)
    }

    /// Creates a wrench on a frame: a force (N) at its origin and a torque (N m).
    pub fn wrench(force: impl Into<Expr>, torque: impl Into<Expr>, on: impl Into<Frame>) -> Load {
        let (force, torque) = (force.into(), torque.into());
        let load = ast::Load::Wrench {
            force,
            torque,
            at: None,
        };
        Load::new(load, on)
    }

    /// Sets the point of application in the frame's axes (m). It does not matter for a torque.
    pub fn at(mut self, point: impl Into<Expr>) -> Load {
        match &mut self.load {
            ast::Load::Force { at, .. } | ast::Load::Wrench { at, .. } => *at = Some(point.into()),
            ast::Load::Torque { .. } => {}
        }
        self
    }

    /// Sets the frame that exerts the load, and on which the reaction acts.
    pub fn from(mut self, frame: impl Into<Frame>) -> Load {
        self.from = Some(frame.into());
        self
    }

    /// Sets the frame, possibly the world, in whose axes its components are given.
    pub fn in_axes_of(mut self, frame: impl Into<Frame>) -> Load {
        self.axes = match frame.into().moving() {
            Some(frame) => Components::Frame(frame),
            None => Components::World,
        };
        self
    }

    pub(super) fn item(self) -> ItemKind {
        ItemKind::Load {
            load: self.load,
            frame: self.frame.ident(),
            from: self.from.map(|frame| frame.ident()),
            axes: self.axes,
        }
    }
}

/// The ends of a spring or a damper: two points, as a pair, which it connects along a straight line; or a scalar, which
/// depends on the configuration for a spring, and is linear in the velocities for a damper and an inerter.
#[derive(Clone, Debug)]
pub struct Between(Acting);

impl From<(Point, Point)> for Between {
    fn from((from, to): (Point, Point)) -> Between {
        Between(Acting::Between(from.0, to.0))
    }
}

impl From<Expr> for Between {
    fn from(value: Expr) -> Between {
        Between(Acting::On(value))
    }
}

impl From<&Expr> for Between {
    fn from(value: &Expr) -> Between {
        value.clone().into()
    }
}

/// A spring, a cable, a damper, an inerter, or a force along a line.
#[derive(Clone, Debug)]
pub struct Element(pub(super) ItemKind);

impl Element {
    /// Creates a spring (N/m) that exerts no force where its points coincide or its scalar is zero.
    pub fn spring(stiffness: impl Into<Expr>, between: impl Into<Between>) -> Element {
        Element(ItemKind::Spring {
            stiffness: stiffness.into(),
            length: None,
            acting: between.into().0,
        })
    }

    /// Creates a spring (N/m) with the length or scalar at which it exerts no force.
    pub fn spring_of_length(
        stiffness: impl Into<Expr>,
        length: impl Into<Expr>,
        between: impl Into<Between>,
    ) -> Element {
        Element(ItemKind::Spring {
            stiffness: stiffness.into(),
            length: Some(length.into()),
            acting: between.into().0,
        })
    }

    /// Creates a cable (N/m) with the length up to which it is slack: a spring that only pulls.
    pub fn cable(
        stiffness: impl Into<Expr>,
        length: impl Into<Expr>,
        from: Point,
        to: Point,
    ) -> Element {
        Element(ItemKind::Cable {
            stiffness: stiffness.into(),
            length: length.into(),
            from: from.0,
            to: to.0,
        })
    }

    /// Creates a damper (N s/m).
    pub fn damper(coefficient: impl Into<Expr>, between: impl Into<Between>) -> Element {
        Element(ItemKind::Damper {
            coefficient: coefficient.into(),
            acting: between.into().0,
        })
    }

    /// Creates an inerter (kg, kg m²), whose force is proportional to the relative acceleration.
    pub fn inerter(inertance: impl Into<Expr>, between: impl Into<Between>) -> Element {
        Element(ItemKind::Inerter {
            inertance: inertance.into(),
            acting: between.into().0,
        })
    }

    /// Creates a force along the line between two points (N), positive if it pushes them apart.
    pub fn push(force: impl Into<Expr>, from: Point, to: Point) -> Element {
        Element(ItemKind::Push {
            force: force.into(),
            from: from.0,
            to: to.0,
        })
    }
}
