//! Torque-free flows of one rotor; methods for bodies in potentials are composed of them.
//!
//! | flow | moments | |
//! |---|---|---|
//! | [`spherical`] | three equal | exact |
//! | [`axial`] | two equal | exact, two turns |
//! | [`exact`](exact()) | any | exact, Jacobi's elliptic functions |
//! | [`pair`] | two nearly equal | order 2 |
//! | [`axes`] | any | order 2, five turns |
//!
//! The flows act on an [`Attitude`] (matrix or quaternion) and on the angular momentum P, in principal axes, and
//! conserve R P, the angular momentum in world axes. [`Flow`] selects one of them and also handles rotors whose body
//! axes are not principal.
//!
//! ```
//! use hamel::{Rotor, flows::Flow, so3};
//!
//! let rotor = Rotor::of_moments([1.0, 2.0, 3.0]);
//! let (r, mut p) = (so3::identity(), [0.01, 4.0, 0.01]);
//! let before = so3::apply(r, p);
//! let r = Flow::Exact.turn(&rotor, r, &mut p, 100.0);
//! // The angular momentum in world axes stays.
//! let after: [f64; 3] = so3::apply(r, p);
//! assert!(after.iter().zip(before).all(|(a, b)| (a - b).abs() < 1e-12));
//! ```

mod attitude;
mod carlson;
mod exact;
mod jacobi;
mod nodes;
mod turns;

pub use attitude::{Attitude, SineCosine};
pub use exact::{exact, half_period};
pub use turns::{axes, axial, pair, spherical};

use core::array::from_fn;

use crate::rotor::{Rotor, Symmetry};
use crate::scalar::Scalar;
use crate::so3::{self, Vector};

/// Which torque-free flow a method uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Flow {
    /// Closed form for every rotor: turns if it is symmetric, elliptic functions otherwise.
    #[default]
    Exact,
    /// Closed form for symmetric rotors, [`axes`] for the others: the cheapest flow of order 2.
    Turns,
    /// Closed form for symmetric rotors, [`pair`] for the others: suits nearly symmetric rotors.
    Pair,
    /// [`axes`] for every rotor; for comparison.
    Axes,
}

impl Flow {
    /// Returns whether the flow is exact for the rotor.
    pub fn is_exact<S>(self, rotor: &Rotor<S>) -> bool {
        match self {
            Self::Exact => true,
            Self::Turns | Self::Pair => rotor.symmetry != Symmetry::None,
            Self::Axes => false,
        }
    }

    /// Returns the attitude after the time `h` without torque, and changes P accordingly, both with respect to body axes.
    #[inline(always)]
    pub fn turn<S: Scalar, A: Attitude<S>>(
        self,
        rotor: &Rotor<S>,
        attitude: A,
        p: &mut Vector<S>,
        h: S,
    ) -> A {
        let Some(axes) = rotor.axes else {
            return self.principal(rotor, attitude, p, h);
        };
        // The increment is computed as a quaternion in principal axes, whose vector part is then transformed to body
        // axes. P is rotated back by it instead of being transformed: axes orthonormal only to rounding would rescale P
        // each time.
        let mut own = rotor.to_principal(*p);
        let [w, v @ ..] = self.principal(rotor, <[S; 4]>::identity(), &mut own, h);
        let v = so3::apply(axes, v);
        let twice = |a: Vector<S>| so3::cross(v, a).map(|component| component + component);
        let once = twice(*p);
        let again = so3::cross(v, once);
        *p = from_fn(|i| p[i] + (again[i] - w * once[i]));
        attitude.turned_by([w, v[0], v[1], v[2]])
    }

    #[inline(always)]
    fn principal<S: Scalar, A: Attitude<S>>(
        self,
        rotor: &Rotor<S>,
        attitude: A,
        p: &mut Vector<S>,
        h: S,
    ) -> A {
        let moments = rotor.moments;
        match (self, rotor.symmetry) {
            (Self::Axes, _) | (Self::Turns, Symmetry::None) => axes(attitude, p, moments, h),
            (_, Symmetry::Spherical) => spherical(attitude, *p, moments[0], h),
            // Written out, so that each call is compiled for its axis.
            (_, Symmetry::Axial(0)) => axial(attitude, p, moments, 0, h),
            (_, Symmetry::Axial(1)) => axial(attitude, p, moments, 1, h),
            (_, Symmetry::Axial(_)) => axial(attitude, p, moments, 2, h),
            (Self::Pair, Symmetry::None) => pair(attitude, p, moments, h),
            (Self::Exact, Symmetry::None) => exact(attitude, p, moments, h),
        }
    }
}
