//! Independent blocks of velocity indices: connected components of the indices that nonzero entries of γ or M link.

use hamel_algebra::graph::{Edge, Graph};

/// Dependence of an entry of M on x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryDependence {
    /// 0 everywhere.
    Zero,
    /// The same at every x.
    Constant,
    /// Changes with x.
    Varying,
}

/// Returns the connected components of the graph with nodes 0..n and some links, in the order of their first members.
pub fn connected_components(
    n: usize,
    links: impl IntoIterator<Item = (usize, usize)>,
) -> Vec<Vec<usize>> {
    let mut label: Vec<usize> = (0..n).collect();
    for (a, b) in links {
        let (from, to) = (label[a].max(label[b]), label[a].min(label[b]));
        for entry in &mut label {
            if *entry == from {
                *entry = to;
            }
        }
    }
    let firsts = (0..n).filter(|&i| label[i] == i);
    firsts
        .map(|first| (0..n).filter(|&i| label[i] == first).collect())
        .collect()
}

/// Returns the blocks of γ: i, j, k belong together if γᵢⱼᵏ ≠ 0. The ∂ᵢ of different blocks commute.
pub fn commuting_blocks(graph: &Graph, gamma: &[Vec<Vec<Edge>>]) -> Vec<Vec<usize>> {
    let n = gamma.len();
    let zero = graph.zero().node();
    let mut links = Vec::new();
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                if gamma[i][j][k].node() != zero {
                    links.extend([(i, j), (i, k)]);
                }
            }
        }
    }
    connected_components(n, links)
}

/// Returns the blocks of M: i, j belong together if M_ij ≠ 0.
pub fn inertia_blocks(pattern: &[Vec<EntryDependence>]) -> Vec<Vec<usize>> {
    let n = pattern.len();
    let all = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    connected_components(
        n,
        all.filter(|&(i, j)| pattern[i][j] != EntryDependence::Zero),
    )
}
