//! First pass of the expansion: copies statements for every round and part, and records what they declare.

use super::names::{Context, Expansion, Kind};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::visit::{Visit, places, visit};
use crate::syntax::ast::{Counter, Expr, Ident, Item, ItemKind, Repeat, Span, Target};
use crate::syntax::joint_endings;
use crate::syntax::path::{Step, steps};
use std::rc::Rc;

/// Largest number of statements and rounds of a description.
const MOST_STATEMENTS: usize = 10_000;

/// Largest number of rounds of one counter.
const MOST_ROUNDS: i64 = 1_000;

/// Copying stops after more errors than this.
const MOST_ERRORS: usize = 200;

impl<'a> Expansion<'a> {
    /// Copies the statements of a list, expands parts and repetitions in it, and records its constants.
    pub fn statements(&mut self, items: &'a [Item], context: &Context) {
        for item in items {
            if let ItemKind::Const(list) = &item.kind {
                for constant in list {
                    if let Some(value) = &constant.value {
                        let scope = &mut self.scopes[context.scope];
                        let constants = &mut scope.constants;
                        constants.insert(&constant.name.name, (value, context.clone()));
                    }
                }
            }
        }
        for item in items {
            if !self.grows(item.span.later(context.by)) {
                return;
            }
            match &item.kind {
                ItemKind::Component(_) => {}
                // An include that was not read has been reported before.
                ItemKind::Include(..) => {}
                ItemKind::Repeat(repeat) => self.repeat(repeat, item.span, context),
                ItemKind::Part(part) => self.part(part, item.span, context),
                _ => self.copy(item, context),
            }
        }
    }

    /// Counts one more statement or round. Returns whether there is room for it.
    pub fn grows(&mut self, span: Span) -> bool {
        self.size += 1;
        if self.size == MOST_STATEMENTS {
            let message =
                format!("the description has more than {MOST_STATEMENTS} statements here");
            let error = Diagnostic::new(span, message);
            self.report.push(error.help("shorten the ranges"));
        }
        self.size < MOST_STATEMENTS && self.report.len() < MOST_ERRORS
    }

    /// Evaluates the first and the last value of a counter.
    pub fn range(&mut self, counter: &Counter, context: &Context) -> Option<(i64, i64)> {
        let by = context.by;
        if context.counter(&counter.name.name).is_some() {
            let message = format!("`{}` is already a counter", counter.name.name);
            self.report.push_once(
                Diagnostic::new(counter.name.span.later(by), message)
                    .help("give the inner counter another name"),
            );
            return None;
        }
        let ends = [&counter.first, &counter.last].map(|end| {
            let value = self.integer(end, context, by);
            value.map_err(|error| self.report.push_once(error)).ok()
        });
        let [Some(first), Some(last)] = ends else {
            return None;
        };
        let span = counter.first.span.to(counter.last.span).later(by);
        let error = |message: String, help: String| Diagnostic::new(span, message).help(help);
        if last < first {
            let message = format!("the range from {first} to {last} is empty");
            let help = "write the smaller value first: `1..n`".to_owned();
            self.report.push_once(error(message, help));
            return None;
        }
        if last.saturating_sub(first) >= MOST_ROUNDS {
            let message = format!("the range from {first} to {last} is too large");
            let help = format!("a range has at most {MOST_ROUNDS} values");
            self.report.push_once(error(message, help));
            return None;
        }
        Some((first, last))
    }

    /// Returns a context in which a counter has a value.
    pub fn counted(&self, context: &Context, counter: &Counter, value: i64) -> Context {
        let mut counters = (*context.counters).clone();
        counters.push((counter.name.name.clone(), value));
        Context {
            counters: Rc::new(counters),
            ..context.clone()
        }
    }

    fn repeat(&mut self, repeat: &'a Repeat, span: Span, context: &Context) {
        let counter = &repeat.counter;
        let Some((first, last)) = self.range(counter, context) else {
            return;
        };
        for value in first..=last {
            if !self.grows(span.later(context.by)) {
                return;
            }
            let mut round = self.counted(context, counter, value);
            let by = counter.span().later(context.by);
            let label = format!("with {} = {value}", counter.name.name);
            round.by += self.origins.copy(span.later(context.by), by, label);
            self.statements(&repeat.items, &round);
        }
    }

    fn copy(&mut self, item: &Item, context: &Context) {
        let mut item = item.clone();
        visit(&mut item, &mut Later(context.by));
        let related = match &item.kind {
            ItemKind::Frame { name, .. } => self.is_parameter(name, context),
            _ => false,
        };
        if !related {
            let mut names = Vec::new();
            if let ItemKind::Joint(joint) = &item.kind {
                let (coordinates, velocities) = joint_endings(joint);
                let endings = coordinates.iter().chain(velocities);
                for ending in endings.filter(|ending| !ending.is_empty()) {
                    let Ident { name, span } = &joint.name;
                    names.push(Ident {
                        name: format!("{name}{ending}"),
                        span: *span,
                    });
                }
            }
            let mut declare = Declare {
                world: self,
                context,
                sound: true,
            };
            visit(&mut item, &mut declare);
            if declare.sound {
                for mut name in names {
                    self.declare(&mut name, Kind::Other, context);
                }
            }
        }
        self.pending.push((item, context.clone()));
    }

    /// Returns whether a name is that of a parameter of the enclosing component.
    pub fn is_parameter(&self, name: &Ident, context: &Context) -> bool {
        self.scopes[context.scope]
            .bindings
            .contains_key(name.name.as_str())
    }

    /// Declares frames that appear only after `on`, as in `frame known on new = P`.
    pub fn frames_after_on(&mut self) {
        for inside in [false, true] {
            let mut pending = std::mem::take(&mut self.pending);
            for (item, context) in &mut pending {
                let ItemKind::Frame { on: Some(on), .. } = &item.kind else {
                    continue;
                };
                let path = steps(on);
                let single = matches!(path.as_slice(), [Step::Name(_)]);
                let unknown = matches!(
                    self.find(&path, on.span, context),
                    Ok(super::names::Found::Unknown)
                );
                if single && unknown && on.name != "world" && (context.scope > 0) == inside {
                    let mut name = on.clone();
                    self.declare(&mut name, Kind::Frame, context);
                }
            }
            self.pending = pending;
        }
    }
}

/// Visitor that moves all places of a copy by an offset.
struct Later(usize);

impl Visit for Later {
    fn declares(&mut self, name: &mut Ident, _: bool) {
        self.uses(name);
    }

    fn uses(&mut self, name: &mut Ident) {
        self.place(&mut name.span);
    }

    fn target(&mut self, target: &mut Target) {
        self.uses(&mut target.name);
        target.field.iter_mut().for_each(|field| self.uses(field));
    }

    fn expr(&mut self, expr: &mut Expr) {
        moved(expr, self.0);
    }

    fn place(&mut self, span: &mut Span) {
        *span = span.later(self.0);
    }
}

/// Moves all places of an expression by an offset.
pub fn moved(expr: &mut Expr, by: usize) {
    if by > 0 {
        places(expr, &mut |span| *span = span.later(by));
    }
}

/// Visitor that registers what a statement declares.
struct Declare<'w, 'a> {
    world: &'w mut Expansion<'a>,
    context: &'w Context,
    /// Whether all names could be declared.
    sound: bool,
}

impl Visit for Declare<'_, '_> {
    fn declares(&mut self, name: &mut Ident, frame: bool) {
        let kind = if frame { Kind::Frame } else { Kind::Other };
        self.sound &= self.world.declare(name, kind, self.context);
    }

    fn uses(&mut self, _: &mut Ident) {}
    fn target(&mut self, _: &mut Target) {}
    fn expr(&mut self, _: &mut Expr) {}
    fn place(&mut self, _: &mut Span) {}
}
