//! Rows of a table: entries that have the same value up to sign.

use super::entries::{Cell, Group};
use super::expression::Term;
use super::polish::sorted;
use hamel_algebra::graph::{Edge, Graph, NodeId};
use hamel_algebra::poly::polynomial::Poly;
use hamel_algebra::residue_pair::ResiduePair;
use num_rational::BigRational;
use num_traits::Signed;
use rustc_hash::FxHashMap;
use std::cmp::Ordering;

/// A value of one or more entries, up to sign.
pub struct Row {
    /// The value as an edge.
    pub edge: Edge,
    /// The value as an expression.
    pub value: Term,
    /// The negative of the value as an expression.
    pub opposite: Term,
    /// The value as a polynomial, if it is shown as one.
    pub polynomial: Option<Poly<BigRational>>,
    /// Indices of the entries with this value.
    pub plus: Vec<Vec<usize>>,
    /// Indices of the entries with the negative of this value.
    pub minus: Vec<Vec<usize>>,
}

impl Row {
    fn new(edge: Edge) -> Self {
        Row {
            edge,
            value: Term::number(BigRational::default()),
            opposite: Term::number(BigRational::default()),
            polynomial: None,
            plus: Vec::new(),
            minus: Vec::new(),
        }
    }

    /// Returns the row as it is shown: if only the negative occurs, the negative becomes the value.
    pub fn group(self) -> Group {
        if self.plus.is_empty() {
            return Group {
                value: self.opposite,
                plus: self.minus,
                minus: Vec::new(),
            };
        }
        Group {
            value: self.value,
            plus: self.plus,
            minus: self.minus,
        }
    }
}

/// Key by which entries are assigned to rows.
#[derive(PartialEq, Eq, Hash)]
enum Key {
    Value(ResiduePair),
    Node(NodeId),
}

/// Assigns each nonzero cell to a row, and tells whether it has the negative of the row's value; `None` for zero cells.
/// Two values are equal if they agree at the graph's point; if they contain square roots, they must be the same node.
/// Of equal expressions, the row keeps one that is constant at run time if there is one.
pub fn rows(cells: &[Cell], graph: &Graph) -> (Vec<Row>, Vec<Option<(usize, bool)>>) {
    let mut rows: Vec<Row> = Vec::new();
    let mut known: FxHashMap<Key, (usize, bool)> = FxHashMap::default();
    let mut places = Vec::new();
    for cell in cells {
        if cell.edge == graph.zero() || cell.edge == -graph.zero() {
            places.push(None);
            continue;
        }
        let value = graph.value(cell.edge);
        // These cannot be told apart by value, and the graph does not merge them: the node is the key.
        let (key, negative) = if value.is_zero() || graph.has_root_below(cell.edge) {
            (Key::Node(cell.edge.node()), cell.edge.is_negative())
        } else if value.is_negative() {
            (Key::Value(-value), true)
        } else {
            (Key::Value(value), false)
        };
        let edge = cell.edge.signed(negative);
        let place = match known.get(&key) {
            Some((place, _)) => *place,
            None => {
                rows.push(Row::new(edge));
                known.insert(key, (rows.len() - 1, negative));
                rows.len() - 1
            }
        };
        if graph.is_free(edge.node()) && !graph.is_free(rows[place].edge.node()) {
            rows[place].edge = edge;
        }
        places.push(Some((place, negative)));
    }
    (rows, places)
}

/// Order of rows: polynomials first, short ones before long ones, then by symbols, signs and numbers.
pub fn order(a: &Row, b: &Row) -> Ordering {
    let first = |row: &Row| {
        row.plus
            .first()
            .into_iter()
            .chain(row.minus.first())
            .min()
            .cloned()
    };
    let by_index = || first(a).cmp(&first(b));
    let (left, right) = match (&a.polynomial, &b.polynomial) {
        (Some(left), Some(right)) => (sorted(left), sorted(right)),
        (None, None) => return by_index(),
        (left, _) => {
            return if left.is_some() {
                Ordering::Less
            } else {
                Ordering::Greater
            };
        }
    };
    let symbols = left
        .iter()
        .map(|(m, _)| m.powers())
        .cmp(right.iter().map(|(m, _)| m.powers()));
    let numbers = || {
        let key = |c: &BigRational| (c.is_negative(), c.abs());
        left.iter()
            .map(|(_, c)| key(c))
            .cmp(right.iter().map(|(_, c)| key(c)))
    };
    left.len()
        .cmp(&right.len())
        .then(symbols)
        .then_with(numbers)
        .then_with(by_index)
}
