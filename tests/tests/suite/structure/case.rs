//! Every model of the tests, interpreted at random points.

use crate::derived::{self, Derived};
use hamel_codegen::generate::Generated;
use hamel_codegen::model::layout::{Block, blocks};
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::structure::Splitting;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// A model whose functions are interpreted at the default parameters.
pub struct Case {
    pub name: String,
    pub generated: &'static Generated,
    pub seed: u64,
}

/// Returns all models, in order.
pub fn cases() -> impl Iterator<Item = Case> {
    let case = |model: &'static Derived| Case {
        name: model.name.clone(),
        generated: model.generated(),
        seed: 1,
    };
    derived::models().iter().map(case)
}

impl Case {
    pub fn interpreter(&self, name: &str) -> Option<Interpreter> {
        let program = &self.generated.program;
        let function = program.function(name)?;
        Some(Interpreter::new(program, function, &program.defaults))
    }

    /// Evaluates a function of x, ξ, u and p.
    pub fn call(&self, name: &str, x: &[f64], xi: &[f64], u: &[f64], p: &[f64]) -> DVector<f64> {
        let interpreter = self.interpreter(name);
        let interpreter = interpreter.unwrap_or_else(|| panic!("{}: no {name}", self.name));
        let value = interpreter.call_with([x, xi, u, &[], p]);
        DVector::from_vec(value.unwrap_or_else(|pivot| panic!("{}: pivot {pivot}", self.name)))
    }

    /// Returns y of x if plain coordinates are shifted, otherwise x.
    pub fn moved(&self, name: &str, x: &[f64]) -> DVector<f64> {
        match self.interpreter(name) {
            Some(_) => self.call(name, x, &[], &[], &[]),
            None => DVector::from_column_slice(x),
        }
    }

    /// Returns a number in ±1 (SplitMix64).
    pub fn number(&mut self) -> f64 {
        self.seed = self.seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn numbers(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.number()).collect()
    }

    /// Returns a point of one block.
    pub fn point(&mut self, block: Block) -> Vec<f64> {
        let quaternion = |numbers: Vec<f64>| -> [f64; 4] {
            let norm = numbers.iter().map(|q| q * q).sum::<f64>().sqrt();
            std::array::from_fn(|i| numbers[i] / norm)
        };
        match block {
            // Away from the poles of angles and the zeros of radii.
            Block::Flat(n) => (0..n).map(|_| 1.2 + 0.4 * self.number()).collect(),
            Block::Circle => hamel::s1::exp(3.0 * self.number()).to_vec(),
            Block::Quaternion => quaternion(self.numbers(4)).to_vec(),
            Block::Rotation => hamel::s3::to_matrix(quaternion(self.numbers(4))).to_vec(),
        }
    }

    /// Returns a point of X; the start if coordinates are constrained.
    pub fn x(&mut self) -> Vec<f64> {
        let model = &self.generated.model;
        if !model.points.constraints.is_empty() || !model.constraints.is_empty() {
            return self.generated.program.start_x.clone();
        }
        let all = self.generated.program.blocks.clone();
        all.into_iter()
            .flat_map(|block| self.point(block))
            .collect()
    }

    /// Returns the names of the blocks, with their ranges in x and among the rates.
    pub fn parts(&self) -> Vec<(String, Block, Range<usize>, Range<usize>)> {
        let (mut place, mut rate) = (0, 0);
        let mut parts = Vec::new();
        for coordinate in &self.generated.program.coordinates {
            let kinds = blocks(coordinate.kind);
            for (index, &block) in kinds.iter().enumerate() {
                let suffix = match (kinds.len(), index) {
                    (1, _) => "",
                    (_, 0) => ".p",
                    _ => ".R",
                };
                let name = format!("{}{suffix}", coordinate.name);
                let (len, dimension) = (block.len(), block.dimension());
                parts.push((name, block, place..place + len, rate..rate + dimension));
                place += len;
                rate += dimension;
            }
        }
        parts
    }

    /// Returns M in the rates of the coordinates, N⁻ᵀ M N⁻¹, where the columns of N are the rates of unit ξ.
    pub fn inertia(&self, x: &[f64]) -> DMatrix<f64> {
        let n = self.generated.program.n;
        let columns: Vec<DVector<f64>> = (0..n)
            .map(|i| {
                let unit: Vec<f64> = (0..n).map(|j| f64::from(u8::from(i == j))).collect();
                self.call("chart_rate", x, &unit, &[], &[])
            })
            .collect();
        let inverse = DMatrix::from_columns(&columns)
            .try_inverse()
            .expect("rates");
        let mass = self.call("mass_matrix", x, &[], &[], &[]);
        let mass = DMatrix::from_row_slice(n, n, mass.as_slice());
        inverse.transpose() * mass * inverse
    }

    /// Returns J of every rotor.
    pub fn rotors(&self, splitting: &Splitting) -> Vec<DMatrix<f64>> {
        if splitting.rotors.is_empty() {
            return Vec::new();
        }
        let numbers = self.call("rotor_inertia", &[], &[], &[], &[]);
        let mut place = 0;
        let all = splitting.rotors.iter().map(|rotor| {
            let entries = rotor.inertia.entries();
            let own = &numbers.as_slice()[place..place + entries];
            place += entries;
            match entries {
                3 => DMatrix::from_diagonal(&DVector::from_column_slice(own)),
                _ => DMatrix::from_row_slice(3, 3, own),
            }
        });
        all.collect()
    }
}
