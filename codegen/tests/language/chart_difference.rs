//! The displacement between two points of a coordinate: its slope is the documented factor, in both charts of
//! rotations.

use hamel_language::algebra::residue_pair::Random;
// The included file uses this name, too.
use hamel_language::model::layout;
use included::{chart_difference, chart_rate, turned};
use layout::{Block, rotation};

// Included, since searches for the nearest configuration only show final positions.
#[path = "../../language/src/model/chart_difference.rs"]
mod included;

/// The rate of the displacement between two points is the documented product, compared with differences.
#[test]
fn the_way_changes_as_its_factor_says() {
    let mut random = Random::new(5);
    let mut number = || (random.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
    for _ in 0..50 {
        let mut unit = || {
            let q: [f64; 4] = std::array::from_fn(|_| number());
            let length = q.iter().map(|e| e * e).sum::<f64>().sqrt();
            q.map(|e| e / length)
        };
        let (from, to, push) = (unit(), unit(), unit());
        let along: f64 = (0..4).map(|k| to[k] * push[k]).sum();
        let rate: [f64; 4] = std::array::from_fn(|k| push[k] - along * to[k]);
        let shifted = |h: f64| -> Vec<f64> {
            let q: [f64; 4] = std::array::from_fn(|k| to[k] + h * rate[k]);
            let length = q.iter().map(|e| e * e).sum::<f64>().sqrt();
            q.map(|e| e / length).to_vec()
        };
        let matrix = |q: &[f64]| rotation([q[0], q[1], q[2], q[3]], 2.0);
        let h = 1e-5;
        let turn = |q: &dyn Fn(f64) -> Vec<f64>, block, from: &[f64]| {
            let (ahead, behind) = (
                chart_difference(block, from, &q(h)).0,
                chart_difference(block, from, &q(-h)).0,
            );
            let slope: Vec<f64> = (0..3).map(|k| (ahead[k] - behind[k]) / (2.0 * h)).collect();
            let (a, b) = (q(h), q(-h));
            let x_dot: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (a - b) / (2.0 * h)).collect();
            let spin = chart_rate(block, &q(0.0), &x_dot);
            let factor = chart_difference(block, from, &q(0.0)).1;
            for k in 0..3 {
                let expected: f64 = (0..3).map(|l| factor[k][l] * spin[l]).sum();
                // The displacement is discontinuous at a rotation by π.
                let cut = (slope[k]).abs() > 1e3;
                assert!(cut || (slope[k] - expected).abs() < 1e-6 * (1.0 + expected.abs()));
            }
            chart_difference(block, from, &q(0.0)).0
        };
        let one = turn(&shifted, Block::Quaternion, &from);
        let other = turn(&|h| matrix(&shifted(h)), Block::Rotation, &matrix(&from));
        assert!(
            (0..3).all(|k| (one[k] - other[k]).abs() < 1e-9),
            "{one:?} {other:?}"
        );
    }
    assert_eq!(turned([1.0, 0.0, 0.0, 0.0]).0, [0.0; 3]);
}
