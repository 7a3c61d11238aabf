//! Components and their parts.

use super::copies::moved;
use super::names::{Binding, Context, Expansion, Kind, Scope, Thing, shown};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{
    Argument, Component, Declaration, Ident, Item, ItemKind, Part, Shape, Span,
};
use crate::syntax::path::{Step, plain, steps};
use crate::syntax::suggest::closest;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Largest nesting depth of parts.
const MOST_NESTED: usize = 32;

impl<'a> Expansion<'a> {
    /// Registers a component.
    pub fn component(&mut self, component: &'a Component, span: Span) {
        let Ident { name, span: place } = &component.name;
        if let Some((first, ..)) = self.components.get(name.as_str()) {
            let error = Diagnostic::new(*place, format!("component `{name}` is defined twice"));
            self.report.push(
                error
                    .help("give one of the two another name")
                    .note(first.name.span, "the first one"),
            );
            return;
        }
        self.components.insert(name, (component, span, false));
    }

    /// Copies the statements of a component for a part, or for each part of an array.
    pub fn part(&mut self, part: &'a Part, span: Span, context: &Context) {
        let by = context.by;
        let Ident { name, span: place } = &part.component;
        let Some((component, whole, used)) = self.components.get_mut(name.as_str()) else {
            let error =
                Diagnostic::new(place.later(by), format!("no component is called `{name}`"));
            let known = self.components.keys().copied();
            let error = match closest(name, known.clone()) {
                Some(close) => error.help(format!("did you mean `{close}`?")),
                None if self.components.is_empty() => {
                    error.help(format!("write `component {name}(mount: frame) {{ … }}`"))
                }
                None => {
                    let all: Vec<String> = known.map(|name| format!("`{name}`")).collect();
                    error.help(format!("the components are {}", all.join(", ")))
                }
            };
            return self.report.push_once(error);
        };
        *used = true;
        let (component, whole) = (*component, *whole);
        if !self.may_contain(component, place.later(by), context) {
            return;
        }
        let Some(counter) = &part.counter else {
            return self.instance(part, component, (span, whole), None, context);
        };
        let Some((first, last)) = self.range(counter, context) else {
            return;
        };
        for value in first..=last {
            if !self.grows(span.later(by)) {
                return;
            }
            let counted = self.counted(context, counter, value);
            self.instance(part, component, (span, whole), Some(value), &counted);
        }
    }

    /// Returns whether a part of a component can stand here: not within itself, and not nested too deeply.
    fn may_contain(&mut self, component: &Component, place: Span, context: &Context) -> bool {
        let (mut scope, mut depth) = (context.scope, 0);
        while let Some((outer, parent)) = self.scopes[scope].part {
            if std::ptr::eq(outer, component) {
                let message = format!("the component `{}` contains itself", component.name.name);
                self.report.push_once(
                    Diagnostic::new(place, message)
                        .help("write a chain of equal parts with `for`, outside the component")
                        .note(component.name.span, "it is defined here"),
                );
                return false;
            }
            (scope, depth) = (parent, depth + 1);
        }
        if depth >= MOST_NESTED {
            let message = format!("parts are nested more than {MOST_NESTED} deep");
            let error = Diagnostic::new(place, message);
            self.report.push_once(error.help("put parts side by side"));
        }
        depth < MOST_NESTED
    }

    /// Creates one part: its scope, its arguments, and copies of the component's statements.
    fn instance(
        &mut self,
        part: &'a Part,
        component: &'a Component,
        (span, whole): (Span, Span),
        counted: Option<i64>,
        context: &Context,
    ) {
        let by = context.by;
        let mut name = part.name.clone();
        name.span = name.span.later(by);
        let path = steps(&name);
        let (base, indices) = match (path.as_slice(), counted) {
            ([Step::Name(base)], None) => (base, None),
            ([Step::Name(base)], Some(value)) if value >= 0 => (base, Some(vec![value])),
            ([Step::Name(_)], Some(value)) => {
                let message = format!("the index {value} is negative");
                let error = Diagnostic::new(name.span, message);
                return self.report.push_once(error.help("indices start at 0 or 1"));
            }
            ([Step::Name(base), Step::Index(list)], None) => match self.indices(list, context) {
                Ok(indices) => (base, Some(indices)),
                Err(error) => return self.report.push_once(error),
            },
            _ => {
                let error = Diagnostic::new(name.span, "this is not the name of a part");
                return self.report.push_once(
                    error.help("a name is a word such as `left`, or `leg[2]` in an array"),
                );
            }
        };
        let outer = &self.scopes[context.scope];
        let own = shown(base, indices.as_deref(), "");
        let (prefix, written) = (
            format!("{}{}_", outer.prefix, plain(&own)),
            format!("{}{own}.", outer.written),
        );
        let label = format!("in the part `{}`, made here", written.trim_end_matches('.'));
        let delta = self.origins.copy(whole, span.later(by), label);
        let bindings = self.bindings(part, component, span.later(by), context, delta);
        let inner = self.scopes.len();
        let thing = Thing {
            kind: Kind::Part(inner),
            name: String::new(),
            span: name.span,
        };
        let first = !self.has_part(base, indices.as_ref(), context.scope);
        self.register(base, indices, "", thing, context.scope);
        self.scopes.push(Scope {
            prefix,
            written,
            part: Some((component, context.scope)),
            bindings,
            ..Scope::default()
        });
        if !first {
            return;
        }
        self.shaped(component, inner, delta);
        let context = Context {
            scope: inner,
            counters: Rc::default(),
            by: delta,
        };
        self.statements(&component.items, &context);
    }

    /// Turns parameters that have a shape into named expressions of the part, such as `left.hip`. Each is then
    /// evaluated once, and its shape is checked.
    fn shaped(&mut self, component: &'a Component, scope: usize, by: usize) {
        for parameter in &component.parameters {
            let Some(shape) = parameter.shape else {
                continue;
            };
            let base = parameter.name.name.as_str();
            let Some(binding) = self.scopes[scope].bindings.remove(base) else {
                continue;
            };
            let span = parameter.name.span.later(by);
            let thing = Thing {
                kind: Kind::Other,
                name: String::new(),
                span,
            };
            let name = self.register(base, None, "", thing, scope);
            let mut value = binding.value.clone();
            moved(&mut value, binding.context.by);
            let declaration = Declaration {
                name: Ident { name, span },
                shape: Shape {
                    span: shape.span.later(by),
                    ..shape
                },
                unit: None,
                value: Some(value),
            };
            let kind = ItemKind::Let(vec![declaration]);
            self.pending.push((Item { kind, span }, binding.context));
            let key = (component.name.name.clone(), base.to_owned());
            self.parameters.borrow_mut().insert(key);
        }
    }

    /// Returns whether a scope has a part of this name.
    fn has_part(&self, base: &str, indices: Option<&Vec<i64>>, scope: usize) -> bool {
        let scope = &self.scopes[scope];
        let thing = match indices {
            None => scope.plain.get(base),
            Some(indices) => {
                let array = scope.arrays.get(&(base.to_owned(), String::new()));
                array.and_then(|array| array.get(indices))
            }
        };
        thing.is_some_and(|thing| matches!(thing.kind, Kind::Part(_)))
    }

    /// Matches the arguments of a part with the parameters of its component.
    fn bindings(
        &mut self,
        part: &'a Part,
        component: &'a Component,
        span: Span,
        context: &Context,
        delta: usize,
    ) -> BTreeMap<&'a str, Binding<'a>> {
        let mut given: BTreeMap<&str, &'a Argument> = BTreeMap::new();
        let parameters = &component.parameters;
        let usage = || {
            let list: Vec<String> = parameters
                .iter()
                .map(
                    |parameter| match (parameter.frame, parameter.default.is_some()) {
                        (false, false) if parameter.shape.is_some() => {
                            let shape = parameter.shape.map(|shape| shape.kind.annotation());
                            parameter.name.name.clone() + &shape.unwrap_or_default()
                        }
                        (true, _) => format!("{}: frame", parameter.name.name),
                        (false, false) => parameter.name.name.clone(),
                        (false, true) => format!("{} = …", parameter.name.name),
                    },
                )
                .collect();
            format!("it is `{}({})`", component.name.name, list.join(", "))
        };
        let mut named = false;
        for (place, argument) in part.arguments.iter().enumerate() {
            let at = |span: Span| span.later(context.by);
            let parameter = match &argument.name {
                Some(name) => {
                    named = true;
                    let known = parameters.iter().find(|p| p.name.name == name.name);
                    if known.is_none() {
                        let message =
                            format!("`{}` has no parameter `{}`", component.name.name, name.name);
                        let error = Diagnostic::new(at(name.span), message);
                        let names = parameters.iter().map(|p| p.name.name.as_str());
                        let help = match closest(&name.name, names) {
                            Some(close) => format!("did you mean `{close}`?"),
                            None => usage(),
                        };
                        self.report.push_once(error.help(help));
                    }
                    known
                }
                None if named => {
                    let error = Diagnostic::new(
                        at(argument.value.span),
                        "an argument without a name follows one with a name",
                    );
                    self.report
                        .push_once(error.help("write its name before it: `side = -1`"));
                    continue;
                }
                None => {
                    let found = parameters.get(place);
                    if found.is_none() {
                        let message = format!(
                            "`{}` takes {} arguments, not {}",
                            component.name.name,
                            parameters.len(),
                            part.arguments.len()
                        );
                        let error = Diagnostic::new(at(argument.value.span), message);
                        self.report.push_once(
                            error
                                .help(usage())
                                .note(component.name.span, "defined here"),
                        );
                        break;
                    }
                    found
                }
            };
            let Some(parameter) = parameter else {
                continue;
            };
            if let Some(first) = given.insert(&parameter.name.name, argument) {
                let message = format!("`{}` is given twice", parameter.name.name);
                let place = argument
                    .name
                    .as_ref()
                    .map_or(argument.value.span, |n| n.span);
                self.report.push_once(
                    Diagnostic::new(at(place), message)
                        .help("remove one of the two")
                        .note(at(first.value.span), "first given here"),
                );
            }
        }
        let mut bindings = BTreeMap::new();
        for parameter in parameters {
            let name = parameter.name.name.as_str();
            let (value, context) = match (given.get(name), &parameter.default) {
                (Some(argument), _) => (&argument.value, context.clone()),
                (None, Some(default)) => {
                    let by = delta;
                    let root = Context {
                        by,
                        ..Context::default()
                    };
                    (default, root)
                }
                (None, None) => {
                    let message = format!("the argument `{name}` is missing");
                    self.report.push_once(
                        Diagnostic::new(span, message)
                            .help(usage())
                            .note(parameter.name.span, "declared here"),
                    );
                    // The parameter gets some binding nevertheless, so that its uses cause no further errors.
                    let Some(any) = part.arguments.first() else {
                        continue;
                    };
                    (&any.value, context.clone())
                }
            };
            let frame = parameter.frame;
            bindings.insert(
                name,
                Binding {
                    frame,
                    value,
                    context,
                },
            );
        }
        bindings
    }

    /// Returns warnings for components without a part, and for parameters that their component does not mention.
    pub fn unused(&self) -> Vec<Diagnostic> {
        let mut warnings = Vec::new();
        let parameters = self.parameters.borrow();
        for (name, (component, _, used)) in &self.components {
            let span = component.name.span;
            if name.starts_with('_') || self.origins.is_included(span) {
                continue;
            }
            if !used {
                let warning =
                    Diagnostic::new(span, format!("the component `{name}` is never used"));
                warnings.push(warning.help(format!("remove it, or call it `_{name}`")));
                continue;
            }
            for parameter in &component.parameters {
                let Ident { name: own, span } = &parameter.name;
                let key = ((*name).to_owned(), own.clone());
                if own.starts_with('_') || parameters.contains(&key) {
                    continue;
                }
                let message = format!("the parameter `{own}` of `{name}` is never used");
                let warning = Diagnostic::new(*span, message);
                warnings.push(warning.help(format!("remove it, or call it `_{own}`")));
            }
        }
        warnings
    }
}
