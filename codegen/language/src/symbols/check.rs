//! Lookup of names in expressions and of names of frames.

use super::table::{DeclaredSymbol, Kind, Symbols};
use super::words::{self, FUNCTIONS, reserved};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{Expr, ExprKind, Ident, ItemKind, Span, System};
use crate::syntax::suggest::{closest, coordinates_of_rate};
use crate::syntax::written::written;
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of names listed in a message if none is close to a misspelt one.
const LISTED: usize = 12;

/// Prefix of names that programs add to a description. They are never suggested.
const GENERATED: &str = "hamel_";

/// Largest number of unknown names for which a close one is searched.
const MOST_MISSPELT: usize = 50;

/// The body of a function, and the names of its parameters.
#[derive(Clone)]
struct Body<'a> {
    parameters: BTreeSet<&'a str>,
    value: &'a Expr,
}

/// Looks up names while more and more of them become known.
pub struct Checker<'a> {
    /// All declared symbols.
    pub symbols: Symbols<'a>,
    /// The errors so far.
    pub report: Report,
    /// Names that are declared but not yet known.
    pub open: BTreeSet<&'a str>,
    /// Names that have been looked up.
    pub used: BTreeSet<String>,
    /// Bodies of functions, checked where the function is called.
    bodies: BTreeMap<&'a str, Body<'a>>,
    /// Functions that have been checked, with the number of open names at that time, or 0 if there were no errors.
    seen: BTreeMap<&'a str, usize>,
    /// Rates that are given for whole coordinates, by the name of the coordinate.
    rates: BTreeMap<&'a str, &'a Expr>,
    /// Number of unknown names so far.
    misspelt: usize,
}

impl<'a> Checker<'a> {
    /// Creates a checker to which no names are known.
    pub fn new(system: &'a System, symbols: Symbols<'a>) -> Self {
        let mut bodies = BTreeMap::new();
        for (&name, function) in &symbols.functions {
            let parameters = function.parameters.iter();
            let parameters = parameters.map(|(name, _)| name.name.as_str()).collect();
            let value = &function.value;
            bodies.insert(name, Body { parameters, value });
        }
        for item in &system.items {
            if let ItemKind::External(function) = &item.kind
                && let Some(value) = &function.stand_in
            {
                let parameters = function.parameters.iter();
                let parameters = parameters.map(|name| name.name.as_str()).collect();
                let body = Body { parameters, value };
                bodies.entry(&function.name.name).or_insert(body);
            }
        }
        Checker {
            used: BTreeSet::new(),
            open: symbols.iter().map(|(name, _)| name).collect(),
            symbols,
            report: Report::new(),
            bodies,
            seen: BTreeMap::new(),
            rates: plain_rates(system),
            misspelt: 0,
        }
    }

    /// Returns the symbol with a name, if it is known already.
    pub fn known(&self, name: &str) -> Option<&DeclaredSymbol> {
        let symbol = self.symbols.get(name)?;
        (!self.open.contains(name)).then_some(symbol)
    }

    /// Reports an error, once per place.
    pub fn error(&mut self, error: Diagnostic) {
        self.report.push_once(error);
    }

    /// Looks up the names in an expression.
    pub fn expr(&mut self, expr: &Expr) {
        self.within(expr, &BTreeSet::new());
    }

    /// Looks up the names in the bodies of all functions that have not been checked.
    pub fn functions(&mut self) {
        for (name, body) in self.bodies.clone() {
            if self.seen.insert(name, self.open.len()).is_none() {
                self.within(body.value, &body.parameters);
            }
        }
    }

    /// Looks up the names in the body of a function with these parameters.
    fn within(&mut self, expr: &Expr, parameters: &BTreeSet<&str>) {
        match &expr.kind {
            ExprKind::Name(name) if parameters.contains(name.as_str()) => {}
            ExprKind::Name(name) => self.name(name, expr.span),
            ExprKind::Call(function, arguments) => {
                for argument in arguments {
                    self.within(argument, parameters);
                }
                self.call(function, expr.span);
            }
            ExprKind::InAxes(call, axes) => {
                self.within(call, parameters);
                // `in body` means the axes of the frame itself.
                if !matches!(&axes.kind, ExprKind::Name(name) if name == "body") {
                    self.within(axes, parameters);
                }
            }
            _ => {
                for part in expr.parts() {
                    self.within(part, parameters);
                }
            }
        }
    }

    fn name(&mut self, name: &str, span: Span) {
        self.used.insert(name.into());
        let error = match self.symbols.get(name) {
            Some(symbol) if self.open.contains(name) => early(span, name, symbol),
            Some(symbol) if symbol.kind != Kind::Function => return,
            None if matches!(name, "world" | "pi") => return,
            None if !reserved().chain(FUNCTIONS).any(|word| word == name) => {
                self.unknown(span, name, None, |_| true)
            }
            _ => Diagnostic::new(span, format!("`{name}` is a function"))
                .help(format!("write its arguments in parentheses: `{name}(…)`")),
        };
        self.error(error);
    }

    /// Looks up a called function. Errors in its body are reported with a note at the call.
    fn call(&mut self, function: &Ident, span: Span) {
        let name = function.name.as_str();
        self.used.insert(name.into());
        let symbol = self.symbols.get(name);
        match symbol.filter(|symbol| symbol.kind == Kind::Function) {
            Some(symbol) if self.open.contains(name) => {
                let error = early(function.span, name, symbol);
                self.error(error);
            }
            Some(_) => self.body(name, span),
            // The internal functions of joints have blanks in their names.
            None if name == "rate" || name.contains(' ') || words::usage(name).is_some() => {}
            None => {
                let error = self.no_function(function);
                self.error(error);
            }
        }
    }

    fn body(&mut self, name: &str, span: Span) {
        let Some((&name, body)) = self.bodies.get_key_value(name) else {
            return;
        };
        // The set of open names only shrinks, so a body without errors remains without errors.
        let open = self.open.len();
        if self.seen.get(name).is_some_and(|&seen| seen <= open) {
            return;
        }
        let body = body.clone();
        let outer = std::mem::take(&mut self.report);
        self.within(body.value, &body.parameters);
        let inner = std::mem::replace(&mut self.report, outer);
        let errors = inner.finish().err().unwrap_or_default();
        let seen = if errors.is_empty() { 0 } else { open };
        self.seen.insert(name, seen);
        for error in errors {
            self.error(error.in_call(span));
        }
    }

    fn no_function(&self, function: &Ident) -> Diagnostic {
        let name = &function.name;
        let error = Diagnostic::new(function.span, format!("no function is called `{name}`"));
        if self.symbols.get(name).is_some() {
            return error.help("a product is written with `*`");
        }
        // Names that other languages use.
        match name.as_str() {
            "ln" => return error.help("the natural logarithm is `log(a)`"),
            "pow" => return error.help("a power is written `a ^ b`"),
            _ => {}
        }
        let own = self.symbols.iter();
        let own = own.filter(|(_, symbol)| symbol.kind == Kind::Function);
        let mut known: Vec<&str> = words::names().collect();
        known.extend(own.map(|(name, _)| name));
        match closest(name, known) {
            Some(known) => error.help(format!("did you mean `{known}`?")),
            None => {
                let all: Vec<&str> = words::names().collect();
                error.help(format!("the functions are {}", all.join(", ")))
            }
        }
    }

    /// Looks up the name of a frame, which may be the world if `world` is true.
    pub fn frame(&mut self, name: &Ident, world: bool) {
        let Ident { name, span } = name;
        self.used.insert(name.clone());
        if self.known(name).is_some_and(|s| s.kind == Kind::Frame) || world && name == "world" {
            return;
        }
        let error = self.unknown(*span, name, Some("frame"), |kind| kind == Kind::Frame);
        self.error(match name.as_str() {
            "world" => error.help("write `frame ground = world;` and use `ground`"),
            _ => error,
        });
    }

    /// Returns the error for a name that does not stand for anything of the wanted kind (or for anything at all, if
    /// `wanted` is `None`). The help suggests the closest name that does.
    pub fn unknown(
        &mut self,
        span: Span,
        name: &str,
        wanted: Option<&str>,
        accept: impl Fn(Kind) -> bool,
    ) -> Diagnostic {
        let error = match (self.symbols.get(name), wanted) {
            (Some(symbol), _) if self.open.contains(name) => return early(span, name, symbol),
            (Some(symbol), Some(wanted)) => {
                let message = format!("`{name}` is {}, not a {wanted}", symbol.kind.describe());
                Diagnostic::new(span, message).note(symbol.span, "defined here")
            }
            (None, None) if self.symbols.outputs.contains_key(name) => {
                let message = format!("`{name}` is an output, which other expressions cannot use");
                return Diagnostic::new(span, message)
                    .help(format!("name the expression with `let {name} = …;`"));
            }
            (_, wanted) => {
                let wanted = wanted.map_or("nothing".into(), |wanted| format!("no {wanted}"));
                Diagnostic::new(span, format!("{wanted} is called `{name}`"))
            }
        };
        self.misspelt += 1;
        if self.misspelt > MOST_MISSPELT {
            return error.help("define it, or check its spelling");
        }
        if name == "t" && wanted.is_none() {
            return error.help("the time has to be declared: `time t;`");
        }
        if let Some((coordinate, velocity)) = self.rate_of(name, &accept) {
            return error.help(format!("the rate of `{coordinate}` is `{velocity}`"));
        }
        let known = || {
            let all = self.symbols.iter();
            let known = all.filter(|(name, s)| {
                accept(s.kind) && !self.open.contains(name) && !name.starts_with(GENERATED)
            });
            known.map(|(name, _)| name)
        };
        if let Some(near) = closest(name, known().filter(|&near| near != name)) {
            return error.help(format!("did you mean `{near}`?"));
        }
        let all: Vec<String> = known()
            .take(LISTED)
            .map(|name| format!("`{name}`"))
            .collect();
        match (all.is_empty(), wanted) {
            (true, Some("frame")) => error.help(format!("define it: `frame {name} = pose(R, p);`")),
            (true, _) => error.help("define it first"),
            (false, _) => error.help(format!("known here: {}", all.join(", "))),
        }
    }
}

impl Checker<'_> {
    /// Returns the coordinate whose rate a name seems to denote, as `x_dot` does for `x`, with the velocity that equals
    /// this rate.
    fn rate_of(&self, name: &str, accept: &impl Fn(Kind) -> bool) -> Option<(&str, String)> {
        let found = coordinates_of_rate(name).filter_map(|name| self.rates.get_key_value(name));
        let mut velocities = found.filter(|(_, velocity)| {
            let of = match &velocity.kind {
                ExprKind::Index(base, _) => base.as_ref(),
                _ => velocity,
            };
            let ExprKind::Name(of) = &of.kind else {
                return false;
            };
            self.symbols
                .kind(of)
                .is_some_and(|kind| kind == Kind::Velocity && accept(kind))
        });
        let (coordinate, velocity) = velocities.next()?;
        Some((coordinate, written(velocity)))
    }
}

/// Returns the rates that are given for whole coordinates, by the name of the coordinate.
fn plain_rates(system: &System) -> BTreeMap<&str, &Expr> {
    let rates = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Rate { target, value } => Some((target, value)),
        _ => None,
    });
    let whole = rates.filter(|(target, _)| target.field.is_none() && target.entry.is_empty());
    whole
        .map(|(target, value)| (target.name.name.as_str(), value))
        .collect()
}

/// Returns the error for a name that is defined, but not yet known where it is used.
fn early(span: Span, name: &str, symbol: &DeclaredSymbol) -> Diagnostic {
    let error = match symbol.kind {
        Kind::Const | Kind::Let | Kind::Frame => {
            Diagnostic::new(span, format!("`{name}` is used before it is defined"))
                .help("move its definition before this statement")
        }
        kind => {
            let message = format!("a constant cannot depend on `{name}`, {}", kind.describe());
            Diagnostic::new(span, message).help(
                "constants are made of numbers and constants; name this expression with `let`",
            )
        }
    };
    error.note(symbol.span, "defined here")
}
