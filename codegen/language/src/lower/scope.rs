//! Values of names in one graph.

use super::curve::Curve;
use super::motion::TimeDerivative;
use crate::algebra::graph::{Edge, NodeId};
use crate::model::value::Value;
use crate::symbols::{Kind, Symbols};
use crate::syntax::ast::{CoordKind, External, Ident, ItemKind, Span, System};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// The names of a description, with those values that are known so far.
#[derive(Clone, Debug)]
pub struct Scope<'a> {
    /// Meaning of each name.
    pub symbols: &'a Symbols<'a>,
    /// For each symbol by index: whether it is defined here, and its value unless the definition was in error.
    values: Vec<Option<Option<Value>>>,
    /// Whether the user wrote constraints, so that coordinates do not move independently.
    constrained: bool,
    /// Whether values are taken off the manifold, so that properties that hold only on it are not checked.
    pub free: bool,
    /// Derivatives of x and ξ, once the rates are known.
    pub motion: Option<TimeDerivative>,
    /// Whether the rates are in error, so that expressions that need them are not reported again.
    pub unmoved: bool,
    /// Derivatives of x along the symbols for ẋ, in definitions of velocities.
    pub rates: Option<TimeDerivative>,
    /// Tables of the description; `None` if they are in error.
    pub tables: BTreeMap<String, Option<Curve>>,
    /// Functions in Rust by name, each with its index in the graph; the indices follow the order of the text.
    pub externals: BTreeMap<String, (usize, External)>,
    /// Calls of functions in Rust: the edge of the first component, and the place of the call.
    pub called: RefCell<Vec<(Edge, Span)>>,
    /// Number of function calls that have been expanded.
    pub calls: Cell<usize>,
    /// Whether a required value was missing, which is an error somewhere.
    pub missed: Cell<bool>,
}

impl<'a> Scope<'a> {
    /// Creates a scope without values.
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

    /// Returns the nodes of all coordinates in ℝ and ℝⁿ, which vary independently of one another; none if the description
    /// has constraints.
    pub fn plain(&self) -> Vec<NodeId> {
        let plain = |kind| matches!(kind, Kind::Coord(CoordKind::Real | CoordKind::Euclidean(_)));
        let symbols = self.symbols.iter();
        let coordinates = symbols.filter(|(_, s)| plain(s.kind) && !self.constrained);
        let values = coordinates.filter_map(|(name, _)| self.value(name));
        let entries = values.flat_map(Value::entries);
        entries.map(Edge::node).collect()
    }

    /// Claims a name whose value follows later. Returns whether the declaration counts: only the first of a name
    /// does, and not if the name is a word of the language.
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

    /// Defines a name, and returns whether it was free.
    pub fn define(&mut self, name: &Ident, kind: Kind, value: Option<Value>) -> bool {
        let free = self.claim(name, kind);
        if free {
            self.set(name, value);
        }
        free
    }

    /// Returns the value of a name, if it is known.
    pub fn value(&self, name: &str) -> Option<&Value> {
        let symbol = self.symbols.get(name)?;
        self.values[symbol.id.index()].as_ref()?.as_ref()
    }
}
