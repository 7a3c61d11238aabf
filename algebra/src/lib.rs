//! Computer algebra without mechanics: a hash-consed graph whose nodes carry values modulo
//! two primes at points of the constraint variety, derivations tangent to that variety, and
//! polynomials with normal forms for the small pieces that people read.
//!
//! Expressions that are equal on the variety are one node. On the unit circle that is
//! cos² + sin² = 1, without any rule that says so:
//!
//! ```
//! use hamel_algebra::fp::Random;
//! use hamel_algebra::graph::Graph;
//! use hamel_algebra::lane::circle_point;
//!
//! const COORDINATE: u8 = 1;
//! let mut graph = Graph::new(7, 0);
//! let (cos, sin) = circle_point(&mut Random::new(11));
//! let c = graph.symbol("c", COORDINATE, cos);
//! let s = graph.symbol("s", COORDINATE, sin);
//! let (cc, ss) = (graph.mul(c, c), graph.mul(s, s));
//! assert_eq!(graph.add(cc, ss), graph.one());
//! assert_eq!(graph.sub(graph.one(), ss), cc);
//! ```

pub mod bend;
pub mod blocks;
pub mod degree;
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
pub mod node;
pub mod numbers;
pub mod numeric;
pub mod poly;
pub mod prime;
pub mod reals;
pub mod resubstitute;
mod roots;
pub mod rounding;
mod shadow;
pub mod slopes;
pub mod tangent;
pub mod tape;
#[cfg(test)]
mod tests;
pub mod text;
pub mod topoly;
pub mod transplant;
pub mod walk;
