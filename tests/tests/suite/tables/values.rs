//! Printed expressions have the values of the entries that they represent, in floating point at a point of X.

use crate::derived::models;
use hamel_codegen::algebra::graph::{Edge, Function, Graph};
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::derive::tables::EquationTables;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::layout::Block;
use hamel_codegen::tables::expression::{Atom, Term};
use hamel_codegen::tables::{Listing, Table};
use num_traits::ToPrimitive;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Rounding of several hundred operations on numbers near 1.
const TOLERANCE: f64 = 1e-9;

type Values = BTreeMap<String, f64>;

fn term(values: &Values, term: &Term) -> f64 {
    let product = |factors: &[(Atom, u32)]| -> f64 {
        let powers = factors
            .iter()
            .map(|(a, power)| atom(values, a).powi(*power as i32));
        powers.product()
    };
    term.coefficient.to_f64().expect("finite") * product(&term.over) / product(&term.under)
}

fn atom(values: &Values, atom: &Atom) -> f64 {
    let arguments =
        |terms: &[Term]| -> Vec<f64> { terms.iter().map(|t| term(values, t)).collect() };
    match atom {
        Atom::Name(name) => values[name],
        Atom::Sum(terms) => arguments(terms).iter().sum(),
        Atom::External { name, .. } => panic!("no values of {name}"),
        Atom::Call(function, terms) => match (function, arguments(terms).as_slice()) {
            (function, [a]) => (function.row().value)(*a),
            (Function::Atan2, [y, x]) => y.atan2(*x),
            (Function::Select, [c, a, b]) => {
                if *c > 0.0 {
                    *a
                } else {
                    *b
                }
            }
            _ => f64::NAN,
        },
    }
}

/// Returns a point of X away from the identity; the start if the description has constraints.
fn point(generated: &Generated) -> Vec<f64> {
    let model = &generated.model;
    if !model.points.constraints.is_empty() {
        return model.start_x.clone();
    }
    let mut x = Vec::new();
    for block in &model.blocks {
        match block {
            // All different: parallel rods are singular.
            Block::Flat(n) => {
                let first = x.len();
                x.extend((0..*n).map(|i| 0.7 + 0.2 * (first + i) as f64));
            }
            Block::Circle => x.extend([0.6, 0.8]),
            Block::Quaternion => x.extend([0.2, 0.4, 0.4, 0.8]),
            Block::Rotation => {
                let rows = [[-0.6, 0.0, 0.8], [0.64, -0.6, 0.48], [0.48, 0.8, 0.36]];
                x.extend(rows.concat());
            }
        }
    }
    x
}

fn compare(what: &str, listing: &Listing, mut values: Values, expected: &[f64]) {
    for definition in listing.constants.iter().chain(&listing.temporaries) {
        let value = term(&values, &definition.value);
        values.insert(definition.name.clone(), value);
    }
    let entries = listing.entries_to_list(true);
    assert_eq!(entries.len(), expected.len(), "{what}");
    for (entry, expected) in entries.iter().zip(expected) {
        let value = term(&values, &entry.value);
        let error = (value - expected).abs() / (1.0 + expected.abs());
        assert!(
            error < TOLERANCE,
            "{what} {:?}: {value} for {expected}",
            entry.index
        );
    }
}

#[test]
fn printed_values_are_those_of_the_graph() {
    models().par_iter().for_each(|model| {
        let (name, generated, shown) = (&model.name, model.generated(), model.tables());
        let model = &generated.model;
        let numbered =
            |n: usize, scale: f64| (1..=n).map(|i| scale * i as f64).collect::<Vec<f64>>();
        let (xi, u) = (numbered(model.n(), 0.3), numbered(model.u.len(), -0.4));
        let x = point(generated);
        let numbers = model.numbers(&model.defaults, &x, &xi, &u, &numbered(model.n(), 0.0));
        let symbols = model.graph.symbols().iter();
        let values: Values = symbols
            .map(|s| s.name.clone())
            .zip(numbers.iter().copied())
            .collect();
        let geometry = EquationTables::new(model).expect("regular");
        let accel = generated.program.function("accel").expect("generated");
        // ξ̇ is a function of the independent velocities.
        let active = &generated.active;
        let left = |xi: &Edge| {
            let name = |graph: &Graph, node| {
                let symbols = graph.symbols().iter();
                symbols
                    .clone()
                    .find(|s| s.node == node)
                    .map(|s| s.name.clone())
            };
            name(&active.graph, xi.node())
        };
        let xi_active: Vec<f64> = active
            .xi
            .iter()
            .filter_map(left)
            .map(|n| values[&n])
            .collect();
        let rest = numbered(active.n(), 0.0);
        let inner = active.numbers(&active.defaults, &x, &xi_active, &u, &rest);
        let shapes: [(Table, Vec<Edge>); 6] = [
            (Table::A, model.a.concat()),
            (Table::Y, geometry.y.concat()),
            (Table::Gamma, geometry.gamma.concat().concat()),
            (Table::Mass, geometry.mass.concat()),
            (Table::Connection, geometry.connection.concat().concat()),
            (Table::Accel, accel.outputs.clone()),
        ];
        for (table, edges) in shapes {
            let graph = match table {
                Table::Accel => &generated.program.graph,
                _ => &geometry.model.graph,
            };
            let numbers = if table == Table::Accel {
                &inner
            } else {
                &numbers
            };
            let expected = evaluate(graph, &edges, numbers);
            let listing = shown.listings.iter().find(|of| of.table == table);
            let listing = listing.expect("among all");
            compare(
                &format!("{name} {table:?}"),
                listing,
                values.clone(),
                &expected,
            );
        }
    });
}
