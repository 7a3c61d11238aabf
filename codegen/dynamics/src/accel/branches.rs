//! Factorisation M = U D Uᵀ from the leaves of a tree to its root, organised by branches; it preserves the zeros
//! that the tree causes in M.
//!
//! A branch is a chain of velocities without a fork. If the velocities before a branch (towards the root) move by
//! w, the branch responds with −G w, where G = M_bb⁻¹ M_ba once everything that hangs on the branch is eliminated.
//! A force elsewhere therefore costs one product with G, and a force b on the branch acts on the velocities before
//! it as −Gᵀ b. After Featherstone (2008), section 6.5.
//!
//! If a joint has a twin, a direction s of the velocities before it that moves the branch as the joint itself does,
//! then M s = M e on the branch, so that G s = e: one column of G follows from the others.

use super::solve::absorb_factor;
use crate::tree::equivalent_motion::EquivalentMotion;
use hamel_algebra::graph::{Edge, Graph};

/// Factors of M = U D Uᵀ, branch by branch of a tree.
pub struct BranchFactors {
    /// Entries of U above the diagonal.
    upper: Vec<Vec<Edge>>,
    /// Pivots, the diagonal of D.
    pub pivots: Vec<Edge>,
    /// Inverse pivots.
    inverses: Vec<Edge>,
    /// Branches, each after the one that it hangs on.
    branches: Vec<Branch>,
    /// Columns of the inverse of the first branch's block of M once everything that hangs on it is eliminated;
    /// empty if not needed.
    first: Vec<Vec<Edge>>,
}

struct Branch {
    /// Velocities of the branch, from the root outwards.
    own: Vec<usize>,
    /// Velocities before the branch, towards the root.
    before: Vec<usize>,
    /// Matrix G; rows by `own`, columns by `before`.
    answers: Vec<Vec<Edge>>,
    /// Column of G that a twin makes known.
    known: Option<KnownColumn>,
}

/// A known column of G: e − Σ sᵢ Gᵢ with e = (1, 0, …).
struct KnownColumn {
    /// Its place in `before`.
    at: usize,
    /// The other places of s, with their entries.
    by: Vec<(usize, Edge)>,
}

impl BranchFactors {
    /// Factors a mass matrix into U D Uᵀ, branch by branch; `None` if a pivot vanishes identically.
    pub fn factorize(
        graph: &mut Graph,
        mass: &[Vec<Edge>],
        equivalent: &[EquivalentMotion],
    ) -> Option<Self> {
        let n = mass.len();
        let zero = graph.zero();
        let mut a = mass.to_vec();
        let mut upper = vec![vec![zero; n]; n];
        let mut inverses = vec![zero; n];
        for c in (0..n).rev() {
            inverses[c] = graph.div(graph.one(), a[c][c])?;
            for r in 0..c {
                upper[r][c] = absorb_factor(graph, a[r][c], inverses[c]);
            }
            for r in 0..c {
                for s in 0..=r {
                    let product = graph.mul(upper[r][c], a[s][c]);
                    a[r][s] = graph.sub(a[r][s], product);
                    a[s][r] = a[r][s];
                }
            }
        }
        let pivots = (0..n).map(|c| a[c][c]).collect();
        let branches = branches(graph, &upper, equivalent);
        let mut factors = BranchFactors {
            upper,
            pivots,
            inverses,
            branches,
            first: Vec::new(),
        };
        if factors.branches.iter().any(|branch| branch.known.is_some()) {
            let size = factors.branches[0].own.len();
            let columns = (0..size).map(|j| {
                let mut unit = vec![zero; n];
                unit[factors.branches[0].own[j]] = graph.one();
                factors.free(graph, &factors.branches[0], &mut unit);
                let own = factors.branches[0].own.iter();
                own.map(|&i| unit[i]).collect::<Vec<Edge>>()
            });
            factors.first = columns.collect();
        }
        Some(factors)
    }

    /// Returns M⁻¹ b.
    pub fn solve(&self, graph: &mut Graph, b: &[Edge]) -> Vec<Edge> {
        let zero = graph.zero();
        let mut b = b.to_vec();
        let mut pushed: Vec<(&KnownColumn, Edge)> = Vec::new();
        let mut others = 0;
        for branch in self.branches.iter().rev() {
            if branch.own.iter().all(|&i| b[i] == zero) {
                continue;
            }
            match &branch.known {
                Some(known) => pushed.push((known, branch.push_known(graph, known, &mut b))),
                None if branch.before.is_empty() => {}
                None => {
                    others += 1;
                    branch.push(graph, &mut b);
                }
            }
        }
        for (place, branch) in self.branches.iter().enumerate() {
            match pushed[..] {
                // If the force acts on a single branch with a known column, b at the known place follows from the
                // rest.
                [(known, rest)] if place == 0 && others == 0 && !self.first.is_empty() => {
                    self.free_known(graph, known, rest, &mut b);
                }
                _ => self.free(graph, branch, &mut b),
            }
            branch.follow(graph, &mut b);
        }
        b
    }

    /// Solves for a branch with the velocities before it at rest.
    fn free(&self, graph: &mut Graph, branch: &Branch, b: &mut [Edge]) {
        let own = &branch.own;
        for (place, &c) in own.iter().enumerate().rev() {
            for &r in &own[..place] {
                let product = graph.mul(self.upper[r][c], b[c]);
                b[r] = graph.sub(b[r], product);
            }
        }
        for (place, &c) in own.iter().enumerate() {
            let mut value = graph.mul(self.inverses[c], b[c]);
            for &r in &own[..place] {
                let product = graph.mul(self.upper[r][c], b[r]);
                value = graph.sub(value, product);
            }
            b[c] = value;
        }
    }

    /// Solves for the first branch, with the velocities before it at rest, if b at the known place equals
    /// `rest` − Σ sᵢ bᵢ.
    fn free_known(&self, graph: &mut Graph, known: &KnownColumn, rest: Edge, b: &mut [Edge]) {
        let own = &self.branches[0].own;
        let places: Vec<usize> = (0..own.len()).filter(|&j| j != known.at).collect();
        let moved: Vec<Edge> = (0..own.len())
            .map(|i| {
                let mut terms: Vec<Edge> = Vec::new();
                for &j in &places {
                    let mut entry = self.first[j][i];
                    if let Some((_, s)) = known.by.iter().find(|(place, _)| *place == j) {
                        let less = graph.mul(*s, self.first[known.at][i]);
                        entry = graph.sub(entry, less);
                    }
                    terms.push(graph.mul(entry, b[own[j]]));
                }
                terms.push(graph.mul(self.first[known.at][i], rest));
                graph.sum(&terms)
            })
            .collect();
        for (&i, moved) in own.iter().zip(moved) {
            b[i] = moved;
        }
    }
}

impl Branch {
    /// Subtracts Gᵀ b from b at the velocities before the branch.
    fn push(&self, graph: &mut Graph, b: &mut [Edge]) {
        for place in 0..self.before.len() {
            self.push_at(graph, place, b);
        }
    }

    fn push_at(&self, graph: &mut Graph, place: usize, b: &mut [Edge]) {
        let column = self.own.iter().zip(&self.answers);
        let terms: Vec<Edge> = column
            .map(|(&k, row)| graph.mul(row[place], b[k]))
            .collect();
        let transmitted = graph.sum(&terms);
        let i = self.before[place];
        b[i] = graph.sub(b[i], transmitted);
    }

    /// Does the same as `push` for a branch with a known column: there b becomes `rest` − Σ sᵢ bᵢ. Returns `rest`.
    fn push_known(&self, graph: &mut Graph, known: &KnownColumn, b: &mut [Edge]) -> Edge {
        let at = self.before[known.at];
        let along = |graph: &mut Graph, b: &[Edge]| {
            let terms = known.by.iter();
            let terms: Vec<Edge> = terms
                .map(|&(place, s)| graph.mul(s, b[self.before[place]]))
                .collect();
            graph.sum(&terms)
        };
        let sum = along(graph, b);
        let sum = graph.add(b[at], sum);
        let rest = graph.sub(sum, b[self.own[0]]);
        for place in (0..self.before.len()).filter(|&place| place != known.at) {
            self.push_at(graph, place, b);
        }
        let sum = along(graph, b);
        b[at] = graph.sub(rest, sum);
        rest
    }

    /// Subtracts G w from b for the motion w of the velocities before the branch.
    fn follow(&self, graph: &mut Graph, b: &mut [Edge]) {
        let mut moved: Vec<Edge> = self.before.iter().map(|&i| b[i]).collect();
        if let Some(known) = &self.known {
            let equivalent = std::mem::replace(&mut moved[known.at], graph.zero());
            for &(place, s) in &known.by {
                let part = graph.mul(s, equivalent);
                moved[place] = graph.sub(moved[place], part);
            }
            b[self.own[0]] = graph.sub(b[self.own[0]], equivalent);
        }
        for (&c, row) in self.own.iter().zip(&self.answers) {
            let answer = graph.dot(row, &moved);
            b[c] = graph.sub(b[c], answer);
        }
    }
}

/// Splits the velocities into branches and computes G of each.
fn branches(
    graph: &mut Graph,
    upper: &[Vec<Edge>],
    equivalent: &[EquivalentMotion],
) -> Vec<Branch> {
    let zero = graph.zero();
    let n = upper.len();
    let before = |c: usize| -> Vec<usize> { (0..c).filter(|&r| upper[r][c] != zero).collect() };
    let parents: Vec<Option<usize>> = (0..n).map(|c| before(c).last().copied()).collect();
    let children = |i: usize| parents.iter().filter(|parent| **parent == Some(i)).count();
    let mut found: Vec<Branch> = Vec::new();
    for c in 0..n {
        // A chain continues if all velocities before this one are on the branch of its parent or before that
        // branch.
        let goes_on = parents[c]
            .filter(|&last| children(last) == 1)
            .and_then(|last| {
                let branch = found
                    .iter_mut()
                    .find(|branch| branch.own.last() == Some(&last))?;
                let whole = [&branch.before[..], &branch.own].concat();
                (before(c).iter().all(|r| whole.contains(r))).then_some(branch)
            });
        match goes_on {
            Some(branch) => branch.own.push(c),
            None => {
                // An entry of U that happens to be zero for the first velocity of a branch may be nonzero for
                // others, so take the whole path to the root.
                let mut path = [path(&parents, c), before(c)].concat();
                path.sort_unstable();
                path.dedup();
                found.push(Branch {
                    own: vec![c],
                    before: path,
                    answers: Vec::new(),
                    known: None,
                });
            }
        }
    }
    let first = found.first().map(|branch| branch.own.clone());
    for branch in &mut found {
        let hangs = first.as_ref() == Some(&branch.before);
        let equivalent = equivalent
            .iter()
            .find(|equivalent| hangs && equivalent.of == branch.own[0]);
        branch.known = equivalent.and_then(|equivalent| known(graph, &branch.before, equivalent));
        for (place, &c) in branch.own.iter().enumerate() {
            let mut row: Vec<Edge> = branch.before.iter().map(|&a| upper[a][c]).collect();
            for (&k, other) in branch.own[..place].iter().zip(&branch.answers) {
                for (entry, &answer) in row.iter_mut().zip(other) {
                    let product = graph.mul(upper[k][c], answer);
                    *entry = graph.sub(*entry, product);
                }
            }
            branch.answers.push(row);
        }
    }
    found
}

/// Returns the column of G that a twin makes known.
fn known(graph: &Graph, before: &[usize], equivalent: &EquivalentMotion) -> Option<KnownColumn> {
    let (at, _) = equivalent
        .by
        .iter()
        .rev()
        .find(|(_, s)| *s == graph.one())?;
    let place = |i: usize| before.iter().position(|&other| other == i);
    let others = equivalent.by.iter().filter(|(i, _)| i != at);
    Some(KnownColumn {
        at: place(*at)?,
        by: others
            .map(|&(i, s)| Some((place(i)?, s)))
            .collect::<Option<_>>()?,
    })
}

/// Returns the velocities on the path from c to the root, without c.
fn path(parents: &[Option<usize>], c: usize) -> Vec<usize> {
    let mut before = Vec::new();
    let mut at = parents[c];
    while let Some(i) = at {
        before.push(i);
        at = parents[i];
    }
    before
}
