//! The builder of scenes: a method for each statement of the language.

use super::claim::{Claim, claimed};
use super::parts::{Body, Element, Frame, Joint, Load};
use super::{Scene, SceneError, check};
use crate::syntax::ast::{
    Between, Beyond, Condition, CoordKind, Declaration, Expr, External, Function, Item, ItemKind,
    Origins, Remarks, Shape, ShapeKind, Source, Span, System, Table, Target, Wanted,
};
use crate::syntax::parse_text;
use hamel_language::expression::ident;

/// Builds a [`Scene`] statement by statement, in the same order as in a text.
///
/// Names, and whether numbers are finite, are checked when the scene is [built](Self::build), everything else when it
/// is [generated](Scene::generate), by the same checks as for texts. Errors show the statement that they are about.
#[derive(Clone, Debug)]
pub struct SceneBuilder {
    pub(super) system: System,
}

impl SceneBuilder {
    pub(super) fn new(name: &str) -> SceneBuilder {
        SceneBuilder {
            system: System {
                docs: Vec::new(),
                public: true,
                name: ident(name),
                items: Vec::new(),
                origins: Origins::default(),
                remarks: Remarks::default(),
                shows_frames: false,
                starts_anywhere: false,
            },
        }
    }

    pub(super) fn add(&mut self, kind: ItemKind) {
        let span = Span::NOWHERE;
        let mut item = Item { kind, span };
        check::cut(&mut item);
        self.system.items.push(item);
    }

    /// Collects the statements that are nested in another one.
    pub(super) fn inner(&self, statements: impl FnOnce(&mut SceneBuilder)) -> Vec<Item> {
        let mut inner = SceneBuilder::new(&self.system.name.name);
        statements(&mut inner);
        inner.system.items
    }

    /// Adds a line, or several, to the documentation of the generated type.
    pub fn doc(&mut self, line: &str) {
        let lines = line.replace("\r\n", "\n").replace('\r', "\n");
        let none = lines.is_empty().then(String::new);
        let lines = lines.lines().map(str::to_string);
        self.system.docs.extend(lines.chain(none));
    }

    /// Sets whether the generated type is `pub`; it is by default.
    pub fn public(&mut self, public: bool) {
        self.system.public = public;
    }

    /// Adds statements as text: `arm.text("output reach = norm(tool.p);")`.
    ///
    /// # Errors
    /// All parts of the text that are not valid statements.
    pub fn text(&mut self, statements: &str) -> Result<(), SceneError> {
        // The text begins on the first line, so that the line numbers of errors are those of the statements.
        let text = format!("system S {{ {statements}\n}}");
        let parsed = parse_text(&text).map_err(|errors| SceneError::new(errors, &text))?;
        self.system.items.extend(parsed.items);
        Ok(())
    }

    /// Adds a scalar parameter with its default value. It is constant along the motion, and is set at run time.
    pub fn param(&mut self, name: &str, value: impl Into<Expr>) -> Expr {
        self.param_of(name, ShapeKind::Scalar, value)
    }

    /// Adds a vector or matrix of parameters with its default value.
    pub fn param_of(&mut self, name: &str, shape: ShapeKind, value: impl Into<Expr>) -> Expr {
        self.add(ItemKind::Param(vec![declared(
            name,
            shape,
            Some(value.into()),
        )]));
        Expr::name(name)
    }

    /// Adds an exact constant, whose value is fixed in the generated code.
    pub fn constant(&mut self, name: &str, value: impl Into<Expr>) -> Expr {
        let value = Some(value.into());
        self.add(ItemKind::Const(vec![declared(
            name,
            ShapeKind::Scalar,
            value,
        )]));
        Expr::name(name)
    }

    /// Adds a name for an expression.
    pub fn define(&mut self, name: &str, value: impl Into<Expr>) -> Expr {
        let value = Some(value.into());
        self.add(ItemKind::Let(vec![declared(
            name,
            ShapeKind::Scalar,
            value,
        )]));
        Expr::name(name)
    }

    /// Adds a function that is defined by an expression. Each parameter has a shape; a scalar one accepts any shape.
    /// Call it with [`call`](super::call).
    pub fn function(
        &mut self,
        name: &str,
        parameters: &[(&str, ShapeKind)],
        value: impl Into<Expr>,
    ) {
        let span = Span::NOWHERE;
        let parameters = parameters
            .iter()
            .map(|&(name, kind)| (ident(name), Shape { kind, span }));
        self.add(ItemKind::Function(Function {
            name: ident(name),
            parameters: parameters.collect(),
            value: value.into(),
        }));
    }

    /// Adds an external function in Rust of some numbers, which returns `components` numbers. The stand-in replaces it
    /// wherever the function is not available. Call it with [`call`](super::call).
    pub fn external(
        &mut self,
        name: &str,
        parameters: &[&str],
        components: usize,
        stand_in: Option<Expr>,
    ) {
        self.add(ItemKind::External(External {
            name: ident(name),
            parameters: parameters.iter().map(|&name| ident(name)).collect(),
            components: (components, Span::NOWHERE),
            stand_in,
            evaluated: false,
        }));
    }

    /// Adds a function that interpolates values at increasing arguments. Call it with [`call`](super::call).
    pub fn table(&mut self, name: &str, points: &[(f64, f64)], between: Between, beyond: Beyond) {
        let points = points.iter().map(|&(a, b)| (a.into(), b.into()));
        self.add(ItemKind::Table(Table {
            name: ident(name),
            source: Source::Points(points.collect(), Span::NOWHERE),
            between,
            beyond,
        }));
    }

    /// Adds such a function with its values in a file. A scene has no folder for the file: it can be printed, and its
    /// text can be derived where the file is.
    pub fn table_from(&mut self, name: &str, path: &str, between: Between, beyond: Beyond) {
        self.add(ItemKind::Table(Table {
            name: ident(name),
            source: Source::File(path.to_string(), Span::NOWHERE),
            between,
            beyond,
        }));
    }

    /// Adds a configuration coordinate.
    pub fn coordinate(&mut self, name: &str, kind: CoordKind) -> Expr {
        self.add(ItemKind::Coord(vec![(ident(name), kind, None)]));
        Expr::name(name)
    }

    /// Adds a velocity coordinate: one entry of ξ, or several.
    pub fn velocity(&mut self, name: &str, shape: ShapeKind) -> Expr {
        self.add(ItemKind::Velocity(vec![declared(name, shape, None)]));
        Expr::name(name)
    }

    /// Adds a velocity coordinate that is defined by rates of coordinates: ξ = Y(x) ẋ, with `rate(…)` in the value.
    pub fn velocity_by(&mut self, name: &str, shape: ShapeKind, value: impl Into<Expr>) -> Expr {
        let value = Some(value.into());
        self.add(ItemKind::Velocity(vec![declared(name, shape, value)]));
        Expr::name(name)
    }

    /// Adds a scalar input u, given at run time.
    pub fn input(&mut self, name: &str) -> Expr {
        self.input_of(name, ShapeKind::Scalar)
    }

    /// Adds a vector or matrix of inputs.
    pub fn input_of(&mut self, name: &str, shape: ShapeKind) -> Expr {
        self.add(ItemKind::Input(vec![declared(name, shape, None)]));
        Expr::name(name)
    }

    /// Adds a state of first order z with its initial value; [`rate`](Self::rate) defines ż.
    pub fn state(&mut self, name: &str, shape: ShapeKind, start: impl Into<Expr>) -> Expr {
        let value = Some(start.into());
        self.add(ItemKind::State(vec![declared(name, shape, value)]));
        Expr::name(name)
    }

    /// Defines ẋ of a coordinate, or of a part such as `X.p`, as a row of ẋ = A ξ; or ż of a state.
    pub fn rate(&mut self, coordinate: &str, value: impl Into<Expr>) {
        self.add(ItemKind::Rate {
            target: target(coordinate),
            value: value.into(),
        });
    }

    /// Adds a geometric constraint φ(x) = 0 on the coordinates: left = right.
    pub fn constraint(&mut self, left: impl Into<Expr>, right: impl Into<Expr>) {
        self.add(ItemKind::Constraint {
            left: left.into(),
            right: right.into(),
        });
    }

    /// Adds the time: a coordinate t with ṫ = 1.
    pub fn time(&mut self, name: &str) -> Expr {
        self.add(ItemKind::Time(ident(name)));
        Expr::name(name)
    }

    /// Prescribes the motion of a coordinate or a velocity as a function of time.
    pub fn prescribe(&mut self, of: &str, value: impl Into<Expr>) {
        self.add(ItemKind::Prescribe {
            target: target(of),
            rate: false,
            value: value.into(),
        });
    }

    /// Prescribes the rate of a velocity, as a function of anything but rates of velocities.
    pub fn prescribe_rate(&mut self, velocity: &str, value: impl Into<Expr>) {
        self.add(ItemKind::Prescribe {
            target: target(velocity),
            rate: true,
            value: value.into(),
        });
    }

    /// Declares velocities that stay zero.
    pub fn inactive(&mut self, velocities: impl IntoIterator<Item = Expr>) {
        self.add(ItemKind::Inactive(velocities.into_iter().collect()));
    }

    /// Declares velocities for which no constraint is solved: they stay in ξ.
    pub fn independent(&mut self, velocities: impl IntoIterator<Item = Expr>) {
        self.add(ItemKind::Independent(velocities.into_iter().collect()));
    }

    /// Adds a constraint B(x) ξ = 0, where both sides are linear in the velocities.
    pub fn nonholonomic(&mut self, left: impl Into<Expr>, right: impl Into<Expr>) {
        self.add(ItemKind::Nonholonomic {
            left: left.into(),
            right: right.into(),
            stabilized: None,
        });
    }

    /// Adds a stabilized constraint B(x) ξ = 0: an initial violation decays at a rate (1/s).
    pub fn nonholonomic_stabilized(
        &mut self,
        left: impl Into<Expr>,
        right: impl Into<Expr>,
        rate: impl Into<Expr>,
    ) {
        self.add(ItemKind::Nonholonomic {
            left: left.into(),
            right: right.into(),
            stabilized: Some(rate.into()),
        });
    }

    /// Adds a closed loop, left = right, enforced by multipliers.
    pub fn closed_loop(&mut self, left: impl Into<Expr>, right: impl Into<Expr>) {
        self.add(ItemKind::Loop {
            left: left.into(),
            right: right.into(),
            stabilized: None,
        });
    }

    /// Adds a stabilized closed loop: an initial violation decays at a rate (1/s).
    pub fn closed_loop_stabilized(
        &mut self,
        left: impl Into<Expr>,
        right: impl Into<Expr>,
        rate: impl Into<Expr>,
    ) {
        self.add(ItemKind::Loop {
            left: left.into(),
            right: right.into(),
            stabilized: Some(rate.into()),
        });
    }

    /// Adds a frame with its pose in another one.
    pub fn frame(&mut self, name: &str, on: impl Into<Frame>, pose: impl Into<Expr>) -> Frame {
        let on = on.into();
        let on = (on != super::WORLD.into()).then(|| on.ident());
        self.add(ItemKind::Frame {
            name: ident(name),
            on,
            pose: pose.into(),
        });
        name.into()
    }

    /// Adds a joint; returns the frame that it carries.
    pub fn joint(&mut self, joint: Joint) -> Frame {
        let moves = joint.0.moves.name.as_str().into();
        self.add(ItemKind::Joint(Box::new(joint.0)));
        moves
    }

    /// Adds a rigid body.
    pub fn body(&mut self, body: Body) {
        self.add(ItemKind::Body(body.0));
    }

    /// Adds a point mass (kg) at a position in world axes (m).
    pub fn particle(&mut self, mass: impl Into<Expr>, at: impl Into<Expr>) {
        self.add(ItemKind::Particle {
            mass: mass.into(),
            at: at.into(),
            on: None,
        });
    }

    /// Adds a point mass (kg) fixed to a frame, at a position in its axes (m).
    pub fn particle_on(
        &mut self,
        frame: impl Into<Frame>,
        mass: impl Into<Expr>,
        at: impl Into<Expr>,
    ) {
        self.add(ItemKind::Particle {
            mass: mass.into(),
            at: at.into(),
            on: Some(frame.into().ident()),
        });
    }

    /// Adds a kinetic energy (J) to that of bodies and particles.
    pub fn kinetic(&mut self, energy: impl Into<Expr>) {
        self.add(ItemKind::Kinetic(energy.into()));
    }

    /// Adds a potential energy (J) to that of gravity.
    pub fn potential(&mut self, energy: impl Into<Expr>) {
        self.add(ItemKind::Potential(energy.into()));
    }

    /// Sets the acceleration of gravity, world axes (m/s²).
    pub fn gravity(&mut self, acceleration: impl Into<Expr>) {
        self.add(ItemKind::Gravity(acceleration.into()));
    }

    /// Adds a force, torque or wrench.
    pub fn load(&mut self, load: Load) {
        self.add(load.item());
    }

    /// Adds a spring, a cable, a damper, an inerter, or a force along a line.
    pub fn element(&mut self, element: Element) {
        self.add(element.0);
    }

    /// Adds a Rayleigh dissipation function D(x, ξ) (W); its generalised force is −∂D/∂ξ.
    pub fn dissipation(&mut self, power: impl Into<Expr>) {
        self.add(ItemKind::Dissipation(power.into()));
    }

    /// Adds a generalised force, dual to a velocity.
    pub fn generalized_force(&mut self, velocity: &str, value: impl Into<Expr>) {
        self.add(ItemKind::Generalized {
            target: target(velocity),
            value: value.into(),
        });
    }

    /// Sets the initial value of a coordinate or velocity.
    pub fn start(&mut self, of: &str, value: impl Into<Expr>) {
        self.add(ItemKind::Start {
            target: target(of),
            value: value.into(),
        });
    }

    /// Sets an approximate initial value of a coordinate or velocity: it selects how loops are assembled.
    pub fn guess(&mut self, of: &str, value: impl Into<Expr>) {
        self.add(ItemKind::Guess {
            target: target(of),
            value: value.into(),
        });
    }

    /// Adds a function to the generated type, in addition to those of the formalism.
    pub fn output(&mut self, name: &str, value: impl Into<Expr>) {
        self.add(ItemKind::Output {
            name: ident(name),
            unit: None,
            value: value.into(),
        });
    }

    /// Claims that a value is constant along the motion, if some inputs or parameters have the given values.
    /// [`generate`](Scene::generate) refuses a claim that does not hold.
    pub fn invariant(
        &mut self,
        name: &str,
        value: impl Into<Expr>,
        when: impl IntoIterator<Item = (Expr, Expr)>,
    ) {
        let when = when.into_iter();
        self.add(ItemKind::Invariant {
            name: ident(name),
            conserved: claimed(value.into()),
            when: when
                .map(|(target, value)| Condition { target, value })
                .collect(),
        });
    }

    /// Claims that an energy or momentum is constant along the motion.
    pub fn claim(&mut self, claim: Claim) {
        self.add(claim.item());
    }

    /// Selects the functions to generate, such as `accel`; all by default.
    pub fn generate(&mut self, functions: &[&str]) {
        let functions = functions.iter().map(|name| Wanted::Function(ident(name)));
        self.add(ItemKind::Generate(functions.collect()));
    }

    /// Generates the kinematics of a frame: pose, twist, Jacobian, bias acceleration. Components are in the axes of the
    /// world or of the frame itself.
    pub fn generate_jacobian(&mut self, frame: &str, axes: &str) {
        self.add(ItemKind::Generate(vec![Wanted::Jacobian {
            frame: ident(frame),
            axes: Some(ident(axes)),
        }]));
    }

    /// Returns the scene.
    ///
    /// # Errors
    /// Names that are not valid in the language, numbers that are not finite, and expressions that are too deep, each
    /// with the statement in which it occurs.
    pub fn build(&self) -> Result<Scene, SceneError> {
        check::checked(&self.system)
    }
}

fn declared(name: &str, shape: ShapeKind, value: Option<Expr>) -> Declaration {
    Declaration {
        name: ident(name),
        shape: Shape {
            kind: shape,
            span: Span::NOWHERE,
        },
        unit: None,
        value,
    }
}

/// Parses a target such as `R`, `X.p` or `leg[3].knee`.
fn target(text: &str) -> Target {
    match text.rsplit_once('.') {
        Some((name, field)) if !field.contains('[') => Target {
            name: ident(name),
            field: Some(ident(field)),
            entry: Vec::new(),
        },
        _ => Target {
            name: ident(text),
            field: None,
            entry: Vec::new(),
        },
    }
}
