//! Robots as described, and their dynamics computed from the definitions in double-double arithmetic: M = Σ m Jᵀ
//! J + J_ωᵀ Θ J_ω over the bodies, forces by the Newton–Euler equations, all in world axes. Only the generator's syntax
//! tree and numbers are used.

use hamel_codegen::algebra::double::Double;
use hamel_codegen::syntax::ast::{
    About, BinaryOp, Body, Expr, ExprKind, ItemKind, Joint, JointKind, System,
};
use std::collections::HashMap;

pub type V3 = [Double; 3];
pub type M3 = [V3; 3];

const ZERO: V3 = [Double::ZERO; 3];

/// A tree of joints and bodies.
pub struct Robot<'a> {
    joints: Vec<&'a Joint>,
    bodies: Vec<&'a Body>,
    gravity: V3,
}

/// A freedom of a link: its angular velocity, and the velocity of a point that moves with the link.
#[derive(Clone, Copy)]
struct Column {
    index: usize,
    spin: V3,
    velocity: V3,
    point: V3,
}

/// Pose of a link, its acceleration at ξ̇ = 0, and its freedoms.
#[derive(Clone)]
struct Place {
    turn: M3,
    origin: V3,
    w: V3,
    alpha: V3,
    a: V3,
    columns: Vec<Column>,
}

/// Terms of the equations of motion.
pub struct Dynamics {
    pub mass: Vec<Vec<Double>>,
    pub bias: Vec<Double>,
    pub slope: Vec<Double>,
}

impl<'a> Robot<'a> {
    /// `None` if a joint follows another one, or if there are no freedoms.
    pub fn of(system: &'a System) -> Option<Self> {
        let mut robot = Robot {
            joints: Vec::new(),
            bodies: Vec::new(),
            gravity: ZERO,
        };
        for item in &system.items {
            match &item.kind {
                ItemKind::Joint(joint) if joint.follows.is_some() => return None,
                ItemKind::Joint(joint) => robot.joints.push(joint),
                ItemKind::Body(body) => robot.bodies.push(body),
                ItemKind::Gravity(gravity) => robot.gravity = vector(gravity),
                _ => {}
            }
        }
        Some(robot)
    }

    /// M, the bias and the gradient of the potential at (x, ξ).
    pub fn dynamics(&self, x: &[f64], xi: &[f64]) -> Dynamics {
        let n = xi.len();
        let mut places: HashMap<&str, Place> = HashMap::new();
        let world = Place {
            turn: about(
                [0.0, 0.0, 1.0].map(Double::new),
                (Double::ONE, Double::ZERO),
            ),
            origin: ZERO,
            w: ZERO,
            alpha: ZERO,
            a: ZERO,
            columns: Vec::new(),
        };
        let (mut x, mut index) = (x, 0);
        for joint in &self.joints {
            let on = joint
                .on
                .as_ref()
                .and_then(|on| places.get(on.name.as_str()));
            let mut place = on.unwrap_or(&world).clone();
            if let Some(at) = &joint.at {
                let (turn, shift) = pose(at);
                place.shift(&shift);
                place.turn = times(&place.turn, &turn);
            }
            let (size, freedoms) = sizes(joint.kind.0);
            let (own, rest) = x.split_at(size);
            place.join(joint, own, &xi[index..index + freedoms], index);
            (x, index) = (rest, index + freedoms);
            places.insert(joint.moves.name.as_str(), place);
        }
        assert!(x.is_empty() && index == n);
        let mut dynamics = Dynamics {
            mass: vec![vec![Double::ZERO; n]; n],
            bias: vec![Double::ZERO; n],
            slope: vec![Double::ZERO; n],
        };
        for body in &self.bodies {
            if let Some(place) = places.get(body.frame.name.as_str()) {
                dynamics.add(place, body, &self.gravity);
            }
        }
        dynamics
    }
}

impl Place {
    /// Moves the origin to a point of the link.
    fn shift(&mut self, by: &V3) {
        let arm = apply(&self.turn, by);
        self.a = add(&self.a, &self.lifted(&arm));
        self.origin = add(&self.origin, &arm);
    }

    /// The acceleration of a point of the link relative to the origin.
    fn lifted(&self, arm: &V3) -> V3 {
        add(
            &cross(&self.alpha, arm),
            &cross(&self.w, &cross(&self.w, arm)),
        )
    }

    fn push(&mut self, index: usize, spin: V3, velocity: V3) {
        let point = self.origin;
        self.columns.push(Column {
            index,
            spin,
            velocity,
            point,
        });
    }

    fn join(&mut self, joint: &Joint, x: &[f64], xi: &[f64], index: usize) {
        let x: Vec<Double> = x.iter().copied().map(Double::new).collect();
        let xi: Vec<Double> = xi.iter().copied().map(Double::new).collect();
        let axis = joint.axes.first().map(|axis| unit(&vector(axis)));
        match (joint.kind.0, axis) {
            (JointKind::Fixed, _) => {}
            (JointKind::Revolute | JointKind::Continuous, Some(axis)) => {
                let angle = match x[..] {
                    [angle] => {
                        let (s, c) = angle.sin_cos();
                        (c, s)
                    }
                    _ => (x[0], x[1]),
                };
                let spin = apply(&self.turn, &axis);
                let rate = scale(xi[0], &spin);
                self.alpha = add(&self.alpha, &cross(&self.w, &rate));
                self.w = add(&self.w, &rate);
                self.turn = times(&self.turn, &about(axis, angle));
                self.push(index, spin, ZERO);
            }
            (JointKind::Prismatic, Some(axis)) => {
                let velocity = apply(&self.turn, &axis);
                self.shift(&scale(x[0], &axis));
                let coriolis = cross(&self.w, &scale(xi[0], &velocity));
                self.a = add(&self.a, &scale(Double::new(2.0), &coriolis));
                self.push(index, ZERO, velocity);
            }
            (JointKind::Free, _) => {
                assert!(self.columns.is_empty(), "a free joint stands in the world");
                self.origin = [x[0], x[1], x[2]];
                self.turn = std::array::from_fn(|i| std::array::from_fn(|j| x[3 + 3 * i + j]));
                let [v, w] = [[xi[0], xi[1], xi[2]], [xi[3], xi[4], xi[5]]];
                self.w = apply(&self.turn, &w);
                self.a = cross(&self.w, &apply(&self.turn, &v));
                for k in 0..3 {
                    let axis: V3 = std::array::from_fn(|row| self.turn[row][k]);
                    self.push(index + k, ZERO, axis);
                }
                for k in 0..3 {
                    let axis: V3 = std::array::from_fn(|row| self.turn[row][k]);
                    self.push(index + 3 + k, axis, ZERO);
                }
            }
            (kind, _) => panic!("URDF has no joints of the kind {kind:?}"),
        }
    }
}

impl Dynamics {
    fn add(&mut self, place: &Place, body: &Body, gravity: &V3) {
        let mass = body.mass.as_ref().map_or(Double::ZERO, number);
        let com = body.com.as_ref().map_or(ZERO, vector);
        let lever = apply(&place.turn, &com);
        let centre = add(&place.origin, &lever);
        let theta = body.inertia.as_ref().map_or([ZERO; 3], |(inertia, about)| {
            assert!(
                matches!(about, Some(About::Com)),
                "URDF has inertias about centres of mass"
            );
            let turned = times(&place.turn, &matrix(inertia));
            times(&turned, &transposed(&place.turn))
        });
        let force = scale(mass, &add(&place.a, &place.lifted(&lever)));
        let spun = cross(&place.w, &apply(&theta, &place.w));
        let torque = add(&apply(&theta, &place.alpha), &spun);
        let moved: Vec<(usize, V3, V3)> = place
            .columns
            .iter()
            .map(|column| {
                let arm = add(&centre, &scale(-Double::ONE, &column.point));
                let velocity = add(&column.velocity, &cross(&column.spin, &arm));
                (column.index, column.spin, velocity)
            })
            .collect();
        for (i, spin, velocity) in &moved {
            self.bias[*i] = self.bias[*i] + dot(spin, &torque) + dot(velocity, &force);
            self.slope[*i] = self.slope[*i] - mass * dot(velocity, gravity);
            for (j, other, speed) in &moved {
                let entry = mass * dot(velocity, speed) + dot(spin, &apply(&theta, other));
                self.mass[*i][*j] = self.mass[*i][*j] + entry;
            }
        }
    }

    /// M⁻¹ b by Gaussian elimination; M is positive definite.
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

    /// ‖M‖ ‖M⁻¹‖ in the maximum row sum norm.
    pub fn condition(&self) -> f64 {
        let n = self.mass.len();
        let column = |k: usize| -> Vec<Double> {
            (0..n)
                .map(|i| if i == k { Double::ONE } else { Double::ZERO })
                .collect()
        };
        let norm = |rows: &[Vec<Double>]| {
            let sums = rows
                .iter()
                .map(|row| row.iter().map(|e| e.abs().to_f64()).sum());
            sums.fold(0.0, f64::max)
        };
        let inverse: Vec<Vec<Double>> = (0..n).map(|k| self.solve(&column(k))).collect();
        norm(&self.mass) * norm(&inverse)
    }
}

/// Numbers of entries of x and of ξ.
fn sizes(kind: JointKind) -> (usize, usize) {
    match kind {
        JointKind::Fixed => (0, 0),
        JointKind::Continuous => (2, 1),
        JointKind::Free => (12, 6),
        _ => (1, 1),
    }
}

/// Values of expressions as the descriptions of robots write them.
fn number(expression: &Expr) -> Double {
    match &expression.kind {
        ExprKind::Number(number) => Double::of_rational(&number.value),
        ExprKind::Name(name) if name == "pi" => Double::PI,
        ExprKind::Neg(inner) => -number(inner),
        ExprKind::Binary(op, a, b) => {
            let (a, b) = (number(a), number(b));
            match op {
                BinaryOp::Add => a + b,
                BinaryOp::Sub => a - b,
                BinaryOp::Mul => a * b,
                BinaryOp::Div => a / b,
                BinaryOp::Pow => panic!("a power in a robot"),
            }
        }
        other => panic!("no number: {other:?}"),
    }
}

fn list(expression: &Expr) -> &[Expr] {
    match &expression.kind {
        ExprKind::Array(entries) => entries,
        other => panic!("no list: {other:?}"),
    }
}

fn vector(expression: &Expr) -> V3 {
    let entries = list(expression);
    std::array::from_fn(|i| number(&entries[i]))
}

fn call(expression: &Expr) -> (&str, &[Expr]) {
    match &expression.kind {
        ExprKind::Call(name, arguments) => (name.name.as_str(), arguments),
        other => panic!("no call: {other:?}"),
    }
}

fn matrix(expression: &Expr) -> M3 {
    match &expression.kind {
        ExprKind::Array(rows) => return std::array::from_fn(|i| vector(&rows[i])),
        ExprKind::Binary(BinaryOp::Mul, a, b) => return times(&matrix(a), &matrix(b)),
        ExprKind::Field(inner, _) => return transposed(&matrix(inner)),
        _ => {}
    }
    let axis = |k: usize| std::array::from_fn(|i| if i == k { Double::ONE } else { Double::ZERO });
    let turned = |k: usize, angle: &Expr| {
        let (s, c) = number(angle).sin_cos();
        about(axis(k), (c, s))
    };
    match call(expression) {
        ("diag", entries) => std::array::from_fn(|i| scale(number(&entries[i]), &axis(i))),
        ("transpose", [inner]) => transposed(&matrix(inner)),
        ("identity", _) => std::array::from_fn(axis),
        ("rotx", angle) => turned(0, &angle[0]),
        ("roty", angle) => turned(1, &angle[0]),
        ("rotz", angle) => turned(2, &angle[0]),
        ("rpy", [r, p, y]) => times(&times(&turned(2, y), &turned(1, p)), &turned(0, r)),
        (other, _) => panic!("no rotation of a robot: {other}"),
    }
}

fn pose(expression: &Expr) -> (M3, V3) {
    match call(expression) {
        ("pose", [turn, shift]) => (matrix(turn), vector(shift)),
        (other, _) => panic!("no pose: {other}"),
    }
}

fn unit(v: &V3) -> V3 {
    let length = dot(v, v).sqrt();
    v.map(|entry| entry / length)
}

/// Rodrigues' formula, for a unit axis and the cosine and sine of the angle.
fn about(n: V3, (c, s): (Double, Double)) -> M3 {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let mut entry = (Double::ONE - c) * n[i] * n[j];
            if i == j {
                entry = entry + c;
            } else {
                let k = 3 - i - j;
                let sign = if (i + 1) % 3 == j {
                    -Double::ONE
                } else {
                    Double::ONE
                };
                entry = entry + sign * s * n[k];
            }
            entry
        })
    })
}

fn transposed(a: &M3) -> M3 {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
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
