//! Generated C, compiled and compared with the interpreter: `tests/attack.rs`; the example: `tests/example.rs`.
