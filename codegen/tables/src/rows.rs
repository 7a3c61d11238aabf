//! Rows of a table: entries with one value up to its sign.

use super::entries::{Cell, Group};
use super::expression::Term;
use super::polish::sorted;
use hamel_algebra::fp::Fp;
use hamel_algebra::graph::{Edge, Graph, NodeId};
use hamel_algebra::poly::polynomial::Poly;
use num_rational::BigRational;
use num_traits::Signed;
use rustc_hash::FxHashMap;
use std::cmp::Ordering;

/// One value up to its sign.
pub struct Row {
    /// The value as an edge.
    pub edge: Edge,
    /// The value.
    pub value: Term,
    /// Its negative.
    pub opposite: Term,
    /// The value as a polynomial, where it is shown as one.
    pub polynomial: Option<Poly<BigRational>>,
    /// Indices of the entries that have it.
    pub plus: Vec<Vec<usize>>,
    /// Indices of those that have its negative.
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

    /// The row as it is shown: where only the negative occurs, that is the value.
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

/// What tells rows apart.
#[derive(PartialEq, Eq, Hash)]
enum Key {
    Value(Fp),
    Node(NodeId),
}

/// For every cell that is not zero its row, and whether it has the row's negative. Values are equal
/// where they agree at the graph's point, or with square roots below them are one node; the expression without coordinates
/// is kept.
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
        // Nodes that the graph does not merge are their own key.
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

/// Polynomials before the rest, short ones first, then by their symbols and signs.
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
