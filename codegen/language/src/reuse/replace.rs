//! Second pass of the expansion: replaces names as written by their final names, counters by numbers, and parameters of
//! components by their arguments.

use super::copies::moved;
use super::names::{Binding, Context, Expansion, Found, Kind};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::visit::{Visit, parts, visit};
use crate::syntax::ast::{Expr, ExprKind, Ident, Item, ItemKind, Span, Target};
use crate::syntax::path::{Step, of_expression, steps};
use num_rational::BigRational;
use std::collections::{BTreeMap, BTreeSet};

/// Largest depth of an expression with arguments substituted, equal to that of a single parsed expression.
const MOST_LEVELS: usize = 600;

/// Largest total number of operations of all substituted arguments.
const MOST_WRITTEN: usize = 250_000;

/// Replacement stops after more errors than this.
const MOST_ERRORS: usize = 200;

/// Replaces the names in all statements by their final names.
pub fn replace(world: &mut Expansion<'_>, pending: Vec<(Item, Context)>) -> Vec<Item> {
    let mut report = Report::new();
    let mut known = Known::default();
    check_arguments(world, &mut known, &mut report);
    let mut items = Vec::with_capacity(pending.len());
    for (mut item, context) in pending {
        if report.len() > MOST_ERRORS {
            break;
        }
        let mut replacing = Replacing {
            world,
            context: &context,
            report: &mut report,
            known: &mut known,
            locals: BTreeSet::new(),
            level: 0,
        };
        if let ItemKind::Function(function) = &item.kind {
            let names = function
                .parameters
                .iter()
                .map(|(name, _)| name.name.clone());
            replacing.locals = names.collect();
        }
        if let ItemKind::External(function) = &item.kind {
            let names = function.parameters.iter().map(|name| name.name.clone());
            replacing.locals = names.collect();
        }
        if let ItemKind::Frame { name, .. } = &mut item.kind
            && world.is_parameter(name, &context)
        {
            replacing.uses(name);
        }
        visit(&mut item, &mut replacing);
        items.push(item);
    }
    for error in report.finish().err().unwrap_or_default() {
        world.report.push_once(error);
    }
    items
}

/// An argument with its depth and its size.
type Written = (Expr, usize, usize);

/// Arguments after replacement, each computed once.
#[derive(Default)]
struct Known {
    /// By scope and parameter: the expression with its depth and size, or `None` if it is in error.
    arguments: BTreeMap<(usize, String), Option<Written>>,
    /// Total size of the substituted arguments so far, and whether it exceeds the limit.
    written: usize,
    full: bool,
}

/// Replaces names in every argument once, even if its parameter is not used, to find errors.
fn check_arguments(world: &Expansion<'_>, known: &mut Known, report: &mut Report) {
    for scope in 0..world.scopes.len() {
        for (name, binding) in &world.scopes[scope].bindings {
            let mut replacing = Replacing {
                world,
                context: &binding.context,
                report,
                known,
                locals: BTreeSet::new(),
                level: 0,
            };
            replacing.argument(scope, name, binding);
        }
    }
}

struct Replacing<'w, 'a> {
    world: &'w Expansion<'a>,
    context: &'w Context,
    report: &'w mut Report,
    known: &'w mut Known,
    /// Parameters of the function whose body this is.
    locals: BTreeSet<String>,
    /// Depth of the current expression within its statement.
    level: usize,
}

impl Visit for Replacing<'_, '_> {
    fn declares(&mut self, _: &mut Ident, _: bool) {}

    fn uses(&mut self, name: &mut Ident) {
        let path = steps(name);
        match self.named(&path, name.span) {
            Ok(None) => {}
            Ok(Some((found, taken))) if taken == path.len() => name.name = found,
            Ok(Some((_, taken))) => {
                let error = no_more(&path, taken, name.span);
                self.report.push_once(error);
            }
            Err(error) => self.report.push_once(error),
        }
    }

    fn target(&mut self, target: &mut Target) {
        let whole = Ident {
            name: match &target.field {
                Some(field) => format!("{}.{}", target.name.name, field.name),
                None => target.name.name.clone(),
            },
            span: target.name.span,
        };
        let path = steps(&whole);
        match (self.named(&path, whole.span), target.field.is_some()) {
            (Ok(None), _) => {}
            (Ok(Some((found, taken))), true) if taken + 1 == path.len() => {
                target.name.name = found;
                let last = target.field.as_ref().map(|field| field.span);
                // The span of the name ends before the field.
                target.name.span = before(target.name.span, last);
            }
            (Ok(Some((found, taken))), _) if taken == path.len() => {
                target.name.name = found;
                target.field = None;
            }
            (Ok(Some((found, taken))), _) => {
                let (field, list) = match &path[taken..] {
                    [Step::Index(list)] => (None, list),
                    [Step::Name(field), Step::Index(list)] => (Some(field), list),
                    _ => {
                        let error = no_more(&path, taken, whole.span);
                        return self.report.push_once(error);
                    }
                };
                match self.world.indices(list, self.context) {
                    Ok(indices) => {
                        target.entry = indices;
                        target.name.name = found;
                        target.field = field.map(|field| Ident {
                            name: field.clone(),
                            span: whole.span,
                        });
                    }
                    Err(error) => self.report.push_once(error),
                }
            }
            (Err(error), _) => self.report.push_once(error),
        }
    }

    fn expr(&mut self, expr: &mut Expr) {
        self.level += 1;
        self.replaced(expr);
        self.level -= 1;
    }

    fn place(&mut self, _: &mut Span) {}
}

/// Returns a region without its last word and the dot before it, if the word is within the region.
fn before(span: Span, last: Option<Span>) -> Span {
    let ends = span.range().zip(last.and_then(Span::range));
    match ends {
        Some((whole, last)) if whole.start + 1 < last.start => {
            Span::new(whole.start..last.start - 1)
        }
        _ => span,
    }
}

/// Returns the error for indices or parts that follow a complete name.
fn no_more(path: &[Step], taken: usize, span: Span) -> Diagnostic {
    let name = match path.first() {
        Some(Step::Name(name)) => name.as_str(),
        _ => "",
    };
    match path.get(taken) {
        Some(Step::Name(part)) => Diagnostic::new(
            span,
            format!("this name cannot be continued by `.{part}`"),
        )
        .help("only parts of components contain names: `left.knee`"),
        _ => Diagnostic::new(span, format!("`{name}` is not an array"))
            .help("declare an array with its index, as in `frame link[0] = world;`; write an entry of a call in other axes as `(velocity(f) in g)[1]`"),
    }
}

impl<'w, 'a> Replacing<'w, 'a> {
    /// Resolves the steps of a name. Returns the final name and the number of steps that it covers, or `None` if the
    /// name is not declared here.
    fn named(&mut self, path: &[Step], span: Span) -> Result<Option<(String, usize)>, Diagnostic> {
        let shown = || match path.first() {
            Some(Step::Name(name)) => name.clone(),
            _ => String::new(),
        };
        match self.world.find(path, span, self.context)? {
            Found::Unknown if path.len() == 1 => Ok(None),
            Found::Unknown => match path.get(1) {
                // An unknown name with one part, such as `q.c`, is reported later as an unknown coordinate.
                Some(Step::Name(_)) if path.len() == 2 => Ok(None),
                _ => {
                    let error = Diagnostic::new(span, format!("unknown name `{}`", shown()));
                    Err(error.help("declare it, or check its spelling"))
                }
            },
            Found::Number(value) => {
                let message = format!("`{}` is the number {value} here, not a name", shown());
                Err(Diagnostic::new(span, message)
                    .help("write a name with the counter as its index: `link[i]`"))
            }
            Found::Parameter(scope, name, binding) => {
                self.world.mention(scope, name);
                if !binding.frame {
                    let message = format!("`{name}` is an expression here, not a name");
                    return Err(Diagnostic::new(span, message)
                        .help(format!("declare it as a frame: `{name}: frame`")));
                }
                let argument = self.argument(scope, name, binding);
                Ok(argument.and_then(|(expr, ..)| match expr.kind {
                    ExprKind::Name(name) => Some((name, 1)),
                    _ => None,
                }))
            }
            Found::Thing(thing, taken) => match thing.kind {
                Kind::Part(scope) => Err(self.is_part(scope, span)),
                _ => Ok(Some((thing.name.clone(), taken))),
            },
        }
    }

    fn is_part(&self, scope: usize, span: Span) -> Diagnostic {
        let part = self.world.scopes[scope].written.trim_end_matches('.');
        Diagnostic::new(span, format!("`{part}` is a part")).help(self.world.parts_of(scope))
    }

    /// Returns the argument that a parameter stands for, with its depth and size.
    fn argument(
        &mut self,
        scope: usize,
        name: &str,
        binding: &Binding<'a>,
    ) -> Option<(Expr, usize, usize)> {
        let key = (scope, name.to_owned());
        if let Some(known) = self.known.arguments.get(&key) {
            return known.clone();
        }
        // An argument that refers to itself finds this entry, and has no value.
        self.known.arguments.insert(key.clone(), None);
        let mut expr = binding.value.clone();
        moved(&mut expr, binding.context.by);
        let mut inner = Replacing {
            world: self.world,
            context: &binding.context,
            report: self.report,
            known: self.known,
            locals: BTreeSet::new(),
            level: 0,
        };
        let sound = match binding.frame {
            true => inner.frame(&mut expr, name),
            false => {
                let before = inner.report.len();
                inner.expr(&mut expr);
                inner.report.len() == before
            }
        };
        let (depth, size) = measure(&mut expr);
        let found = sound.then_some((expr, depth, size));
        self.known.arguments.insert(key, found.clone());
        found
    }

    /// Replaces an expression that has to name a frame. Returns whether it does.
    fn frame(&mut self, expr: &mut Expr, parameter: &str) -> bool {
        let wrong = |span: Span, what: String| {
            Diagnostic::new(span, format!("`{parameter}` has to be a frame, but {what}"))
                .help("give the name of a frame, as in `mount[2]` or `left.foot`; declare a place on a frame as another `frame`")
        };
        let Some(mut name) = of_expression(expr) else {
            let error = wrong(expr.span, "this is an expression".into());
            self.report.push_once(error);
            return false;
        };
        let path = steps(&name);
        let found = self.world.find(&path, name.span, self.context);
        if let Ok(Found::Thing(thing, taken)) = &found {
            let frame = thing.kind == Kind::Frame && *taken == path.len();
            if !frame && !matches!(thing.kind, Kind::Part(_)) {
                let error = wrong(name.span, format!("`{}` is not one", name.name));
                self.report
                    .push_once(error.note(thing.span, "declared here"));
                return false;
            }
        }
        if let (Ok(Found::Unknown), true) = (&found, name.name != "world") {
            let error = Diagnostic::new(name.span, format!("unknown frame `{}`", name.name));
            let error = error.help("declare it with `frame` or `moves`, or check its spelling");
            self.report.push_once(error);
            return false;
        }
        let before = self.report.len();
        self.uses(&mut name);
        expr.kind = ExprKind::Name(name.name);
        self.report.len() == before
    }

    fn replaced(&mut self, expr: &mut Expr) {
        let Some(path) = spine(expr) else {
            if let ExprKind::Call(function, _) = &mut expr.kind
                && !self.locals.contains(&function.name)
            {
                self.called(function);
            }
            parts(expr).into_iter().for_each(|part| self.expr(part));
            return;
        };
        let local = matches!(path.first(), Some(Step::Name(name)) if self.locals.contains(name));
        let found = match local {
            true => Ok(Found::Unknown),
            false => self.world.find(&path, expr.span, self.context),
        };
        let layers = layers(expr);
        let base = path.len() - layers;
        let (value, taken) = match found {
            Err(error) => return self.report.push_once(error),
            Ok(Found::Unknown) if base > 1 => {
                let name = match path.first() {
                    Some(Step::Name(name)) => name.as_str(),
                    _ => "",
                };
                let error = Diagnostic::new(expr.span, format!("unknown name `{name}`"));
                let help = "declare it, or check its spelling; the ending of a joint's coordinates and velocities follows the index, as in `j[2]_dot`";
                return self.report.push_once(error.help(help));
            }
            Ok(Found::Unknown) => (None, base),
            Ok(Found::Number(value)) => {
                let number = ExprKind::Number(BigRational::from_integer(value.into()).into());
                (Some(number), 1)
            }
            Ok(Found::Parameter(scope, name, binding)) => {
                self.world.mention(scope, name);
                // The size is checked first, so that an argument that is too large is not copied.
                let known = self.known.arguments.get(&(scope, name.to_owned()));
                let measured = known.map(|known| known.as_ref().map(|(_, d, s)| (*d, *s)));
                let (depth, size) = match measured {
                    Some(Some(measured)) => measured,
                    Some(None) => return,
                    None => match self.argument(scope, name, binding) {
                        Some((_, depth, size)) => (depth, size),
                        None => return,
                    },
                };
                if self.is_too_large(depth, size, expr.span) {
                    return;
                }
                let Some((argument, ..)) = self.argument(scope, name, binding) else {
                    return;
                };
                (Some(argument.kind), 1)
            }
            Ok(Found::Thing(thing, taken)) => match thing.kind {
                Kind::Part(scope) => {
                    let error = self.is_part(scope, expr.span);
                    return self.report.push_once(error);
                }
                _ => (Some(ExprKind::Name(thing.name.clone())), taken),
            },
        };
        if taken < base {
            let error = no_more(&path, taken, expr.span);
            return self.report.push_once(error);
        }
        let mut node = expr;
        for _ in 0..layers - (taken - base) {
            node = match &mut node.kind {
                ExprKind::Index(inner, list) => {
                    list.iter_mut().for_each(|index| self.expr(index));
                    inner
                }
                ExprKind::Field(inner, _) => inner,
                _ => return,
            };
        }
        if let Some(value) = value {
            // A negative number is written as a negation.
            node.kind = signed(value, node.span);
        }
    }

    fn called(&mut self, function: &mut Ident) {
        let path = [Step::Name(function.name.clone())];
        if let Ok(Found::Thing(thing, 1)) = self.world.find(&path, function.span, self.context)
            && thing.kind == Kind::Other
        {
            function.name.clone_from(&thing.name);
        }
    }

    fn is_too_large(&mut self, depth: usize, size: usize, span: Span) -> bool {
        if self.known.full {
            // The error was reported when the limit was crossed.
            return true;
        }
        self.known.written += size;
        self.known.full = self.known.written > MOST_WRITTEN;
        let large = self.known.full || self.level + depth > MOST_LEVELS;
        if large {
            let error = Diagnostic::new(span, "arguments make this expression too large");
            self.report
                .push_once(error.help("name common parts with `let`"));
        }
        large
    }
}

/// Writes a negative number as the negation of a positive one, as the parser does.
fn signed(value: ExprKind, span: Span) -> ExprKind {
    match value {
        ExprKind::Number(number) if number.value < BigRational::from_integer(0.into()) => {
            let kind = ExprKind::Number((-number.value).into());
            ExprKind::Neg(Box::new(Expr { kind, span }))
        }
        other => other,
    }
}

/// Returns the steps of an expression that is a name with indices and parts.
fn spine(expr: &Expr) -> Option<Vec<Step>> {
    match &expr.kind {
        ExprKind::Name(name) => {
            let (name, span) = (name.clone(), expr.span);
            Some(steps(&Ident { name, span }))
        }
        ExprKind::Field(base, field) => {
            let mut path = spine(base)?;
            path.push(Step::Name(field.name.clone()));
            Some(path)
        }
        ExprKind::Index(base, list) => {
            let mut path = spine(base)?;
            path.push(Step::Index(list.clone()));
            Some(path)
        }
        _ => None,
    }
}

/// Returns the number of indices and parts that follow the first name of an expression.
fn layers(mut expr: &Expr) -> usize {
    let mut layers = 0;
    while let ExprKind::Field(base, _) | ExprKind::Index(base, _) = &expr.kind {
        layers += 1;
        expr = base;
    }
    layers
}

/// Returns the depth of an expression and its number of nodes.
fn measure(expr: &mut Expr) -> (usize, usize) {
    let inner: Vec<(usize, usize)> = parts(expr).into_iter().map(measure).collect();
    let depth = inner.iter().map(|(depth, _)| *depth).max().unwrap_or(0);
    let size: usize = inner.iter().map(|(_, size)| *size).sum();
    (depth + 1, size + 1)
}
