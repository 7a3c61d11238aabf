//! Compiles generated C and compares it with the interpreter: `tests/attack.rs`.
