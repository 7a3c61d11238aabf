//! Axes and places of joints, with exact unit vectors.

use crate::algebra::graph::{Edge, Function, Graph};
use crate::algebra::linear::{Mat3, Vec3, identity3};
use crate::diagnostics::Diagnostic;
use crate::model::class;
use crate::model::value::Value;
use crate::symbols::words::{AXIS, PLACE, PLANE};
use crate::syntax::ast::Span;
use num_rational::BigRational;
use num_traits::Signed;

/// Functions that expanded joints call.
pub const CALLS: [&str; 3] = [AXIS, PLACE, PLANE];

/// Why an axis or place of a joint is refused: the reason, and what to do.
#[derive(Debug)]
pub struct Refused(&'static str, &'static str);

impl Refused {
    /// Returns the error at a place of the description.
    pub fn at(self, span: Span) -> Diagnostic {
        Diagnostic::new(span, self.0).help(self.1)
    }
}

/// Evaluates one of the [`CALLS`]; `None` if its argument is in error.
pub fn call(graph: &mut Graph, name: &str, value: &Value) -> Option<Result<Value, Refused>> {
    if name == PLACE {
        return place(graph, value);
    }
    let axis = unit(graph, value.as_vec3()?);
    Some(axis.map(|axis| match name {
        PLANE => plane(graph, axis),
        _ => Value::Vector(axis.to_vec()),
    }))
}

/// Checks that a pose does not depend on the motion.
fn place(graph: &Graph, value: &Value) -> Option<Result<Value, Refused>> {
    let place = match (value, value.as_vec3()) {
        (Value::Pose(..), _) => value.clone(),
        (_, point) => Value::Pose(identity3(graph), point?),
    };
    if class_of(graph, value) & !class::PARAM != 0 {
        return Some(Err(Refused(
            "the place of a joint has to be constant",
            "it may depend only on parameters and constants; write what moves as a joint or a `frame`",
        )));
    }
    Some(Ok(place))
}

fn class_of(graph: &Graph, value: &Value) -> u8 {
    let entries = value.entries();
    entries.iter().fold(0, |all, e| all | graph.class(e.node()))
}

/// Returns the unit vector of a constant direction.
pub fn unit(graph: &mut Graph, axis: Vec3) -> Result<Vec3, Refused> {
    if class_of(graph, &Value::Vector(axis.to_vec())) != 0 {
        return Err(Refused(
            "the axis of a joint has to be made of numbers and constants",
            "to make the direction a parameter, turn the joint by its place, `at pose(R, p)`",
        ));
    }
    if axis.iter().all(|&entry| entry == graph.zero()) {
        return Err(Refused(
            "the axis of a joint has no direction: it is zero",
            "write a direction, such as `[0, 0, 1]`",
        ));
    }
    let square = graph.dot(&axis, &axis);
    if square == graph.one() {
        return Ok(axis);
    }
    let rational = graph.as_rational(square);
    let length = match rational.as_ref().and_then(exact_root) {
        Some(length) => graph.rational(&length),
        None => graph.apply(Function::Sqrt, square),
    };
    let quotients = axis.map(|entry| graph.div(entry, length));
    let [Some(a), Some(b), Some(c)] = quotients else {
        return Err(Refused(
            "the axis of a joint has no length",
            "write a direction, such as `[0, 0, 1]`",
        ));
    };
    Ok([a, b, c])
}

/// Returns the square root of a rational number if that is rational.
fn exact_root(number: &BigRational) -> Option<BigRational> {
    let root = BigRational::new(number.numer().sqrt(), number.denom().sqrt());
    (&root * &root == *number).then_some(root)
}

/// Returns two unit vectors that form a right-handed frame with the normal, as columns: the images of the two
/// coordinate axes after the one nearest to the normal, under the shortest rotation that takes that axis to the
/// normal.
fn plane(graph: &mut Graph, normal: Vec3) -> Value {
    let sizes = normal.map(|entry| graph.as_rational(entry).map(|number| number.abs()));
    // A symbolic root has no size here; the order follows from its square.
    let size = |k: usize, graph: &mut Graph| {
        sizes[k].clone().map(|s| &s * &s).or_else(|| {
            let square = graph.mul(normal[k], normal[k]);
            graph.as_rational(square)
        })
    };
    let squares = [size(0, graph), size(1, graph), size(2, graph)];
    let nearest = (0..3).fold(
        0,
        |best, k| if squares[k] > squares[best] { k } else { best },
    );
    let negative = match graph.as_rational(normal[nearest]) {
        Some(number) => number.is_negative(),
        None => normal[nearest].is_negative(),
    };
    let (i, j) = ((nearest + 1) % 3, (nearest + 2) % 3);
    let turn = shortest(graph, nearest, negative, normal);
    let (first, second) = if negative { (j, i) } else { (i, j) };
    Value::Matrix(
        (0..3)
            .map(|row| vec![turn[row][first], turn[row][second]])
            .collect(),
    )
}

/// Returns the shortest rotation from ±eₖ to n: I + ŵ + ŵ²/(1 + c) with w = ±eₖ × n and c = ±nₖ.
fn shortest(graph: &mut Graph, k: usize, negative: bool, n: Vec3) -> Mat3 {
    use crate::algebra::linear::{cross, multiply3};
    use crate::model::rotations::hat;
    let mut from = [graph.zero(); 3];
    from[k] = graph.one().signed(negative);
    let w = cross(graph, from, n);
    let c = n[k].signed(negative);
    let below = graph.add(graph.one(), c);
    let skew = hat(graph, w);
    let square = multiply3(graph, &skew, &skew);
    let identity = identity3(graph);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            // 1 + c is at least 1.
            let bent: Edge = graph.div(square[i][j], below).unwrap_or(graph.zero());
            let sum = graph.add(identity[i][j], skew[i][j]);
            graph.add(sum, bent)
        })
    })
}
