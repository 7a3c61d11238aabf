//! The twelve rotations of the tetrahedron.

#[cfg(test)]
mod tests;

/// Returns the rotations of the tetrahedron as unit quaternions multiplied by two.
pub fn tetrahedron() -> Vec<[i64; 4]> {
    let mut twice: Vec<[i64; 4]> = (0..4)
        .map(|axis| std::array::from_fn(|i| if i == axis { 2 } else { 0 }))
        .collect();
    twice.extend((0..8).map(|bits| {
        let sign = |bit: i64| if bits >> bit & 1 == 1 { -1 } else { 1 };
        [1, sign(0), sign(1), sign(2)]
    }));
    twice
}

/// Returns the rotation matrix of a quaternion divided by two; for those above, its entries are 0,
/// 1 and −1.
pub fn rotation_matrix([w, x, y, z]: [i64; 4]) -> [[i64; 3]; 3] {
    let rows = [
        [
            w * w + x * x - y * y - z * z,
            2 * (x * y - w * z),
            2 * (x * z + w * y),
        ],
        [
            2 * (x * y + w * z),
            w * w - x * x + y * y - z * z,
            2 * (y * z - w * x),
        ],
        [
            2 * (x * z - w * y),
            2 * (y * z + w * x),
            w * w - x * x - y * y + z * z,
        ],
    ];
    rows.map(|row| row.map(|entry| entry / 4))
}
