//! Systems whose motion splits into free motion in closed form and kicks by forces: rigid bodies in potentials.
//!
//! The Hamiltonian is T(p) + V(x). Without forces, every rotor turns as a torque-free body and everything else moves
//! uniformly. Methods that alternate between this flow and kicks by the forces have no energy drift, at one evaluation
//! of the forces per kick. The generator recognises systems of this form, whatever coordinates and velocities describe
//! them, and implements [`Split`] for them.

use crate::rotor::Rotor;
use crate::system::System;

/// A system that consists of torque-free rotors and uniform motions, with forces that depend only on positions, inputs
/// and time.
///
/// The *centred* coordinates y have the blocks of x; flat blocks that carry a body are moved to its
/// centre of mass. The *momenta* p are laid out like the chart: ẏ for flat blocks, θ̇ for circles, and
/// for quaternions and rotations the angular momentum P of the rotor in body axes, about the centre
/// of mass or the fixed point. Between kicks ẏ, θ̇ and R P are constant.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// # hamel::rigid_eom! {
/// #     system Body {
/// #         param Theta: sym3 = [[2.1, 0.1, 0], [0.1, 1.7, 0], [0, 0, 1.2]];
/// #         coord R: SO3;
/// #         velocity w: vec3;
/// #         rate R = R * hat(w);
/// #         frame hull = pose(R, [0, 0, 0]);
/// #         body on hull { mass 1; inertia Theta about origin; }
/// #         start w = [0.01, 2, 0.01];
/// #     }
/// # }
///
/// use hamel::{Run, Split};
/// use hamel::methods::{Scheme, Splitting};
///
/// let body = Body::<f64>::default();
/// assert_eq!(body.rotors().len(), 1);
/// let method = Splitting::new(&body, Scheme::Strang);
/// let end = Run::new(&body).method(method).step(0.1).until(10.0)?;
/// assert!(end.is_finite());
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "the equations of `{Self}` do not split into free motion and kicks",
    label = "this method needs a torque-free flow in closed form",
    note = "run `hamel check` on the description for the reason; `Rkmk4` and `Rkmk8` work for any system"
)]
pub trait Split: System {
    /// Storage of the rotors.
    type Rotors: Clone + AsRef<[Rotor<Self::Scalar>]>;

    /// Whether no force can act, whatever the inputs: the closed form then gives the motion at any time.
    const FREE: bool;

    /// Returns the rotors, with the inertia that follows from the current parameters: one for every quaternion and
    /// rotation block, in the order of the blocks.
    fn rotors(&self) -> Self::Rotors;

    /// Converts x to the centred coordinates y.
    fn centre(&self, x: &Self::Coordinates) -> Self::Coordinates;

    /// Converts y to x: the inverse of [`centre`](Self::centre).
    fn uncentre(&self, y: &Self::Coordinates) -> Self::Coordinates;

    /// Returns the momenta p of (x, ξ), linear in ξ.
    fn split_momenta(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart;

    /// Returns the velocities ξ of (x, p): the inverse of [`split_momenta`](Self::split_momenta).
    fn split_velocities(&self, x: &Self::Coordinates, p: &Self::Chart) -> Self::Velocities;

    /// Returns ṗ due to the forces alone: ÿ for plain coordinates, θ̈ for circles, the torque in body axes for
    /// quaternions and rotations.
    fn kick(&self, x: &Self::Coordinates, u: &Self::Inputs) -> Self::Chart;
}
