//! Statements that expand into others: repetition, components and their parts.

use super::{Expr, Ident, Item, Shape, Span};

/// `i in 1..n`: a counter and its range, both ends included.
#[derive(Clone, Debug, PartialEq)]
pub struct Counter {
    /// The name of the counter.
    pub name: Ident,
    /// Its first value.
    pub first: Expr,
    /// Its last value.
    pub last: Expr,
}

impl Counter {
    /// Returns the span from the counter's name to the last value.
    pub fn span(&self) -> Span {
        self.name.span.to(self.last.span)
    }
}

/// `for i in 1..n { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Repeat {
    /// Counter of the loop.
    pub counter: Counter,
    /// The statements that are repeated.
    pub items: Vec<Item>,
}

/// `component Leg(mount: frame, side = 1) { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its name.
    pub name: Ident,
    /// Parameters, for which each part gives arguments.
    pub parameters: Vec<Parameter>,
    /// Its statements.
    pub items: Vec<Item>,
}

/// `mount: frame`, `hip: vec3` or `side = 1` of a component.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in the component.
    pub name: Ident,
    /// Whether it stands for a frame; otherwise for an expression.
    pub frame: bool,
    /// Required shape of the expression, if one is written.
    pub shape: Option<Shape>,
    /// Default, if one is written.
    pub default: Option<Expr>,
}

/// `part left = Leg(hip, side = -1);` or `part leg[i in 1..6] = Leg(mount[i]);`
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name, as written.
    pub name: Ident,
    /// Counter of an array of parts, if it is one.
    pub counter: Option<Counter>,
    /// Component that the part is an instance of.
    pub component: Ident,
    /// Arguments for the component's parameters.
    pub arguments: Vec<Argument>,
}

/// An argument of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// Name of the parameter, if written.
    pub name: Option<Ident>,
    /// Value; for a frame, its name.
    pub value: Expr,
}
