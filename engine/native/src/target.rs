//! The target of code: its lanes, and the numbers that it reads.

use cranelift_codegen::ir::{MemFlags, Type, types};
use hamel::trig;
use std::collections::HashMap;

/// The options of code generation.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Whether a b + c is one instruction.
    pub fused: bool,
    /// Whether code has two lanes.
    pub paired: bool,
    /// Whether Cranelift verifies its input before it compiles it.
    pub verified: bool,
}

impl Target {
    /// Returns the number of lanes.
    pub fn lanes(self) -> usize {
        if self.paired { 2 } else { 1 }
    }

    /// Returns the type of a value.
    pub fn number(self) -> Type {
        if self.paired {
            types::F64X2
        } else {
            types::F64
        }
    }

    /// Returns the flags of memory accesses. Pairs are at even indices of lists, which need not be aligned to whole
    /// registers.
    pub fn flags(self) -> MemFlags {
        if self.paired {
            MemFlags::new().with_notrap()
        } else {
            MemFlags::trusted()
        }
    }

    /// Returns the offset of an entry in bytes.
    pub fn bytes(self, place: usize) -> i32 {
        i32::try_from(8 * self.lanes() * place).unwrap_or(i32::MAX)
    }
}

/// Numbers that code reads from memory, after the constants.
#[derive(Debug, Default)]
pub struct Pool {
    /// The index of the first one.
    pub start: usize,
    /// The numbers.
    pub numbers: Vec<f64>,
    places: HashMap<u64, usize>,
    turned: Option<usize>,
}

impl Pool {
    /// Creates an empty pool after `start` constants.
    pub fn behind(start: usize) -> Self {
        Pool {
            start,
            ..Pool::default()
        }
    }

    /// Returns the index of a number, counted from the first constant; adds it if it is new.
    pub fn place(&mut self, number: f64) -> usize {
        let (start, numbers) = (self.start, &mut self.numbers);
        *self.places.entry(number.to_bits()).or_insert_with(|| {
            numbers.push(number);
            start + numbers.len() - 1
        })
    }

    /// Returns the index of the rows of quarter turns.
    pub fn turned(&mut self) -> usize {
        let (start, numbers) = (self.start, &mut self.numbers);
        *self.turned.get_or_insert_with(|| {
            let place = start + numbers.len();
            numbers.extend(trig::TURNED.iter().flatten());
            place
        })
    }
}
