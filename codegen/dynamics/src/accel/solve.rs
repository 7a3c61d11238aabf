//! Solution ξ̇ = M⁻¹ Σ groups by M = L D Lᵀ, unrolled and sparse, with constant parts computed only once.

use super::parts::EquationTerms;
use crate::candidates::SHORT_SEARCH_NODES;
use hamel_algebra::graph::{Edge, Graph, Node};
use hamel_algebra::linear::solve_symmetric;
use hamel_language::model::Model;

/// Order and form of the elimination by which M ξ̇ = Σ groups is solved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EliminationPlan {
    /// Order in which velocities are eliminated.
    pub order: Vec<usize>,
    /// Number of leading columns that are eliminated from each group separately.
    ///
    /// Terms that cancel within a group (a force at the centre of mass has no torque about it) then cancel before
    /// the groups are summed.
    pub apart: usize,
    /// Whether to divide the remaining right-hand side by the first remaining pivot, if that is constant: the
    /// factor is absorbed into constants that the right-hand side contains anyway.
    pub scale: bool,
    /// Whether to multiply the remaining right-hand side by the inverse of the remaining block of M, if that block
    /// is constant.
    ///
    /// For a full block this takes as many operations as substitution, but the chain of dependent operations is
    /// shorter.
    pub inverse: bool,
}

/// Returns all plans worth counting for a small system.
pub(crate) fn all_plans(graph: &Graph, parts: &EquationTerms) -> Vec<EliminationPlan> {
    let n = parts.mass.len();
    if graph.len() > SHORT_SEARCH_NODES {
        return [(0..n).collect(), (0..n).rev().collect()]
            .map(|order| EliminationPlan {
                order,
                apart: 0,
                scale: false,
                inverse: false,
            })
            .to_vec();
    }
    // A constant M is factored once, when the parameters are set, so its elimination order costs nothing at run
    // time.
    let constant = parts
        .mass
        .iter()
        .flatten()
        .all(|edge| graph.is_free(edge.node()));
    let mut orders: Vec<Vec<usize>> = match constant {
        true => vec![(0..n).collect()],
        false => vec![
            (0..n).collect(),
            (0..n).rev().collect(),
            constant_first(graph, parts),
        ],
    };
    orders.sort();
    orders.dedup();
    // The first three velocities of a body are usually the linear ones; other useful values are none and all.
    let mut aparts = if parts.groups.len() > 1 {
        vec![0, 3.min(n), n]
    } else {
        vec![0]
    };
    aparts.dedup();
    let mut plans = Vec::new();
    for order in orders {
        for &apart in &aparts {
            for scale in [false, true] {
                for inverse in [false, true] {
                    if apart < n || !(scale || inverse) {
                        plans.push(EliminationPlan {
                            order: order.clone(),
                            apart,
                            scale,
                            inverse,
                        });
                    }
                }
            }
        }
    }
    plans
}

/// Orders velocities with a constant diagonal entry of M first, and otherwise keeps their order.
pub(super) fn constant_first(graph: &Graph, parts: &EquationTerms) -> Vec<usize> {
    let constant = |i: &usize| graph.is_free(parts.mass[*i][*i].node());
    let (first, last): (Vec<usize>, Vec<usize>) = (0..parts.mass.len()).partition(constant);
    first.into_iter().chain(last).collect()
}

/// Describes the elimination order in words.
pub(super) fn describe_order(model: &Model, order: &[usize]) -> String {
    if order.windows(2).all(|pair| pair[0] < pair[1]) {
        return "velocities eliminated in their order".into();
    }
    let name = |i: &usize| {
        model
            .graph
            .symbols()
            .iter()
            .find(|s| s.node == model.xi[*i].node())
            .map_or("", |s| s.name.as_str())
    };
    let names: Vec<String> = order.iter().map(|i| format!("`{}`", name(i))).collect();
    format!("velocities eliminated in the order {}", names.join(", "))
}

/// Solution ξ̇ with the pivots that must be positive.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Accelerations ξ̇.
    pub xi_dot: Vec<Edge>,
    /// Pivots of D, one per velocity, in the order of the velocities whatever the elimination order; 1 for a
    /// velocity whose rate is given.
    pub pivots: Vec<Edge>,
}

/// Solves M ξ̇ = Σ groups; `None` if a pivot vanishes identically.
pub fn solve(graph: &mut Graph, parts: &EquationTerms, plan: &EliminationPlan) -> Option<Solution> {
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
    // Factorise M: l[r][c] below the diagonal, d on the diagonal, and the inverses of d that are worth computing.
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
    // Eliminate the leading columns group by group.
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

/// Returns S⁻¹ b for a constant S; with `scale`, the entry `[1,1]` of the inverse is absorbed into constants of b.
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
            .map(|entry| absorb_factor(graph, entry, factor))
            .collect();
    }
    Some(inverse.iter().map(|row| graph.dot(row, &b)).collect())
}

/// Performs forward, diagonal and backward substitution in the columns from `plan.apart` on.
fn substitute(
    graph: &mut Graph,
    plan: &EliminationPlan,
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
            *entry = absorb_factor(graph, *entry, factor);
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
        Some(inverse) => Some(absorb_factor(graph, a, inverse)),
        None => graph.div(a, pivot),
    }
}

/// Returns factor · edge, with the factor absorbed into constants of the expression if possible.
pub fn absorb_factor(graph: &mut Graph, edge: Edge, factor: Edge) -> Edge {
    if !graph.is_free(factor.node()) || !can_absorb_factor(graph, edge, 0) {
        return graph.mul(factor, edge);
    }
    let negative = edge.is_negative();
    let result = match graph.node(edge.node()) {
        Node::Add(a, b) => {
            let (a, b) = (
                absorb_factor(graph, a, factor),
                absorb_factor(graph, b, factor),
            );
            graph.add(a, b)
        }
        Node::Mul(a, b) if can_absorb_factor(graph, a, 0) => {
            let a = absorb_factor(graph, a, factor);
            graph.mul(a, b)
        }
        Node::Mul(a, b) => {
            let b = absorb_factor(graph, b, factor);
            graph.mul(a, b)
        }
        _ => graph.mul(factor, edge.abs()),
    };
    result.signed(negative)
}

/// Returns whether a constant factor can be absorbed by an expression at no cost: every term has a constant to take
/// it.
fn can_absorb_factor(graph: &Graph, edge: Edge, depth: usize) -> bool {
    if graph.is_free(edge.node()) {
        return true;
    }
    // Absorbing a factor into a deep sum would copy the whole sum.
    if depth > 12 {
        return false;
    }
    match graph.node(edge.node()) {
        Node::Add(a, b) => {
            can_absorb_factor(graph, a, depth + 1) && can_absorb_factor(graph, b, depth + 1)
        }
        Node::Mul(a, b) => {
            can_absorb_factor(graph, a, depth + 1) || can_absorb_factor(graph, b, depth + 1)
        }
        _ => false,
    }
}
