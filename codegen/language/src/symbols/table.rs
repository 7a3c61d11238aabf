//! The table of symbols.

use crate::syntax::ast::{CoordKind, Function, Span};
use std::collections::BTreeMap;

/// What kind of thing a name is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A run-time parameter.
    Param,
    /// A build-time constant.
    Const,
    /// A named expression.
    Let,
    /// A coordinate.
    Coord(CoordKind),
    /// A velocity coordinate.
    Velocity,
    /// A run-time input.
    Input,
    /// A state of first order.
    State,
    /// A frame.
    Frame,
    /// A function of expressions, one in Rust, or a table.
    Function,
}

impl Kind {
    /// Whether a claim can set it: an input or a parameter.
    pub fn is_settable(self) -> bool {
        matches!(self, Kind::Input | Kind::Param)
    }

    /// The kind in words.
    pub fn describe(self) -> &'static str {
        match self {
            Kind::Param => "a parameter",
            Kind::Const => "a constant",
            Kind::Let => "a named expression",
            Kind::Coord(_) => "a coordinate",
            Kind::Velocity => "a velocity",
            Kind::Input => "an input",
            Kind::State => "a state",
            Kind::Frame => "a frame",
            Kind::Function => "a function",
        }
    }
}

/// The number of a symbol, by which values are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SymbolId(usize);

impl SymbolId {
    /// The number.
    pub fn index(self) -> usize {
        self.0
    }
}

/// One name.
#[derive(Clone, Copy, Debug)]
pub struct Symbol {
    /// Its number.
    pub id: SymbolId,
    /// What kind of thing it is.
    pub kind: Kind,
    /// Where it was first declared.
    pub span: Span,
    /// Whether it has a word of the language for a name, and therefore no value.
    pub refused: bool,
}

/// The names of a description.
#[derive(Clone, Debug, Default)]
pub struct Symbols<'a> {
    names: BTreeMap<&'a str, Symbol>,
    /// The outputs, which expressions cannot use; they may share their names with expressions.
    pub outputs: BTreeMap<&'a str, Span>,
    /// The functions of the description that can be called.
    pub functions: BTreeMap<&'a str, &'a Function>,
}

impl<'a> Symbols<'a> {
    /// The symbol of a name.
    pub fn get(&self, name: &str) -> Option<&Symbol> {
        self.names.get(name)
    }

    /// What kind of thing a name is.
    pub fn kind(&self, name: &str) -> Option<Kind> {
        Some(self.names.get(name)?.kind)
    }

    /// Whether this is the name of a coordinate that is an angle, as a pair (c, s).
    pub fn is_circle(&self, name: &str) -> bool {
        self.kind(name) == Some(Kind::Coord(CoordKind::S1))
    }

    /// How many symbols there are.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// All names in alphabetical order.
    pub fn iter(&self) -> impl Iterator<Item = (&'a str, &Symbol)> {
        self.names.iter().map(|(name, symbol)| (*name, symbol))
    }

    /// Takes a name that is free.
    pub(super) fn add(&mut self, name: &'a str, kind: Kind, span: Span, refused: bool) {
        let id = SymbolId(self.names.len());
        let symbol = Symbol {
            id,
            kind,
            span,
            refused,
        };
        self.names.insert(name, symbol);
    }
}
