//! Implicit steps of Euler in the chart: u = h w(x ⊕ u, ξ₁), ξ₁ = ξ + h f(x ⊕ u, ξ₁), x₁ = x ⊕ u, by Newton's method.
//!
//! The first of these equations is not stiff. It is solved by itself, in as many turns as coordinates move one another, and
//! makes u a function of ξ₁; what is left are as many unknowns as there are velocities and states,
//!
//! g(ξ₁) = ξ₁ − ξ − h f(x ⊕ u(ξ₁), ξ₁) = 0,  ∂g/∂ξ₁ = I − h ∂f/∂ξ − h ∂f/∂x ∂u/∂ξ₁.
//!
//! Where coordinates are plain and ẋ = ξ, ∂g/∂ξ₁ is I − h (T_ξ + h T_x) with the linearisation T = [A B], else it comes from
//! the same sums in dual numbers: both are exact. Without a linearisation it is found by differences. Factors are kept as
//! long as corrections shrink, and corrected by the steps (Broyden).
//!
//! Where a point turns out to be no nearer, measured by the correction that follows, there are two remedies. First, M(x) g = 0
//! is solved instead. Far from the solution f = M⁻¹ τ is larger by h² k/m than it will be, and ∂(M⁻¹)/∂x τ passes for
//! stiffness; M g contains τ itself, which is nearly linear, and M only beside ξ₁ − ξ. Where that does not do, as where a
//! spring between two points is so stiff that it guides a mechanism like a rod, the step is approached by way of shorter
//! ones, each of which begins where the last two point (continuation in h).
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
use equations::{Equations, Point};
use unknowns::Unknowns;

/// How ∂g/∂ξ₁ is found.
pub(super) trait Derivative<Sys: System + ?Sized> {
    /// What is solved with it.
    type Factors;

    /// Whether it knows how inputs follow the state.
    const KNOWS_INPUTS: bool;

    /// g with the factors of its slopes; evaluations are counted.
    fn linear(
        &self,
        equations: &Equations<'_, Sys>,
        z: &mut Unknowns<Sys>,
        iterations: &mut u32,
    ) -> Result<(Point<Sys>, Self::Factors), StepError>;

    /// (∂g/∂ξ₁)⁻¹ g in the place of g.
    fn solve(factors: &Self::Factors, defect: &mut Sys::Velocities);
}
