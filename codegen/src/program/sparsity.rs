//! The sparsity of a motion along the chart rate: which displacements and velocities each displacement at its end
//! depends on, and directions that many of them share.
//!
//! x⁺ is x moved along the chart rate for a time, block by block, and η⁺ = Y(x⁺) δx⁺. Entries of (η, ξ) that no row meets
//! together vary along one direction, so that dual numbers of few directions have all slopes in them. Source: A. R. Curtis,
//! M. J. D. Powell, J. K. Reid, *On the estimation of sparse Jacobian matrices*, J. Inst. Maths Applics 13 (1974).

use std::collections::BTreeSet;

use super::{FunctionId, Program, Shape};
use crate::algebra::graph::{Edge, Node};
use crate::model::layout::Block;
use num_traits::Zero;

/// The patterns, and a direction for each entry of η, ξ and z.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sparsity {
    /// For each row of the frame A(x) the entries that are not 0.
    pub frame: Vec<Vec<usize>>,
    /// For each row of the coframe Y(x) the entries that are not 0.
    pub coframe: Vec<Vec<usize>>,
    /// For each row of η⁺ the entries of (η, ξ, z) that it depends on, in order.
    pub motion: Vec<Vec<usize>>,
    /// The direction of each entry of (η, ξ, z); 0 where it moves nothing.
    pub seeds: Vec<usize>,
}

impl Sparsity {
    /// That of a program with a frame of displacements; nothing where there is none.
    pub fn of(program: &Program) -> Option<Self> {
        let [frame, coframe, rate] = [
            FunctionId::DisplacementFrame,
            FunctionId::DisplacementCoframe,
            FunctionId::ChartRate,
        ]
        .map(|id| program.function(id));
        let (frame, coframe, rate) = (frame?, coframe?, rate?);
        let Shape::Matrix(displacements, _) = coframe.shape else {
            return None;
        };
        let graph = &program.graph;
        let stands = |edge: &Edge| {
            graph
                .as_rational(*edge)
                .is_none_or(|number| !number.is_zero())
        };
        let pattern = |outputs: &[Edge], columns: usize| -> Vec<Vec<usize>> {
            let row = |row: &[Edge]| {
                let entries = row.iter().enumerate();
                entries
                    .filter(|(_, edge)| stands(edge))
                    .map(|(j, _)| j)
                    .collect()
            };
            outputs.chunks(columns.max(1)).map(row).collect()
        };
        let frame = pattern(&frame.outputs, displacements);
        let coframe = pattern(&coframe.outputs, program.nu);
        let moved_by = |place: usize| frame.get(place).into_iter().flatten().copied();
        let [_, coordinates, velocities, inputs, states, rates, ..] = program.symbols();
        // Entries of (η, ξ, z) that move the coordinates of a block.
        let mut blocks: Vec<BTreeSet<usize>> = Vec::with_capacity(program.nu);
        let (mut place, mut chart) = (0, 0);
        for block in &program.blocks {
            // A plain coordinate moves by itself.
            let (parts, part) = match *block {
                Block::Flat(n) => (n, Block::Flat(1)),
                other => (1, other),
            };
            for _ in 0..parts {
                let own = place..place + part.len();
                let mut entries: BTreeSet<usize> = own.flat_map(moved_by).collect();
                let along = rate.outputs.iter().skip(chart).take(part.dimension());
                let along: Vec<Edge> = along.copied().collect();
                for id in graph.reachable(&along) {
                    let Node::Symbol(symbol) = graph.node(id) else {
                        continue;
                    };
                    let symbol = symbol as usize;
                    if (coordinates..velocities).contains(&symbol) {
                        entries.extend(moved_by(symbol - coordinates));
                    } else if (velocities..inputs).contains(&symbol) {
                        entries.insert(displacements + symbol - velocities);
                    } else if (states..rates).contains(&symbol) {
                        entries.insert(displacements + program.n + symbol - states);
                    }
                }
                blocks.extend(std::iter::repeat_n(entries, part.len()));
                place += part.len();
                chart += part.dimension();
            }
        }
        let motion: Vec<Vec<usize>> = coframe
            .iter()
            .map(|row| {
                let entries: BTreeSet<usize> =
                    row.iter().flat_map(|&a| &blocks[a]).copied().collect();
                entries.into_iter().collect()
            })
            .collect();
        let seeds = seeds(&motion, displacements + program.n + program.n_z);
        Some(Sparsity {
            frame,
            coframe,
            motion,
            seeds,
        })
    }

    /// How many directions there are.
    pub fn directions(&self) -> usize {
        1 + self.seeds.iter().max().copied().unwrap_or_default()
    }
}

/// Directions for a pattern: entries that most rows meet come first, each takes the lowest that is free in these rows.
fn seeds(rows: &[Vec<usize>], entries: usize) -> Vec<usize> {
    let meeting: Vec<Vec<usize>> = (0..entries)
        .map(|entry| {
            (0..rows.len())
                .filter(|&i| rows[i].contains(&entry))
                .collect()
        })
        .collect();
    let mut order: Vec<usize> = (0..entries)
        .filter(|&entry| !meeting[entry].is_empty())
        .collect();
    order.sort_by_key(|&entry| usize::MAX - meeting[entry].len());
    let mut taken = vec![BTreeSet::new(); rows.len()];
    let mut seeds = vec![0; entries];
    for entry in order {
        let free = |direction: &usize| {
            meeting[entry]
                .iter()
                .all(|&i| !taken[i].contains(direction))
        };
        let direction = (0..entries).find(free).unwrap_or_default();
        for &i in &meeting[entry] {
            taken[i].insert(direction);
        }
        seeds[entry] = direction;
    }
    seeds
}

#[cfg(test)]
mod tests {
    use super::seeds;

    /// Entries of one row differ in direction, and no more directions are taken than the longest row needs where no row
    /// forces them.
    #[test]
    fn entries_of_a_row_have_directions_of_their_own() {
        let hull = [0, 1, 2, 3, 4, 5, 8, 9, 10];
        let attitude = [3, 4, 5, 11, 12, 13];
        let mut rows = vec![hull.to_vec(), hull.to_vec(), hull.to_vec()];
        rows.extend([attitude.to_vec(), attitude.to_vec(), attitude.to_vec()]);
        rows.extend([vec![6, 14], vec![7, 15]]);
        let seeds = seeds(&rows, 17);
        for row in &rows {
            let mut own: Vec<usize> = row.iter().map(|&entry| seeds[entry]).collect();
            own.sort_unstable();
            own.dedup();
            assert_eq!(own.len(), row.len(), "{row:?}: {seeds:?}");
        }
        assert_eq!(seeds.iter().max(), Some(&8));
        // Entry 16 moves nothing.
        assert_eq!(seeds[16], 0);
    }
}
