//! Builds the book from `docs/book`: runs the commands that its pages show and puts in what they print, and writes the
//! parts of the reference that follow from the code.
//!
//! | file | owns |
//! |---|---|
//! | `page` | the blocks and directives of a page |
//! | `shell` | the folder in which the commands of a page run |
//! | `lists` | the functions and options, as the code has them |
//! | `errors` | the errors of the generator, with descriptions that have them |
//! | `rare` | the errors that no example has |
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

/// The pages that have programs in Rust: each is compiled and run, but for build scripts, which are compiled.
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
