//! Laws of polynomials, of ideals of them and of their points, one module for each file.

mod elimination;
mod factor;
mod field;
mod jacobian;
mod monomial;
mod normal_form;
mod oracle;
mod order;
mod polynomial;
mod solve;
mod univariate;
