//! The order in which a description is read, with its checkpoints.

use super::declare::{Declared, NextValue, declare, shape_fits, size};
use super::expression::Evaluator;
use super::layout::{Block, blocks, constraint};
use super::points::Points;
use super::scope::{NameKind, Scope};
use super::value::Value;
use super::{Frame, Model, class, dynamics, kinematics, start};
use crate::algebra::fp::{Fp, Random};
use crate::algebra::graph::{Graph, LANES};
use crate::algebra::numeric::evaluate;
use crate::diagnostics::{Diagnostic, Report};
use crate::syntax::ast::{Declaration, Expr, Ident, ItemKind, ShapeKind, System};

/// Points are chosen anew this often when a square root has no value there.
const ATTEMPTS: u64 = 48;

/// Seed of the points: fixed, so that builds repeat.
const SEED: u64 = 0x4a6d_656c;

/// Reads a description; all its independent errors are reported together.
pub fn build(system: &System) -> Result<Model, Vec<Diagnostic>> {
    let mut attempt = 0;
    loop {
        let (result, stuck) = build_at(system, SEED + attempt);
        attempt += 1;
        if !stuck || attempt == ATTEMPTS {
            return result;
        }
    }
}

fn build_at(system: &System, seed: u64) -> (Result<Model, Vec<Diagnostic>>, bool) {
    let mut report = Report::new();
    let points = match points(system, seed, &mut report) {
        Some(points) => points,
        None => return (Err(report.finish().err().unwrap_or_default()), false),
    };
    let mut random = Random::new(seed ^ 0x5eed);
    let lanes: Option<Vec<Vec<Fp>>> = (0..LANES).map(|_| points.choose(&mut random)).collect();
    let Some(lanes) = lanes else {
        let places: Vec<_> = system
            .items
            .iter()
            .filter(|i| matches!(i.kind, ItemKind::Constraint { .. }))
            .collect();
        for item in places.iter().take(1) {
            report.push(
                Diagnostic::new(item.span, "no configuration satisfies the constraints")
                    .help("the constraints contradict one another, or have no solution for general parameters"),
            );
        }
        return (Err(report.finish().err().unwrap_or_default()), false);
    };
    let mut graph = Graph::new(seed, class::PARAM);
    let mut scope = Scope::default();
    let mut count = 0;
    let mut next = |_: &mut Graph| {
        count += 1;
        std::array::from_fn(|lane| lanes[lane][count - 1])
    };
    let declared = declare(
        system,
        &mut graph,
        &mut next as &mut NextValue,
        &mut scope,
        &mut report,
    );
    let result = assemble(system, graph, scope, points, declared, report);
    match result {
        Ok(model) => {
            let stuck = model.graph.is_stuck();
            (Ok(model), stuck)
        }
        Err((errors, stuck)) => (Err(errors), stuck),
    }
}

/// The variety: the free graph with φ; constraints in error are left out, the main pass reports them.
fn points(system: &System, seed: u64, report: &mut Report) -> Option<Points> {
    let mut random = Random::new(seed ^ 0xf4ee);
    let mut graph = Graph::new(seed ^ 0xf4ee, class::PARAM);
    let mut next = |_: &mut Graph| -> [Fp; LANES] { std::array::from_fn(|_| random.element()) };
    let mut scope = Scope::default();
    let mut silent = Report::new();
    let declared = declare(system, &mut graph, &mut next, &mut scope, &mut silent);
    for item in &system.items {
        if let ItemKind::Let(list) = &item.kind {
            for declaration in list {
                define_let(declaration, &mut graph, &mut scope, &mut silent);
            }
        }
    }
    let mut constraints = Vec::new();
    for item in &system.items {
        let ItemKind::Constraint { left, right } = &item.kind else {
            continue;
        };
        let mut evaluator = Evaluator {
            graph: &mut graph,
            scope: &scope,
            report: &mut silent,
        };
        let (Some(a), Some(b)) = (evaluator.value(left), evaluator.value(right)) else {
            continue;
        };
        if !a.same_shape(&b) {
            continue;
        }
        let difference = a.zip(&b, |x, y| graph.sub(x, y));
        for edge in difference.entries() {
            if edge == graph.zero() {
                continue;
            }
            let class = graph.class(edge.node());
            let polynomial = crate::algebra::topoly::is_polynomial(&graph, edge, class::COORD);
            if class & !(class::PARAM | class::COORD) != 0 || class & class::COORD == 0 {
                report.push(
                    Diagnostic::new(
                        item.span,
                        "a constraint is about coordinates, parameters and constants alone",
                    )
                    .help("velocities are constrained by the choice of `velocity` and `rate`"),
                );
            } else if !polynomial {
                report.push(
                    Diagnostic::new(item.span, "a constraint has to be polynomial in the coordinates")
                        .help("use an S1 coordinate for an angle, its parts `.c` and `.s` for cos and sin"),
                );
            } else {
                constraints.push(edge);
            }
        }
    }
    if !report.is_empty() {
        return None;
    }
    let blocks: Vec<Block> = declared
        .coordinates
        .iter()
        .flat_map(|c| blocks(c.kind))
        .collect();
    let symbols = graph.symbols().len();
    let params: usize = declared.params.iter().map(|group| group.len).sum();
    Some(Points {
        free: graph,
        constraints,
        blocks,
        first: 1 + params,
        symbols,
    })
}

fn assemble(
    system: &System,
    mut graph: Graph,
    mut scope: Scope,
    mut points: Points,
    declared: Declared,
    mut report: Report,
) -> Result<Model, (Vec<Diagnostic>, bool)> {
    let blocks: Vec<Block> = declared
        .coordinates
        .iter()
        .flat_map(|c| blocks(c.kind))
        .collect();
    check_present(system, &declared, &mut report);
    let defaults = defaults(system, &mut graph, &scope, &declared, &mut report);
    let mut lets = Vec::new();
    let mut frames = Vec::new();
    for item in &system.items {
        match &item.kind {
            ItemKind::Let(list) => {
                for declaration in list {
                    if let Some(value) =
                        define_let(declaration, &mut graph, &mut scope, &mut report)
                    {
                        lets.push((declaration.name.name.clone(), value));
                    }
                }
            }
            ItemKind::Frame { name, on, pose } => {
                define_frame(
                    name,
                    on.as_ref(),
                    pose,
                    &mut graph,
                    &mut scope,
                    &mut frames,
                    &mut report,
                );
            }
            _ => {}
        }
    }
    let phi = all_constraints(
        system,
        &mut points,
        &declared,
        &mut scope,
        &mut graph,
        &mut report,
    );
    let kinematics = kinematics::read(
        system,
        &mut graph,
        &scope,
        &points,
        &phi,
        &declared,
        &mut report,
    );
    let dynamics = dynamics::read(system, &mut graph, &scope, &frames, &declared, &mut report);
    let starts = start::read(
        system,
        &mut graph,
        &scope,
        &declared,
        &defaults,
        &mut report,
    );
    let stuck = graph.is_stuck();
    let span = system.name.span;
    if let Err(errors) = report.finish() {
        return Err((errors, stuck));
    }
    let (Some(kinematics), Some((start_x, start_xi))) = (kinematics, starts) else {
        return Err((
            vec![Diagnostic::new(span, "the description could not be read")],
            stuck,
        ));
    };
    let model = Model {
        name: system.name.name.clone(),
        public: system.public,
        docs: system.docs.clone(),
        graph,
        points,
        params: declared.params,
        defaults,
        coordinates: declared.coordinates,
        blocks,
        x: declared.x,
        phi,
        velocities: declared.velocities,
        xi: declared.xi,
        xi_dot: declared.xi_dot,
        inputs: declared.inputs,
        u: declared.u,
        rate: kinematics.rate,
        a: kinematics.a,
        frames,
        bodies: dynamics.bodies,
        particles: dynamics.particles,
        kinetic: dynamics.kinetic,
        potential: dynamics.potential,
        gravity: dynamics.gravity,
        wrenches: dynamics.wrenches,
        generalized: dynamics.generalized,
        outputs: dynamics.outputs,
        lets,
        start_x,
        start_xi,
        generate: dynamics.generate,
        span,
    };
    let mut report = Report::new();
    start::check(system, &model, &mut report);
    let stuck = model.graph.is_stuck();
    report.finish().map_err(|errors| (errors, stuck))?;
    Ok(model)
}

fn check_present(system: &System, declared: &Declared, report: &mut Report) {
    if declared.coordinates.is_empty() {
        report.push(
            Diagnostic::new(system.name.span, "the system has no coordinates")
                .help("write `coord q;` or `coord R: SO3;`"),
        );
    }
    if declared.velocities.is_empty() {
        report.push(
            Diagnostic::new(system.name.span, "the system has no velocities")
                .help("write `velocity u;` or `velocity w: vec3;`"),
        );
    }
}

fn defaults(
    system: &System,
    graph: &mut Graph,
    scope: &Scope,
    declared: &Declared,
    report: &mut Report,
) -> Vec<f64> {
    let mut numbers = Vec::new();
    let lists = system.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Param(list) => Some(list),
        _ => None,
    });
    for (declaration, group) in lists.flatten().zip(&declared.params) {
        let before = numbers.len();
        numbers.extend(default_of(declaration, graph, scope, report).unwrap_or_default());
        numbers.resize(before + group.len, f64::NAN);
    }
    numbers
}

fn default_of(
    declaration: &Declaration,
    graph: &mut Graph,
    scope: &Scope,
    report: &mut Report,
) -> Option<Vec<f64>> {
    let name = &declaration.name;
    let Some(expr) = &declaration.value else {
        report.push(
            Diagnostic::new(name.span, format!("parameter `{}` has no default", name.name))
                .help("every parameter has a default, with which the description is checked: `param m = 1.3;`"),
        );
        return None;
    };
    let value = Evaluator {
        graph,
        scope,
        report,
    }
    .value(expr)?;
    if value
        .entries()
        .iter()
        .any(|edge| graph.class(edge.node()) != 0)
    {
        report.push(
            Diagnostic::new(expr.span, format!("the default of `{}` is no number", name.name))
                .help("defaults are made of numbers and constants; name an expression of parameters with `let`"),
        );
        return None;
    }
    if !shape_fits(declaration, &value, report) {
        return None;
    }
    if declaration.shape.kind == ShapeKind::Scalar && !matches!(value, Value::Scalar(_)) {
        let shape = match &value {
            Value::Vector(v) => format!("vec{}", v.len()),
            Value::Matrix(m) => format!("mat{}` or `{}: sym{}", m.len(), name.name, m.len()),
            _ => "…".into(),
        };
        report.push(
            Diagnostic::new(
                expr.span,
                format!(
                    "`{}` was declared as a scalar, its value is {}",
                    name.name,
                    value.shape()
                ),
            )
            .help(format!("write `{}: {shape}`", name.name)),
        );
        return None;
    }
    let entries = match (&value, declaration.shape.kind) {
        (Value::Matrix(m), ShapeKind::Symmetric(n)) => {
            for i in 0..n {
                for j in i + 1..n {
                    if m[i][j] != m[j][i] {
                        report.push(
                            Diagnostic::new(
                                expr.span,
                                format!(
                                    "`{}` is not symmetric: entries [{},{}] and [{},{}] differ",
                                    name.name,
                                    i + 1,
                                    j + 1,
                                    j + 1,
                                    i + 1
                                ),
                            )
                            .help("a symmetric matrix equals its transpose"),
                        );
                        return None;
                    }
                }
            }
            (0..n)
                .flat_map(|i| (i..n).map(move |j| (i, j)))
                .map(|(i, j)| m[i][j])
                .collect()
        }
        _ => value.entries(),
    };
    let numbers = evaluate(graph, &entries, &symbol_numbers(graph));
    if numbers.iter().any(|number| !number.is_finite()) {
        report.push(
            Diagnostic::new(
                expr.span,
                format!("the default of `{}` is not finite", name.name),
            )
            .help("write a finite number"),
        );
        return None;
    }
    Some(numbers)
}

/// Numbers for symbols where only π can occur.
pub fn symbol_numbers(graph: &Graph) -> Vec<f64> {
    let mut numbers = vec![f64::NAN; graph.symbols().len()];
    if let Some(first) = numbers.first_mut() {
        *first = std::f64::consts::PI;
    }
    numbers
}

/// Defines a `let`; its value, where it has one.
pub fn define_let(
    declaration: &Declaration,
    graph: &mut Graph,
    scope: &mut Scope,
    report: &mut Report,
) -> Option<Value> {
    let value = match &declaration.value {
        Some(expr) => Evaluator {
            graph,
            scope,
            report,
        }
        .value(expr)
        .filter(|value| shape_fits(declaration, value, report)),
        None => {
            report.push(
                Diagnostic::new(
                    declaration.name.span,
                    format!("`{}` has no value", declaration.name.name),
                )
                .help(format!("write `let {} = …;`", declaration.name.name)),
            );
            None
        }
    };
    scope.define(&declaration.name, NameKind::Let, value.clone(), report);
    value
}

fn define_frame(
    name: &Ident,
    on: Option<&Ident>,
    pose: &Expr,
    graph: &mut Graph,
    scope: &mut Scope,
    frames: &mut Vec<Frame>,
    report: &mut Report,
) {
    let value = frame_value(name, on, pose, graph, scope, report);
    scope.define(name, NameKind::Frame, value.clone(), report);
    if let Some(Value::Pose(rotation, position)) = value {
        frames.push(Frame {
            name: name.name.clone(),
            rotation,
            position,
        });
    }
}

fn frame_value(
    name: &Ident,
    on: Option<&Ident>,
    pose: &Expr,
    graph: &mut Graph,
    scope: &Scope,
    report: &mut Report,
) -> Option<Value> {
    let mut evaluator = Evaluator {
        graph,
        scope,
        report,
    };
    let value = evaluator.value(pose)?;
    let Value::Pose(rotation, _) = &value else {
        return evaluator.error(
            Diagnostic::new(
                pose.span,
                format!("a frame has to be a pose, this is {}", value.shape()),
            )
            .help(format!("write `frame {} = pose(R, p);`", name.name)),
        );
    };
    let gram = crate::algebra::linear::multiply3(
        evaluator.graph,
        &crate::algebra::linear::transpose3(rotation),
        rotation,
    );
    let identity = crate::algebra::linear::identity3(evaluator.graph);
    for i in 0..3 {
        for j in 0..3 {
            if gram[i][j] != identity[i][j] {
                return evaluator.error(
                    Diagnostic::new(pose.span, format!("the matrix of frame `{}` is no rotation: entry [{},{}] of R.T * R is not {}", name.name, i + 1, j + 1, (i == j) as u8))
                        .help("use an SO3 coordinate, `rot(q)`, `rotx(angle)` and their products"),
                );
            }
        }
    }
    let value = Value::Pose(
        *rotation,
        match &value {
            Value::Pose(_, p) => *p,
            _ => return None,
        },
    );
    let class = value
        .entries()
        .iter()
        .fold(0, |class, edge| class | evaluator.graph.class(edge.node()));
    if class & !(class::PARAM | class::COORD) != 0 {
        return evaluator.error(
            Diagnostic::new(
                pose.span,
                format!("frame `{}` depends on velocities or inputs", name.name),
            )
            .help("a frame is a function of coordinates and parameters"),
        );
    }
    let Some(parent) = on else { return Some(value) };
    let parent_value = match scope.get(&parent.name) {
        Some(entry) if entry.kind == NameKind::Frame => entry.value.clone()?,
        _ if parent.name == "world" => return Some(value),
        _ => {
            let error = scope.unknown(parent.span, &parent.name, "frame", |kind| {
                kind == NameKind::Frame
            });
            return evaluator.error(error);
        }
    };
    let (Value::Pose(r, p), Value::Pose(r2, p2)) = (&parent_value, &value) else {
        return None;
    };
    let moved = crate::algebra::linear::apply3(evaluator.graph, r, *p2);
    let position = crate::algebra::linear::add3(evaluator.graph, *p, moved);
    Some(Value::Pose(
        crate::algebra::linear::multiply3(evaluator.graph, r, r2),
        position,
    ))
}

/// φ of every block and of the user, in the free graph, with the text of each row; errors of the
/// user's constraints are reported from the main graph.
fn all_constraints(
    system: &System,
    points: &mut Points,
    declared: &Declared,
    scope: &mut Scope,
    graph: &mut Graph,
    report: &mut Report,
) -> Vec<(crate::algebra::graph::Edge, String)> {
    let mut phi = Vec::new();
    let free_x: Vec<_> = (points.first..points.first + declared.x.len())
        .map(|index| crate::algebra::graph::Edge::of(points.free.symbols()[index].node))
        .collect();
    for coordinate in &declared.coordinates {
        let mut place = coordinate.offset;
        for block in blocks(coordinate.kind) {
            let name = if size(coordinate.kind) == 12 && block == Block::Rotation {
                format!("{}.R", coordinate.name)
            } else {
                coordinate.name.clone()
            };
            phi.extend(constraint(
                &mut points.free,
                block,
                &free_x[place..place + block.len()],
                &name,
            ));
            place += block.len();
        }
    }
    for item in &system.items {
        let ItemKind::Constraint { left, right } = &item.kind else {
            continue;
        };
        let mut evaluator = Evaluator {
            graph,
            scope,
            report,
        };
        let (a, b) = (evaluator.value(left), evaluator.value(right));
        let (Some(a), Some(b)) = (a, b) else { continue };
        if !a.same_shape(&b) {
            report.push(
                Diagnostic::new(
                    item.span,
                    format!(
                        "one side of the constraint is {}, the other {}",
                        a.shape(),
                        b.shape()
                    ),
                )
                .help("both sides need the same shape"),
            );
            continue;
        }
        let difference = a.zip(&b, |x, y| graph.sub(x, y));
        if !difference.is_zero(graph) {
            report.push(
                Diagnostic::new(
                    item.span,
                    "the constraint does not hold at the points that were found for it",
                )
                .help("the constraints contradict one another"),
            );
        }
    }
    for (index, &edge) in points.constraints.clone().iter().enumerate() {
        phi.push((edge, format!("constraint {}", index + 1)));
    }
    phi
}
