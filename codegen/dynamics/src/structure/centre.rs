//! Shift of plain coordinates to centres of mass.
//!
//! The shifted coordinates are y = r + R s; in general y = r + ⟨G, R⟩ with a constant G for every
//! plain coordinate and every rotation, and y = x + a c + b s for circles.
//!
//! If the inertia of the plain and the turning rates is [D, D K; Kᵀ D, ·], then ẏ = ẋ + K ω removes
//! the coupling. K ω has to be the rate of ⟨G, R⟩ along the rotation, Kᵢ = Σₐ (Gₐⱼ Rₐₖ − Gₐₖ Rₐⱼ)
//! for i, j, k cyclic. G is determined from the twelve rotations of the tetrahedron, over which
//! products of entries of R average to δ/3; whether it reproduces K is checked by means of the
//! remaining inertia.

use super::constant::rest_configuration;
use super::rates::CoordinateBlock;
use super::tetrahedron::{rotation_matrix, tetrahedron};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Mat3, dot_mat3};
use hamel_algebra::transplant::substitute;
use hamel_language::model::Model;
use hamel_language::model::layout::Block;
use hamel_language::model::rotations::quaternion_matrix;

/// Shift of plain coordinates to centred ones, for which the inertia splits, and its rate.
#[derive(Clone, Debug)]
pub struct CentreShift {
    /// Offset y − x, ν entries.
    pub offset: Vec<Edge>,
    /// Rate offset ẏ − ẋ per unit of each rate, n × n: rows of plain coordinates, columns of
    /// turning ones.
    pub rate: Vec<Vec<Edge>>,
}

/// Computes the shift to centred coordinates for K, where `coupling[f][c]` is the entry for plain rate f and turning
/// rate c.
///
/// There is no offset where a row of K is zero.
pub fn centre_shift(
    model: &Model,
    graph: &mut Graph,
    parts: &[CoordinateBlock],
    plain: &[usize],
    coupling: &[Vec<Edge>],
) -> CentreShift {
    let (n, zero) = (model.n(), graph.zero());
    let mut shift = CentreShift {
        offset: vec![zero; model.nu()],
        rate: vec![vec![zero; n]; n],
    };
    let places: Vec<(usize, usize)> = parts
        .iter()
        .filter(|part| matches!(part.block, Block::Flat(_)))
        .flat_map(|part| part.rates().zip(part.first..))
        .collect();
    for part in parts {
        for (row, &f) in plain.iter().enumerate() {
            let k: Vec<Edge> = part.rates().map(|c| coupling[row][c]).collect();
            if k.iter().all(|&edge| edge == zero) {
                continue;
            }
            let Some((offset, rate)) = offset(model, graph, parts, part, &k) else {
                continue;
            };
            if let Some((_, place)) = places.iter().find(|(rate, _)| *rate == f) {
                shift.offset[*place] = graph.add(shift.offset[*place], offset);
            }
            for (c, entry) in part.rates().zip(rate) {
                shift.rate[f][c] = entry;
            }
        }
    }
    shift
}

/// Returns ⟨G, R⟩ and its rates for one row of K; `None` for plain coordinates.
fn offset(
    model: &Model,
    graph: &mut Graph,
    parts: &[CoordinateBlock],
    part: &CoordinateBlock,
    k: &[Edge],
) -> Option<(Edge, Vec<Edge>)> {
    let x = part.entries(&model.x).to_vec();
    let rest = rest_configuration(model, graph, parts, 0);
    // K where the part has the given numbers and all other coordinates are at rest.
    let at = |graph: &mut Graph, numbers: &[(i64, i64)]| -> Vec<Edge> {
        let mut set = rest.clone();
        for (&entry, &(p, q)) in x.iter().zip(numbers) {
            let Some(index) = graph.as_symbol(entry) else {
                continue;
            };
            let number = graph.ratio(p, q);
            if let Some(known) = set.iter_mut().find(|(symbol, _)| *symbol == index) {
                known.1 = number;
            }
        }
        substitute(graph, k, &set)
    };
    match part.block {
        Block::Flat(_) => None,
        Block::Circle => {
            let half = graph.ratio(1, 2);
            let between = |graph: &mut Graph, a: (i64, i64), b: (i64, i64)| {
                let (a, b) = (
                    at(graph, &[(a.0, 1), (a.1, 1)])[0],
                    at(graph, &[(b.0, 1), (b.1, 1)])[0],
                );
                let difference = graph.sub(a, b);
                graph.mul(half, difference)
            };
            // d/dθ (a c + b s) = b c − a s.
            let b = between(graph, (1, 0), (-1, 0));
            let a = between(graph, (0, -1), (0, 1));
            let offset = graph.dot(&[a, b], &x);
            let rate = graph.dot(&[b, -a], &x);
            Some((offset, vec![rate]))
        }
        Block::Quaternion | Block::Rotation => {
            let mut sums = [[graph.zero(); 3]; 3];
            for quaternion in tetrahedron() {
                let turned = rotation_matrix(quaternion);
                let numbers: Vec<(i64, i64)> = match part.block {
                    Block::Quaternion => quaternion.iter().map(|&q| (q, 2)).collect(),
                    _ => turned.iter().flatten().map(|&r| (r, 1)).collect(),
                };
                let values = at(graph, &numbers);
                for (i, &value) in values.iter().enumerate() {
                    let (j, l) = ((i + 1) % 3, (i + 2) % 3);
                    for (a, row) in turned.iter().enumerate() {
                        match row[l] {
                            0 => {}
                            sign => sums[a][j] = graph.add(sums[a][j], value.signed(sign < 0)),
                        }
                    }
                }
            }
            let quarter = graph.ratio(1, 4);
            let g: Mat3 = sums.map(|row| row.map(|sum| graph.mul(quarter, sum)));
            let rotation = rotation_matrix_of(graph, part, &x)?;
            let offset = dot_mat3(graph, &g, &rotation);
            let rate = (0..3)
                .map(|i| {
                    let (j, l) = ((i + 1) % 3, (i + 2) % 3);
                    let column = |m: &Mat3, k: usize| [m[0][k], m[1][k], m[2][k]];
                    let plus = graph.dot(&column(&g, j), &column(&rotation, l));
                    let minus = graph.dot(&column(&g, l), &column(&rotation, j));
                    graph.sub(plus, minus)
                })
                .collect();
            Some((offset, rate))
        }
    }
}

/// Returns the rotation matrix R of a rotor's coordinates.
pub fn rotation_matrix_of(graph: &mut Graph, part: &CoordinateBlock, x: &[Edge]) -> Option<Mat3> {
    match part.block {
        Block::Quaternion => Some(quaternion_matrix(graph, x.try_into().ok()?)),
        Block::Rotation => {
            let rows: [Edge; 9] = x.try_into().ok()?;
            Some(std::array::from_fn(|i| {
                std::array::from_fn(|j| rows[3 * i + j])
            }))
        }
        _ => None,
    }
}
