//! Lists the parts that a picture of a mechanism leaves out because the description gives them no place.

use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::model::Model;
use hamel_codegen::model::pfaffian::{Kind, Pfaffian};

/// Returns a sentence for each part of a description that has no place in space, with the statement that would give it
/// one.
pub(super) fn unplaced_parts(model: &Model) -> Vec<String> {
    let mut all = Vec::new();
    if has_energy(model) {
        all.push(
            "the inertia in `kinetic` has no place: write `body on f { mass m; … }` or `particle mass m at p;` instead"
                .into(),
        );
    }
    let mut graph = model.graph.clone();
    let mut ends: Vec<Edge> = Vec::new();
    for (left, right) in &model.closures {
        let sides = left.iter().zip(right);
        ends.extend(sides.map(|(&left, &right)| graph.sub(left, right).abs()));
    }
    let loops = model.constraints.iter();
    let loops = loops.filter(|row| row.kind == Kind::Loop && !ends.contains(&row.residual.abs()));
    let mut written: Vec<&str> = loops.map(|row: &Pfaffian| row.written.as_str()).collect();
    written.dedup();
    let about = |equation: &&str| {
        format!(
            "the loop {equation} is an equation of numbers: only a loop between two points, as in `loop f.p = g.p;`, is drawn"
        )
    };
    all.extend(written.iter().map(about));
    all
}

/// Returns whether the kinetic energy has a part beyond bodies, particles and the armatures of joints.
fn has_energy(model: &Model) -> bool {
    let mut graph = model.graph.clone();
    let half = graph.ratio(1, 2);
    let mut rest = model.kinetic;
    for (&armature, &xi) in model.armature.iter().zip(&model.xi) {
        let square = graph.mul(xi, xi);
        let whole = graph.mul(armature, square);
        let part = graph.mul(half, whole);
        rest = graph.sub(rest, part);
    }
    rest.abs() != graph.zero()
}
