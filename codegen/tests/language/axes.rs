//! Axes of joints and their perpendicular planes: exact unit vectors.

use hamel_language::algebra::derivation::Derivation;
use hamel_language::algebra::linear::{Vec3, cross};
use hamel_language::algebra::numeric::evaluate;
use hamel_language::lower::build;
use hamel_language::model::Model;
use hamel_language::syntax::parse_text;

/// Returns the motion of a frame with a coordinate: the axis of a slide, or a direction in a plane.
fn direction(model: &mut Model, frame: &str, coordinate: usize) -> Vec3 {
    let frames = &model.frames;
    let frame = frames.iter().find(|f| f.name == frame).expect("a frame");
    let along = (model.x[coordinate].node(), model.graph.one());
    let mut along = Derivation::new([along]);
    frame
        .position
        .map(|entry| along.of(&mut model.graph, entry))
}

/// Every direction becomes a vector of the same direction whose square is exactly one.
#[test]
fn axes_are_units_exactly() {
    for axis in [
        ["0", "0", "1"],
        ["0", "-2", "0"],
        ["3", "0", "4"],
        ["1", "1", "0"],
        ["1", "1", "1"],
        ["-57735/100000", "57735/100000", "-57735/100000"],
        ["1/1000000000", "1", "0"],
    ] {
        let joints = format!(
            "joint s: prismatic [{0}] moves f; joint p: planar [{0}] moves g;",
            axis.join(", ")
        );
        let loads = "body on f { mass 1; } body on g { mass 1; inertia identity(3) about com; }";
        let system = parse_text(&format!("system S {{ {joints} {loads} }}")).expect("a system");
        let mut model = build(&system).unwrap_or_else(|_| panic!("{axis:?} has a direction"));
        let unit = direction(&mut model, "f", 0);
        let graph = &mut model.graph;
        assert_eq!(graph.dot(&unit, &unit), graph.one(), "{axis:?}");
        let numbers = model.numbers(&model.defaults, &[0.0; 4], &[0.0; 4], &[], &[0.0; 4]);
        let n = evaluate(&model.graph, &unit, &numbers);
        let a = axis.map(|entry| {
            let (n, d) = entry.split_once('/').unwrap_or((entry, "1"));
            let parse = |t: &str| t.parse::<f64>().expect("a number");
            parse(n) / parse(d)
        });
        let length = a.iter().map(|a| a * a).sum::<f64>().sqrt();
        // Rounding of f64.
        assert!(
            (0..3).all(|k| (n[k] - a[k] / length).abs() < 2e-16),
            "{axis:?}: {n:?}"
        );
        let column = [1, 2].map(|place| direction(&mut model, "g", place));
        let third = cross(&mut model.graph, column[0], column[1]);
        assert_eq!(third, unit, "{axis:?}");
    }
}
