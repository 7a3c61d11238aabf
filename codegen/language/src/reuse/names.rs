//! Names declared by the statements of a description: plain names, arrays, and parts with names of their own.

use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{Component, Expr, Ident, Item, Origins, Span, System};
use crate::syntax::path::{Step, plain, steps};
use crate::syntax::suggest::closest;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// Context of a statement: the part that it is in, and the values of the enclosing counters.
#[derive(Clone, Debug, Default)]
pub struct Context {
    /// Index of the scope. The description itself has scope 0.
    pub scope: usize,
    /// The counters, innermost last.
    pub counters: Rc<Vec<(String, i64)>>,
    /// Offset from places in the text to the places of this copy.
    pub by: usize,
}

impl Context {
    /// Returns the value of a counter.
    pub fn counter(&self, name: &str) -> Option<i64> {
        let found = self.counters.iter().rev().find(|(known, _)| known == name);
        found.map(|(_, value)| *value)
    }
}

/// An item that a statement declares, with its final name.
#[derive(Clone, Debug)]
pub struct Thing {
    /// Kind of the item.
    pub kind: Kind,
    /// Final name, after expansion.
    pub name: String,
    /// Place of its declaration.
    pub span: Span,
}

/// Kinds of items that the expansion distinguishes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A frame.
    Frame,
    /// Anything else with a name: a parameter, a coordinate, a function, …
    Other,
    /// A part, with the index of its scope.
    Part(usize),
}

/// Argument bound to a parameter of a component.
#[derive(Clone, Debug)]
pub struct Binding<'a> {
    /// Whether the parameter is a frame.
    pub frame: bool,
    /// The argument.
    pub value: &'a Expr,
    /// Context of the argument.
    pub context: Context,
}

/// Items of an array, by their indices.
pub type Array = BTreeMap<Vec<i64>, Thing>;

/// Names declared in the description, or in one part.
#[derive(Debug, Default)]
pub struct Scope<'a> {
    /// Prefix of the final names declared here.
    pub prefix: String,
    /// The same prefix as it is written in the description.
    pub written: String,
    /// Component of the part, with the scope that contains the part.
    pub part: Option<(&'a Component, usize)>,
    /// Arguments bound to the parameters of the component.
    pub bindings: BTreeMap<&'a str, Binding<'a>>,
    /// Items without an index, by name.
    pub plain: BTreeMap<String, Thing>,
    /// Arrays, by name and by the suffix after the index.
    pub arrays: BTreeMap<(String, String), Array>,
    /// Values of constants, for ranges and indices.
    pub constants: BTreeMap<&'a str, (&'a Expr, Context)>,
}

/// State of the expansion of a description.
pub struct Expansion<'a> {
    /// All scopes. The first one is that of the description.
    pub scopes: Vec<Scope<'a>>,
    /// Components, each with the span of its statement and whether any part uses it.
    pub components: BTreeMap<&'a str, (&'a Component, Span, bool)>,
    /// Origins of the copies.
    pub origins: Origins,
    /// Errors so far.
    pub report: Report,
    /// Copied statements, whose names are still as written.
    pub pending: Vec<(Item, Context)>,
    /// Number of statements and rounds so far.
    pub size: usize,
    /// Final names of constants used in ranges and indices.
    pub used: RefCell<BTreeSet<String>>,
    /// Parameters of components that are used, by component and parameter.
    pub parameters: RefCell<BTreeSet<(String, String)>>,
    /// Final names, each with its spelling in the description and its place.
    ends: BTreeMap<String, (String, Span)>,
}

/// Meaning of a name during the expansion of components.
pub enum Found<'w, 'a> {
    /// No declared item.
    Unknown,
    /// A counter, with its value.
    Number(i64),
    /// A parameter of a component, with its scope and its name.
    Parameter(usize, &'a str, &'w Binding<'a>),
    /// A declared item, with the number of steps that lead to it.
    Thing(&'w Thing, usize),
}

impl<'a> Expansion<'a> {
    /// Creates a state in which no names are known.
    pub fn new(system: &'a System) -> Self {
        Expansion {
            scopes: vec![Scope::default()],
            components: BTreeMap::new(),
            origins: system.origins.clone(),
            report: Report::new(),
            pending: Vec::new(),
            size: 0,
            used: RefCell::default(),
            parameters: RefCell::default(),
            ends: BTreeMap::new(),
        }
    }

    /// Returns the origins, the map from final names to names as written where these differ, and the errors.
    pub fn finish(self) -> ((Origins, BTreeMap<String, String>), Report) {
        let differs = |(name, (written, _)): (String, (String, Span))| {
            let shown = (name != written).then_some(written)?;
            Some((name, shown))
        };
        let written = self.ends.into_iter().filter_map(differs).collect();
        ((self.origins, written), self.report)
    }

    /// Registers a name that a statement declares, and replaces it by its final name. Returns whether it can be
    /// declared here.
    pub fn declare(&mut self, ident: &mut Ident, kind: Kind, context: &Context) -> bool {
        let found = steps(ident);
        let (base, list, ending) = match found.as_slice() {
            [Step::Name(base)] => (base, None, ""),
            [Step::Name(base), Step::Index(list)] => (base, Some(list), ""),
            [Step::Name(base), Step::Index(list), Step::Ending(ending)] => {
                (base, Some(list), ending.as_str())
            }
            _ => return false,
        };
        let counted = context.counter(base).is_some();
        if counted
            || self.scopes[context.scope]
                .bindings
                .contains_key(base.as_str())
        {
            let what = if counted { "counter" } else { "parameter" };
            let message = format!("`{base}` is the name of a {what} here");
            let error = Diagnostic::new(ident.span, message);
            self.report
                .push_once(error.help("give one of the two another name"));
            return false;
        }
        let indices = match list {
            None => None,
            Some(list) => match self.indices(list, context) {
                Ok(indices) => Some(indices),
                Err(error) => {
                    self.report.push_once(error);
                    return false;
                }
            },
        };
        let thing = Thing {
            kind,
            name: String::new(),
            span: ident.span,
        };
        ident.name = self.register(base, indices, ending, thing, context.scope);
        true
    }

    /// Registers an item and returns its final name.
    pub fn register(
        &mut self,
        base: &str,
        indices: Option<Vec<i64>>,
        ending: &str,
        mut thing: Thing,
        scope: usize,
    ) -> String {
        let own = shown(base, indices.as_deref(), ending);
        let Scope {
            prefix, written, ..
        } = &self.scopes[scope];
        let (name, written) = (
            format!("{prefix}{}", plain(&own)),
            format!("{written}{own}"),
        );
        thing.name.clone_from(&name);
        if let Some(error) =
            self.contradiction(base, indices.as_ref(), ending, &thing, &written, scope)
        {
            self.report.push_once(error);
        }
        self.ends
            .entry(name.clone())
            .or_insert((written, thing.span));
        let scope = &mut self.scopes[scope];
        let kind = thing.kind;
        let known = match indices {
            None => scope.plain.entry(base.to_owned()).or_insert(thing),
            Some(indices) => {
                let array = scope.arrays.entry((base.to_owned(), ending.to_owned()));
                array.or_default().entry(indices).or_insert(thing)
            }
        };
        // If a part and something else share a name, the name refers to the part, so that names within it are found.
        if !matches!(known.kind, Kind::Part(_)) && matches!(kind, Kind::Part(_)) {
            known.kind = kind;
        }
        name
    }

    /// Returns the error for a declaration that contradicts an earlier one. A second declaration of the same name is
    /// otherwise reported by a later stage if it is wrong.
    fn contradiction(
        &self,
        base: &str,
        indices: Option<&Vec<i64>>,
        ending: &str,
        thing: &Thing,
        written: &str,
        scope: usize,
    ) -> Option<Diagnostic> {
        let error = |message: String| Diagnostic::new(thing.span, message);
        let scope = &self.scopes[scope];
        let array = scope.arrays.get(&(base.to_owned(), ending.to_owned()));
        let known = match indices {
            None => scope.plain.get(base),
            Some(indices) => array.and_then(|array| array.get(indices)),
        };
        if let Some(first) = known {
            let part = |thing: &Thing| matches!(thing.kind, Kind::Part(_));
            let place = |span: Span| self.origins.source(span).range();
            if place(first.span) == place(thing.span) && place(thing.span).is_some() {
                let message = format!("every round of this `for` declares `{written}` again");
                let index = format!("give it the counter as an index, as in `{base}[i]`");
                return Some(error(message).help(index));
            }
            if part(first) || part(thing) {
                let message = format!("`{written}` is defined twice");
                let error = error(message).help("give one of the two another name");
                return Some(error.note(first.span, "first defined here"));
            }
        }
        let other = match indices {
            None => array.and_then(|array| array.values().next()),
            Some(_) if ending.is_empty() => scope.plain.get(base),
            Some(_) => None,
        };
        if let Some(first) = other {
            let message = format!("`{base}` is declared with an index and without one");
            let error = error(message).help("give one of the two another name");
            return Some(error.note(first.span, "first declared here"));
        }
        let (first, span) = self.ends.get(&thing.name)?;
        if first == written {
            return None;
        }
        let message = format!(
            "`{written}` and `{first}` would both be called `{}`",
            thing.name
        );
        let error = error(message).help(
            "give one of the two another name: in generated code brackets and dots become `_`",
        );
        Some(error.note(*span, "the other one"))
    }

    /// Resolves the steps of a name that a statement mentions.
    pub fn find<'w>(
        &'w self,
        steps: &[Step],
        span: Span,
        context: &Context,
    ) -> Result<Found<'w, 'a>, Diagnostic> {
        let Some(Step::Name(first)) = steps.first() else {
            return Ok(Found::Unknown);
        };
        if let Some(value) = context.counter(first) {
            return Ok(Found::Number(value));
        }
        let own = &self.scopes[context.scope];
        if let Some((name, binding)) = own.bindings.get_key_value(first.as_str()) {
            return Ok(Found::Parameter(context.scope, name, binding));
        }
        for scope in [context.scope, 0] {
            let found = self.step(scope, first, &steps[1..], span, context)?;
            if let Some((thing, taken)) = found {
                return self.onward(thing, steps, taken, span, context);
            }
        }
        Ok(Found::Unknown)
    }

    /// Follows the steps of a name into parts.
    fn onward<'w>(
        &'w self,
        mut thing: &'w Thing,
        steps: &[Step],
        mut taken: usize,
        span: Span,
        context: &Context,
    ) -> Result<Found<'w, 'a>, Diagnostic> {
        while let (Kind::Part(scope), Some(step)) = (thing.kind, steps.get(taken)) {
            let part = self.scopes[scope].written.trim_end_matches('.');
            let Step::Name(name) = step else {
                let message = format!("the part `{part}` is not an array");
                return Err(Diagnostic::new(span, message).help(self.parts_of(scope)));
            };
            let rest = &steps[taken + 1..];
            match self.step(scope, name, rest, span, context)? {
                Some((next, more)) => {
                    thing = next;
                    taken += more;
                }
                None => {
                    let message = format!("the part `{part}` has no `{name}`");
                    let error = Diagnostic::new(span, message);
                    let known = self.scopes[scope].bases();
                    return Err(match closest(name, known) {
                        Some(close) => error.help(format!("did you mean `{part}.{close}`?")),
                        None => error.help(self.parts_of(scope)),
                    });
                }
            }
        }
        Ok(Found::Thing(thing, taken))
    }

    /// Returns help that lists the names of a part.
    pub fn parts_of(&self, scope: usize) -> String {
        /// Largest number of names listed.
        const MOST: usize = 8;
        let scope = &self.scopes[scope];
        let names: Vec<String> = scope
            .bases()
            .take(MOST)
            .map(|name| format!("`{name}`"))
            .collect();
        match names.as_slice() {
            [] => "it declares no names".to_owned(),
            list => format!("it has {}; write `{}NAME`", list.join(", "), scope.written),
        }
    }

    /// Finds an item of a scope by its name and the index after it. Returns the item and the number of steps used.
    fn step(
        &self,
        scope: usize,
        name: &str,
        rest: &[Step],
        span: Span,
        context: &Context,
    ) -> Result<Option<(&Thing, usize)>, Diagnostic> {
        let scope = &self.scopes[scope];
        let array = |ending: &str| scope.arrays.get(&(name.to_owned(), ending.to_owned()));
        let (list, ending) = match rest {
            [Step::Index(list), Step::Ending(ending), ..] => (Some(list), ending.as_str()),
            [Step::Index(list), ..] => (Some(list), ""),
            _ => (None, ""),
        };
        if let (None, Some(thing)) = (array(ending), scope.plain.get(name)) {
            if ending.is_empty() {
                return Ok(Some((thing, 1)));
            }
            let message = format!("`{name}` is not an array");
            return Err(Diagnostic::new(span, message).help(format!("write `{name}{ending}`")));
        }
        let (array, list) = match (array(ending), list) {
            (Some(array), Some(list)) => (array, list),
            (Some(array), None) => {
                let message = format!("`{name}` is an array");
                let first = array.keys().next().map_or(Vec::new(), Vec::clone);
                let help = format!(
                    "write which one is meant, as in `{}`",
                    shown(name, Some(&first), "")
                );
                return Err(Diagnostic::new(span, message).help(help));
            }
            (None, Some(_)) if !ending.is_empty() && array("").is_some() => {
                let message = format!("no `{name}[…]{ending}` is declared");
                let help = "the ending of a joint's coordinates and velocities follows the index, as in `j[2]_dot`";
                return Err(Diagnostic::new(span, message).help(help));
            }
            _ => return Ok(None),
        };
        let indices = self.indices(list, context)?;
        match array.get(&indices) {
            Some(thing) => Ok(Some((thing, 1 + 1 + usize::from(!ending.is_empty())))),
            None => {
                let missing = shown(name, Some(&indices), ending);
                let (first, last) = (array.keys().next(), array.keys().next_back());
                let range = first.zip(last).map(|(first, last)| {
                    let of = |indices: &[i64]| shown(name, Some(indices), ending);
                    format!("the names run from `{}` to `{}`", of(first), of(last))
                });
                let error = Diagnostic::new(span, format!("there is no `{missing}`"));
                Err(error.help(range.unwrap_or_default()))
            }
        }
    }
}

impl Scope<'_> {
    /// Returns the names declared here, without indices.
    pub fn bases(&self) -> impl Iterator<Item = &str> {
        let arrays = self.arrays.keys().filter(|(_, ending)| ending.is_empty());
        let arrays = arrays.map(|(name, _)| name.as_str());
        self.plain.keys().map(String::as_str).chain(arrays)
    }
}

/// Returns a name as it is written: `link[3]`, `j[2]_dot`.
pub fn shown(base: &str, indices: Option<&[i64]>, ending: &str) -> String {
    match indices {
        None => base.to_owned(),
        Some(indices) => {
            let list: Vec<String> = indices.iter().map(i64::to_string).collect();
            format!("{base}[{}]{ending}", list.join(","))
        }
    }
}
