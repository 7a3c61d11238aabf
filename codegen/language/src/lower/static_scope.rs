//! The motion-independent part of a description in a graph: its symbols, defaults, names, and both sides of
//! constraints.
//!
//! Every graph starts with this part. The first graph has symbols with independent values: there φ itself can be
//! seen, and points of X are found. The second has the values of such a point, so that expressions that are equal on
//! X are one node. The rest of a description is read only in the second.

use super::configuration_manifold::ConfigurationManifold;
use super::declare::{Declared, NextValue, declare};
use super::defaults;
use super::expression::Evaluator;
use super::names::Names;
use super::scope::Scope;
use crate::algebra::graph::Graph;
use crate::algebra::residue_pair::{Random, ResiduePair};
use crate::diagnostics::{Diagnostic, Report};
use crate::model::value::Value;
use crate::model::{class, samples};
use crate::symbols::Resolved;
use crate::syntax::ast::{ItemKind, Span, System};

/// A constraint that the user wrote.
pub struct Constraint {
    /// Index of its statement.
    pub item: usize,
    /// Range of both sides.
    pub span: Span,
    /// Left side minus right side; `None` if a side is in error.
    pub difference: Option<Value>,
    /// Errors in the sides.
    pub errors: Vec<Diagnostic>,
}

/// The motion-independent part of a description, in a graph.
pub struct StaticScope<'a> {
    pub graph: Graph,
    pub scope: Scope<'a>,
    pub declared: Declared,
    /// Values of all parameters' symbols; NaN where there is an error.
    pub defaults: Vec<f64>,
    /// Names whose values need no rates.
    pub names: Names,
    pub constraints: Vec<Constraint>,
}

impl<'a> StaticScope<'a> {
    /// Reads the description with independent values of all symbols.
    pub fn free(
        system: &'a System,
        names: &'a Resolved<'a>,
        seed: u64,
        report: &mut Report,
    ) -> Self {
        let own = seed ^ 0xf4ee;
        let mut random = Random::new(own);
        let mut next = |_: &mut Graph| random.element();
        let reals = |graph: &mut Graph| {
            graph.set_reals(samples::anywhere(graph.symbols().len(), seed));
        };
        let graph = Graph::new(class::PARAM);
        StaticScope::read(system, names, true, graph, &mut next, reals, report)
    }

    /// Reads the description at a point of X.
    pub fn on(
        manifold: &ConfigurationManifold,
        point: &[ResiduePair],
        system: &'a System,
        names: &'a Resolved<'a>,
        seed: u64,
        report: &mut Report,
    ) -> Self {
        let mut point = point.iter();
        let mut next = |_: &mut Graph| point.next().copied().unwrap_or(ResiduePair::ONE);
        let reals = |graph: &mut Graph| {
            let near = manifold.near.as_deref();
            graph.set_reals(samples::sample(&manifold.points, &manifold.phi, seed, near));
            graph.compare_samples(near.is_some() && manifold.complete);
        };
        let mut graph = Graph::new(class::PARAM);
        graph.set_roots(manifold.points.roots);
        StaticScope::read(system, names, false, graph, &mut next, reals, report)
    }

    fn read(
        system: &'a System,
        names: &'a Resolved<'a>,
        free: bool,
        mut graph: Graph,
        next: &mut NextValue,
        reals: impl FnOnce(&mut Graph),
        report: &mut Report,
    ) -> Self {
        let mut scope = Scope::new(system, &names.symbols, free);
        let declared = declare(system, &mut graph, next, &mut scope, report);
        reals(&mut graph);
        check_present(system, &declared, report);
        let defaults = defaults::read(system, &mut graph, &scope, &declared, report);
        let mut values = Names::default();
        values.read(&names.order.before, &mut graph, &mut scope, report);
        let constraints = constraints(system, &mut graph, &scope);
        StaticScope {
            graph,
            scope,
            declared,
            defaults,
            names: values,
            constraints,
        }
    }
}

/// Reports a system without coordinates or velocities.
fn check_present(system: &System, declared: &Declared, report: &mut Report) {
    let span = system.name.span;
    if declared.faulty {
        return;
    }
    if declared.coordinates.is_empty() {
        report.push(
            Diagnostic::new(span, "the system has no coordinates")
                .help("write `coord q;` or `coord R: SO3;`"),
        );
    }
    if declared.velocities.is_empty() {
        report.push(
            Diagnostic::new(span, "the system has no velocities")
                .help("write `velocity u;` or `velocity w: vec3;`"),
        );
    }
}

fn constraints(system: &System, graph: &mut Graph, scope: &Scope) -> Vec<Constraint> {
    let items = system.items.iter().enumerate();
    let written = items.filter_map(|(item, statement)| match &statement.kind {
        ItemKind::Constraint { left, right } => Some((item, left, right)),
        _ => None,
    });
    let read = |(item, left, right): (usize, &_, &_)| {
        let mut own = Report::new();
        let mut evaluator = Evaluator::new(graph, scope, &mut own);
        let sides = (evaluator.value(left), evaluator.value(right));
        let difference = match sides {
            (Some(a), Some(b)) if a.same_shape(&b) => Some(a.zip(&b, |x, y| graph.sub(x, y))),
            _ => None,
        };
        Constraint {
            item,
            span: left.span.to(right.span),
            difference,
            errors: own.finish().err().unwrap_or_default(),
        }
    };
    written.map(read).collect()
}
