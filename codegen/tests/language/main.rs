//! Laws of the language, one module for each file of `src`. To run a single module:
//! `cargo test -p hamel-codegen-tests --test language syntax::`.

mod axes;
mod chart_difference;
mod charts;
mod dimensions;
mod functions;
mod nearest;
mod number;
mod random_dimensions;
mod shapes;
mod suggest;
mod syntax;
mod unused;
mod written;
