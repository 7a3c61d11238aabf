//! Compares the output of a board with the same controller on this machine, and with bounds.
//!
//! `report NAME single|double INSTRUCTIONS BYTES < OUTPUT`, with the greatest numbers of instructions of an iteration
//! and of bytes of the stack. The exit status is 1 if a check fails.

use std::io::Read;
use std::process::ExitCode;

use hamel::{Scalar, StepError};
use hamel_cortex::control::{ITERATIONS, NODES, Regulator};

/// Instructions per tick of the boards' timer: with `-icount shift=0`, QEMU executes one instruction a nanosecond, and
/// the clock of its MPS2 boards has 25 MHz.
const TICK: u64 = 40;
/// Largest relative difference of costs between two machines, in `f64` and in `f32`.
const CLOSE: [f64; 2] = [1e-12, 1e-5];

/// Returns the initial cost of the plan, and its cost after each iteration.
fn costs<S: Scalar>() -> Result<Vec<f64>, StepError> {
    let mut regulator = Regulator::<S>::tilted();
    regulator.hover()?;
    let mut costs = vec![regulator.cost().largest_lane()];
    for _ in 0..ITERATIONS {
        regulator.improve()?;
        costs.push(regulator.cost().largest_lane());
    }
    Ok(costs)
}

/// The output of a board.
#[derive(Debug, Default)]
struct Said {
    costs: Vec<f64>,
    instructions: Vec<u64>,
    /// Instructions of a loop: computed, and measured by the timer.
    tried: [u64; 2],
    /// Used bytes of the stack, and its size.
    stack: [u64; 2],
}

/// Parses the lines of a board: a word, and the bits of numbers.
fn read(text: &str) -> Option<Said> {
    let mut said = Said::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let name = words.next()?;
        let numbers: Result<Vec<_>, _> = words.map(|word| u64::from_str_radix(word, 16)).collect();
        match (name, numbers.ok()?.as_slice()) {
            ("loop", [expected, ticks]) => said.tried = [*expected, TICK * ticks],
            ("start", [cost]) => said.costs.push(f64::from_bits(*cost)),
            ("iteration", [cost, ticks]) => {
                said.costs.push(f64::from_bits(*cost));
                said.instructions.push(TICK * ticks);
            }
            ("stack", [used, room]) => said.stack = [*used, *room],
            _ => return None,
        }
    }
    Some(said)
}

fn checked(arguments: &[String]) -> Result<String, String> {
    let [name, kind, instructions, bytes] = arguments else {
        return Err("report NAME single|double INSTRUCTIONS BYTES".into());
    };
    let bound = |text: &String| text.parse::<u64>().map_err(|_| format!("{text}: a number"));
    let (most_instructions, most_bytes) = (bound(instructions)?, bound(bytes)?);
    let (here, close) = match kind.as_str() {
        "single" => (costs::<f32>(), CLOSE[1]),
        "double" => (costs::<f64>(), CLOSE[0]),
        other => return Err(format!("{other}: single or double")),
    };
    let here = here.map_err(|error| format!("here: {error}"))?;
    let mut text = String::new();
    let read_all = std::io::stdin().read_to_string(&mut text);
    read_all.map_err(|error| error.to_string())?;
    let said = read(&text)
        .filter(|said| said.instructions.len() == ITERATIONS && said.costs.len() == here.len())
        .ok_or_else(|| format!("{name} did not come to an end:\n{text}"))?;

    let [expected, counted] = said.tried;
    if expected == 0 || counted.abs_diff(expected) > expected / 1000 {
        return Err(format!(
            "{name}: the timer counts {counted} of {expected} instructions"
        ));
    }
    let most = said.instructions.iter().max().copied().unwrap_or(u64::MAX);
    let last = said.instructions.last().copied().unwrap_or(u64::MAX);
    let apart = said.costs.iter().zip(&here);
    let apart = apart.fold(0.0_f64, |most, (board, here)| {
        // Not `max`, which ignores NaN.
        let apart = (board - here).abs() / here.abs();
        if apart > most || apart.is_nan() {
            apart
        } else {
            most
        }
    });
    let (first, end) = (said.costs[0], said.costs[ITERATIONS]);
    let [used, room] = said.stack;
    let text = format!(
        "{name}: {most} instructions an iteration at most, {last} the last, over {NODES} nodes; {used} bytes of stack; \
         cost {first:.4} to {end:.12} in {ITERATIONS} iterations, {apart:.1e} from here"
    );
    let falls = said.costs.windows(2).all(|pair| pair[1] < pair[0]);
    let failures = [
        (!falls || end > 0.01 * first, "the cost does not fall"),
        (
            apart.is_nan() || apart > close,
            "not the numbers of this machine",
        ),
        (most > most_instructions, "too many instructions"),
        (used > most_bytes || used == room, "too much of the stack"),
    ];
    let failed: Vec<_> = failures.iter().filter(|(failed, _)| *failed).collect();
    match failed.as_slice() {
        [] => Ok(text),
        all => Err(all.iter().fold(text, |text, (_, why)| text + "\n  " + why)),
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match checked(&arguments) {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(text) => {
            eprintln!("{text}");
            ExitCode::FAILURE
        }
    }
}
