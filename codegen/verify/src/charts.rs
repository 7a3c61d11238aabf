//! Rates of charts: K(x) times them has to be ẋ. The tangents K are those of `model/charts`, which the generator does
//! not use to compute the rates.

use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::Edge;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tape::Tape;
use hamel_language::model::charts::all_tangents;
use hamel_program::{FunctionId, Program};

/// Comparison of K times the emitted rates of the chart with ẋ; `None` inside if no such rates are emitted.
pub(super) struct ChartComparison(Option<Tangents>);

struct Tangents {
    tape: Tape,
    columns: usize,
}

impl ChartComparison {
    /// Prepares the comparison for a program; `None` if an expression has no value modulo p.
    pub(super) fn new(program: &Program) -> Option<Self> {
        let Some(chart) = program.function(FunctionId::ChartRate) else {
            return Some(ChartComparison(None));
        };
        let [_, first, end, ..] = program.symbols();
        let mut graph = program.graph.clone();
        let symbol = |place: usize| Edge::of(program.graph.symbols()[place].node);
        let x: Vec<Edge> = (first..end).map(symbol).collect();
        let columns = all_tangents(&mut graph, &program.blocks, &x, |_| true);
        let roots = columns.iter().flatten().chain(&chart.outputs);
        let roots: Vec<Edge> = roots.copied().collect();
        let tape = Tape::new(&graph, &roots)?;
        let columns = columns.len();
        Some(ChartComparison(Some(Tangents { tape, columns })))
    }

    /// Returns whether K times the rates of the chart is the given ẋ at a point; `None` if they have no value there.
    pub(super) fn hold(&self, rate: &[ResiduePair], point: &FieldPoint) -> Option<bool> {
        let Some(Tangents { tape, columns }) = &self.0 else {
            return Some(true);
        };
        let mut values = tape.values(point)?;
        let chart = values.split_off(columns * rate.len());
        let mut moved = vec![ResiduePair::ZERO; rate.len()];
        for (place, tangent) in values.iter().enumerate() {
            let (column, row) = (place / rate.len(), place % rate.len());
            moved[row] = moved[row] + *tangent * *chart.get(column)?;
        }
        Some(*columns == chart.len() && moved == rate)
    }
}
