//! ξ̇ = M⁻¹ Σ groups by M = L D Lᵀ, unrolled and sparse, with what is constant done once.

use super::parts::Parts;
use hamel_algebra::graph::{Edge, Graph, Node};
use hamel_algebra::linear::solve_symmetric;

/// One way to solve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Order of elimination.
    pub order: Vec<usize>,
    /// The first so many columns are eliminated from each group alone, so that what cancels in a
    /// group (a force at the centre of mass has no torque there) cancels before it is summed.
    pub apart: usize,
    /// Scale the remaining right-hand side by the first remaining pivot, where that is constant:
    /// the factor goes into constants that are there anyway.
    pub scale: bool,
    /// Multiply the remaining right-hand side by the inverse of what remains of M, where that is
    /// constant: as many operations as substitution where it is full, but fewer after one another.
    pub inverse: bool,
}

/// ξ̇ and the pivots that have to be positive.
#[derive(Clone, Debug)]
pub struct Solution {
    /// ξ̇.
    pub xi_dot: Vec<Edge>,
    /// Pivots of D, one for each velocity in their order, whatever the order of elimination; 1 where a rate is given.
    pub pivots: Vec<Edge>,
}

/// Solves; `None` where a pivot vanishes identically.
pub fn solve(graph: &mut Graph, parts: &Parts, plan: &Plan) -> Option<Solution> {
    let n = plan.order.len();
    let zero = graph.zero();
    let mut a: Vec<Vec<Edge>> = plan
        .order
        .iter()
        .map(|&i| plan.order.iter().map(|&j| parts.mass[i][j]).collect())
        .collect();
    let mut groups: Vec<Vec<Edge>> = parts
        .groups
        .iter()
        .map(|g| plan.order.iter().map(|&i| g[i]).collect())
        .collect();
    if groups.is_empty() {
        groups.push(vec![zero; n]);
    }
    // Factorise: l[r][c] below the diagonal, d on it, and how to divide by d.
    let mut l = vec![vec![zero; n]; n];
    let mut pivots = Vec::with_capacity(n);
    let mut inverses: Vec<Option<Edge>> = Vec::with_capacity(n);
    let mut rest = Vec::new();
    for c in 0..n {
        if c == plan.apart {
            rest = (c..n).map(|r| a[r][c..].to_vec()).collect();
        }
        let pivot = a[c][c];
        let below = (c + 1..n).filter(|&r| a[r][c] != zero).count();
        let inverse = if graph.is_free(pivot.node()) || below > 0 {
            Some(graph.div(graph.one(), pivot)?)
        } else {
            None
        };
        for r in c + 1..n {
            if a[r][c] != zero {
                l[r][c] = divide(graph, a[r][c], pivot, inverse)?;
            }
        }
        for r in c + 1..n {
            for s in c + 1..=r {
                if l[r][c] != zero && a[s][c] != zero {
                    let product = graph.mul(l[r][c], a[s][c]);
                    a[r][s] = graph.sub(a[r][s], product);
                    a[s][r] = a[r][s];
                }
            }
        }
        pivots.push(pivot);
        inverses.push(inverse);
    }
    let mut w = vec![zero; n];
    // Group by group.
    for c in 0..plan.apart {
        for group in &mut groups {
            let y = group[c];
            for r in c + 1..n {
                let product = graph.mul(l[r][c], y);
                group[r] = graph.sub(group[r], product);
            }
            let part = divide(graph, y, pivots[c], inverses[c])?;
            w[c] = graph.add(w[c], part);
        }
    }
    let mut right: Vec<Edge> = (0..n)
        .map(|r| {
            let column: Vec<Edge> = groups.iter().map(|group| group[r]).collect();
            graph.sum(&column)
        })
        .collect();
    let constant = rest.iter().flatten().all(|edge| graph.is_free(edge.node()));
    if plan.inverse && constant && !rest.is_empty() {
        let block = multiply_inverse(graph, &rest, &right[plan.apart..], plan.scale)?;
        w.truncate(plan.apart);
        w.extend(block);
    } else {
        substitute(graph, plan, &l, (&pivots, &inverses), &mut right, &mut w)?;
    }
    for c in (0..plan.apart).rev() {
        for r in c + 1..n {
            let product = graph.mul(l[r][c], w[r]);
            w[c] = graph.sub(w[c], product);
        }
    }
    let mut solution = Solution {
        xi_dot: vec![zero; n],
        pivots: vec![zero; n],
    };
    for (place, &i) in plan.order.iter().enumerate() {
        solution.xi_dot[i] = w[place];
        solution.pivots[i] = pivots[place];
    }
    Some(solution)
}

/// S⁻¹ b for a constant S; scaled, the entry [1,1] of the inverse goes into constants of b.
fn multiply_inverse(
    graph: &mut Graph,
    s: &[Vec<Edge>],
    b: &[Edge],
    scale: bool,
) -> Option<Vec<Edge>> {
    let k = s.len();
    let identity: Vec<Vec<Edge>> = (0..k)
        .map(|i| {
            (0..k)
                .map(|j| if i == j { graph.one() } else { graph.zero() })
                .collect()
        })
        .collect();
    let mut inverse = solve_symmetric(graph, s, &identity)?;
    let mut b = b.to_vec();
    if scale {
        let factor = inverse[0][0];
        for entry in inverse.iter_mut().flatten() {
            *entry = graph.div(*entry, factor)?;
        }
        b = b
            .into_iter()
            .map(|entry| absorb(graph, entry, factor))
            .collect();
    }
    Some(inverse.iter().map(|row| graph.dot(row, &b)).collect())
}

/// Forward, diagonal and backward substitution in the columns from `plan.apart` on.
fn substitute(
    graph: &mut Graph,
    plan: &Plan,
    l: &[Vec<Edge>],
    (pivots, inverses): (&[Edge], &[Option<Edge>]),
    right: &mut [Edge],
    w: &mut [Edge],
) -> Option<()> {
    let n = right.len();
    let lead = pivots
        .get(plan.apart)
        .copied()
        .filter(|pivot| plan.scale && graph.is_free(pivot.node()));
    if let Some(lead) = lead {
        let factor = graph.div(graph.one(), lead)?;
        for entry in right.iter_mut().skip(plan.apart) {
            *entry = absorb(graph, *entry, factor);
        }
    }
    for c in plan.apart..n {
        let y = right[c];
        for r in c + 1..n {
            let product = graph.mul(l[r][c], y);
            right[r] = graph.sub(right[r], product);
        }
        w[c] = match lead {
            Some(lead) => {
                let factor = divide(graph, lead, pivots[c], inverses[c])?;
                graph.mul(factor, y)
            }
            None => divide(graph, y, pivots[c], inverses[c])?,
        };
    }
    for c in (plan.apart..n).rev() {
        for r in c + 1..n {
            let product = graph.mul(l[r][c], w[r]);
            w[c] = graph.sub(w[c], product);
        }
    }
    Some(())
}

fn divide(graph: &mut Graph, a: Edge, pivot: Edge, inverse: Option<Edge>) -> Option<Edge> {
    match inverse {
        Some(inverse) => Some(absorb(graph, a, inverse)),
        None => graph.div(a, pivot),
    }
}

/// factor · edge, the factor put into constants of the expression where there are some.
pub fn absorb(graph: &mut Graph, edge: Edge, factor: Edge) -> Edge {
    if !graph.is_free(factor.node()) || !absorbs(graph, edge, 0) {
        return graph.mul(factor, edge);
    }
    let negative = edge.is_negative();
    let result = match graph.node(edge.node()) {
        Node::Add(a, b) => {
            let (a, b) = (absorb(graph, a, factor), absorb(graph, b, factor));
            graph.add(a, b)
        }
        Node::Mul(a, b) if absorbs(graph, a, 0) => {
            let a = absorb(graph, a, factor);
            graph.mul(a, b)
        }
        Node::Mul(a, b) => {
            let b = absorb(graph, b, factor);
            graph.mul(a, b)
        }
        _ => graph.mul(factor, edge.abs()),
    };
    result.signed(negative)
}

/// Whether a constant factor costs nothing in an expression: every term has a constant to take it.
fn absorbs(graph: &Graph, edge: Edge, depth: usize) -> bool {
    if graph.is_free(edge.node()) {
        return true;
    }
    // Deep sums would be copied as a whole.
    if depth > 12 {
        return false;
    }
    match graph.node(edge.node()) {
        Node::Add(a, b) => absorbs(graph, a, depth + 1) && absorbs(graph, b, depth + 1),
        Node::Mul(a, b) => absorbs(graph, a, depth + 1) || absorbs(graph, b, depth + 1),
        _ => false,
    }
}
