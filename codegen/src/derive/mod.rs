//! The symbols of the formalism, one file each, and the cheapest way to ξ̇.
//!
//! | file | object | KR18 |
//! |---|---|---|
//! | `calculus` | ∂ᵢ, d/dt along ẋ = A ξ, frame Jacobians | (9) |
//! | `kinematics` | Y, chart rates, the stabilising term −Ψ φ | (5), (8) |
//! | `commutation` | Hamel coefficients γ | (12), (13) |
//! | `inertia` | mass matrix M | (20) |
//! | `connection` | connection coefficients Γ | (23) |
//! | `loads` | potential, gravity, applied forces | (28) |
//! | `virtual_work` | applied forces by virtual work, in world axes | (28) |
//! | `hamel_form` | equations of Lagrange and Hamel, from T and γ | (30a) |
//! | `gibbs` | equations of Gibbs and Appell, from accelerations | (30b) |
//! | `levi_civita` | explicit equations, from M and Γ | (30c) |
//! | `forms` | all symbols side by side, to be compared | (30) |
//! | `energy` | T, V, momentum | |
//! | `accel` | ξ̇ by the cheapest of several routes | (30) |
//! | `assemble` | the program of all generated functions | |
//! | `check` | the identities that any derivation has to satisfy | (6), (12), (13), (21) |
//! | `motion` | those of the equations of motion | (20), (28), (30) |
//! | `geometry` | integrability, Lie algebras, patterns, symmetries | 2.5 |

pub mod accel;
pub mod assemble;
pub mod calculus;
pub mod check;
pub mod commutation;
pub mod connection;
pub mod energy;
pub mod forms;
pub mod geometry;
pub mod gibbs;
pub mod hamel_form;
pub mod inertia;
pub mod kinematics;
pub mod levi_civita;
pub mod loads;
pub mod motion;
pub mod normal;
pub mod tables;
pub mod validate;
pub mod virtual_work;
