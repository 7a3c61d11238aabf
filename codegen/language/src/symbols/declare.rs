//! Declaration of the names in all statements, each of which must be declared once.

use super::table::{Kind, Symbols};
use super::words::{is_function, reserved};
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{Expr, ExprKind, Function, Ident, ItemKind, System};
use std::collections::{BTreeMap, BTreeSet};

/// Declares all names in the order of the text. Reports duplicates and names that are words of the language.
pub fn declare<'a>(system: &'a System, report: &mut Report) -> Symbols<'a> {
    let mut symbols = Symbols::default();
    let mut functions = Vec::new();
    for item in &system.items {
        let (list, kind) = match &item.kind {
            ItemKind::Param(list) => (list, Kind::Param),
            ItemKind::Const(list) => (list, Kind::Const),
            ItemKind::Let(list) => (list, Kind::Let),
            ItemKind::Velocity(list) => (list, Kind::Velocity),
            ItemKind::Input(list) => (list, Kind::Input),
            ItemKind::State(list) => (list, Kind::State),
            ItemKind::Coord(list) => {
                for (name, kind, _) in list {
                    claim(&mut symbols, name, Kind::Coord(*kind), report);
                }
                continue;
            }
            ItemKind::Frame { name, .. } => {
                // Two statements may relate the same frame to others.
                if symbols.kind(&name.name) != Some(Kind::Frame) {
                    claim(&mut symbols, name, Kind::Frame, report);
                }
                continue;
            }
            ItemKind::Function(function) => {
                functions.push(function);
                claim_function(&mut symbols, &function.name, report);
                continue;
            }
            ItemKind::External(function) => {
                claim_function(&mut symbols, &function.name, report);
                continue;
            }
            ItemKind::Table(table) => {
                claim_function(&mut symbols, &table.name, report);
                continue;
            }
            ItemKind::Output { name, .. } => {
                symbols.outputs.entry(&name.name).or_insert(name.span);
                continue;
            }
            _ => continue,
        };
        for declaration in list {
            claim(&mut symbols, &declaration.name, kind, report);
        }
    }
    let all = functions.iter().map(|f| (f.name.name.as_str(), *f));
    let all: BTreeMap<&str, &Function> = all.collect();
    for function in functions {
        let name = function.name.name.as_str();
        if !symbols.functions.contains_key(name) && can_be_called(function, &all, report) {
            symbols.functions.insert(name, function);
        }
    }
    symbols
}

/// Declares a name, and reports a second declaration as an error.
///
/// A word of the language is declared nevertheless, so that its uses cause no further errors.
fn claim<'a>(symbols: &mut Symbols<'a>, name: &'a Ident, kind: Kind, report: &mut Report) {
    if let Some(first) = symbols.get(&name.name) {
        report.push(
            Diagnostic::new(name.span, format!("`{}` is defined twice", name.name))
                .help("rename one of the two")
                .note(
                    first.span,
                    format!("first defined here, as {}", first.kind.describe()),
                ),
        );
        return;
    }
    let refused = reserved().any(|word| word == name.name);
    symbols.add(&name.name, kind, name.span, refused);
    if refused {
        let message = format!("`{}` is a word of the language", name.name);
        let help = format!("choose another name, such as `{}_1`", name.name);
        report.push(Diagnostic::new(name.span, message).help(help));
    }
}

/// Declares a function of the description. Its name must not be that of a function of the language.
fn claim_function<'a>(symbols: &mut Symbols<'a>, name: &'a Ident, report: &mut Report) {
    if is_function(&name.name) {
        let message = format!("`{}` is a function of the language", name.name);
        let help = format!("choose another name, such as `{}_1`", name.name);
        report.push(Diagnostic::new(name.span, message).help(help));
    } else {
        claim(symbols, name, Kind::Function, report);
    }
}

/// Returns whether a function is valid: its parameters have distinct names and it is not recursive. Reports an error
/// otherwise.
fn can_be_called(
    function: &Function,
    all: &BTreeMap<&str, &Function>,
    report: &mut Report,
) -> bool {
    let name = &function.name.name;
    let mut known: Vec<&Ident> = Vec::new();
    for (parameter, _) in &function.parameters {
        if let Some(first) = known.iter().find(|first| first.name == parameter.name) {
            let message = format!("two parameters are called `{}`", parameter.name);
            report.push(
                Diagnostic::new(parameter.span, message)
                    .help("rename one of the two")
                    .note(first.span, "the first one"),
            );
            return false;
        }
        known.push(parameter);
    }
    if reaches(all, function, name) {
        let message = format!("the value of `{name}` depends on `{name}` itself");
        let help = "a function may call others but not itself: write its value out";
        report.push(Diagnostic::new(function.value.span, message).help(help));
        return false;
    }
    true
}

/// Returns whether a function calls another, directly or through functions that it calls.
fn reaches(all: &BTreeMap<&str, &Function>, function: &Function, wanted: &str) -> bool {
    let mut reached = BTreeSet::new();
    let mut open = vec![function];
    while let Some(function) = open.pop() {
        let mut calls = BTreeSet::new();
        called(&function.value, &mut calls);
        for name in calls {
            if reached.insert(name) {
                open.extend(all.get(name));
            }
        }
    }
    reached.contains(wanted)
}

/// Collects the functions that an expression calls.
fn called<'a>(expr: &'a Expr, names: &mut BTreeSet<&'a str>) {
    if let ExprKind::Call(function, _) = &expr.kind {
        names.insert(&function.name);
    }
    let parts = expr.parts().into_iter();
    parts.for_each(|part| called(part, names));
}
