//! Reader for the statements about inertia and loads, and its results.

use super::declare::Declared;
use super::expression::Evaluator;
use crate::algebra::graph::Edge;
use crate::algebra::linear::Vec3;
use crate::diagnostics::Diagnostic;
use crate::functions::{Asked, FunctionId};
use crate::model::elements::Elements;
use crate::model::value::Value;
use crate::model::{Body, Frame, Particle, Wrench, class};
use crate::syntax::ast::{Expr, Ident, Span};

/// Word in `generate` for everything that a description without `generate` gets.
pub const ALL: &str = "all";

/// Contents of the statements about inertia and loads.
pub struct Dynamics {
    pub bodies: Vec<Body>,
    pub particles: Vec<Particle>,
    pub kinetic: Edge,
    pub potential: Edge,
    pub gravity: Vec3,
    pub wrenches: Vec<Wrench>,
    pub generalized: Vec<Edge>,
    pub dissipation: Edge,
    pub elements: Elements,
    pub outputs: Vec<(String, Value)>,
    pub asked: Asked,
    /// Whether there is any statement about inertia.
    pub has_inertia: bool,
}

/// Returns whether a name is that of a generated function, which outputs and invariants cannot have.
pub fn is_taken(name: &str) -> bool {
    name == ALL || FunctionId::from_name(name).is_some()
}

/// Reads single statements.
pub struct Reader<'a, 'b> {
    pub evaluator: Evaluator<'a>,
    pub frames: &'b [Frame],
    pub declared: &'b Declared,
}

impl Reader<'_, '_> {
    pub fn class_of(&self, value: &Value) -> u8 {
        let entries = value.entries();
        entries.iter().fold(0, |class, edge| {
            class | self.evaluator.graph.class(edge.node())
        })
    }

    /// Reports an error unless a value consists of parameters and constants alone.
    pub fn constant(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        if self.class_of(value) & !class::PARAM == 0 {
            return Some(());
        }
        self.evaluator.error(
            Diagnostic::new(span, format!("{what} has to be constant"))
                .help("it may depend only on parameters and constants"),
        )
    }

    pub fn constant_scalar(&mut self, expr: &Expr, what: &str) -> Option<Edge> {
        let edge = self.evaluator.scalar(expr)?;
        self.constant(&Value::Scalar(edge), expr.span, what)?;
        Some(edge)
    }

    pub fn constant_vec3(&mut self, expr: &Expr, what: &str) -> Option<Vec3> {
        let value = self.evaluator.vec3(expr)?;
        self.constant(&Value::Vector(value.to_vec()), expr.span, what)?;
        Some(value)
    }

    /// Reports an error if a load depends on accelerations.
    pub fn no_acceleration(&mut self, value: &Value, span: Span, what: &str) -> Option<()> {
        if self.class_of(value) & class::ACCEL == 0 {
            return Some(());
        }
        self.evaluator.error(
            Diagnostic::new(span, format!("{what} cannot depend on accelerations"))
                .help("what resists acceleration is inertia: a `body`, a `particle` or a `kinetic` energy"),
        )
    }

    /// Reports an error unless a value is a function of the configuration.
    pub fn configuration(
        &mut self,
        value: &Value,
        span: Span,
        what: &str,
        help: &str,
    ) -> Option<()> {
        if self.class_of(value) & !(class::PARAM | class::CONFIGURATION) == 0 {
            return Some(());
        }
        let message = format!("{what} may depend only on coordinates and parameters");
        self.evaluator
            .error(Diagnostic::new(span, message).help(help))
    }

    /// Finds a frame by name; `None` if its own definition was in error.
    pub fn frame(&self, name: &Ident) -> Option<usize> {
        self.frames.iter().position(|frame| frame.name == name.name)
    }
}
