//! Splits long functions into parts of bounded size.
//!
//! rustc nests a debug scope in every `let` and overflows its stack at about 3,000 of them; code
//! that keeps all values in memory compiles slowly. So a long body is split into parts with plain
//! `let`s, and only values that a later part reads go through an array of slots.
//!
//! The run time of a function that exceeds the instruction cache is the time to fetch its code from the next cache
//! level, so the shortest code is the fastest. If most values are read far from where they are computed, as in the
//! linearization of a legged robot, short parts give the shortest code: a long part would load a value from its slot,
//! soon spill it to the stack for want of registers, and load it from there again.

use hamel_algebra::graph::{Edge, NodeId};
use hamel_program::places::{Place, Places, Time};
use hamel_program::statements::Body;
use rustc_hash::{FxHashMap, FxHashSet};
use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::ops::Range;

/// Smallest limit on the `let`s of a part: one statement with its numbers has to fit.
const SMALLEST: usize = 8;

/// Largest number of `let`s in a short part.
const SHORT: usize = 70;

/// Number of statements up to which a function fits in the instruction cache, 32 KB on most machines.
const FITS: usize = 3000;

/// Threshold for short parts, as (values, statements): used if more than 21 values per 20 statements cross parts.
const MANY: (usize, usize) = (21, 20);

/// A range of statements of a long function that becomes a function of its own.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Its statements, as indices into the body.
    pub statements: Range<usize>,
    /// Numbers that it reads, in order of first use.
    pub numbers: Vec<NodeId>,
}

/// The division of a body into parts.
#[derive(Clone, Debug)]
pub struct BodyPartition {
    /// Whether the body is small enough for one function.
    pub whole: bool,
    /// The parts in order; at most one if `whole`.
    pub parts: Vec<Part>,
    /// Slot of every value that is read in a later part.
    pub slots: FxHashMap<NodeId, usize>,
    /// Number of slots.
    pub size: usize,
    /// Index of each result that later parts read from the output array instead of a slot. Short parts do so with all
    /// results that they write at once. Neighbours in a row are then often computed from neighbours, which suits SIMD.
    pub results: FxHashMap<NodeId, usize>,
}

/// Splits a body into parts of at most `limit` `let`s, counting statements, numbers, and the name of the constants.
/// The parts write results when they compute them, or leave them in slots, as `when` says.
pub fn partition_body(
    body: &Body,
    places: &Places,
    time: Time,
    limit: usize,
    when: ResultWriting,
) -> BodyPartition {
    let none = FxHashMap::default();
    let plan = cut(body, places, time, limit, &none, &FxHashSet::default());
    // The function of constants runs only when parameters change, and a body that fits the cache gains nothing.
    if time != Time::Call || when == ResultWriting::Whole || body.statements.len() <= FITS {
        return plan;
    }
    let results = body.outputs.iter().map(|edge| edge.node()).enumerate();
    let computed = results.filter(|&(_, node)| places.of(node, time) == Place::Temporary);
    // Of several equal results the first.
    let mut results: FxHashMap<NodeId, usize> =
        computed.map(|(place, node)| (node, place)).rev().collect();
    let kept = match when {
        ResultWriting::AtOnce => 0,
        ResultWriting::BehindPivots => {
            let pivot = body.statements.iter().rposition(|s| !s.is_let());
            pivot.unwrap_or(0)
        }
        ResultWriting::AtTheEnd | ResultWriting::Whole => body.statements.len(),
    };
    let kept = body.statements[..kept].iter();
    let known = kept.flat_map(|statement| statement.defined());
    let last = known
        .filter(|node| results.remove(node).is_some())
        .collect();
    let short = cut(body, places, time, limit.min(SHORT), &results, &last);
    let (values, statements) = MANY;
    if statements * crossings(body, &short.parts) <= values * body.statements.len() {
        return plan;
    }
    let slots = most_used_first(body, &short);
    BodyPartition {
        slots,
        results,
        ..short
    }
}

/// When the parts of a function write its results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResultWriting {
    /// Where they are computed.
    AtOnce,
    /// Results computed before the last pivot check are written after all parts, the others where they are computed.
    /// So nothing is written if a pivot is not positive.
    BehindPivots,
    /// All after the last part.
    AtTheEnd,
    /// All at the end of a function without parts.
    Whole,
}

/// Counts accesses to values that cross parts: one for each part that reads a value computed elsewhere, and one for the
/// part that computes it.
fn crossings(body: &Body, parts: &[Part]) -> usize {
    let mut home: FxHashMap<NodeId, usize> = FxHashMap::default();
    for (index, part) in parts.iter().enumerate() {
        let statements = &body.statements[part.statements.clone()];
        let defined = statements.iter().flat_map(|statement| statement.defined());
        home.extend(defined.map(|node| (node, index)));
    }
    let mut crossing: FxHashSet<NodeId> = FxHashSet::default();
    let mut reads = 0;
    for (index, part) in parts.iter().enumerate() {
        let statements = &body.statements[part.statements.clone()];
        let operands = statements.iter().flat_map(|s| s.operation.operands());
        let foreign = |node: &NodeId| home.get(node).is_some_and(|&home| home != index);
        let read: FxHashSet<NodeId> = operands.map(Edge::node).filter(foreign).collect();
        reads += read.len();
        crossing.extend(read);
    }
    reads + crossing.len()
}

/// Forms the parts. Assigns slots to all values that cross them, except those in `results`, and to the values `last`,
/// which are read after all parts.
fn cut(
    body: &Body,
    places: &Places,
    time: Time,
    limit: usize,
    results: &FxHashMap<NodeId, usize>,
    last: &FxHashSet<NodeId>,
) -> BodyPartition {
    let limit = limit.max(SMALLEST);
    let is_number = |edge: &Edge| places.of(edge.node(), time) == Place::Number;
    let mut parts: Vec<Part> = Vec::new();
    let mut start = 0;
    while start < body.statements.len() {
        let part = longest(body, start, limit, is_number, results);
        start = part.statements.end;
        parts.push(part);
    }
    let mut whole = parts.len() <= 1;
    if whole {
        let mut part = parts.pop().unwrap_or_default();
        let lets = body.statements.iter().filter(|s| s.is_let()).count();
        // An undivided body also binds the numbers among its results.
        let read = part.numbers.len();
        let outputs = body.outputs.iter().filter(|edge| is_number(edge));
        for node in outputs.map(|edge| edge.node()) {
            if !part.numbers.contains(&node) {
                part.numbers.push(node);
            }
        }
        whole = 1 + lets + part.numbers.len() <= limit;
        if !whole {
            part.numbers.truncate(read);
        }
        if whole || !part.statements.is_empty() {
            parts.push(part);
        }
    }
    let (slots, size) = slots(body, &parts, results, last);
    BodyPartition {
        whole,
        parts,
        slots,
        size,
        results: FxHashMap::default(),
    }
}

/// Returns the longest part that begins at `start`. It is cut back to end after one of `results`, if at least half of
/// it remains: results that are neighbours in a row are then more often computed together.
fn longest(
    body: &Body,
    start: usize,
    limit: usize,
    is_number: impl Fn(&Edge) -> bool,
    results: &FxHashMap<NodeId, usize>,
) -> Part {
    let mut numbers: Vec<NodeId> = Vec::new();
    let mut seen: FxHashSet<NodeId> = FxHashSet::default();
    let (mut end, mut lets) = (start, 1);
    let mut behind_result = (start, 0);
    for statement in &body.statements[start..] {
        let read = statement.operation.operands().filter(&is_number);
        let read = read.map(Edge::node).filter(|node| !seen.contains(node));
        let new: BTreeSet<NodeId> = read.collect();
        lets += usize::from(statement.is_let()) + new.len();
        if lets > limit && end > start {
            let (earlier, count) = behind_result;
            if 2 * (earlier - start) >= end - start {
                end = earlier;
                numbers.truncate(count);
            }
            break;
        }
        seen.extend(&new);
        numbers.extend(new);
        end += 1;
        if statement.defined().any(|node| results.contains_key(&node)) {
            behind_result = (end, numbers.len());
        }
    }
    Part {
        statements: start..end,
        numbers,
    }
}

/// Assigns slots by liveness: a slot is free again after the last part that reads its value.
fn slots(
    body: &Body,
    parts: &[Part],
    results: &FxHashMap<NodeId, usize>,
    at_the_end: &FxHashSet<NodeId>,
) -> (FxHashMap<NodeId, usize>, usize) {
    let mut last: FxHashMap<NodeId, usize> = FxHashMap::default();
    for (index, part) in parts.iter().enumerate() {
        for statement in &body.statements[part.statements.clone()] {
            for edge in statement.operation.operands() {
                last.insert(edge.node(), index);
            }
        }
    }
    last.extend(at_the_end.iter().map(|&node| (node, parts.len())));
    let mut slots = FxHashMap::default();
    let mut size = 0;
    let mut free: BTreeSet<usize> = BTreeSet::new();
    let mut ends: Vec<Vec<usize>> = vec![Vec::new(); parts.len() + 1];
    for (index, part) in parts.iter().enumerate() {
        let statements = &body.statements[part.statements.clone()];
        for node in statements.iter().flat_map(|statement| statement.defined()) {
            let Some(&end) = last
                .get(&node)
                .filter(|&&end| end > index && !results.contains_key(&node))
            else {
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

/// Renumbers slots by how many parts use them: the first ones have shorter offsets, and lie close together.
fn most_used_first(body: &Body, plan: &BodyPartition) -> FxHashMap<NodeId, usize> {
    let mut uses = vec![0_usize; plan.size];
    for part in &plan.parts {
        let statements = &body.statements[part.statements.clone()];
        let values = statements.iter().flat_map(|statement| {
            let operands = statement.operation.operands().map(Edge::node);
            operands.chain(statement.defined())
        });
        let here: FxHashSet<NodeId> = values.collect();
        for &slot in here.iter().filter_map(|node| plan.slots.get(node)) {
            uses[slot] += 1;
        }
    }
    let mut order: Vec<usize> = (0..plan.size).collect();
    order.sort_by_key(|&slot| Reverse(uses[slot]));
    let mut places = vec![0; plan.size];
    for (place, &slot) in order.iter().enumerate() {
        places[slot] = place;
    }
    let slots = plan.slots.iter();
    slots.map(|(&node, &slot)| (node, places[slot])).collect()
}
