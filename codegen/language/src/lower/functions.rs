//! The functions of the language.

use super::axes;
use super::choice::{greater, lesser};
use super::expression::Evaluator;
use crate::algebra::graph::{Edge, Function, Graph, Node};
use crate::algebra::linear::{apply3, cross, identity3, multiply3, transpose, transpose3};
use crate::diagnostics::Diagnostic;
use crate::model::class;
use crate::model::rotations::{axis_angle, hat, quaternion_matrix, turn};
use crate::model::value::Value;
use crate::shapes::MOST_ENTRIES;
use crate::syntax::ast::{Expr, Ident, Span};
use num_traits::{Signed, ToPrimitive};
use rustc_hash::FxHashSet;

impl Evaluator<'_> {
    /// Evaluates a call.
    pub fn call(&mut self, function: &Ident, arguments: &[Expr], span: Span) -> Option<Value> {
        let scope = self.scope;
        if let Some(own) = scope.symbols.functions.get(function.name.as_str()) {
            return self.applied(own, arguments, span);
        }
        if let Some(curve) = scope.tables.get(&function.name) {
            return self.table(&function.name, curve.as_ref(), arguments);
        }
        if let Some((place, external)) = self.scope.externals.get(&function.name) {
            return self.external(*place, external, arguments, span);
        }
        if function.name == "rate" {
            return self.rate(arguments.first()?, span);
        }
        if let (true, [argument]) = (axes::CALLS.contains(&function.name.as_str()), arguments) {
            let value = self.value(argument)?;
            return match axes::call(self.graph, &function.name, &value)? {
                Ok(value) => Some(value),
                Err(refused) => self.error(refused.at(argument.span)),
            };
        }
        let values: Vec<Option<Value>> = arguments
            .iter()
            .map(|argument| self.value(argument))
            .collect();
        let values = values.into_iter().collect::<Option<Vec<Value>>>()?;
        if let Some(value) = self.motion(function, arguments, &values, span) {
            return value;
        }
        match evaluate(self.graph, &function.name, &values, self.scope.free) {
            Ok(value) => Some(value),
            Err(None) => None,
            Err(Some((message, help))) => self.error(Diagnostic::new(span, message).help(help)),
        }
    }
}

/// Why a call has no value: a mathematical reason, and what to do; `None` if the arguments are in error.
type Fault = Option<(&'static str, &'static str)>;

/// Size of arguments below which every function has a finite value in `f64` if it has one.
const MAX_ARGUMENT: f64 = 700.0;

const ZERO_DIVISOR: Fault = Some((
    "division by an expression that is identically zero",
    "this is 0 for every configuration that satisfies the constraints",
));

/// Evaluates a call of a built-in function; `free` is true at points off the manifold.
fn evaluate(graph: &mut Graph, name: &str, values: &[Value], free: bool) -> Result<Value, Fault> {
    use Value::{Matrix, Pose, Scalar, Vector};
    let value = match (name, values) {
        ("tan", [Scalar(a)]) => {
            let (s, c) = (
                graph.apply(Function::Sin, *a),
                graph.apply(Function::Cos, *a),
            );
            Scalar(graph.div(s, c).ok_or(ZERO_DIVISOR)?)
        }
        ("asin" | "acos", [Scalar(a)]) => {
            // The angle of (√(1 − a²), a) or (a, √(1 − a²)); (1 − a)(1 + a) keeps its precision near ±1.
            let one = graph.one();
            let (less, more) = (graph.sub(one, *a), graph.add(one, *a));
            let square = graph.mul(less, more);
            if graph.as_rational(square).is_some_and(|n| n.is_negative()) {
                return Err(Some((
                    "`asin` and `acos` take numbers from -1 to 1",
                    "check the argument: it is this number for every configuration",
                )));
            }
            let other = root(graph, square);
            Scalar(match name {
                "asin" => graph.atan2(*a, other),
                _ => graph.atan2(other, *a),
            })
        }
        ("log", [Scalar(a)]) => {
            let number = graph.as_rational(*a);
            if number.is_some_and(|n| !n.is_positive()) {
                return Err(Some((
                    "the logarithm of a number that is not positive",
                    "check the argument: it is this number for every configuration",
                )));
            }
            Scalar(graph.apply(Function::Log, *a))
        }
        ("sqrt", [Scalar(a)]) => Scalar(real_root(graph, *a)?),
        ("atan2", [Scalar(y), Scalar(x)]) if *y == graph.zero() && *x == graph.zero() => {
            return Err(Some((
                "the angle of a zero vector",
                "one of the arguments has to differ from 0",
            )));
        }
        ("atan", [Scalar(a)]) => {
            let one = graph.one();
            Scalar(graph.atan2(*a, one))
        }
        ("atan2", [Scalar(y), Scalar(x)]) => Scalar(graph.atan2(*y, *x)),
        ("min", [Scalar(a), Scalar(b)]) => Scalar(lesser(graph, *a, *b)),
        ("max", [Scalar(a), Scalar(b)]) => Scalar(greater(graph, *a, *b)),
        ("clamp", [Scalar(a), Scalar(low), Scalar(high)]) => {
            if let (Some(low), Some(high)) = (graph.as_rational(*low), graph.as_rational(*high))
                && low > high
            {
                return Err(Some((
                    "the bounds of `clamp` are in the wrong order",
                    "write the lower one first: `clamp(a, low, high)`",
                )));
            }
            let above = greater(graph, *a, *low);
            Scalar(lesser(graph, above, *high))
        }
        ("hypot", [Scalar(a), Scalar(b)]) => Scalar(length(graph, &[*a, *b])),
        ("dot", [Vector(a), Vector(b)]) if a.len() == b.len() => Scalar(graph.dot(a, b)),
        ("outer", [Vector(a), Vector(b)]) => Matrix(
            a.iter()
                .map(|&x| b.iter().map(|&y| graph.mul(x, y)).collect())
                .collect(),
        ),
        ("norm", [Vector(a)]) => Scalar(length(graph, a)),
        ("transpose", [Matrix(m)]) => Matrix(transpose(m)),
        ("trace", [Matrix(m)]) if m.len() == m.first().map_or(0, Vec::len) => {
            let diagonal: Vec<Edge> = (0..m.len()).map(|i| m[i][i]).collect();
            Scalar(graph.sum(&diagonal))
        }
        ("diag", [Vector(v)]) => diagonal(graph, v),
        ("diag", scalars)
            if (1..=MOST_ENTRIES).contains(&scalars.len())
                && scalars.iter().all(|v| matches!(v, Scalar(_))) =>
        {
            let entries: Vec<Edge> = scalars.iter().flat_map(Value::entries).collect();
            diagonal(graph, &entries)
        }
        ("identity", [Scalar(n)]) => {
            let size = graph
                .as_rational(*n)
                .filter(|n| n.is_integer())
                .map(|n| n.to_integer());
            let size = size
                .and_then(|n| usize::try_from(n).ok())
                .filter(|n| (1..=MOST_ENTRIES).contains(n))
                .ok_or(None)?;
            diagonal(graph, &vec![graph.one(); size])
        }
        ("rotx" | "roty" | "rotz", _) => {
            let (c, s) = cosine_sine(graph, values).ok_or(None)?;
            let axis = match name {
                "rotx" => 0,
                "roty" => 1,
                _ => 2,
            };
            Value::from_mat3(&turn(graph, axis, c, s))
        }
        ("rpy", [Scalar(r), Scalar(p), Scalar(y)]) => {
            let turns = [(0, *r), (1, *p), (2, *y)].map(|(axis, angle)| {
                let (c, s) = (
                    graph.apply(Function::Cos, angle),
                    graph.apply(Function::Sin, angle),
                );
                turn(graph, axis, c, s)
            });
            let last = multiply3(graph, &turns[2], &turns[1]);
            Value::from_mat3(&multiply3(graph, &last, &turns[0]))
        }
        ("axis_angle", [axis, turn @ ..]) => {
            let given = axis.as_vec3().ok_or(None)?;
            let (c, s) = cosine_sine(graph, turn).ok_or(None)?;
            // A numeric direction has an exact unit vector.
            let axis = axes::unit(graph, given).unwrap_or(given);
            if !free && graph.dot(&axis, &axis) != graph.one() {
                return Err(Some((
                    "the axis of `axis_angle` is not a unit vector",
                    "divide it by its length: `axis_angle(a / norm(a), angle)`",
                )));
            }
            axis_angle(graph, axis, c, s)
        }
        ("rot", [Vector(q)]) if q.len() == 4 => {
            Value::from_mat3(&quaternion_matrix(graph, [q[0], q[1], q[2], q[3]]))
        }
        ("qmul", [Vector(p), Vector(q)]) if p.len() == 4 && q.len() == 4 => {
            let (u, v) = ([p[1], p[2], p[3]], [q[1], q[2], q[3]]);
            let (scalars, dot) = (graph.mul(p[0], q[0]), graph.dot(&u, &v));
            let mut product = vec![graph.sub(scalars, dot)];
            let turned = cross(graph, u, v);
            for i in 0..3 {
                let (left, right) = (graph.mul(p[0], v[i]), graph.mul(q[0], u[i]));
                let sum = graph.add(left, right);
                product.push(graph.add(sum, turned[i]));
            }
            Vector(product)
        }
        ("pose", [r, p]) => match (r.as_mat3(), p.as_vec3()) {
            (Some(r), Some(p)) => Pose(r, p),
            _ => return Err(None),
        },
        ("translation", [p]) => Pose(identity3(graph), p.as_vec3().ok_or(None)?),
        ("angle", [Vector(q)]) if q.len() == 2 => Scalar(angle_from(graph, [q[0], q[1]], None)),
        ("inverse", [Pose(r, p)]) => {
            let back = transpose3(r);
            Pose(back, apply3(graph, &back, *p).map(|edge| -edge))
        }
        ("cross", [a, b]) => match (a.as_vec3(), b.as_vec3()) {
            (Some(a), Some(b)) => Vector(cross(graph, a, b).to_vec()),
            _ => return Err(None),
        },
        ("hat", [w]) => Value::from_mat3(&hat(graph, w.as_vec3().ok_or(None)?)),
        ("vee", [w]) => {
            let w = w.as_mat3().ok_or(None)?;
            let half = graph.ratio(1, 2);
            Vector(
                [(2, 1), (0, 2), (1, 0)]
                    .iter()
                    .map(|&(i, j)| {
                        let difference = graph.sub(w[i][j], w[j][i]);
                        graph.mul(half, difference)
                    })
                    .collect(),
            )
        }
        (name, [Scalar(a)]) => {
            let function = Function::from_name(name).ok_or(None)?;
            let number = graph.as_rational(*a).and_then(|n| n.to_f64());
            if number
                .is_some_and(|a| a.abs() < MAX_ARGUMENT && !(function.row().value)(a).is_finite())
            {
                return Err(Some((
                    "this function has no value at its argument",
                    "check the argument: it is this number for every configuration",
                )));
            }
            Scalar(graph.apply(function, *a))
        }
        _ => return Err(None),
    };
    Ok(value)
}

/// Returns cosine and sine: of an angle, of an S1 coordinate, or as they are given.
fn cosine_sine(graph: &mut Graph, values: &[Value]) -> Option<(Edge, Edge)> {
    match values {
        [Value::Scalar(a)] => Some((
            graph.apply(Function::Cos, *a),
            graph.apply(Function::Sin, *a),
        )),
        [Value::Scalar(c), Value::Scalar(s)] => Some((*c, *s)),
        [Value::Vector(v)] if v.len() == 2 => Some((v[0], v[1])),
        _ => None,
    }
}

/// Returns the angle of (c, s) relative to the angle `rest`, from −π to π.
pub(super) fn angle_from(graph: &mut Graph, [c, s]: [Edge; 2], rest: Option<Edge>) -> Edge {
    let Some(rest) = rest else {
        return graph.atan2(s, c);
    };
    let (cos, sin) = (
        graph.apply(Function::Cos, rest),
        graph.apply(Function::Sin, rest),
    );
    let (along, across) = (
        graph.dot(&[c, s], &[cos, sin]),
        graph.dot(&[s, -c], &[cos, sin]),
    );
    graph.atan2(across, along)
}

/// Returns the length of a vector. That of a velocity has a kink at rest and is given slope 0 there, so that drag
/// |v| v has derivative 0.
fn length(graph: &mut Graph, a: &[Edge]) -> Edge {
    let square = graph.dot(a, a);
    let moves = graph.class(square.node()) & class::VELOCITY != 0;
    graph.apply(
        if moves {
            Function::Norm
        } else {
            Function::Sqrt
        },
        square,
    )
}

fn real_root(graph: &mut Graph, square: Edge) -> Result<Edge, Fault> {
    if graph.as_rational(square).is_some_and(|n| n.is_negative()) {
        return Err(Some((
            "the square root of a negative number",
            "check the argument: it is this number for every configuration",
        )));
    }
    Ok(root(graph, square))
}

/// Returns √a. If a is a sum of squares of velocities, or a length, the root is a length, too, with slope 0 at rest.
pub fn root(graph: &mut Graph, a: Edge) -> Edge {
    let moves = graph.class(a.node()) & class::VELOCITY != 0;
    let function = match moves && is_length(graph, a) {
        true => Function::Norm,
        false => Function::Sqrt,
    };
    graph.apply(function, a)
}

/// Returns whether an expression is written as the square of a length, `v^2 + w^2`, or is itself a length.
fn is_length(graph: &Graph, edge: Edge) -> bool {
    if matches!(graph.node(edge.node()), Node::Apply(Function::Norm, _)) {
        return !edge.is_negative();
    }
    let (mut open, mut seen) = (vec![edge], FxHashSet::default());
    while let Some(edge) = open.pop() {
        match graph.node(edge.node()) {
            _ if edge.is_negative() => return false,
            // Sums are shared, so each is visited once.
            Node::Add(a, b) if seen.insert(edge.node()) => open.extend([a, b]),
            Node::Add(..) => {}
            Node::Mul(a, b) if a == b => {}
            _ => return false,
        }
    }
    true
}

fn diagonal(graph: &Graph, entries: &[Edge]) -> Value {
    let n = entries.len();
    Value::Matrix(
        (0..n)
            .map(|i| {
                (0..n)
                    .map(|j| if i == j { entries[i] } else { graph.zero() })
                    .collect()
            })
            .collect(),
    )
}
