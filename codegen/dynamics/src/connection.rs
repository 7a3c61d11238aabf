//! Connection coefficients Γᵢⱼₖ, KR18 (23).

use super::calculus::Calculus;
use hamel_algebra::graph::Edge;
use hamel_language::model::Model;

/// Returns the connection `Γ[i][j][k]` = ½ (∂ₖM_ij + ∂ⱼM_ik − ∂ᵢM_jk + γᵢⱼˢ M_sk + γᵢₖˢ M_sj − γⱼₖˢ M_si), KR18 (23),
/// as expressions.
pub fn connection(
    model: &mut Model,
    calculus: &mut Calculus,
    mass: &[Vec<Edge>],
    gamma: &[Vec<Vec<Edge>>],
) -> Vec<Vec<Vec<Edge>>> {
    let n = model.n();
    let graph = &mut model.graph;
    let (half, zero) = (graph.ratio(1, 2), graph.zero());
    // change[k][i][j] = ∂ₖM_ij; lowered[i][j][k] = γᵢⱼˢ M_sk
    let change: Vec<Vec<Vec<Edge>>> = (0..n)
        .map(|k| {
            mass.iter()
                .map(|row| {
                    row.iter()
                        .map(|&entry| calculus.along(graph, k, entry))
                        .collect()
                })
                .collect()
        })
        .collect();
    let lowered: Vec<Vec<Vec<Edge>>> = gamma
        .iter()
        .map(|plane| {
            plane
                .iter()
                .map(|row| match row.iter().all(|&entry| entry == zero) {
                    true => vec![zero; n],
                    false => (0..n).map(|k| graph.dot(row, &mass[k])).collect(),
                })
                .collect()
        })
        .collect();
    (0..n)
        .map(|i| {
            (0..n)
                .map(|j| {
                    (0..n)
                        .map(|k| {
                            let terms = [
                                change[k][i][j],
                                change[j][i][k],
                                -change[i][j][k],
                                lowered[i][j][k],
                                lowered[i][k][j],
                                -lowered[j][k][i],
                            ];
                            let sum = graph.sum(&terms);
                            graph.mul(half, sum)
                        })
                        .collect()
                })
                .collect()
        })
        .collect()
}

/// Returns the bias forces hᵢ = Γᵢⱼₖ ξʲ ξᵏ, Coriolis and centrifugal, without forming Γ and without gravity.
///
/// hᵢ = Ṁ_ij ξʲ − ½ ∂ᵢM_jk ξʲ ξᵏ + γᵢⱼˢ ξʲ p_s with p = M ξ (the antisymmetric term of (23) drops
/// out); this is Hamel's form of KR18 (30a).
pub fn bias_forces(
    model: &mut Model,
    calculus: &mut Calculus,
    mass: &[Vec<Edge>],
    gamma: &[Vec<Vec<Edge>>],
) -> Vec<Edge> {
    let n = model.n();
    let graph = &mut model.graph;
    let xi = model.xi.clone();
    let momentum: Vec<Edge> = mass.iter().map(|row| graph.dot(row, &xi)).collect();
    let half = graph.ratio(1, 2);
    let zero = graph.zero();
    let mut twice_energy = zero;
    for (p, x) in momentum.iter().zip(&xi) {
        let product = graph.mul(*p, *x);
        twice_energy = graph.add(twice_energy, product);
    }
    let energy = graph.mul(half, twice_energy);
    (0..n)
        .map(|i| {
            let rate = calculus.rate(graph, momentum[i]);
            let change = calculus.along(graph, i, energy);
            let mut sum = graph.sub(rate, change);
            for j in 0..n {
                if gamma[i][j].iter().all(|&entry| entry == zero) {
                    continue;
                }
                let row = graph.dot(&gamma[i][j], &momentum);
                let product = graph.mul(row, xi[j]);
                sum = graph.add(sum, product);
            }
            sum
        })
        .collect()
}
