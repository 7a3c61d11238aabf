//! Systems whose kinetic energy moves by itself in closed form: bodies in potentials.
//!
//! The Hamiltonian is T(p) + V(x): with the forces away, every rotor turns as a torque-free body and
//! everything else moves uniformly. Methods that alternate between that flow and kicks of the forces
//! keep energy without drift, at one evaluation of forces a kick. Only the generator can tell that a
//! system is of this form, in whatever coordinates and velocities it was described; it then
//! implements [`Split`].

use crate::rotor::Rotor;
use crate::system::System;

/// A system that is a product of torque-free rotors and uniform motions, with forces that depend on
/// positions, inputs and time alone.
///
/// The *centred* coordinates y have the blocks of x; flat blocks that carry a body are moved to its
/// centre of mass. The *momenta* p are laid out like the chart: ẏ for flat blocks, θ̇ for circles, and
/// for quaternions and rotations the angular momentum P of the rotor in body axes, about the centre
/// of mass or the fixed point. Between kicks ẏ, θ̇ and R P are constant.
#[diagnostic::on_unimplemented(
    message = "the equations of `{Self}` do not split into free motion and kicks",
    label = "this method needs a torque-free flow in closed form",
    note = "`hamel check` on the description says what stands in the way; `Rkmk4` and `Rkmk8` run any system"
)]
pub trait Split: System {
    /// Storage of the rotors.
    type Rotors: Clone + AsRef<[Rotor<Self::Scalar>]>;

    /// Whether no force acts, whatever the inputs: the closed form then gives
    /// the motion at any time.
    const FREE: bool;

    /// The rotors, with the inertia of the present parameters, one for every quaternion and rotation
    /// block, in the order of the blocks.
    fn rotors(&self) -> Self::Rotors;

    /// y of x.
    fn centre(&self, x: &Self::Coordinates) -> Self::Coordinates;

    /// x of y: the inverse of [`centre`](Self::centre).
    fn uncentre(&self, y: &Self::Coordinates) -> Self::Coordinates;

    /// p of (x, ξ), linear in ξ.
    fn split_momenta(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart;

    /// ξ of (x, p): the inverse of [`split_momenta`](Self::split_momenta).
    fn split_velocities(&self, x: &Self::Coordinates, p: &Self::Chart) -> Self::Velocities;

    /// ṗ by the forces alone: ÿ (flat), θ̈ (circle), torque in body axes (quaternion, rotation).
    fn kick(&self, x: &Self::Coordinates, u: &Self::Inputs) -> Self::Chart;
}
