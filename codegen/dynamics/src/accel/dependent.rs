//! Rows of B that depend on one another along the whole motion, as those of overconstrained mechanisms do where their loops are
//! closed. S = B M⁻¹ Bᵀ is singular there, and S λ = r is solved by S⁺ in place of S⁻¹.
//!
//! The diagonal of S is raised by a small part of itself that rounding does not hide (`Function::Raised`): R = S + E with a
//! diagonal E. T = E R⁻¹ is small across the rows that are independent and 1 along what contradicts them. S⁻¹ is
//! R⁻¹ (1 − T)⁻¹, and
//!
//! S⁺ = R⁻¹ (1 + 3 T + 6 T²) (1 − T)²
//!
//! agrees with it up to the second order in T, but is 0 where T is 1: what is contradictory in r is taken away before it is
//! divided by E.
//!
//! The right side for ξ̇ is not contradictory where the loops are closed, and steps of refinement by R would serve it. But its
//! slopes are: displacements and velocities also open the loops. With refinement the slopes of λ are as large as 1/E along what
//! Bᵀ maps to 0, and Bᵀ leaves of them their rounding, 1e-8 of the slopes of ξ̇. With S⁺ nothing is that large.

use super::saddle::solve_columns;
use hamel_algebra::fp::Fp;
use hamel_algebra::graph::{Edge, Function, Graph};
use hamel_language::model::pfaffian::{Kind, Pfaffian};

/// Factors 1 − T of S⁺. In numbers, one leaves of a contradiction a part that is as large as rounding beside E; what two leave
/// is still less than rounding after it is divided by E.
pub(super) const CLEARED: usize = 2;

/// The first coefficients of (1 − T) to the power −1 − `CLEARED`.
pub(super) const SERIES: [i64; 3] = [1, 3, 6];

/// Since a single row may vanish on the way, the diagonal is raised by the same part of a share of the sum over all rows of
/// its equation, too.
const SHARE: i64 = 1024;

/// For each row the rows whose diagonal of S raises its own: all constraints, of a row of a loop; a row of another kind by itself.
/// `more` rows of given rates stand behind the constraints.
pub fn raising(constraints: &[Pfaffian], more: usize) -> Vec<Vec<usize>> {
    let is_loop = |i: usize| constraints.get(i).is_some_and(|c| c.kind == Kind::Loop);
    let rows = 0..constraints.len() + more;
    rows.map(|i| match is_loop(i) {
        false => vec![i],
        true => (0..constraints.len()).collect(),
    })
    .collect()
}

/// Makes R of S, and gives the diagonal of E.
pub(super) fn raise(
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
                let share = graph.ratio(1, SHARE);
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

/// S⁺ r in numbers modulo p; `factor` is what `Raised` multiplies by, 1 where S is regular.
pub(super) fn multipliers_at(
    schur: &[Fp],
    raising: &[Vec<usize>],
    wanted: Vec<Fp>,
    factor: Fp,
) -> Option<Vec<Fp>> {
    let m = wanted.len();
    let share = Fp::from_i64(SHARE).inv()?;
    let raised = raising.iter().enumerate().map(|(i, rows)| {
        let all = rows.iter().fold(Fp::ZERO, |sum, &j| sum + schur[j * m + j]);
        let size = match rows.len() {
            1 => schur[i * m + i],
            _ => schur[i * m + i] + all * share,
        };
        size * factor - size
    });
    let raised: Vec<Fp> = raised.collect();
    let mut matrix = schur.to_vec();
    (0..m).for_each(|i| matrix[i * m + i] = matrix[i * m + i] + raised[i]);
    let divided = |v: Vec<Fp>| solve_columns(&matrix, m, &[v])?.pop();
    // T v.
    let kept = |v: Vec<Fp>| -> Option<Vec<Fp>> {
        let divided = divided(v)?;
        Some(raised.iter().zip(divided).map(|(&e, y)| e * y).collect())
    };
    let mut left = wanted;
    for _ in 0..CLEARED {
        let kept = kept(left.clone())?;
        left.iter_mut().zip(kept).for_each(|(v, t)| *v = *v - t);
    }
    let mut sum = vec![Fp::ZERO; m];
    for factor in SERIES {
        let factor = Fp::from_i64(factor);
        let terms = sum.iter_mut().zip(&left);
        terms.for_each(|(sum, &v)| *sum = *sum + factor * v);
        left = kept(left)?;
    }
    divided(sum)
}
