//! The symbol table.

use crate::syntax::ast::{CoordKind, Function, Span};
use std::collections::BTreeMap;

/// Kind of a symbol.
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
    /// A function of the description, an external function in Rust, or a table.
    Function,
}

impl Kind {
    /// Returns whether the condition of an invariant can set it: an input or a parameter.
    pub fn is_settable(self) -> bool {
        matches!(self, Kind::Input | Kind::Param)
    }

    /// Describes the kind in words.
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

/// Number of a symbol, used as an index for its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SymbolId(usize);

impl SymbolId {
    /// Returns the number.
    pub fn index(self) -> usize {
        self.0
    }
}

/// Meaning of a name in the description: its kind, the place of its first declaration, and the number under which its
/// value is kept. The name itself is the key in [`Symbols`].
#[derive(Clone, Copy, Debug)]
pub struct DeclaredSymbol {
    /// Number.
    pub id: SymbolId,
    /// Kind.
    pub kind: Kind,
    /// Place of its first declaration.
    pub span: Span,
    /// Whether its name is a word of the language. This is reported as an error, and the symbol has no value.
    pub refused: bool,
}

/// The symbols of a description.
#[derive(Clone, Debug, Default)]
pub struct Symbols<'a> {
    names: BTreeMap<&'a str, DeclaredSymbol>,
    /// Outputs. Expressions cannot use them, so they may share their names with other symbols.
    pub outputs: BTreeMap<&'a str, Span>,
    /// Functions of the description that can be called, without those in error.
    pub functions: BTreeMap<&'a str, &'a Function>,
}

impl<'a> Symbols<'a> {
    /// Returns the symbol with a name.
    pub fn get(&self, name: &str) -> Option<&DeclaredSymbol> {
        self.names.get(name)
    }

    /// Returns the kind of the symbol with a name.
    pub fn kind(&self, name: &str) -> Option<Kind> {
        Some(self.names.get(name)?.kind)
    }

    /// Returns whether this is the name of an S1 coordinate, an angle given as a pair (c, s).
    pub fn is_circle(&self, name: &str) -> bool {
        self.kind(name) == Some(Kind::Coord(CoordKind::S1))
    }

    /// Returns the number of symbols.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Returns all symbols in alphabetical order.
    pub fn iter(&self) -> impl Iterator<Item = (&'a str, &DeclaredSymbol)> {
        self.names.iter().map(|(name, symbol)| (*name, symbol))
    }

    /// Adds a symbol whose name is not yet in the table.
    pub(super) fn add(&mut self, name: &'a str, kind: Kind, span: Span, refused: bool) {
        let id = SymbolId(self.names.len());
        let symbol = DeclaredSymbol {
            id,
            kind,
            span,
            refused,
        };
        self.names.insert(name, symbol);
    }
}
