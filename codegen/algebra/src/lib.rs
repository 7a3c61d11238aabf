//! Exact computer algebra: expressions with values in prime fields, derivations, polynomials with normal forms.
//!
#![doc = include_str!("../README.md")]

pub mod bend;
pub mod blocks;
pub mod closest;
pub mod degree;
pub mod dense;
pub mod derivation;
pub mod double;
pub mod dual;
pub mod echelon;
pub mod external;
mod fold;
pub mod fp;
pub mod function;
pub mod graph;
pub mod interval;
pub mod jets;
mod jumps;
pub mod lane;
pub mod linear;
pub mod newton;
pub mod node;
pub mod numbers;
pub mod numeric;
pub mod poly;
pub mod prime;
pub mod reals;
pub mod resubstitute;
pub mod roots;
pub mod rounding;
mod shadow;
pub mod sizes;
pub mod slopes;
pub mod tangent;
pub mod tape;
pub mod text;
pub mod topoly;
pub mod transplant;
pub mod walk;
