//! Compares the tables of the fixtures with KR18 and with their geometry.

mod paper;
mod values;

use crate::derived::{model, models};
use hamel_codegen::algebra::derivation::Derivation;
use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::derive::tables::EquationTables;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::model::layout::Block;
use hamel_codegen::tables::expression::Term;
use hamel_codegen::tables::{Listing, Table, Tables, json, latex, markdown, text};
use rayon::prelude::*;
use serde_json::Value;

/// Returns a table as JSON.
fn printed(generated: &Generated, table: Table) -> Value {
    let shown = generated.tables(&[table]).expect("derivable");
    json(&shown, false)["tables"][table.name()].clone()
}

/// Returns the indices in a JSON list.
fn index(value: &Value) -> Vec<usize> {
    let entries = value.as_array().expect("a list").iter();
    let entries = entries.map(|entry| entry.as_u64().expect("an index") as usize);
    entries.collect()
}

/// Returns the nonzero entries of a table: their indices and printed values.
fn values(generated: &Generated, table: Table) -> Vec<(Vec<usize>, String)> {
    let printed = printed(generated, table);
    let entries = printed["entries"].as_array().expect("a list").iter();
    let value = |entry: &Value| entry["value"].as_str().expect("a text").to_string();
    entries
        .map(|entry| (index(&entry["index"]), value(entry)))
        .collect()
}

#[test]
fn entries_contain_only_coordinates_that_they_depend_on() {
    let fixtures = [
        "free_body",
        "free_body_no_wrench",
        "free_body_world",
        "free_body_world_velocity",
        "heavy_top",
        "heavy_top_axis",
        "heavy_top_quaternion",
        "heavy_top_world",
    ];
    for name in fixtures {
        let generated = model(name).generated();
        let mut geometry = EquationTables::new(&generated.model).expect(name);
        let shown = generated
            .tables(&[Table::Gamma, Table::Mass, Table::Connection])
            .expect(name);
        for listing in &shown.listings {
            for entry in &listing.entries {
                let i: Vec<usize> = entry.index.iter().map(|i| i - 1).collect();
                let edge = match listing.table {
                    Table::Gamma => geometry.gamma[i[0]][i[1]][i[2]],
                    Table::Mass => geometry.mass[i[0]][i[1]],
                    _ => geometry.connection[i[0]][i[1]][i[2]],
                };
                let printed = coordinates(&shown, listing, &entry.value);
                check_blocks(
                    &mut geometry,
                    edge,
                    &printed,
                    &format!("{name} {:?} {:?}", listing.table, entry.index),
                );
            }
        }
    }
}

/// Returns the indices in x of the coordinates in a value.
fn coordinates(tables: &Tables, listing: &Listing, value: &Term) -> Vec<usize> {
    let mut places = Vec::new();
    for name in value.names() {
        places.extend(tables.coordinates.iter().position(|known| known == name));
        if let Some(temporary) = listing.temporaries.iter().find(|t| t.name == name) {
            places.extend(coordinates(tables, listing, &temporary.value));
        }
    }
    places
}

/// Every block with a printed coordinate changes the value when it moves alone along X.
fn check_blocks(geometry: &mut EquationTables, edge: Edge, printed: &[usize], what: &str) {
    let model = &mut geometry.model;
    let mut first = 0;
    for block in model.blocks.clone() {
        let range = first..first + Block::len(block);
        first = range.end;
        if !printed.iter().any(|place| range.contains(place)) {
            continue;
        }
        let moves = (0..model.xi.len()).any(|i| {
            let seeds = range
                .clone()
                .map(|place| (model.x[place].node(), model.a[place][i]));
            Derivation::new(seeds).of(&mut model.graph, edge) != model.graph.zero()
        });
        assert!(moves, "{what} contains coordinates {range:?} without need");
    }
}

#[test]
fn curvilinear_gamma_keeps_its_coordinate() {
    let expected = [
        (vec![1, 2, 2], "-1/rho".to_string()),
        (vec![2, 1, 2], "1/rho".to_string()),
    ];
    assert_eq!(
        values(model("polar_particle").generated(), Table::Gamma),
        expected
    );
}

#[test]
fn every_table_of_every_fixture_prints() {
    models().par_iter().for_each(|model| {
        let (name, shown) = (&model.name, model.tables());
        for all in [false, true] {
            let json = json(shown, all).to_string();
            let out = [
                text(shown, all),
                markdown(shown, all),
                latex(shown, all),
                json,
            ];
            assert!(out.iter().all(|text| !text.is_empty()), "{name}");
        }
    });
}

#[test]
fn outputs_names_and_notation() {
    let generated = from_text(
        "system Arm {
            param m1 = 1, l = 2, omega = 3, t1 = 0.5, g = 9.81;
            coord th, x1;
            velocity w, v;
            rate th = w;
            rate x1 = v;
            let tip = l * sin(th) + t1 * cos(th);
            particle mass m1 at [tip, x1, l * cos(th)];
            gravity [0, 0, -g];
            output reach = sqrt(tip^2 + x1^2);
            output both = [omega * tip / (1 + x1^2), 0];
        }",
    )
    .expect("derivable");
    let shown = generated
        .tables(&[Table::Outputs, Table::Mass, Table::Accel])
        .expect("shown");
    let printed = [
        text(&shown, false),
        latex(&shown, false),
        markdown(&shown, true),
    ];
    assert!(printed[0].contains("both[2] = 0"));
    // l² cos² + l² sin² is l².
    let mass = "m1*(t1^2*sin(th)^2 - 2*l*t1*sin(th)*cos(th) + l^2)";
    assert!(printed[0].contains(mass), "{}", printed[0]);
    assert!(printed[1].contains(r"\omega"));
    let output = &json(&shown, false)["tables"]["outputs"]["entries"][0];
    assert_eq!(output["name"], "reach");
    assert_eq!(output["index"], serde_json::json!([1]));
}

#[test]
fn an_unknown_table_is_refused_with_the_names() {
    let error = Table::parse_list("A,gama")
        .expect_err("unknown")
        .to_string();
    assert!(
        error.contains("`gama`") && error.contains("gamma") && error.contains("outputs"),
        "{error}"
    );
    assert_eq!(
        Table::parse_list("A, gamma"),
        Ok(vec![Table::A, Table::Gamma])
    );
}
