//! Compares the linearisation with published eigenvalues, for the Whipple bicycle and the rolling disk.
//!
//! J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, *Linearized dynamics equations for the
//! balance and steer of a bicycle: a benchmark and review*, Proc. R. Soc. A 463 (2007), table 2.

use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::count::count;
use hamel_codegen::program::interpret::Interpreter;
use std::path::Path;

fn linearized(name: &str) -> Generated {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    let text = std::fs::read_to_string(path).expect("the model is in the repository");
    let generated = from_text(&text).expect("correct");
    Generated::all(generated.model, 0).expect("derived")
}

/// Returns A of a linearisation at the start, with other active velocities.
fn matrix(generated: &Generated, xi: &[f64]) -> Vec<Vec<f64>> {
    let program = &generated.program;
    let function = program.function("linearize").expect("generated");
    let interpreter = Interpreter::new(program, function, &program.defaults);
    let u = vec![0.0; program.m];
    let flat = interpreter
        .call(&program.start_x, xi, &u, &[])
        .expect("regular");
    let size = generated.model.n() + program.n;
    flat.chunks(size + program.m)
        .map(|row| row[..size].to_vec())
        .collect()
}

type Complex = (f64, f64);

fn multiply(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn divide(a: Complex, b: Complex) -> Complex {
    let square = b.0 * b.0 + b.1 * b.1;
    let (re, im) = multiply(a, (b.0, -b.1));
    (re / square, im / square)
}

/// Returns a solution of (A − λ I) v = b by elimination with pivoting.
fn solve(a: &[Vec<f64>], shift: Complex, b: &[Complex]) -> Vec<Complex> {
    let n = a.len();
    let mut rows: Vec<Vec<Complex>> = (0..n)
        .map(|i| {
            let mut row: Vec<Complex> = a[i].iter().map(|&entry| (entry, 0.0)).collect();
            row[i] = (row[i].0 - shift.0, -shift.1);
            row.push(b[i]);
            row
        })
        .collect();
    let size = |z: Complex| z.0.hypot(z.1);
    for c in 0..n {
        let pivot = (c..n)
            .max_by(|&i, &j| size(rows[i][c]).total_cmp(&size(rows[j][c])))
            .expect("rows are left");
        rows.swap(c, pivot);
        let lead = rows[c].clone();
        for row in rows.iter_mut().skip(c + 1) {
            let factor = divide(row[c], lead[c]);
            for (entry, &by) in row.iter_mut().zip(&lead).skip(c) {
                let product = multiply(factor, by);
                *entry = (entry.0 - product.0, entry.1 - product.1);
            }
        }
    }
    let mut v = vec![(0.0, 0.0); n];
    for i in (0..n).rev() {
        let known = (i + 1..n).fold(rows[i][n], |sum, j| {
            let product = multiply(rows[i][j], v[j]);
            (sum.0 - product.0, sum.1 - product.1)
        });
        v[i] = divide(known, rows[i][i]);
    }
    v
}

/// Returns the eigenvalue of A nearest to a guess, by inverse iteration, as an independent computation.
fn eigenvalue_near(a: &[Vec<f64>], guess: Complex) -> Complex {
    let n = a.len();
    let mut shift = (guess.0 + 1e-3, guess.1 + 2e-3);
    let mut v: Vec<Complex> = (0..n).map(|i| (1.0 + 0.1 * i as f64, 0.3)).collect();
    for _ in 0..12 {
        let w = solve(a, shift, &v);
        let (largest, _) = w.iter().enumerate().fold((0, 0.0), |best, (i, z)| {
            let size = z.0.hypot(z.1);
            if size > best.1 { (i, size) } else { best }
        });
        // (A − s) w = v: the eigenvalue is s + v / w, taken at the largest entry.
        let ratio = divide(v[largest], w[largest]);
        let next = (shift.0 + ratio.0, shift.1 + ratio.1);
        let scale = w[largest];
        v = w.into_iter().map(|z| divide(z, scale)).collect();
        if (next.0 - shift.0).hypot(next.1 - shift.1) < 1e-13 {
            return next;
        }
        shift = next;
    }
    shift
}

#[test]
fn bicycle_has_the_published_eigenvalues() {
    let generated = linearized("bicycle");
    let (rr, rf) = (0.3, 0.35);
    let published: [(f64, &[Complex]); 4] = [
        (
            0.0,
            &[
                (3.13164324790656, 0.0),
                (-3.13164324790656, 0.0),
                (5.53094371765393, 0.0),
                (-5.53094371765393, 0.0),
            ],
        ),
        (
            4.0,
            &[
                (0.41325331521125, 3.07910818603206),
                (-1.42944427361326, 0.0),
                (-12.15861426576447, 0.0),
            ],
        ),
        (
            5.0,
            &[
                (-0.77534188219585, 4.46486771378823),
                (-0.32286642900409, 0.0),
                (-14.07838969279822, 0.0),
            ],
        ),
        (
            10.0,
            &[
                (-3.72016840437287, 10.90681139476287),
                (0.16105338653172, 0.0),
                (-24.62459635017404, 0.0),
            ],
        ),
    ];
    for (speed, expected) in published {
        // Active velocities: the rear frame's angular velocity, steer, rear wheel, front wheel.
        let xi = [0.0, 0.0, 0.0, 0.0, -speed / rr, -speed / rf];
        let a = matrix(&generated, &xi);
        for &value in expected {
            let found = eigenvalue_near(&a, value);
            let error = (found.0 - value.0).hypot(found.1 - value.1);
            println!("v = {speed}: {found:?}, off by {error:.1e}");
            assert!(error < 1e-10, "v = {speed}: {found:?} for {value:?}");
        }
    }
}

/// M, the forcing and the solution for ξ̇ together cost less than the 2,367 operations of M and the forcing in the best
/// published symbolic derivation.
#[test]
fn bicycle_is_cheap() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/bicycle.eom");
    let text = std::fs::read_to_string(path).expect("the model is in the repository");
    let generated = from_text(&text).expect("correct");
    let program = &generated.program;
    let accel = program.function("accel").expect("generated");
    let roots = [accel.outputs.clone(), accel.guards.clone()].concat();
    let flops = count(&program.graph, &roots).flops();
    println!("{flops}");
    assert!(flops < 2367, "{flops}");
}

#[test]
fn free_body_costs_at_most_300_operations() {
    let generated = linearized("free_body");
    let function = generated.program.function("linearize").expect("generated");
    let roots = [function.outputs.clone(), function.guards.clone()].concat();
    let flops = count(&generated.program.graph, &roots).flops();
    println!("{flops}");
    assert!(flops <= 300, "{flops}");
}

/// At the spin 1/√3 with m = a = g = 1 all eight eigenvalues of the upright disk are zero: A is
/// nilpotent, tr Aᵏ = 0 for k = 1..8, while A itself is not zero.
#[test]
fn critical_disk_has_eight_zero_eigenvalues() {
    let generated = linearized("rolling_disk_plane");
    let a = matrix(&generated, &generated.program.start_xi);
    assert_eq!(a.len(), 8);
    let size = a.iter().flatten().fold(0.0_f64, |m, e| m.max(e.abs()));
    assert!(size > 0.5, "{size}");
    let mut power = a.clone();
    for k in 1..=8 {
        let trace: f64 = (0..8).map(|i| power[i][i]).sum();
        assert!(trace.abs() < 1e-14, "tr A^{k} = {trace:e}");
        power = power
            .iter()
            .map(|row| {
                (0..8)
                    .map(|j| (0..8).map(|l| row[l] * a[l][j]).sum())
                    .collect()
            })
            .collect();
    }
    assert!(power.iter().flatten().all(|entry| entry.abs() < 1e-14));
    // At a slightly higher or lower spin they are not zero.
    let mut xi = generated.program.start_xi.clone();
    *xi.last_mut().expect("three velocities") *= 0.9;
    let slower = matrix(&generated, &xi);
    let square: f64 = (0..8)
        .map(|i| (0..8).map(|l| slower[i][l] * slower[l][i]).sum::<f64>())
        .sum();
    assert!(square > 0.1, "{square}");
}
