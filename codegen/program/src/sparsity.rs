//! Sparsity of a motion along the chart rate: the displacements and velocities on which each displacement at its end
//! depends, and directions of differentiation that many of them share.
//!
//! x⁺ is x moved along the chart rate for a time, block by block, and η⁺ = Y(x⁺) δx⁺. Entries of (η, ξ) that occur
//! together in no row can share one direction, so that dual numbers with few directions yield all slopes. Source:
//! A. R. Curtis, M. J. D. Powell, J. K. Reid, *On the estimation of sparse Jacobian matrices*, J. Inst. Maths Applics
//! 13 (1974).

use std::collections::BTreeSet;

use super::seeds::seeds;
use super::{FunctionId, Program, Shape};
use hamel_algebra::graph::{Edge, Node};
use hamel_language::model::layout::Block;
use num_traits::Zero;

/// Sparsity patterns, and a direction for each entry of η, ξ and z.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sparsity {
    /// Nonzero entries of each row of the frame A(x).
    pub frame: Vec<Vec<usize>>,
    /// Nonzero entries of each row of the coframe Y(x).
    pub coframe: Vec<Vec<usize>>,
    /// For each row of η⁺ the entries of (η, ξ, z) on which it depends, in order.
    pub motion: Vec<Vec<usize>>,
    /// Direction of each entry of (η, ξ, z); 0 for entries on which nothing depends.
    pub seeds: Vec<usize>,
}

impl Sparsity {
    /// Returns the sparsity of a program; `None` if it has no frame of displacements.
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
        // For each coordinate the entries of (η, ξ, z) that move the block to which it belongs.
        let mut blocks: Vec<BTreeSet<usize>> = Vec::with_capacity(program.nu);
        let (mut place, mut chart) = (0, 0);
        for block in &program.blocks {
            // Each plain coordinate moves by itself.
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

    /// Returns the number of directions.
    pub fn directions(&self) -> usize {
        1 + self.seeds.iter().max().copied().unwrap_or_default()
    }
}
