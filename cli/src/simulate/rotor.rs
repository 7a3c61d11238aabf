//! The angular momentum of a single body, and whether the body is nearly free, for Poinsot's construction.

use hamel::{Block, System};
use hamel_engine::mechanism::{Instance, Numbers};
use hamel_engine::run::Sample;
use hamel_report::plot::Poinsot;
use nalgebra::{DMatrix, DVector, Matrix3};

/// Largest relative change of |P| for a body that is nearly free.
const NEARLY: f64 = 0.05;
/// Relative rounding error of an inertia.
const ROUNDING: f64 = 1e-9;

/// Poinsot's construction of a run, if exactly one coordinate is an attitude, T = ½ ωᵀJω + (the rest) with
/// a constant J in body axes, and |P| of P = J ω is nearly constant.
pub fn poinsot(system: &Instance, track: &[Sample]) -> Option<Poinsot> {
    let row = attitude(system.blocks())?;
    let (first, last) = (track.first()?, track.last()?);
    let middle = track.get(track.len() / 2)?;
    let inertia = inertia(system, first, row)?;
    for sample in [middle, last] {
        let other = self::inertia(system, sample, row)?;
        if (other - inertia).amax() > ROUNDING * inertia.amax() {
            return None;
        }
    }
    let of = |x: &[f64], xi: &[f64]| system.chart_rate(&x.into(), &xi.into());
    let momenta: Vec<[f64; 3]> = track
        .iter()
        .map(|sample| {
            let rate = DVector::from_column_slice(&of(&sample.x, &sample.xi));
            (inertia * rate.fixed_rows::<3>(row)).into()
        })
        .collect();
    let size = |p: &[f64; 3]| p.iter().map(|v| v * v).sum::<f64>().sqrt();
    let first = momenta.first().map(size)?;
    let kept = momenta
        .iter()
        .all(|p| (size(p) - first).abs() <= NEARLY * first);
    (kept && first > 0.0).then(|| Poinsot {
        momenta,
        inertia: inertia.transpose().into(),
    })
}

/// Returns the row of the only attitude in the chart.
fn attitude(blocks: &[Block]) -> Option<usize> {
    let (mut row, mut found) = (0, None);
    for block in blocks {
        if matches!(block, Block::Quaternion | Block::Rotation) {
            if found.is_some() {
                return None;
            }
            found = Some(row);
        }
        row += block.chart();
    }
    found
}

/// J of T in the rates of the chart, C⁻ᵀ M C⁻¹, if the attitude is decoupled from the rest.
fn inertia(system: &Instance, at: &Sample, row: usize) -> Option<Matrix3<f64>> {
    let n = at.xi.len();
    let columns = |of: &dyn Fn(&Numbers) -> Numbers| -> Vec<DVector<f64>> {
        let basis = |j: usize| {
            let mut basis = Numbers::filled(0.0, n);
            basis.as_mut()[j] = 1.0;
            basis
        };
        let column = |j: usize| DVector::from_column_slice(&of(&basis(j)));
        (0..n).map(column).collect()
    };
    let x = Numbers::from(at.x.as_slice());
    let rates = DMatrix::from_columns(&columns(&|xi| system.chart_rate(&x, xi)));
    let mass = DMatrix::from_columns(&columns(&|xi| system.momentum(&at.x, xi)));
    if rates.nrows() != n || mass.nrows() != n {
        return None;
    }
    let inverse = rates.try_inverse()?;
    let mass = inverse.transpose() * mass * inverse;
    let inertia: Matrix3<f64> = mass.fixed_view::<3, 3>(row, row).into_owned();
    let within = |i: usize| (row..row + 3).contains(&i);
    for i in (0..n).filter(|&i| !within(i)) {
        for j in row..row + 3 {
            if mass[(i, j)].abs() > ROUNDING * mass.amax() {
                return None;
            }
        }
    }
    Some(inertia)
}
