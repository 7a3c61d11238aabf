//! Exact computer algebra: expressions with values in prime fields, derivations, polynomials with normal forms.
//!
#![doc = include_str!("../README.md")]

pub mod blocks;
mod continuity;
pub mod degree;
pub mod dense;
pub mod derivation;
pub mod double;
pub mod dual;
pub mod echelon;
pub mod external;
pub mod field_point;
mod fold;
pub mod function;
pub mod graph;
pub mod interval;
pub mod jets;
pub mod least_norm_newton;
pub mod linear;
pub mod nearest_solution;
pub mod newton;
pub mod node;
pub mod numbers;
pub mod numeric;
pub mod poly;
pub mod prime;
mod real_enclosure;
pub mod reals;
pub mod residual_scale;
pub mod residue_pair;
pub mod resubstitute;
pub mod roots;
pub mod rounding;
pub mod second_derivative;
pub mod slopes;
pub mod tangent;
pub mod tape;
pub mod text;
pub mod topoly;
pub mod transplant;
pub mod walk;
