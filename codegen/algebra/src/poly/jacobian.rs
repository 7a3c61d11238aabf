//! Variables that a system g(x) = 0 leaves free, from the rank of its Jacobian J = ∂g/∂x.
//!
//! At a point, x_v can be varied, with the other variables following, unless e_v is in the row space of J.
//! The point used here is random and not on the variety, which is right for constants in general position
//! (rods of arbitrary lengths). For dependent equations, fewer variables are found.

use super::monomial::Var;
use super::polynomial::Poly;
use crate::echelon::Echelon;
use crate::prime::Residue;
use crate::residue_pair::Random;

/// Returns those of the given variables that are free one at a time, in the given order.
pub fn free_variables<const K: usize>(
    system: &[Poly<Residue<K>>],
    variables: &[Var],
    random: &mut Random,
) -> Vec<Var> {
    let last = variables.iter().max().map_or(0, |&v| v as usize + 1);
    let point: Vec<Residue<K>> = (0..last).map(|_| random.residue()).collect();
    let at = |v: Var| point.get(v as usize).copied().unwrap_or(Residue::ZERO);
    let row = |f: &Poly<Residue<K>>| -> Vec<Residue<K>> {
        let entries = variables.iter().map(|&v| f.derivative(v).eval(&at));
        entries.collect()
    };
    let Echelon { rows, pivots } = Echelon::new(system.iter().map(row).collect());
    let fixed = |column: usize| {
        let own = pivots.iter().position(|&pivot| pivot == column);
        own.is_some_and(|row| rows[row].iter().filter(|entry| !entry.is_zero()).count() == 1)
    };
    let free = (0..variables.len()).filter(|&column| !fixed(column));
    free.map(|column| variables[column]).collect()
}
