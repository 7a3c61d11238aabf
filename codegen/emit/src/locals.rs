//! Local names of the values within one function.

use super::names::{ReservedWords, UniqueNames, to_snake_case};
use super::number;
use hamel_algebra::graph::{Edge, NodeId};
use hamel_program::places::Places;
use hamel_program::statements::{Operation, Statement};
use rustc_hash::{FxHashMap, FxHashSet};

/// Names of the temporaries and numbers of one function.
#[derive(Clone, Debug)]
pub struct Locals {
    scope: UniqueNames,
    legal: fn(String) -> String,
    names: FxHashMap<NodeId, String>,
}

impl Locals {
    /// Names those of `nodes`, the values of a function, that the description names; [`fill`](Self::fill) names the
    /// others.
    pub fn with_user_names(
        words: &ReservedWords,
        named: &[(String, Edge)],
        nodes: &[NodeId],
    ) -> Self {
        let here: FxHashSet<NodeId> = nodes.iter().copied().collect();
        let mut locals = Locals {
            scope: words.locals.clone(),
            legal: words.legal,
            names: FxHashMap::default(),
        };
        for (name, edge) in named {
            let node = edge.node();
            if here.contains(&node) && !locals.names.contains_key(&node) {
                let sign = if edge.is_negative() { "minus_" } else { "" };
                locals.claim(node, &format!("{sign}{}", to_snake_case(name)));
            }
        }
        locals
    }

    /// Returns the name that a value was given, `t3` or the user's; empty before it was named.
    pub fn name_of(&self, node: NodeId) -> &str {
        self.names.get(&node).map_or("", String::as_str)
    }

    /// Names all values that have no name yet, `t1`, `t2` …, and the numbers, `c1` …, in order of first use.
    pub fn fill(
        &mut self,
        statements: &[Statement],
        numbers: impl Iterator<Item = NodeId>,
        places: &Places,
    ) {
        let mut count = 0;
        for node in numbers.filter(|&node| places.is_number(node)) {
            if self.names.contains_key(&node) {
                continue;
            }
            match number::constant_name(places.graph(), node) {
                Some(name) => self.claim(node, name),
                None => self.count(node, "c", &mut count),
            }
        }
        let (mut temporaries, mut angles) = (0, 0);
        for statement in statements {
            if let Operation::SinCos(angle) = statement.operation {
                self.pair(angle, statement.results, &mut angles, places);
                continue;
            }
            for node in statement.defined() {
                if !self.names.contains_key(&node) {
                    self.count(node, "t", &mut temporaries);
                }
            }
        }
    }

    /// Names a sine and a cosine: `sin_q` and `cos_q` if the angle is an entry q, else `sin1` and `cos1`.
    fn pair(
        &mut self,
        angle: Edge,
        results: [Option<NodeId>; 2],
        count: &mut usize,
        places: &Places,
    ) {
        let entry = places.entry(angle.node()).filter(|_| !angle.is_negative());
        let suffix = match entry {
            Some(entry) => format!("_{}", to_snake_case(entry)),
            None => {
                *count += 1;
                count.to_string()
            }
        };
        for (node, function) in results.into_iter().zip(["sin", "cos"]) {
            if let Some(node) = node
                && !self.names.contains_key(&node)
            {
                self.claim(node, &format!("{function}{suffix}"));
            }
        }
    }

    /// Gives a value the next free name of a numbered series.
    fn count(&mut self, node: NodeId, letter: &str, count: &mut usize) {
        loop {
            *count += 1;
            let name = format!("{letter}{count}");
            if self.scope.is_free(&name) {
                return self.claim(node, &name);
            }
        }
    }

    fn claim(&mut self, node: NodeId, wanted: &str) {
        let name = self.scope.claim(&(self.legal)(wanted.into()));
        self.names.insert(node, name);
    }
}
