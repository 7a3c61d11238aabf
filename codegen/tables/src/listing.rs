//! The entries of a table, in order of their indices and grouped by value as in KR18 (45).

use super::entries::{Cell, Definition, Entry, Group};
use super::expression::Term;
use super::kind::Table;
use super::naming::Temporaries;
use super::polish::reads_better_negated;
use super::rows::{Row, order, rows};
use super::simplify::Simplifier;
use super::style::Style;
use super::write::Writer;
use hamel_algebra::graph::{Edge, Graph};
use num_rational::BigRational;

/// One table with its entries.
#[derive(Clone, Debug, PartialEq)]
pub struct Listing {
    /// Kind of the table.
    pub table: Table,
    /// Its sizes, one for each index.
    pub shape: Vec<usize>,
    /// All nonzero entries, sorted by index.
    pub entries: Vec<Entry>,
    /// All zero entries, sorted by index.
    pub zeros: Vec<Entry>,
    /// The nonzero entries, grouped by value.
    pub groups: Vec<Group>,
    /// Temporaries that depend on parameters alone; only for the generated code's ξ̇.
    pub constants: Vec<Definition>,
    /// Other temporaries.
    pub temporaries: Vec<Definition>,
}

impl Listing {
    /// Returns the entries to list one by one. Zero entries are included if `all`, or if each entry
    /// has a name of its own.
    pub fn entries_to_list(&self, all: bool) -> Vec<&Entry> {
        let mut listed: Vec<&Entry> = self.entries.iter().collect();
        if all || matches!(self.table, Table::Accel | Table::States | Table::Outputs) {
            listed.extend(&self.zeros);
        }
        listed.sort_by(|a, b| a.index.cmp(&b.index));
        listed
    }

    /// Total number of entries, zero or not.
    pub fn size(&self) -> usize {
        self.entries.len() + self.zeros.len()
    }
}

/// Writes the cells of a table as expressions; `user_names` are the values that the user named.
pub fn listing(
    table: Table,
    shape: Vec<usize>,
    cells: &[Cell],
    graph: &Graph,
    simplifier: &mut Simplifier,
    user_names: &[(String, Edge)],
) -> Listing {
    let (mut rows, places) = rows(cells, graph);
    let roots: Vec<Edge> = rows.iter().map(|row| row.edge).collect();
    let style = if table == Table::Accel {
        Style::Route
    } else {
        Style::Table
    };
    let names = Temporaries::new(graph, &roots, user_names);
    let mut writer = Writer::new(graph, simplifier, style, names);
    writer.prepare(&roots);
    let mut flipped = vec![false; rows.len()];
    for (row, flip) in rows.iter_mut().zip(&mut flipped) {
        row.polynomial = writer.polynomial(row.edge);
        *flip = match &row.polynomial {
            Some(polynomial) => reads_better_negated(polynomial),
            None => row.edge.is_negative(),
        };
        row.edge = row.edge.signed(*flip);
        match row
            .polynomial
            .take()
            .map(|p| if *flip { p.neg() } else { p })
        {
            Some(polynomial) => {
                row.value = writer.polish(&polynomial);
                row.opposite = writer.polish(&polynomial.neg());
                row.polynomial = Some(polynomial);
            }
            None => {
                row.value = writer.value(row.edge);
                row.opposite = writer.value(-row.edge);
            }
        }
    }
    let (mut entries, mut zeros) = (Vec::new(), Vec::new());
    for (cell, place) in cells.iter().zip(&places) {
        let Some((place, negative)) = *place else {
            zeros.push(cell.entry(Term::number(BigRational::default())));
            continue;
        };
        let row = &mut rows[place];
        let negative = negative ^ flipped[place];
        let side = if negative {
            &mut row.minus
        } else {
            &mut row.plus
        };
        side.push(cell.index.clone());
        let value = if negative { &row.opposite } else { &row.value };
        entries.push(cell.entry(value.clone()));
    }
    rows.sort_by(order);
    let groups = rows.into_iter().map(Row::group);
    let (constants, temporaries) = writer.definitions();
    Listing {
        table,
        shape,
        entries,
        zeros,
        groups: groups.collect(),
        constants,
        temporaries,
    }
}
