//! Name lookup in all statements, in the order in which names become known.

use super::Resolved;
use super::check::Checker;
use super::order::{Order, Planner};
use super::table::{Kind, Symbols};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::visit::{Visit, visit};
use crate::syntax::ast::{
    Declaration, Expr, ExprKind, Ident, Item, ItemKind, Source, Span, System, Target, Wanted,
};
use crate::syntax::suggest::closest;
use crate::syntax::written;

/// Looks up the names in all statements. Returns the resolved names and the errors.
pub fn read<'a>(system: &'a System, symbols: Symbols<'a>) -> (Resolved<'a>, Vec<Diagnostic>) {
    let mut checker = Checker::new(system, symbols);
    let values = |checker: &mut Checker<'a>, list: &'a [Declaration]| {
        let values = list.iter().filter_map(|one| one.value.as_ref());
        values.for_each(|value| checker.expr(value));
    };
    for item in &system.items {
        if let ItemKind::Const(list) = &item.kind {
            for declaration in list {
                values(&mut checker, std::slice::from_ref(declaration));
                checker.open.remove(declaration.name.name.as_str());
            }
        }
    }
    for item in &system.items {
        if let ItemKind::Table(table) = &item.kind
            && let Source::Points(points, _) = &table.source
        {
            let numbers = points
                .iter()
                .flat_map(|(argument, value)| [argument, value]);
            numbers.for_each(|number| checker.expr(number));
        }
    }
    let Checker { open, symbols, .. } = &mut checker;
    open.retain(|name| matches!(symbols.kind(name), Some(Kind::Let | Kind::Frame)));
    for item in &system.items {
        if let ItemKind::Param(list) = &item.kind {
            values(&mut checker, list);
        }
    }
    let mut planner = Planner::new(system);
    planner.go_on(&mut checker);
    let before = std::mem::take(&mut planner.steps);
    let (early, late): (Vec<&Item>, Vec<&Item>) = system
        .items
        .iter()
        .partition(|item| precedes_rates(item, &checker.symbols));
    early.iter().for_each(|item| statement(item, &mut checker));
    planner.rates_are_known();
    planner.go_on(&mut checker);
    checker.open.clear();
    late.iter().for_each(|item| statement(item, &mut checker));
    checker.functions();
    let after = planner.steps;
    let errors = checker.report.finish().err().unwrap_or_default();
    let resolved = Resolved {
        symbols: checker.symbols,
        order: Order { before, after },
        used: checker.used,
    };
    (resolved, errors)
}

/// Returns whether a statement is processed before the rates of the coordinates are known.
fn precedes_rates(item: &Item, symbols: &Symbols) -> bool {
    match &item.kind {
        ItemKind::Constraint { .. }
        | ItemKind::Velocity(_)
        | ItemKind::Start { .. }
        | ItemKind::Guess { .. } => true,
        ItemKind::Rate { target, .. } => symbols.kind(&target.name.name) != Some(Kind::State),
        _ => false,
    }
}

/// Looks up the names in one statement, unless they were looked up when the statement became known.
fn statement(item: &Item, checker: &mut Checker) {
    match &item.kind {
        ItemKind::Param(_)
        | ItemKind::Const(_)
        | ItemKind::Let(_)
        | ItemKind::Function(_)
        | ItemKind::External(_)
        | ItemKind::Table(_)
        | ItemKind::Frame { .. } => {}
        // The motion of a joint has been expanded into other statements; the values in its braces have not.
        ItemKind::Joint(joint) => {
            // A frame that a joint moves is used by the joint.
            checker.used.insert(joint.moves.name.clone());
            let values = joint.fields.iter().flat_map(|(.., values)| values);
            values.for_each(|value| checker.expr(value));
        }
        ItemKind::Rate { target, value } => {
            checker.expr(value);
            rate(target, checker);
        }
        ItemKind::Start { target, value } | ItemKind::Guess { target, value } => {
            checker.expr(value);
            start(target, checker);
        }
        ItemKind::Prescribe {
            target,
            rate: of_velocity,
            value,
        } => {
            checker.expr(value);
            prescribed(target, *of_velocity, checker);
        }
        ItemKind::Generalized { target, value } => {
            checker.expr(value);
            let is_velocity = |kind| kind == Kind::Velocity;
            let Ident { name, span } = &target.name;
            if !checker.symbols.kind(name).is_some_and(is_velocity) {
                let error = checker.unknown(*span, name, Some("velocity"), is_velocity);
                checker.error(error);
            }
        }
        ItemKind::Load { from, .. } if from.as_ref().is_some_and(|name| name.name == "world") => {
            let mut item = item.clone();
            if let ItemKind::Load { from, .. } = &mut item.kind {
                *from = None;
            }
            others(item, false, checker);
        }
        ItemKind::Invariant { .. } => {
            let mut item = item.clone();
            if let ItemKind::Invariant { when, .. } = &mut item.kind {
                when.retain(|condition| settable(&condition.target, checker));
            }
            others(item, false, checker);
        }
        // The points that these act on may be fixed to the world.
        ItemKind::Push { .. }
        | ItemKind::Spring { .. }
        | ItemKind::Cable { .. }
        | ItemKind::Damper { .. }
        | ItemKind::Inerter { .. } => others(item.clone(), true, checker),
        ItemKind::Generate(all) => {
            for wanted in all {
                if let Wanted::Jacobian { frame, axes } = wanted {
                    jacobian(frame, axes.as_ref(), checker);
                }
            }
        }
        _ => others(item.clone(), false, checker),
    }
}

/// Looks up the expressions and frames of a statement. A frame may be the world if `world` is true.
fn others(mut item: Item, world: bool, checker: &mut Checker) {
    visit(&mut item, &mut Mentions { checker, world });
}

/// Visitor that looks up the names that a statement mentions.
struct Mentions<'c, 'a> {
    checker: &'c mut Checker<'a>,
    /// Whether a frame may be the world.
    world: bool,
}

impl Visit for Mentions<'_, '_> {
    fn declares(&mut self, _: &mut Ident, _: bool) {}

    fn uses(&mut self, name: &mut Ident) {
        self.checker.frame(name, self.world);
    }

    fn target(&mut self, _: &mut Target) {}

    fn expr(&mut self, expr: &mut Expr) {
        self.checker.expr(expr);
    }

    fn place(&mut self, _: &mut Span) {}
}

/// Checks the target of a `rate` statement: a coordinate or state.
fn rate(target: &Target, checker: &mut Checker) {
    let Ident { name, span } = &target.name;
    let is_coordinate = |kind| matches!(kind, Kind::Coord(_));
    let error = match checker.symbols.get(name) {
        Some(symbol) if is_coordinate(symbol.kind) || symbol.kind == Kind::State => return,
        Some(symbol) => {
            let kind = symbol.kind.describe();
            let message = format!("`{name}` is {kind} and has no rate");
            let error = Diagnostic::new(*span, message).note(symbol.span, "defined here");
            error.help("give the rate of a coordinate")
        }
        None => checker.unknown(*span, name, Some("coordinate"), is_coordinate),
    };
    checker.error(error);
}

/// Checks the target of a `start` statement: a coordinate or velocity.
fn start(target: &Target, checker: &mut Checker) {
    let Ident { name, span } = &target.name;
    let has_start = |kind| matches!(kind, Kind::Coord(_) | Kind::Velocity);
    let error = match checker.symbols.get(name) {
        Some(symbol) if has_start(symbol.kind) => return,
        Some(symbol) if symbol.kind == Kind::State => {
            let message = format!("the start of the state `{name}` belongs to its declaration");
            let error = Diagnostic::new(*span, message).note(symbol.span, "declared here");
            error.help(format!("write `state {name} = …;`"))
        }
        _ => checker.unknown(*span, name, Some("coordinate or velocity"), has_start),
    };
    checker.error(error);
}

/// Checks the target of a `prescribe` statement: a coordinate or velocity, or the rate of a velocity.
fn prescribed(target: &Target, of_velocity: bool, checker: &mut Checker) {
    let Ident { name, span } = &target.name;
    let symbol = checker.symbols.get(name).copied();
    match symbol.map(|symbol| (symbol.kind, symbol.span)) {
        Some((Kind::Velocity, _)) if target.field.is_none() => {}
        _ if of_velocity => {
            let message = format!("`{}` is not a velocity", written::target(target));
            checker.error(
                Diagnostic::new(target.span(), message).help(
                    "only the rate of a velocity can be prescribed: `prescribe rate(v) = a;`",
                ),
            );
        }
        Some((Kind::State, declared)) => {
            let message = format!("`{name}` is a state: its motion follows from its rate");
            let error = Diagnostic::new(*span, message).note(declared, "declared here");
            checker.error(error.help(format!("write `rate {name} = …;`")));
        }
        _ => rate(target, checker),
    }
}

/// Returns whether the condition of an invariant can set this: an input or a parameter. Reports an error otherwise.
fn settable(target: &Expr, checker: &mut Checker) -> bool {
    let (name, span) = match &target.kind {
        ExprKind::Name(name) => (name, target.span),
        ExprKind::Index(base, _) => match &base.kind {
            ExprKind::Name(name) => (name, base.span),
            _ => return true,
        },
        _ => return true,
    };
    let error = match checker.symbols.get(name) {
        Some(symbol) if symbol.kind.is_settable() => return true,
        Some(symbol) => {
            let message = format!(
                "`{name}` is {}, but a claim can set only inputs and parameters",
                symbol.kind.describe()
            );
            Diagnostic::new(span, message)
                .help("what holds only at some states is not an invariant of the motion")
                .note(symbol.span, "defined here")
        }
        None => checker.unknown(span, name, Some("input or parameter"), Kind::is_settable),
    };
    checker.error(error);
    false
}

/// Checks `jacobian f in f`: the frame, and the axes, which must be those of the frame or of the world.
fn jacobian(frame: &Ident, axes: Option<&Ident>, checker: &mut Checker) {
    let Ident { name, span } = frame;
    checker.used.insert(name.clone());
    if checker.symbols.kind(name) != Some(Kind::Frame) {
        let message = match name.as_str() {
            "world" => "the world does not move".into(),
            name => format!("no frame is called `{name}`"),
        };
        let frames = checker.symbols.iter();
        let frames = frames.filter(|(_, symbol)| symbol.kind == Kind::Frame);
        let near = closest(name, frames.map(|(name, _)| name));
        let error = Diagnostic::new(*span, message);
        checker.error(match near {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(
                "`jacobian f` is the kinematics of a frame f that is declared by `frame` or by `moves` of a joint",
            ),
        });
    }
    let known = |axes: &Ident| axes.name == *name || matches!(axes.name.as_str(), "body" | "world");
    if let Some(axes) = axes.filter(|axes| !known(axes)) {
        let message = format!("components can be only in axes of `world` or of `{name}`");
        let help = format!("write `jacobian {name} in world` or `jacobian {name} in {name}`");
        checker.error(Diagnostic::new(axes.span, message).help(help));
    }
}
