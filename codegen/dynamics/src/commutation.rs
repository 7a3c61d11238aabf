//! Commutation (Hamel) coefficients, ∂ᵢ∂ⱼ − ∂ⱼ∂ᵢ = γᵢⱼᵏ ∂ₖ.

use super::calculus::Calculus;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::Edge;
use hamel_language::model::Model;

/// Returns the Hamel coefficients `γ[i][j][k]` = γᵢⱼᵏ = (∂ᵢAⱼ^β − ∂ⱼAᵢ^β) Y_β^k, KR18 (12), as expressions, where `y`
/// is Y, n × ν.
pub fn gamma(model: &mut Model, calculus: &mut Calculus, y: &[Vec<Edge>]) -> Vec<Vec<Vec<Edge>>> {
    let (n, zero) = (model.n(), model.graph.zero());
    let mut gamma = vec![vec![vec![zero; n]; n]; n];
    for i in 0..n {
        for j in i + 1..n {
            let commutator: Vec<Edge> = (0..model.nu())
                .map(|beta| {
                    let left = calculus.along(&mut model.graph, i, model.a[beta][j]);
                    let right = calculus.along(&mut model.graph, j, model.a[beta][i]);
                    model.graph.sub(left, right)
                })
                .collect();
            // Most vector fields of large frames commute.
            if commutator.iter().all(|&entry| entry == zero) {
                continue;
            }
            for k in 0..n {
                let entry = model.graph.dot(&commutator, &y[k]);
                gamma[i][j][k] = entry;
                gamma[j][i][k] = -entry;
            }
        }
    }
    gamma
}

/// Returns the Hamel coefficients `γ[i][j][k]` = (∂Y_α^k/∂x^β − ∂Y_β^k/∂x^α) Aᵢ^α Aⱼ^β from the rows of Y, KR18 (13),
/// which must agree with (12) on X.
///
/// The curl of Y is contracted with tangent vectors on both sides; with A held fixed each half is
/// the derivative of Y(x) a along b for constant a, b, so no derivative off X is taken:
/// ∂ⱼ(Y_α^k) Aᵢ^α − ∂ᵢ(Y_β^k) Aⱼ^β.
pub fn gamma_from_rows(model: &mut Model, y: &[Vec<Edge>]) -> Vec<Vec<Vec<Edge>>> {
    let (n, zero) = (model.n(), model.graph.zero());
    let mut directions: Vec<Derivation> = (0..n)
        .map(|i| {
            Derivation::new(
                model
                    .x
                    .iter()
                    .zip(&model.a)
                    .map(|(x, row)| (x.node(), row[i])),
            )
        })
        .collect();
    let mut gamma = vec![vec![vec![zero; n]; n]; n];
    for k in 0..n {
        // change[j][i] = ∂ⱼ(Y_α^k) Aᵢ^α
        let change: Vec<Vec<Edge>> = directions
            .iter_mut()
            .map(|direction| {
                let moved = direction.all(&mut model.graph, &y[k]);
                (0..n)
                    .map(|i| {
                        let column: Vec<Edge> = model.a.iter().map(|row| row[i]).collect();
                        model.graph.dot(&moved, &column)
                    })
                    .collect()
            })
            .collect();
        for i in 0..n {
            for j in 0..n {
                gamma[i][j][k] = model.graph.sub(change[j][i], change[i][j]);
            }
        }
    }
    gamma
}
