//! Statements of a scene that expand to others: repetition, components and their parts, included files.

use super::build::SceneBuilder;
use crate::syntax::ast::{
    self, Argument, Component, Counter, Expr, ItemKind, Part, Repeat, Shape, ShapeKind, Span,
};
use hamel_language::expression::ident;

/// A parameter of a component.
#[derive(Clone, Debug)]
pub struct Parameter(ast::Parameter);

impl Parameter {
    fn new(name: &str, frame: bool) -> Parameter {
        Parameter(ast::Parameter {
            name: ident(name),
            frame,
            shape: None,
            default: None,
        })
    }

    /// Creates a parameter that stands for a frame.
    pub fn frame(name: &str) -> Parameter {
        Parameter::new(name, true)
    }

    /// Creates a parameter that stands for an expression.
    pub fn value(name: &str) -> Parameter {
        Parameter::new(name, false)
    }

    /// Creates a parameter that stands for an expression of this shape, a vector or a matrix.
    pub fn shaped(name: &str, kind: ShapeKind) -> Parameter {
        let mut parameter = Parameter::new(name, false);
        let span = Span::NOWHERE;
        parameter.0.shape = Some(Shape { kind, span });
        parameter
    }

    /// Sets the default, for parts that do not give a value.
    pub fn or(mut self, default: impl Into<Expr>) -> Parameter {
        self.0.default = Some(default.into());
        self
    }
}

/// Statements that expand to others. Names with an index that contains a counter are written as in texts, for example
/// `link[i - 1]`.
impl SceneBuilder {
    /// Includes the statements of a file. A scene has no folder for the file: it can be printed, and its text can be
    /// derived where the file is.
    pub fn include(&mut self, path: &str) {
        self.add(ItemKind::Include(path.to_string(), Span::NOWHERE));
    }

    /// Repeats statements for every value of a counter, from a first one to a last one.
    pub fn repeat(
        &mut self,
        counter: &str,
        first: impl Into<Expr>,
        last: impl Into<Expr>,
        statements: impl FnOnce(&mut SceneBuilder),
    ) {
        let counter = self::counter(counter, first, last);
        let items = self.inner(statements);
        self.add(ItemKind::Repeat(Repeat { counter, items }));
    }

    /// Adds a component: statements that are instantiated, under names of their own, by every part of this component.
    pub fn component(
        &mut self,
        name: &str,
        parameters: impl IntoIterator<Item = Parameter>,
        statements: impl FnOnce(&mut SceneBuilder),
    ) {
        let items = self.inner(statements);
        self.add(ItemKind::Component(Component {
            name: ident(name),
            parameters: parameters.into_iter().map(|one| one.0).collect(),
            items,
        }));
    }

    /// Adds a part of the mechanism that instantiates a component, with arguments by name. A declaration `knee` of the
    /// component is called `NAME.knee`.
    pub fn part<'a>(
        &mut self,
        name: &str,
        component: &str,
        arguments: impl IntoIterator<Item = (&'a str, Expr)>,
    ) {
        self.add(made(name, None, component, arguments));
    }

    /// Adds an array of parts. Arguments may contain the counter; the parts are called `NAME[1]` and so on.
    pub fn parts<'a>(
        &mut self,
        name: &str,
        (counter, first, last): (&str, impl Into<Expr>, impl Into<Expr>),
        component: &str,
        arguments: impl IntoIterator<Item = (&'a str, Expr)>,
    ) {
        let counter = self::counter(counter, first, last);
        self.add(made(name, Some(counter), component, arguments));
    }
}

fn counter(name: &str, first: impl Into<Expr>, last: impl Into<Expr>) -> Counter {
    Counter {
        name: ident(name),
        first: first.into(),
        last: last.into(),
    }
}

fn made<'a>(
    name: &str,
    counter: Option<Counter>,
    component: &str,
    arguments: impl IntoIterator<Item = (&'a str, Expr)>,
) -> ItemKind {
    let arguments = arguments.into_iter().map(|(name, value)| Argument {
        name: Some(ident(name)),
        value,
    });
    ItemKind::Part(Part {
        name: ident(name),
        counter,
        component: ident(component),
        arguments: arguments.collect(),
    })
}
