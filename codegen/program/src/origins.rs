//! Origins of statements: the quantity that each of them serves.
//!
//! A statement that computes an entry of a quantity serves that quantity. Any other statement serves a quantity that its
//! result is needed for.

use super::statements::{Body, Operation};
use super::{Function, Program, Shape};
use hamel_algebra::graph::{Label, NodeId};
use hamel_language::model::provenance::Origin;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Finds the origins of the statements of a body, by the nodes that they define. The outputs of the body are those of
/// the given functions, one after another.
pub fn origins(
    program: &Program,
    functions: &[&Function],
    body: &Body,
) -> FxHashMap<NodeId, Rc<Origin>> {
    let results = functions.iter().flat_map(|function| {
        let columns = match function.shape {
            Shape::Matrix(_, columns) => columns,
            Shape::Scalar | Shape::Vector(_) => 1,
        };
        let name = &function.name;
        let result = move |index| program.provenance.result(function.id, name, index, columns);
        (0..function.shape.entries()).map(result)
    });
    let outputs = body.outputs.iter().map(|edge| edge.node());
    let mut named: FxHashMap<NodeId, Rc<Origin>> = FxHashMap::default();
    for (node, origin) in outputs.zip(results) {
        if let Some(origin) = origin {
            named.entry(node).or_insert_with(|| Rc::new(origin));
        }
    }
    let mut labels: FxHashMap<Label, Option<Rc<Origin>>> = FxHashMap::default();
    served(body, |node| {
        named.get(&node).cloned().or_else(|| {
            let label = program.graph.label_of(node)?;
            let origin = || program.provenance.origin(label).map(Rc::new);
            labels.entry(label).or_insert_with(origin).clone()
        })
    })
}

/// Finds what the statements of a body serve, by the nodes that they define; `own` tells what a node is an entry of.
///
/// A statement without an own answer continues that of the next statement if its result is needed there, or else serves
/// the first statement that reads its result.
pub fn served<T: Clone + PartialEq>(
    body: &Body,
    mut own: impl FnMut(NodeId) -> Option<T>,
) -> FxHashMap<NodeId, T> {
    let mut all: FxHashMap<NodeId, T> = FxHashMap::default();
    // What the readers of each node serve. Statements are visited backwards, so that the first reader is the last one.
    let mut readers: FxHashMap<NodeId, Vec<T>> = FxHashMap::default();
    let mut next: Option<T> = None;
    for statement in body.statements.iter().rev() {
        if matches!(statement.operation, Operation::Check(..)) {
            continue;
        }
        let needed = || {
            let reads = statement.defined().filter_map(|node| readers.get(&node));
            let reads: Vec<&T> = reads.flatten().collect();
            match reads.last() {
                Some(&first) if !reads.iter().any(|&of| next.as_ref() == Some(of)) => {
                    Some(first.clone())
                }
                _ => next.clone(),
            }
        };
        let Some(of) = statement.defined().find_map(&mut own).or_else(needed) else {
            continue;
        };
        for edge in statement.operation.operands() {
            readers.entry(edge.node()).or_default().push(of.clone());
        }
        all.extend(statement.defined().map(|node| (node, of.clone())));
        next = Some(of);
    }
    all
}
