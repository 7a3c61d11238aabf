//! Twists and wrenches as six numbers, the angular part first, and rotations.

/// A twist or a wrench: angular part, linear part.
pub type Six = [f64; 6];
/// A matrix by rows.
pub type M3 = [[f64; 3]; 3];
/// Rotation and origin of a frame in the previous one.
pub type Pose = (M3, [f64; 3]);

pub fn add(a: &Six, b: &Six) -> Six {
    std::array::from_fn(|i| a[i] + b[i])
}

pub fn halves(a: &Six) -> ([f64; 3], [f64; 3]) {
    ([a[0], a[1], a[2]], [a[3], a[4], a[5]])
}

pub fn whole(a: [f64; 3], b: [f64; 3]) -> Six {
    [a[0], a[1], a[2], b[0], b[1], b[2]]
}

/// Returns the composition of two poses.
pub fn compose((r, p): &Pose, (rotation, origin): &Pose) -> Pose {
    let moved = apply(r, *origin);
    (
        product(r, rotation),
        std::array::from_fn(|i| p[i] + moved[i]),
    )
}

/// Transforms a twist of the previous frame to the axes and origin of the next.
pub fn into((rotation, origin): &Pose, twist: &Six) -> Six {
    let (w, v) = halves(twist);
    let lever = cross(w, *origin);
    let moved = std::array::from_fn(|i| v[i] + lever[i]);
    whole(transposed(rotation, w), transposed(rotation, moved))
}

/// Transforms a wrench on the next frame to the axes and origin of the previous one.
pub fn back((rotation, origin): &Pose, wrench: &Six) -> Six {
    let (torque, force) = halves(wrench);
    let (torque, force) = (apply(rotation, torque), apply(rotation, force));
    let lever = cross(*origin, force);
    whole(std::array::from_fn(|i| torque[i] + lever[i]), force)
}

/// v × m of two twists
pub fn bracket(v: &Six, m: &Six) -> Six {
    let ((w, u), (a, b)) = (halves(v), halves(m));
    let (first, second, third) = (cross(w, a), cross(w, b), cross(u, a));
    whole(first, std::array::from_fn(|i| second[i] + third[i]))
}

/// v ×* f of a twist and a wrench
pub fn dual(v: &Six, f: &Six) -> Six {
    let ((w, u), (torque, force)) = (halves(v), halves(f));
    let (first, second) = (cross(w, torque), cross(u, force));
    whole(
        std::array::from_fn(|i| first[i] + second[i]),
        cross(w, force),
    )
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn apply(m: &M3, a: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * a[0] + row[1] * a[1] + row[2] * a[2])
}

fn transposed(m: &M3, a: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|j| m[j][i] * a[j]).sum())
}

fn product(a: &M3, b: &M3) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

pub fn rows(q: &[f64]) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| q[3 * i + j]))
}

/// The rotation of a unit quaternion (w, v): I + 2 w v̂ + 2 v̂ v̂
pub fn of_quaternion(q: &[f64]) -> M3 {
    let (w, v) = (q[0], [q[1], q[2], q[3]]);
    columns(|e| {
        let once = cross(v, e);
        let twice = cross(v, once);
        std::array::from_fn(|i| e[i] + 2.0 * (w * once[i] + twice[i]))
    })
}

/// Rz(yaw) Ry(pitch) Rx(roll)
pub fn turn([roll, pitch, yaw]: [f64; 3]) -> M3 {
    let about = |k: usize, angle: f64| about(unit(k), angle.cos(), angle.sin());
    product(&product(&about(2, yaw), &about(1, pitch)), &about(0, roll))
}

/// The rotation about an axis by Rodrigues' formula
pub fn about(n: [f64; 3], c: f64, s: f64) -> M3 {
    columns(|e| {
        let (across, along) = (cross(n, e), n[0] * e[0] + n[1] * e[1] + n[2] * e[2]);
        std::array::from_fn(|i| c * e[i] + s * across[i] + (1.0 - c) * along * n[i])
    })
}

/// Returns a coordinate axis.
pub fn unit(k: usize) -> [f64; 3] {
    std::array::from_fn(|i| f64::from(u8::from(i == k)))
}

/// Returns the matrix of a linear map.
fn columns(of: impl Fn([f64; 3]) -> [f64; 3]) -> M3 {
    let columns = [of(unit(0)), of(unit(1)), of(unit(2))];
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}
