//! The generator in a browser: sessions of the command line, with requests from JavaScript in JSON.
//!
//! | file | owns |
//! |---|---|
//! | `exports` | functions exported to JavaScript, which exchange text through memory |
//! | `requests` | requests and their answers |
//! | `scenes` | scenes of a run, to be drawn |
//! | `described` | JSON of an open description: names, the start, errors and warnings with their places |

mod described;
mod exports;
mod requests;
mod scenes;

pub use requests::answer;
