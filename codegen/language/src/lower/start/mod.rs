//! Reads the start: values of x and ξ that satisfy the constraints.

pub mod check;
pub mod guess;

use crate::algebra::graph::{Edge, Function, Graph};
use crate::algebra::numeric::evaluate;
use crate::diagnostics::{Diagnostic, Report, rough};
use crate::lower::declare::Declared;
use crate::lower::expression::Evaluator;
use crate::lower::rate::{entry, part};
use crate::lower::scope::Scope;
use crate::lower::states::States;
use crate::model::class;
use crate::model::complete::{Mass, Refused};
use crate::model::initial_conditions::{Formulas, InitialConditions};
use crate::model::layout::{blocks, identity};
use crate::model::loop_closure::{LoopClosure, Open};
use crate::model::pfaffian::{Kind, Pfaffian};
use crate::model::value::Value;
use crate::syntax::ast::{CoordKind, Expr, ItemKind, Span, System, Target};
use crate::syntax::written::target as written;
use std::sync::Arc;

/// Values of x and ξ so far, and where each entry was given or guessed.
pub struct Start {
    pub x: Vec<f64>,
    pub xi: Vec<f64>,
    pub given_x: Vec<Option<Span>>,
    pub given_xi: Vec<Option<Span>>,
    guessed_x: Vec<Option<Span>>,
    guessed_xi: Vec<Option<Span>>,
    /// Entries of x that depend on parameters.
    formulas_x: Vec<(usize, Edge)>,
    /// Entries of ξ that depend on parameters.
    formulas_xi: Vec<(usize, Edge)>,
}

/// Reads x and ξ from the `start` statements; entries that are not given are at the identity and at rest.
pub fn read(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    defaults: &[f64],
    report: &mut Report,
) -> Option<Start> {
    let kinds = declared
        .coordinates
        .iter()
        .map(|coordinate| coordinate.kind);
    let x: Vec<f64> = kinds.flat_map(blocks).flat_map(identity).collect();
    let xi = vec![0.0; declared.xi.len()];
    let (no_x, no_xi) = (vec![None; x.len()], vec![None; xi.len()]);
    let mut start = Start {
        formulas_x: Vec::new(),
        formulas_xi: Vec::new(),
        x,
        xi,
        given_x: no_x.clone(),
        given_xi: no_xi.clone(),
        guessed_x: no_x,
        guessed_xi: no_xi,
    };
    let symbols = known(graph, defaults);
    let mut complete = true;
    for item in &system.items {
        let (target, value, guess) = match &item.kind {
            ItemKind::Start { target, value } => (target, value, false),
            ItemKind::Guess { target, value } => (target, value, true),
            _ => continue,
        };
        let evaluator = Evaluator::new(graph, scope, report);
        complete &= start
            .read((target, guess), value, evaluator, declared, &symbols)
            .is_some();
    }
    complete.then_some(start)
}

impl Start {
    /// Returns the start as it is given, before the rest is computed.
    pub fn initial_conditions(&self, graph: &Graph, states: &States) -> InitialConditions {
        let is_there =
            |list: &[Option<Span>]| -> Vec<bool> { list.iter().map(Option::is_some).collect() };
        let lists = [&self.formulas_x, &self.formulas_xi, &states.formulas];
        let varies = lists.iter().any(|list| !list.is_empty());
        InitialConditions {
            x: self.x.clone(),
            xi: self.xi.clone(),
            z: states.start.clone(),
            exact_x: is_there(&self.given_x),
            exact_xi: is_there(&self.given_xi),
            guessed_x: is_there(&self.guessed_x),
            guessed_xi: is_there(&self.guessed_xi),
            formulas: varies.then(|| {
                let [x, xi, z] = lists.map(Clone::clone);
                let graph = graph.clone();
                Arc::new(Formulas { graph, x, xi, z })
            }),
        }
    }

    /// Solves for the values that the description does not give, so that loops are closed and constraints satisfied.
    ///
    /// # Errors
    /// Returns an error about the constraint that cannot be satisfied.
    pub fn complete(
        &mut self,
        mut initial: InitialConditions,
        closure: &LoopClosure,
        (constraints, prescribed): (&[Pfaffian], &[(usize, Edge)]),
        mass: Mass,
    ) -> Result<(), Diagnostic> {
        let refused = match initial.complete(closure, prescribed, mass) {
            Ok(()) => {
                (self.x, self.xi) = (initial.x, initial.xi);
                return Ok(());
            }
            Err(refused) => refused,
        };
        let open = match refused {
            Refused::Configuration(open) => open,
            Refused::Velocities(open) => {
                let given = closure.any_speed(&initial.exact_xi);
                return Err(violated(constraints, open, given));
            }
        };
        let row = &constraints[open.constraint];
        let by = rough(open.residual);
        let (message, help) = match row.kind {
            Kind::Drive { .. } => (
                format!("the start differs from this motion by {by}"),
                "remove the `start` of what is prescribed: it follows from the motion",
            ),
            _ if initial.guesses_coordinates() => (
                format!(
                    "no configuration near the guesses closes this loop, which is open by {by} there"
                ),
                "check the lengths, and turn exact starts that need not be kept into guesses, `start q ~ 1.2;`",
            ),
            _ => (
                format!(
                    "no configuration near the start closes this loop, which is open by {by} there"
                ),
                "give a `start` closer to a closed loop; coordinates without a `start` are solved for, those with one are kept",
            ),
        };
        Err(Diagnostic::new(row.span, message).help(help))
    }

    /// Returns whether coordinates are guessed.
    pub fn guesses_coordinates(&self) -> bool {
        self.guessed_x.iter().any(Option::is_some)
    }

    fn read(
        &mut self,
        (target, guess): (&Target, bool),
        expr: &Expr,
        mut evaluator: Evaluator,
        declared: &Declared,
        symbols: &[f64],
    ) -> Option<()> {
        let name = &target.name.name;
        let value = evaluator.value(expr);
        let (range, wanted, of_x) = place(target, declared)?;
        let mut value = value?;
        let is_circle =
            |c: &&crate::model::Coordinate| c.kind == CoordKind::S1 && c.offset == range.start;
        if let Value::Scalar(angle) = value
            && of_x
            && range.len() == 2
            && declared.coordinates.iter().any(|c| is_circle(&c))
        {
            let graph = &mut *evaluator.graph;
            let (c, s) = (
                graph.apply(Function::Cos, angle),
                graph.apply(Function::Sin, angle),
            );
            value = Value::Vector(vec![c, s]);
        }
        if !value.same_shape(&wanted) {
            return evaluator.miss();
        }
        let numbers = numbers(&mut evaluator, &value, name, expr.span, symbols)?;
        let graph = &*evaluator.graph;
        let places = range.clone().zip(value.entries());
        let varying: Vec<(usize, Edge)> = places
            .filter(|(_, edge)| graph.class(edge.node()) != 0)
            .collect();
        let (into, given, guessed, formulas) = if of_x {
            (
                &mut self.x,
                &mut self.given_x,
                &mut self.guessed_x,
                &mut self.formulas_x,
            )
        } else {
            (
                &mut self.xi,
                &mut self.given_xi,
                &mut self.guessed_xi,
                &mut self.formulas_xi,
            )
        };
        let first = |list: &[Option<Span>]| list[range.clone()].iter().flatten().next().copied();
        if let Some((span, exact)) = first(given)
            .map(|span| (span, true))
            .or(first(guessed).map(|span| (span, false)))
        {
            let written = written(target);
            let (message, help) = match (exact, guess) {
                (true, false) => (
                    format!("the start of `{written}` is given twice"),
                    "remove one of the two",
                ),
                (false, true) => (
                    format!("the start of `{written}` is guessed twice"),
                    "remove one of the two",
                ),
                _ => (
                    format!("`{written}` has an exact start and a guess"),
                    "remove the guess to keep the exact start, or remove the exact start to use the guess",
                ),
            };
            let error = Diagnostic::new(target.span(), message).help(help);
            return evaluator.error(error.note(span, "first given here"));
        }
        let known = if guess { guessed } else { given };
        formulas.extend(varying);
        known[range.clone()].fill(Some(target.span()));
        into[range].copy_from_slice(&numbers);
        Some(())
    }
}

/// Evaluates an initial value, given the values of all symbols, which are NaN if unknown.
pub fn numbers(
    evaluator: &mut Evaluator,
    value: &Value,
    name: &str,
    span: Span,
    symbols: &[f64],
) -> Option<Vec<f64>> {
    let entries = value.entries();
    let class = entries
        .iter()
        .fold(0, |class, e| class | evaluator.graph.class(e.node()));
    if class & !class::PARAM != 0 {
        return evaluator.error(
            Diagnostic::new(span, format!("the start of `{name}` is not a number"))
                .help("a start is made of numbers, constants and parameters"),
        );
    }
    let params = symbols.iter().zip(evaluator.graph.symbols());
    let unknown =
        |(n, s): (&f64, &crate::algebra::graph::Symbol)| s.class == class::PARAM && n.is_nan();
    if class != 0 && params.into_iter().any(unknown) {
        // A default is in error, so the start is unknown.
        return None;
    }
    let numbers = evaluate(evaluator.graph, &entries, symbols);
    if numbers.iter().any(|number| !number.is_finite()) {
        return evaluator.error(
            Diagnostic::new(span, format!("the start of `{name}` is not finite"))
                .help("write numbers that floating point can hold"),
        );
    }
    Some(numbers)
}

/// Returns the values of all symbols that are known before the start: π and the parameters. The others are NaN.
pub fn known(graph: &Graph, defaults: &[f64]) -> Vec<f64> {
    let mut symbols = vec![std::f64::consts::PI];
    symbols.extend_from_slice(defaults);
    symbols.resize(graph.symbols().len(), f64::NAN);
    symbols
}

/// Returns the error for start velocities that contradict a constraint; `given` tells whether any of them was given.
fn violated(constraints: &[Pfaffian], open: Open, given: bool) -> Diagnostic {
    if !given {
        let message = format!(
            "no velocities at the start satisfy this constraint together with the others: it is violated by {}",
            rough(open.residual)
        );
        return Diagnostic::new(constraints[open.constraint].span, message).help(
            "remove a constraint or a prescribed motion; if rows depend on one another only at the start, start elsewhere",
        );
    }
    let message = format!(
        "the start velocities violate this constraint by {}",
        rough(open.residual)
    );
    Diagnostic::new(constraints[open.constraint].span, message)
        .help("remove the `start` of velocities that follow from the others: they are solved for")
}

/// Returns the entries of x or ξ that a start is about, their value, and whether they belong to x.
fn place(target: &Target, declared: &Declared) -> Option<(std::ops::Range<usize>, Value, bool)> {
    let name = &target.name.name;
    let Some(group) = declared.velocities.iter().find(|group| group.name == *name) else {
        let (range, wanted) = part(target, declared)?;
        return Some((range, wanted, true));
    };
    let range = group.offset..group.offset + group.len;
    let (range, value) = entry(target, range, group.value.clone());
    target.field.is_none().then_some((range, value, false))
}

impl Declared {
    /// Returns the values of all symbols at the start, with inputs and accelerations 0; NaN where they are unknown.
    pub fn numbers(&self, defaults: &[f64], start: Option<&Start>) -> Vec<f64> {
        let mut numbers = vec![std::f64::consts::PI];
        numbers.extend_from_slice(defaults);
        match start {
            Some(start) => numbers.extend(start.x.iter().chain(&start.xi)),
            None => numbers.resize(numbers.len() + self.x.len() + self.xi.len(), f64::NAN),
        }
        numbers.resize(numbers.len() + self.u.len() + self.xi_dot.len(), 0.0);
        numbers
    }
}
