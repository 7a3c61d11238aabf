//! Tables as LaTeX, one displayed array each; needs amsmath. The report on the geometry is printed as comments.

use super::entries::{Definition, Entry, Group};
use super::kind::Table;
use super::listing::Listing;
use super::notation::latex_name;
use super::print::{Notation, index};
use super::text::lists_definitions_first;
use super::{Tables, geometry};

/// Prints all tables as LaTeX; if `all`, ungrouped and with zeros.
pub fn latex(tables: &Tables, all: bool) -> String {
    let mut text = format!("% {}\n", tables.system);
    text.push_str(&display(
        "rcl",
        &[
            vector("x", &tables.coordinates),
            vector(r"\xi", &tables.velocities),
        ],
    ));
    for listing in &tables.listings {
        text.push_str(&format!(
            "\n% {}: {}\n",
            listing.table.name(),
            listing.table.title()
        ));
        let before = if lists_definitions_first(listing) {
            &listing.temporaries
        } else {
            &Vec::new()
        };
        let first: Vec<String> = listing
            .constants
            .iter()
            .chain(before)
            .map(definition)
            .collect();
        text.push_str(&display("rcl", &first));
        let (columns, rows) = match listing.table.is_grouped() && !all {
            true => ("lll", groups(listing)),
            false => (
                "rcl",
                listing
                    .entries_to_list(all)
                    .into_iter()
                    .map(|entry| single(listing, entry))
                    .collect(),
            ),
        };
        text.push_str(&display(columns, &rows));
        if !lists_definitions_first(listing) {
            let rest: Vec<String> = listing.temporaries.iter().map(definition).collect();
            text.push_str(&display("rcl", &rest));
        }
    }
    if let Some(inspection) = &tables.geometry {
        text.push_str(&format!("\n% {}\n", Table::Geometry.title()));
        for line in geometry::lines(inspection) {
            text.push_str(&format!("%   {}\n", line.trim_end()));
        }
    }
    text
}

fn display(columns: &str, rows: &[String]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    format!(
        "\\[\n\\begin{{array}}{{{columns}}}\n  {}\n\\end{{array}}\n\\]\n",
        rows.join(" \\\\\n  ")
    )
}

fn vector(symbol: &str, names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| latex_name(name)).collect();
    format!("{symbol} & = & ({})", names.join(", "))
}

fn definition(definition: &Definition) -> String {
    format!(
        "{} & = & {}",
        latex_name(&definition.name),
        Notation::Latex.term(&definition.value)
    )
}

fn groups(listing: &Listing) -> Vec<String> {
    if listing.groups.is_empty() {
        return Vec::new();
    }
    let indices = |list: &[Vec<usize>]| {
        let written: Vec<String> = list
            .iter()
            .map(|entry| index(entry, &listing.shape))
            .collect();
        written.join(r"\;\; ")
    };
    let row = |group: &Group| {
        format!(
            "{} & {} & {}",
            Notation::Latex.term(&group.value),
            indices(&group.plus),
            indices(&group.minus)
        )
    };
    let letters = listing.table.indices().replace('α', r"\alpha ");
    let head = format!(
        r"\text{{value of }} {} & {} & \text{{negative of it}}",
        listing.table.latex(),
        letters
    );
    let ruled = format!("\\hline\n  {}", row(&listing.groups[0]));
    let rest = listing.groups.iter().skip(1).map(row);
    [head, ruled].into_iter().chain(rest).collect()
}

fn single(listing: &Listing, entry: &Entry) -> String {
    let value = Notation::Latex.term(&entry.value);
    let name = left(listing, &entry.index, &entry.label);
    format!("{name} & = & {value}")
}

/// Returns the left-hand side of an entry: its label, or the symbol of the table with the indices.
pub(super) fn left(listing: &Listing, indices: &[usize], label: &str) -> String {
    let subscript = index(indices, &listing.shape);
    match listing.table {
        _ if !label.is_empty() => latex_name(label),
        Table::PotentialForce => format!(r"\partial_{{{subscript}}} V"),
        // The third index of γ is a superscript.
        Table::Gamma => match indices.split_last() {
            Some((above, below)) => format!(
                r"\gamma_{{{}}}{{}}^{{{above}}}",
                index(below, &listing.shape)
            ),
            None => r"\gamma".into(),
        },
        table => format!("{}_{{{subscript}}}", table.latex()),
    }
}
