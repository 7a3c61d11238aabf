//! Compares the linearisation of every model with differences of its motion along the manifold; checks that trivial
//! parts cost nothing, and that a wrong sign in any derived function is never emitted.

use crate::thinning::thin_out;
use hamel::{Block, manifold};
use hamel_codegen::algebra::residue_pair::Random;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::model::layout;
use hamel_codegen::program::count::count;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::proof::validate::validate;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Step of central differences, extrapolated once: truncation like h⁴/480 times fifth derivatives
/// (rates reach 150 / s), rounding 1e-16 / h.
const DIFFERENCE_STEP: f64 = 1e-4;
/// Bound of their errors, relative to the largest entry.
const TOLERANCE: f64 = 1e-7;

fn models() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let files = |folder: &Path| std::fs::read_dir(folder).expect("models");
    let mut paths: Vec<PathBuf> = files(&folder)
        .chain(files(&folder.join("multibody")))
        .map(|entry| entry.expect("entry").path())
        .collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "eom"));
    paths.sort();
    assert!(paths.len() > 20, "the models have gone");
    paths
}

fn linearized(path: &Path) -> Generated {
    let text = std::fs::read_to_string(path).expect("readable");
    let generated = from_text(&text).expect("correct");
    Generated::all(generated.model, 0).expect("derived")
}

fn model(name: &str) -> Generated {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    linearized(&path)
}

/// The interpreted functions of a model.
struct At {
    blocks: Vec<Block>,
    rate: Interpreter,
    chart_rate: Interpreter,
    accel: Interpreter,
    n: usize,
    u: Vec<f64>,
}

impl At {
    fn new(generated: &Generated, u: Vec<f64>) -> Self {
        let program = &generated.program;
        let function = |name: &str| {
            let function = program.function(name).expect("generated");
            Interpreter::new(program, function, &program.defaults)
        };
        let blocks = program.blocks.iter().map(|block| match block {
            layout::Block::Flat(n) => Block::Flat(*n),
            layout::Block::Circle => Block::Circle,
            layout::Block::Quaternion => Block::Quaternion,
            layout::Block::Rotation => Block::Rotation,
        });
        At {
            blocks: blocks.collect(),
            rate: function("rate"),
            chart_rate: function("chart_rate"),
            accel: function("accel"),
            n: program.n,
            u,
        }
    }

    /// Moves x by the motion with velocities ξ for a short time.
    fn moved(&self, x: &[f64], xi: &[f64], time: f64) -> Vec<f64> {
        let mut chart = self.chart_rate.call(x, xi, &[], &[]).expect("a value");
        chart.iter_mut().for_each(|entry| *entry *= time);
        let mut moved = x.to_vec();
        manifold::retract(&self.blocks, &mut moved, &chart);
        moved
    }

    /// Moves x along A only: if time is a coordinate, rates have terms without ξ.
    fn displaced(&self, x: &[f64], h: &[f64], time: f64) -> Vec<f64> {
        let chart = |xi: &[f64]| self.chart_rate.call(x, xi, &[], &[]).expect("a value");
        let mut chart = along(&chart(h), &chart(&vec![0.0; self.n]), -1.0);
        chart.iter_mut().for_each(|entry| *entry *= time);
        let mut moved = x.to_vec();
        manifold::retract(&self.blocks, &mut moved, &chart);
        moved
    }

    /// Returns A h.
    fn linear(&self, x: &[f64], h: &[f64]) -> Vec<f64> {
        along(&self.rate(x, h), &self.rate(x, &vec![0.0; self.n]), -1.0)
    }

    fn unit(&self, i: usize) -> Vec<f64> {
        (0..self.n).map(|j| f64::from(u8::from(i == j))).collect()
    }

    fn rate(&self, x: &[f64], xi: &[f64]) -> Vec<f64> {
        self.rate.call(x, xi, &[], &[]).expect("a value")
    }

    fn accel(&self, x: &[f64], xi: &[f64], u: &[f64]) -> Vec<f64> {
        self.accel.call(x, xi, u, &[]).expect("M is regular")
    }
}

fn difference(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let central = |h: f64| -> Vec<f64> {
        let (after, before) = (f(h), f(-h));
        let pairs = after.iter().zip(&before);
        pairs.map(|(a, b)| (a - b) / (2.0 * h)).collect()
    };
    let (coarse, fine) = (central(DIFFERENCE_STEP), central(DIFFERENCE_STEP / 2.0));
    let pairs = coarse.iter().zip(&fine);
    pairs.map(|(c, f)| (4.0 * f - c) / 3.0).collect()
}

fn along(a: &[f64], direction: &[f64], step: f64) -> Vec<f64> {
    a.iter().zip(direction).map(|(a, d)| a + step * d).collect()
}

#[test]
fn linearize_is_the_difference_of_neighbouring_motions() {
    thin_out(models()).par_iter().for_each(|path| {
        let generated = linearized(path);
        // For models with velocity constraints, the build compares with dual numbers.
        if !generated.model.constraints.is_empty() {
            return;
        }
        let program = &generated.program;
        let name = &program.name;
        let mut random = Random::new(7);
        let mut numbers = |count: usize| -> Vec<f64> {
            let one =
                |random: &mut Random| (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
            (0..count).map(|_| one(&mut random)).collect()
        };
        // First-order states follow the velocities.
        let (n, m, n_z) = (program.n, program.m, program.n_z);
        let moving = n + n_z;
        let at = At::new(&generated, numbers(m));
        let mut x = program.start_x.clone();
        // Away from the start, if this only takes the charts.
        if generated.model.points.constraints.is_empty() {
            let there = numbers(n);
            x = at.moved(&x, &there, 0.4);
        }
        let xi = along(&program.start_xi, &numbers(moving), 0.7);
        let linearize = program.function("linearize").expect("generated");
        let linearize = Interpreter::new(program, linearize, &program.defaults);
        let found = linearize.call(&x, &xi, &at.u, &[]).expect("M is regular");
        let columns = n + moving + m;
        assert_eq!(found.len(), (n + moving) * columns);
        let size = found
            .iter()
            .fold(1.0, |size: f64, entry| size.max(entry.abs()));
        let check = |what: &str, j: usize, found: &[f64], expected: &[f64]| {
            for (a, b) in found.iter().zip(expected) {
                assert!(
                    (a - b).abs() <= TOLERANCE * size,
                    "{name}, {what}, column {}: {found:?} against {expected:?}",
                    j + 1
                );
            }
        };
        for j in 0..columns {
            let column = |row: usize| found[row * columns + j];
            let lower: Vec<f64> = (n..n + moving).map(column).collect();
            let upper: Vec<f64> = (0..n).map(column).collect();
            let (slope, moved) = if j < n {
                let unit = at.unit(j);
                let slope = difference(|h| at.accel(&at.displaced(&x, &unit, h), &xi, &at.u));
                // D(A ξ)[A h] − Ȧ h
                let ahead = difference(|h| at.rate(&at.displaced(&x, &unit, h), &xi));
                let swept = difference(|h| at.linear(&at.moved(&x, &xi, h), &unit));
                (slope, along(&ahead, &swept, -1.0))
            } else if j < n + moving {
                let unit: Vec<f64> = (0..moving)
                    .map(|k| f64::from(u8::from(k == j - n)))
                    .collect();
                let slope = difference(|h| at.accel(&x, &along(&xi, &unit, h), &at.u));
                (slope, at.linear(&x, &unit[..n]))
            } else {
                let unit: Vec<f64> = (0..m)
                    .map(|k| f64::from(u8::from(k == j - n - moving)))
                    .collect();
                let slope = difference(|h| at.accel(&x, &xi, &along(&at.u, &unit, h)));
                (slope, vec![0.0; x.len()])
            };
            check("velocities", j, &lower, &slope);
            check("displacements", j, &at.linear(&x, &upper), &moved);
        }
    });
}

/// The best count that another program reaches for the same matrices is 3185.
#[test]
fn the_free_body_is_linearised_in_at_most_300_operations() {
    let program = model("free_body").program;
    let linearize = program.function("linearize").expect("generated");
    let roots: Vec<_> = linearize
        .outputs
        .iter()
        .chain(&linearize.guards)
        .copied()
        .collect();
    let count = count(&program.graph, &roots);
    assert!(count.flops() <= 300, "{} operations", count.flops());
    assert_eq!(count.div, 0);
}

#[test]
fn linearize_is_generated_where_it_is_asked_for() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/cart_pole.eom");
    let text = std::fs::read_to_string(path).expect("readable");
    let generated = from_text(&text).expect("correct");
    assert!(generated.program.function("linearize").is_none());
    let asked = text.replace("gravity", "generate rate, linearize;\n    gravity");
    let code = hamel_codegen::builder::source(&asked, "cart_pole.eom").expect("correct");
    assert!(code.contains("pub fn linearize("), "{code}");
    // The linearised system can be simulated; no other functions are generated.
    assert!(code.contains("hamel::System for"), "{code}");
    assert!(!code.contains("pub fn mass_matrix("), "{code}");
}

/// Validation detects one wrong sign in every function that is a derivative or an inverse.
#[test]
fn wrong_signs_are_never_emitted() {
    let generated = model("free_body_momenta");
    let (model, program) = (&generated.model, &generated.program);
    assert!(validate(model, program).is_ok());
    for name in [
        "momentum",
        "momentum_rate",
        "velocity_from_momentum",
        "linearize",
        "angular_momentum",
        "spin",
    ] {
        let entries = program.function(name).expect("generated").outputs.len();
        let mut caught = 0;
        let mut varied = 0;
        for entry in 0..entries {
            let mut wrong = program.clone();
            let function = wrong.functions.iter_mut().find(|f| f.name == name);
            let output = &mut function.expect("generated").outputs[entry];
            if *output == program.graph.zero() {
                continue;
            }
            // For large models, one sign in every function is enough.
            varied += 1;
            if varied > 12 {
                break;
            }
            *output = -*output;
            caught += usize::from(validate(model, &wrong).is_err());
        }
        assert_eq!(caught, varied.min(12), "{name}");
        assert!(caught > 0, "{name}");
    }
}
