//! Eigenvalues of a general real matrix.
//!
//! States that influence one another form classes; ordering the classes makes the matrix block triangular, so that its
//! eigenvalues are those of the diagonal blocks. A displacement on which nothing depends is a separate block, with an
//! eigenvalue that is exactly zero instead of the square root of a rounding error. Blocks are balanced before the QR
//! algorithm.

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{DMatrix, DVector, Schur};

/// Iterations of the QR algorithm for each row before other axes are tried.
const MAX_ITERATIONS_PER_ROW: usize = 60;
/// Number of bases in which the algorithm is tried, beginning with the basis of the block. For systems at rest, whose
/// eigenvalues come in pairs ±λ, QR cycles on about one matrix in a hundred; in another basis it then converges.
const BASES: u64 = 12;
/// Random reflections that make up a change of basis.
const REFLECTIONS_PER_BASIS: usize = 4;
/// Deflation thresholds, in units of rounding; looser ones are tried where no basis leads to convergence.
const DEFLATION_THRESHOLDS: [f64; 4] = [1.0, 8.0, 64.0, 512.0];

/// Strategy for repeating the QR algorithm until it converges.
struct Strategy<'a> {
    /// Deflation thresholds, in units of rounding.
    thresholds: &'a [f64],
    /// Number of bases, beginning with the basis of the block.
    turns: u64,
    /// Limits on the iterations of the first attempts, where they differ from the default.
    most: &'a [usize],
}

/// Returns real and imaginary parts of the eigenvalues, the fastest growing first; `None` if the QR algorithm does not
/// converge. The entries have to be finite.
pub fn eigenvalues(rows: &[Vec<f64>]) -> Option<Vec<(f64, f64)>> {
    let strategy = Strategy {
        thresholds: &DEFLATION_THRESHOLDS,
        turns: BASES,
        most: &[],
    };
    eigenvalues_by(rows, &strategy)
}

fn eigenvalues_by(rows: &[Vec<f64>], strategy: &Strategy) -> Option<Vec<(f64, f64)>> {
    let mut values = Vec::with_capacity(rows.len());
    for class in classes(rows) {
        if let [only] = class.as_slice() {
            values.push((rows[*only][*only], 0.0));
        } else {
            let block = DMatrix::from_fn(class.len(), class.len(), |i, j| rows[class[i]][class[j]]);
            values.extend(of_block(block, strategy)?);
        }
    }
    values.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)));
    Some(values)
}

/// Returns the classes of states that influence one another, directly or through others.
fn classes(rows: &[Vec<f64>]) -> Vec<Vec<usize>> {
    let n = rows.len();
    let mut reaches: Vec<Vec<bool>> = (0..n)
        .map(|i| (0..n).map(|j| i == j || rows[i][j] != 0.0).collect())
        .collect();
    for k in 0..n {
        for i in 0..n {
            for j in 0..n {
                reaches[i][j] |= reaches[i][k] && reaches[k][j];
            }
        }
    }
    let mut open: Vec<usize> = (0..n).collect();
    let mut classes = Vec::new();
    while let Some(&first) = open.first() {
        let (class, rest) = open
            .into_iter()
            .partition(|&other| reaches[first][other] && reaches[other][first]);
        classes.push(class);
        open = rest;
    }
    classes
}

fn of_block(mut block: DMatrix<f64>, strategy: &Strategy) -> Option<Vec<(f64, f64)>> {
    // Balancing squares the entries. A power of two changes no digit; it is split into two factors since it may
    // overflow.
    let exponent = block.amax().log2().floor() as i32;
    let halves = [exponent / 2, exponent - exponent / 2].map(|half| 2.0_f64.powi(half));
    block.apply(|entry| *entry = *entry / halves[0] / halves[1]);
    balance_parlett_reinsch(&mut block);
    let n = block.nrows();
    let thresholds = strategy.thresholds.iter();
    let attempts =
        thresholds.flat_map(|&threshold| (0..strategy.turns).map(move |turn| (threshold, turn)));
    attempts.enumerate().find_map(|(count, (threshold, turn))| {
        let most = strategy
            .most
            .get(count)
            .copied()
            .unwrap_or(MAX_ITERATIONS_PER_ROW * n);
        let schur = Schur::try_new(reflect(&block, turn), threshold * f64::EPSILON, most)?;
        let values = schur.complex_eigenvalues();
        let scaled = |part: f64| part * halves[0] * halves[1];
        let values: Vec<(f64, f64)> = (values.iter())
            .map(|value| (scaled(value.re), scaled(value.im)))
            .collect();
        values
            .iter()
            .all(|(re, im)| re.is_finite() && im.is_finite())
            .then_some(values)
    })
}

/// H A Hᵀ, similar to A, with H a product of reflections I − 2 v vᵀ / |v|²; A itself for turn 0.
fn reflect(block: &DMatrix<f64>, turn: u64) -> DMatrix<f64> {
    let mut turned = block.clone();
    let mut state = turn;
    for _ in 0..if turn > 0 { REFLECTIONS_PER_BASIS } else { 0 } {
        let v = DVector::from_fn(block.nrows(), |_, _| {
            // Steele and Vigna (2021).
            state = state.wrapping_mul(0xf135_7aea_2e62_a9c5).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        });
        let w = &v * (2.0 / v.norm_squared());
        let rows = v.transpose() * &turned;
        turned -= &w * rows;
        let columns = &turned * &v;
        turned -= columns * w.transpose();
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::{BASES, DEFLATION_THRESHOLDS, Strategy, eigenvalues, eigenvalues_by};

    /// Pseudorandom numbers between −1 and 1.
    fn numbers(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as f64 / (1u64 << 30) as f64 - 1.0
        }
    }

    /// Oscillators of any frequency: ±i ω.
    #[test]
    fn frequencies_of_all_magnitudes() {
        for exponent in [-300, -160, -20, 0, 20, 155, 160, 300] {
            let stiffness = 10.0_f64.powi(exponent);
            let rows = vec![vec![0.0, 1.0], vec![-stiffness, 0.0]];
            let values = eigenvalues(&rows).expect("converges");
            for (value, sign) in values.iter().zip([1.0, -1.0]) {
                assert_eq!(value.0, 0.0);
                let omega = sign * stiffness.sqrt();
                assert!((value.1 / omega - 1.0).abs() < 1e-14, "{value:?} {omega:e}");
            }
        }
    }

    /// Asserts that sum and sum of squares of the eigenvalues are the traces of A and A².
    fn assert_traces(rows: &[Vec<f64>]) {
        let values = eigenvalues(rows).expect("converges");
        assert_eq!(values.len(), rows.len());
        let n = rows.len();
        let trace: f64 = (0..n).map(|i| rows[i][i]).sum();
        let square: f64 = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .map(|(i, j)| rows[i][j] * rows[j][i])
            .sum();
        let found: f64 = values.iter().map(|v| v.0).sum();
        let squares: f64 = values.iter().map(|v| v.0 * v.0 - v.1 * v.1).sum();
        assert!((found - trace).abs() < 1e-9, "{values:?}");
        assert!((squares - square).abs() < 1e-7, "{values:?}");
    }

    #[test]
    fn structured_matrices_converge() {
        // A cycle, on which unshifted QR makes no progress.
        let cycle: Vec<Vec<f64>> = (0..6)
            .map(|i| {
                (0..6)
                    .map(|j| f64::from(u8::from((i + 1) % 6 == j)))
                    .collect()
            })
            .collect();
        assert_traces(&cycle);
        // A spinning top: two coupled tilts.
        let (a, b, c) = (60.0, 19.62, 44.0);
        assert_traces(&[
            vec![0.0, a, 1.0, 0.0],
            vec![-a, 0.0, 0.0, 1.0],
            vec![b, 0.0, 0.0, c],
            vec![0.0, b, -c, 0.0],
        ]);
        let mut number = numbers(1u64);
        for n in 2..12 {
            let rows: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| number()).collect()).collect();
            assert_traces(&rows);
        }
    }

    /// Masses on springs, at rest: A = [[0, I], [−M⁻¹ K, 0]] has a diagonal of zeros, and the squares of
    /// its eigenvalues are those of −M⁻¹ K, each twice. At full size with `HAMEL_ATTACK=full`.
    #[test]
    fn oscillators_at_rest_converge() {
        let rounds = match std::env::var("HAMEL_ATTACK").as_deref() {
            Ok("full") => 400,
            Ok(_) => 20,
            Err(_) => 3,
        };
        let mut signed = numbers(7u64);
        let mut number = || (1.0 + signed()) / 2.0;
        for round in 0..rounds {
            for n in 2..=24 {
                // Equal links first, then random ones.
                let mut any = || {
                    if round == 0 {
                        1.0
                    } else {
                        0.1 + 10.0 * number()
                    }
                };
                let springs: Vec<f64> = (0..=n).map(|_| any()).collect();
                let masses: Vec<f64> = (0..n).map(|_| any()).collect();
                let mut rows = vec![vec![0.0; 2 * n]; 2 * n];
                for i in 0..n {
                    rows[i][n + i] = 1.0;
                    rows[n + i][i] = -(springs[i] + springs[i + 1]) / masses[i];
                    if i > 0 {
                        rows[n + i][i - 1] = springs[i] / masses[i];
                    }
                    if i + 1 < n {
                        rows[n + i][i + 1] = springs[i + 1] / masses[i];
                    }
                }
                let values = eigenvalues(&rows).expect("converges");
                let trace: f64 = (0..n).map(|i| rows[n + i][i]).sum();
                let squares: f64 = values.iter().map(|v| v.0 * v.0 - v.1 * v.1).sum();
                assert!(
                    (squares - 2.0 * trace).abs() < 1e-10 * trace.abs(),
                    "{n}: {squares} for {trace}"
                );
                let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.0.abs()));
                assert!(
                    largest < 1e-6 * trace.abs().sqrt(),
                    "{n}: grows by {largest}"
                );
            }
        }
    }

    /// Systems at rest with a random −M⁻¹ K, for which the squares of the eigenvalues add up to twice its trace: QR
    /// cycles on some of these matrices. A thousand of them with `HAMEL_ATTACK`.
    #[test]
    fn systems_at_rest_converge() {
        let mut number = numbers(9u64);
        let rounds = match std::env::var("HAMEL_ATTACK") {
            Ok(_) => 1000,
            Err(_) => 100,
        };
        let in_their_own = Strategy {
            thresholds: &DEFLATION_THRESHOLDS,
            turns: 1,
            most: &[],
        };
        let mut circles = 0;
        for round in 0..rounds {
            let n = 2 + round % 7;
            let mut rows = vec![vec![0.0; 2 * n]; 2 * n];
            for i in 0..n {
                rows[i][n + i] = 1.0;
                for j in 0..n {
                    rows[n + i][j] = number() * 100.0_f64.powf(number());
                }
            }
            let values = eigenvalues(&rows).expect("converges");
            let trace: f64 = (0..n).map(|i| rows[n + i][i]).sum();
            let squares = values.iter().map(|v| v.0 * v.0 - v.1 * v.1).sum::<f64>();
            let size = values.iter().map(|v| v.0 * v.0 + v.1 * v.1).sum::<f64>();
            assert!((squares - 2.0 * trace).abs() < 1e-11 * size, "{rows:?}");
            circles += usize::from(eigenvalues_by(&rows, &in_their_own).is_none());
        }
        println!("{circles} of {rounds} systems go in circles in their own axes");
        assert!(circles > 0);
    }

    /// The knees and elbows of a robot at rest, on which nalgebra's algorithm cycles: pairs of ±λ, whose
    /// squares have the traces of −M⁻¹ K and of its square.
    #[test]
    fn what_goes_in_circles_converges_in_other_axes() {
        let springs = [
            [
                1.0121339304301869e2,
                1.5090024121138836,
                2.5174074509918865e-2,
            ],
            [
                -1.0111540804496773e2,
                3.6159074392462455,
                -6.184788542376635e-1,
            ],
            [
                3.114236210166117e-1,
                3.299049682783092e-1,
                5.419884410378721,
            ],
        ];
        let mut rows = vec![vec![0.0; 6]; 6];
        for i in 0..3 {
            rows[i][3 + i] = 1.0;
            rows[3 + i][..3].copy_from_slice(&springs[i]);
        }
        let values = eigenvalues(&rows).expect("converges");
        let squares = values.iter().map(|v| v.0 * v.0 - v.1 * v.1).sum::<f64>();
        let trace: f64 = (0..3).map(|i| springs[i][i]).sum();
        assert!((squares - 2.0 * trace).abs() < 1e-12 * trace, "{squares}");
        for (found, opposite) in values.iter().zip(values.iter().rev()) {
            assert!((found.0 + opposite.0).abs() < 1e-12 * trace, "{values:?}");
        }
    }

    /// An attempt that does not converge is followed by the next one, which yields the right numbers; if none
    /// converges there are no eigenvalues. One iteration is never enough here.
    #[test]
    fn what_stalls_is_tried_again() {
        let (n, tilt) = (5, 0.3);
        // A companion matrix of (x − 1)(x − 2) … (x − 5) in another basis.
        let entry = |i: usize, j: usize| match (i + 1 == j, i == j) {
            (true, _) => tilt,
            (_, true) => 1.0 + i as f64,
            _ => 0.0,
        };
        // Similar to it by I + e₅ e₁ᵀ, so that all states influence one another.
        let rows: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let row =
                    |i: usize, j: usize| entry(i, j) - if j == 0 { entry(i, n - 1) } else { 0.0 };
                let first = |j: usize| if i == n - 1 { row(0, j) } else { 0.0 };
                (0..n).map(|j| row(i, j) + first(j)).collect()
            })
            .collect();
        let by = |thresholds: &[f64], turns: u64, most: &[usize]| {
            let strategy = Strategy {
                thresholds,
                turns,
                most,
            };
            eigenvalues_by(&rows, &strategy)
        };
        assert_eq!(by(&[1.0, 8.0], BASES, &[1; 24]), None);
        for (thresholds, turns, most) in [
            (&[1.0, 8.0][..], 1, &[1][..]),
            (&[1.0, 512.0], 2, &[1, 1, 1]),
        ] {
            let values = by(thresholds, turns, most).expect("the last try ends");
            for (value, expected) in values.iter().zip([5.0, 4.0, 3.0, 2.0, 1.0]) {
                assert!(
                    (value.0 - expected).abs() < 1e-9 && value.1 == 0.0,
                    "{values:?}"
                );
            }
        }
    }

    #[test]
    fn what_nothing_depends_on_has_an_eigenvalue_of_exactly_zero() {
        let integrator = vec![
            vec![0.0, 1.0, 0.5],
            vec![0.0, 0.0, 2.0],
            vec![0.0, 0.0, -3.0],
        ];
        let values = eigenvalues(&integrator).expect("converges");
        assert_eq!(values, [(0.0, 0.0), (0.0, 0.0), (-3.0, 0.0)]);
    }
}
