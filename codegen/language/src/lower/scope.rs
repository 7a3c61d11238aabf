//! The values of names in one graph.

use super::curve::Curve;
use super::motion::TimeDerivative;
use crate::algebra::graph::{Edge, NodeId};
use crate::model::value::Value;
use crate::symbols::{Kind, Symbols};
use crate::syntax::ast::{CoordKind, External, Ident, ItemKind, Span, System};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// The names of a description, with their values as far as they are known.
#[derive(Clone, Debug)]
pub struct Scope<'a> {
    /// What the names stand for.
    pub symbols: &'a Symbols<'a>,
    /// By the numbers of the symbols: whether it is defined here, and its value unless its definition was in error.
    values: Vec<Option<Option<Value>>>,
    /// Whether the user wrote constraints, so that no coordinate moves alone.
    constrained: bool,
    /// Whether values are those at points off the variety: what holds on it alone is not checked.
    pub free: bool,
    /// How x and ξ move, once the rates are known.
    pub motion: Option<TimeDerivative>,
    /// Whether the rates are in error: what needs them is no further error.
    pub unmoved: bool,
    /// How x moves along symbols that stand for ẋ, in definitions of velocities.
    pub rates: Option<TimeDerivative>,
    /// The tables of the description; `None` where they are in error.
    pub tables: BTreeMap<String, Option<Curve>>,
    /// The functions in Rust, in the order of the text, each with its place among those of the graph.
    pub externals: BTreeMap<String, (usize, External)>,
    /// Where functions in Rust are called, by the lists of their arguments.
    pub called: RefCell<Vec<(Edge, Span)>>,
    /// How many calls of them have been written out.
    pub calls: Cell<usize>,
    /// Whether a value was wanted that is not known, which is an error somewhere.
    pub missed: Cell<bool>,
}

impl<'a> Scope<'a> {
    /// No values yet.
    pub fn new(system: &System, symbols: &'a Symbols<'a>, free: bool) -> Self {
        let mut items = system.items.iter();
        Scope {
            symbols,
            values: vec![None; symbols.len()],
            constrained: items.any(|item| matches!(item.kind, ItemKind::Constraint { .. })),
            free,
            motion: None,
            unmoved: false,
            rates: None,
            tables: BTreeMap::new(),
            externals: BTreeMap::new(),
            called: RefCell::default(),
            calls: Cell::new(0),
            missed: Cell::new(false),
        }
    }

    /// The coordinates that are a chart by themselves: plain numbers, where no constraint was written.
    pub fn plain(&self) -> Vec<NodeId> {
        let plain = |kind| matches!(kind, Kind::Coord(CoordKind::Real | CoordKind::Euclidean(_)));
        let symbols = self.symbols.iter();
        let coordinates = symbols.filter(|(_, s)| plain(s.kind) && !self.constrained);
        let values = coordinates.filter_map(|(name, _)| self.value(name));
        let entries = values.flat_map(Value::entries);
        entries.map(Edge::node).collect()
    }

    /// Defines a name, its value to follow. Whether it can have one: the first of its declarations can, unless its
    /// name is a word of the language.
    pub fn claim(&mut self, name: &Ident, kind: Kind) -> bool {
        let Some(symbol) = self.symbols.get(&name.name) else {
            return false;
        };
        let value = &mut self.values[symbol.id.index()];
        if symbol.kind != kind || value.is_some() {
            return false;
        }
        *value = Some(None);
        !symbol.refused
    }

    /// Gives a claimed name its value.
    pub fn set(&mut self, name: &Ident, value: Option<Value>) {
        if let Some(symbol) = self.symbols.get(&name.name) {
            self.values[symbol.id.index()] = Some(value);
        }
    }

    /// Defines a name; whether it was free.
    pub fn define(&mut self, name: &Ident, kind: Kind, value: Option<Value>) -> bool {
        let free = self.claim(name, kind);
        if free {
            self.set(name, value);
        }
        free
    }

    /// The value of a name, where it is known.
    pub fn value(&self, name: &str) -> Option<&Value> {
        let symbol = self.symbols.get(name)?;
        self.values[symbol.id.index()].as_ref()?.as_ref()
    }
}
