//! The generator in a browser: the session of the command line, which JavaScript asks in JSON.
//!
//! | file | owns |
//! |---|---|
//! | `exports` | what JavaScript calls: a text goes in through memory, a text comes out |
//! | `requests` | what can be asked, and the answers |
//! | `scenes` | what is drawn of a run |
//! | `described` | a description that was read: names, the start, errors and warnings with their places |

mod described;
mod exports;
mod requests;
mod scenes;

pub use requests::answer;
