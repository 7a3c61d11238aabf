//! Speed against error: what a method costs on a system, and how far it ends from the truth.
//!
#![doc = include_str!("../README.md")]
//!
//! # Modules
//!
//! | module | owns |
//! |---|---|
//! | [`auto`] | how good the chosen method is |
//! | `controlled` | runs by error control as a table |
//! | [`counted`] | a system that counts the evaluations of its forces |
//! | [`problem`] | one system with its start, its errors and what it conserves |
//! | [`entry`] | a method on a problem, in equal steps or by error control |
//! | [`measure`] | the loop: errors and drifts once, times interleaved and as medians |
//! | [`drift`] | one long run of one method |
//! | [`solution`] | reference solutions as files |
//! | [`data`] | the results, as they stand in JSON |
//! | [`work`] | work to reach an error, between the runs measured |
//! | [`markdown`], [`json`], [`page`], [`excerpt`] | what people and programs read |
//! | `code` | code between backticks, in pages and pictures |
//! | [`summary`] | the runs behind that part |
//! | [`plot`] | pictures as SVG |
//!
//! Pictures are drawn by `plotters` (MIT) with its SVG backend alone: axes, ticks and logarithmic
//! scales are its work. It is in wide use, needs no fonts on the machine (text is measured by its
//! length), and its text is deterministic. It knows whole pixels and fixed colours only; [`plot`]
//! draws ten times as large and gives the colours of a dark page by a style sheet. HTML is written by
//! `maud` (MIT or Apache-2.0), which escapes whatever is inserted.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `pictures` | pictures, and the pages that show them |

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod auto;
#[cfg(feature = "pictures")]
mod code;
mod controlled;
pub mod counted;
pub mod data;
pub mod drift;
pub mod entry;
pub mod excerpt;
pub mod json;
pub mod markdown;
pub mod measure;
#[cfg(feature = "pictures")]
pub mod page;
#[cfg(feature = "pictures")]
pub mod plot;
pub mod problem;
pub mod solution;
pub mod summary;
pub mod work;

use hamel_files::number;
