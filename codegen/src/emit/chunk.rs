//! Functions of bounded size.
//!
//! rustc nests one debug scope in each `let` and overflows its stack at about 3,000 of them; code
//! that keeps all values in memory compiles slowly. So a long body is cut in parts of plain
//! `let`s, and only values that are read in a later part go through an array of slots.

use crate::algebra::graph::{Edge, NodeId};
use crate::program::places::{Place, Places, Time};
use crate::program::statements::Body;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;
use std::ops::Range;

/// The fewest `let`s that a part is allowed: one statement with its numbers has to fit.
const SMALLEST: usize = 8;

/// A run of statements that becomes one function.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its statements.
    pub statements: Range<usize>,
    /// The numbers that it reads, in order of first use.
    pub numbers: Vec<NodeId>,
}

/// How a body is cut.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Whether the body is small enough for one function.
    pub whole: bool,
    /// The parts, in order; a single one where the body is whole.
    pub parts: Vec<Part>,
    /// The slot of every value that is read in a later part.
    pub slots: FxHashMap<NodeId, usize>,
    /// Number of slots.
    pub size: usize,
}

/// Cuts a body in parts of at most `limit` `let`s: statements, numbers, and the constants' name.
pub fn plan(body: &Body, places: &Places, time: Time, limit: usize) -> Plan {
    let limit = limit.max(SMALLEST);
    let is_number = |edge: &Edge| places.of(edge.node(), time) == Place::Number;
    let mut parts = Vec::new();
    let mut start = 0;
    let mut numbers: Vec<NodeId> = Vec::new();
    let mut seen: FxHashSet<NodeId> = FxHashSet::default();
    let mut lets = 1;
    for (index, statement) in body.statements.iter().enumerate() {
        let fresh = |seen: &FxHashSet<NodeId>| -> BTreeSet<NodeId> {
            let read = statement.operation.operands().filter(is_number);
            read.map(Edge::node)
                .filter(|node| !seen.contains(node))
                .collect()
        };
        let mut new = fresh(&seen);
        let cost = usize::from(statement.is_let());
        if lets + cost + new.len() > limit {
            let numbers = std::mem::take(&mut numbers);
            parts.push(Part {
                statements: start..index,
                numbers,
            });
            seen.clear();
            (start, lets, new) = (index, 1, fresh(&seen));
        }
        lets += cost + new.len();
        seen.extend(&new);
        numbers.extend(new);
    }
    let end = body.statements.len();
    let mut whole = parts.is_empty();
    if whole {
        // A single body binds the numbers among its results too.
        let results = body
            .outputs
            .iter()
            .filter(|edge| is_number(edge))
            .map(|edge| edge.node());
        let results: Vec<NodeId> = results.filter(|&node| seen.insert(node)).collect();
        whole = lets + results.len() <= limit;
        numbers.extend(results.into_iter().filter(|_| whole));
    }
    if whole || start < end {
        parts.push(Part {
            statements: start..end,
            numbers,
        });
    }
    let (slots, size) = slots(body, &parts);
    Plan {
        whole,
        parts,
        slots,
        size,
    }
}

/// Slots by liveness: one is used again after the last part that reads its value.
fn slots(body: &Body, parts: &[Part]) -> (FxHashMap<NodeId, usize>, usize) {
    let mut last: FxHashMap<NodeId, usize> = FxHashMap::default();
    for (index, part) in parts.iter().enumerate() {
        for statement in &body.statements[part.statements.clone()] {
            for edge in statement.operation.operands() {
                last.insert(edge.node(), index);
            }
        }
    }
    let mut slots = FxHashMap::default();
    let mut size = 0;
    let mut free: BTreeSet<usize> = BTreeSet::new();
    let mut ends: Vec<Vec<usize>> = vec![Vec::new(); parts.len()];
    for (index, part) in parts.iter().enumerate() {
        let statements = &body.statements[part.statements.clone()];
        for node in statements.iter().flat_map(|statement| statement.defined()) {
            let Some(&end) = last.get(&node).filter(|&&end| end > index) else {
                continue;
            };
            let slot = free.pop_first().unwrap_or_else(|| {
                size += 1;
                size - 1
            });
            ends[end].push(slot);
            slots.insert(node, slot);
        }
        free.extend(ends[index].drain(..));
    }
    (slots, size)
}
