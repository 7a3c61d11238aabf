//! A parallel projection of space, and the images of ellipsoids and their sections.

use super::shape::Vector;
use crate::plot::line::Point;

/// Azimuth and elevation of the isometric view (degrees): all three axes are shortened alike.
pub const ISOMETRIC: (f64, f64) = (-45.0, 35.264_389_682_754_654);

/// Three unit vectors at right angles: to the right and up in the drawing, and towards the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    right: Vector,
    up: Vector,
    eye: Vector,
}

/// Two horizontal directions and the vertical one, right-handed unit vectors.
pub type Base = [Vector; 3];

/// Returns the base with this vertical direction whose first direction is as close to the first axis as possible.
pub fn base(vertical: Vector) -> Base {
    let up = unit(vertical).unwrap_or([0.0, 0.0, 1.0]);
    let along = |axis: Vector| {
        let part = dot(axis, up);
        unit(std::array::from_fn(|k| axis[k] - part * up[k]))
    };
    let steep = up[0].abs() > 0.9;
    let first = along(if steep {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    });
    let first = first.unwrap_or([1.0, 0.0, 0.0]);
    [first, cross(up, first), up]
}

impl View {
    /// Creates a view from an elevation and an azimuth, counted from the first direction of the base towards the second
    /// (degrees).
    pub fn new([first, second, vertical]: Base, (azimuth, elevation): (f64, f64)) -> Self {
        let ((sa, ca), (se, ce)) = (
            azimuth.to_radians().sin_cos(),
            elevation.to_radians().sin_cos(),
        );
        let level: Vector = std::array::from_fn(|k| ca * first[k] + sa * second[k]);
        View {
            right: std::array::from_fn(|k| ca * second[k] - sa * first[k]),
            up: std::array::from_fn(|k| ce * vertical[k] - se * level[k]),
            eye: std::array::from_fn(|k| ce * level[k] + se * vertical[k]),
        }
    }

    /// Projects a point to the drawing, whose second axis points down; lengths are those of space.
    pub fn place(&self, point: Vector) -> Point {
        (dot(self.right, point), -dot(self.up, point))
    }

    /// Returns the direction that points to the right.
    pub fn right(&self) -> Vector {
        self.right
    }

    /// Returns the direction that points up.
    pub fn up(&self) -> Vector {
        self.up
    }

    /// Returns the coordinate of a point towards the eye.
    pub fn depth(&self, point: Vector) -> f64 {
        dot(self.eye, point)
    }
}

/// An ellipse around its centre: its half axes, and the angle of the longer one (degrees).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// The longer half axis.
    pub long: f64,
    /// The shorter half axis.
    pub short: f64,
    /// The angle from the first axis of the drawing to the longer half axis (degrees).
    pub angle: f64,
    /// The symmetric matrix that maps the unit circle to the ellipse: its entries 11, 12 and 22.
    pub root: [f64; 3],
}

impl Ellipse {
    /// Returns the outline of all sums of the arms with coefficients whose squares add up to 1: for three half axes
    /// that of an ellipsoid, for two conjugate ones a plane ellipse.
    pub fn of(arms: &[Point]) -> Self {
        let sum = |f: fn(&Point) -> f64| arms.iter().map(f).sum::<f64>();
        let (a, b, d) = (sum(|p| p.0 * p.0), sum(|p| p.0 * p.1), sum(|p| p.1 * p.1));
        let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
        let apart = half.hypot(b);
        let (long, short) = ((mean + apart).sqrt(), (mean - apart).max(0.0).sqrt());
        // √Q = (Q + √det I) / √(tr Q + 2 √det).
        let det = long * short;
        let scale = 1.0 / (long + short).max(f64::MIN_POSITIVE);
        Ellipse {
            long,
            short,
            angle: if apart > 0.0 {
                0.5 * b.atan2(half).to_degrees()
            } else {
                0.0
            },
            root: [(a + det) * scale, b * scale, (d + det) * scale],
        }
    }
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

/// Normalises a vector; `None` if it has no length.
pub fn unit(a: Vector) -> Option<Vector> {
    let length = dot(a, a).sqrt();
    (length > 1e-12 && length.is_finite()).then(|| a.map(|entry| entry / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_isometric_view_shortens_all_axes_alike() {
        let view = View::new(base([0.0, 0.0, 1.0]), ISOMETRIC);
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let (x, y) = view.place(axis);
            assert!((x.hypot(y) - (2.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        }
        // The third axis points up.
        assert!(view.place([0.0, 0.0, 1.0]).1 < 0.0);
    }

    #[test]
    fn the_outline_of_an_ellipsoid_touches_its_points() {
        let view = View::new(base([0.0, 1.0, 0.2]), (20.0, 40.0));
        let arms = [[0.3, 0.1, 0.0], [-0.1, 0.3, 0.0], [0.0, 0.0, 0.7]];
        let ellipse = Ellipse::of(&arms.map(|arm| view.place(arm)));
        let (s, c) = ellipse.angle.to_radians().sin_cos();
        let mut most: f64 = 0.0;
        for i in 0..=60 {
            for j in 0..120 {
                let (p, q) = (f64::from(i) * 3.0, f64::from(j) * 3.0);
                let ((sp, cp), (sq, cq)) = (p.to_radians().sin_cos(), q.to_radians().sin_cos());
                let weights = [sp * cq, sp * sq, cp];
                let point =
                    std::array::from_fn(|k| (0..3).map(|i| weights[i] * arms[i][k]).sum::<f64>());
                let (x, y) = view.place(point);
                let (u, v) = (
                    (c * x + s * y) / ellipse.long,
                    (c * y - s * x) / ellipse.short,
                );
                most = most.max(u.hypot(v));
            }
        }
        assert!((0.999..1.0 + 1e-12).contains(&most), "{most}");
        // The root squared is Σ p pᵀ.
        let [a, b, d] = ellipse.root;
        let first: f64 = arms.map(|arm| view.place(arm).0.powi(2)).iter().sum();
        assert!((a * a + b * b - first).abs() < 1e-12);
        assert!((a * d - b * b - ellipse.long * ellipse.short).abs() < 1e-12);
    }

    #[test]
    fn bases_are_right_handed() {
        for vertical in [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -9.0],
            [1.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
        ] {
            let [a, b, c] = base(vertical);
            assert!((dot(cross(a, b), c) - 1.0).abs() < 1e-12);
            assert!(dot(c, vertical) > 0.0);
        }
    }
}
