//! Equations of motion as generated, specialised code, and integrators that run them on manifolds.
//!
#![cfg_attr(feature = "macros", doc = include_str!("../README.md"))]
//!
//! # What this crate contains
//!
//! A generated type implements [`System`]: coordinates x, which may be redundant and consist of the kinds of [`Block`],
//! quasi-velocities ξ, and the equations of motion
//!
//! ẋ = A(x) ξ,  ξ̇ = M(x)⁻¹ (f(x, ξ, u) − Γ(x) ξ ξ − ∂V(x)).
//!
//! | | |
//! |---|---|
//! | [`Run`] | runs built by chained calls: method, inputs or controller, observers, events |
//! | [`integrate`](integrate()), [`integrate_while`], [`step`], [`ZeroOrderHold`] | the plain functions beneath: runs in equal steps, single steps, controllers with a period of their own |
//! | [`methods`] | the integrators: explicit and implicit Runge-Kutta methods on Lie groups, variational and splitting methods |
//! | [`adaptive`] | error control, events and dense output |
//! | [`Monitor`] | how well a run conserves energy and satisfies constraints |
//! | [`step_slopes`], [`step_slopes_into`], [`Dual`] | derivatives of a step with respect to state and inputs |
//! | [`flows`], [`Split`] | exact flows of force-free bodies, for systems that split into free motion and kicks |
//! | `ensemble`, `wide` | many states at once, in SIMD lanes and on all cores |
//! | [`adapter`] | any generated system as y′ = f(t, y), for the solvers of other crates |
//! | [`so3`], [`s3`], [`s1`] | rotations as matrices, unit quaternions and angles |
//!
//! Nothing in this crate allocates, except `ensemble`, [`BackwardEuler`](methods::BackwardEuler) on stiff systems, and
//! whatever you store yourself. Nothing panics: every failure is a [`StepError`] or a [`Singular`], whose message says
//! what to do. All numbers may be of any [`Scalar`] type: `f64`, `f32`, dual numbers, SIMD lanes.
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `std` | yes | mathematical functions of the standard library, `Vec` as a [`Store`], and differences in [`BackwardEuler`](methods::BackwardEuler). Without it the crate is `no_std` and takes them from `libm` |
//! | `macros` | yes | [`rigid_eom!`] |
//! | `nalgebra` | no | conversions of states to nalgebra types, in `nalgebra_interop` |
//! | `wide` | no | SIMD lanes as scalars, in `wide` |
//! | `ensemble` | no | many states at once on SIMD lanes and threads, in `ensemble`; implies `std` and `wide` |
//!
//! # A system written by hand
//!
//! The integrators work for any [`System`], whether it was generated or not. Three methods are required; [`Energies`] are
//! for the monitor. This is a pendulum of length l, with x = (cos θ, sin θ), ξ = θ̇ and l θ̈ = −g sin θ:
//!
//! ```
//! use hamel::methods::Rkmk4;
//! use hamel::{s1, Block, Energies, Monitor, Run, Singular, State, System};
//!
//! struct Pendulum { g: f64, l: f64 }
//!
//! impl System for Pendulum {
//!     type Scalar = f64;
//!     type Coordinates = [f64; 2];
//!     type Velocities = [f64; 1];
//!     type Chart = [f64; 1];
//!     type Inputs = [f64; 0];
//!
//!     fn blocks(&self) -> &[Block] { &[Block::Circle] }
//!     fn start(&self) -> ([f64; 2], [f64; 1]) { (s1::exp(1.0), [0.0]) }
//!     fn chart_rate(&self, _: &[f64; 2], xi: &[f64; 1]) -> [f64; 1] { *xi }
//!     fn forward_dynamics(&self, x: &[f64; 2], _: &[f64; 1], _: &[f64; 0]) -> Result<[f64; 1], Singular> {
//!         Ok([-self.g / self.l * x[1]])
//!     }
//! }
//!
//! impl Energies for Pendulum {
//!     fn kinetic_energy(&self, _: &[f64; 2], xi: &[f64; 1]) -> f64 {
//!         0.5 * (self.l * xi[0]).powi(2)
//!     }
//!     fn potential_energy(&self, x: &[f64; 2]) -> f64 { -self.g * self.l * x[0] }
//! }
//!
//! # fn main() -> Result<(), hamel::StepError> {
//! let pendulum = Pendulum { g: 9.81, l: 0.5 };
//! let mut monitor = Monitor::new(&pendulum, &State::start(&pendulum));
//! let end = Run::new(&pendulum)
//!     .method(Rkmk4)
//!     .step(1e-3)
//!     .observe(|state| monitor.observe(&pendulum, state))
//!     .until(10.0)?;
//! assert_eq!(end.t, 10.0);
//! assert!(monitor.relative_energy_deviation() < 1e-10);
//! assert!(monitor.constraint() < 1e-15);
//! # Ok(())
//! # }
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(feature = "std"), no_std)]

pub mod adapter;
pub mod adaptive;
mod canonical;
mod clock;
mod dual;
#[cfg(feature = "ensemble")]
pub mod ensemble;
mod error;
pub mod flows;
mod integrate;
mod lanes;
pub mod manifold;
pub mod methods;
mod monitor;
#[cfg(feature = "nalgebra")]
pub mod nalgebra_interop;
pub mod rotor;
pub mod run;
pub mod s1;
pub mod s3;
mod scalar;
mod slopes;
pub mod so3;
mod split;
mod state;
mod store;
mod system;
#[doc(hidden)]
pub mod trig;
#[cfg(feature = "wide")]
pub mod wide;
mod zero_order_hold;

pub use canonical::Canonical;
pub use clock::Clock;
pub use dual::Dual;
pub use error::{Singular, StepError};
#[cfg(feature = "macros")]
pub use hamel_macros::rigid_eom;
pub use integrate::{Grid, integrate, integrate_while, step};
pub use lanes::Lanes;
pub use methods::Method;
pub use monitor::Monitor;
#[cfg(feature = "nalgebra")]
pub use nalgebra;
pub use rotor::Rotor;
pub use run::Run;
pub use scalar::Scalar;
pub use slopes::{
    Directions, Sparsity, Stepped, Tangent, TangentStep, TangentSystem, step_slopes,
    step_slopes_into,
};
pub use split::Split;
pub use state::State;
pub use store::{Store, Table};
pub use system::{Block, Energies, System};
pub use zero_order_hold::ZeroOrderHold;
