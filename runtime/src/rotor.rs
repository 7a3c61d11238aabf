//! The inertia of a torque-free rotor, and what its symmetry lets a method do.

use crate::scalar::Scalar;
use crate::so3::{Matrix, Vector};

/// How the principal moments are equal, which decides how the torque-free flow is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Three equal moments: the rotor turns about a fixed axis.
    Spherical,
    /// The two moments beside this principal axis (0, 1, 2) are equal: two turns are exact.
    Axial(usize),
    /// Three different moments: Jacobi's elliptic functions.
    None,
}

/// One torque-free rotor.
#[derive(Clone, Copy, Debug)]
pub struct Rotor<S> {
    /// J₁, J₂, J₃.
    pub moments: Vector<S>,
    /// Principal axes as columns, in body axes; `None` where they are the body axes.
    pub axes: Option<Matrix<S>>,
    /// What is known to be equal.
    pub symmetry: Symmetry,
}

impl<S: Scalar> Rotor<S> {
    /// A rotor whose body axes are principal and whose symmetry is known from its description.
    pub fn principal(moments: Vector<S>, symmetry: Symmetry) -> Self {
        Self {
            moments,
            axes: None,
            symmetry,
        }
    }

    /// A rotor whose body axes are principal; that moments are equal is not known.
    pub fn of_moments(moments: [S; 3]) -> Self {
        Self::principal(moments, Symmetry::None)
    }

    /// A rotor of any inertia J, body axes.
    pub fn general(inertia: [[S; 3]; 3]) -> Self {
        let [[a, ..], [_, b, _], [.., c]] = inertia;
        Self::of_moments([a, b, c])
    }
}
