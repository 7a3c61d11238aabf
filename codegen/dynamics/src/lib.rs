//! Quantities of the formalism, one file each, and the cheapest way to compute ξ̇.
//!
#![doc = include_str!("../README.md")]
//!
//! | file | contents | KR18 |
//! |---|---|---|
//! | `calculus` | ∂ᵢ, d/dt along ẋ = A ξ, frame Jacobians | (9) |
//! | `kinematics` | Y, chart rates | (5) |
//! | `complement` | Φ and Ψ | (5), (6) |
//! | `correction` | the stabilising term −Ψ φ | (8) |
//! | `commutation` | Hamel coefficients γ | (12), (13) |
//! | `inertia` | mass matrix M | (20) |
//! | `inertialess_motion` | advice on motions without inertia, for a singular M | |
//! | `connection` | connection coefficients Γ | (23) |
//! | `loads` | potential, gravity, applied forces | (28) |
//! | `energy` | T, V, momentum | |
//! | `momentum` | ṗ, and ξ from p | (30a) |
//! | `linearize` | the linearisation, in displacement coordinates | (12) |
//! | `centroidal` | centre of mass, centroidal momentum and its matrix | |
//! | `frames` | poses, twists, Jacobians and bias accelerations of frames | |
//! | `accel` | ξ̇ by the cheapest of several routes | (30) |
//! | `tree` | links and joints: inverse dynamics, M, ξ̇ and derivatives by recursion | |
//! | `regressor` | forces as linear functions of inertial parameters, and base parameters | |
//! | `adviser` | other velocity coordinates for the same motion, and their cost | |
//! | `program`, `assemble` | the program of all generated functions | |
//! | `multipliers`, `undetermined` | multipliers λ of constraints, and those that are not determined | |
//! | `quantity` | momenta and energies that are claimed to be constant | |
//! | `secondary_functions` | momenta, the linearisation and invariants as functions | |
//! | `structure` | whether a system splits into free motion and kicks; choice of the method | |
//! | `geometry` | integrability, Lie algebras, patterns, symmetries | 2.5 |

pub mod accel;
pub mod adviser;
pub mod assemble;
pub mod calculus;
mod candidates;
pub mod centroidal;
pub mod commutation;
pub mod complement;
pub mod connection;
pub mod correction;
mod derivatives;
pub mod energy;
mod frames;
pub mod geometry;
pub mod inertia;
mod inertialess_motion;
pub mod kinematics;
pub mod linearize;
pub mod loads;
pub mod momentum;
pub mod multipliers;
pub mod normal;
mod norms;
pub mod numerical_loss;
mod program;
pub mod quantity;
mod reactions;
pub mod reduction;
pub mod regressor;
mod secondary_functions;
pub mod structure;
pub mod tables;
// Public for tests, which compare the recursions with derivations that do not use trees.
#[doc(hidden)]
pub mod tree;
pub mod undetermined;
