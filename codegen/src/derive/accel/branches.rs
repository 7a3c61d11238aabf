//! M = U D Uᵀ from the leaves of a tree to its root, by branches: what is zero in M by the tree stays zero.
//!
//! A branch is a chain of velocities without a fork. Its velocities answer a movement w of those before it by −G w, where
//! G = M_bb⁻¹ M_ba once what hangs on the branch is eliminated; so a force elsewhere costs one product with G, and one on the
//! branch is felt before it as −Gᵀ b. After Featherstone (2008), section 6.5.

use crate::algebra::graph::{Edge, Graph};

use super::solve::absorb;

/// The factors.
pub struct Branches {
    /// Above the diagonal.
    upper: Vec<Vec<Edge>>,
    /// The pivots, D.
    pub pivots: Vec<Edge>,
    /// 1 / pivot.
    inverses: Vec<Edge>,
    /// Each after the one that it hangs on.
    branches: Vec<Branch>,
}

struct Branch {
    /// Velocities, the first next to the root.
    own: Vec<usize>,
    /// Velocities before them.
    before: Vec<usize>,
    /// G, by own and before.
    answers: Vec<Vec<Edge>>,
}

impl Branches {
    /// Factors M; `None` where a pivot vanishes identically.
    pub fn of(graph: &mut Graph, mass: &[Vec<Edge>]) -> Option<Self> {
        let n = mass.len();
        let zero = graph.zero();
        let mut a = mass.to_vec();
        let mut upper = vec![vec![zero; n]; n];
        let mut inverses = vec![zero; n];
        for c in (0..n).rev() {
            inverses[c] = graph.div(graph.one(), a[c][c])?;
            for r in 0..c {
                upper[r][c] = absorb(graph, a[r][c], inverses[c]);
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
        let branches = branches(graph, &upper);
        Some(Branches {
            upper,
            pivots,
            inverses,
            branches,
        })
    }

    /// M⁻¹ b.
    pub fn solve(&self, graph: &mut Graph, b: &[Edge]) -> Vec<Edge> {
        let mut b = b.to_vec();
        for branch in self.branches.iter().rev() {
            for (place, &i) in branch.before.iter().enumerate() {
                let column = branch.own.iter().zip(&branch.answers);
                let terms: Vec<Edge> = column
                    .map(|(&k, row)| graph.mul(row[place], b[k]))
                    .collect();
                let felt = graph.sum(&terms);
                b[i] = graph.sub(b[i], felt);
            }
        }
        for branch in &self.branches {
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
            let moved: Vec<Edge> = branch.before.iter().map(|&i| b[i]).collect();
            let free: Vec<Edge> = own.iter().map(|&c| b[c]).collect();
            for ((&c, row), value) in own.iter().zip(&branch.answers).zip(free) {
                let answer = graph.dot(row, &moved);
                b[c] = graph.sub(value, answer);
            }
        }
        b
    }
}

/// The branches of a factor, with G.
fn branches(graph: &mut Graph, upper: &[Vec<Edge>]) -> Vec<Branch> {
    let zero = graph.zero();
    let n = upper.len();
    let before = |c: usize| -> Vec<usize> { (0..c).filter(|&r| upper[r][c] != zero).collect() };
    let parents: Vec<Option<usize>> = (0..n).map(|c| before(c).last().copied()).collect();
    let children = |i: usize| parents.iter().filter(|parent| **parent == Some(i)).count();
    let mut found: Vec<Branch> = Vec::new();
    for c in 0..n {
        // A chain goes on where everything before its last velocity is before this one, too.
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
                // What is zero by chance for the first velocity of a branch may not be for others.
                let mut path = [path(&parents, c), before(c)].concat();
                path.sort_unstable();
                path.dedup();
                found.push(Branch {
                    own: vec![c],
                    before: path,
                    answers: Vec::new(),
                });
            }
        }
    }
    for branch in &mut found {
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

/// The velocities on the way from the root to one.
fn path(parents: &[Option<usize>], c: usize) -> Vec<usize> {
    let mut before = Vec::new();
    let mut at = parents[c];
    while let Some(i) = at {
        before.push(i);
        at = parents[i];
    }
    before
}
