//! Block-wise solution of small linear systems M X = B over the graph, where M has full column rank on the
//! constraint variety.
//!
//! A block is a set of at most four unknowns with as many equations that contain no other unsolved
//! unknowns. It is solved by its adjugate, so that its determinant is the only divisor. Blocks whose
//! determinant is constant at run time come first, then blocks with excess equations and a constant Gram
//! matrix, then the whole remaining system if its Gram matrix is constant. Blocks with a varying
//! determinant are used only if it does not vanish at the start. The rest is solved with the Gram matrix
//! MᵀM, which is singular only where M is.

use super::graph::{Edge, Graph};
use super::linear::{multiply, solve_symmetric, transpose};
use super::numeric::rank;

/// Largest number of unknowns of a block that is solved by its adjugate.
const MAX_ADJUGATE_SIZE: usize = 4;
/// Largest number of sets of unknowns considered as blocks.
const MAX_COLUMN_SETS: usize = 6000;
/// Largest number of choices of equations tried for a set of unknowns.
const MAX_ROW_CHOICES: usize = 40;
/// Threshold below which a determinant, relative to the product of its row norms, counts as zero at the
/// start.
const DETERMINANT_TOLERANCE: f64 = 1e-7;

/// Function that evaluates expressions at the start configuration.
pub type StartValues<'a> = dyn Fn(&Graph, &[Edge]) -> Vec<f64> + 'a;

/// Solution X of a linear system, with the divisors that were used.
#[derive(Clone, Debug)]
pub struct Solution {
    /// X, one row per unknown.
    pub x: Vec<Vec<Edge>>,
    /// Divisors that vary with the coordinates, with signs chosen such that they are positive at the start,
    /// if that is given.
    pub pivots: Vec<Edge>,
    /// Divisors that depend on parameters only.
    pub constants: Vec<Edge>,
}

/// Reason why a system has no solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Unknowns that are not determined at generic points, by their indices.
    Undetermined(Vec<usize>),
    /// The system is singular at the start, though not in general.
    SingularStart,
}

/// Solves M X = B.
///
/// If `start` is `None`, divisors may vanish somewhere; this suits results that are only evaluated at
/// generic points.
pub fn solve(
    graph: &mut Graph,
    m: &[Vec<Edge>],
    b: &[Vec<Edge>],
    start: Option<&StartValues>,
) -> Result<Solution, Failure> {
    let unknowns = m.first().map_or(0, Vec::len);
    let undetermined = undetermined(graph, m, unknowns);
    if !undetermined.is_empty() {
        return Err(Failure::Undetermined(undetermined));
    }
    let mut system = System {
        graph,
        m,
        b,
        start,
        solved: vec![None; unknowns],
        used: vec![false; m.len()],
        pivots: Vec::new(),
        constants: Vec::new(),
    };
    while system.solved.iter().any(Option::is_none) {
        system.step()?;
    }
    Ok(Solution {
        x: system.solved.into_iter().flatten().collect(),
        pivots: system.pivots,
        constants: system.constants,
    })
}

/// Returns the unknowns that the system does not determine: those whose column can be removed without
/// changing the rank of M.
fn undetermined(graph: &Graph, m: &[Vec<Edge>], unknowns: usize) -> Vec<usize> {
    let without = |left_out: Option<usize>| {
        let row = |row: &Vec<Edge>| {
            let kept = row.iter().enumerate().filter(|(j, _)| Some(*j) != left_out);
            kept.map(|(_, &edge)| graph.value(edge)).collect()
        };
        rank(m.iter().map(row).collect())
    };
    let whole = without(None);
    if whole == unknowns {
        return Vec::new();
    }
    (0..unknowns)
        .filter(|&j| without(Some(j)) == whole)
        .collect()
}

/// State of the elimination.
struct System<'a> {
    graph: &'a mut Graph,
    m: &'a [Vec<Edge>],
    b: &'a [Vec<Edge>],
    start: Option<&'a StartValues<'a>>,
    solved: Vec<Option<Vec<Edge>>>,
    used: Vec<bool>,
    pivots: Vec<Edge>,
    constants: Vec<Edge>,
}

/// Equations and unknowns that are solved together.
#[derive(Clone, Debug)]
struct Block {
    rows: Vec<usize>,
    columns: Vec<usize>,
    determinant: Edge,
}

impl System<'_> {
    fn step(&mut self) -> Result<(), Failure> {
        let sets = self.sets();
        if let Some(block) = self.constant_block(&sets) {
            return self.adjugate(&block).ok_or(Failure::SingularStart);
        }
        for columns in &sets {
            let rows = self.rows_within(columns);
            if rows.len() > columns.len() && self.gram(&rows, columns, true).is_some() {
                return Ok(());
            }
        }
        let open: Vec<usize> = self.open().collect();
        let rows = self.rows_within(&open);
        if self.gram(&rows, &open, true).is_some() {
            return Ok(());
        }
        if self.start.is_some()
            && let Some(block) = self.varying_block(&sets)
        {
            return self.adjugate(&block).ok_or(Failure::SingularStart);
        }
        self.gram(&rows, &open, false).ok_or(Failure::SingularStart)
    }

    fn open(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.solved.len()).filter(|&j| self.solved[j].is_none())
    }

    /// Returns the unsolved unknowns of an equation.
    fn support(&self, row: usize) -> Vec<usize> {
        let zero = self.graph.zero();
        self.open().filter(|&j| self.m[row][j] != zero).collect()
    }

    /// Returns candidate sets of unknowns for blocks, small ones first: unions of the supports of
    /// equations.
    fn sets(&self) -> Vec<Vec<usize>> {
        let mut supports: Vec<Vec<usize>> = (0..self.m.len())
            .filter(|&row| !self.used[row])
            .map(|row| self.support(row))
            .filter(|support| (1..=MAX_ADJUGATE_SIZE).contains(&support.len()))
            .collect();
        supports.sort_by_key(|support| (support.len(), support.clone()));
        supports.dedup();
        let mut sets = supports.clone();
        let mut next = 0;
        while next < sets.len() && sets.len() < MAX_COLUMN_SETS {
            for support in &supports {
                let mut union = sets[next].clone();
                union.extend(support);
                union.sort_unstable();
                union.dedup();
                if union.len() <= MAX_ADJUGATE_SIZE && !sets.contains(&union) {
                    sets.push(union);
                }
            }
            next += 1;
        }
        sets.sort_by_key(|set| (set.len(), set.clone()));
        sets
    }

    /// Returns the unused equations whose unsolved unknowns are all in `columns`.
    fn rows_within(&self, columns: &[usize]) -> Vec<usize> {
        (0..self.m.len())
            .filter(|&row| !self.used[row])
            .filter(|&row| {
                let support = self.support(row);
                !support.is_empty() && support.iter().all(|j| columns.contains(j))
            })
            .collect()
    }

    /// Returns the square blocks of a set of unknowns, without those whose determinant vanishes on the
    /// constraint variety.
    fn blocks(&mut self, columns: &[usize]) -> Vec<Block> {
        let rows = self.rows_within(columns);
        let mut found = Vec::new();
        for rows in choices(&rows, columns.len()) {
            let part: Vec<Vec<Edge>> = rows.iter().map(|&i| pick(&self.m[i], columns)).collect();
            let determinant = determinant(self.graph, &part);
            if determinant.abs() != self.graph.zero() {
                found.push(Block {
                    rows,
                    columns: columns.to_vec(),
                    determinant,
                });
            }
        }
        found
    }

    /// Picks the block with the simplest constant determinant: a number is preferred to an expression in
    /// parameters, and few unknowns to many.
    fn constant_block(&mut self, sets: &[Vec<usize>]) -> Option<Block> {
        let mut of_parameters = None;
        for columns in sets {
            for block in self.blocks(columns) {
                if self.graph.as_rational(block.determinant).is_some() {
                    return Some(block);
                }
                if self.graph.is_free(block.determinant.node()) && of_parameters.is_none() {
                    of_parameters = Some(block);
                }
            }
        }
        of_parameters
    }

    /// Picks the smallest block that is regular at the start; of several, the one farthest from being
    /// singular there.
    fn varying_block(&mut self, sets: &[Vec<usize>]) -> Option<Block> {
        let start = self.start?;
        let mut best: Option<(f64, Block)> = None;
        for columns in sets {
            if let Some((_, best)) = &best
                && best.columns.len() < columns.len()
            {
                break;
            }
            for block in self.blocks(columns) {
                let value = start(self.graph, &[block.determinant])[0].abs();
                let lengths = block.rows.iter().map(|&row| {
                    let numbers = start(self.graph, &pick(&self.m[row], columns));
                    numbers.iter().map(|x| x * x).sum::<f64>().sqrt()
                });
                let relative = value / lengths.product::<f64>();
                if relative > DETERMINANT_TOLERANCE
                    && best.as_ref().is_none_or(|(most, _)| relative > *most)
                {
                    best = Some((relative, block));
                }
            }
        }
        best.map(|(_, block)| block)
    }

    /// Returns the right-hand side of an equation, with the terms of solved unknowns moved to it.
    fn right(&mut self, row: usize) -> Vec<Edge> {
        let mut right = self.b[row].clone();
        for (j, known) in self.solved.iter().enumerate() {
            let factor = self.m[row][j];
            if let Some(known) = known
                && factor != self.graph.zero()
            {
                for (entry, &value) in right.iter_mut().zip(known) {
                    let product = self.graph.mul(factor, value);
                    *entry = self.graph.sub(*entry, product);
                }
            }
        }
        right
    }

    /// Solves a square block: X = adj(M) B / det M.
    fn adjugate(&mut self, block: &Block) -> Option<()> {
        let part: Vec<Vec<Edge>> = block
            .rows
            .iter()
            .map(|&row| pick(&self.m[row], &block.columns))
            .collect();
        let right: Vec<Vec<Edge>> = block.rows.iter().map(|&row| self.right(row)).collect();
        let inverse = self.divisor(block.determinant)?;
        for (j, &column) in block.columns.iter().enumerate() {
            let cofactors: Vec<Edge> = (0..part.len())
                .map(|i| cofactor(self.graph, &part, i, j))
                .collect();
            let numerators: Vec<Edge> = (0..right[0].len())
                .map(|k| {
                    let entries: Vec<Edge> = right.iter().map(|row| row[k]).collect();
                    self.graph.dot(&cofactors, &entries)
                })
                .collect();
            let values = numerators.into_iter().map(|n| self.graph.mul(inverse, n));
            self.solved[column] = Some(values.collect());
        }
        block.rows.iter().for_each(|&row| self.used[row] = true);
        Some(())
    }

    /// Returns 1/d, and records d as a divisor.
    fn divisor(&mut self, d: Edge) -> Option<Edge> {
        if self.graph.as_rational(d).is_none() {
            if self.graph.is_free(d.node()) {
                self.constants.push(d);
            } else {
                let negative = self
                    .start
                    .is_some_and(|start| start(self.graph, &[d])[0] < 0.0);
                self.pivots.push(d.signed(negative));
            }
        }
        self.graph.div(self.graph.one(), d)
    }

    /// Solves with a Gram matrix: MᵀM X = MᵀB, or X = Mᵀ(M Mᵀ)⁻¹ B if M is square. If `constant` is set but
    /// the Gram matrix varies at run time, changes nothing and returns `None`.
    fn gram(&mut self, rows: &[usize], columns: &[usize], constant: bool) -> Option<()> {
        let part: Vec<Vec<Edge>> = rows.iter().map(|&i| pick(&self.m[i], columns)).collect();
        let turned = transpose(&part);
        let square = rows.len() == columns.len();
        let gram = match square {
            true => multiply(self.graph, &part, &turned),
            false => multiply(self.graph, &turned, &part),
        };
        let free = |edge: &Edge| self.graph.is_free(edge.node());
        if constant && !gram.iter().flatten().all(free) {
            return None;
        }
        let right: Vec<Vec<Edge>> = rows.iter().map(|&row| self.right(row)).collect();
        let solution = if square {
            let multipliers = solve_symmetric(self.graph, &gram, &right)?;
            multiply(self.graph, &turned, &multipliers)
        } else {
            let projected = multiply(self.graph, &turned, &right);
            solve_symmetric(self.graph, &gram, &projected)?
        };
        let determinant = symmetric_pivots(self.graph, &gram)?;
        for pivot in determinant {
            self.divisor(pivot)?;
        }
        for (&column, values) in columns.iter().zip(solution) {
            self.solved[column] = Some(values);
        }
        rows.iter().for_each(|&row| self.used[row] = true);
        Some(())
    }
}

/// Returns the pivots of Gaussian elimination without row exchanges; `None` if one vanishes on the
/// constraint variety.
fn symmetric_pivots(graph: &mut Graph, a: &[Vec<Edge>]) -> Option<Vec<Edge>> {
    let mut a = a.to_vec();
    let mut pivots = Vec::new();
    for k in 0..a.len() {
        pivots.push(a[k][k]);
        for i in k + 1..a.len() {
            let factor = graph.div(a[i][k], a[k][k])?;
            for j in k + 1..a.len() {
                let product = graph.mul(factor, a[k][j]);
                a[i][j] = graph.sub(a[i][j], product);
            }
        }
    }
    Some(pivots)
}

fn pick(row: &[Edge], columns: &[usize]) -> Vec<Edge> {
    columns.iter().map(|&j| row[j]).collect()
}

/// Returns the subsets of `rows` of this size, in order; at most `MAX_ROW_CHOICES` of them.
fn choices(rows: &[usize], size: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 0..size {
        all = all
            .into_iter()
            .flat_map(|head| {
                let last = head.last().copied();
                let later = rows
                    .iter()
                    .filter(move |&&row| last.is_none_or(|l| row > l));
                later
                    .map(|&row| [head.as_slice(), &[row]].concat())
                    .collect::<Vec<_>>()
            })
            .take(MAX_ROW_CHOICES * size)
            .collect();
    }
    all.truncate(MAX_ROW_CHOICES);
    all
}

/// det M by expansion along the first row.
fn determinant(graph: &mut Graph, m: &[Vec<Edge>]) -> Edge {
    let Some(first) = m.first() else {
        return graph.one();
    };
    let mut sum = graph.zero();
    for (j, &entry) in first.iter().enumerate() {
        if entry != graph.zero() {
            let minor = cofactor(graph, m, 0, j);
            let product = graph.mul(entry, minor);
            sum = graph.add(sum, product);
        }
    }
    sum
}

/// (−1)^(i+j) times the minor without row i and column j.
fn cofactor(graph: &mut Graph, m: &[Vec<Edge>], i: usize, j: usize) -> Edge {
    let rest: Vec<Vec<Edge>> = m
        .iter()
        .enumerate()
        .filter(|(row, _)| *row != i)
        .map(|(_, row)| {
            let kept = row.iter().enumerate().filter(|(column, _)| *column != j);
            kept.map(|(_, &entry)| entry).collect()
        })
        .collect();
    determinant(graph, &rest).signed((i + j) % 2 == 1)
}
