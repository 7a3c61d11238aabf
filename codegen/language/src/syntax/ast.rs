//! The syntax tree of a description: every node carries its span, and nothing is resolved.

mod expression;
mod joint;
mod origins;
mod quantity;
mod remarks;
mod reuse;
mod span;
mod table;
mod target;
pub mod visit;
mod wanted;

pub use expression::{BinaryOp, Choice, Comparison, Expr, ExprKind, Literal};
pub use joint::{Joint, JointField, JointKind};
pub use origins::{Included, Origins, Texts};
pub use quantity::Quantity;
pub use remarks::{Remark, Remarks};
pub use reuse::{Argument, Component, Counter, Parameter, Part, Repeat};
pub use span::Span;
pub use table::{Between, Beyond, Source, Table};
pub use target::Target;
pub use wanted::Wanted;

use crate::units::Unit;

/// A name with its source position.
#[derive(Clone, Debug, PartialEq)]
pub struct Ident {
    /// The name as written. Until components are expanded it can be `knee`, but also `left.knee` or `link[i-1]`.
    pub name: String,
    /// Position in the source.
    pub span: Span,
}

/// A whole description: `pub system Name { … }`.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// Doc comments above the system, one string per line, without the blank after `///`.
    pub docs: Vec<String>,
    /// Whether it was declared `pub`.
    pub public: bool,
    /// Name of the generated type.
    pub name: Ident,
    /// The statements, in source order.
    pub items: Vec<Item>,
    /// Origins of statements that do not stand in the text itself.
    pub origins: Origins,
    /// Comments for a reader of the printed text.
    pub remarks: Remarks,
    /// Whether all frames are results, for example because they are drawn. If so, no frame is reported as unused.
    pub shows_frames: bool,
    /// Whether the start was not chosen by anyone, as for a robot in URDF, whose coordinates start at 0. If so, M may
    /// be singular at the start provided it is regular nearby.
    pub starts_anywhere: bool,
}

/// A shape annotation: `vec3`, `mat3`, `sym3`, or nothing for a scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeKind {
    /// One number.
    Scalar,
    /// `vecN`
    Vector(usize),
    /// `matN`
    Matrix(usize),
    /// `symN`
    Symmetric(usize),
}

impl ShapeKind {
    /// Describes the shape in words.
    pub fn describe(self) -> String {
        match self {
            ShapeKind::Scalar => "a scalar".into(),
            ShapeKind::Vector(n) => format!("a vector of {n}"),
            ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => format!("a {n}×{n} matrix"),
        }
    }

    /// Returns the annotation that follows a name: `: vec3`, or nothing for a scalar.
    pub fn annotation(self) -> String {
        match self {
            ShapeKind::Scalar => String::new(),
            ShapeKind::Vector(n) => format!(": vec{n}"),
            ShapeKind::Matrix(n) => format!(": mat{n}"),
            ShapeKind::Symmetric(n) => format!(": sym{n}"),
        }
    }
}

/// A shape annotation with its position, which is that of the name if no annotation was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// The shape.
    pub kind: ShapeKind,
    /// Position in the source.
    pub span: Span,
}

/// The manifold of a coordinate: ℝ, ℝⁿ, S¹, S³, SO(3) or SE(3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordKind {
    /// A bare real number: an unconstrained scalar, or a raw coordinate of user-written `constraint`s.
    Real,
    /// `R1` .. `Rn`: a vector.
    Euclidean(usize),
    /// A pair (c, s) on the unit circle.
    S1,
    /// A unit quaternion, scalar first.
    S3,
    /// A rotation matrix.
    SO3,
    /// A rotation matrix `.R` and a position `.p`.
    SE3,
}

/// `param name: shape [unit] = default` or `input name: shape`, `velocity name: shape`.
#[derive(Clone, Debug, PartialEq)]
pub struct Declaration {
    /// The declared name.
    pub name: Ident,
    /// Its shape.
    pub shape: Shape,
    /// Its unit, if one was written.
    pub unit: Option<Unit>,
    /// Value, if the statement has one.
    pub value: Option<Expr>,
}

/// `fn name(a, b: vec3) = value;`
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name.
    pub name: Ident,
    /// Parameters. A parameter without an annotation is stored as a scalar but accepts any shape.
    pub parameters: Vec<(Ident, Shape)>,
    /// Body, an expression in the parameters and in all names of the description.
    pub value: Expr,
}

/// `extern fn lift(alpha, mach) -> 2;`, or with a substitute: `… -> 2 = [a, b];`
#[derive(Clone, Debug, PartialEq)]
pub struct External {
    /// Its name.
    pub name: Ident,
    /// Names of the arguments, which are all scalars.
    pub parameters: Vec<Ident>,
    /// Number of components of the result, and its position in the source.
    pub components: (usize, Span),
    /// Substitute for numerical evaluation where the Rust function is not available.
    pub stand_in: Option<Expr>,
    /// Whether the function is to be evaluated numerically, by its substitute.
    pub evaluated: bool,
}

impl System {
    /// Marks all `extern fn`s to be evaluated by their substitutes.
    pub fn evaluate(&mut self) {
        evaluate(&mut self.items);
    }
}

fn evaluate(items: &mut [Item]) {
    for item in items {
        match &mut item.kind {
            ItemKind::External(function) => function.evaluated = true,
            ItemKind::Component(component) => evaluate(&mut component.items),
            ItemKind::Repeat(repeat) => evaluate(&mut repeat.items),
            _ => {}
        }
    }
}

/// The reference point of an inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// The centre of mass.
    Com,
    /// The origin of the body's frame.
    Origin,
}

/// The axes in which the components of a load are written, after `in`.
#[derive(Clone, Debug, PartialEq)]
pub enum Components {
    /// `in body`: those of the frame that the load acts on.
    Body,
    /// `in world`
    World,
    /// `in g`: those of any frame.
    Frame(Ident),
}

/// The axes in which the components of a load, or of a traced motion, are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// The axes of the frame itself.
    Body,
    /// The world axes.
    World,
}

/// The fields of `body on f { … }`.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Frame to which the body is fixed.
    pub frame: Ident,
    /// `mass m;`
    pub mass: Option<Expr>,
    /// `com s;` in the frame's axes.
    pub com: Option<Expr>,
    /// `inertia Theta about com;`, the point is `None` where `about` was not written.
    pub inertia: Option<(Expr, Option<About>)>,
}

/// Load that a statement applies.
#[derive(Clone, Debug, PartialEq)]
pub enum Load {
    /// `force F at p on f in …;` with p in the frame's axes.
    Force {
        /// Force.
        force: Expr,
        /// Point of application, the origin of the frame if absent.
        at: Option<Expr>,
    },
    /// `torque t on f in …;`
    Torque {
        /// Torque.
        torque: Expr,
    },
    /// `wrench (F, t) [at p] on f in …;`
    Wrench {
        /// Force.
        force: Expr,
        /// Torque about the point.
        torque: Expr,
        /// Point of application, the origin of the frame if absent.
        at: Option<Expr>,
    },
}

/// A point of a frame: `p on f`, or `f` for its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// Point in the frame's axes, the origin if absent.
    pub at: Option<Expr>,
    /// Frame, possibly the world.
    pub frame: Ident,
}

/// The two points or the scalar that a spring, damper or inerter acts on.
#[derive(Clone, Debug, PartialEq)]
pub enum Acting {
    /// `from p on f to q on g`: along the line between two points.
    Between(End, End),
    /// `on q2 - q1`: a scalar coordinate expression; for a damper or inerter, a rate.
    On(Expr),
}

/// Quantity that an `invariant` statement claims to be constant along the motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Conserved {
    /// `energy`: T + V.
    Energy,
    /// `linear_momentum [of f] [along a]`, in world axes.
    LinearMomentum {
        /// Frame whose bodies count, or all bodies if absent.
        of: Option<Ident>,
        /// Direction of the constant component, or all three components if absent.
        along: Option<Expr>,
    },
    /// `angular_momentum [of f] [about p] [along a]`, in world axes.
    AngularMomentum {
        /// Frame whose bodies count, or all bodies if absent.
        of: Option<Ident>,
        /// Reference point in the world, the origin if absent.
        about: Option<Expr>,
        /// Direction of the constant component, or all three components if absent.
        along: Option<Expr>,
    },
    /// An expression.
    Value(Expr),
}

/// `F = 0` in `invariant … when F = 0;`: the value of an input or parameter, or of an entry of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Input or parameter that is set.
    pub target: Expr,
    /// Its value, made of parameters and constants.
    pub value: Expr,
}

/// One statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// Kind and contents of the statement.
    pub kind: ItemKind,
    /// Span of the whole statement.
    pub span: Span,
}

/// The statements of the language.
#[derive(Clone, Debug, PartialEq)]
pub enum ItemKind {
    /// `param m = 1.3, s: vec3 = [0, 0, 1];` run-time parameters.
    Param(Vec<Declaration>),
    /// `const k = 3/2;` exact build-time constants.
    Const(Vec<Declaration>),
    /// `let e = m * s;` a named expression.
    Let(Vec<Declaration>),
    /// `fn drag(v: vec3, c) = -c * norm(v) * v;` a function of expressions.
    Function(Function),
    /// `extern fn lift(alpha, mach) -> 2;`
    External(External),
    /// `table thrust = [(0, 0), (0.2, 1.1)] linear extrapolate hold;` a function given by its values.
    Table(Table),
    /// `coord r: R3 [m], R: SO3, q: [rad];`
    Coord(Vec<(Ident, CoordKind, Option<Unit>)>),
    /// `velocity v: vec3, w: vec3, u;`, or with the rows of Y that define it: `velocity v: vec3 = R.T * rate(r);`
    Velocity(Vec<Declaration>),
    /// `constraint a = b;`
    Constraint {
        /// The left side.
        left: Expr,
        /// The right side.
        right: Expr,
    },
    /// `rate r = R * v;`
    Rate {
        /// The coordinate.
        target: Target,
        /// Its time derivative, linear in the velocities.
        value: Expr,
    },
    /// `time t;` the user's name for the time.
    Time(Ident),
    /// `prescribe q = 0.3 * sin(t);` a given motion of a coordinate or velocity, or with `rate(v)` a given rate of a
    /// velocity.
    Prescribe {
        /// The coordinate or velocity.
        target: Target,
        /// Whether the rate of the velocity is given rather than the velocity itself.
        rate: bool,
        /// Prescribed value.
        value: Expr,
    },
    /// `inactive v, w[3];` velocities that stay zero.
    Inactive(Vec<Expr>),
    /// `independent u, w[1];` velocities that must remain independent when constraints are solved.
    Independent(Vec<Expr>),
    /// `nonholonomic a = b;` both sides linear in the velocities.
    Nonholonomic {
        /// The left side.
        left: Expr,
        /// The right side.
        right: Expr,
        /// λ in d/dt (B ξ) = −2 λ B ξ (1/s), no stabilisation if absent.
        stabilized: Option<Expr>,
    },
    /// `loop a = b;` a loop closure, enforced by multipliers.
    Loop {
        /// The left side.
        left: Expr,
        /// The right side.
        right: Expr,
        /// λ in φ̈ = −2 λ φ̇ − λ² φ (1/s), no stabilisation if absent.
        stabilized: Option<Expr>,
    },
    /// `frame f [on g] = pose(R, p);`
    Frame {
        /// The new frame.
        name: Ident,
        /// Frame that the pose is relative to, the world if absent.
        on: Option<Ident>,
        /// Its pose.
        pose: Expr,
    },
    /// `joint j: revolute [0, 0, 1] on f moves g;`
    Joint(Box<Joint>),
    /// `body on f { … }`
    Body(Body),
    /// `particle mass m at p [on f];` with p in world axes, or in those of the frame.
    Particle {
        /// Its mass.
        mass: Expr,
        /// Its position.
        at: Expr,
        /// Frame to which the particle is fixed, the world if absent.
        on: Option<Ident>,
    },
    /// `kinetic expr;`
    Kinetic(Expr),
    /// `potential expr;`
    Potential(Expr),
    /// `gravity [0, 0, -g];`
    Gravity(Expr),
    /// `input F: vec3;`
    Input(Vec<Declaration>),
    /// `state i = 0;` first-order states with their initial values; `rate i = …;` gives their derivatives.
    State(Vec<Declaration>),
    /// `force …`, `torque …`, `wrench …`
    Load {
        /// The load.
        load: Load,
        /// Frame it acts on.
        frame: Ident,
        /// `from g`: the frame that exerts the load and takes the reaction.
        from: Option<Ident>,
        /// Axes of the components.
        axes: Components,
    },
    /// `force F from p on f to q on g;` a force along the line between two points, positive if it pushes them apart.
    Push {
        /// The force, a scalar.
        force: Expr,
        /// The first point.
        from: End,
        /// The second point.
        to: End,
    },
    /// `spring stiffness k [length l] from p on f to q on g;` or `… on q2 - q1;`
    Spring {
        /// The stiffness.
        stiffness: Expr,
        /// Free length, 0 if absent.
        length: Option<Expr>,
        /// Points or scalar that it acts on.
        acting: Acting,
    },
    /// `cable stiffness k length l from p on f to q on g;` a spring that only pulls.
    Cable {
        /// The stiffness.
        stiffness: Expr,
        /// Length up to which the cable is slack.
        length: Expr,
        /// The first point.
        from: End,
        /// The second point.
        to: End,
    },
    /// `damper coefficient c from p on f to q on g;` or `… on w2 - w1;`
    Damper {
        /// The coefficient.
        coefficient: Expr,
        /// Points or scalar that it acts on.
        acting: Acting,
    },
    /// `inerter inertance b from p on f to q on g;` or `… on w2 - w1;`
    Inerter {
        /// The inertance.
        inertance: Expr,
        /// Points or scalar that it acts on.
        acting: Acting,
    },
    /// `dissipation d * w^2 / 2;` Rayleigh's function.
    Dissipation(Expr),
    /// `generalized force w = -d * w;` a generalized force, dual to a velocity.
    Generalized {
        /// The velocity.
        target: Target,
        /// Components of the force.
        value: Expr,
    },
    /// `start w = [0.01, 1, 0];`
    Start {
        /// The coordinate or velocity.
        target: Target,
        /// Its initial value.
        value: Expr,
    },
    /// `start q ~ 1.2;` an initial guess from which the start is solved for.
    Guess {
        /// The coordinate or velocity.
        target: Target,
        /// Approximate initial value.
        value: Expr,
    },
    /// `output speed = norm(v);`
    Output {
        /// The name of the function.
        name: Ident,
        /// Its unit, if one was written.
        unit: Option<Unit>,
        /// Value that the function returns.
        value: Expr,
    },
    /// `invariant name = expr when F = 0;`, `invariant energy;`
    Invariant {
        /// Name of the function that monitors the invariant.
        name: Ident,
        /// Constant quantity.
        conserved: Conserved,
        /// Conditions under which the quantity is constant.
        when: Vec<Condition>,
    },
    /// `generate accel, energy, jacobian tip in world;`
    Generate(Vec<Wanted>),
    /// `include "leg.eom";` the statements of a file. Holds the file name and its span.
    Include(String, Span),
    /// `component Leg(mount: frame, side = 1) { … }`
    Component(Component),
    /// `part left = Leg(hip, side = -1);`
    Part(Part),
    /// `for i in 1..n { … }`
    Repeat(Repeat),
}
