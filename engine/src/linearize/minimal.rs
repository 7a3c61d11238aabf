//! Minimal form of a linearisation with constraints: the independent displacements and velocities.
//!
//! Rows B h = 0 of position constraints, loops and prescribed coordinates leave the displacements h = T η. Rows
//! g = B(x) ξ + b = 0 of any kind leave δξ with B δξ = −(∂g/∂h) h, that is δξ = T δζ + S η. Hence
//! (h, δξ, δz) = L (η, δζ, δz), and the independent rows of A L and B are those of d/dt (η, δζ, δz), with n_q
//! displacements and d velocities: 2 d if all constraints act on position. The variables that the description names are
//! independent; elimination with the largest pivots at the state chooses the others.

use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::algebra::numeric::evaluate;
use hamel_codegen::algebra::slopes::slopes;
use hamel_codegen::generate::Generated;

use crate::state::State;

/// Pivots below this, in rows whose largest entry is 1, belong to dependent rows.
const PIVOT_TOLERANCE: f64 = 1e-8;

/// Rows smaller than the largest by this factor vanish at the state: they consist of rounding errors and are not scaled
/// to 1.
const ROW_TOLERANCE: f64 = 1e-6;

/// Independent part of (h, δξ, δz) under constraints.
pub struct Tangent {
    /// Indices of η, δζ and δz in (h, δξ, δz).
    pub kept: Vec<usize>,
    /// L, by rows.
    pub lift: Vec<Vec<f64>>,
}

/// Finds the independent part at a state; `None` if no constraint acts on displacements or is enforced by multipliers.
/// `frame` is A(x) by rows, along whose columns displacements are measured.
pub fn tangent(generated: &Generated, state: &State, frame: &[Vec<f64>]) -> Option<Tangent> {
    let (full, active) = (&generated.model, &generated.active);
    let time = full.clock.map(|clock| clock.xi);
    let places: Vec<usize> = (0..full.n()).filter(|&i| Some(i) != time).collect();
    let (n, na) = (places.len(), active.n());
    let named = |place: &usize| full.independent.iter().any(|(named, _)| named == place);
    // Velocities of the state, by their indices in the full frame.
    let solved = |place: &usize| {
        generated
            .solved
            .iter()
            .any(|(velocity, _)| velocity == place)
    };
    let moving: Vec<usize> = places.iter().copied().filter(|i| !solved(i)).collect();
    let none = vec![0.0; full.n()];
    let numbers = full.numbers(&state.params, &state.x, &none, &state.u, &none);
    let holonomic = full.constraints.iter().filter(|row| row.is_holonomic());
    let displaced = holonomic.map(|constraint| -> Vec<f64> {
        let row: Vec<Edge> = places.iter().map(|&i| constraint.row[i]).collect();
        evaluate(&full.graph, &row, &numbers)
    });
    let spared: Vec<usize> = (0..n).filter(|&i| named(&places[i])).collect();
    let position = ReducedRows::new(displaced.collect(), n, &spared);
    if position.pivots.is_empty() && active.constraints.is_empty() {
        return None;
    }
    let free = position.free(n);
    let lift_h = position.lift(n, &free);
    // g and its derivatives along h, then along η.
    let numbers = active.numbers(&state.params, &state.x, &state.xi, &state.u, &vec![0.0; na]);
    let first = active.points.first;
    let directions: Vec<Vec<f64>> = (0..n)
        .map(|j| {
            let mut direction = vec![0.0; first];
            direction.extend(frame.iter().map(|row| row[j]));
            direction
        })
        .collect();
    let rows = active.constraints.iter().map(|constraint| {
        let mut entries = constraint.row.clone();
        entries.push(constraint.shift);
        let sloped = slopes(&active.graph, &entries, &numbers, &directions);
        let xi = state.xi[..na].iter().chain(&[1.0]);
        let along_h: Vec<f64> = (0..n)
            .map(|j| {
                let terms = sloped.iter().zip(xi.clone());
                terms.map(|(entry, xi)| entry.slope(j) * xi).sum()
            })
            .collect();
        let along = (0..free.len()).map(|k| {
            let terms = along_h
                .iter()
                .zip(&lift_h)
                .map(|(slope, row)| slope * row[k]);
            terms.sum::<f64>()
        });
        let row = sloped[..na].iter().map(|entry| entry.value);
        row.chain(along).collect()
    });
    let spared: Vec<usize> = (0..na).filter(|&i| named(&moving[i])).collect();
    let velocity = ReducedRows::new(rows.collect(), na, &spared);
    let free_v = velocity.free(na);
    let states = active.state_rates.len();
    let width = free.len() + free_v.len() + states;
    let mut lift: Vec<Vec<f64>> = Vec::new();
    for row in lift_h {
        lift.push([row, vec![0.0; width - free.len()]].concat());
    }
    for place in 0..na {
        let mut row = vec![0.0; width];
        match velocity.pivots.iter().find(|(_, column)| *column == place) {
            None => {
                let k = free_v.iter().position(|free| *free == place);
                k.into_iter().for_each(|k| row[free.len() + k] = 1.0);
            }
            Some((found, _)) => {
                let given = &velocity.rows[*found];
                for k in 0..free.len() {
                    row[k] = -given[na + k];
                }
                for (k, &column) in free_v.iter().enumerate() {
                    row[free.len() + k] = -given[column];
                }
            }
        }
        lift.push(row);
    }
    for state in 0..states {
        let mut row = vec![0.0; width];
        row[free.len() + free_v.len() + state] = 1.0;
        lift.push(row);
    }
    let velocities = free_v.iter().map(|place| n + place);
    let behind = (0..states).map(|state| n + na + state);
    Some(Tangent {
        kept: free
            .iter()
            .copied()
            .chain(velocities)
            .chain(behind)
            .collect(),
        lift,
    })
}

impl Tangent {
    /// Returns the independent rows of a matrix, times L.
    pub fn of_square(&self, rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let kept: Vec<Vec<f64>> = self.kept.iter().map(|&row| rows[row].clone()).collect();
        self.of_columns(&kept)
    }

    /// Returns a matrix times L.
    pub fn of_columns(&self, rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let entry = |row: &[f64], column: usize| -> f64 {
            let terms = row.iter().zip(&self.lift);
            terms.map(|(a, lift)| a * lift[column]).sum()
        };
        let columns = self.kept.len();
        let lifted = rows
            .iter()
            .map(|row| (0..columns).map(|k| entry(row, k)).collect());
        lifted.collect()
    }

    /// Returns the independent entries of a list.
    pub fn of_list<T: Clone>(&self, list: &[T]) -> Vec<T> {
        self.kept.iter().map(|&place| list[place].clone()).collect()
    }
}

/// Rows after elimination: each pivot is 1, and all other entries of its column are 0.
struct ReducedRows {
    rows: Vec<Vec<f64>>,
    /// Rows and columns of the pivots.
    pivots: Vec<(usize, usize)>,
}

impl ReducedRows {
    /// Eliminates with the largest pivots among the first n columns, taking `spared` columns only if there is no other.
    fn new(mut rows: Vec<Vec<f64>>, n: usize, spared: &[usize]) -> Self {
        let size = |row: &Vec<f64>| row[..n].iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        let largest = rows.iter().map(size).fold(0.0, f64::max);
        for row in &mut rows {
            let most = size(row).max(ROW_TOLERANCE * largest);
            if most > 0.0 {
                row.iter_mut().for_each(|entry| *entry /= most);
            }
        }
        let mut pivots: Vec<(usize, usize)> = Vec::new();
        loop {
            let largest = |spare: bool| {
                let mut best = (PIVOT_TOLERANCE, None);
                for (i, row) in rows.iter().enumerate() {
                    if pivots.iter().any(|(used, _)| *used == i) {
                        continue;
                    }
                    for (j, entry) in row[..n].iter().enumerate() {
                        if entry.abs() > best.0 && (spare || !spared.contains(&j)) {
                            best = (entry.abs(), Some((i, j)));
                        }
                    }
                }
                best.1
            };
            let Some((i, j)) = largest(false).or_else(|| largest(true)) else {
                return ReducedRows { rows, pivots };
            };
            let pivot = rows[i][j];
            rows[i].iter_mut().for_each(|entry| *entry /= pivot);
            let by = rows[i].clone();
            for (other, row) in rows.iter_mut().enumerate() {
                let factor = row[j];
                if other != i && factor != 0.0 {
                    let pairs = row.iter_mut().zip(&by);
                    pairs.for_each(|(entry, by)| *entry -= factor * by);
                }
            }
            pivots.push((i, j));
        }
    }

    /// Returns the columns without pivots.
    fn free(&self, n: usize) -> Vec<usize> {
        let pivot = |column: &usize| self.pivots.iter().any(|(_, pivot)| pivot == column);
        (0..n).filter(|column| !pivot(column)).collect()
    }

    /// Returns the matrix that gives the entries of all columns from those of the free ones, by rows.
    fn lift(&self, n: usize, free: &[usize]) -> Vec<Vec<f64>> {
        let row = |place: usize| -> Vec<f64> {
            match self.pivots.iter().find(|(_, column)| *column == place) {
                Some((row, _)) => free.iter().map(|&k| -self.rows[*row][k]).collect(),
                None => free
                    .iter()
                    .map(|&k| f64::from(u8::from(k == place)))
                    .collect(),
            }
        };
        (0..n).map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::ReducedRows;

    #[test]
    fn rows_that_follow_from_others_have_no_pivot() {
        let rows = vec![
            vec![1.0, 2.0, 0.0, 5.0],
            vec![2.0, 4.0, 1e-12, 10.0],
            vec![0.0, 0.0, 3.0, 6.0],
        ];
        let found = ReducedRows::new(rows.clone(), 3, &[]);
        assert_eq!(found.free(3), [0]);
        assert_eq!(found.lift(3, &[0]), [[1.0], [-0.5], [0.0]]);
        let spared = ReducedRows::new(rows, 3, &[1]);
        assert_eq!(spared.free(3), [1]);
    }

    #[test]
    fn what_rounding_leaves_of_a_row_is_no_pivot() {
        let rows = vec![vec![1.0, 0.0, 0.0], vec![0.0, 1e-17, -1e-16]];
        assert_eq!(ReducedRows::new(rows, 3, &[]).free(3), [1, 2]);
        let rows = vec![vec![1.0, 0.0], vec![0.0, 1e-9]];
        assert!(ReducedRows::new(rows, 2, &[]).free(2).is_empty());
    }
}
