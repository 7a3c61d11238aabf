//! Programs without functions, which tests add.

use hamel_codegen::algebra::graph::{Edge, Graph};
use hamel_codegen::algebra::residue_pair::Random;
use hamel_codegen::model::layout::{blocks, entry_names};
use hamel_codegen::model::value::Value;
use hamel_codegen::model::{Coordinate, Group, class};
use hamel_codegen::program::provenance::Provenance;
use hamel_codegen::program::structure::Structure;
use hamel_codegen::program::{Argument, Function, Program, Shape};
use hamel_codegen::syntax::ast::Span as Place;
use hamel_codegen::syntax::ast::{CoordKind, ShapeKind};

/// Declarations: names with shapes.
pub struct Declared<'a> {
    pub params: &'a [(&'a str, ShapeKind)],
    pub coordinates: &'a [(&'a str, CoordKind)],
    pub velocities: &'a [(&'a str, ShapeKind)],
    pub inputs: &'a [(&'a str, ShapeKind)],
}

/// Returns a program without functions, and its symbols: parameters, x, ξ, u, ξ̇.
pub fn sketch(name: &str, declared: &Declared) -> (Program, [Vec<Edge>; 5]) {
    let mut random = Random::new(7);
    let mut graph = Graph::new(class::PARAM);
    let mut symbol = |graph: &mut Graph, name: &str, class: u8| {
        let value = random.element();
        graph.symbol(name, class, value)
    };
    symbol(&mut graph, "pi", 0);
    let mut groups = |graph: &mut Graph, list: &[(&str, ShapeKind)], class| {
        let (mut groups, mut all) = (Vec::new(), Vec::new());
        for &(name, shape) in list {
            let suffixes: Vec<String> = match shape {
                ShapeKind::Scalar => vec![String::new()],
                ShapeKind::Vector(n) => (1..=n).map(|i| format!("[{i}]")).collect(),
                ShapeKind::Matrix(n) => (1..=n)
                    .flat_map(|i| (1..=n).map(move |j| format!("[{i},{j}]")))
                    .collect(),
                ShapeKind::Symmetric(n) => (1..=n)
                    .flat_map(|i| (i..=n).map(move |j| format!("[{i},{j}]")))
                    .collect(),
            };
            let symbols: Vec<Edge> = suffixes
                .iter()
                .map(|s| symbol(graph, &format!("{name}{s}"), class))
                .collect();
            let (offset, len) = (all.len(), symbols.len());
            groups.push(Group {
                name: name.into(),
                shape,
                value: Value::Vector(symbols.clone()),
                offset,
                len,
                unit: None,
            });
            all.extend(symbols);
        }
        (groups, all)
    };
    let (params, p) = groups(&mut graph, declared.params, class::PARAM);
    let entries: Vec<(&str, ShapeKind)> = Vec::new();
    let (_, mut x) = groups(&mut graph, &entries, class::COORD);
    let mut coordinates = Vec::new();
    for &(name, kind) in declared.coordinates {
        let span = Place::NOWHERE;
        coordinates.push(Coordinate {
            name: name.into(),
            kind,
            offset: x.len(),
            span,
        });
        for entry in entry_names(name, kind) {
            x.extend(
                groups(
                    &mut graph,
                    &[(entry.as_str(), ShapeKind::Scalar)],
                    class::COORD,
                )
                .1,
            );
        }
    }
    let (velocities, xi) = groups(&mut graph, declared.velocities, class::VELOCITY);
    let (inputs, u) = groups(&mut graph, declared.inputs, class::INPUT);
    let (_, xi_dot) = groups(&mut graph, declared.velocities, class::ACCEL);
    let program = Program {
        name: name.into(),
        public: true,
        docs: Vec::new(),
        defaults: p
            .iter()
            .enumerate()
            .map(|(index, _)| 1.25 + 0.3 * index as f64)
            .collect(),
        params,
        blocks: declared
            .coordinates
            .iter()
            .flat_map(|&(_, kind)| blocks(kind))
            .collect(),
        coordinates,
        velocities,
        inputs,
        states: Vec::new(),
        joints: Vec::new(),
        nu: x.len(),
        n: xi.len(),
        n_z: 0,
        m: u.len(),
        phi: 0,
        clock: None,
        embedded: false,
        start_x: vec![0.5; x.len()],
        start_xi: vec![0.25; xi.len()],
        names: Vec::new(),
        constant_guards: Vec::new(),
        causes: Vec::new(),
        functions: Vec::new(),
        structure: Structure {
            split: Err(Vec::new()),
            canonical: Ok(()),
            mass: Vec::new(),
            damped: Vec::new(),
            conservative: false,
            multipliers: false,
        },
        provenance: Provenance::default(),
        graph,
    };
    (program, [p, x, xi, u, xi_dot])
}

/// Returns a function with a line of documentation.
pub fn function(name: &str, arguments: &[Argument], shape: Shape, outputs: Vec<Edge>) -> Function {
    let docs = format!("The {name} of a sample.");
    Function {
        id: hamel_codegen::program::FunctionId::from_name(name),
        ..Function::described(name, docs, arguments, shape, outputs)
    }
}
