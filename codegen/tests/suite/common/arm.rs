//! Arms with ill-conditioned axes, and their dynamics from the definitions in doubled precision.
//!
//! M = Σ m Jᵀ J + J_ωᵀ Θ J_ω over the bodies, in world axes; forces by the Newton-Euler equations for every body. It
//! shares only the number type with the generator.

use super::Random;
use hamel_codegen::algebra::double::Double;

pub type V3 = [Double; 3];
pub type M3 = [V3; 3];

/// An exact decimal, k · 10^e.
#[derive(Clone, Copy, Debug)]
pub struct Decimal(pub i64, pub i32);

impl Decimal {
    fn text(self) -> String {
        format!("{}e{}", self.0, self.1)
    }

    fn value(self) -> Double {
        let ten = (0..self.1.abs()).fold(Double::ONE, |power, _| power * Double::new(10.0));
        let whole = Double::new(self.0 as f64);
        if self.1 < 0 { whole / ten } else { whole * ten }
    }

    /// Returns a random number of three digits with about this power of ten, of either sign.
    pub fn random(random: &mut Random, power: i32) -> Self {
        Decimal((random.number() * 1000.0) as i64, power - 3)
    }
}

/// Quarter turns plus an angle (rad).
#[derive(Clone, Copy, Debug)]
pub struct Angle(pub i64, pub Decimal);

impl Angle {
    fn text(self) -> String {
        match self.0 {
            0 => self.1.text(),
            quarters => format!("{quarters} * pi / 2 + {}", self.1.text()),
        }
    }

    fn value(self) -> Double {
        Double::PI * Double::new(self.0 as f64 / 2.0) + self.1.value()
    }
}

/// A joint with its pose on the previous link, and the body that it moves.
#[derive(Clone, Debug)]
pub struct Joint {
    pub slides: bool,
    /// Index of its axis in its frame.
    pub axis: usize,
    /// Rotations about the axes 1, 2, 3 in URDF's order.
    pub rpy: [Angle; 3],
    pub place: [Decimal; 3],
    pub mass: Decimal,
    pub com: [Decimal; 3],
    /// Principal moments about the centre of mass.
    pub moments: [Decimal; 3],
}

/// A chain of joints.
#[derive(Clone, Debug)]
pub struct Arm(pub Vec<Joint>);

/// Number of cases for the relative position of neighbouring axes.
const AXIS_PLACEMENTS: usize = 5;

impl Arm {
    /// Returns an arm with axes 10^-1 … 10^-16 rad from parallel or perpendicular, and as many metres from
    /// intersecting.
    pub fn awkward(random: &mut Random) -> Arm {
        let count = 2 + random.below(5);
        Arm((0..count).map(|i| Joint::awkward(random, i)).collect())
    }

    pub fn text(&self) -> String {
        let mut text = String::from(
            "system Arm { generate accel, mass_matrix, bias, potential_force; gravity [0, 0, -9.81];\n",
        );
        for (i, joint) in self.0.iter().enumerate() {
            let on = i
                .checked_sub(1)
                .map_or(String::new(), |b| format!("on f{b}"));
            let kind = if joint.slides {
                "prismatic"
            } else {
                "revolute"
            };
            let axis: [u8; 3] = std::array::from_fn(|k| u8::from(k == joint.axis));
            let [r, p, y] = joint.rpy.map(Angle::text);
            let place = joint.place.map(Decimal::text).join(", ");
            text += &format!(
                "    input u{i}; joint j{i}: {kind} {axis:?} {on} at pose(rpy({r}, {p}, {y}), [{place}]) moves f{i} {{ force u{i}; }}\n"
            );
            let com = joint.com.map(Decimal::text).join(", ");
            let moments = joint.moments.map(Decimal::text).join(", ");
            let mass = joint.mass.text();
            text += &format!(
                "    body on f{i} {{ mass {mass}; com [{com}]; inertia diag({moments}) about com; }}\n"
            );
        }
        text + "}\n"
    }

    /// Returns M, the bias and the slope of the potential at (x, ξ).
    pub fn dynamics(&self, x: &[f64], xi: &[f64]) -> Dynamics {
        let n = self.0.len();
        let zero3 = [Double::ZERO; 3];
        let mut dynamics = Dynamics {
            mass: vec![vec![Double::ZERO; n]; n],
            bias: vec![Double::ZERO; n],
            slope: vec![Double::ZERO; n],
        };
        let (mut turn, mut origin) = (identity(), zero3);
        // The motion of the frame at ξ̇ = 0: ω, its rate, velocity and acceleration of the origin.
        let (mut w, mut alpha, mut v, mut a) = (zero3, zero3, zero3, zero3);
        let mut columns: Vec<(bool, V3, V3)> = Vec::new();
        for (i, joint) in self.0.iter().enumerate() {
            let (q, rate) = (Double::new(x[i]), Double::new(xi[i]));
            let base = times(&turn, &joint.turn());
            let axis: V3 = std::array::from_fn(|row| base[row][joint.axis]);
            let mut arm = apply(&turn, &joint.place.map(Decimal::value));
            turn = base;
            let slide = scale(rate, &axis);
            if joint.slides {
                arm = add(&arm, &scale(q, &axis));
            }
            let (spun, lifted) = (cross(&w, &arm), cross(&alpha, &arm));
            a = add(&add(&a, &lifted), &cross(&w, &spun));
            v = add(&v, &spun);
            origin = add(&origin, &arm);
            if joint.slides {
                a = add(&a, &scale(Double::new(2.0), &cross(&w, &slide)));
                v = add(&v, &slide);
            } else {
                turn = times(&turn, &about(joint.axis, q));
                alpha = add(&alpha, &cross(&w, &slide));
                w = add(&w, &slide);
            }
            columns.push((joint.slides, axis, origin));
            let mass = joint.mass.value();
            let lever = apply(&turn, &joint.com.map(Decimal::value));
            let centre = add(&origin, &lever);
            let theta = joint.inertia(&turn);
            let lifted = add(&cross(&alpha, &lever), &cross(&w, &cross(&w, &lever)));
            let force = scale(mass, &add(&a, &lifted));
            let torque = add(&apply(&theta, &alpha), &cross(&w, &apply(&theta, &w)));
            let weight = [Double::ZERO, Double::ZERO, mass * Double::new(9.81)];
            let moved: Vec<(V3, V3)> = columns
                .iter()
                .map(|(slides, axis, point)| match slides {
                    true => (zero3, *axis),
                    false => (
                        *axis,
                        cross(axis, &add(&centre, &scale(-Double::ONE, point))),
                    ),
                })
                .collect();
            for (j, (spin, speed)) in moved.iter().enumerate() {
                dynamics.bias[j] = dynamics.bias[j] + dot(spin, &torque) + dot(speed, &force);
                dynamics.slope[j] = dynamics.slope[j] + dot(speed, &weight);
                for (k, (other, velocity)) in moved.iter().enumerate() {
                    let entry = mass * dot(speed, velocity) + dot(spin, &apply(&theta, other));
                    dynamics.mass[j][k] = dynamics.mass[j][k] + entry;
                }
            }
        }
        dynamics
    }
}

impl Joint {
    fn awkward(random: &mut Random, index: usize) -> Joint {
        let power = -(1 + random.below(16) as i32);
        let still = Angle(0, Decimal(0, 0));
        let mut place = [(); 3].map(|()| Decimal::random(random, 0));
        let small = |random: &mut Random| Decimal::random(random, power);
        let (a, b, c) = (small(random), small(random), small(random));
        let any = Angle(0, Decimal::random(random, 0));
        let rpy = match random.below(AXIS_PLACEMENTS) {
            // Almost parallel, with any rotation about the axis.
            0 => [Angle(0, a), Angle(0, b), any],
            // Almost antiparallel.
            1 => [Angle(2, a), Angle(0, b), Angle(random.below(4) as i64, c)],
            // Almost perpendicular.
            2 => [Angle(1, a), Angle(0, b), Angle(random.below(4) as i64, c)],
            // Almost intersecting at any angle.
            3 => {
                place = [a, b, place[2]];
                [any, Angle(0, Decimal::random(random, 0)), any]
            }
            // Almost parallel and almost intersecting.
            _ => {
                place = [c, a, place[2]];
                [Angle(0, a), Angle(0, b), still]
            }
        };
        Joint {
            slides: index > 0 && random.below(8) == 0,
            axis: if random.below(4) == 0 {
                random.below(3)
            } else {
                2
            },
            rpy,
            place,
            mass: Decimal(1 + random.below(9) as i64, 0),
            com: [(); 3].map(|()| Decimal::random(random, 0)),
            moments: [(); 3].map(|()| Decimal(60 + random.below(40) as i64, -2)),
        }
    }

    /// Returns the axes of its mounting in those of the previous link.
    fn turn(&self) -> M3 {
        let [r, p, y] = self.rpy.map(Angle::value);
        times(&times(&about(2, y), &about(1, p)), &about(0, r))
    }

    fn inertia(&self, turn: &M3) -> M3 {
        let moments = self.moments.map(Decimal::value);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let terms = (0..3).map(|k| turn[i][k] * moments[k] * turn[j][k]);
                terms.fold(Double::ZERO, |sum, term| sum + term)
            })
        })
    }
}

/// The terms of the equations of motion.
pub struct Dynamics {
    pub mass: Vec<Vec<Double>>,
    pub bias: Vec<Double>,
    pub slope: Vec<Double>,
}

impl Dynamics {
    /// Returns M⁻¹ b by Gaussian elimination; M is positive definite.
    pub fn solve(&self, b: &[Double]) -> Vec<Double> {
        let n = b.len();
        let (mut m, mut b) = (self.mass.clone(), b.to_vec());
        for k in 0..n {
            for i in k + 1..n {
                let factor = m[i][k] / m[k][k];
                for j in k..n {
                    m[i][j] = m[i][j] - factor * m[k][j];
                }
                b[i] = b[i] - factor * b[k];
            }
        }
        for k in (0..n).rev() {
            for j in k + 1..n {
                b[k] = b[k] - m[k][j] * b[j];
            }
            b[k] = b[k] / m[k][k];
        }
        b
    }

    /// Returns ‖M‖ ‖M⁻¹‖ in the row-sum norm.
    pub fn condition(&self) -> f64 {
        let n = self.mass.len();
        let unit = |k: usize| -> Vec<Double> {
            (0..n)
                .map(|i| Double::new(if i == k { 1.0 } else { 0.0 }))
                .collect()
        };
        let norm = |rows: &[Vec<Double>]| {
            let sums = rows
                .iter()
                .map(|row| row.iter().map(|e| e.abs().to_f64()).sum::<f64>());
            sums.fold(0.0, f64::max)
        };
        let inverse: Vec<Vec<Double>> = (0..n).map(|k| self.solve(&unit(k))).collect();
        norm(&self.mass) * norm(&inverse)
    }
}

fn identity() -> M3 {
    about(0, Double::ZERO)
}

fn about(axis: usize, angle: Double) -> M3 {
    let (s, c) = angle.sin_cos();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turn = [[Double::ZERO; 3]; 3];
    turn[axis][axis] = Double::ONE;
    (turn[i][i], turn[j][j]) = (c, c);
    (turn[i][j], turn[j][i]) = (-s, s);
    turn
}

fn times(a: &M3, b: &M3) -> M3 {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j])
    })
}

fn apply(a: &M3, v: &V3) -> V3 {
    std::array::from_fn(|i| dot(&a[i], v))
}

fn dot(a: &V3, b: &V3) -> Double {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: &V3, b: &V3) -> V3 {
    std::array::from_fn(|i| a[i] + b[i])
}

fn scale(k: Double, v: &V3) -> V3 {
    v.map(|entry| k * entry)
}

fn cross(a: &V3, b: &V3) -> V3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}
