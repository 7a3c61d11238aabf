//! The rates of charts: K(x) times them is ẋ, with the tangents K of `model/charts`, by which the generator does not compute
//! them.

use crate::algebra::fp::Fp;
use crate::algebra::graph::Edge;
use crate::algebra::lane::Lane;
use crate::algebra::numeric::evaluate_at;
use crate::model::charts::all_tangents;
use crate::program::{FunctionId, Program};

/// Whether the emitted rates of the chart give these rates ẋ at a point; `None` where they have no value there.
pub(super) fn hold(program: &Program, rate: &[Fp], lane: &Lane) -> Option<bool> {
    let Some(chart) = program.function(FunctionId::ChartRate) else {
        return Some(true);
    };
    let [_, first, end, ..] = program.symbols();
    let mut graph = program.graph.clone();
    let symbol = |place: usize| Edge::of(program.graph.symbols()[place].node);
    let x: Vec<Edge> = (first..end).map(symbol).collect();
    let columns = all_tangents(&mut graph, &program.blocks, &x, |_| true);
    let roots: Vec<Edge> = columns
        .iter()
        .flatten()
        .chain(&chart.outputs)
        .copied()
        .collect();
    let mut values = evaluate_at(&graph, &roots, &mut lane.clone())?;
    let chart = values.split_off(values.len() - chart.outputs.len());
    let mut moved = vec![Fp::ZERO; rate.len()];
    for (place, tangent) in values.iter().enumerate() {
        let (column, row) = (place / rate.len(), place % rate.len());
        moved[row] = moved[row] + *tangent * chart[column];
    }
    Some(columns.len() == chart.len() && moved == rate)
}
