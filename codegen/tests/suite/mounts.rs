//! Attacks mounts: arms whose mounts contain exact angles, roots and awkward numbers are compared with their definition
//! in numbers of 200 bits.
//!
//! M = Σ m Jᵥᵀ Jᵥ + J_ωᵀ Θ J_ω with the Jacobians of absolute poses, Γ ξ ξ by differences of M over 2⁻⁶⁰, and ∂V by
//! Jacobians, independently of the generator. A few arms by default, dozens with `HAMEL_ATTACK=more`, two thousand with
//! `HAMEL_ATTACK=full`.

use crate::common::{Random, attack, value};
use crate::precise::{
    Matrix, Precise, Three, about, apply, cross, dot, identity, minus, normed, plus, product,
    scaled,
};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::render::render;

/// Rounding of a program, relative to the size of its terms.
const TOLERANCE: f64 = 1e-13;

/// A number: its text in the language and its value.
type Number = (String, Precise);

fn decimal(text: &str) -> Number {
    (text.to_string(), Precise::parse(text))
}

/// Returns a number as written by people or by a program.
fn number(random: &mut Random) -> Number {
    match random.below(4) {
        0 => decimal(&format!("{}", random.below(5) as i64 - 2)),
        1 => decimal(&format!("{:.1}", 2.0 * random.number())),
        2 => decimal(&format!("{:.3}", 2.0 * random.number())),
        _ => decimal(&format!("{:.15}", random.number())),
    }
}

/// Returns an angle with a known sine, cosine or tangent, or a value of another function.
fn inverse(random: &mut Random) -> Number {
    let (n, d) = (1 + random.below(11), 12 + random.below(4));
    let part = &Precise::of(n as f64) / &Precise::of(d as f64);
    match random.below(7) {
        6 => (format!("atan(-{n} / {d})"), -&part.atan()),
        0 => (format!("acos({n} / {d})"), part.acos()),
        1 => (format!("acos(-{n} / {d})"), (-&part).acos()),
        2 => (format!("asin({n} / {d})"), part.asin()),
        3 => (format!("atan2({n}, {d})"), part.atan()),
        4 => (format!("atan2({n}, -{d})"), &Precise::pi() - &part.atan()),
        _ => (format!("log({n} / {d})"), part.log()),
    }
}

/// Returns an angle: a multiple of π/12, one of a triangle of sides 3, 4, 5, one of an inverse function, or any.
fn angle(random: &mut Random) -> Number {
    match random.below(9) {
        8 => inverse(random),
        0 => decimal(&format!("{:.2}", 3.0 * random.number())),
        1 => decimal(&format!("{:.15}", 3.0 * random.number())),
        2 => decimal("0.643501108793284386802809228717322638"),
        _ => {
            let twelfths = random.below(49) as i64 - 24;
            let value = &(&Precise::of(twelfths as f64) * &Precise::pi()) / &Precise::of(12.0);
            let text = match twelfths {
                t if t % 12 == 0 => format!("{} * pi", t / 12),
                t if t % 3 == 0 && random.below(2) == 0 => format!("{} * pi / 4", t / 3),
                t => format!("{t} * pi / 12"),
            };
            (text, value)
        }
    }
}

/// Returns a rotation.
fn turn(random: &mut Random) -> (String, Matrix) {
    let unit =
        |k: usize| -> Three { std::array::from_fn(|i| Precise::of(f64::from(u8::from(i == k)))) };
    let one = |k: usize, angle: &Precise| about(&unit(k), &angle.cos(), &angle.sin());
    match random.below(6) {
        0 => ("identity(3)".into(), identity()),
        k @ 1..=3 => {
            let (text, value) = angle(random);
            (
                format!("rot{}({text})", ["x", "y", "z"][k - 1]),
                one(k - 1, &value),
            )
        }
        4 => {
            // Cosine and sine of a triangle
            let text = "rotx(4/5, 3/5)".to_string();
            (
                text,
                about(&unit(0), &Precise::parse("0.8"), &Precise::parse("0.6")),
            )
        }
        _ => {
            let [r, p, y] = [(); 3].map(|()| angle(random));
            let turned = product(&one(2, &y.1), &product(&one(1, &p.1), &one(0, &r.1)));
            (format!("rpy({}, {}, {})", r.0, p.0, y.0), turned)
        }
    }
}

fn three(random: &mut Random, of: fn(&mut Random) -> Number) -> (String, Three) {
    let [a, b, c] = [(); 3].map(|()| of(random));
    (format!("[{}, {}, {}]", a.0, b.0, c.0), [a.1, b.1, c.1])
}

fn axis(random: &mut Random) -> (String, Three) {
    const AXES: [[i32; 3]; 10] = [
        [0, 0, 1],
        [0, 0, 1],
        [0, 1, 0],
        [1, 0, 0],
        [0, -1, 0],
        [1, 1, 0],
        [1, 1, 1],
        [2, -1, 3],
        [0, 3, 4],
        [-1, 0, 1],
    ];
    let axis = AXES[random.below(AXES.len())];
    let values: Three = axis.map(|entry| Precise::of(f64::from(entry)));
    (format!("{axis:?}"), normed(&values))
}

struct Link {
    slides: bool,
    axis: Three,
    turn: Matrix,
    place: Three,
    mass: Precise,
    com: Three,
    inertia: Three,
}

struct Arm {
    text: String,
    links: Vec<Link>,
    gravity: Three,
}

impl Arm {
    fn random(seed: u64) -> Self {
        let random = &mut Random::new(seed);
        let count = 2 + random.below(3);
        let mut lines = Vec::new();
        let mut links = Vec::new();
        for k in 0..count {
            let slides = random.below(6) == 0;
            let ((axis_text, axis), (turn_text, turn)) = (axis(random), turn(random));
            let (place_text, place) = three(random, number);
            let on = if k > 0 {
                format!(" on f{}", k - 1)
            } else {
                String::new()
            };
            let kind = if slides { "prismatic" } else { "revolute" };
            lines.push(format!(
                "joint j{k}: {kind} {axis_text}{on} at pose({turn_text}, {place_text}) moves f{k};"
            ));
            let (com_text, com) = three(random, number);
            let mass = decimal(&format!("{}", 1 + random.below(4)));
            let inertia = [(); 3].map(|()| decimal(&format!("{:.2}", 1.5 + 0.4 * random.number())));
            lines.push(format!(
                "body on f{k} {{ mass {}; com {com_text}; inertia diag({}, {}, {}) about com; }}",
                mass.0, inertia[0].0, inertia[1].0, inertia[2].0
            ));
            let (mass, inertia) = (mass.1, inertia.map(|moment| moment.1));
            links.push(Link {
                slides,
                axis,
                turn,
                place,
                mass,
                com,
                inertia,
            });
        }
        let (gravity_text, gravity) = three(random, number);
        lines.push(format!("gravity {gravity_text};"));
        let text = format!("system Arm {{\n    {}\n}}\n", lines.join("\n    "));
        Arm {
            text,
            links,
            gravity,
        }
    }

    /// Returns M and ∂V.
    fn at(&self, q: &[Precise]) -> (Vec<Vec<Precise>>, Vec<Precise>) {
        let n = self.links.len();
        let zero = || Precise::of(0.0);
        let mut mass = vec![vec![zero(); n]; n];
        let mut slope = vec![zero(); n];
        let (mut frame, mut origin): (Matrix, Three) = (identity(), [zero(), zero(), zero()]);
        // Axes and positions of the joints so far, in the world.
        let mut joints: Vec<(bool, Three, Three)> = Vec::new();
        for (link, q) in self.links.iter().zip(q) {
            origin = plus(&origin, &apply(&frame, &link.place));
            frame = product(&frame, &link.turn);
            let axis = apply(&frame, &link.axis);
            joints.push((link.slides, axis.clone(), origin.clone()));
            if link.slides {
                origin = plus(&origin, &scaled(q, &axis));
            } else {
                frame = product(&frame, &about(&link.axis, &q.cos(), &q.sin()));
            }
            let centre = plus(&origin, &apply(&frame, &link.com));
            let none = || [zero(), zero(), zero()];
            // Velocity of the centre of mass, and angular velocity in body axes.
            let columns: Vec<(Three, Three)> = joints
                .iter()
                .map(|(slides, axis, place)| {
                    if *slides {
                        return (axis.clone(), none());
                    }
                    let own = std::array::from_fn(|k| {
                        let column: Three = std::array::from_fn(|i| frame[i][k].clone());
                        dot(&column, axis)
                    });
                    (cross(axis, &minus(&centre, place)), own)
                })
                .collect();
            for (i, (v, w)) in columns.iter().enumerate() {
                slope[i] = &slope[i] - &(&link.mass * &dot(v, &self.gravity));
                for (j, (other, turning)) in columns.iter().enumerate() {
                    let momentum: Three = std::array::from_fn(|k| &link.inertia[k] * &turning[k]);
                    let entry = &(&link.mass * &dot(v, other)) + &dot(w, &momentum);
                    mass[i][j] = &mass[i][j] + &entry;
                }
            }
        }
        (mass, slope)
    }

    /// Γ ξ ξ = Ṁ ξ − ½ ∂(ξᵀ M ξ)/∂q, by central differences.
    fn bias(&self, q: &[Precise], xi: &[Precise]) -> Vec<Precise> {
        let n = q.len();
        let h = Precise::power_of_two(-60);
        let twice = &h + &h;
        let moved = |direction: &[Precise]| -> Vec<Vec<Precise>> {
            let at = |step: &Precise| {
                let q: Vec<Precise> = q
                    .iter()
                    .zip(direction)
                    .map(|(q, d)| q + &(step * d))
                    .collect();
                self.at(&q).0
            };
            let (after, before) = (at(&h), at(&-&h));
            let slope = |i: usize, j: usize| &(&after[i][j] - &before[i][j]) / &twice;
            (0..n)
                .map(|i| (0..n).map(|j| slope(i, j)).collect())
                .collect()
        };
        let quadratic = |m: &[Vec<Precise>]| -> Precise {
            let terms = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            terms.fold(Precise::of(0.0), |sum, (i, j)| {
                &sum + &(&m[i][j] * &(&xi[i] * &xi[j]))
            })
        };
        let along = moved(xi);
        let half = Precise::of(0.5);
        (0..n)
            .map(|i| {
                let unit: Vec<Precise> = (0..n)
                    .map(|j| Precise::of(f64::from(u8::from(i == j))))
                    .collect();
                let row = along[i].iter().zip(xi);
                let first = row.fold(Precise::of(0.0), |sum, (m, xi)| &sum + &(m * xi));
                &first - &(&half * &quadratic(&moved(&unit)))
            })
            .collect()
    }
}

fn numbers(values: &[Precise]) -> Vec<f64> {
    values.iter().map(Precise::to_f64).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

/// Returns the least pivot of a positive definite matrix, without square roots, relative to the largest entry.
fn least_pivot(mass: &[f64], n: usize) -> f64 {
    let (mut rest, scale) = (mass.to_vec(), largest(mass));
    let mut least = f64::INFINITY;
    for k in 0..n {
        let pivot = rest[k * n + k];
        least = least.min(pivot / scale);
        for i in k + 1..n {
            for j in k + 1..n {
                rest[i * n + j] -= rest[i * n + k] * rest[k * n + j] / pivot;
            }
        }
    }
    least
}

/// Compares a program with the definition; returns an error if it is refused or wrong.
fn verdict(arm: &Arm, seed: u64) -> Result<(), String> {
    let of: Generated = match from_text(&arm.text) {
        Ok(of) => of,
        Err(errors) => return Err(render(&errors, "arm", &arm.text, false)),
    };
    let n = arm.links.len();
    let mut random = Random::new(seed ^ 0xf00d);
    for _ in 0..2 {
        let x: Vec<f64> = random.numbers(n).iter().map(|q| 3.0 * q).collect();
        let xi = random.numbers(n);
        let precise =
            |list: &[f64]| -> Vec<Precise> { list.iter().map(|&v| Precise::of(v)).collect() };
        let (q, speed) = (precise(&x), precise(&xi));
        let (mass, slope) = arm.at(&q);
        let expected_mass: Vec<f64> = mass.iter().flat_map(|row| numbers(row)).collect();
        let (bias, slope) = (numbers(&arm.bias(&q, &speed)), numbers(&slope));
        let scale = largest(&expected_mass).max(1e-3);
        let weight = largest(&numbers(&arm.gravity)).max(1.0);
        let compare = |name: &str, expected: &[f64], scale: f64| {
            let found = value(&of, name, [&x, &xi, &[], &[]]);
            let error = expected
                .iter()
                .zip(&found)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            // False for NaN as well.
            if error <= TOLERANCE * scale {
                return Ok(());
            }
            Err(format!(
                "{name} at {x:?}, {xi:?}: {found:?}, not {expected:?}"
            ))
        };
        compare("mass_matrix", &expected_mass, scale)?;
        compare("bias", &bias, scale * 4.0)?;
        compare("potential_force", &slope, scale * weight * 4.0)?;
        let function = of.program.function("accel").expect("it was asked for");
        let compiled = Interpreter::new(&of.program, function, &of.program.defaults);
        let accel = match compiled.call_with([&x, &xi, &[], &[], &[]]) {
            Ok(accel) => accel,
            // Without accelerations: for example, two slides along the same line.
            Err(_) if least_pivot(&expected_mass, n) < 1e-12 => continue,
            Err(pivot) => return Err(format!("accel at {x:?}: pivot {pivot} is refused")),
        };
        // M ξ̇ + h + ∂V = 0 up to the rounding of a stable solution.
        let force = scale * largest(&accel) + largest(&bias) + largest(&slope) + scale;
        for i in 0..n {
            let row = (0..n)
                .map(|j| expected_mass[i * n + j] * accel[j])
                .sum::<f64>();
            let rest = row + bias[i] + slope[i];
            if rest.is_nan() || rest.abs() > 10.0 * TOLERANCE * force {
                return Err(format!(
                    "accel at {x:?}, {xi:?}: {accel:?} leaves {rest:e} of {force:e}"
                ));
            }
        }
    }
    Ok(())
}

#[test]
fn mounts_at_exact_and_awkward_angles() {
    attack(6, 2000, |seed| {
        let arm = Arm::random(seed);
        let fault = verdict(&arm, seed).err();
        let said = fault.map(|fault| format!("seed {seed}: {fault}\n{}", arm.text));
        said.into_iter().collect()
    });
}

/// Arms that were once wrong or refused modulo 2⁶¹ − 1: their M at rest, in closed form if short.
#[test]
fn arms_of_the_first_attack() {
    let quarter = "system A {
        joint a: revolute [0, 0, 1] moves f;
        joint b: revolute [0, 0, 1] on f at pose(rotx(pi / 4), [1, 0, 0]) moves g;
        body on g { mass 1; com [1, 2, 3]; inertia diag(1, 2, 3) about com; }
        gravity [0, 0, -9.81];
    }";
    let of = from_text(quarter).expect("an arm");
    let state = [&[0.0; 2][..], &[0.0; 2], &[], &[]];
    let mass = value(&of, "mass_matrix", state);
    let off = 3.0 * 0.5_f64.sqrt();
    for (found, expected) in mass.iter().zip([7.0, off, off, 8.0]) {
        assert!((found - expected).abs() < 1e-14, "{mass:?}");
    }
    for text in [
        "system A {
            joint a: revolute [0, 0, 1] at pose(rpy(-0.3, 0, 1), [0, 0, 0]) moves f;
            joint b: revolute [0, 0, 1] on f at pose(rpy(pi, 2.47, 1), [0, 0, 0]) moves g;
            body on g { mass 1; com [1, 0, 0]; inertia diag(1, 1, 1) about com; }
            gravity [0, 0, 1];
        }",
        "system A {
            joint j0: revolute [1, 1, 0] at pose(rpy(pi, 0, pi), [0, 0, 0]) moves f0;
            joint j1: revolute [1, 1, 0] on f0 at pose(roty(pi / 12), [1, 0, 0]) moves f1;
            joint j2: revolute [1, 1, 1] on f1 at pose(rotz(-pi), [0, 0, 0]) moves f2;
            body on f2 { mass 1; com [1, 0, 0]; inertia diag(1, 1, 1) about com; }
            gravity [0, 0, 1];
        }",
    ] {
        let of = from_text(text)
            .unwrap_or_else(|errors| panic!("{}", render(&errors, "arm", text, false)));
        let mass = value(
            &of,
            "mass_matrix",
            [
                &vec![0.0; of.active.xi.len()],
                &vec![0.0; of.active.xi.len()],
                &[],
                &[],
            ],
        );
        assert!(mass.iter().all(|entry| entry.is_finite()));
    }
}
