//! Orders in which nodes can be computed: children precede their parents.

use super::Graph;
use crate::node::{Edge, Node, NodeId};

impl Graph {
    /// Returns all nodes that the roots depend on, including the roots, with children before parents.
    pub fn reachable(&self, roots: &[Edge]) -> Vec<NodeId> {
        let ends = roots.iter().map(|root| root.node());
        let count = ends.clone().max().map_or(0, |last| last + 1);
        let mut seen = vec![false; count as usize];
        for id in ends {
            seen[id as usize] = true;
        }
        // Children are older than their parents.
        for id in (0..count as usize).rev() {
            if seen[id] {
                for child in self.nodes[id].children() {
                    seen[child.node() as usize] = true;
                }
            }
        }
        (0..count).filter(|&id| seen[id as usize]).collect()
    }

    /// Returns the nodes that the roots depend on and that vary at run time, without symbols. They are in
    /// depth-first order of the roots, so that a value is computed shortly before it is needed.
    pub fn varying_nodes(&self, roots: &[Edge]) -> Vec<NodeId> {
        let mut order = Vec::new();
        let mut seen = vec![false; self.nodes.len()];
        let mut stack = Vec::new();
        for root in roots {
            stack.push((root.node(), false));
            while let Some((id, done)) = stack.pop() {
                if done {
                    order.push(id);
                    continue;
                }
                let node = self.nodes[id as usize];
                let given = self.is_free(id) || matches!(node, Node::Symbol(_));
                if given || std::mem::replace(&mut seen[id as usize], true) {
                    continue;
                }
                stack.push((id, true));
                stack.extend(node.children().rev().map(|child| (child.node(), false)));
            }
        }
        order
    }

    /// Returns the length of the longest chain of nodes that vary at run time and depend on one another.
    pub fn depth(&self, roots: &[Edge]) -> usize {
        let mut depths = vec![0; self.nodes.len()];
        let mut deepest = 0;
        for id in self.varying_nodes(roots) {
            let children = self.nodes[id as usize].children();
            let below = children.map(|child| depths[child.node() as usize]).max();
            let depth = 1 + below.unwrap_or(0);
            depths[id as usize] = depth;
            deepest = deepest.max(depth);
        }
        deepest
    }
}
