//! Differences between two points of a coordinate in its chart, and how their rates follow from those of the chart.

use super::layout::Block;

/// Computes the chart rate of a block in numbers from x and ẋ: ẋ, θ̇, or the angular velocity in body axes.
pub fn chart_rate(block: Block, x: &[f64], rate: &[f64]) -> Vec<f64> {
    match block {
        Block::Flat(_) => rate.to_vec(),
        Block::Circle => vec![x[0] * rate[1] - x[1] * rate[0]],
        Block::Quaternion => {
            let entry = |i: usize| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let plus = x[0] * rate[1 + i] + x[1 + k] * rate[1 + j];
                2.0 * (plus - x[1 + i] * rate[0] - x[1 + j] * rate[1 + k])
            };
            (0..3).map(entry).collect()
        }
        Block::Rotation => {
            let product = |j: usize, k: usize| -> f64 {
                (0..3).map(|row| x[3 * row + j] * rate[3 * row + k]).sum()
            };
            let entry = |i: usize| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                0.5 * (product(k, j) - product(j, k))
            };
            (0..3).map(entry).collect()
        }
    }
}

/// Computes in numbers the difference between two points of a block in its chart, and the matrix that maps the chart
/// rate to the rate of the difference.
pub fn chart_difference(block: Block, from: &[f64], to: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
    match block {
        Block::Flat(n) => {
            let way = to.iter().zip(from).map(|(a, b)| a - b).collect();
            let row = |i: usize| (0..n).map(|j| f64::from(i == j)).collect();
            (way, (0..n).map(row).collect())
        }
        Block::Circle => {
            let (c, s) = (
                from[0] * to[0] + from[1] * to[1],
                from[0] * to[1] - from[1] * to[0],
            );
            (vec![s.atan2(c)], vec![vec![1.0]])
        }
        Block::Quaternion => turned(relative(from, to)),
        Block::Rotation => turned(relative(&quaternion(from), &quaternion(to))),
    }
}

/// Returns p̄ q.
fn relative(p: &[f64], q: &[f64]) -> [f64; 4] {
    let entry = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        p[0] * q[1 + i] - q[0] * p[1 + i] - p[1 + j] * q[1 + k] + p[1 + k] * q[1 + j]
    };
    let scalar = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
    [scalar, entry(0), entry(1), entry(2)]
}

/// Returns the unit quaternion of a rotation matrix by rows, up to its sign.
fn quaternion(r: &[f64]) -> [f64; 4] {
    let trace = r[0] + r[4] + r[8];
    let squares = [
        1.0 + trace,
        1.0 + 2.0 * r[0] - trace,
        1.0 + 2.0 * r[4] - trace,
        1.0 + 2.0 * r[8] - trace,
    ];
    let largest = (0..4).fold(
        0,
        |best, k| if squares[k] > squares[best] { k } else { best },
    );
    // Row of twice the products of the largest entry with the others.
    let skew = [r[7] - r[5], r[2] - r[6], r[3] - r[1]];
    let sum = |i: usize, j: usize| r[3 * i + j] + r[3 * j + i];
    let row = match largest {
        0 => [squares[0], skew[0], skew[1], skew[2]],
        1 => [skew[0], squares[1], sum(0, 1), sum(0, 2)],
        2 => [skew[1], sum(0, 1), squares[2], sum(1, 2)],
        _ => [skew[2], sum(0, 2), sum(1, 2), squares[3]],
    };
    let length = row.iter().map(|e| e * e).sum::<f64>().sqrt();
    row.map(|e| e / length)
}

/// Computes the rotation vector δ of a unit quaternion, and the matrix 1 + δ̂/2 + κ δ̂² that maps ω to δ̇, in numbers.
pub fn turned(q: [f64; 4]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let q = if q[0] < 0.0 { q.map(|e| -e) } else { q };
    let v = [q[1], q[2], q[3]];
    let length = v.iter().map(|e| e * e).sum::<f64>().sqrt();
    let angle = 2.0 * length.atan2(q[0]);
    let factor = if length > 1e-8 { angle / length } else { 2.0 };
    let way = v.map(|e| factor * e);
    let kappa = match angle {
        small if small < 1e-3 => 1.0 / 12.0 + small * small / 720.0,
        angle => 1.0 / (angle * angle) - q[0] / (2.0 * angle * length),
    };
    let square: f64 = way.iter().map(|e| e * e).sum();
    let entry = |i: usize, j: usize| {
        let bent = kappa * way[i] * way[j];
        match (3 + j - i) % 3 {
            0 => 1.0 + bent - kappa * square,
            1 => bent - 0.5 * way[(i + 2) % 3],
            _ => bent + 0.5 * way[(i + 1) % 3],
        }
    };
    let rows = (0..3).map(|i| (0..3).map(|j| entry(i, j)).collect());
    (way.to_vec(), rows.collect())
}
