//! The symbols of the formalism, one file each, and the cheapest way to ξ̇.
//!
//! | file | object | KR18 |
//! |---|---|---|
//! | `calculus` | ∂ᵢ, d/dt along ẋ = A ξ, frame Jacobians | (9) |
//! | `kinematics` | Y, chart rates | (5) |
//! | `complement` | Φ and Ψ | (5), (6) |
//! | `correction` | the stabilising term −Ψ φ | (8) |
//! | `commutation` | Hamel coefficients γ | (12), (13) |
//! | `inertia` | mass matrix M | (20) |
//! | `connection` | connection coefficients Γ | (23) |
//! | `loads` | potential, gravity, applied forces | (28) |
//! | `virtual_power` | loads as forces on points, motion of points | (28) |
//! | `hamel_form` | equations of Lagrange and Hamel, from T and γ | (30a) |
//! | `gibbs` | equations of Gibbs and Appell, from accelerations | (30b) |
//! | `levi_civita` | explicit equations, from M and Γ | (30c) |
//! | `forms` | all symbols side by side, to be compared | (30) |
//! | `numbers` | the three forms at points modulo p: what every build is compared with | (30) |
//! | `energy` | T, V, momentum | |
//! | `momentum` | ṗ, and ξ from p | (30a) |
//! | `linearize` | the linearisation, in displacement coordinates | (12) |
//! | `invariants` | claims of constancy along the motion, proved or refuted | |
//! | `accel` | ξ̇ by the cheapest of several routes | (30) |
//! | `tree` | links and joints: inverse dynamics, M, ξ̇ and slopes by recursion | |
//! | `adviser` | other velocity coordinates for the same motion, and their cost | |
//! | `assemble` | the program of all generated functions | |
//! | `further` | momenta, the linearisation and invariants as functions | |
//! | `structure` | whether a system splits into free motion and kicks; which method fits | |
//! | `confidence` | what equality at random points says | |
//! | `check` | the identities that any derivation has to satisfy | (6), (12), (13), (21) |
//! | `motion` | those of the equations of motion | (20), (28), (30) |
//! | `geometry` | integrability, Lie algebras, patterns, symmetries | 2.5 |

pub mod accel;
pub mod adviser;
pub(crate) mod assemble;
pub mod calculus;
mod candidates;
pub mod care;
pub mod check;
pub(crate) mod commutation;
pub(crate) mod complement;
pub mod confidence;
pub(crate) mod connection;
pub(crate) mod constrained;
pub mod correction;
pub(crate) mod energy;
pub mod forms;
mod further;
pub mod geometry;
pub(crate) mod gibbs;
pub(crate) mod hamel_form;
pub mod inertia;
pub(crate) mod invariants;
mod kernel;
pub mod kinematics;
pub mod levi_civita;
pub(crate) mod linearize;
pub(crate) mod loads;
pub(crate) mod momentum;
pub(crate) mod motion;
pub(crate) mod multipliers;
pub(crate) mod normal;
mod numbers;
mod reactions;
pub(crate) mod reduction;
mod reference;
mod slopes;
pub mod structure;
pub mod tables;
pub(crate) mod tree;
pub mod validate;
pub(crate) mod virtual_power;
