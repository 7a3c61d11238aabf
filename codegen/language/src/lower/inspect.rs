//! Inspects single expressions, for tests: the shape that inference gives, and the value in a graph.

use super::declare::declare;
use super::expression::Evaluator;
use super::motion::TimeDerivative;
use super::names::Names;
use super::scope::Scope;
use super::{joints, time};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::residue_pair::Random;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::model::{class, samples};
use crate::syntax::ast::{Expr, System};
use crate::{reuse, shapes, symbols};
use num_rational::BigRational;

pub use super::axes::CALLS;

/// Result of inspecting one expression: its shape, its value, and whether it has an error.
#[derive(Debug)]
pub struct Found {
    /// Inferred shape in words, with the values of the entries if they are known; `None` if something is wrong.
    pub inferred: Option<(String, Option<Vec<BigRational>>)>,
    /// Whether inference reports an error.
    pub refused: bool,
    /// Value in the graph, with those of its entries that are numbers.
    pub value: Option<(Value, Vec<Option<BigRational>>)>,
    /// Whether evaluation fails for a mathematical reason.
    pub failed: bool,
}

/// Inspects expressions in a description whose joints and time are expanded: `look` receives the expanded description
/// and a function that inspects an expression.
pub fn inspect<R>(
    system: &System,
    look: impl FnOnce(&System, &dyn Fn(&Expr) -> Found) -> R,
) -> Result<R, Vec<Diagnostic>> {
    let written = reuse::expand(system)?;
    let mut report = Report::new();
    let system = joints::expand(&written.system, &mut report);
    let system = time::expand(&system, &mut report);
    let names = symbols::resolve(&system, &mut report);
    shapes::check(&system, &names, &mut report);
    report.finish()?;
    let setting = Setting::new(&system, &names)?;
    Ok(look(&system, &|expr| setting.find(expr)))
}

/// A description, with a graph in which everything that its expressions can mention has a value.
struct Setting<'a> {
    system: &'a System,
    names: &'a symbols::Resolved<'a>,
    graph: Graph,
    scope: Scope<'a>,
}

impl<'a> Setting<'a> {
    fn new(system: &'a System, names: &'a symbols::Resolved<'a>) -> Result<Self, Vec<Diagnostic>> {
        let mut random = Random::new(7);
        let mut graph = Graph::new(class::PARAM);
        let mut scope = Scope::new(system, &names.symbols, true);
        let mut report = Report::new();
        let mut next = |_: &mut Graph| random.element();
        let declared = declare(system, &mut graph, &mut next, &mut scope, &mut report);
        let x_dot = declared.x.iter();
        let x_dot = x_dot.map(|_| graph.symbol("x_dot", class::VELOCITY, random.element()));
        let x_dot: Vec<Edge> = x_dot.collect();
        graph.set_reals(samples::anywhere(graph.symbols().len(), 7));
        let (x, xi, xi_dot) = (&declared.x, &declared.xi, &declared.xi_dot);
        scope.motion = Some(TimeDerivative::new(x, &x_dot, xi, xi_dot));
        let mut values = Names::default();
        let order = &names.order;
        values.read(&order.before, &mut graph, &mut scope, &mut report);
        values.read(&order.after, &mut graph, &mut scope, &mut report);
        report.finish()?;
        Ok(Setting {
            system,
            names,
            graph,
            scope,
        })
    }

    fn find(&self, expr: &Expr) -> Found {
        let mut inference = shapes::read(self.system, self.names);
        inference.report = Report::new();
        let inferred = inference.of(expr);
        self.scope.calls.set(0);
        let (mut graph, mut report) = (self.graph.clone(), Report::new());
        let value = Evaluator::new(&mut graph, &self.scope, &mut report).value(expr);
        let value = value.map(|value| {
            let entries = value.entries().into_iter();
            let entries = entries.map(|edge| graph.as_rational(edge)).collect();
            (value, entries)
        });
        Found {
            inferred: inferred.map(|found| (found.shape.describe(), found.numbers)),
            refused: !inference.report.is_empty(),
            value,
            failed: !report.is_empty(),
        }
    }
}
