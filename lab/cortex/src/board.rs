//! The controller on a board: measures the instructions of every iteration by the system timer, and the depth of the
//! stack.
//!
//! Numbers are written by semihosting as hexadecimal digits of their bits, so that nothing is rounded, and the program
//! contains no formatting of floating-point numbers, which can panic.

#![allow(
    unsafe_code,
    reason = "the stack is read where it has been, and its ends are symbols of the linker"
)]

use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::STACK_PAINT_VALUE;
use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS, exit};
use cortex_m_semihosting::hio::{HostStream, hstdout};
use hamel::{Scalar, StepError};
use panic_halt as _;

use crate::control::{ITERATIONS, Regulator};

/// Value from which the timer counts down: 24 bits.
const RELOAD: u32 = 0x00FF_FFFF;
/// Turns of the loop for the calibration of the timer.
const TURNS: u32 = 400_000;

unsafe extern "C" {
    /// The lowest address of the stack, and the address above the highest.
    static _stack_end: u32;
    static _stack_start: u32;
}

/// Writes words and numbers to the host, and records failures.
struct Lines {
    stream: HostStream,
    complete: bool,
}

impl Lines {
    fn write(&mut self, bytes: &[u8]) {
        self.complete &= self.stream.write_all(bytes).is_ok();
    }

    /// Writes a name and the bits of numbers.
    fn line<const N: usize>(&mut self, name: &str, numbers: [u64; N]) {
        self.write(name.as_bytes());
        for number in numbers {
            let mut digits = [b' '; 17];
            for (k, digit) in digits.iter_mut().skip(1).enumerate() {
                let four = (number >> (60 - 4 * k)) as u8 & 15;
                *digit = if four < 10 {
                    b'0' + four
                } else {
                    b'a' - 10 + four
                };
            }
            self.write(&digits);
        }
        self.write(b"\n");
    }
}

/// Returns the ticks of the timer during some work.
fn ticks<T>(work: impl FnOnce() -> T) -> (T, u64) {
    let before = SYST::get_current();
    let result = work();
    let after = SYST::get_current();
    (result, u64::from(before.wrapping_sub(after) & RELOAD))
}

/// Returns the number of bytes of the stack written since the reset, and its size.
fn stack() -> [u64; 2] {
    let (end, start) = (&raw const _stack_end, &raw const _stack_start);
    let room = (start as usize).wrapping_sub(end as usize);
    let mut place = end;
    // SAFETY: all words between the two symbols are memory of the stack, which `cortex-m-rt` has painted before `main`.
    // The words read are below the part in use, except perhaps for the last one; only its value is compared.
    while place < start && unsafe { place.read_volatile() } == STACK_PAINT_VALUE {
        place = place.wrapping_add(1);
    }
    let used = (start as usize).wrapping_sub(place as usize);
    [used as u64, room as u64]
}

/// Plans, and writes the cost.
fn plan<S: Scalar>(lines: &mut Lines) -> Result<(), StepError> {
    let mut regulator = Regulator::<S>::tilted();
    regulator.hover()?;
    let bits = |cost: S| cost.largest_lane().to_bits();
    lines.line("start", [bits(regulator.cost())]);
    for _ in 0..ITERATIONS {
        let (result, ticks) = ticks(|| regulator.improve());
        result?;
        lines.line("iteration", [bits(regulator.cost()), ticks]);
    }
    Ok(())
}

/// Runs the program, and ends by leaving QEMU.
pub fn main<S: Scalar>() -> ! {
    let done = match (Peripherals::take(), hstdout()) {
        (Some(mut board), Ok(stream)) => {
            let timer = &mut board.SYST;
            timer.set_clock_source(SystClkSource::Core);
            timer.set_reload(RELOAD);
            timer.clear_current();
            timer.enable_counter();
            let mut lines = Lines {
                stream,
                complete: true,
            };
            // The loop has two instructions a turn, and one more turn than requested.
            let ((), tried) = ticks(|| cortex_m::asm::delay(TURNS - 1));
            lines.line("loop", [2 * u64::from(TURNS), tried]);
            let planned = plan::<S>(&mut lines);
            lines.line("stack", stack());
            lines.complete && planned.is_ok()
        }
        _ => false,
    };
    exit(if done { EXIT_SUCCESS } else { EXIT_FAILURE });
    loop {
        cortex_m::asm::wfi();
    }
}
