//! Tables as plain text for a terminal.

use super::entries::{Definition, Entry, Group};
use super::listing::Listing;
use super::print::{Notation, index};
use super::{Table, Tables, geometry};

/// Largest width of a value that counts for the alignment of the indices after it.
const MAX_ALIGNED_WIDTH: usize = 60;

/// Prints all tables as text; if `all`, ungrouped and with zeros.
pub fn text(tables: &Tables, all: bool) -> String {
    let mut text = format!("{}\n", tables.system);
    text.push_str(&format!("x = ({})\n", tables.coordinates.join(", ")));
    text.push_str(&format!("ξ = ({})\n", tables.velocities.join(", ")));
    for listing in &tables.listings {
        text.push_str(&format!(
            "\n{}: {}\n",
            listing.table.name(),
            listing.table.title()
        ));
        text.push_str(&format!("  {}\n", summary(listing)));
        let lines = match listing.table.is_grouped() && !all {
            true => grouped(listing),
            false => single(listing, all),
        };
        for line in definitions(&listing.constants).into_iter().chain(lines) {
            text.push_str(&format!("  {}\n", line.trim_end()));
        }
        if !listing.temporaries.is_empty() && !lists_definitions_first(listing) {
            text.push_str("  where\n");
            for line in definitions(&listing.temporaries) {
                text.push_str(&format!("    {line}\n"));
            }
        }
    }
    if let Some(inspection) = &tables.geometry {
        text.push_str(&format!(
            "\n{}: {}\n",
            Table::Geometry.name(),
            Table::Geometry.title()
        ));
        for line in geometry::lines(inspection) {
            text.push_str(&format!("  {}\n", line.trim_end()));
        }
    }
    text
}

/// Whether temporaries are listed before the entries that use them, as in straight-line code.
pub fn lists_definitions_first(listing: &Listing) -> bool {
    listing.table == Table::Accel
}

/// Prints the size of a table, such as `6×6×6, 48 of 216 nonzero`.
pub fn summary(listing: &Listing) -> String {
    let sizes: Vec<String> = listing.shape.iter().map(usize::to_string).collect();
    let size = match sizes.as_slice() {
        [_] if listing.size() == 1 => "1 entry".to_string(),
        [_] => format!("{} entries", listing.size()),
        _ => sizes.join("×"),
    };
    match (listing.entries.len(), listing.size()) {
        (_, 0) => "none".into(),
        (0, _) => format!("{size}, all zero"),
        (nonzero, all) if nonzero == all => size,
        (nonzero, all) => format!("{size}, {nonzero} of {all} nonzero"),
    }
}

/// Prints the indices of some entries, such as `135 216 324`.
pub fn indices(list: &[Vec<usize>], shape: &[usize]) -> String {
    let written: Vec<String> = list.iter().map(|entry| index(entry, shape)).collect();
    written.join(" ")
}

/// Returns the left-hand side of an entry: `gamma[1,2,3]`, or its own name.
pub fn label(listing: &Listing, entry: &Entry) -> String {
    if entry.label.is_empty() {
        let digits: Vec<String> = entry.index.iter().map(usize::to_string).collect();
        return format!("{}[{}]", listing.table.name(), digits.join(","));
    }
    entry.label.clone()
}

fn definitions(list: &[Definition]) -> Vec<String> {
    let line = |definition: &Definition| {
        format!(
            "{} = {}",
            definition.name,
            Notation::Text.term(&definition.value)
        )
    };
    list.iter().map(line).collect()
}

fn single(listing: &Listing, all: bool) -> Vec<String> {
    let before = if lists_definitions_first(listing) {
        definitions(&listing.temporaries)
    } else {
        Vec::new()
    };
    let entries = listing.entries_to_list(all);
    let labels: Vec<String> = entries.iter().map(|entry| label(listing, entry)).collect();
    let width = labels
        .iter()
        .map(|label| label.chars().count())
        .max()
        .unwrap_or(0);
    let lines = entries.iter().zip(&labels).map(|(entry, label)| {
        let value = Notation::Text.term(&entry.value);
        if entry.reads.is_empty() {
            format!("{label:width$} = {value}")
        } else {
            format!("{label:width$}: {value} = 0    ({})", entry.reads)
        }
    });
    before.into_iter().chain(lines).collect()
}

fn grouped(listing: &Listing) -> Vec<String> {
    if listing.groups.is_empty() {
        return Vec::new();
    }
    let row = |group: &Group| {
        [
            Notation::Text.term(&group.value),
            indices(&group.plus, &listing.shape),
            indices(&group.minus, &listing.shape),
        ]
    };
    let mut rows: Vec<[String; 3]> = listing.groups.iter().map(row).collect();
    let signed = listing.groups.iter().any(|group| !group.minus.is_empty());
    let last = if signed { "negative of it" } else { "" };
    rows.insert(
        0,
        ["value".into(), listing.table.indices().into(), last.into()],
    );
    let width = |column: usize| {
        let widths = rows.iter().map(|row| row[column].chars().count());
        widths
            .filter(|&width| width <= MAX_ALIGNED_WIDTH)
            .max()
            .unwrap_or(0)
    };
    let (first, second) = (width(0), width(1));
    rows.iter()
        .map(|[value, plus, minus]| format!("{value:first$}  {plus:second$}  {minus}"))
        .collect()
}
