//! Layout of the coordinates in x, with their constraints and canonical quasi-velocities.

use crate::algebra::field_point::circle_point;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{multiply3, transpose3};
use crate::algebra::residue_pair::{Random, ResiduePair};
use crate::syntax::ast::CoordKind;
use std::ops::{Add, Mul, Sub};

/// A block of x with a chart of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// Vector of n real numbers.
    Flat(usize),
    /// Point (c, s) of the unit circle.
    Circle,
    /// Unit quaternion, scalar first.
    Quaternion,
    /// Rotation matrix by rows.
    Rotation,
}

impl Block {
    /// Returns the number of entries in x.
    pub fn len(self) -> usize {
        match self {
            Block::Flat(n) => n,
            Block::Circle => 2,
            Block::Quaternion => 4,
            Block::Rotation => 9,
        }
    }

    /// Returns a point whose entries are numbers of `number`, or in the direction of such numbers.
    pub fn point(self, mut number: impl FnMut() -> f64) -> Vec<f64> {
        let mut list = |n: usize| -> Vec<f64> { (0..n).map(|_| number()).collect() };
        let mut unit = |n: usize| -> Vec<f64> {
            let entries = list(n);
            let length = entries.iter().map(|x| x * x).sum::<f64>().sqrt();
            entries.iter().map(|x| x / length).collect()
        };
        match self {
            Block::Flat(n) => list(n),
            Block::Circle => unit(2),
            Block::Quaternion => unit(4),
            Block::Rotation => {
                let q = unit(4);
                rotation([q[0], q[1], q[2], q[3]], 2.0)
            }
        }
    }

    /// Returns `false`: every block has entries.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// Returns the dimension of its chart, whose rates are ẋ, θ̇, or the body angular velocity.
    pub fn dimension(self) -> usize {
        match self {
            Block::Flat(n) => n,
            Block::Circle => 1,
            Block::Quaternion | Block::Rotation => 3,
        }
    }

    /// Returns the number of its own constraints: one for unit length, or six for Rᵀ R = I.
    pub fn constraints(self) -> usize {
        match self {
            Block::Flat(_) => 0,
            Block::Circle | Block::Quaternion => 1,
            Block::Rotation => 6,
        }
    }
}

/// Returns the blocks of x for a kind of coordinate: two for a pose, one for any other.
pub fn blocks(kind: CoordKind) -> Vec<Block> {
    match kind {
        CoordKind::Real => vec![Block::Flat(1)],
        CoordKind::Euclidean(n) => vec![Block::Flat(n)],
        CoordKind::S1 => vec![Block::Circle],
        CoordKind::S3 => vec![Block::Quaternion],
        CoordKind::SO3 => vec![Block::Rotation],
        CoordKind::SE3 => vec![Block::Flat(3), Block::Rotation],
    }
}

/// Returns the names of a coordinate's entries as the language writes them.
pub fn entry_names(name: &str, kind: CoordKind) -> Vec<String> {
    let matrix = |name: &str| -> Vec<String> {
        (1..=3)
            .flat_map(|i| (1..=3).map(move |j| (i, j)))
            .map(|(i, j)| format!("{name}[{i},{j}]"))
            .collect()
    };
    let vector =
        |name: &str, n: usize| -> Vec<String> { (1..=n).map(|i| format!("{name}[{i}]")).collect() };
    match kind {
        CoordKind::Real => vec![name.to_string()],
        CoordKind::Euclidean(n) => vector(name, n),
        CoordKind::S1 => vec![format!("{name}.c"), format!("{name}.s")],
        CoordKind::S3 => vector(name, 4),
        CoordKind::SO3 => matrix(name),
        CoordKind::SE3 => {
            let mut names = vector(&format!("{name}.p"), 3);
            names.extend(matrix(&format!("{name}.R")));
            names
        }
    }
}

/// Returns a random point of a block, in numbers modulo p, from rational parametrisations of the circle, the sphere S³
/// and SO(3).
pub fn sample(block: Block, random: &mut Random) -> Vec<ResiduePair> {
    match block {
        Block::Flat(n) => (0..n).map(|_| random.element()).collect(),
        Block::Circle => {
            let (c, s) = circle_point(random);
            vec![c, s]
        }
        Block::Quaternion => loop {
            // Stereographic projection: ((1 − |t|²), 2 t)/(1 + |t|²).
            let t: [ResiduePair; 3] = std::array::from_fn(|_| random.element());
            let square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
            if let Some(scale) = (ResiduePair::ONE + square).inv() {
                let mut q = vec![(ResiduePair::ONE - square) * scale];
                q.extend(t.iter().map(|&x| (x + x) * scale));
                return q;
            }
        },
        Block::Rotation => loop {
            let q: [ResiduePair; 4] = std::array::from_fn(|_| random.element());
            let square = q
                .iter()
                .fold(ResiduePair::ZERO, |sum, &entry| sum + entry * entry);
            if let Some(scale) = square.inv() {
                let entries = rotation(q, ResiduePair::new(2)).into_iter();
                return entries.map(|entry| entry * scale).collect();
            }
        },
    }
}

/// Returns |q|² R(q) of a quaternion, scalar first, by rows; `two` is the number 2.
pub fn rotation<T>([w, x, y, z]: [T; 4], two: T) -> Vec<T>
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>,
{
    vec![
        w * w + x * x - y * y - z * z,
        two * (x * y - w * z),
        two * (x * z + w * y),
        two * (x * y + w * z),
        w * w - x * x + y * y - z * z,
        two * (y * z - w * x),
        two * (x * z - w * y),
        two * (y * z + w * x),
        w * w - x * x - y * y + z * z,
    ]
}

/// Returns φ of a block as expressions, each with the text of the row. Only to be called in a graph with unconstrained
/// points.
pub fn constraint(graph: &mut Graph, block: Block, x: &[Edge], name: &str) -> Vec<(Edge, String)> {
    let minus_one = -graph.one();
    let sphere = |graph: &mut Graph, text: String| {
        let square = graph.dot(x, x);
        vec![(graph.add(square, minus_one), text)]
    };
    match block {
        Block::Flat(_) => Vec::new(),
        Block::Circle => sphere(graph, format!("{name}.c^2 + {name}.s^2 = 1")),
        Block::Quaternion => sphere(graph, format!("dot({name}, {name}) = 1")),
        Block::Rotation => {
            let r = std::array::from_fn(|i| std::array::from_fn(|j| x[3 * i + j]));
            let gram = multiply3(graph, &transpose3(&r), &r);
            let rows = [(0, 0), (1, 1), (2, 2), (1, 2), (2, 0), (0, 1)];
            rows.iter()
                .map(|&(i, j)| {
                    let target = if i == j { minus_one } else { graph.zero() };
                    let text = format!(
                        "{name}.T * {name} = identity(3), entry [{},{}]",
                        i + 1,
                        j + 1
                    );
                    (graph.add(gram[i][j], target), text)
                })
                .collect()
        }
    }
}

/// Returns the chart rate of a block as an expression linear in its ẋ: ẋ itself, c ṡ − s ċ, the vector part of 2 q̄ q̇,
/// or ½ (R₃·Ṙ₂ − R₂·Ṙ₃) and cyclic, KR18 (36).
pub fn chart_rate(graph: &mut Graph, block: Block, x: &[Edge], rate: &[Edge]) -> Vec<Edge> {
    match block {
        Block::Flat(_) => rate.to_vec(),
        Block::Circle => {
            let (a, b) = (graph.mul(x[0], rate[1]), graph.mul(x[1], rate[0]));
            vec![graph.sub(a, b)]
        }
        Block::Quaternion => {
            // w = 2 (q₀ v̇ − q̇₀ v − v × v̇)
            let two = graph.ratio(2, 1);
            (0..3)
                .map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    let plus = graph.dot(&[x[0], x[1 + k]], &[rate[1 + i], rate[1 + j]]);
                    let minus = graph.dot(&[x[1 + i], x[1 + j]], &[rate[0], rate[1 + k]]);
                    let difference = graph.sub(plus, minus);
                    graph.mul(two, difference)
                })
                .collect()
        }
        Block::Rotation => {
            let half = graph.ratio(1, 2);
            let column = |m: &[Edge], j: usize| [m[j], m[3 + j], m[6 + j]];
            (0..3)
                .map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    let plus = graph.dot(&column(x, k), &column(rate, j));
                    let minus = graph.dot(&column(x, j), &column(rate, k));
                    let difference = graph.sub(plus, minus);
                    graph.mul(half, difference)
                })
                .collect()
        }
    }
}

/// Returns the identity of a block in numbers: zeros, angle 0, or no rotation.
pub fn identity(block: Block) -> Vec<f64> {
    match block {
        Block::Flat(n) => vec![0.0; n],
        Block::Circle => vec![1.0, 0.0],
        Block::Quaternion => vec![1.0, 0.0, 0.0, 0.0],
        Block::Rotation => vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
    }
}
