//! Tables as JSON.
//!
//! `{ "hamel": version, "system", "coordinates", "velocities", "tables": { name: { "symbol", "shape",
//! "nonzero", "entries": [{ "index", "value" }], "groups": [{ "value", "plus", "minus" }],
//! "constants": [{ "name", "value" }], "temporaries": [{ "name", "value" }] } } }`. Entries of φ also
//! have `reads`, and entries with a name of their own have `name`. If the report on the geometry was
//! requested, it is in `geometry`, in the format that the module `geometry` describes.

use super::entries::{Definition, Entry, Group};
use super::listing::Listing;
use super::print::Notation;
use super::{Tables, geometry};
use serde_json::{Value, json as object};

/// Returns all tables as JSON; if `all`, the entries include those that are zero.
pub fn json(tables: &Tables, all: bool) -> Value {
    let listings = tables.listings.iter();
    let listings = listings.map(|listing| (listing.table.name().to_string(), table(listing, all)));
    let mut all = object!({
        "hamel": env!("CARGO_PKG_VERSION"),
        "system": tables.system,
        "coordinates": tables.coordinates,
        "velocities": tables.velocities,
        "tables": Value::Object(listings.collect()),
    });
    if let (Some(inspection), Value::Object(fields)) = (&tables.geometry, &mut all) {
        fields.insert("geometry".into(), geometry::json(inspection));
    }
    all
}

fn table(listing: &Listing, all: bool) -> Value {
    let listed = listing.entries_to_list(all).into_iter();
    object!({
        "symbol": listing.table.symbol(),
        "shape": listing.shape,
        "nonzero": listing.entries.len(),
        "entries": listed.map(entry).collect::<Vec<Value>>(),
        "groups": listing.groups.iter().map(group).collect::<Vec<Value>>(),
        "constants": listing.constants.iter().map(definition).collect::<Vec<Value>>(),
        "temporaries": listing.temporaries.iter().map(definition).collect::<Vec<Value>>(),
    })
}

fn entry(entry: &Entry) -> Value {
    let mut value = object!({ "index": entry.index, "value": Notation::Text.term(&entry.value) });
    if let Value::Object(fields) = &mut value {
        let named = [("name", &entry.label), ("reads", &entry.reads)];
        for (key, text) in named.into_iter().filter(|(_, text)| !text.is_empty()) {
            fields.insert(key.into(), Value::String(text.clone()));
        }
    }
    value
}

fn group(group: &Group) -> Value {
    object!({ "value": Notation::Text.term(&group.value), "plus": group.plus, "minus": group.minus })
}

fn definition(definition: &Definition) -> Value {
    object!({ "name": definition.name, "value": Notation::Text.term(&definition.value) })
}
