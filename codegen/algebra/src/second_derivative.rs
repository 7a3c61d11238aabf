//! Second derivatives modulo p by reverse-mode differentiation over dual numbers: the slopes of f′ in all
//! symbols at once, where f′ is the derivative of f along one direction. This costs a few evaluations,
//! however many symbols there are.

use super::dual::{Duals, Record};
use super::field_point::FieldPoint;
use super::residue_pair::ResiduePair;
use super::tangent::duals;
use super::tape::Tape;

impl Tape {
    /// Computes ∂(∂f/∂s)/∂xₖ for the symbols xₖ, where f is the first of the expressions and s is
    /// `direction`; one entry for each entry of `direction`. `None` if something has no value at the point.
    pub fn second_derivative(
        &self,
        point: &FieldPoint,
        direction: &[ResiduePair],
    ) -> Option<Vec<ResiduePair>> {
        let mut all = Duals {
            numbers: duals(point, direction),
            slopes: Record::default(),
        };
        let place = self.run(&mut all)?.first()?.1;
        let row = all
            .slopes
            .gradient(&mut all.numbers, place, direction.len())?;
        (!all.numbers.numbers.has_missing_root())
            .then(|| row.into_iter().map(|(_, bent)| bent).collect())
    }
}
