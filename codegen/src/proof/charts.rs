//! The proof of the rates of charts: K(x) times them is ẋ, with the tangents K of `model/charts`, by which the
//! generator does not compute them.

use super::points::{Unequal, at_fresh_points};
use super::verdict::failure;
use crate::algebra::fp::Fp;
use crate::algebra::graph::Edge;
use crate::algebra::numeric::evaluate_at;
use crate::diagnostics::Diagnostic;
use crate::model::Model;
use crate::model::charts::all_tangents;
use crate::program::{FunctionId, Program};

/// Compares at fresh points of X, those of the velocities that constraints leave; the rates ẋ themselves have been
/// proved. Where there is no such point nothing is said. Not for systems with prescribed coordinates.
pub fn validate(model: &Model, program: &Program) -> Result<(), Diagnostic> {
    let outputs = |id| Some(&program.function(id)?.outputs);
    let functions = (outputs(FunctionId::Rate), outputs(FunctionId::ChartRate));
    let (Some(rate), Some(chart)) = functions else {
        return Ok(());
    };
    let [_, first, end, ..] = program.symbols();
    let mut graph = program.graph.clone();
    let symbol = |place: usize| Edge::of(program.graph.symbols()[place].node);
    let x: Vec<Edge> = (first..end).map(symbol).collect();
    let columns = all_tangents(&mut graph, &program.blocks, &x, |_| true);
    let mut roots = columns.concat();
    roots.extend(rate.iter().chain(chart));
    let compared = at_fresh_points(
        |number| model.points.lane(0xc4_a27 + number),
        |lane, _| {
            let mut values = evaluate_at(&graph, &roots, &mut lane.clone())?;
            let chart = values.split_off(values.len() - chart.len());
            let rate = values.split_off(values.len() - rate.len());
            let mut moved = vec![Fp::ZERO; rate.len()];
            for (place, tangent) in values.iter().enumerate() {
                let (column, row) = (place / rate.len(), place % rate.len());
                moved[row] = moved[row] + *tangent * chart[column];
            }
            let agrees = columns.len() == chart.len() && moved == rate;
            Some(if agrees { Ok(()) } else { Err(()) })
        },
    );
    match compared {
        Err(Unequal::Differs(())) => Err(failure(model, "K(x) times the rate of the chart = ẋ")),
        Ok(()) | Err(Unequal::Nowhere) => Ok(()),
    }
}
