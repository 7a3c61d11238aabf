//! Vectors and matrices of edges, with the products that mechanics in three dimensions needs.

use super::graph::{Edge, Graph};

/// A vector in R³.
pub type Vec3 = [Edge; 3];
/// A 3×3 matrix, stored by rows.
pub type Mat3 = [[Edge; 3]; 3];

/// 0 ∈ R³.
pub fn zero3(graph: &Graph) -> Vec3 {
    [graph.zero(); 3]
}

/// I ∈ R³ˣ³.
pub fn identity3(graph: &Graph) -> Mat3 {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == j { graph.one() } else { graph.zero() })
    })
}

/// a + b.
pub fn add3(graph: &mut Graph, a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| graph.add(a[i], b[i]))
}

/// a − b.
pub fn sub3(graph: &mut Graph, a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| graph.sub(a[i], b[i]))
}

/// k a.
pub fn scale3(graph: &mut Graph, k: Edge, a: Vec3) -> Vec3 {
    a.map(|entry| graph.mul(k, entry))
}

/// a × b.
pub fn cross(graph: &mut Graph, a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let left = graph.mul(a[j], b[k]);
        let right = graph.mul(a[k], b[j]);
        graph.sub(left, right)
    })
}

/// M a.
pub fn apply3(graph: &mut Graph, m: &Mat3, a: Vec3) -> Vec3 {
    std::array::from_fn(|i| graph.dot(&m[i], &a))
}

/// Mᵀ a.
pub fn apply_transposed(graph: &mut Graph, m: &Mat3, a: Vec3) -> Vec3 {
    apply3(graph, &transpose3(m), a)
}

/// Mᵀ.
pub fn transpose3(m: &Mat3) -> Mat3 {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

/// A B.
pub fn multiply3(graph: &mut Graph, a: &Mat3, b: &Mat3) -> Mat3 {
    let columns = transpose3(b);
    std::array::from_fn(|i| std::array::from_fn(|j| graph.dot(&a[i], &columns[j])))
}

/// ⟨A, B⟩ = Σ Aᵢⱼ Bᵢⱼ.
pub fn dot_mat3(graph: &mut Graph, a: &Mat3, b: &Mat3) -> Edge {
    let rows: Vec<Edge> = (0..3).map(|i| graph.dot(&a[i], &b[i])).collect();
    graph.sum(&rows)
}

/// A B for matrices stored as rows.
pub fn multiply(graph: &mut Graph, a: &[Vec<Edge>], b: &[Vec<Edge>]) -> Vec<Vec<Edge>> {
    let columns = b.first().map_or(0, Vec::len);
    let zero = graph.zero();
    a.iter()
        .map(|row| {
            // Large frames are sparse.
            let entries = row.iter().zip(b).filter(|(entry, _)| **entry != zero);
            let entries: Vec<(Edge, &Vec<Edge>)> = entries.map(|(&a, b)| (a, b)).collect();
            (0..columns)
                .map(|j| {
                    entries.iter().fold(zero, |sum, (a, b)| {
                        let product = graph.mul(*a, b[j]);
                        graph.add(sum, product)
                    })
                })
                .collect()
        })
        .collect()
}

/// Builds a matrix from its entries by rows; it is empty if rows have no entries.
pub fn matrix<T: Clone>(entries: &[T], columns: usize) -> Vec<Vec<T>> {
    entries.chunks(columns.max(1)).map(<[T]>::to_vec).collect()
}

/// Mᵀ for a matrix stored as rows.
pub fn transpose(m: &[Vec<Edge>]) -> Vec<Vec<Edge>> {
    let columns = m.first().map_or(0, Vec::len);
    (0..columns)
        .map(|j| m.iter().map(|row| row[j]).collect())
        .collect()
}

/// Computes A⁻¹ B for symmetric A whose leading minors do not vanish on the constraint variety (positive
/// definite on the reals), by Gaussian elimination without row exchanges; `None` if a pivot is identically
/// zero.
pub fn solve_symmetric(
    graph: &mut Graph,
    a: &[Vec<Edge>],
    b: &[Vec<Edge>],
) -> Option<Vec<Vec<Edge>>> {
    let n = a.len();
    let (mut a, mut b) = (a.to_vec(), b.to_vec());
    for k in 0..n {
        for i in k + 1..n {
            let factor = graph.div(a[i][k], a[k][k])?;
            if factor == graph.zero() {
                continue;
            }
            for j in k + 1..n {
                let product = graph.mul(factor, a[k][j]);
                a[i][j] = graph.sub(a[i][j], product);
            }
            for j in 0..b[i].len() {
                let product = graph.mul(factor, b[k][j]);
                b[i][j] = graph.sub(b[i][j], product);
            }
        }
    }
    for i in (0..n).rev() {
        for j in 0..b[i].len() {
            let mut value = b[i][j];
            for k in i + 1..n {
                let product = graph.mul(a[i][k], b[k][j]);
                value = graph.sub(value, product);
            }
            b[i][j] = graph.div(value, a[i][i])?;
        }
    }
    Some(b)
}
