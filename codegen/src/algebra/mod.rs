//! Computer algebra without mechanics: a hash-consed graph whose nodes carry values modulo
//! two primes at points of the constraint variety, derivations tangent to that variety, and
//! polynomials with normal forms for the small pieces that people read.

pub mod bend;
pub mod blocks;
pub mod degree;
pub mod derivation;
pub mod double;
pub mod echelon;
mod fold;
pub mod fp;
pub mod graph;
pub mod interval;
pub mod jets;
pub mod lane;
pub mod linear;
pub mod node;
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
