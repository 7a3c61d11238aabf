//! The functions of the language.

use super::expression::Evaluator;
use super::scope::{RESERVED, closest};
use super::value::Value;
use crate::algebra::graph::{Edge, Function, Graph};
use crate::algebra::linear::{
    Mat3, Vec3, apply3, cross, identity3, multiply3, transpose, transpose3,
};
use crate::diagnostics::Diagnostic;
use crate::syntax::ast::{Expr, Ident, Span};

impl Evaluator<'_> {
    /// A call; wrong names, counts and shapes are reported.
    pub fn call(&mut self, function: &Ident, arguments: &[Expr], span: Span) -> Option<Value> {
        let values: Vec<Option<Value>> = arguments
            .iter()
            .map(|argument| self.value(argument))
            .collect();
        let Some(usage) = usage(&function.name) else {
            let error = Diagnostic::new(
                function.span,
                format!("no function is called `{}`", function.name),
            );
            let known = RESERVED
                .iter()
                .copied()
                .filter(|name| usage_of(name).is_some());
            return match closest(&function.name, known) {
                Some(known) => self.error(error.help(format!("did you mean `{known}`?"))),
                None => self.error(error.help("functions are sin, cos, tan, atan2, sqrt, exp, log, dot, cross, norm, hat, vee, transpose, trace, diag, outer, identity, rotx, roty, rotz, rpy, axis_angle, rot, qmul, pose, inverse")),
            };
        };
        let values = values.into_iter().collect::<Option<Vec<Value>>>()?;
        match evaluate(self.graph, &function.name, &values) {
            Ok(value) => Some(value),
            Err(Fault::Usage) => {
                let found: Vec<String> = values.iter().map(Value::shape).collect();
                self.error(
                    Diagnostic::new(
                        span,
                        format!(
                            "`{}` cannot take {}",
                            function.name,
                            if found.is_empty() {
                                "no argument".into()
                            } else {
                                found.join(" and ")
                            }
                        ),
                    )
                    .help(format!("write {usage}")),
                )
            }
            Err(Fault::Why(message, help)) => self.error(Diagnostic::new(span, message).help(help)),
        }
    }
}

/// Why a call has no value.
enum Fault {
    /// Number or shapes of the arguments.
    Usage,
    /// A mathematical reason, and what to do.
    Why(String, String),
}

fn usage(name: &str) -> Option<&'static str> {
    usage_of(name)
}

fn usage_of(name: &str) -> Option<&'static str> {
    Some(match name {
        "sin" | "cos" | "tan" => "`sin(angle)` of a scalar, and so cos and tan",
        "sqrt" | "exp" | "log" => "`sqrt(a)` of a scalar, and so exp and log",
        "atan2" => "`atan2(y, x)` of scalars",
        "dot" => "`dot(a, b)` of vectors of equal length",
        "cross" => "`cross(a, b)` of vectors of 3",
        "outer" => "`outer(a, b)` of vectors",
        "norm" => "`norm(v)` of a vector",
        "hat" => "`hat(w)` of a vector of 3",
        "vee" => "`vee(W)` of a 3×3 matrix",
        "transpose" => "`transpose(M)` of a matrix",
        "trace" => "`trace(M)` of a square matrix",
        "diag" => "`diag(a, b, c)` of scalars or `diag(v)` of a vector",
        "identity" => "`identity(n)` with n from 1 to 64",
        "rotx" | "roty" | "rotz" => {
            "`rotx(angle)`, `rotx(c, s)` or `rotx(q)` with an S1 coordinate q, and so roty and rotz"
        }
        "rpy" => "`rpy(roll, pitch, yaw)` of scalars",
        "axis_angle" => "`axis_angle(axis, angle)` of a unit vector of 3 and a scalar",
        "rot" => "`rot(q)` of a unit quaternion, scalar first",
        "qmul" => "`qmul(p, q)` of vectors of 4, scalar first",
        "pose" => "`pose(R, p)` of a rotation matrix and a vector of 3",
        "inverse" => "`inverse(P)` of a pose",
        _ => return None,
    })
}

fn evaluate(graph: &mut Graph, name: &str, values: &[Value]) -> Result<Value, Fault> {
    use Value::{Matrix, Pose, Scalar, Vector};
    let value = match (name, values) {
        ("sin", [Scalar(a)]) => Scalar(graph.apply(Function::Sin, *a)),
        ("cos", [Scalar(a)]) => Scalar(graph.apply(Function::Cos, *a)),
        ("tan", [Scalar(a)]) => {
            let (s, c) = (
                graph.apply(Function::Sin, *a),
                graph.apply(Function::Cos, *a),
            );
            Scalar(graph.div(s, c).ok_or(Fault::Usage)?)
        }
        ("exp", [Scalar(a)]) => Scalar(graph.apply(Function::Exp, *a)),
        ("log", [Scalar(a)]) if *a == graph.zero() => {
            return Err(Fault::Why(
                "logarithm of something that is identically zero".into(),
                "the argument has to be positive".into(),
            ));
        }
        ("log", [Scalar(a)]) => Scalar(graph.apply(Function::Log, *a)),
        ("sqrt", [Scalar(a)]) => Scalar(root(graph, *a)?),
        ("atan2", [Scalar(y), Scalar(x)]) => Scalar(graph.atan2(*y, *x)),
        ("dot", [Vector(a), Vector(b)]) if a.len() == b.len() => Scalar(graph.dot(a, b)),
        ("outer", [Vector(a), Vector(b)]) => Matrix(
            a.iter()
                .map(|&x| b.iter().map(|&y| graph.mul(x, y)).collect())
                .collect(),
        ),
        ("norm", [Vector(a)]) => {
            let square = graph.dot(a, a);
            Scalar(root(graph, square)?)
        }
        ("transpose", [Matrix(m)]) => Matrix(transpose(m)),
        ("trace", [Matrix(m)]) if m.len() == m.first().map_or(0, Vec::len) => {
            let diagonal: Vec<Edge> = (0..m.len()).map(|i| m[i][i]).collect();
            Scalar(graph.sum(&diagonal))
        }
        ("diag", [Vector(v)]) => diagonal(graph, v),
        ("diag", scalars)
            if !scalars.is_empty() && scalars.iter().all(|v| matches!(v, Scalar(_))) =>
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
                .filter(|n| (1..=64).contains(n))
                .ok_or(Fault::Usage)?;
            diagonal(graph, &vec![graph.one(); size])
        }
        ("rotx" | "roty" | "rotz", _) => {
            let (c, s) = match values {
                [Scalar(a)] => (
                    graph.apply(Function::Cos, *a),
                    graph.apply(Function::Sin, *a),
                ),
                [Scalar(c), Scalar(s)] => (*c, *s),
                [Vector(v)] if v.len() == 2 => (v[0], v[1]),
                _ => return Err(Fault::Usage),
            };
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
        ("axis_angle", [axis, Scalar(angle)]) => {
            let axis = axis.as_vec3().ok_or(Fault::Usage)?;
            axis_angle(graph, axis, *angle)?
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
            _ => return Err(Fault::Usage),
        },
        ("inverse", [Pose(r, p)]) => {
            let back = transpose3(r);
            Pose(back, apply3(graph, &back, *p).map(|edge| -edge))
        }
        ("cross", [a, b]) => match (a.as_vec3(), b.as_vec3()) {
            (Some(a), Some(b)) => Vector(cross(graph, a, b).to_vec()),
            _ => return Err(Fault::Usage),
        },
        ("hat", [w]) => Value::from_mat3(&hat(graph, w.as_vec3().ok_or(Fault::Usage)?)),
        ("vee", [w]) => {
            let w = w.as_mat3().ok_or(Fault::Usage)?;
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
        _ => return Err(Fault::Usage),
    };
    Ok(value)
}

fn root(graph: &mut Graph, square: Edge) -> Result<Edge, Fault> {
    if graph
        .as_rational(square)
        .is_some_and(|n| n < num_traits::Zero::zero())
    {
        return Err(Fault::Why(
            "square root of a negative number".into(),
            "check the sign of the argument".into(),
        ));
    }
    Ok(graph.apply(Function::Sqrt, square))
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

/// ŵ, with ŵ a = w × a.
pub fn hat(graph: &Graph, w: Vec3) -> Mat3 {
    let o = graph.zero();
    [[o, -w[2], w[1]], [w[2], o, -w[0]], [-w[1], w[0], o]]
}

/// Rotation about a coordinate axis.
fn turn(graph: &Graph, axis: usize, c: Edge, s: Edge) -> Mat3 {
    let mut m = identity3(graph);
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    m[j][j] = c;
    m[k][k] = c;
    m[j][k] = -s;
    m[k][j] = s;
    m
}

/// I + sin a n̂ + (1 − cos a) n̂² for a unit vector n.
fn axis_angle(graph: &mut Graph, axis: Vec3, angle: Edge) -> Result<Value, Fault> {
    if graph.dot(&axis, &axis) != graph.one() {
        return Err(Fault::Why(
            "the axis of `axis_angle` is no unit vector".into(),
            "divide it by its length: `axis_angle(a / norm(a), angle)`".into(),
        ));
    }
    let (c, s) = (
        graph.apply(Function::Cos, angle),
        graph.apply(Function::Sin, angle),
    );
    let versine = graph.sub(graph.one(), c);
    let n = hat(graph, axis);
    let square = multiply3(graph, &n, &n);
    let mut m = identity3(graph);
    for i in 0..3 {
        for j in 0..3 {
            let (a, b) = (graph.mul(s, n[i][j]), graph.mul(versine, square[i][j]));
            let sum = graph.add(m[i][j], a);
            m[i][j] = graph.add(sum, b);
        }
    }
    Ok(Value::from_mat3(&m))
}

/// Rotation matrix of a unit quaternion (w, v): (w² − v·v) I + 2 v vᵀ + 2 w v̂.
pub fn quaternion_matrix(graph: &mut Graph, q: [Edge; 4]) -> Mat3 {
    let [w, v @ ..] = q;
    let (ww, vv) = (graph.mul(w, w), graph.dot(&v, &v));
    let base = graph.sub(ww, vv);
    let two = graph.ratio(2, 1);
    let skew = hat(graph, v);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let (outer, turn) = (graph.mul(v[i], v[j]), graph.mul(w, skew[i][j]));
            let sum = graph.add(outer, turn);
            let double = graph.mul(two, sum);
            if i == j {
                graph.add(base, double)
            } else {
                double
            }
        })
    })
}
