//! Rows of B that are dependent along the whole motion, as in overconstrained mechanisms with closed loops.
//! S = B M⁻¹ Bᵀ is singular there, and S λ = r is solved with S⁺ instead of S⁻¹.
//!
//! The diagonal of S is raised by a small fraction of itself that is still large compared with rounding
//! (`Function::Raised`): R = S + E with a diagonal E. Then T = E R⁻¹ is small along the independent rows and 1
//! along contradictions. With S⁻¹ = R⁻¹ (1 − T)⁻¹,
//!
//! S⁺ = R⁻¹ (1 + 3 T + 6 T²) (1 − T)²
//!
//! agrees with S⁻¹ up to the second order in T, but is 0 where T is 1: the contradictory part of r is removed
//! before it is divided by E.
//!
//! The right-hand side for ξ̇ is not contradictory as long as the loops are closed, so iterative refinement with R
//! would do for ξ̇ itself. It does not do for its derivatives, because displacements and velocities also open the
//! loops: with refinement, the derivatives of λ are as large as 1/E along directions that Bᵀ maps to 0, and Bᵀ
//! leaves their rounding error, 1e-8 of the derivatives of ξ̇. With S⁺ nothing becomes that large.

use super::kkt::solve_columns;
use hamel_algebra::graph::{Edge, Function, Graph};
use hamel_algebra::residue_pair::ResiduePair;
use hamel_language::model::pfaffian::{Kind, Pfaffian};

/// Number of factors 1 − T in S⁺.
///
/// In floating point, one factor leaves a part of a contradiction as large as rounding relative to E; the part left
/// by two factors is below rounding even after the division by E.
pub(super) const CLEARING_POWER: usize = 2;

/// First coefficients of the power series of (1 − T) to the power −1 − `CLEARING_POWER`.
pub(super) const SERIES_COEFFICIENTS: [i64; 3] = [1, 3, 6];

/// Denominator of the share of the sum over all rows that is added to a row's own diagonal entry before it is
/// raised, since a single row may vanish along the motion.
const SHARE_DENOMINATOR: i64 = 1024;

/// Returns for each row of constraints the indices of the rows whose diagonal entries of S = B M⁻¹ Bᵀ raise its own:
/// all constraints for a row of a loop, and only the row itself otherwise.
///
/// `more` rows of given rates follow the constraints.
pub fn regularization_rows(constraints: &[Pfaffian], more: usize) -> Vec<Vec<usize>> {
    let is_loop = |i: usize| constraints.get(i).is_some_and(|c| c.kind == Kind::Loop);
    let rows = 0..constraints.len() + more;
    rows.map(|i| match is_loop(i) {
        false => vec![i],
        true => (0..constraints.len()).collect(),
    })
    .collect()
}

/// Turns S into R = S + E in place, and returns the diagonal of E.
pub(super) fn regularize(
    graph: &mut Graph,
    schur: &mut [Vec<Edge>],
    raising: &[Vec<usize>],
) -> Vec<Edge> {
    let diagonal: Vec<Edge> = (0..schur.len()).map(|i| schur[i][i]).collect();
    let mut raised = Vec::new();
    for (i, rows) in raising.iter().enumerate() {
        let own = diagonal[i];
        let size = match rows.len() {
            1 => own,
            _ => {
                let all: Vec<Edge> = rows.iter().map(|&j| diagonal[j]).collect();
                let share = graph.ratio(1, SHARE_DENOMINATOR);
                let all = graph.sum(&all);
                let all = graph.mul(share, all);
                graph.add(own, all)
            }
        };
        let more = graph.apply(Function::Raised, size);
        let more = graph.sub(more, size);
        schur[i][i] = graph.add(own, more);
        raised.push(more);
    }
    raised
}

/// Returns S⁺ r in numbers modulo p; `factor` is the factor of `Raised`, 1 if S is regular.
pub(super) fn multipliers_at(
    schur: &[ResiduePair],
    raising: &[Vec<usize>],
    wanted: Vec<ResiduePair>,
    factor: ResiduePair,
) -> Option<Vec<ResiduePair>> {
    let m = wanted.len();
    let share = ResiduePair::from_i64(SHARE_DENOMINATOR).inv()?;
    let raised = raising.iter().enumerate().map(|(i, rows)| {
        let all = rows
            .iter()
            .fold(ResiduePair::ZERO, |sum, &j| sum + schur[j * m + j]);
        let size = match rows.len() {
            1 => schur[i * m + i],
            _ => schur[i * m + i] + all * share,
        };
        size * factor - size
    });
    let raised: Vec<ResiduePair> = raised.collect();
    let mut matrix = schur.to_vec();
    (0..m).for_each(|i| matrix[i * m + i] = matrix[i * m + i] + raised[i]);
    let divided = |v: Vec<ResiduePair>| solve_columns(&matrix, m, &[v])?.pop();
    // Returns T v.
    let kept = |v: Vec<ResiduePair>| -> Option<Vec<ResiduePair>> {
        let divided = divided(v)?;
        Some(raised.iter().zip(divided).map(|(&e, y)| e * y).collect())
    };
    let mut left = wanted;
    for _ in 0..CLEARING_POWER {
        let kept = kept(left.clone())?;
        left.iter_mut().zip(kept).for_each(|(v, t)| *v = *v - t);
    }
    let mut sum = vec![ResiduePair::ZERO; m];
    for factor in SERIES_COEFFICIENTS {
        let factor = ResiduePair::from_i64(factor);
        let terms = sum.iter_mut().zip(&left);
        terms.for_each(|(sum, &v)| *sum = *sum + factor * v);
        left = kept(left)?;
    }
    divided(sum)
}
