//! Builds the book from `docs/book`: runs the commands of its pages, inserts their output, and writes the parts of the
//! reference that are derived from the code.
//!
//! | file | owns |
//! |---|---|
//! | `page` | the blocks and directives of a page |
//! | `shell` | the folder in which the commands of a page run |
//! | `lists` | the functions and options, taken from the code |
//! | `errors` | the errors of the generator, with descriptions that cause them |
//! | `rare` | the errors without an example |
//! | `build` | all pages, into a folder that mdBook reads |
//! | `gallery` | the mechanisms of `examples/gallery`, each with its picture, counts and a remark |
//! | `html` | the links of the pages that mdBook has made |

pub mod build;
pub mod errors;
pub mod gallery;
pub mod html;
pub mod lists;
pub mod page;
pub mod rare;
pub mod shell;

/// The pages that contain programs in Rust: each program is compiled and run; build scripts are only compiled.
#[cfg(doctest)]
mod programs {
    #[doc = include_str!("../../../README.md")]
    struct Readme;
    #[doc = include_str!("../../book/src/ensembles.md")]
    struct Ensembles;
    #[doc = include_str!("../../book/src/front-ends.md")]
    struct FrontEnds;
    #[doc = include_str!("../../book/src/robots.md")]
    struct Robots;
}
