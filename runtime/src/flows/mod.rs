//! Torque-free flows of one rotor, from which methods for bodies in potentials are composed.
//!
//! | flow | moments | |
//! |---|---|---|
//! | [`spherical`] | three equal | exact |
//! | [`axial`] | two equal | exact, two turns |
//! | [`exact`](exact()) | any | exact, Jacobi's elliptic functions |
//! | [`pair`] | two nearly equal | order 2 |
//! | [`axes`] | any | order 2, five turns |
//!
//! They act on an [`Attitude`] (matrix or quaternion) and on the angular momentum P, in principal
//! axes, and keep R P. [`Flow`] chooses among them and takes rotors with other body axes.

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
    /// In closed form for every rotor: turns where it is symmetric, elliptic functions elsewhere.
    #[default]
    Exact,
    /// In closed form for symmetric rotors, [`axes`] for the others: the cheapest of order 2.
    Turns,
    /// In closed form for symmetric rotors, [`pair`] for the others: for nearly symmetric ones.
    Pair,
    /// [`axes`] for every rotor; for comparison.
    Axes,
}

impl Flow {
    /// Whether the flow is exact for the rotor.
    pub fn is_exact<S>(self, rotor: &Rotor<S>) -> bool {
        match self {
            Self::Exact => true,
            Self::Turns | Self::Pair => rotor.symmetry != Symmetry::None,
            Self::Axes => false,
        }
    }

    /// Moves the attitude and P, both of body axes, by `h` without torque.
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
        // The increment is found as a quaternion, whose axis then goes over to body axes. P is turned
        // back by it rather than taken over: axes orthonormal to rounding would scale it each time.
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
            // Written out, so that each is compiled for its axis.
            (_, Symmetry::Axial(0)) => axial(attitude, p, moments, 0, h),
            (_, Symmetry::Axial(1)) => axial(attitude, p, moments, 1, h),
            (_, Symmetry::Axial(_)) => axial(attitude, p, moments, 2, h),
            (Self::Pair, Symmetry::None) => pair(attitude, p, moments, h),
            (Self::Exact, Symmetry::None) => exact(attitude, p, moments, h),
        }
    }
}
