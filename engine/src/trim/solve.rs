//! Levenberg's and Marquardt's method for the conditions of a trim, by singular values, on the manifold of states.
//!
//! Rows are divided by the largest slopes met so far, and columns likewise, so that units do not matter. Without damping
//! a step is the one of least norm; damping follows the success of steps. After the conditions are met to the
//! tolerance, steps go on until rounding errors stop them.

use super::conditions::{Conditions, Local, Point};
use super::problem::{TrimProblem, Unmet};
use hamel_codegen::algebra::dense::largest;
use hamel_codegen::algebra::residue_pair::Random;
use nalgebra::{DMatrix, DVector, SVD};

/// Largest number of steps.
const MAX_STEPS: usize = 200;
/// Largest residual from which steps go on until rounding errors stop them, relative to the slopes of its row times the
/// sizes of the unknowns.
pub const POLISHED_RESIDUAL: f64 = 1e-9;
/// Largest residual of a solution, likewise.
const RESIDUAL_TOLERANCE: f64 = 1e-11;
/// Residual that is always small enough.
const ABSOLUTE_TOLERANCE: f64 = 1e-12;
/// Singular values below this, relative to the largest, are those of a matrix of lower rank.
pub const RANK_TOLERANCE: f64 = 1e-7;
/// Damping of the first step, relative to the squared largest singular value.
const FIRST_DAMPING: f64 = 1e-4;
/// Damping at which steps are too short to help.
const MAX_DAMPING: f64 = 1e12;
/// Damping that is replaced by 0.
const MIN_DAMPING: f64 = 1e-13;
/// Displacement to neighbours of a solution, relative to 1 or to the unknown.
const PROBE: f64 = 0.1;
/// Largest residual of a solution beside those of its neighbours.
const PROBED_PART: f64 = 1e-7;
/// Residual that is not compared with those of neighbours.
const LEAST_PROBED: f64 = 1e-10;
/// Largest number of neighbours of a start that are tried.
const MAX_NEIGHBOURS: usize = 24;
/// Largest number of neighbours times unknowns.
const NEIGHBOUR_BUDGET: usize = 240;
/// Largest change of each unknown from the start to a neighbour, relative to 1 or to the unknown.
const MAX_DISTANCE: f64 = 2.5;
/// Largest displacement of a step (rad, m), relative to 1 + the largest coordinate.
const MAX_DISPLACEMENT: f64 = 0.3;
/// Rows below this, relative to others of their kind, are not scaled up.
const NOISE: f64 = 1e-6;
/// Columns of displacements and velocities below this, relative to the largest, are not scaled up: their units are
/// comparable, unlike those of inputs.
const MECHANICAL_PART: f64 = 0.1;
/// Damping that leaves out directions in which conditions hardly change.
const POLISHING_DAMPING: f64 = 1e-8;
/// Longest step from a solution, relative to 1 or to the unknown.
const MAX_LAST_STEP: f64 = 1e-3;
/// Scaled residual that is not worth a step.
const LEAST_RESIDUAL: f64 = 1e-30;
/// Largest number of steps after a solution is found.
const MAX_POLISHING_STEPS: usize = 30;
/// Ratio of the residuals after and before a step at which only rounding errors are left.
const STAGNATION_RATIO: f64 = 0.9;
/// Reduction of residuals, in each of `MAX_SLOW_STEPS` steps, at which they count as a minimum.
const LEAST_REDUCTION: f64 = 1e-5;
const MAX_SLOW_STEPS: usize = 8;
/// Conditions that are named as unmet have at least this part of the largest residual.
const NAMED_PART: f64 = 0.1;

/// Largest slopes of the rows and columns met so far, by their numbers.
pub struct Scales {
    rows: Vec<f64>,
    columns: Vec<f64>,
    /// Numbers of rows of rates, and of rates with their derivatives.
    kinds: [usize; 2],
    /// Number of columns of displacements and velocities.
    mechanical: usize,
}

/// Scaled Jacobian with its singular values and the scaled residuals.
pub struct Factored {
    pub svd: SVD<f64, nalgebra::Dyn, nalgebra::Dyn>,
    residuals: DVector<f64>,
    /// Units of the unknowns.
    pub units: Vec<f64>,
}

/// Solution of the conditions.
pub struct Solution {
    pub point: Point,
    pub local: Local,
    pub steps: usize,
    /// The conditions at neighbours of the point.
    pub probes: Vec<Local>,
}

impl Scales {
    pub fn new(conditions: &Conditions) -> Self {
        let [nh, na, nz] = conditions.sizes;
        Scales {
            mechanical: nh + na,
            rows: vec![0.0; 2 * (na + nz)],
            columns: vec![0.0; conditions.names.len()],
            kinds: [na + nz, 2 * (na + nz)],
        }
    }

    /// Takes the slopes of another point into account.
    pub fn meet(&mut self, local: &Local) {
        let most = local.rows.iter().max().map_or(0, |row| row + 1);
        self.rows.resize(most.max(self.rows.len()), 0.0);
        for (&row, slopes) in local.rows.iter().zip(&local.jacobian) {
            let norm = slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt();
            self.rows[row] = self.rows[row].max(norm);
        }
        for (k, &column) in local.columns.iter().enumerate() {
            let scaled = local.rows.iter().zip(&local.jacobian);
            let squares = scaled.map(|(&row, slopes)| (slopes[k] / self.row(row)).powi(2));
            self.columns[column] = self.columns[column].max(squares.sum::<f64>().sqrt());
        }
    }

    /// Scale of a row. Rows much smaller than others of their kind consist of rounding errors, and so do derivatives of
    /// rates that are much smaller than slopes of rates.
    fn row(&self, row: usize) -> f64 {
        let [rates, derivatives] = self.kinds;
        let of_rates = largest(&self.rows[..rates]);
        let least = match row {
            row if row < rates => NOISE * of_rates,
            row if row < derivatives => of_rates,
            _ => NOISE * largest(&self.rows[derivatives..]),
        };
        positive(self.rows[row].max(least))
    }

    fn column(&self, column: usize) -> f64 {
        let noise = if column < self.mechanical {
            MECHANICAL_PART
        } else {
            NOISE * NOISE
        };
        positive(self.columns[column].max(noise * largest(&self.columns)))
    }

    /// Residuals divided by the slopes of their rows.
    fn residuals(&self, local: &Local) -> DVector<f64> {
        let scaled = local.rows.iter().zip(&local.residuals);
        DVector::from_iterator(local.rows.len(), scaled.map(|(&row, r)| r / self.row(row)))
    }

    /// Factors the scaled Jacobian; `None` if the algorithm does not converge.
    pub fn factor(&self, local: &Local) -> Option<Factored> {
        let units: Vec<f64> = local
            .columns
            .iter()
            .map(|&k| 1.0 / self.column(k))
            .collect();
        let (rows, columns) = (local.rows.len(), units.len());
        // Rows of zeros make all right singular vectors appear.
        let matrix = DMatrix::from_fn(rows.max(columns), columns, |i, j| match i < rows {
            true => local.jacobian[i][j] * units[j] / self.row(local.rows[i]),
            false => 0.0,
        });
        let residuals = self
            .residuals(local)
            .resize_vertically(rows.max(columns), 0.0);
        let svd = SVD::try_new(matrix, true, true, f64::EPSILON, 10_000)?;
        Some(Factored {
            svd,
            residuals,
            units,
        })
    }
}

fn positive(size: f64) -> f64 {
    if size > 0.0 { size } else { 1.0 }
}

impl Factored {
    /// Returns the damped step in the unknowns, of least norm among the best ones.
    pub fn step(&self, damping: f64) -> Vec<f64> {
        let values = &self.svd.singular_values;
        let most = values.amax();
        let (Some(u), Some(v)) = (&self.svd.u, &self.svd.v_t) else {
            return vec![0.0; self.units.len()];
        };
        let mut step = DVector::zeros(self.units.len());
        for (i, &value) in values
            .iter()
            .enumerate()
            .filter(|(_, v)| **v > RANK_TOLERANCE * most)
        {
            let part =
                u.column(i).dot(&self.residuals) * value / (value * value + damping * most * most);
            step.axpy(-part, &v.row(i).transpose(), 1.0);
        }
        step.iter()
            .zip(&self.units)
            .map(|(step, unit)| step * unit)
            .collect()
    }
}

impl Local {
    /// Returns whether all residuals are small, relative to slopes times sizes of unknowns.
    pub fn is_solved(&self, conditions: &Conditions, point: &Point, relative: f64) -> bool {
        let sizes: Vec<f64> = self
            .columns
            .iter()
            .map(|&k| conditions.size(&point.state, k))
            .collect();
        self.residuals
            .iter()
            .zip(&self.jacobian)
            .all(|(residual, slopes)| {
                let terms = slopes
                    .iter()
                    .zip(&sizes)
                    .map(|(slope, size)| (slope * size).abs());
                residual.abs() <= ABSOLUTE_TOLERANCE + relative * terms.sum::<f64>()
            })
    }

    /// Evaluates the conditions at two neighbours of a point, unless they have no value there.
    fn probes(&self, conditions: &Conditions, point: &Point) -> Vec<Local> {
        let sizes = self
            .columns
            .iter()
            .map(|&k| conditions.size(&point.state, k));
        let sizes: Vec<f64> = sizes.collect();
        let probes = [1.0, 2.0].into_iter().filter_map(|turn| {
            let steps = sizes.iter().zip(1_u32..);
            let step = steps.map(|(size, k)| PROBE * size * f64::sin(turn * f64::from(k)));
            let there = self.moved(conditions, point, &step.collect::<Vec<_>>())?;
            conditions.at(&there)
        });
        probes.collect()
    }

    /// Moves a point by a step in the unknowns.
    pub fn moved(&self, conditions: &Conditions, point: &Point, step: &[f64]) -> Option<Point> {
        let step: Vec<f64> = self
            .lift
            .iter()
            .map(|row| row.iter().zip(step).map(|(l, y)| l * y).sum())
            .collect();
        conditions.moved(point, &step, &self.kept)
    }
}

/// Finds the solution to which damped steps lead from a start or, failing that, from one of its neighbours; their
/// number is the second result, and errors are those of the start. Solutions have to be confirmed.
pub fn search(
    conditions: &Conditions,
    start: &Point,
    confirm: &dyn Fn(&Solution) -> Result<(), TrimProblem>,
) -> Result<(Solution, usize), TrimProblem> {
    let confirmed = |solution: Solution| confirm(&solution).map(|()| solution);
    let failure = match solve(conditions, start.clone()).and_then(confirmed) {
        Ok(solution) => return Ok((solution, 0)),
        Err(failure) => failure,
    };
    let local = conditions.at(start).ok_or(TrimProblem::NoStart)?;
    let mut random = Random::new(0x7472_696d);
    let mut number = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    let count = MAX_NEIGHBOURS.min(NEIGHBOUR_BUDGET / local.columns.len().max(1));
    for neighbour in 1..=count {
        let distance = MAX_DISTANCE * neighbour as f64 / count as f64;
        let sizes = local
            .columns
            .iter()
            .map(|&k| conditions.size(&start.state, k));
        let step: Vec<f64> = sizes.map(|size| distance * size * number()).collect();
        let there = local.moved(conditions, start, &step);
        if let Some(solution) =
            there.and_then(|there| solve(conditions, there).and_then(confirmed).ok())
        {
            return Ok((solution, neighbour));
        }
    }
    Err(failure)
}

/// Finds the solution to which damped steps lead from a point.
fn solve(conditions: &Conditions, start: Point) -> Result<Solution, TrimProblem> {
    let mut scales = Scales::new(conditions);
    let mut point = start;
    let mut local = conditions.at(&point).ok_or(TrimProblem::NoStart)?;
    let (mut damping, mut slow, mut leaves) = (FIRST_DAMPING, 0, false);
    let (mut steps, mut polished, mut found, mut polishing) = (0, 0, false, 0.0);
    scales.meet(&local);
    while steps < MAX_STEPS && damping <= MAX_DAMPING && slow < MAX_SLOW_STEPS {
        let Some(factored) = scales.factor(&local) else {
            break;
        };
        let before = factored.residuals.norm();
        // Residuals that vanish at infinity leave steps that do not become short.
        let whole = factored.step(0.0);
        let lengths = local.columns.iter().zip(&whole);
        let mut lengths = lengths.map(|(&k, h)| h.abs() / conditions.size(&point.state, k));
        found = local.is_solved(conditions, &point, POLISHED_RESIDUAL)
            && lengths.all(|h| h <= MAX_LAST_STEP);
        if found && (before <= LEAST_RESIDUAL || polished == MAX_POLISHING_STEPS) {
            break;
        }
        let mut step = if found {
            factored.step(polishing)
        } else {
            factored.step(damping)
        };
        let displaced = local
            .columns
            .iter()
            .zip(&step)
            .filter(|(k, _)| **k < conditions.sizes[0]);
        let size = displaced.fold(0.0, |most: f64, (_, h)| most.max(h.abs()));
        let most = MAX_DISPLACEMENT * (1.0 + largest(&point.state.x));
        let factor = (most / size).min(1.0);
        step.iter_mut().for_each(|entry| *entry *= factor);
        let next = local.moved(conditions, &point, &step);
        let next = next.and_then(|next| Some((conditions.at(&next)?, next)));
        leaves |= next.is_none();
        let after = next
            .as_ref()
            .map(|(local, _)| scales.residuals(local).norm());
        match (next, after) {
            (Some((there, next)), Some(after)) if after < before => {
                (local, point) = (there, next);
                scales.meet(&local);
                steps += 1;
                polished += usize::from(found);
                damping = if damping < MIN_DAMPING {
                    0.0
                } else {
                    damping * 0.1
                };
                let is_slow = after > (1.0 - LEAST_REDUCTION) * before;
                slow = if is_slow { slow + 1 } else { 0 };
                leaves &= is_slow;
                if found && after > STAGNATION_RATIO * before {
                    break;
                }
            }
            _ if found && polishing == 0.0 => polishing = POLISHING_DAMPING,
            _ if found => break,
            _ => damping = (damping * 10.0).max(FIRST_DAMPING),
        }
    }
    if found && local.is_solved(conditions, &point, RESIDUAL_TOLERANCE) {
        let probes = local.probes(conditions, &point);
        let beside = probes.iter().map(|probe| largest(&probe.residuals));
        let beside = beside.fold(0.0, f64::max);
        let residual = largest(&local.residuals);
        // Where slopes are infinite, residuals are small beside them only.
        if !probes.is_empty() && residual > f64::max(LEAST_PROBED, PROBED_PART * beside) {
            return Err(TrimProblem::SingularConfiguration { residual });
        }
        return Ok(Solution {
            point,
            local,
            steps,
            probes,
        });
    }
    if leaves {
        return Err(TrimProblem::LeavesDomain { steps });
    }
    let scaled = scales.residuals(&local);
    let worst = scaled.amax();
    let unmet = local.rows.iter().zip(&local.residuals).zip(&scaled);
    let mut unmet: Vec<_> = unmet
        .filter(|(_, scaled)| scaled.abs() >= NAMED_PART * worst)
        .collect();
    unmet.sort_by(|(_, a), (_, b)| b.abs().total_cmp(&a.abs()));
    let unmet = unmet.into_iter().map(|((&row, &residual), _)| Unmet {
        condition: conditions.name(row),
        residual,
    });
    Err(match steps < MAX_STEPS {
        true => TrimProblem::NoSolution {
            steps,
            unmet: unmet.collect(),
        },
        false => TrimProblem::OutOfSteps {
            steps,
            unmet: unmet.collect(),
        },
    })
}
