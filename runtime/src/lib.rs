//! Equations of motion as specialised code, and their integration on manifolds.
//!
#![cfg_attr(feature = "macros", doc = include_str!("../README.md"))]
//!
//! # What this crate contains
//!
//! A generated type implements [`System`]: coordinates x, possibly redundant and of the kinds of [`Block`],
//! quasi-velocities ξ, and the equations of motion
//!
//! ẋ = A(x) ξ,  ξ̇ = M(x)⁻¹ (f(x, ξ, u) − Γ(x) ξ ξ − ∂V(x)).
//!
//! | | |
//! |---|---|
//! | [`integrate`](integrate()), [`integrate_while`], [`step`], [`Sampled`] | runs in equal steps, single steps, and runs with a controller that has a period of its own |
//! | [`methods`] | the integrators: explicit and implicit Runge-Kutta methods on Lie groups, variational and splitting methods |
//! | [`adaptive`] | error control, events and dense output |
//! | [`Monitor`] | how well a run keeps energy, momentum and constraints |
//! | [`step_slopes`], [`step_slopes_into`], [`Dual`] | the derivatives of a step with respect to state and inputs |
//! | [`flows`], [`Split`] | exact flows of free bodies, for systems that split into free motion and kicks |
//! | `ensemble`, `wide` | many states at once, in SIMD lanes and on all cores |
//! | [`adapter`] | any generated system as y′ = f(t, y), for the solvers of other crates |
//! | [`so3`], [`s3`], [`s1`] | rotations as matrices, unit quaternions and angles |
//!
//! Nothing here allocates (but for `ensemble`, [`BackwardEuler`](methods::BackwardEuler) where a system is stiff, and what you
//! store yourself), and nothing panics: whatever fails is a [`StepError`] or a [`Singular`] that says what to do. Numbers can
//! be of any [`Scalar`] type: `f64`, `f32`, dual numbers, SIMD lanes.
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `std` | yes | mathematical functions of the standard library, `Vec` as a [`Store`], and differences in [`BackwardEuler`](methods::BackwardEuler). Without it the crate is `no_std` and takes them from `libm` |
//! | `macros` | yes | [`rigid_eom!`] |
//! | `nalgebra` | yes | states as types of nalgebra, in `edge` |
//! | `wide` | no | SIMD lanes as scalars, in `wide` |
//! | `ensemble` | no | many states on lanes and threads, in `ensemble`; implies `std` and `wide` |
//!
//! # A system written by hand
//!
//! The integrators work for any [`System`], whether it was generated or not.
//! A pendulum of length l, x = (cos θ, sin θ), ξ = θ̇, l θ̈ = −g sin θ, as written by hand:
//!
//! ```
//! use hamel::methods::Rkmk4;
//! use hamel::{integrate, s1, Block, Monitor, Singular, State, System};
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
//!     fn zero_coordinates(&self) -> [f64; 2] { [0.0; 2] }
//!     fn zero_velocities(&self) -> [f64; 1] { [0.0] }
//!     fn zero_chart(&self) -> [f64; 1] { [0.0] }
//!     fn zero_inputs(&self) -> [f64; 0] { [] }
//!     fn start(&self) -> ([f64; 2], [f64; 1]) { (s1::exp(1.0), [0.0]) }
//!     fn rate(&self, x: &[f64; 2], xi: &[f64; 1]) -> [f64; 2] { s1::rate(*x, xi[0]) }
//!     fn chart_rate(&self, _: &[f64; 2], xi: &[f64; 1]) -> [f64; 1] { *xi }
//!     fn accel(&self, x: &[f64; 2], _: &[f64; 1], _: &[f64; 0]) -> Result<[f64; 1], Singular> {
//!         Ok([-self.g / self.l * x[1]])
//!     }
//!     fn correction(&self, x: &[f64; 2]) -> [f64; 2] { s1::correction(*x) }
//!     fn constraint_norm(&self, x: &[f64; 2]) -> f64 { s1::defect(*x) }
//!     fn kinetic_energy(&self, _: &[f64; 2], xi: &[f64; 1]) -> f64 {
//!         0.5 * (self.l * xi[0]).powi(2)
//!     }
//!     fn potential_energy(&self, x: &[f64; 2]) -> f64 { -self.g * self.l * x[0] }
//! }
//!
//! # fn main() -> Result<(), hamel::StepError> {
//! let pendulum = Pendulum { g: 9.81, l: 0.5 };
//! let mut state = State::start(&pendulum);
//! let mut monitor = Monitor::new(&pendulum, &state);
//! integrate(&pendulum, Rkmk4, &mut state, 1e-3, 10.0, |_, _, _| [], |state| {
//!     monitor.observe(&pendulum, state);
//! })?;
//! assert_eq!(state.t, 10.0);
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
#[cfg(feature = "nalgebra")]
pub mod edge;
#[cfg(feature = "ensemble")]
pub mod ensemble;
mod error;
pub mod flows;
mod integrate;
mod lanes;
pub mod manifold;
pub mod methods;
mod monitor;
pub mod rotor;
pub mod s1;
pub mod s3;
mod sampled;
mod scalar;
mod slopes;
pub mod so3;
mod split;
mod state;
mod store;
mod system;
pub mod trig;
#[cfg(feature = "wide")]
pub mod wide;

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
pub use sampled::Sampled;
pub use scalar::Scalar;
pub use slopes::{
    Directions, Sparsity, Stepped, Tangent, TangentStep, TangentSystem, step_slopes,
    step_slopes_into,
};
pub use split::Split;
pub use state::State;
pub use store::{Store, Table};
pub use system::{Block, System};
