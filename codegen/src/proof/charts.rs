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

#[cfg(test)]
mod tests {
    use super::validate;
    use crate::derive::reduction::reduce;
    use crate::generate::from_text;
    use crate::program::FunctionId;

    /// Coordinates of every kind, and velocities that a constraint takes away.
    const MODELS: [&str; 2] = [
        "system Kinds {
            coord r: R3, q: S3, R: SO3, a: S1, z;
            velocity v: vec3, w: vec3, o: vec3, b, u;
            rate r = R * v;
            rate q = qmul(q, [0, w[1], w[2], w[3]]) / 2;
            rate R = R * hat(o);
            rate a = b - u;
            rate z = u;
            kinetic dot(v, v) / 2 + dot(w, w) / 2 + dot(o, o) / 2 + b^2 / 2 + u^2 / 2;
        }",
        "system Disk {
            coord x, y, a: S1; velocity u, v, w; rate x = u; rate y = v; rate a = w + u;
            kinetic u^2 / 2 + v^2 / 2 + w^2 / 2;
            nonholonomic u * a.s - v * a.c = 0;
        }",
    ];

    #[test]
    fn a_wrong_sign_is_noticed() {
        for text in MODELS {
            let generated = from_text(text).unwrap_or_else(|errors| panic!("{errors:?}"));
            let reduction = reduce(&generated.model).expect("regular");
            let reduced = reduction.as_ref().map(|reduction| &reduction.model);
            let model = reduced.unwrap_or(&generated.model);
            assert!(validate(model, &generated.program).is_ok());
            let chart = (generated.program.functions.iter())
                .position(|function| function.id == Some(FunctionId::ChartRate))
                .expect("it is there");
            for place in 0..generated.program.functions[chart].outputs.len() {
                let mut wrong = generated.program.clone();
                let entry = &mut wrong.functions[chart].outputs[place];
                *entry = -*entry;
                let error = validate(model, &wrong).expect_err("a wrong sign");
                assert!(
                    error.message.contains("rate of the chart"),
                    "{}",
                    error.message
                );
            }
        }
    }
}
