//! Methods against exact solutions; a module alone: `cargo test -p hamel --test suite wide::`.

mod accuracy;
mod adapter;
mod adaptive;
#[cfg(feature = "std")]
mod blocks;
mod bodies;
mod clock;
mod common;
#[cfg(feature = "std")]
mod events;
mod explicit;
mod extremes;
mod free_rotation;
#[cfg(feature = "macros")]
mod implicit;
#[cfg(feature = "std")]
mod invariants;
mod lanes;
#[path = "common/oscillator.rs"]
mod oscillator;
mod rotations;
mod rotor_slopes;
mod run;
#[path = "../../../codegen/tests/suite/common/size.rs"]
mod size;
mod stiff;
#[cfg(feature = "macros")]
mod stiff_euler;
mod tableaux;
mod trigonometry;
#[cfg(feature = "wide")]
mod wide;
mod zero_order_hold;
