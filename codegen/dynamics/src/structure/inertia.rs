//! Inertia that remains when plain coordinates are shifted to centres of mass: one constant matrix
//! for each rotor, and one for plain and circular coordinates together.

use super::centre::{CentreShift, centre_shift};
use super::constant::eliminate_symbols;
use super::context::StructureContext;
use super::rates::{CoordinateBlock, RateMaps, changing_parts, is_volume_preserving, rate_maps};
use crate::accel::parts::EquationTerms;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Mat3, matrix, multiply, solve_symmetric, transpose};
use hamel_language::model::layout::Block;
use hamel_program::structure::Reason;

/// System whose inertia splits into constant blocks.
pub struct SplitInertia {
    /// Maps w = B ξ and ξ = N w.
    pub rates: RateMaps,
    /// Offset y − x and its rate.
    pub shift: CentreShift,
    /// Inertia matrix J of every rotor, in order.
    pub rotors: Vec<Mat3>,
    /// Indices of the rates of plain and circular coordinates.
    pub uniform: Vec<usize>,
    /// Inertia of these rates.
    pub block: Vec<Vec<Edge>>,
}

/// Splits the inertia of a model into constant blocks; the error lists the reasons why it does not split.
///
/// # Errors
/// Returns the reasons why it does not split.
pub fn split_inertia(
    context: &StructureContext,
    graph: &mut Graph,
    traced: &EquationTerms,
) -> Result<SplitInertia, Vec<Reason>> {
    let StructureContext {
        model,
        parts,
        variation,
    } = *context;
    let n = model.n();
    let zero = graph.zero();
    let Some(rates) = rate_maps(model, graph) else {
        return Err(vec![Reason::Rates]);
    };
    let depends = |graph: &Graph, edges: &[Edge]| {
        let on = changing_parts(variation, graph, parts, &model.x, edges);
        vec![Reason::Mass { on }]
    };
    let mn = multiply(graph, &traced.mass, &rates.to_velocities);
    let inertia = multiply(graph, &transpose(&rates.to_velocities), &mn);
    let plain: Vec<usize> = parts
        .iter()
        .filter(|part| matches!(part.block, Block::Flat(_)))
        .flat_map(CoordinateBlock::rates)
        .collect();
    let square = |places: &[usize]| -> Vec<Edge> {
        let rows = places.iter();
        rows.flat_map(|&i| places.iter().map(move |&j| (i, j)))
            .map(|(i, j)| inertia[i][j])
            .collect()
    };
    let of_plain = square(&plain);
    if variation
        .changes(graph, &of_plain, &model.x)
        .contains(&true)
    {
        return Err(depends(graph, &inertia.concat()));
    }
    let of_plain = eliminate_symbols(model, graph, parts, variation, &of_plain);
    // K = D⁻¹ M, with the rows of the plain rates.
    let right: Vec<Vec<Edge>> = plain.iter().map(|&f| inertia[f].clone()).collect();
    let of_plain: Vec<Vec<Edge>> = matrix(&of_plain, plain.len());
    let Some(coupling) = solve_symmetric(graph, &of_plain, &right) else {
        return Err(depends(graph, &inertia.concat()));
    };
    let shift = centre_shift(model, graph, parts, &plain, &coupling);
    // T⁻¹ = I − K, since K maps turning rates to plain ones.
    let mut back: Vec<Vec<Edge>> = shift
        .rate
        .iter()
        .map(|row| row.iter().map(|&edge| -edge).collect())
        .collect();
    for (i, row) in back.iter_mut().enumerate() {
        row[i] = graph.one();
    }
    let left = multiply(graph, &inertia, &back);
    let left = multiply(graph, &transpose(&back), &left);
    if variation
        .changes(graph, &left.concat(), &model.x)
        .contains(&true)
    {
        let on = depends(graph, &inertia.concat());
        return Err(on);
    }
    if !is_volume_preserving(model, graph, &rates) {
        return Err(vec![Reason::Rates]);
    }
    let left = eliminate_symbols(model, graph, parts, variation, &left.concat());
    if left.iter().any(|edge| !graph.is_free(edge.node())) {
        return Err(depends(graph, &inertia.concat()));
    }
    let coupled = coupled(parts, |i, j| left[i * n + j] != zero);
    if !coupled.is_empty() {
        return Err(coupled);
    }
    let uniform: Vec<usize> = parts
        .iter()
        .filter(|part| !part.is_rotor())
        .flat_map(CoordinateBlock::rates)
        .collect();
    let block = uniform
        .iter()
        .map(|&i| uniform.iter().map(|&j| left[i * n + j]).collect())
        .collect();
    let rotors = parts
        .iter()
        .filter(|part| part.is_rotor())
        .map(|part| {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| left[(part.rate + i) * n + part.rate + j])
            })
        })
        .collect();
    Ok(SplitInertia {
        rates,
        shift,
        rotors,
        uniform,
        block,
    })
}

/// Returns each rotor that the remaining inertia couples to other coordinates, together with these.
fn coupled(parts: &[CoordinateBlock], linked: impl Fn(usize, usize) -> bool) -> Vec<Reason> {
    let mut found = Vec::new();
    for (place, rotor) in parts.iter().enumerate().filter(|(_, part)| part.is_rotor()) {
        for (index, other) in parts.iter().enumerate() {
            if index == place || (other.is_rotor() && index < place) {
                continue;
            }
            if rotor.rates().any(|i| other.rates().any(|j| linked(i, j))) {
                found.push(Reason::Coupled {
                    rotor: rotor.name.clone(),
                    other: other.name.clone(),
                });
            }
        }
    }
    found
}
