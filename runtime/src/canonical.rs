//! Systems whose motion is also given in generalised momenta.

use crate::error::Singular;
use crate::system::System;

/// A system that also gives its motion in generalised momenta p = M(x) ξ, KR18 (30a).
///
/// Methods for long runs step (x, p): if M depends on x, it is in p that the motion is symplectic.
#[diagnostic::on_unimplemented(
    message = "the momenta of `{Self}` are not generated",
    label = "this method steps generalised momenta",
    note = "systems with constraints on velocities have none; a `generate` list has to name momentum_rate and velocity_from_momentum"
)]
pub trait Canonical: System {
    /// p = M(x) ξ.
    fn momentum(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Velocities;

    /// ṗᵢ = ∂ᵢL − γᵢⱼᵏ ξʲ pₖ + fᵢ.
    fn momentum_rate(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Self::Velocities;

    /// ξ = M(x)⁻¹ p.
    ///
    /// # Errors
    /// [`Singular`] if M is not positive definite at x.
    fn velocity_from_momentum(
        &self,
        x: &Self::Coordinates,
        p: &Self::Velocities,
    ) -> Result<Self::Velocities, Singular>;
}
