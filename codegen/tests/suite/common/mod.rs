//! Evaluates generated systems at random states.
#![allow(dead_code, unused_imports)] // each test file uses a part

use hamel_codegen::algebra::residue_pair;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::model::layout::Block;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::render::render;

/// A random generator with the same numbers on every machine.
#[derive(Clone)]
pub struct Random(residue_pair::Random);

impl Random {
    /// Creates the generator for a seed.
    pub fn new(seed: u64) -> Self {
        Random(residue_pair::Random::new(seed))
    }

    /// Returns the next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.bits()
    }

    /// Returns a number in ±1.
    pub fn number(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Returns numbers in ±1.
    pub fn numbers(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.number()).collect()
    }

    /// Returns a whole number below a bound.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// Returns a random point of every block of x.
    pub fn configuration(&mut self, blocks: &[Block]) -> Vec<f64> {
        let mut x = Vec::new();
        for block in blocks {
            match block {
                Block::Flat(n) => x.extend(self.numbers(*n)),
                Block::Circle => {
                    let (s, c) = (3.0 * self.number()).sin_cos();
                    x.extend([c, s]);
                }
                Block::Quaternion => x.extend(self.quaternion()),
                Block::Rotation => {
                    let [w, a, b, c] = self.quaternion();
                    x.extend([
                        1.0 - 2.0 * (b * b + c * c),
                        2.0 * (a * b - w * c),
                        2.0 * (a * c + w * b),
                        2.0 * (a * b + w * c),
                        1.0 - 2.0 * (a * a + c * c),
                        2.0 * (b * c - w * a),
                        2.0 * (a * c - w * b),
                        2.0 * (b * c + w * a),
                        1.0 - 2.0 * (a * a + b * b),
                    ]);
                }
            }
        }
        x
    }

    fn quaternion(&mut self) -> [f64; 4] {
        let q: [f64; 4] = std::array::from_fn(|_| self.number());
        let length = q.iter().map(|q| q * q).sum::<f64>().sqrt();
        q.map(|q| q / length)
    }
}

/// Generates a correct description.
pub fn generated(text: &str) -> Generated {
    from_text(text).unwrap_or_else(|errors| panic!("{}", render(&errors, "test", text, false)))
}

/// Evaluates a function at (x, ξ, u, ξ̇), with default parameters.
pub fn value(of: &Generated, name: &str, [x, xi, u, dot]: [&[f64]; 4]) -> Vec<f64> {
    let function = of.program.function(name).expect("it was asked for");
    let compiled = Interpreter::new(&of.program, function, &of.program.defaults);
    compiled
        .call_with([x, xi, u, dot, &[]])
        .unwrap_or_else(|guard| panic!("{name}: pivot {guard} is not positive"))
}

/// Returns the largest difference of two lists, relative to the largest entry of the first, if that exceeds 1.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = a.iter().fold(1.0, |most: f64, a| most.max(a.abs()));
    a.iter()
        .zip(b)
        .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs() / scale))
}

#[path = "size.rs"]
mod size;
pub use size::size;

/// Returns generated code without comments, which quote the description and its names.
pub fn without_comments(code: &str) -> String {
    let is_comment = |line: &&str| line.trim_start().split(' ').next() == Some("//");
    let lines: Vec<&str> = code.lines().filter(|line| !is_comment(line)).collect();
    lines.join("\n")
}

/// Asserts that no seed has faults, on all cores; `size` determines the number of seeds.
pub fn attack(few: u64, many: u64, faults: impl Fn(u64) -> Vec<String> + Sync) {
    let count = size(few, many);
    let workers = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let work = |worker: u64| -> Vec<String> {
        let seeds = (worker..count).step_by(workers as usize);
        seeds.flat_map(&faults).collect()
    };
    let all: Vec<String> = std::thread::scope(|scope| {
        let running: Vec<_> = (0..workers)
            .map(|worker| {
                scope.spawn({
                    let work = &work;
                    move || work(worker)
                })
            })
            .collect();
        let results = running.into_iter();
        results
            .flat_map(|worker| worker.join().expect("no panic"))
            .collect()
    });
    assert!(
        all.is_empty(),
        "{} faults in {count} cases:\n{}",
        all.len(),
        all.join("\n")
    );
}
