//! Runtime of generated equations of motion.
//!
//! A generated type implements [`System`]: coordinates x, possibly redundant and of the kinds of
//! [`Block`], velocity coordinates ξ, and the equations ẋ = A(x) ξ, ξ̇ = M⁻¹(f − c). This crate moves
//! such systems in time on their manifold ([`integrate`](integrate()), [`methods`]) and watches what
//! they conserve ([`Monitor`]). It knows nothing of descriptions, does not allocate, and never panics;
//! what fails is a [`StepError`].
//!
//! Two modules carry the mathematics of rotations, [`so3`] and [`s3`]; numbers are any [`Scalar`].
//!
//! # Features
//! - `std` (default): mathematical functions of the standard library, in nalgebra, too, `Vec` as a [`Store`]. Without
//!   it the crate is `no_std` and takes them from `libm`.
//! - `macros` (default): `rigid_eom!`, which expands a description to a `System`.
//! - `wide`: SIMD lanes as scalars, in `wide`.
//! - `ensemble`: many states on lanes and threads, in `ensemble`.
//! - `nalgebra` (default): views of states as nalgebra types, in `edge`.
//!
//! # Example
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

#![cfg_attr(not(feature = "std"), no_std)]

pub mod adapter;
pub mod adaptive;
mod canonical;
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
pub use dual::Dual;
pub use error::{Singular, StepError};
#[cfg(feature = "macros")]
pub use hamel_macros::rigid_eom;
pub use integrate::{Grid, integrate, step};
pub use lanes::Lanes;
pub use methods::Method;
pub use monitor::Monitor;
#[cfg(feature = "nalgebra")]
pub use nalgebra;
pub use rotor::Rotor;
pub use sampled::Sampled;
pub use scalar::Scalar;
pub use slopes::{Directions, Nearby, Stepped, Tangent, TangentStep, step_nearby, step_slopes};
pub use split::Split;
pub use state::State;
pub use store::{Store, Table};
pub use system::{Block, System};
