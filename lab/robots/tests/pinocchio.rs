//! Compares the semi-implicit step of real robots and its slopes [A_d B_d] with Pinocchio's
//! (`tests/reference/control`).
//!
//! Pinocchio moves a floating base by the exponential of SE(3), x⁺ = (R, p) exp(u) with u = h ξ⁺; hamel by the
//! exponentials of its parts, R⁺ = R exp(û_a) and p⁺ = p + R u_l. Everything except the position agrees directly; the
//! reference position and its slopes are converted to the other map.

use hamel::methods::SemiImplicitEuler;
use hamel::{State, Table, Tangent, so3, step_slopes};

/// A sample of the reference: the state before and after the step, A by rows and B by rows.
struct Sample {
    h: f64,
    x: &'static [f64],
    xi: &'static [f64],
    u: &'static [f64],
    end_x: &'static [f64],
    end_xi: &'static [f64],
    a: &'static [f64],
    b: &'static [f64],
}

/// Relative to the largest number compared.
const TOLERANCE: f64 = 1e-10;

fn agree(what: &str, found: &[f64], wanted: &[f64]) {
    assert_eq!(found.len(), wanted.len(), "{what}");
    let size = wanted.iter().fold(1e-3_f64, |most, v| most.max(v.abs()));
    for (place, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        let off = (found - wanted).abs() / size;
        assert!(
            off < TOLERANCE,
            "{what}[{place}]: {found} {wanted}, {off:.1e}"
        );
    }
}

/// Returns the rows (h, δξ) of a step's slopes, each with the columns (h, δξ, δu).
fn rows(sample: &Sample, n: usize) -> Vec<Vec<f64>> {
    let (a, b) = (sample.a.chunks(2 * n), sample.b.chunks(n));
    a.zip(b).map(|(a, b)| [a, b].concat()).collect()
}

fn check<S: Tangent<Scalar = f64> + Default>(floating: bool, samples: &[Sample]) {
    let system = S::default();
    for sample in samples {
        let n = sample.xi.len();
        let (mut x, mut xi) = system.start();
        x.as_mut().copy_from_slice(sample.x);
        xi.as_mut().copy_from_slice(sample.xi);
        let mut u = system.zero_inputs();
        u.as_mut().copy_from_slice(sample.u);
        let state = State { t: 0.0, x, xi };
        let (end, slopes) =
            step_slopes(&SemiImplicitEuler, &system, &state, &u, sample.h).expect("a step");
        agree("ξ⁺", end.xi.as_ref(), sample.end_xi);
        let mut end_x = sample.end_x.to_vec();
        let mut wanted = rows(sample, n);
        if floating {
            // The position is the first block of x, the twist the first of ξ.
            let moved: [f64; 6] = std::array::from_fn(|k| sample.h * sample.end_xi[k]);
            let [linear, angular] = [0, 3].map(|k| [moved[k], moved[k + 1], moved[k + 2]]);
            let rotation: [f64; 9] = std::array::from_fn(|k| sample.x[3 + k]);
            let way = so3::apply(rotation, linear);
            (0..3).for_each(|k| end_x[k] = sample.x[k] + way[k]);
            // δp⁺ = R (h_l + h_a × u_l + h δv⁺), expressed in the axes of R⁺ = R exp(û_a).
            let turn = so3::exp(angular);
            for column in 0..3 * n {
                let unit = |k: usize| if column == k { 1.0 } else { 0.0 };
                let turned = so3::cross([3, 4, 5].map(unit), linear);
                let before =
                    std::array::from_fn(|k| unit(k) + turned[k] + sample.h * wanted[n + k][column]);
                let after = so3::apply_transpose(turn, before);
                (0..3).for_each(|k| wanted[k][column] = after[k]);
            }
        }
        agree("x⁺", end.x.as_ref(), &end_x);
        for (i, row) in wanted.iter().enumerate() {
            agree(&format!("row {i} of the slopes"), slopes.row(i), row);
        }
    }
}

include!(concat!(env!("OUT_DIR"), "/robots.rs"));
