//! Laws of the graph, of its numbers and of polynomials, one module for each file of `src`. To run a single module:
//! `cargo test -p hamel-algebra --test suite poly::`.

mod bend;
mod blocks;
mod closest;
mod common;
mod degree;
mod dense;
mod double;
mod echelon;
mod external;
mod fp;
mod graph;
mod interval;
mod jets;
mod jumps;
mod lane;
mod poly;
mod prime;
mod reals;
mod resubstitute;
mod roots;
mod rounding;
mod sizes;
mod slopes;
mod tangent;
mod text;
mod topoly;
