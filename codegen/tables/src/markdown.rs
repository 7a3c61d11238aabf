//! Tables as Markdown, with expressions in code spans.

use super::entries::Definition;
use super::listing::Listing;
use super::print::Notation;
use super::text::{indices, label, lists_definitions_first, summary};
use super::{Table, Tables, geometry};

/// Prints all tables as Markdown; if `all`, ungrouped and with zeros.
pub fn markdown(tables: &Tables, all: bool) -> String {
    let mut text = format!("# {}\n\n", tables.system);
    text.push_str(&format!(
        "x = ({}), ξ = ({})\n",
        spans(&tables.coordinates),
        spans(&tables.velocities)
    ));
    for listing in &tables.listings {
        let table = listing.table;
        text.push_str(&format!(
            "\n## {}: {}\n\n{}\n",
            table.symbol(),
            table.title(),
            summary(listing)
        ));
        block(&mut text, "Constants:", &listing.constants);
        if lists_definitions_first(listing) {
            block(&mut text, "Temporaries:", &listing.temporaries);
        }
        let grouped = table.is_grouped() && !all;
        let rows = if grouped {
            groups(listing)
        } else {
            entries(listing, all)
        };
        if !rows.is_empty() {
            let head = match (grouped, table == Table::Phi) {
                (true, _) => format!(
                    "| value | {} | negative of it |\n|---|---|---|\n",
                    table.indices()
                ),
                (false, true) => "| entry | value, = 0 | as described |\n|---|---|---|\n".into(),
                (false, false) => "| entry | value |\n|---|---|\n".into(),
            };
            text.push_str(&format!("\n{head}{}", rows.concat()));
        }
        if !lists_definitions_first(listing) {
            block(&mut text, "where", &listing.temporaries);
        }
    }
    if let Some(inspection) = &tables.geometry {
        text.push_str(&format!("\n## {}\n\n```text\n", Table::Geometry.title()));
        for line in geometry::lines(inspection) {
            text.push_str(&format!("{}\n", line.trim_end()));
        }
        text.push_str("```\n");
    }
    text
}

fn spans(names: &[String]) -> String {
    let spans: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    spans.join(", ")
}

fn block(text: &mut String, head: &str, definitions: &[Definition]) {
    if definitions.is_empty() {
        return;
    }
    text.push_str(&format!("\n{head}\n\n```text\n"));
    for definition in definitions {
        text.push_str(&format!(
            "{} = {}\n",
            definition.name,
            Notation::Text.term(&definition.value)
        ));
    }
    text.push_str("```\n");
}

fn groups(listing: &Listing) -> Vec<String> {
    let row = |group: &super::Group| {
        let value = Notation::Text.term(&group.value);
        let (plus, minus) = (
            indices(&group.plus, &listing.shape),
            indices(&group.minus, &listing.shape),
        );
        format!("| `{value}` | {plus} | {minus} |\n")
    };
    listing.groups.iter().map(row).collect()
}

fn entries(listing: &Listing, all: bool) -> Vec<String> {
    let row = |entry: &super::Entry| {
        let value = Notation::Text.term(&entry.value);
        let reads = if entry.reads.is_empty() {
            String::new()
        } else {
            format!(" `{}` |", entry.reads)
        };
        format!("| `{}` | `{value}` |{reads}\n", label(listing, entry))
    };
    listing.entries_to_list(all).into_iter().map(row).collect()
}
