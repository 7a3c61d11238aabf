//! Laws of the graph, of its numbers and of polynomials, one module for each file of `src`. To run a single module:
//! `cargo test -p hamel-algebra --test suite poly::`.

mod blocks;
mod common;
mod continuity;
mod degree;
mod dense;
mod double;
mod echelon;
mod external;
mod field_point;
mod graph;
mod interval;
mod jets;
mod nearest_solution;
mod poly;
mod prime;
mod reals;
mod residual_scale;
mod residue_pair;
mod resubstitute;
mod roots;
mod rounding;
mod second_derivative;
mod slopes;
mod tangent;
mod text;
mod topoly;
