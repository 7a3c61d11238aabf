//! Attacks velocity constraints, eliminated or with multipliers, under forces that are functions of all velocities,
//! including dependent ones: comparison with M ξ̇ = f + Bᵀ λ, B ξ̇ = −Ḃ ξ in numbers.
//!
//! Twenty systems by default, eighty with `HAMEL_ATTACK=more`, two thousand with `HAMEL_ATTACK=full`.

use crate::common::{Random, attack, generated, value};
use hamel_codegen::generate::from_text;
use hamel_codegen::render::render;

/// An entry of B: its text, its value, and its rate of change.
struct Factor {
    text: String,
    of: Box<dyn Fn(f64) -> [f64; 2]>,
    coordinate: usize,
}

impl Factor {
    fn random(random: &mut Random, n: usize, is_pivot: bool) -> Self {
        let k = random.below(n);
        let number = (1 + random.below(3)) as f64;
        let (text, of): (String, Box<dyn Fn(f64) -> [f64; 2]>) = match random.below(6) {
            0 => (
                format!("({} + sin(q{k}))", number + 1.0),
                Box::new(move |q| [number + 1.0 + q.sin(), q.cos()]),
            ),
            1 => (
                format!("({} + q{k}^2)", number),
                Box::new(move |q| [number + q * q, 2.0 * q]),
            ),
            2 if !is_pivot => (
                format!("(-cos(q{k}) / {number})"),
                Box::new(move |q| [-q.cos() / number, q.sin() / number]),
            ),
            3 if !is_pivot => (format!("q{k}"), Box::new(|q| [q, 1.0])),
            4 => (format!("(-{number})"), Box::new(move |_| [-number, 0.0])),
            _ => (format!("{number}"), Box::new(move |_| [number, 0.0])),
        };
        Factor {
            text,
            of,
            coordinate: k,
        }
    }
}

/// A force: its text, and its value at ξ.
type Force = (String, Box<dyn Fn(&[f64]) -> f64>);

fn force(random: &mut Random, n: usize) -> Force {
    let (j, k) = (random.below(n), random.below(n));
    match random.below(9) {
        0 => (format!("-tanh(v{j})"), Box::new(move |v| -v[j].tanh())),
        1 => (
            format!("-2 * v{j} / sqrt(1 + v{j}^2)"),
            Box::new(move |v| -2.0 * v[j] / (1.0 + v[j] * v[j]).sqrt()),
        ),
        2 => (
            format!("sin(v{j} + 2 * v{k})"),
            Box::new(move |v| (v[j] + 2.0 * v[k]).sin()),
        ),
        3 => (
            format!("v{k} * exp(-v{j}^2)"),
            Box::new(move |v| v[k] * (-v[j] * v[j]).exp()),
        ),
        4 => (
            format!("cosh((v{j} - v{k}) / 3)"),
            Box::new(move |v| ((v[j] - v[k]) / 3.0).cosh()),
        ),
        5 => (
            format!("-v{j} * sqrt(v{j}^2 + v{k}^2 + 1)"),
            Box::new(move |v| -v[j] * (v[j] * v[j] + v[k] * v[k] + 1.0).sqrt()),
        ),
        6 => (
            format!("atan2(v{j}, 1 + v{k}^2)"),
            Box::new(move |v| v[j].atan2(1.0 + v[k] * v[k])),
        ),
        7 => (
            format!("log(2 + sin(v{j}))"),
            Box::new(move |v| (2.0 + v[j].sin()).ln()),
        ),
        _ => (format!("-v{j}"), Box::new(move |v| -v[j])),
    }
}

/// Returns the solution of a small dense system, given by rows with right sides.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()));
        rows.swap(k, pivot.expect("a row"));
        let own = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != k {
                let factor = row[k] / own[k];
                row.iter_mut().zip(&own).for_each(|(a, b)| *a -= factor * b);
            }
        }
    }
    (0..n).map(|k| rows[k][n] / rows[k][k]).collect()
}

/// Returns the faults of a random system.
fn faults(seed: u64) -> Vec<String> {
    let random = &mut Random::new(seed ^ 0xc057);
    let n = 2 + random.below(4);
    let count = 1 + random.below((n - 1).min(2));
    // Row r has a nonzero factor at velocity r, at which the other rows have none.
    let rows: Vec<Vec<Option<Factor>>> = (0..count)
        .map(|r| {
            let mut row: Vec<Option<Factor>> = (0..n).map(|_| None).collect();
            row[r] = Some(Factor::random(random, n, true));
            for entry in row.iter_mut().skip(count) {
                *entry = (random.below(4) > 0).then(|| Factor::random(random, n, false));
            }
            row
        })
        .collect();
    let masses: Vec<f64> = (0..n).map(|_| 0.5 + random.below(4) as f64).collect();
    let forces: Vec<Vec<Force>> = (0..n)
        .map(|_| (0..random.below(3)).map(|_| force(random, n)).collect())
        .collect();
    let list = |name: &str| -> String {
        let names: Vec<String> = (0..n).map(|i| format!("{name}{i}")).collect();
        names.join(", ")
    };
    let mut text = format!(
        "system Bound {{\n    coord {};\n    velocity {};\n",
        list("q"),
        list("v")
    );
    for (i, mass) in masses.iter().enumerate() {
        text += &format!("    rate q{i} = v{i};\n    kinetic {mass} * v{i}^2 / 2;\n");
    }
    for row in &rows {
        let terms = row.iter().enumerate();
        let terms: Vec<String> = terms
            .filter_map(|(i, factor)| Some(format!("{} * v{i}", factor.as_ref()?.text)))
            .collect();
        text += &format!("    nonholonomic {} = 0;\n", terms.join(" + "));
    }
    for (i, terms) in forces
        .iter()
        .enumerate()
        .filter(|(_, terms)| !terms.is_empty())
    {
        let terms: Vec<&str> = terms.iter().map(|(text, _)| text.as_str()).collect();
        text += &format!("    generalized force v{i} = {};\n", terms.join(" + "));
    }
    text += "}\n";
    let of = match from_text(&text) {
        Ok(of) => of,
        Err(errors) => {
            let said = render(&errors, "test", &text, false);
            return vec![format!("seed {seed}: refused: {said}\n{text}")];
        }
    };
    let active: Vec<usize> = of
        .active
        .velocities
        .iter()
        .map(|group| group.name[1..].parse().expect("a number"))
        .collect();
    let mut faults = Vec::new();
    for _ in 0..3 {
        let (q, mut v) = (random.numbers(n), random.numbers(n));
        let at = |factor: &Option<Factor>| {
            let factor = factor.as_ref();
            factor.map_or([0.0; 2], |factor| (factor.of)(q[factor.coordinate]))
        };
        for (r, row) in rows.iter().enumerate() {
            let others = (count..n).map(|i| at(&row[i])[0] * v[i]);
            v[r] = -others.sum::<f64>() / at(&row[r])[0];
        }
        let size = n + count;
        let mut system = vec![vec![0.0; size + 1]; size];
        for i in 0..n {
            system[i][i] = masses[i];
            system[i][size] = forces[i].iter().map(|(_, force)| force(&v)).sum();
        }
        for (r, row) in rows.iter().enumerate() {
            for (i, entry) in row.iter().enumerate() {
                let [factor, slope] = at(entry);
                system[i][n + r] = -factor;
                system[n + r][i] = factor;
                let moving = entry.as_ref().map_or(0.0, |entry| v[entry.coordinate]);
                system[n + r][size] -= slope * moving * v[i];
            }
        }
        let expected = solved(system);
        let xi: Vec<f64> = active.iter().map(|&i| v[i]).collect();
        let found = value(&of, "accel", [&q, &xi, &[], &[]]);
        let scale = expected.iter().fold(1.0, |most: f64, a| most.max(a.abs()));
        for (&i, found) in active.iter().zip(found) {
            let error = (found - expected[i]).abs() / scale;
            if error.is_nan() || error > 1e-11 {
                faults.push(format!(
                    "seed {seed}: v{i} changes by {}, not {found}\n{text}",
                    expected[i]
                ));
            }
        }
    }
    faults
}

#[test]
fn constraints_under_functions_of_velocities() {
    attack(20, 2000, faults);
}

/// Constraints may make velocities proportional, so that their norm is √c |ξ| where c is not a square: in any field of
/// the proofs, this happens for one of these. Drag along a rail: m ṡ = −|s| s.
#[test]
fn norms_of_velocities_that_are_tied_have_roots() {
    for slope in ["2", "3", "5", "1.3 / 0.372"] {
        let of = generated(&format!(
            "system Dragged {{
                coord x, y;
                velocity u, v;
                rate x = u;
                rate y = v;
                particle mass 2 at [x, y, 0];
                nonholonomic v - {slope} * u = 0;
                generalized force u = -norm([u, v]) * u;
                generalized force v = -norm([u, v]) * v;
                start u = 1;
            }}"
        ));
        let (x, xi) = ([0.3, -0.2], [1.5, 1.5 * ratio(slope)]);
        let left: Vec<f64> = match of.active.n() {
            1 => vec![xi[0]],
            _ => xi.to_vec(),
        };
        let found = value(&of, "accel", [&x, &left, &[], &[]]);
        let speed = f64::hypot(xi[0], xi[1]);
        for (found, xi) in found.iter().zip(left) {
            let expected = -speed * xi / 2.0;
            assert!(
                (found - expected).abs() < 1e-13 * expected.abs(),
                "{slope}: {found} for {expected}"
            );
        }
    }
}

/// Evaluates the text a/b.
fn ratio(text: &str) -> f64 {
    let parts = text.split('/').map(|part| part.trim().parse::<f64>());
    let parts: Vec<f64> = parts.map(|part| part.expect("a number")).collect();
    parts[0] / parts.get(1).unwrap_or(&1.0)
}
