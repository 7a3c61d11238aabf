//! Joint computation of ξ̇ and [A B]: nearly all that ξ̇ needs is computed on the way to [A B].

use super::count::count_nodes;
use super::{FunctionId, Program};
use hamel_algebra::graph::{Edge, NodeId};

/// [A B] is never computed alone if ξ̇ adds at most 1/`LITTLE` to its weighted operations.
const LITTLE: usize = 100;

/// Joint computation of ξ̇ and [A B].
#[derive(Clone, Debug)]
pub struct Together {
    /// Index of `accel` among the functions.
    pub accel: usize,
    /// Index of `linearize` among the functions.
    pub linearize: usize,
    /// ξ̇, followed by [A B] by rows.
    pub outputs: Vec<Edge>,
    /// Pivots of both functions.
    pub guards: Vec<Edge>,
    /// Nodes that vary at run time, children first.
    pub nodes: Vec<NodeId>,
}

/// Plans the joint computation of ξ̇ and [A B]; `None` if one of them is not generated, or if too little is common to
/// both.
pub fn together(program: &Program) -> Option<Together> {
    let place = |id: FunctionId| program.functions.iter().position(|f| f.id == Some(id));
    let (accel, linearize) = (place(FunctionId::Accel)?, place(FunctionId::Linearize)?);
    let [rates, slopes] = [accel, linearize].map(|index| &program.functions[index]);
    if rates.arguments != slopes.arguments || rates.fallible != slopes.fallible {
        return None;
    }
    let mut guards = slopes.guards.clone();
    let mut xi_dot = &slopes.rates;
    if xi_dot.is_empty() {
        xi_dot = &rates.outputs;
        let more = rates.guards.iter();
        guards.extend(more.filter(|&guard| !slopes.guards.contains(guard)));
    }
    let roots = |lists: &[&[Edge]]| program.graph.varying_nodes(&lists.concat());
    let nodes = roots(&[xi_dot, &slopes.outputs, &guards]);
    let alone = roots(&[&slopes.outputs, &slopes.guards]);
    let [both, alone] = [&nodes, &alone].map(|nodes| count_nodes(&program.graph, nodes).weight());
    if (both - alone) * LITTLE > alone {
        return None;
    }
    Some(Together {
        accel,
        linearize,
        outputs: [&xi_dot[..], &slopes.outputs].concat(),
        guards,
        nodes,
    })
}
