//! A wrong sign in any entry of a symbol breaks an identity, which is named.

use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::proof::check::failed_identities;
use hamel_codegen::proof::forms::ComparedQuantities;
use std::path::Path;

/// Constant and varying γ, constant and varying M, bodies, particles, a given T, and all kinds of loads.
const MODELS: [&str; 6] = [
    "free_body",
    "heavy_top_world",
    "planar_world",
    "polar_particle",
    "hoop_bead",
    "spherical_orthonormal",
];

fn model(name: &str) -> Generated {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    let text = std::fs::read_to_string(path).expect("the model is in the repository");
    from_text(&text).unwrap_or_else(|errors| panic!("{name}: {errors:?}"))
}

/// Selects an entry of a symbol with at most three indices.
type Entry = for<'a> fn(&'a mut ComparedQuantities, usize, usize, usize) -> &'a mut Edge;

/// Flips the sign of every nonzero entry in turn; each flip must break all of `broken`. Returns the number of flips.
fn flips(name: &str, symbol: &str, rank: u32, entry: Entry, broken: &[&str]) -> usize {
    let Generated { model, program, .. } = model(name);
    let symbols = ComparedQuantities::new(&model).expect("Y");
    assert!(failed_identities(&model, &program, symbols.clone()).is_empty());
    let (n, zero) = (model.n(), model.graph.zero().node());
    let mut flipped = 0;
    for place in 0..n.pow(rank) {
        let (i, j, k) = (place % n, place / n % n, place / (n * n));
        let mut wrong = symbols.clone();
        let edge = entry(&mut wrong, i, j, k);
        if edge.node() == zero {
            continue;
        }
        *edge = -*edge;
        flipped += 1;
        let failed: Vec<&str> = failed_identities(&model, &program, wrong)
            .iter()
            .map(|identity| identity.label)
            .collect();
        for label in broken {
            assert!(
                failed.contains(label),
                "{name}: {symbol}[{i}][{j}][{k}] with the wrong sign breaks {failed:?}, not {label}"
            );
        }
    }
    flipped
}

fn flip_in_all(symbol: &str, rank: u32, entry: Entry, broken: &[&str]) {
    let flipped: usize = MODELS
        .iter()
        .map(|name| flips(name, symbol, rank, entry, broken))
        .sum();
    println!("{symbol}: {flipped} entries");
    assert!(flipped > MODELS.len(), "{symbol} is zero everywhere");
}

#[test]
fn signs_of_gamma_are_checked() {
    let entry: Entry = |symbols, i, j, k| &mut symbols.geometry.gamma[i][j][k];
    flip_in_all("gamma", 3, entry, &["(12) = (13)"]);
}

#[test]
fn signs_of_gamma_of_rows_are_checked() {
    let entry: Entry = |symbols, i, j, k| &mut symbols.gamma_of_rows[i][j][k];
    flip_in_all("gamma of rows", 3, entry, &["(12) = (13)"]);
}

#[test]
fn signs_of_the_connection_are_checked() {
    let entry: Entry = |symbols, i, j, k| &mut symbols.geometry.connection[i][j][k];
    flip_in_all("connection", 3, entry, &["(21a)"]);
}

#[test]
fn signs_of_the_mass_matrix_are_checked() {
    let entry: Entry = |symbols, i, j, _| &mut symbols.geometry.mass[i][j];
    flip_in_all("mass", 2, entry, &["(20)", "(30a) = (30c)"]);
}

#[test]
fn signs_of_hamels_form_are_checked() {
    let entry: Entry = |symbols, i, _, _| &mut symbols.hamel[i];
    flip_in_all("hamel", 1, entry, &["(30a) = (30b)", "(30a) = (30c)"]);
}

#[test]
fn signs_of_gibbs_form_are_checked() {
    let entry: Entry = |symbols, i, _, _| &mut symbols.gibbs[i];
    flip_in_all("gibbs", 1, entry, &["(30a) = (30b)"]);
}

#[test]
fn signs_of_the_loads_are_checked() {
    let entry: Entry = |symbols, i, _, _| &mut symbols.applied[i];
    for (name, loaded) in [("free_body", 6), ("planar_world", 3), ("hoop_bead", 1)] {
        let broken = ["(28)", "(30c)", "power"];
        assert_eq!(flips(name, "applied", 1, entry, &broken), loaded, "{name}");
    }
}
