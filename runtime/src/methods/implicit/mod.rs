//! Implicit Euler steps in the chart, by Newton's method: u = h w(x ⊕ u, ξ₁), ξ₁ = ξ + h f(x ⊕ u, ξ₁), x₁ = x ⊕ u.
//!
//! The first equation is not stiff. It is solved by itself by fixed-point iteration, which takes about as many
//! iterations as there are levels in the dependence of the coordinates' rates on other coordinates, and makes u a
//! function of ξ₁. The remaining unknowns are the velocities and first-order states ξ₁,
//!
//! g(ξ₁) = ξ₁ − ξ − h f(x ⊕ u(ξ₁), ξ₁) = 0,  ∂g/∂ξ₁ = I − h ∂f/∂ξ − h ∂f/∂x ∂u/∂ξ₁.
//!
//! If coordinates are plain and ẋ = ξ, ∂g/∂ξ₁ is I − h (T_ξ + h T_x) with the linearisation T = `[A B]`; otherwise it
//! comes from evaluating g in dual numbers. Both are exact. Without a linearisation it is found by finite differences.
//! LU factors are kept as long as the corrections shrink, and are updated from the steps by Broyden's method.
//!
//! If a correction leads to a point that is no nearer to the solution, as measured by the next correction, there are
//! two remedies. First, M(x) g = 0 is solved instead. Far from the solution f = M⁻¹ τ is larger than at the solution by
//! a factor of h² k/m, and ∂(M⁻¹)/∂x τ looks like stiffness; M g contains τ itself, which is nearly linear, and M only
//! as a factor of ξ₁ − ξ. If that fails, for example if a spring between two points is so stiff that it guides a
//! mechanism like a rod, the step is approached through shorter ones, each of which starts from an extrapolation of the
//! last two solutions (continuation in h).
//!
//! Sources: P. Deuflhard, *Newton Methods for Nonlinear Problems* (2011), 3.3 and 5.1; C. T. Kelley, *Iterative Methods for
//! Linear and Nonlinear Equations* (1995), 7.3.

#[cfg(feature = "std")]
pub(super) mod differences;
pub(super) mod equations;
pub(super) mod exact;
mod newton;
pub(super) mod unknowns;

use crate::error::StepError;
use crate::system::System;
use equations::{ImplicitStep, Point};
use unknowns::Unknowns;

/// A way to find ∂g/∂ξ₁.
pub(super) trait Derivative<Sys: System + ?Sized> {
    /// Factors of ∂g/∂ξ₁, used to solve linear equations.
    type Factors;

    /// Whether the derivative includes the dependence of the inputs on the state.
    const KNOWS_INPUTS: bool;

    /// Returns g and the factors of its derivative; adds the evaluations to `iterations`.
    fn linear(
        &self,
        equations: &ImplicitStep<'_, Sys>,
        z: &mut Unknowns<Sys>,
        iterations: &mut u32,
    ) -> Result<(Point<Sys>, Self::Factors), StepError>;

    /// Replaces g by (∂g/∂ξ₁)⁻¹ g.
    fn solve(factors: &Self::Factors, defect: &mut Sys::Velocities);
}
