//! The descriptions that the adviser proposes have the same motion as the given one.

use hamel_codegen::algebra::field_point::FieldPoint;
use hamel_codegen::algebra::graph::{Edge, Graph, Node};
use hamel_codegen::algebra::numeric::{evaluate_at, solve};
use hamel_codegen::algebra::residue_pair::ResiduePair;
use hamel_codegen::algebra::tangent::tangent_at;
use hamel_codegen::derive::accel::forward_dynamics;
use hamel_codegen::derive::adviser::advise;
use hamel_codegen::derive::numerical_loss::NumericalLoss;
use hamel_codegen::generate::from_text;
use hamel_codegen::model::Model;
use std::path::Path;

fn model(name: &str) -> (String, Model) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    let text = std::fs::read_to_string(path).expect("the model is in the repository");
    let model = from_text(&text).expect("correct").model;
    (text, model)
}

fn symbols(graph: &Graph, edges: &[Edge]) -> Vec<usize> {
    edges
        .iter()
        .map(|edge| match graph.node(edge.node()) {
            Node::Symbol(index) => index as usize,
            other => panic!("{other:?}"),
        })
        .collect()
}

/// Returns ẋ and ẍ at a point with these values of ξ.
fn motion(
    model: &Model,
    point: &FieldPoint,
    xi: &[ResiduePair],
) -> (Vec<ResiduePair>, Vec<ResiduePair>) {
    let (chosen, _) = forward_dynamics(model, &NumericalLoss::default()).expect("M is regular");
    let graph = &model.graph;
    let places = symbols(graph, &model.xi);
    let mut moved = FieldPoint::new();
    for index in 0..graph.symbols().len() {
        let own = places.iter().position(|&place| place == index);
        moved.push_symbol(own.map_or_else(|| point.symbol(index), |place| xi[place]));
    }
    let rate = evaluate_at(graph, &model.rate, &mut moved.clone()).expect("a value");
    let xi_dot = evaluate_at(&chosen.graph, &chosen.xi_dot, &mut moved.clone()).expect("a value");
    let mut direction = vec![ResiduePair::ZERO; graph.symbols().len()];
    for (place, slope) in symbols(graph, &model.x).into_iter().zip(&rate) {
        direction[place] = *slope;
    }
    for (place, slope) in places.into_iter().zip(xi_dot) {
        direction[place] = slope;
    }
    let duals = tangent_at(graph, &model.rate, &mut moved, &direction).expect("a value");
    (rate, duals.into_iter().map(|dual| dual.1).collect())
}

#[test]
fn every_choice_has_the_same_motion() {
    for (name, least) in [
        ("free_body_world_velocity", 4),
        ("heavy_top_quaternion", 2),
        ("double_pendulum_circles", 3),
        ("pendulum_circle", 1),
        ("satellite", 2),
        ("polar_particle", 1),
    ] {
        let (_, model) = model(name);
        let choices = advise(&model).expect("choices");
        assert!(choices.len() >= least, "{name}: {}", choices.len());
        assert_eq!(choices.iter().filter(|choice| choice.as_written).count(), 1);
        let weights: Vec<usize> = choices.iter().map(|choice| choice.accel.weight()).collect();
        assert!(weights.is_sorted(), "{name}: {weights:?}");
        let point = model.points.lane(0xadf1).expect("a point");
        for choice in &choices {
            // Computes ξ' from ẋ = A' ξ' by the normal equations.
            let given = symbols(&model.graph, &model.xi);
            let xi: Vec<ResiduePair> = given.iter().map(|&place| point.symbol(place)).collect();
            let (rate, acceleration) = motion(&model, &point, &xi);
            let a = evaluate_at(
                &choice.model.graph,
                &choice.model.a.concat(),
                &mut point.clone(),
            )
            .expect("a value");
            let n = model.n();
            let rows: Vec<&[ResiduePair]> = a.chunks(n).collect();
            let sum = |terms: Vec<ResiduePair>| {
                terms
                    .into_iter()
                    .fold(ResiduePair::ZERO, |sum, term| sum + term)
            };
            let gram = (0..n)
                .map(|i| {
                    (0..n)
                        .map(|j| sum(rows.iter().map(|row| row[i] * row[j]).collect()))
                        .collect()
                })
                .collect();
            let right = (0..n)
                .map(|i| sum(rows.iter().zip(&rate).map(|(row, &r)| row[i] * r).collect()))
                .collect();
            let own = solve(gram, right).expect("A' has full rank");
            let (own_rate, own_acceleration) = motion(&choice.model, &point, &own);
            assert_eq!(own_rate, rate, "{name}: {}", choice.label);
            assert_eq!(own_acceleration, acceleration, "{name}: {}", choice.label);
        }
    }
}

/// The proposed statements form a valid description with the promised counts.
#[test]
fn statements_give_what_was_counted() {
    let (text, model) = model("heavy_top_quaternion");
    let choices = advise(&model).expect("choices");
    let other = choices
        .iter()
        .find(|choice| !choice.as_written)
        .expect("another choice");
    let kept: String = text
        .lines()
        .map(|line| match line.trim() {
            line if line.starts_with("velocity") => other.statements.join("\n"),
            line if line.starts_with("rate") => String::new(),
            _ => line.to_string(),
        })
        .collect::<Vec<_>>()
        .join("\n");
    let generated = from_text(&kept).unwrap_or_else(|errors| panic!("{errors:?}\n{kept}"));
    let (chosen, _) =
        forward_dynamics(&generated.model, &NumericalLoss::default()).expect("M is regular");
    assert_eq!(chosen.count, other.accel);
}
