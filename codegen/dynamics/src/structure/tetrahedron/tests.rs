//! Tests of the rotations of the tetrahedron.

use super::{rotation_matrix, tetrahedron};

/// The twelve matrices are rotations, and average products of entries to δ/3.
#[test]
fn the_tetrahedron_averages() {
    let all: Vec<_> = tetrahedron().into_iter().map(rotation_matrix).collect();
    assert_eq!(all.len(), 12);
    for (a, b) in (0..9).flat_map(|a| (0..9).map(move |b| (a, b))) {
        let sum: i64 = all.iter().map(|r| r[a / 3][a % 3] * r[b / 3][b % 3]).sum();
        assert_eq!(sum, if a == b { 4 } else { 0 });
    }
    for r in all {
        let [a, b, c] = r;
        let cross = [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ];
        assert_eq!(cross, c);
    }
}
