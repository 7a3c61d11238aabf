//! Tables as displayed mathematics in LaTeX or MathML, with matrices where a table is one.
//!
//! A matrix of more than twelve rows or columns is listed by its nonzero entries. An entry whose text is
//! longer than its limit stands in the matrix by its symbol, and is defined below it.

use super::entries::{Definition, Entry};
use super::kind::Table;
use super::latex;
use super::listing::Listing;
use super::notation::mathml_name;
use super::print::{Notation, index};
use super::text::lists_definitions_first;

/// Number of rows and columns up to which a table is displayed as a matrix.
const MAX_MATRIX_SIZE: usize = 12;
/// Number of signs up to which an entry is written into its matrix.
const MAX_ENTRY_LENGTH: usize = 40;
/// Number of signs up to which a row of a matrix fits the width of a page; in wider matrices short entries remain.
const MAX_ROW_LENGTH: usize = 80;
/// Number of signs up to which an entry is written into a matrix with wider rows.
const MAX_SHORT_LENGTH: usize = 12;

/// Displayed mathematics, each piece in one notation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Display {
    /// An equation between a symbol and a matrix, given by rows. In a symmetric matrix, entries below the diagonal are
    /// empty.
    Matrix {
        /// The symbol on the left.
        symbol: String,
        /// Entries by rows.
        rows: Vec<Vec<String>>,
    },
    /// Equations below one another: left and right sides.
    Equations(Vec<[String; 2]>),
}

/// Returns the displays of a table, in order; empty if all entries are zero.
pub fn displays(listing: &Listing, notation: Notation) -> Vec<Display> {
    if listing.entries.is_empty() && !matches!(listing.table, Table::States | Table::Outputs) {
        return Vec::new();
    }
    let (rows, beside) = match matrix(listing, notation) {
        Some((rows, beside)) => (Some(rows), beside),
        None => (None, listing.entries_to_list(false)),
    };
    let entries = beside.into_iter().map(|entry| {
        let value = notation.term(&entry.value);
        [left(listing, entry, notation), value]
    });
    let defined = |list: &[Definition]| -> Vec<[String; 2]> {
        let one = |it: &Definition| [notation.name(&it.name), notation.term(&it.value)];
        list.iter().map(one).collect()
    };
    let (constants, temporaries) = (defined(&listing.constants), defined(&listing.temporaries));
    let entries: Vec<[String; 2]> = entries.collect();
    let lists = match lists_definitions_first(listing) {
        true => [constants, temporaries, entries],
        false => [constants, entries, temporaries],
    };
    let symbol = symbol(listing.table, notation);
    let matrix = rows.map(|rows| Display::Matrix { symbol, rows });
    let lists = lists.into_iter().filter(|list| !list.is_empty());
    matrix
        .into_iter()
        .chain(lists.map(Display::Equations))
        .collect()
}

/// Returns the rows of a matrix, and the entries that are too long to stand in it; `None` if the table is no matrix of
/// moderate size.
fn matrix(listing: &Listing, notation: Notation) -> Option<(Vec<Vec<String>>, Vec<&Entry>)> {
    let [rows, columns] = listing.shape[..] else {
        return None;
    };
    if rows.max(columns) > MAX_MATRIX_SIZE {
        return None;
    }
    let is_symmetric = listing.table == Table::Mass;
    let length = |entry: &Entry| signs(&Notation::Latex.term(&entry.value));
    let is_wide = (1..=rows).any(|row| {
        let of_row = listing.entries.iter().filter(|it| it.index[0] == row);
        of_row.map(length).sum::<usize>() > MAX_ROW_LENGTH
    });
    let limit = match is_wide {
        true => MAX_SHORT_LENGTH,
        false => MAX_ENTRY_LENGTH,
    };
    let zero = notation.zero();
    let mut cells = vec![vec![zero; columns]; rows];
    let mut beside = Vec::new();
    for entry in listing.entries_to_list(false) {
        let [row, column] = entry.index[..] else {
            return None;
        };
        let cell = cells.get_mut(row - 1)?.get_mut(column - 1)?;
        if is_symmetric && column < row {
            continue;
        }
        *cell = match length(entry) > limit {
            true => {
                beside.push(entry);
                left(listing, entry, notation)
            }
            false => notation.term(&entry.value),
        };
    }
    if is_symmetric {
        for (row, cells) in cells.iter_mut().enumerate() {
            cells[..row].fill(String::new());
        }
    }
    Some((cells, beside))
}

/// Returns the approximate number of signs that LaTeX shows for a formula.
pub fn signs(formula: &str) -> usize {
    let mut count = 0;
    let mut is_command = false;
    for letter in formula.chars() {
        let goes_on = is_command && letter.is_ascii_alphabetic();
        is_command = goes_on || letter == '\\';
        count += usize::from(!goes_on && !"{}_^ ".contains(letter));
    }
    count
}

/// Returns the left-hand side of an entry.
fn left(listing: &Listing, entry: &Entry, notation: Notation) -> String {
    if notation != Notation::MathMl {
        return latex::left(listing, &entry.index, &entry.label);
    }
    let below = index(&entry.index, &listing.shape);
    let symbol = symbol(listing.table, notation);
    match listing.table {
        _ if !entry.label.is_empty() => mathml_name(&entry.label),
        Table::PotentialForce => format!("<msub><mo>∂</mo><mn>{below}</mn></msub><mi>V</mi>"),
        Table::Gamma => match entry.index.split_last() {
            Some((above, below)) => format!(
                "<msubsup>{symbol}<mn>{}</mn><mn>{above}</mn></msubsup>",
                index(below, &listing.shape)
            ),
            None => symbol,
        },
        _ => format!("<msub>{symbol}<mn>{below}</mn></msub>"),
    }
}

/// Returns the symbol of a table.
fn symbol(table: Table, notation: Notation) -> String {
    match (notation, table) {
        (Notation::MathMl, Table::Accel) => "<mover><mi>ξ</mi><mo>˙</mo></mover>".into(),
        (Notation::MathMl, Table::States) => "<mover><mi>z</mi><mo>˙</mo></mover>".into(),
        (Notation::MathMl, table) => format!("<mi>{}</mi>", table.symbol()),
        (Notation::Text, table) => table.symbol().into(),
        (Notation::Latex, table) => table.latex().into(),
    }
}
