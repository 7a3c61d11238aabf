//! Points of X over F_p: random values of all symbols that satisfy φ = 0.

use super::layout::{Block, sample};
use crate::algebra::fp::{Fp, Random};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::lane::Lane;
use crate::algebra::poly;
use crate::algebra::topoly::polynomial_at;

/// The variety X as the generator samples it.
#[derive(Clone, Debug)]
pub struct Points {
    /// Graph whose points are unconstrained; `constraints` live here.
    pub free: Graph,
    /// Constraints that the user wrote, = 0.
    pub constraints: Vec<Edge>,
    /// Blocks of x.
    pub blocks: Vec<Block>,
    /// Index of the symbol of x₁.
    pub first: usize,
    /// Number of symbols before and after creation of the model's own ones.
    pub symbols: usize,
}

impl Points {
    /// Values of all symbols at a random point of X; `None` where no point was found.
    pub fn choose(&self, random: &mut Random) -> Option<Vec<Fp>> {
        let mut values: Vec<Fp> = (0..self.symbols).map(|_| random.element()).collect();
        let mut place = self.first;
        for &block in &self.blocks {
            for value in sample(block, random) {
                values[place] = value;
                place += 1;
            }
        }
        if self.constraints.is_empty() {
            return Some(values);
        }
        let solved = self.solve(&values, random)?;
        for (var, value) in solved {
            values[var as usize] = value;
        }
        Some(values)
    }

    /// Coordinates that satisfy the user's constraints, by elimination over F_p.
    fn solve(&self, values: &[Fp], random: &mut Random) -> Option<Vec<(poly::monomial::Var, Fp)>> {
        let last = self.first + self.blocks.iter().map(|block| block.len()).sum::<usize>();
        let unknown = |symbol: usize| (self.first..last).contains(&symbol);
        let mut generators = Vec::new();
        for &constraint in &self.constraints {
            generators.push(polynomial_at(&self.free, constraint, values, &unknown)?);
        }
        let used = |generators: &[poly::polynomial::Poly<Fp>]| {
            let mut used: Vec<poly::monomial::Var> =
                generators.iter().flat_map(|g| g.variables()).collect();
            used.sort_unstable();
            used.dedup();
            used
        };
        let mut variables = used(&generators);
        // A constrained block that takes part brings its own φ.
        let mut place = self.first as poly::monomial::Var;
        for &block in &self.blocks {
            let range: Vec<poly::monomial::Var> =
                (place..place + block.len() as poly::monomial::Var).collect();
            place += block.len() as poly::monomial::Var;
            if range.iter().any(|var| variables.contains(var)) {
                generators.extend(match block {
                    Block::Flat(_) => Vec::new(),
                    Block::Circle => poly::ideals::circle(range[0], range[1]),
                    Block::Quaternion => {
                        poly::ideals::quaternion([range[0], range[1], range[2], range[3]])
                    }
                    Block::Rotation => poly::ideals::rotation(std::array::from_fn(|i| range[i])),
                });
                if !matches!(block, Block::Flat(_)) {
                    variables.extend(&range);
                }
            }
        }
        variables.sort_unstable();
        variables.dedup();
        poly::solve::point(&generators, &variables, random)
    }

    /// A lane at a fresh point.
    pub fn lane(&self, seed: u64) -> Option<Lane> {
        let mut lane = Lane::new(seed);
        let values = self.choose(&mut Random::new(seed ^ 0x0b5e))?;
        for value in values {
            lane.push_symbol(value);
        }
        Some(lane)
    }
}
