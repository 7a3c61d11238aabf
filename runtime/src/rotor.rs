//! The inertia of a torque-free rotor, and its symmetry, which decides how its flow is computed.

use core::array::from_fn;

use crate::scalar::{Scalar, epsilon};
use crate::so3::{self, Matrix, Vector};

/// Which principal moments of inertia are equal; this decides how the torque-free flow is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Three equal moments: the rotor turns about a fixed axis.
    Spherical,
    /// The two moments other than that of this principal axis (0, 1, 2) are equal: the flow is exactly two turns.
    Axial(usize),
    /// Three different moments: the flow needs Jacobi's elliptic functions.
    None,
}

/// A torque-free rotor.
///
/// ```
/// use hamel::Rotor;
/// use hamel::rotor::Symmetry;
///
/// let wheel = Rotor::of_moments([0.2, 0.2, 0.4]);
/// assert_eq!(wheel.symmetry, Symmetry::Axial(2));
/// let body = Rotor::general([2.0, 0.5, 0.0, 0.5, 2.0, 0.0, 0.0, 0.0, 1.0]);
/// let mut moments: [f64; 3] = body.moments;
/// moments.sort_by(f64::total_cmp);
/// assert!((moments[2] - 2.5).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Rotor<S> {
    /// The principal moments J₁, J₂, J₃.
    pub moments: Vector<S>,
    /// The principal axes as columns, in body axes; `None` if they are the body axes.
    pub axes: Option<Matrix<S>>,
    /// Which moments are known to be equal.
    pub symmetry: Symmetry,
}

/// Moments of a diagonal inertia count as equal if they differ by less than this many rounding units of the largest.
const ULPS_GIVEN: f64 = 4.0;
/// The same limit for moments computed by Jacobi rotations.
const ULPS_COMPUTED: f64 = 16.0;
/// Number of sweeps of Jacobi's method. The off-diagonal part shrinks quadratically; three sweeps usually suffice.
const SWEEPS: usize = 7;

impl<S: Scalar> Rotor<S> {
    /// Creates a rotor whose body axes are principal and whose symmetry is known from its description.
    pub fn principal(moments: Vector<S>, symmetry: Symmetry) -> Self {
        Self {
            moments,
            axes: None,
            symmetry,
        }
    }

    /// Creates a rotor whose body axes are principal. Moments that agree to rounding in all lanes are taken as equal.
    pub fn of_moments(moments: Vector<S>) -> Self {
        Self::principal(moments, symmetry(moments, ULPS_GIVEN))
    }

    /// Creates a rotor from any inertia matrix, of which only the symmetric part counts. Jacobi rotations yield the
    /// principal moments and axes; moments that agree to rounding are taken as equal.
    ///
    /// C. G. J. Jacobi 1846; W. H. Press et al., *Numerical Recipes*, 11.1.
    pub fn general(inertia: Matrix<S>) -> Self {
        let half = S::from_f64(0.5);
        let mut j: Matrix<S> = from_fn(|k| half * (inertia[k] + inertia[3 * (k % 3) + k / 3]));
        if [j[1], j[2], j[5]]
            .iter()
            .all(|entry| entry.magnitude().largest_lane() == 0.0)
        {
            return Self::of_moments([j[0], j[4], j[8]]);
        }
        let mut axes = so3::identity();
        for _ in 0..SWEEPS {
            for (a, b) in [(0, 1), (0, 2), (1, 2)] {
                let turn = rotation(j, a, b);
                j = so3::transpose_product(turn, so3::product(j, turn));
                axes = so3::product(axes, turn);
            }
        }
        let moments = [j[0], j[4], j[8]];
        Self {
            moments,
            axes: Some(so3::polar(axes)),
            symmetry: symmetry(moments, ULPS_COMPUTED),
        }
    }

    /// Transforms a vector from body axes to principal axes.
    #[inline]
    pub fn to_principal(&self, body: Vector<S>) -> Vector<S> {
        self.axes
            .map_or(body, |axes| so3::apply_transpose(axes, body))
    }

    /// Transforms a vector from principal axes to body axes.
    #[inline]
    pub fn to_body(&self, principal: Vector<S>) -> Vector<S> {
        self.axes
            .map_or(principal, |axes| so3::apply(axes, principal))
    }
}

/// Returns the rotation about the third axis that makes the entry (a, b) of a symmetric matrix vanish:
/// tan θ = 2 j_ab sgn d / (|d| + √(d² + 4 j_ab²)), d = j_bb − j_aa.
fn rotation<S: Scalar>(j: Matrix<S>, a: usize, b: usize) -> Matrix<S> {
    let (zero, one) = (S::default(), S::from_f64(1.0));
    let twice = S::from_f64(2.0) * j[3 * a + b];
    let difference = j[4 * b] - j[4 * a];
    let length = difference.abs() + (difference * difference + twice * twice).sqrt();
    let signed = difference.select_lt(zero, -twice, twice);
    let tangent = zero.select_lt(length, signed / length, zero);
    let cosine = one / (one + tangent * tangent).sqrt();
    let sine = tangent * cosine;
    let mut turn = so3::identity();
    turn[4 * a] = cosine;
    turn[4 * b] = cosine;
    turn[3 * a + b] = sine;
    turn[3 * b + a] = -sine;
    turn
}

/// Finds which moments differ by less than `ulps` rounding units of the largest, in all lanes, and have the same
/// slopes.
fn symmetry<S: Scalar>(moments: Vector<S>, ulps: f64) -> Symmetry {
    let [a, b, c] = moments;
    let largest = Scalar::max(Scalar::max(a.abs(), b.abs()), c.abs());
    let limit = S::from_f64(ulps) * epsilon::<S>();
    let equal = |a: S, b: S| (limit * largest.magnitude() - (a - b).magnitude()).is_positive();
    match (equal(b, c), equal(c, a), equal(a, b)) {
        (true, true, true) => Symmetry::Spherical,
        (true, _, false) => Symmetry::Axial(0),
        (_, true, false) => Symmetry::Axial(1),
        (_, _, true) => Symmetry::Axial(2),
        _ => Symmetry::None,
    }
}
