//! Names of temporaries: `k1`, `k2` … for values that depend on parameters alone, `t1`, `t2` … for others, or the
//! names that the user gave.

use super::entries::Definition;
use super::expression::Term;
use hamel_algebra::graph::{Edge, Graph, NodeId};
use rustc_hash::{FxHashMap, FxHashSet};

/// The temporaries of one table.
#[derive(Clone, Debug, Default)]
pub struct Temporaries {
    value_prefix: String,
    constant_prefix: String,
    user_names: FxHashMap<NodeId, (String, bool)>,
    roots: FxHashSet<NodeId>,
    named: FxHashSet<NodeId>,
    constants: Vec<Definition>,
    values: Vec<Definition>,
    numbered: (usize, usize),
}

impl Temporaries {
    /// Creates an empty list whose names differ from all symbols of the graph; `user_names` are the user's names.
    pub fn new(graph: &Graph, roots: &[Edge], user_names: &[(String, Edge)]) -> Self {
        let symbols = graph.symbols().iter().map(|symbol| symbol.name.as_str());
        let taken: Vec<&str> = symbols
            .chain(user_names.iter().map(|(name, _)| name.as_str()))
            .collect();
        let mut own = FxHashMap::default();
        for (name, edge) in user_names {
            own.entry(edge.node())
                .or_insert((name.clone(), edge.is_negative()));
        }
        Temporaries {
            value_prefix: free_prefix("t", &taken),
            constant_prefix: free_prefix("k", &taken),
            user_names: own,
            roots: roots.iter().map(|root| root.node()).collect(),
            ..Temporaries::default()
        }
    }

    /// Whether a node is the value of an entry.
    pub fn is_root(&self, id: NodeId) -> bool {
        self.roots.contains(&id)
    }

    /// Whether the user named a node.
    pub fn is_user_named(&self, id: NodeId) -> bool {
        self.user_names.contains_key(&id)
    }

    /// Whether a node has been named.
    pub fn is_named(&self, id: NodeId) -> bool {
        self.named.contains(&id)
    }

    /// Names a value, and returns the expression to write in its place.
    pub fn claim(&mut self, id: NodeId, value: Term, constant: bool) -> Term {
        self.named.insert(id);
        let (name, negative) = match self.user_names.get(&id) {
            Some(own) => own.clone(),
            None if constant => {
                self.numbered.0 += 1;
                (
                    format!("{}{}", self.constant_prefix, self.numbered.0),
                    false,
                )
            }
            None => {
                self.numbered.1 += 1;
                (format!("{}{}", self.value_prefix, self.numbered.1), false)
            }
        };
        let list = if constant {
            &mut self.constants
        } else {
            &mut self.values
        };
        list.push(Definition {
            name: name.clone(),
            value: value.signed(negative),
        });
        Term::name(&name).signed(negative)
    }

    /// Returns the constants and the other values, each in order of definition.
    pub fn definitions(self) -> (Vec<Definition>, Vec<Definition>) {
        (self.constants, self.values)
    }
}

/// Repeats `prefix` until no taken name begins with it and a digit.
fn free_prefix(prefix: &str, taken: &[&str]) -> String {
    let mut chosen = prefix.to_string();
    let clashes = |chosen: &str| {
        taken.iter().any(|name| {
            let rest = name.strip_prefix(chosen);
            rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
        })
    };
    while clashes(&chosen) {
        chosen.push_str(prefix);
    }
    chosen
}
