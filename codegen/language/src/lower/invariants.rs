//! Reads claims that something is constant along the motion, as far as possible without derivation.

use super::declare::Declared;
use super::expression::Evaluator;
use super::reader::{Reader, is_taken};
use super::scope::Scope;
use crate::algebra::graph::{Edge, Graph, Node};
use crate::algebra::linear::Vec3;
use crate::diagnostics::{Diagnostic, Report};
use crate::model::invariants::{Invariant, Quantity};
use crate::model::value::Value;
use crate::model::{Frame, class};
use crate::symbols::Kind;
use crate::syntax::ast::{Condition, Conserved, Expr, ExprKind, Ident, ItemKind, Span, System};
use crate::syntax::written;

/// Returns the names of all invariants, except for the energy, which has a function anyway.
pub fn names(system: &System) -> Vec<&Ident> {
    let mut names = Vec::new();
    for item in &system.items {
        if let ItemKind::Invariant {
            name, conserved, ..
        } = &item.kind
            && !is_energy(name, conserved)
        {
            names.push(name);
        }
    }
    names
}

fn is_energy(name: &Ident, conserved: &Conserved) -> bool {
    name.name == "energy" && matches!(conserved, Conserved::Energy)
}

/// Reads all claims.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    frames: &[Frame],
    declared: &Declared,
    report: &mut Report,
) -> Vec<Invariant> {
    check_names(system, report);
    let kinetic = system.items.iter().find_map(|item| match item.kind {
        ItemKind::Kinetic(_) => Some(item.span),
        _ => None,
    });
    let mut all = Vec::new();
    for item in &system.items {
        let ItemKind::Invariant {
            name,
            conserved,
            when,
        } = &item.kind
        else {
            continue;
        };
        let evaluator = Evaluator::new(graph, scope, report);
        let mut reader = Reader {
            evaluator,
            frames,
            declared,
        };
        let quantity = reader.quantity(conserved, item.span, kinetic);
        let set = reader.conditions(when);
        if let (Some(quantity), Some(set)) = (quantity, set) {
            all.push(Invariant {
                name: name.name.clone(),
                span: item.span,
                quantity,
                set,
                when: written::conditions(when),
            });
        }
    }
    all
}

/// Reports names that are taken: every invariant becomes a function.
fn check_names(system: &System, report: &mut Report) {
    let outputs = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Output { name, .. } => Some(name),
        _ => None,
    });
    let mut taken: Vec<&Ident> = outputs.collect();
    for name in names(system) {
        let first = taken.iter().find(|known| known.name == name.name);
        if first.is_some() || is_taken(&name.name) {
            let message = format!("there is already a function `{}`", name.name);
            let error = Diagnostic::new(name.span, message).help(format!(
                "give this invariant another name: `invariant {}_1 = …;`",
                name.name
            ));
            report.push(match first {
                Some(first) => error.note(first.span, "first given here"),
                None => error,
            });
        }
        taken.push(name);
    }
}

impl Reader<'_, '_> {
    fn quantity(
        &mut self,
        conserved: &Conserved,
        span: Span,
        kinetic: Option<Span>,
    ) -> Option<Quantity> {
        match conserved {
            Conserved::Energy => Some(Quantity::Energy),
            Conserved::LinearMomentum { of, along } => {
                let of = self.bodies(of.as_ref(), span, kinetic)?;
                let along = self.direction(along.as_ref())?;
                Some(Quantity::LinearMomentum { of, along })
            }
            Conserved::AngularMomentum { of, about, along } => {
                let of = self.bodies(of.as_ref(), span, kinetic)?;
                let about = match about {
                    Some(point) => self.place(point, "the point of an angular momentum")?,
                    None => [self.evaluator.graph.zero(); 3],
                };
                let along = self.direction(along.as_ref())?;
                Some(Quantity::AngularMomentum { of, about, along })
            }
            Conserved::Value(expr) => {
                let value = self.evaluator.value(expr)?;
                let class = self.class_of(&value);
                if class & (class::INPUT | class::ACCEL) != 0 {
                    let message =
                        "an invariant may depend only on coordinates, velocities and parameters";
                    return self
                        .evaluator
                        .error(Diagnostic::new(expr.span, message).help(
                        "inputs are free functions of time; set them after `when`: `when F = 0`; states move by their own rates",
                    ));
                }
                self.evaluator
                    .continuous(&value, expr.span, "an invariant")?;
                if class & (class::CONFIGURATION | class::VELOCITY) == 0 {
                    let message = "this is constant for every motion, so there is nothing to prove";
                    return self.evaluator.error(
                        Diagnostic::new(expr.span, message)
                            .help("an invariant depends on coordinates or velocities"),
                    );
                }
                Some(Quantity::Value(value))
            }
        }
    }

    /// Finds the frame whose momentum is meant; `kinetic` is a statement whose masses have unknown places.
    fn bodies(
        &mut self,
        of: Option<&Ident>,
        span: Span,
        kinetic: Option<Span>,
    ) -> Option<Option<usize>> {
        if let Some(name) = of {
            return self.frame(name).map(Some);
        }
        match kinetic {
            None => Some(None),
            Some(kinetic) => self.evaluator.error(
                Diagnostic::new(span, "the momentum of a `kinetic` statement is not known: it does not give the positions of its masses")
                    .help("write the momentum as an expression: `invariant p = m * v;`, or describe the masses by `particle` and `body`")
                    .note(kinetic, "this energy has masses without positions"),
            ),
        }
    }

    fn direction(&mut self, along: Option<&Expr>) -> Option<Option<Vec3>> {
        match along {
            Some(along) => self.place(along, "the direction of a momentum").map(Some),
            None => Some(None),
        }
    }

    /// Reads a vector in world axes that depends at most on the configuration.
    fn place(&mut self, expr: &Expr, what: &str) -> Option<Vec3> {
        let value = self.evaluator.vec3(expr)?;
        let help = "give it in world axes; an axis fixed in a body is `R * [0, 0, 1]`";
        self.configuration(&Value::Vector(value.to_vec()), expr.span, what, help)?;
        Some(value)
    }

    /// Returns the symbols that the conditions set, with their values.
    fn conditions(&mut self, when: &[Condition]) -> Option<Vec<(usize, Edge)>> {
        let mut set: Vec<(usize, Edge)> = Vec::new();
        let mut complete = true;
        for condition in when {
            match self.condition(condition) {
                Some(more) => {
                    if more.iter().any(|(s, _)| set.iter().any(|(t, _)| s == t)) {
                        complete = false;
                        let error = Diagnostic::new(condition.target.span, "this is set twice");
                        self.evaluator
                            .report
                            .push(error.help("remove one of the two"));
                    }
                    set.extend(more);
                }
                None => complete = false,
            }
        }
        if !complete {
            return None;
        }
        for condition in when {
            let value = self.evaluator.value(&condition.value)?;
            let graph = &self.evaluator.graph;
            let used = graph.reachable(&value.entries());
            let of_set = |id: &u32| matches!(graph.node(*id), Node::Symbol(s) if set.iter().any(|(t, _)| *t == s as usize));
            if used.iter().any(of_set) {
                let message = "the value of a condition depends on something that the claim sets";
                return self.evaluator.error(
                    Diagnostic::new(condition.value.span, message)
                        .help("give values in terms of the parameters that are not set"),
                );
            }
        }
        Some(set)
    }

    fn condition(&mut self, condition: &Condition) -> Option<Vec<(usize, Edge)>> {
        let set = match &condition.target.kind {
            ExprKind::Index(base, _) => &base.kind,
            name => name,
        };
        let symbols = self.evaluator.scope.symbols;
        match set {
            ExprKind::Name(name) if symbols.kind(name).is_some_and(Kind::is_settable) => {}
            // Reported already.
            _ => return None,
        }
        let (target, value) = (
            self.evaluator.value(&condition.target),
            self.evaluator.value(&condition.value),
        );
        let (target, value) = (target?, value?);
        self.constant(&value, condition.value.span, "the value of a condition")?;
        let symbols = target.entries();
        let zero = self.evaluator.graph.zero();
        // `F = 0` sets every entry.
        let values = match &value {
            Value::Scalar(edge) if *edge == zero => vec![zero; symbols.len()],
            value if value.same_shape(&target) => value.entries(),
            _ => return None,
        };
        let graph = &self.evaluator.graph;
        let mut set: Vec<(usize, Edge)> = Vec::new();
        for (symbol, value) in symbols.into_iter().zip(values) {
            if let Node::Symbol(index) = graph.node(symbol.node()) {
                let index = index as usize;
                match set.iter().find(|(known, _)| *known == index) {
                    // Both halves of a symmetric matrix are the same symbols.
                    Some((_, known)) if *known == value => {}
                    Some(_) => {
                        let message = "the value of a symmetric matrix is not symmetric";
                        return self.evaluator.error(
                            Diagnostic::new(condition.value.span, message)
                                .help("write the same value in both places"),
                        );
                    }
                    None => set.push((index, value)),
                }
            }
        }
        Some(set)
    }
}
