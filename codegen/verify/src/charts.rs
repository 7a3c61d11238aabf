//! The rates of charts: K(x) times them is ẋ, with the tangents K of `model/charts`, by which the generator does not compute
//! them.

use hamel_algebra::fp::Fp;
use hamel_algebra::graph::Edge;
use hamel_algebra::lane::Lane;
use hamel_algebra::tape::Tape;
use hamel_language::model::charts::all_tangents;
use hamel_program::{FunctionId, Program};

/// K and the emitted rates of the chart, to be evaluated together; nothing where no such rates are emitted.
pub(super) struct Charts(Option<Tangents>);

struct Tangents {
    tape: Tape,
    columns: usize,
}

impl Charts {
    /// Those of a program; `None` where they have no numbers.
    pub(super) fn new(program: &Program) -> Option<Self> {
        let Some(chart) = program.function(FunctionId::ChartRate) else {
            return Some(Charts(None));
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
        Some(Charts(Some(Tangents { tape, columns })))
    }

    /// Whether the rates of the chart give these rates ẋ at a point; `None` where they have no value there.
    pub(super) fn hold(&self, rate: &[Fp], lane: &Lane) -> Option<bool> {
        let Some(Tangents { tape, columns }) = &self.0 else {
            return Some(true);
        };
        let mut values = tape.values(lane)?;
        let chart = values.split_off(columns * rate.len());
        let mut moved = vec![Fp::ZERO; rate.len()];
        for (place, tangent) in values.iter().enumerate() {
            let (column, row) = (place / rate.len(), place % rate.len());
            moved[row] = moved[row] + *tangent * *chart.get(column)?;
        }
        Some(*columns == chart.len() && moved == rate)
    }
}
