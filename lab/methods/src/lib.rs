//! The report of speed against error.
//!
//! One command makes it again, from the root of the repository:
//!
//! ```sh
//! cargo run --release --manifest-path lab/Cargo.toml -p hamel-bench -- --out docs/report
//! ```
//!
//! | module | owns |
//! |---|---|
//! | [`methods`] | the table of methods: one line each |
//! | [`cases`] | the hard cases of `hamel-cases`, and what is constant in each |
//! | [`peers`] | other programs, each an optional feature or script |
//! | [`runner`] | what is measured of a case |
//! | [`output`] | the files, and what is kept of them in the repository |

pub mod cases;
pub mod methods;
pub mod output;
pub mod peers;
pub mod pictures;
pub mod runner;
