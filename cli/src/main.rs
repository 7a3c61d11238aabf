//! `hamel`: equations of motion from a description, on the command line.

use std::panic::resume_unwind;
use std::process::ExitCode;

/// Stack size in bytes, sufficient for the deepest nesting allowed. Windows gives the main thread 1 MB.
const STACK_BYTES: usize = 8 << 20;

fn main() -> ExitCode {
    let command = || hamel_cli::command(std::env::args_os());
    let deep = std::thread::Builder::new().stack_size(STACK_BYTES);
    ExitCode::from(match deep.spawn(command) {
        Ok(thread) => thread.join().unwrap_or_else(|panic| resume_unwind(panic)),
        Err(_) => command(),
    })
}
