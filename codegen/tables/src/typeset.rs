//! Tables as JSON with formulas in LaTeX, for web pages that typeset them.
//!
//! `{ "system", "coordinates", "velocities", "tables": [{ "name", "symbol", "title", "size", "nonzero", "groups":
//! [{ "value", "plus", "minus" }], "entries": [{ "left", "value", "reads" }], "before", "after" }] }`. In groups,
//! `plus` and `minus` are lists of `{ "index", "left" }`; temporaries are listed in `before` or `after` the entries.

use super::Tables;
use super::entries::Definition;
use super::latex::left;
use super::listing::Listing;
use super::notation::latex_name;
use super::print::{Notation, index};
use super::text::lists_definitions_first;
use serde_json::{Value, json};

/// Returns all tables; entries with equal values are grouped in the kinds of tables that read best that way.
pub fn typeset(tables: &Tables) -> Value {
    let names = |list: &[String]| -> Vec<String> { list.iter().map(|n| latex_name(n)).collect() };
    json!({
        "system": tables.system,
        "coordinates": names(&tables.coordinates),
        "velocities": names(&tables.velocities),
        "tables": tables.listings.iter().map(table).collect::<Vec<Value>>(),
    })
}

fn table(listing: &Listing) -> Value {
    let grouped = listing.table.is_grouped();
    let named = |list: &[Vec<usize>]| -> Vec<Value> {
        let one = |at: &Vec<usize>| json!({ "index": index(at, &listing.shape), "left": left(listing, at, "") });
        list.iter().map(one).collect()
    };
    let groups = listing.groups.iter().filter(|_| grouped).map(|group| {
        json!({
            "value": Notation::Latex.term(&group.value),
            "plus": named(&group.plus),
            "minus": named(&group.minus),
        })
    });
    let entries = listing
        .entries_to_list(false)
        .into_iter()
        .filter(|_| !grouped);
    let entries = entries.map(|entry| {
        json!({
            "left": left(listing, &entry.index, &entry.label),
            "value": Notation::Latex.term(&entry.value),
            "reads": entry.reads,
        })
    });
    let first = listing.constants.iter();
    let (before, after): (Vec<&Definition>, Vec<&Definition>) =
        match lists_definitions_first(listing) {
            true => (first.chain(&listing.temporaries).collect(), Vec::new()),
            false => (first.collect(), listing.temporaries.iter().collect()),
        };
    json!({
        "name": listing.table.name(),
        "symbol": listing.table.latex(),
        "title": listing.table.title(),
        "size": listing.size(),
        "nonzero": listing.entries.len(),
        "groups": groups.collect::<Vec<Value>>(),
        "entries": entries.collect::<Vec<Value>>(),
        "before": definitions(&before),
        "after": definitions(&after),
    })
}

fn definitions(list: &[&Definition]) -> Vec<Value> {
    let one = |definition: &&Definition| {
        json!({
            "left": latex_name(&definition.name),
            "value": Notation::Latex.term(&definition.value),
        })
    };
    list.iter().map(one).collect()
}
