//! Rows of second derivatives modulo p by dual numbers that run backwards: the slopes of f′ along one
//! direction in all symbols at once, at the cost of a few evaluations however many symbols there are.

use super::dual::{Duals, Record};
use super::fp::Fp;
use super::lane::Lane;
use super::tangent::duals;
use super::tape::Tape;

impl Tape {
    /// ∂(∂f/∂s)/∂xₖ for every symbol xₖ, f the first of the expressions and s along `direction`; `None`
    /// where something has no value at the point.
    pub fn bend(&self, lane: &Lane, direction: &[Fp]) -> Option<Vec<Fp>> {
        let mut all = Duals {
            numbers: duals(lane, direction),
            slopes: Record::default(),
        };
        let place = self.run(&mut all)?.first()?.1;
        let row = all
            .slopes
            .backwards(&mut all.numbers, place, direction.len())?;
        (!all.numbers.numbers.is_stuck()).then(|| row.into_iter().map(|(_, bent)| bent).collect())
    }
}
