//! Origins of statements: the quantity that each of them serves.
//!
//! A statement that computes an entry of a quantity serves that quantity. Any other statement serves a quantity that its
//! result is needed for.

use super::provenance::Origin;
use super::statements::{Body, Operation};
use super::{Function, Program, Shape};
use hamel_algebra::graph::{Label, NodeId};
use hamel_language::functions::FunctionId;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Finds the origins of the statements of a body, by the nodes that they define. The outputs of the body are those of
/// the given functions, one after another.
pub fn origins(
    program: &Program,
    functions: &[&Function],
    body: &Body,
) -> FxHashMap<NodeId, Rc<Origin>> {
    let provenance = &program.provenance;
    let mut all = Interned::default();
    let mut named: FxHashMap<NodeId, usize> = FxHashMap::default();
    let mut outputs = body.outputs.iter();
    for function in functions {
        let (rows, columns) = match function.shape {
            Shape::Matrix(rows, columns) => (rows, columns),
            Shape::Scalar | Shape::Vector(_) => (function.shape.entries(), 1),
        };
        for row in 0..rows.max(1) {
            let origin = all.place(provenance.result(function.id, &function.name, row));
            for output in outputs.by_ref().take(columns) {
                // Labels name the rows of a linearisation, in which displacements, velocities and states follow one
                // another.
                let is_labelled = program.graph.label_of(output.node()).is_some();
                if function.id != Some(FunctionId::Linearize) || !is_labelled {
                    named.entry(output.node()).or_insert(origin);
                }
            }
        }
    }
    let mut labels: FxHashMap<Label, Option<usize>> = FxHashMap::default();
    let served = served(body, |node| {
        named.get(&node).copied().or_else(|| {
            let label = program.graph.label_of(node)?;
            let mut place = || Some(all.place(provenance.origin(label)?));
            *labels.entry(label).or_insert_with(&mut place)
        })
    });
    let served = served.into_iter();
    served
        .map(|(node, place)| (node, all.list[place].clone()))
        .collect()
}

/// Origins, each kept once.
#[derive(Default)]
struct Interned {
    list: Vec<Rc<Origin>>,
    places: FxHashMap<String, usize>,
}

impl Interned {
    fn place(&mut self, origin: Origin) -> usize {
        if let Some(&known) = self.places.get(&origin.quantity) {
            return known;
        }
        self.places.insert(origin.quantity.clone(), self.list.len());
        self.list.push(Rc::new(origin));
        self.list.len() - 1
    }
}

/// Finds what the statements of a body serve, by the nodes that they define; `own` tells what a node is an entry of.
/// Quantities are numbered.
///
/// A statement without an own answer continues that of the next statement if its result is needed there, or else serves
/// the first statement that reads its result.
pub fn served(
    body: &Body,
    mut own: impl FnMut(NodeId) -> Option<usize>,
) -> FxHashMap<NodeId, usize> {
    let mut all: FxHashMap<NodeId, usize> = FxHashMap::default();
    let mut readers: FxHashMap<NodeId, Readers> = FxHashMap::default();
    let mut next: Option<usize> = None;
    // Backwards, so that readers come before what they read.
    for statement in body.statements.iter().rev() {
        if matches!(statement.operation, Operation::Check(..)) {
            continue;
        }
        let needed = || {
            let reads = || statement.defined().filter_map(|node| readers.get(&node));
            let continues = next.is_some_and(|next| reads().any(|all| all.contain(next)));
            let first = reads().map(|all| all.first).next();
            // Of values that only checks read, the first quantity.
            first.filter(|_| !continues).or(next).or(Some(0))
        };
        let whole = |node: &NodeId| !body.partial.contains(node);
        let found = statement.defined().filter(whole).find_map(&mut own);
        let Some(of) = found.or_else(needed) else {
            continue;
        };
        for edge in statement.operation.operands() {
            let entry = readers.entry(edge.node());
            entry
                .and_modify(|all| all.precede(of))
                .or_insert_with(|| Readers::only(of));
        }
        all.extend(statement.defined().map(|node| (node, of)));
        next = Some(of);
    }
    all
}

/// What the readers of a node serve.
struct Readers {
    /// The quantity of the first reader.
    first: usize,
    /// The quantities of the others.
    others: Vec<usize>,
}

impl Readers {
    fn only(first: usize) -> Self {
        Readers {
            first,
            others: Vec::new(),
        }
    }

    /// Adds a reader before the others.
    fn precede(&mut self, quantity: usize) {
        if quantity != self.first {
            self.others.push(self.first);
            self.first = quantity;
        }
    }

    fn contain(&self, quantity: usize) -> bool {
        self.first == quantity || self.others.contains(&quantity)
    }
}
