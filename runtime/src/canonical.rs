//! Systems that provide their equations of motion in generalised momenta as well.

use crate::error::Singular;
use crate::system::System;

/// A system that also provides its equations of motion in generalised momenta p = M(x) ξ, KR18 (30a).
///
/// Symplectic methods for long runs integrate (x, p): if M depends on x, the motion is symplectic in p, not in ξ.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// # hamel::rigid_eom! {
/// #     system Pendulum {
/// #         coord q;
/// #         velocity w;
/// #         rate q = w;
/// #         kinetic w^2 / 2;
/// #         potential -cos(q);
/// #         input tau;
/// #         generalized force w = tau;
/// #         start q = 1;
/// #     }
/// # }
///
/// use hamel::{Canonical, Run, State, methods::Gauss4};
///
/// let pendulum = Pendulum::<f64>::default();
/// let end = Run::new(&pendulum).method(Gauss4).step(0.1).until(10.0)?;
/// let p = Canonical::momentum(&pendulum, &end.x, &end.xi);
/// assert_eq!(p, end.xi); // M = 1
/// # let _: State<Pendulum<f64>> = end;
/// # }
/// # Ok::<(), hamel::StepError>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "the momenta of `{Self}` are not generated",
    label = "this method steps generalised momenta",
    note = "systems with constraints on velocities have none; for others add momentum_rate and velocity_from_momentum to `generate`"
)]
pub trait Canonical: System {
    /// Returns p = M(x) ξ.
    fn momentum(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Velocities;

    /// Returns ṗᵢ = ∂ᵢL − γᵢⱼᵏ ξʲ pₖ + fᵢ.
    fn momentum_rate(
        &self,
        x: &Self::Coordinates,
        xi: &Self::Velocities,
        u: &Self::Inputs,
    ) -> Self::Velocities;

    /// Returns ξ = M(x)⁻¹ p.
    ///
    /// # Errors
    /// [`Singular`] if M is not positive definite at x.
    fn velocity_from_momentum(
        &self,
        x: &Self::Coordinates,
        p: &Self::Velocities,
    ) -> Result<Self::Velocities, Singular>;
}
