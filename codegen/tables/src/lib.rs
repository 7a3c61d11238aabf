//! The symbols of the formalism as tables for people to read: text, Markdown, LaTeX, JSON.
//!
#![doc = include_str!("../README.md")]
//!
//! | file | owns |
//! |---|---|
//! | `kind` | the kinds of tables, with their symbols, shapes and names |
//! | `error` | reasons why a table is not available |
//! | `collect` | the entries of every table as edges of a graph |
//! | `simplify`, `circles` | the polynomial that is shown for an expression, modulo φ |
//! | `write`, `style` | turns nodes into expressions; shared subexpressions get names |
//! | `naming` | names of shared subexpressions |
//! | `polish` | turns polynomials into expressions, with common factors in front |
//! | `expression` | products, sums, calls |
//! | `listing`, `rows` | entries in order, and grouped by value |
//! | `geometry` | the report on integrable velocities, Lie algebras, symmetries |
//! | `regressor` | base parameters, in all four formats |
//! | `notation`, `print` | names and expressions as text or LaTeX |
//! | `display` | matrices and equations for documents, in LaTeX or MathML |
//! | `text`, `markdown`, `latex`, `json`, `typeset` | output of a whole set of tables |

mod circles;
mod collect;
pub mod display;
mod entries;
mod error;
pub mod expression;
pub mod geometry;
mod json;
pub mod kind;
mod latex;
pub mod listing;
mod markdown;
mod naming;
mod notation;
mod polish;
pub mod print;
pub mod regressor;
mod rows;
mod simplify;
mod style;
mod text;
mod typeset;
mod write;

pub use entries::{Definition, Entry, Group};
pub use error::TableError;
pub use json::json;
pub use kind::Table;
pub use latex::latex;
pub use listing::Listing;
pub use markdown::markdown;
pub use text::text;
pub use typeset::typeset;

use collect::Collector;
use hamel_dynamics::geometry::Inspection;
use hamel_language::model::Model;
use hamel_program::Program;

/// The requested tables of a system, ready to be printed.
#[derive(Clone, Debug)]
pub struct Tables {
    /// Name of the system.
    pub system: String,
    /// Names of x, in order.
    pub coordinates: Vec<String>,
    /// Names of ξ, in order.
    pub velocities: Vec<String>,
    /// The tables, in the order requested.
    pub listings: Vec<Listing>,
    /// The report on the geometry, if requested.
    pub geometry: Option<Inspection>,
}

/// A derived system, from which tables are made.
#[derive(Clone, Copy, Debug)]
pub struct Derivation<'a> {
    /// The system in the full frame.
    pub model: &'a Model,
    /// The system in the independent velocities that remain after constraints are solved.
    pub active: &'a Model,
    /// Its functions.
    pub program: &'a Program,
}

/// Derives tables. If none is requested: all of [`Table::DEFAULT`] that the system has, plus the rates of states if it
/// has states. The error says which table is not available, and why.
pub fn tables(derivation: Derivation, asked: &[Table]) -> Result<Tables, TableError> {
    let model = derivation.model;
    let of = match asked {
        [] if model.states.is_empty() => Table::DEFAULT.to_vec(),
        [] => [&Table::DEFAULT[..], &[Table::States]].concat(),
        of => of.to_vec(),
    };
    let lacking = |table: &Table| table.needs_inertia() && !model.has_inertia;
    let of = match (asked, of.iter().copied().find(lacking)) {
        ([], _) => of.into_iter().filter(|table| !lacking(table)).collect(),
        (_, None) => of,
        (_, Some(table)) => return Err(TableError::NoInertia(table)),
    };
    let mut collector = Collector::new(derivation);
    let mut listings: Vec<Listing> = Vec::new();
    let mut geometry = None;
    for table in of {
        if table == Table::Geometry {
            let inspection = Inspection::new(model);
            geometry = Some(inspection.ok_or(TableError::DependentColumns(table))?);
        } else if listings.iter().all(|known| known.table != table) {
            listings.push(collector.listing(table)?);
        }
    }
    let names = |edges: &[hamel_algebra::graph::Edge]| -> Vec<String> {
        let symbols = model.graph.symbols();
        let of = |node| symbols.iter().find(|symbol| symbol.node == node);
        let named = edges.iter().filter_map(|edge| of(edge.node()));
        named.map(|symbol| symbol.name.clone()).collect()
    };
    Ok(Tables {
        system: model.name.clone(),
        coordinates: names(&model.x),
        velocities: names(&model.xi),
        listings,
        geometry,
    })
}
