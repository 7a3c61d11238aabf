//! The description as written: every node carries its span, nothing is resolved.

mod expression;
mod joint;
mod origins;
mod reuse;
mod span;
mod table;
mod target;
pub mod visit;
mod wanted;

pub use expression::{BinaryOp, Choice, Comparison, Expr, ExprKind};
pub use joint::{Joint, JointField, JointKind};
pub use origins::{Included, Origins, Texts};
pub use reuse::{Argument, Component, Counter, Parameter, Part, Repeat};
pub use span::Span;
pub use table::{Between, Beyond, Source, Table};
pub use target::Target;
pub use wanted::Wanted;

/// A name with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Ident {
    /// The name as written: `knee`, but also `left.knee`, `link[i-1]` until components are written out.
    pub name: String,
    /// Where it stands.
    pub span: Span,
}

/// A whole description: `pub system Name { … }`.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// Doc comments above the system, one string a line, without the blank after `///`.
    pub docs: Vec<String>,
    /// Whether it was declared `pub`.
    pub public: bool,
    /// Name of the generated type.
    pub name: Ident,
    /// The statements, in source order.
    pub items: Vec<Item>,
    /// Where statements come from that do not stand in the text itself.
    pub origins: Origins,
    /// Whether all frames are results, as where they are drawn: then none of them is without a use.
    pub shows_frames: bool,
    /// Whether nobody has chosen the start, as that of a robot in URDF, whose coordinates start at 0: M may be singular
    /// there if it is not so nearby.
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
    /// The shape in words.
    pub fn describe(self) -> String {
        match self {
            ShapeKind::Scalar => "a scalar".into(),
            ShapeKind::Vector(n) => format!("a vector of {n}"),
            ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => format!("a {n}×{n} matrix"),
        }
    }

    /// What stands behind a name: `: vec3`, nothing for a scalar.
    pub fn annotation(self) -> String {
        match self {
            ShapeKind::Scalar => String::new(),
            ShapeKind::Vector(n) => format!(": vec{n}"),
            ShapeKind::Matrix(n) => format!(": mat{n}"),
            ShapeKind::Symmetric(n) => format!(": sym{n}"),
        }
    }
}

/// A shape annotation with its place (the place of the name where none was written).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// The shape.
    pub kind: ShapeKind,
    /// Where it stands.
    pub span: Span,
}

/// The coordinate kinds.
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

/// `param name: shape = default` or `input name: shape`, `velocity name: shape`.
#[derive(Clone, Debug, PartialEq)]
pub struct Declaration {
    /// The declared name.
    pub name: Ident,
    /// Its shape.
    pub shape: Shape,
    /// Its value, where the statement has one.
    pub value: Option<Expr>,
}

/// `fn name(a, b: vec3) = value;`
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its name.
    pub name: Ident,
    /// Its parameters; a scalar's shape stands for any where none was written.
    pub parameters: Vec<(Ident, Shape)>,
    /// Its value, in its parameters and all names of the description.
    pub value: Expr,
}

/// `extern fn lift(alpha, mach) -> 2;`, or with a stand-in: `… -> 2 = [a, b];`
#[derive(Clone, Debug, PartialEq)]
pub struct External {
    /// Its name.
    pub name: Ident,
    /// The names of its arguments, all of them numbers.
    pub parameters: Vec<Ident>,
    /// How many components it has, and where that is said.
    pub components: (usize, Span),
    /// What has its place where numbers of it are wanted and the function is not there.
    pub stand_in: Option<Expr>,
    /// Whether numbers of it are wanted.
    pub evaluated: bool,
}

impl System {
    /// From now on numbers of functions in Rust are wanted: those of their stand-ins.
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

/// The axes in which components are computed: those of a load, or of a motion that is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// Those of the frame itself.
    Body,
    /// Those of the world.
    World,
}

/// The fields of `body on f { … }`.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The frame it is fixed to.
    pub frame: Ident,
    /// `mass m;`
    pub mass: Option<Expr>,
    /// `com s;` in the frame's axes.
    pub com: Option<Expr>,
    /// `inertia Theta about com;`, the point is `None` where `about` was not written.
    pub inertia: Option<(Expr, Option<About>)>,
}

/// What a load statement applies.
#[derive(Clone, Debug, PartialEq)]
pub enum Load {
    /// `force F at p on f in …;` p in the frame's axes, the origin where absent.
    Force {
        /// The force.
        force: Expr,
        /// The point it acts at.
        at: Option<Expr>,
    },
    /// `torque t on f in …;`
    Torque {
        /// The torque.
        torque: Expr,
    },
    /// `wrench (F, t) [at p] on f in …;`
    Wrench {
        /// The force.
        force: Expr,
        /// The torque about the point.
        torque: Expr,
        /// The point they act at, the origin of the frame where absent.
        at: Option<Expr>,
    },
}

/// A point of a frame: `p on f`, or `f` for its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// The point in the frame's axes, the origin where absent.
    pub at: Option<Expr>,
    /// The frame; the world is one.
    pub frame: Ident,
}

/// What a spring or damper acts on.
#[derive(Clone, Debug, PartialEq)]
pub enum Acting {
    /// `from p on f to q on g`: along the line between two points.
    Between(End, End),
    /// `on q2 - q1`: a scalar; for a damper, a rate.
    On(Expr),
}

/// What an `invariant` statement claims to be constant along the motion.
#[derive(Clone, Debug, PartialEq)]
pub enum Conserved {
    /// `energy`: T + V.
    Energy,
    /// `linear_momentum [of f] [along a]`, world axes.
    LinearMomentum {
        /// The frame whose bodies are meant, everything where absent.
        of: Option<Ident>,
        /// The direction, all three components where absent.
        along: Option<Expr>,
    },
    /// `angular_momentum [of f] [about p] [along a]`, world axes.
    AngularMomentum {
        /// The frame whose bodies are meant, everything where absent.
        of: Option<Ident>,
        /// The point of reference in the world, its origin where absent.
        about: Option<Expr>,
        /// The direction, all three components where absent.
        along: Option<Expr>,
    },
    /// An expression.
    Value(Expr),
}

/// `F = 0` of `invariant … when F = 0;`: an input or a parameter, or an entry of one, with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// What is set.
    pub target: Expr,
    /// Its value, of parameters and constants.
    pub value: Expr,
}

/// One statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// What it says.
    pub kind: ItemKind,
    /// The whole statement.
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
    /// `table thrust = [(0, 0), (0.2, 1.1)] linear extrapolate hold;` a function by its values.
    Table(Table),
    /// `coord r: R3, R: SO3, q;`
    Coord(Vec<(Ident, CoordKind)>),
    /// `velocity v: vec3, w: vec3, u;`, or with rows of Y: `velocity v: vec3 = R.T * rate(r);`
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
    /// `time t;` the time, under a name of the user's.
    Time(Ident),
    /// `prescribe q = 0.3 * sin(t);` the motion of a coordinate or of a velocity is given, or with `rate(v)` the rate of
    /// a velocity.
    Prescribe {
        /// The coordinate or velocity.
        target: Target,
        /// Whether it is the rate of the velocity that is given.
        rate: bool,
        /// What is given.
        value: Expr,
    },
    /// `inactive v, w[3];` velocities that stay zero.
    Inactive(Vec<Expr>),
    /// `independent u, w[1];` velocities that no constraint gives by others.
    Independent(Vec<Expr>),
    /// `nonholonomic a = b;` both sides linear in the velocities.
    Nonholonomic {
        /// The left side.
        left: Expr,
        /// The right side.
        right: Expr,
        /// λ in d/dt (B ξ) = −2 λ B ξ (1/s), nothing where absent.
        stabilized: Option<Expr>,
    },
    /// `loop a = b;` a closed loop, kept by multipliers.
    Loop {
        /// The left side.
        left: Expr,
        /// The right side.
        right: Expr,
        /// λ in φ̈ = −2 λ φ̇ − λ² φ (1/s), nothing where absent.
        stabilized: Option<Expr>,
    },
    /// `frame f [on g] = pose(R, p);`
    Frame {
        /// The new frame.
        name: Ident,
        /// The frame that the pose is relative to, the world where absent.
        on: Option<Ident>,
        /// Its pose.
        pose: Expr,
    },
    /// `joint j: revolute [0, 0, 1] on f moves g;`
    Joint(Box<Joint>),
    /// `body on f { … }`
    Body(Body),
    /// `particle mass m at p [on f];` p in world axes, or in those of the frame.
    Particle {
        /// Its mass.
        mass: Expr,
        /// Its position.
        at: Expr,
        /// The frame it is fixed to, the world's axes where absent.
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
    /// `state i = 0;` states of first order with their values at the start; `rate i = …;` says how they change.
    State(Vec<Declaration>),
    /// `force …`, `torque …`, `wrench …`
    Load {
        /// What is applied.
        load: Load,
        /// The frame it acts on.
        frame: Ident,
        /// `from g`: the frame that exerts it, and takes the reaction.
        from: Option<Ident>,
        /// The axes of its components.
        axes: Components,
    },
    /// `force F from p on f to q on g;` along the line between two points, positive apart.
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
        /// The length without force, 0 where absent.
        length: Option<Expr>,
        /// What it acts on.
        acting: Acting,
    },
    /// `damper coefficient c from p on f to q on g;` or `… on w2 - w1;`
    Damper {
        /// The coefficient.
        coefficient: Expr,
        /// What it acts on.
        acting: Acting,
    },
    /// `inerter inertance b from p on f to q on g;` or `… on w2 - w1;`
    Inerter {
        /// The inertance.
        inertance: Expr,
        /// What it acts on.
        acting: Acting,
    },
    /// `dissipation d * w^2 / 2;` Rayleigh's function.
    Dissipation(Expr),
    /// `generalized force w = -d * w;` dual to a velocity.
    Generalized {
        /// The velocity.
        target: Target,
        /// The components dual to it.
        value: Expr,
    },
    /// `start w = [0.01, 1, 0];`
    Start {
        /// The coordinate or velocity.
        target: Target,
        /// Its value at the start.
        value: Expr,
    },
    /// `start q ~ 1.2;` near which value the start is looked for.
    Guess {
        /// The coordinate or velocity.
        target: Target,
        /// A value near that at the start.
        value: Expr,
    },
    /// `output speed = norm(v);`
    Output {
        /// The name of the function.
        name: Ident,
        /// What it returns.
        value: Expr,
    },
    /// `invariant name = expr when F = 0;`, `invariant energy;`
    Invariant {
        /// The name of the function that watches it.
        name: Ident,
        /// What is constant.
        conserved: Conserved,
        /// Where it is.
        when: Vec<Condition>,
    },
    /// `generate accel, energy, jacobian tip in world;`
    Generate(Vec<Wanted>),
    /// `include "leg.eom";` the statements of a file, with the place of its name.
    Include(String, Span),
    /// `component Leg(mount: frame, side = 1) { … }`
    Component(Component),
    /// `part left = Leg(hip, side = -1);`
    Part(Part),
    /// `for i in 1..n { … }`
    Repeat(Repeat),
}
