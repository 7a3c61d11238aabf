//! Binding times: which values are computed once when parameters are set, and which on every call.

use super::Program;
use hamel_algebra::graph::{Edge, Graph, Node, NodeId};

/// Order of computation of a program.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// Nodes computed when parameters are set, children first, without symbols and numbers.
    pub hoisted: Vec<NodeId>,
    /// Hoisted nodes that functions read at run time, in order of their ids: the constants that are kept.
    pub kept: Vec<NodeId>,
    /// For every function its nodes computed at run time, in depth-first order of the results.
    ///
    /// Other orders gain nothing, because LLVM reorders anyway. Run times for UR5, Solo12 and a chain of 32 links:
    /// this order 156, 526, 1906 ns; greatest register need first 155, 523, 1855; fewest live values first 158, 518,
    /// 1935; by depth from the arguments 150, 607, 1933; by depth from the results 151, 558, 1917.
    pub bodies: Vec<Vec<NodeId>>,
}

impl Schedule {
    /// Schedules all functions of a program.
    pub fn of(program: &Program) -> Self {
        let graph = &program.graph;
        let bodies: Vec<Vec<NodeId>> = program
            .functions
            .iter()
            .map(|function| {
                let roots: Vec<Edge> = function
                    .outputs
                    .iter()
                    .chain(&function.guards)
                    .copied()
                    .collect();
                graph.varying_nodes(&roots)
            })
            .collect();
        let mut kept: Vec<NodeId> = Vec::new();
        for (function, nodes) in program.functions.iter().zip(&bodies) {
            let on_the_way = graph.varying_nodes(&function.rates);
            let nodes = nodes.iter().chain(&on_the_way);
            let children = nodes.flat_map(|&id| graph.node(id).children());
            let roots = function.outputs.iter().chain(&function.guards);
            let roots = roots.chain(&function.rates).copied();
            kept.extend(
                children
                    .chain(roots)
                    .map(Edge::node)
                    .filter(|&id| is_hoisted(graph, id)),
            );
        }
        kept.sort_unstable();
        kept.dedup();
        let roots: Vec<Edge> = kept
            .iter()
            .map(|&id| Edge::of(id))
            .chain(program.constant_guards.iter().copied())
            .collect();
        let hoisted = graph
            .reachable(&roots)
            .into_iter()
            .filter(|&id| is_hoisted(graph, id))
            .collect();
        Schedule {
            hoisted,
            kept,
            bodies,
        }
    }
}

/// Returns whether a node is computed when parameters are set: constant at run time, but neither symbol nor number.
pub fn is_hoisted(graph: &Graph, id: NodeId) -> bool {
    graph.is_free(id) && !matches!(graph.node(id), Node::Constant(_) | Node::Symbol(_))
}
