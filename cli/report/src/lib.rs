//! Speed against error: the cost of a method on a system, and its final error.
//!
#![doc = include_str!("../README.md")]
//!
//! # Modules
//!
//! | module | owns |
//! |---|---|
//! | [`auto`] | how good the chosen method is |
//! | `tolerance_table` | runs by error control as a table |
//! | [`counted_system`] | a system that counts the evaluations of its forces |
//! | [`problem`] | a system with its start, its error and its constants of motion |
//! | [`entry`] | a method on a problem, in equal steps or by error control |
//! | [`measure`] | the loop: errors and drifts once, times interleaved and as medians |
//! | [`drift`] | one long run of one method |
//! | [`solution`] | reference solutions as files |
//! | [`data`] | the results, in the form of the JSON file |
//! | [`work`] | work to reach an error, between the runs measured |
//! | [`markdown`], [`json`], [`page`], [`book_excerpt`] | the output for people and programs |
//! | `code_markup` | code between backticks, in pages and pictures |
//! | [`summary`] | the runs behind the excerpt |
//! | [`plot`] | pictures as SVG |
//!
//! Pictures are drawn by `plotters` (MIT), with only its SVG backend, which provides axes, ticks and logarithmic
//! scales. It is in wide use, needs no fonts on the machine (text is measured by its length), and its output is
//! deterministic. It supports only whole pixels and fixed colours, so [`plot`] draws ten times as large and gives the
//! colours of a dark page by a style sheet. HTML is written by `maud` (MIT or Apache-2.0), which escapes all inserted
//! text.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `pictures` | pictures, and the pages that show them |

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod auto;
pub mod book_excerpt;
#[cfg(feature = "pictures")]
mod code_markup;
pub mod counted_system;
pub mod data;
pub mod drift;
pub mod entry;
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
mod tolerance_table;
pub mod work;

use hamel_files::number;
