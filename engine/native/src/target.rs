//! What code is written for: how many numbers stand side by side, and the numbers that it reads.

use cranelift_codegen::ir::{MemFlags, Type, types};
use hamel::trig;
use std::collections::HashMap;

/// How code is written.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Whether a b + c is one instruction.
    pub fused: bool,
    /// Whether there are two lanes.
    pub paired: bool,
    /// Whether Cranelift looks at what it is given before it makes code of it.
    pub verified: bool,
}

impl Target {
    /// How many numbers stand side by side.
    pub fn lanes(self) -> usize {
        if self.paired { 2 } else { 1 }
    }

    /// The type of a value.
    pub fn number(self) -> Type {
        if self.paired {
            types::F64X2
        } else {
            types::F64
        }
    }

    /// Pairs stand at even places of lists, which need not be those of whole registers.
    pub fn flags(self) -> MemFlags {
        if self.paired {
            MemFlags::new().with_notrap()
        } else {
            MemFlags::trusted()
        }
    }

    /// How far an entry is from the first.
    pub fn bytes(self, place: usize) -> i32 {
        i32::try_from(8 * self.lanes() * place).unwrap_or(i32::MAX)
    }
}

/// Numbers that code reads from memory, behind the constants.
#[derive(Debug, Default)]
pub struct Pool {
    /// Where they begin.
    pub start: usize,
    /// The numbers.
    pub numbers: Vec<f64>,
    places: HashMap<u64, usize>,
    turned: Option<usize>,
}

impl Pool {
    /// Numbers that begin behind so many constants.
    pub fn behind(start: usize) -> Self {
        Pool {
            start,
            ..Pool::default()
        }
    }

    /// The place of a number among constants and numbers.
    pub fn place(&mut self, number: f64) -> usize {
        let (start, numbers) = (self.start, &mut self.numbers);
        *self.places.entry(number.to_bits()).or_insert_with(|| {
            numbers.push(number);
            start + numbers.len() - 1
        })
    }

    /// Where the rows of quarter turns begin.
    pub fn turned(&mut self) -> usize {
        let (start, numbers) = (self.start, &mut self.numbers);
        *self.turned.get_or_insert_with(|| {
            let place = start + numbers.len();
            numbers.extend(trig::TURNED.iter().flatten());
            place
        })
    }
}
