//! Machine code compared with tapes and graphs. To run a single module:
//! `cargo test -p hamel-native --test suite random::`.

mod float;
mod models;
mod random;
#[path = "../../../../codegen/tests/suite/common/size.rs"]
mod size;
#[path = "../../../../codegen/tests/suite/common/thinning.rs"]
mod thinning;
