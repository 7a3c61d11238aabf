//! Statements that stand for others: repetition, components and their parts.

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
    /// The region of all of it.
    pub fn span(&self) -> Span {
        self.name.span.to(self.last.span)
    }
}

/// `for i in 1..n { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Repeat {
    /// What counts.
    pub counter: Counter,
    /// The statements that are repeated.
    pub items: Vec<Item>,
}

/// `component Leg(mount: frame, side = 1) { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its name.
    pub name: Ident,
    /// What a part has to say of itself.
    pub parameters: Vec<Parameter>,
    /// Its statements.
    pub items: Vec<Item>,
}

/// `mount: frame`, `hip: vec3` or `side = 1` of a component.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in the component.
    pub name: Ident,
    /// Whether it stands for a frame, else for an expression.
    pub frame: bool,
    /// The shape that the expression has to have, where one is written.
    pub shape: Option<Shape>,
    /// What it is where a part does not say.
    pub default: Option<Expr>,
}

/// `part left = Leg(hip, side = -1);` or `part leg[i in 1..6] = Leg(mount[i]);`
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name, as written.
    pub name: Ident,
    /// The counter of an array of parts.
    pub counter: Option<Counter>,
    /// The component that it is one of.
    pub component: Ident,
    /// What its parameters are.
    pub arguments: Vec<Argument>,
}

/// An argument of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// The name of the parameter, where it is written.
    pub name: Option<Ident>,
    /// Its value; a frame by its name.
    pub value: Expr,
}
