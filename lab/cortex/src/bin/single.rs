//! The controller in `f32`, for a board.

#![no_std]
#![no_main]

use cortex_m_rt::entry;

#[entry]
fn main() -> ! {
    hamel_cortex::board::main::<f32>()
}
