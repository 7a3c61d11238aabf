//! Small dense linear systems, by elimination with the largest pivots.

/// Returns the least pivot of a matrix restricted to some directions, relative to the diagonal; 1 if there are none.
pub fn least_pivot(mass: &[Vec<f64>], columns: &[Vec<f64>]) -> f64 {
    let n = mass.len();
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        pairs.map(|(i, j)| a[i] * mass[i][j] * b[j]).sum()
    };
    let k = columns.len();
    let whole: Vec<Vec<f64>> = columns
        .iter()
        .map(|a| columns.iter().map(|b| product(a, b)).collect())
        .collect();
    let mut rest = whole.clone();
    let mut least: f64 = 1.0;
    for c in 0..k {
        // NaN if a direction has no inertia.
        let ratio = rest[c][c] / whole[c][c];
        if ratio.is_nan() || ratio < 1e-12 {
            return 0.0;
        }
        least = least.min(ratio);
        for i in c + 1..k {
            for j in c + 1..k {
                rest[i][j] -= rest[i][c] * rest[c][j] / rest[c][c];
            }
        }
    }
    least
}

/// Returns ξ̇ of M ξ̇ − Bᵀ λ = f, B ξ̇ = b.
pub fn solution(
    (mass, force): (Vec<Vec<f64>>, Vec<f64>),
    (rows, right): (Vec<Vec<f64>>, Vec<f64>),
) -> Vec<f64> {
    let (n, size) = (force.len(), force.len() + rows.len());
    let mut a = vec![vec![0.0; size + 1]; size];
    for i in 0..n {
        a[i][..n].copy_from_slice(&mass[i]);
        a[i][size] = force[i];
        for (k, row) in rows.iter().enumerate() {
            (a[i][n + k], a[n + k][i]) = (-row[i], row[i]);
        }
    }
    for (k, right) in right.iter().enumerate() {
        a[n + k][size] = *right;
    }
    for c in 0..size {
        let largest = (c..size).max_by(|&i, &j| a[i][c].abs().total_cmp(&a[j][c].abs()));
        a.swap(c, largest.expect("a row"));
        for i in (0..size).filter(|&i| i != c) {
            let factor = a[i][c] / a[c][c];
            for j in c..=size {
                let part = factor * a[c][j];
                a[i][j] -= part;
            }
        }
    }
    (0..n).map(|i| a[i][size] / a[i][i]).collect()
}

/// Returns the shortest vector of n entries that satisfies some independent rows.
pub fn shortest(rows: &[Vec<f64>], right: &[f64], n: usize) -> Vec<f64> {
    let unit = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect());
    solution(
        (unit.collect(), vec![0.0; n]),
        (rows.to_vec(), right.to_vec()),
    )
}

/// Returns a basis of the kernel of some rows, by elimination with the largest pivots, and the least of these pivots.
pub fn kernel(rows: &[Vec<f64>], n: usize) -> (Vec<Vec<f64>>, f64) {
    let mut rows = rows.to_vec();
    let mut pivots: Vec<usize> = Vec::new();
    let mut least: f64 = 1.0;
    for r in 0..rows.len() {
        let width = rows[r].len();
        let all = (r..rows.len()).flat_map(|i| (0..width).map(move |j| (i, j)));
        let best = all.max_by(|a, b| {
            let size = |at: &(usize, usize)| rows[at.0][at.1].abs();
            size(a).total_cmp(&size(b))
        });
        let Some((row, column)) = best else { break };
        least = least.min(rows[row][column].abs());
        rows.swap(r, row);
        let own = rows[r].clone();
        for (i, other) in rows.iter_mut().enumerate() {
            let factor = match i == r {
                true => 1.0 - 1.0 / own[column],
                false => other[column] / own[column],
            };
            other
                .iter_mut()
                .zip(&own)
                .for_each(|(a, b)| *a -= factor * b);
        }
        pivots.push(column);
    }
    let free = (0..n).filter(|column| !pivots.contains(column));
    let basis = free.map(|column| {
        let mut vector = vec![0.0; n];
        vector[column] = 1.0;
        for (row, &pivot) in rows.iter().zip(&pivots) {
            vector[pivot] = -row[column];
        }
        vector
    });
    (basis.collect(), least)
}
