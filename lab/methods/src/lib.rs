//! The report of speed against error.
//!
//! This command writes it, from the root of the repository:
//!
//! ```sh
//! cargo run --release --manifest-path lab/Cargo.toml -p hamel-bench -- --out docs/report
//! ```
//!
//! | module | owns |
//! |---|---|
//! | [`methods`] | the table of methods: one line each |
//! | [`cases`] | the hard cases of `hamel-cases`, and the constants of motion of each |
//! | [`peers`] | other programs, each an optional feature or script |
//! | [`runner`] | the measurements of a case |
//! | [`output`] | the files, and the part of them that is kept in the repository |

pub mod cases;
pub mod methods;
pub mod output;
pub mod peers;
pub mod pictures;
pub mod runner;
