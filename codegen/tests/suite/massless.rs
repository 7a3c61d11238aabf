//! Attacks coordinates without inertia that loops or prescribed rates relate to others: comparison with M ξ̇ = f + Bᵀ
//! λ, B ξ̇ = b by elimination with pivots.
//!
//! The motion is determined if M is positive definite on the kernel of B; M itself may have any rank. Forty systems by
//! default, four times as many with `HAMEL_ATTACK=more`, three thousand with `HAMEL_ATTACK=full`.

mod joints;

use crate::common::{Random, attack, generated, value};
use crate::dense::{least_pivot, solution};
use hamel_codegen::generate::from_text;
use hamel_codegen::render::render;

/// Least pivot, relative to the diagonal, of a matrix that counts as regular.
const MIN_PIVOT: f64 = 1e-3;
/// Bound of rounding, relative to the size of the compared values.
const TOLERANCE: f64 = 1e-9;

/// Σ cⱼ qⱼ + d sin qᵢ.
struct Function {
    linear: Vec<f64>,
    sine: (f64, usize),
}

impl Function {
    fn random(random: &mut Random, n: usize) -> Self {
        const FACTORS: [f64; 6] = [0.0, 0.0, 0.0, 1.0, -1.0, 0.5];
        let linear = (0..n).map(|_| FACTORS[random.below(6)]).collect();
        let sine = ([0.0, 0.7][random.below(2)], random.below(n));
        Function { linear, sine }
    }

    fn text(&self) -> String {
        let linear = self.linear.iter().enumerate();
        let linear = linear.filter(|(_, factor)| **factor != 0.0);
        let mut terms: Vec<String> = linear.map(|(j, c)| format!("{c} * q{j}")).collect();
        if self.sine.0 != 0.0 {
            terms.push(format!("{} * sin(q{})", self.sine.0, self.sine.1));
        }
        match terms.is_empty() {
            true => "0".into(),
            false => terms.join(" + "),
        }
    }

    fn slopes(&self, q: &[f64]) -> Vec<f64> {
        let mut slopes = self.linear.clone();
        slopes[self.sine.1] += self.sine.0 * q[self.sine.1].cos();
        slopes
    }

    /// Returns the second derivative along a motion of constant rates.
    fn curvature(&self, q: &[f64], v: &[f64]) -> f64 {
        let (d, i) = self.sine;
        -d * q[i].sin() * v[i] * v[i]
    }
}

/// q_a = −(sum of others).
struct Loop {
    given: usize,
    by: Function,
}

struct System {
    n: usize,
    text: String,
    particles: Vec<(f64, [Function; 3])>,
    /// ½ c (vᵢ − vⱼ)².
    couplings: Vec<(f64, usize, usize)>,
    stiffness: Vec<f64>,
    loops: Vec<Loop>,
    /// A velocity with a prescribed rate.
    driven: Option<(usize, f64)>,
}

const GRAVITY: f64 = 9.81;

impl System {
    fn random(seed: u64) -> Self {
        let random = &mut Random::new(seed);
        let n = 2 + random.below(4);
        let count = 1 + random.below(n - 1);
        // The last coordinates depend on the first ones.
        let loops: Vec<Loop> = (n - count..n)
            .map(|given| {
                let mut by = Function::random(random, n);
                by.linear[n - count..].fill(0.0);
                by.sine.1 %= n - count;
                Loop { given, by }
            })
            .collect();
        let particles: Vec<(f64, [Function; 3])> = (0..1 + random.below(2))
            .map(|_| {
                let mass = 1.0 + random.below(3) as f64;
                (mass, std::array::from_fn(|_| Function::random(random, n)))
            })
            .collect();
        let couplings: Vec<(f64, usize, usize)> = (0..random.below(2))
            .map(|_| (2.0, random.below(n), random.below(n)))
            .collect();
        let stiffness: Vec<f64> = (0..n).map(|_| [0.0, 3.0][random.below(2)]).collect();
        let driven = (n - count > 1 && random.below(4) == 0)
            .then(|| (random.below(n - count), random.number()));
        let names = |letter: &str| {
            let names: Vec<String> = (0..n).map(|i| format!("{letter}{i}")).collect();
            names.join(", ")
        };
        let rates: Vec<String> = (0..n).map(|i| format!("q{i} = v{i}")).collect();
        let mut lines = vec![
            format!("coord {};", names("q")),
            format!("velocity {};", names("v")),
            format!("rate {};", rates.join(", ")),
        ];
        for (mass, position) in &particles {
            let [x, y, z] = position.each_ref().map(Function::text);
            lines.push(format!("particle mass {mass} at [{x}, {y}, {z}];"));
        }
        for (inertia, i, j) in &couplings {
            lines.push(format!("kinetic {inertia} / 2 * (v{i} - v{j})^2;"));
        }
        for (i, k) in stiffness.iter().enumerate().filter(|(_, k)| **k > 0.0) {
            lines.push(format!("spring stiffness {k} on q{i};"));
        }
        for row in &loops {
            lines.push(format!("loop q{} + {} = 0;", row.given, row.by.text()));
        }
        if let Some((place, rate)) = driven {
            lines.push(format!("prescribe rate(v{place}) = {rate};"));
        }
        lines.push(format!("gravity [0, 0, -{GRAVITY}];"));
        System {
            n,
            text: format!("system S {{\n    {}\n}}\n", lines.join("\n    ")),
            particles,
            couplings,
            stiffness,
            loops,
            driven,
        }
    }

    /// Returns M and f − h − ∂V.
    fn inertia_and_force(&self, q: &[f64], v: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let n = self.n;
        let mut mass = vec![vec![0.0; n]; n];
        let mut force: Vec<f64> = (0..n).map(|i| -self.stiffness[i] * q[i]).collect();
        for (m, position) in &self.particles {
            for (axis, entry) in position.iter().enumerate() {
                let slopes = entry.slopes(q);
                let weight = if axis == 2 { GRAVITY } else { 0.0 };
                for i in 0..n {
                    force[i] -= m * slopes[i] * (entry.curvature(q, v) + weight);
                    for j in 0..n {
                        mass[i][j] += m * slopes[i] * slopes[j];
                    }
                }
            }
        }
        for &(c, i, j) in &self.couplings {
            let mut row = vec![0.0; n];
            row[i] += 1.0;
            row[j] -= 1.0;
            for a in 0..n {
                for b in 0..n {
                    mass[a][b] += c * row[a] * row[b];
                }
            }
        }
        (mass, force)
    }

    /// Returns B and b.
    fn rows(&self, q: &[f64], v: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for row in &self.loops {
            let mut slopes = row.by.slopes(q);
            slopes[row.given] += 1.0;
            rows.push(slopes);
            right.push(-row.by.curvature(q, v));
        }
        if let Some((place, rate)) = self.driven {
            let mut row = vec![0.0; self.n];
            row[place] = 1.0;
            rows.push(row);
            right.push(rate);
        }
        (rows, right)
    }

    /// Returns a point and a velocity that satisfy the loops.
    fn state(&self, mut free: impl FnMut() -> f64) -> (Vec<f64>, Vec<f64>) {
        let mut q: Vec<f64> = (0..self.n).map(|_| free()).collect();
        let mut v: Vec<f64> = (0..self.n).map(|_| free()).collect();
        for row in &self.loops {
            let linear = row.by.linear.iter().zip(&q).map(|(c, q)| c * q);
            let (d, i) = row.by.sine;
            q[row.given] = -(linear.sum::<f64>() + d * q[i].sin());
            let slopes = row.by.slopes(&q);
            v[row.given] = -slopes.iter().zip(&v).map(|(s, v)| s * v).sum::<f64>();
        }
        (q, v)
    }

    /// Returns the least pivot of M on the kernel of the rows, relative to the diagonal; 1 if the kernel is zero.
    fn least_pivot(&self, q: &[f64]) -> f64 {
        let n = self.n;
        let still = vec![0.0; n];
        let (mass, _) = self.inertia_and_force(q, &still);
        let driven = self.driven.map(|(place, _)| place);
        let free = (0..n - self.loops.len()).filter(|&i| Some(i) != driven);
        let columns: Vec<Vec<f64>> = free
            .map(|i| {
                let mut column = vec![0.0; n];
                column[i] = 1.0;
                for row in &self.loops {
                    column[row.given] = -row.by.slopes(q)[i];
                }
                column
            })
            .collect();
        least_pivot(&mass, &columns)
    }

    /// Returns ξ̇ of M ξ̇ − Bᵀ λ = f, B ξ̇ = b.
    fn acceleration(&self, q: &[f64], v: &[f64]) -> Vec<f64> {
        solution(self.inertia_and_force(q, v), self.rows(q, v))
    }
}

fn verdict(system: &System, seed: u64) -> Result<(), String> {
    let random = &mut Random::new(seed ^ 0xbead);
    let somewhere = system.state(|| random.number());
    let start = vec![0.0; system.n];
    let pivots = [&start, &somewhere.0].map(|q| system.least_pivot(q));
    let read = from_text(&system.text);
    let of = match (read, pivots) {
        (Ok(of), _) => of,
        (Err(errors), pivots) => {
            let said = render(&errors, "system", &system.text, false);
            let regular = pivots.iter().all(|&pivot| pivot > MIN_PIVOT);
            let fault = said.contains("internal check");
            let moves = system.loops.len() + usize::from(system.driven.is_some()) < system.n;
            return match fault || regular && moves {
                true => Err(said),
                false => Ok(()),
            };
        }
    };
    if pivots[1] <= MIN_PIVOT {
        return match pivots[1] == 0.0 {
            true => Err("it is derived, although directions without inertia are left".into()),
            false => Ok(()),
        };
    }
    let (q, v) = somewhere;
    let expected = system.acceleration(&q, &v);
    let place = |symbol: &hamel_codegen::algebra::graph::Edge| -> usize {
        let graph = &of.active.graph;
        let name = graph.symbols().iter().find(|s| s.node == symbol.node());
        name.expect("a velocity").name[1..]
            .parse()
            .expect("a number")
    };
    let places: Vec<usize> = of.active.xi.iter().map(place).collect();
    let xi: Vec<f64> = places.iter().map(|&i| v[i]).collect();
    let found = value(&of, "accel", [&q, &xi, &[], &[]]);
    let size = expected.iter().fold(10.0, |most: f64, a| most.max(a.abs()));
    for (&i, found) in places.iter().zip(&found) {
        let difference = (found - expected[i]).abs();
        if difference.is_nan() || difference > TOLERANCE * size {
            return Err(format!(
                "rate of v{i} at {q:?}, {v:?}: {found}, not {}",
                expected[i]
            ));
        }
    }
    Ok(())
}

#[test]
fn ties_carry_what_has_no_inertia() {
    attack(40, 3000, |seed| {
        let system = System::random(seed);
        let fault = verdict(&system, seed).err();
        let said = fault.map(|fault| format!("seed {seed}: {fault}\n{}", system.text));
        said.into_iter().collect()
    });
}

/// An inerter that amplifies rounding in M, and a loop that determines the massless direction.
#[test]
fn a_loop_over_a_direction_without_mass() {
    let text = "system C {
        rate z19 = sign(j5) - z19; state z19 = 1; time t;
        coord q8, q9; velocity w10, w11; param p12 = 0.5, p18 = 1, p16 = 1, p25 = 1, p26 = 1;
        particle mass 1 at [0, p18, 0] on f15;
        joint j5: revolute [1, 1, 0] on world at pose(rpy(1, 1, 1), [1, 1, 0]) moves f6;
        rate q8 = w10 / (2 + cos(q9)) + p12 * cos(t) * q8 + t;
        loop 2 * j14 + sin(j5) = 1 stabilized 5;
        body on f13 { mass 1; com [0.2, 1, 1]; inertia [[0.6, 0, 0.02], [0, 1, -0.05], [0.02, -0.05, 1]] about com; }
        frame f13 on f6 = pose(rotz(q8) * rotx(q9), [0.3, sin(q9), q8]);
        rate q9 = w11 / (2 + cos(q8)) + sin(q8) * w10;
        inerter inertance 1 from [0, 1, 1] on f13 to [p25, p26, 1] on world;
        joint j14: planar [0, 0, 1] on f6 at pose(rotx(pi / 2), [p16, 0, 1]) moves f15;
        start q8 = 1;
    }";
    let read = from_text(text);
    assert!(
        read.is_ok(),
        "{}",
        render(&read.err().unwrap_or_default(), "system", text, false)
    );
}

/// A massless slider that a loop relates to a prescribed motion: M is 0 for the unknowns, and the loop alone determines
/// the motion and carries the spring.
#[test]
fn loops_to_given_motions_carry_what_has_no_mass_at_all() {
    let of = generated(
        "system Slave {
            time t;
            joint a: prismatic [1, 0, 0] moves slider;
            joint b: prismatic [1, 0, 0] moves drive;
            body on drive { mass 2; }
            spring stiffness 3 on a;
            loop a + 0.3 * sin(a) = b;
            prescribe b = sin(t);
            generate accel, constraint_force;
        }",
    );
    let (t, a) = (0.4_f64, 0.25_f64);
    let b = a + 0.3 * a.sin();
    let slope = 1.0 + 0.3 * a.cos();
    let v = t.cos() / slope;
    let mut x = vec![0.0; of.model.nu()];
    for (name, entry) in [("t", t), ("a", a), ("b", b)] {
        let mut coordinates = of.model.coordinates.iter();
        let coordinate = coordinates
            .find(|c| c.name == name)
            .expect("it is declared");
        x[coordinate.offset] = entry;
    }
    let rate = value(&of, "accel", [&x, &[v], &[], &[]]);
    let expected = (-t.sin() + 0.3 * a.sin() * v * v) / slope;
    assert!(
        (rate[0] - expected).abs() < 1e-12,
        "{rate:?}, not {expected}"
    );
    // 0 = −3 a + λ (1 + 0.3 cos a); the drive accelerates its mass and carries the force of the loop.
    let forces = value(&of, "constraint_force", [&x, &[v], &[], &[]]);
    let bond = 3.0 * a / slope;
    for (found, expected) in forces.iter().zip([bond, -2.0 * t.sin() + bond]) {
        assert!((found - expected).abs() < 1e-12, "{forces:?}");
    }
}
