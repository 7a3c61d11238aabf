//! Polynomials over a field and ideals of them: the algebra of the constraint variety.
//!
//! | file | object |
//! |---|---|
//! | `field` | coefficients: Q and F_p |
//! | `monomial`, `order` | monomials x^a and their orders |
//! | `polynomial`, `evaluation` | Σ c_a x^a, its values, derivatives and substitutions |
//! | `normal_form`, `sums`, `buchberger` | remainder by a basis, sums of sorted terms, reduced Gröbner basis |
//! | `ideals` | generators of circle, S³, SO(3) |
//! | `elimination` | minimal polynomial of a variable modulo an ideal |
//! | `jacobian` | variables that a system leaves free |
//! | `univariate`, `solve` | roots in F_p, a random F_p point of a variety |
//! | `factor` | a cheap straight-line program for several polynomials |

pub mod buchberger;
pub mod elimination;
mod evaluation;
pub mod factor;
pub mod field;
pub mod ideals;
pub mod jacobian;
pub mod monomial;
pub mod normal_form;
pub mod order;
pub mod polynomial;
pub mod solve;
mod sums;
pub mod univariate;
