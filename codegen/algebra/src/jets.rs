//! Values with first and mixed second derivatives modulo p by hyper-dual numbers: f, its slope f₁ along one
//! direction, its slopes f₂ along many other directions, and all mixed slopes f₁₂. No derivative is ever
//! written as an expression.
//!
//! For symbols x(s, t) with ∂x/∂s = x₁, ∂x/∂t = x₂ and ∂²x/∂s∂t = x₁₂,
//! `f₁₂ = D²f [x₁, x₂] + Df(x₁₂)`.

use super::dual::{Duals, VectorForwardMode};
use super::field_point::FieldPoint;
use super::residue_pair::ResiduePair;
use super::tangent::{Dual, duals};
use super::tape::Tape;

/// Motion of the symbols, with one entry for each symbol, 0 beyond the end.
#[derive(Clone, Debug, Default)]
pub struct Seeds {
    /// x₁.
    pub along: Vec<ResiduePair>,
    /// x₂ of every column.
    pub across: Vec<Vec<ResiduePair>>,
    /// x₁₂ of every column, 0 for columns beyond the end.
    pub mixed: Vec<Vec<ResiduePair>>,
}

/// Value and slopes of an expression: f, f₁, and f₂ and f₁₂ for every column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Jet {
    /// f.
    pub value: ResiduePair,
    /// f₁.
    pub along: ResiduePair,
    /// f₂ of every column; empty if f and f₁ are constant along all of them.
    pub across: Vec<ResiduePair>,
    /// f₁₂ of every column; empty if f and f₁ are constant along all columns.
    pub mixed: Vec<ResiduePair>,
}

impl Jet {
    /// f₂ of a column.
    pub fn across(&self, column: usize) -> ResiduePair {
        self.across
            .get(column)
            .copied()
            .unwrap_or(ResiduePair::ZERO)
    }

    /// f₁₂ of a column.
    pub fn mixed(&self, column: usize) -> ResiduePair {
        self.mixed.get(column).copied().unwrap_or(ResiduePair::ZERO)
    }

    /// Whether the expression is constant along all directions.
    pub fn is_constant(&self) -> bool {
        self.across.is_empty() && self.along.is_zero()
    }
}

impl Tape {
    /// Computes the jets of the expressions at a point; `None` if something has no value there.
    pub fn jets(&self, point: &FieldPoint, seeds: &Seeds) -> Option<Vec<Jet>> {
        // Numbers are f and f₁ along s, with the slopes of both along all t.
        let of_symbol = |index: usize| -> Vec<Dual> {
            let at = |row: Option<&Vec<ResiduePair>>| row?.get(index).copied();
            let slope = |k: usize| {
                let (across, mixed) = (at(seeds.across.get(k)), at(seeds.mixed.get(k)));
                (
                    across.unwrap_or(ResiduePair::ZERO),
                    mixed.unwrap_or(ResiduePair::ZERO),
                )
            };
            (0..seeds.across.len()).map(slope).collect()
        };
        let mut all = Duals {
            numbers: duals(point, &seeds.along),
            slopes: VectorForwardMode(of_symbol),
        };
        let values = self.run(&mut all)?;
        let jet = |((value, along), columns): (Dual, Vec<Dual>)| {
            let (across, mixed) = columns.into_iter().unzip();
            Jet {
                value,
                along,
                across,
                mixed,
            }
        };
        let jets = values.into_iter().map(jet);
        (!all.numbers.numbers.has_missing_root()).then(|| jets.collect())
    }
}
