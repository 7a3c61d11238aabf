//! Small hand-written programs.

use super::sketch::{Declared, function, sketch};
use hamel_codegen::algebra::graph::{Edge, Function as Elementary};
use hamel_codegen::model::layout::{Block, chart_rate};
use hamel_codegen::program::{Argument, Program, Shape};
use hamel_codegen::syntax::ast::{CoordKind, ShapeKind};

const X: Argument = Argument::Coordinates;
const XI: Argument = Argument::Velocities;
const XI_DOT: Argument = Argument::Accelerations;
const U: Argument = Argument::Inputs;

/// A driven pendulum, x = (cos θ, sin θ), ξ = θ̇: m l² θ̈ = τ − m g l sin θ.
pub fn pendulum() -> Program {
    let s = ShapeKind::Scalar;
    let (mut program, [p, x, xi, u, xi_dot]) = sketch(
        "Pendulum",
        &Declared {
            params: &[("m", s), ("l", s), ("g", s)],
            coordinates: &[("θ", CoordKind::S1)],
            velocities: &[("ω", s)],
            inputs: &[("τ", s)],
        },
    );
    program.docs = vec!["A driven pendulum.".into()];
    program.phi = 1;
    let graph = &mut program.graph;
    let square = graph.mul(p[1], p[1]);
    let inertia = graph.mul(p[0], square);
    let weight = graph.mul(p[0], p[2]);
    let moment = graph.mul(weight, p[1]);
    let gravity = graph.mul(moment, x[1]);
    let force = graph.sub(u[0], gravity);
    let accel = graph.div(force, inertia).unwrap();
    let product = graph.mul(inertia, xi_dot[0]);
    let inverse = graph.add(product, gravity);
    let rate: Vec<Edge> = [(-x[1]), x[0]]
        .iter()
        .map(|&e| graph.mul(e, xi[0]))
        .collect();
    let chart = chart_rate(graph, Block::Circle, &x, &rate);
    let norm = graph.dot(&x, &x);
    let minus_one = -graph.one();
    let phi = graph.add(norm, minus_one);
    let half = graph.ratio(1, 2);
    let pull: Vec<Edge> = x.iter().map(|&e| graph.mul(e, phi)).map(|e| -e).collect();
    let correction: Vec<Edge> = pull.into_iter().map(|e| graph.mul(half, e)).collect();
    let kinetic = graph.mul(xi[0], xi[0]);
    let kinetic = graph.mul(kinetic, inertia);
    let kinetic = graph.mul(half, kinetic);
    let potential = -graph.mul(moment, x[0]);
    program.names = vec![("moment".into(), gravity), ("φ".into(), phi)];
    program.constant_guards = vec![inertia];
    program.functions = vec![
        function("rate", &[X, XI], Shape::Vector(2), rate),
        function("accel", &[X, XI, U], Shape::Vector(1), vec![accel]),
        function(
            "inverse_dynamics",
            &[X, XI, XI_DOT],
            Shape::Vector(1),
            vec![inverse],
        ),
        function("chart_rate", &[X, XI], Shape::Vector(1), chart),
        function("correction", &[X], Shape::Vector(2), correction),
        function("constraint", &[X], Shape::Vector(1), vec![phi]),
        function("kinetic_energy", &[X, XI], Shape::Scalar, vec![kinetic]),
        function("potential_energy", &[X], Shape::Scalar, vec![potential]),
    ];
    program
}

/// Returns a program with every kind of node, place and shape that can be printed, under names that are hard to print.
pub fn everything() -> Program {
    let s = ShapeKind::Scalar;
    let (mut program, [p, x, xi, u, xi_dot]) = sketch(
        "θSystem",
        &Declared {
            params: &[
                ("self", s),
                ("k", s),
                ("Θ", ShapeKind::Symmetric(3)),
                ("theta", ShapeKind::Vector(2)),
                ("rate", ShapeKind::Matrix(2)),
                ("set_k", s),
                ("é", s),
            ],
            coordinates: &[
                ("q", CoordKind::Real),
                ("R", CoordKind::SO3),
                ("type", CoordKind::S3),
                ("X", CoordKind::SE3),
                ("r", CoordKind::Euclidean(2)),
            ],
            velocities: &[("ω", ShapeKind::Vector(3)), ("move", s)],
            inputs: &[("f", s)],
        },
    );
    let graph = &mut program.graph;
    let pi = Edge::of(graph.symbols()[0].node);
    let sum = graph.add(p[0], x[0]);
    let difference = graph.sub(x[1], xi[0]);
    let swapped = graph.sub(xi[1], x[2]);
    let product = graph.mul(sum, difference);
    let fused = graph.add(product, x[3]);
    let other = graph.mul(swapped, x[4]);
    let negated = graph.sub(x[5], other);
    let third = graph.mul(u[0], x[6]);
    let reduced = graph.sub(third, x[7]);
    let squares = [graph.mul(x[2], x[2]), graph.mul(xi[0], xi[0])];
    let radicand = graph.add(squares[0], squares[1]);
    let one = graph.one();
    let positive = graph.add(radicand, one);
    let root = graph.apply(Elementary::Sqrt, positive);
    let quotient = graph.div(fused, root).unwrap();
    let inverse = graph.div(one, positive).unwrap();
    let scaled = graph.ratio(-7, 3);
    let scaled = graph.mul(scaled, negated);
    let angle = graph.mul(pi, x[0]);
    let (sin, cos) = (
        graph.apply(Elementary::Sin, angle),
        graph.apply(Elementary::Cos, angle),
    );
    let (sin_q, cos_r) = (
        graph.apply(Elementary::Sin, x[0]),
        graph.apply(Elementary::Cos, x[1]),
    );
    let exponential = graph.apply(Elementary::Exp, -sum);
    let logarithm = graph.apply(Elementary::Log, positive);
    let arc = graph.atan2(reduced, -positive);
    let hoisted = graph.apply(Elementary::Sqrt, p[1]);
    let hoisted = graph.add(hoisted, p[5]);
    let kept = graph.mul(hoisted, x[1]);
    let two = graph.ratio(2, 1);
    let number = graph.apply(Elementary::Sqrt, two);
    let number = graph.mul(number, xi_dot[0]);
    let trig = graph.mul(sin, cos);
    let tiny = graph.rational(&num_rational::BigRational::new(
        314159.into(),
        100000.into(),
    ));
    let list = vec![
        quotient,
        inverse,
        -scaled,
        trig,
        sin_q,
        cos_r,
        exponential,
        logarithm,
        -arc,
        kept,
        number,
        graph.zero(),
        -one,
        tiny,
        pi,
        p[2],
        -p[9],
        x[11],
        reduced,
        graph.ratio(1, 3),
    ];
    let n = list.len();
    program.names = vec![
        ("self".into(), quotient),
        ("x".into(), scaled),
        ("t2".into(), inverse),
        ("ω̇".into(), -kept),
        ("sin_q".into(), arc),
    ];
    let mut pivoted = function("type", &[X, XI, XI_DOT, U], Shape::Vector(n), list.clone());
    pivoted.guards = vec![positive, root, p[1], graph.one()];
    pivoted.fallible = true;
    let positive_p = graph.mul(p[2], p[2]);
    program.constant_guards = vec![positive_p, p[1], graph.one()];
    program.functions = vec![
        pivoted,
        function("new", &[X, XI, XI_DOT, U], Shape::Matrix(2, n / 2), list),
        function("unused", &[X, XI], Shape::Scalar, vec![x[0]]),
        function("constant", &[], Shape::Scalar, vec![p[3]]),
        function("θ1", &[X], Shape::Vector(2), vec![sin_q, -cos_r]),
        function("clone", &[X], Shape::Matrix(1, 2), vec![graph.zero(), x[2]]),
    ];
    program
}

/// Returns a random program of about `size` live statements, with `pivots` guards.
pub fn random(size: usize, pivots: usize) -> Program {
    reaching(size, pivots, size)
}

/// Returns a random program of parameters only, without pivots.
pub fn constant(size: usize) -> Program {
    drawn(size, 0, size, true)
}

/// Returns a random program in which no value is read after more than `reach` others, except in one sum of all.
pub fn reaching(size: usize, pivots: usize, reach: usize) -> Program {
    drawn(size, pivots, reach, false)
}

fn drawn(size: usize, pivots: usize, reach: usize, constant: bool) -> Program {
    let s = ShapeKind::Vector(4);
    let (mut program, [p, x, xi, u, _]) = sketch(
        "Random",
        &Declared {
            params: &[("p", s)],
            coordinates: &[("q", CoordKind::Euclidean(8))],
            velocities: &[("v", ShapeKind::Vector(8))],
            inputs: &[("f", s)],
        },
    );
    let graph = &mut program.graph;
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut draw = |n: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % n.max(1) as u64) as usize
    };
    let mut pool: Vec<Edge> = match constant {
        true => p.clone(),
        false => x.iter().chain(&xi).chain(&u).copied().collect(),
    };
    let mut constants = p.clone();
    for _ in 0..size / 10 {
        let (a, b) = (
            constants[draw(constants.len())],
            constants[draw(constants.len())],
        );
        let product = graph.mul(a, b);
        let next = graph.add(product, p[draw(4)]);
        constants.push(graph.apply(Elementary::Cos, next));
    }
    let mut guards = Vec::new();
    let one = graph.one();
    while pool.len() < size {
        // Mostly recent values, so that everything stays live; sometimes through a bounded function.
        let near = pool.len() - draw(reach.min(40).min(pool.len())) - 1;
        let far = pool.len() - draw(reach.min(pool.len())) - 1;
        let (a, b) = (pool[near], pool[far]);
        let next = match draw(12) {
            0..4 => graph.add(a, b),
            4..6 => graph.sub(a, b),
            6 => graph.mul(constants[draw(constants.len())], a),
            7 => graph.ratio(1 + draw(9) as i64, 7),
            8 => graph.apply(Elementary::Sin, a),
            9 => graph.apply(Elementary::Cos, a),
            _ => {
                let (sin, cos) = (
                    graph.apply(Elementary::Sin, a),
                    graph.apply(Elementary::Cos, b),
                );
                graph.mul(sin, cos)
            }
        };
        pool.push(next);
        if guards.len() < pivots && pool.len().is_multiple_of(size / pivots.max(1)) {
            let square = graph.mul(next, next);
            let guard = graph.add(square, one);
            guards.push(guard);
            pool.push(graph.div(next, guard).unwrap());
        }
    }
    let mut outputs = pool.split_off(pool.len() - 12);
    // Results that are read again, one of them negated.
    outputs[9] = pool[pool.len() / 3];
    outputs[10] = -pool[pool.len() / 2];
    let rest = graph.sum(&pool);
    outputs[3] = -graph.apply(Elementary::Sin, rest);
    outputs[5] = x[2];
    outputs[7] = graph.ratio(5, 3);
    outputs[8] = graph.zero();
    let mut accel = function("accel", &[X, XI, U], Shape::Matrix(3, 4), outputs.clone());
    accel.fallible = pivots > 0;
    accel.guards = guards;
    program.functions = vec![
        accel,
        function("energy", &[X, XI, U], Shape::Scalar, vec![outputs[3]]),
    ];
    program
}
