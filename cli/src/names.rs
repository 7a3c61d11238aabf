//! Names of single numbers, as the language writes them: `r[1]`, `R[1,2]`, `q.c`.

use hamel_codegen::model::layout::entry_names;
use hamel_codegen::model::{Group, Model};
use hamel_codegen::program::Shape;
use hamel_codegen::syntax::ast::ShapeKind;

/// Names of the entries of x.
pub fn coordinates(model: &Model) -> Vec<String> {
    model
        .coordinates
        .iter()
        .flat_map(|coordinate| entry_names(&coordinate.name, coordinate.kind))
        .collect()
}

/// Names of the entries of ξ.
pub fn velocities(model: &Model) -> Vec<String> {
    model.velocities.iter().flat_map(group).collect()
}

/// Names of the entries of ξ and of the states of first order behind it.
pub fn moving(model: &Model) -> Vec<String> {
    let groups = model.velocities.iter().chain(&model.states);
    groups.flat_map(group).collect()
}

/// Names of the entries of a group of symbols.
pub fn group(group: &Group) -> Vec<String> {
    let name = &group.name;
    match group.shape {
        ShapeKind::Scalar => shaped(name, Shape::Scalar),
        ShapeKind::Vector(n) => shaped(name, Shape::Vector(n)),
        ShapeKind::Matrix(n) => shaped(name, Shape::Matrix(n, n)),
        ShapeKind::Symmetric(n) => (1..=n)
            .flat_map(|i| (i..=n).map(move |j| format!("{name}[{i},{j}]")))
            .collect(),
    }
}

/// Names of the entries of a value, matrices by rows.
pub fn shaped(name: &str, shape: Shape) -> Vec<String> {
    match shape {
        Shape::Scalar => vec![name.to_string()],
        Shape::Vector(n) => (1..=n).map(|i| format!("{name}[{i}]")).collect(),
        Shape::Matrix(rows, columns) => (1..=rows)
            .flat_map(|i| (1..=columns).map(move |j| format!("{name}[{i},{j}]")))
            .collect(),
    }
}
