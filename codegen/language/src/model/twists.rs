//! Numerical motions of frames: their twists for each velocity, and the mass matrix that follows. Derivatives are
//! evaluated numerically; none is built as an expression.

use super::{Body, Frame, Particle};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{Mat3, Vec3};
use crate::algebra::numeric::evaluate;
use crate::algebra::slopes::{ValueWithSlopes, slopes};

/// Angular velocity and velocity of a frame's origin for one unit velocity, in world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Twist {
    /// Angular velocity ω (rad/s).
    pub spin: [f64; 3],
    /// Velocity of the origin (m/s).
    pub speed: [f64; 3],
}

/// Axes of a frame at a given state, with its twist for each velocity, in numbers.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Axes of the frame in the world, by columns.
    pub rotation: [[f64; 3]; 3],
    /// Twist for each velocity.
    pub twists: Vec<Twist>,
}

/// Graph, A and places of x and ξ, from which twists of frames are evaluated in numbers.
#[derive(Clone, Copy)]
pub struct KinematicExpressions<'a> {
    /// Graph of all expressions.
    pub graph: &'a Graph,
    /// Rows of A.
    pub a: &'a [Vec<Edge>],
    /// Index of the symbol of the first coordinate.
    pub first: usize,
    /// Index of the symbol of the first velocity.
    pub velocity: usize,
    /// Number of velocities.
    pub n: usize,
}

impl KinematicExpressions<'_> {
    /// Evaluates the columns of A as directions in the space of all symbols.
    pub fn directions(&self, numbers: &[f64]) -> Vec<Vec<f64>> {
        let a = evaluate(self.graph, &self.a.concat(), numbers);
        let column = |i: usize| {
            let mut direction = vec![0.0; self.first];
            direction.extend(a.chunks(self.n.max(1)).map(|row| row[i]));
            direction
        };
        (0..self.n).map(column).collect()
    }

    /// Evaluates axes and twists of frames at a state.
    pub fn frames(&self, frames: &[Frame], numbers: &[f64]) -> Vec<Placed> {
        let directions = self.directions(numbers);
        let entries = frames.iter().flat_map(|f| pose(&f.rotation, f.position));
        let entries: Vec<Edge> = entries.collect();
        let sloped = slopes(self.graph, &entries, numbers, &directions);
        let frames = sloped.chunks(12);
        frames.map(|entries| placed(entries, self.n)).collect()
    }

    /// Evaluates M, by rows, of bodies, particles and a kinetic energy that the user wrote.
    pub fn mass(
        &self,
        frames: &[Frame],
        (bodies, particles, kinetic): (&[Body], &[Particle], Edge),
        numbers: &[f64],
    ) -> Vec<Vec<f64>> {
        let n = self.n;
        let mut mass = vec![vec![0.0; n]; n];
        let placed = self.frames(frames, numbers);
        for body in bodies {
            let mut entries = vec![body.mass];
            entries.extend(body.com);
            entries.extend(body.inertia_com.concat());
            let values = evaluate(self.graph, &entries, numbers);
            let (s, inertia) = ([values[1], values[2], values[3]], &values[4..]);
            let frame = &placed[body.frame];
            let arm = apply(&frame.rotation, s);
            let moved: Vec<([f64; 3], [f64; 3])> = frame
                .twists
                .iter()
                .map(|twist| {
                    let turning = cross(twist.spin, arm);
                    let speed = std::array::from_fn(|k| twist.speed[k] + turning[k]);
                    (back(&frame.rotation, twist.spin), speed)
                })
                .collect();
            for (i, (spin, speed)) in moved.iter().enumerate() {
                let momentum: [f64; 3] =
                    std::array::from_fn(|k| (0..3).map(|l| inertia[3 * k + l] * spin[l]).sum());
                for (j, (other, faster)) in moved.iter().enumerate() {
                    mass[i][j] += values[0] * dot(speed, faster) + dot(&momentum, other);
                }
            }
        }
        let directions = self.directions(numbers);
        for particle in particles {
            let weight = evaluate(self.graph, &[particle.mass], numbers)[0];
            let moved = slopes(self.graph, &particle.position, numbers, &directions);
            for (i, row) in mass.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    let product = moved.iter().map(|p| p.slope(i) * p.slope(j));
                    *entry += weight * product.sum::<f64>();
                }
            }
        }
        self.add_kinetic(kinetic, numbers, &mut mass);
        mass
    }

    /// Adds ∂²T/∂ξⁱ∂ξʲ of a quadratic T, computed from values of T.
    fn add_kinetic(&self, kinetic: Edge, numbers: &[f64], mass: &mut [Vec<f64>]) {
        if kinetic.abs() == self.graph.zero() {
            return;
        }
        let energy = |moving: &[usize]| {
            let mut numbers = numbers.to_vec();
            numbers[self.velocity..self.velocity + self.n].fill(0.0);
            moving
                .iter()
                .for_each(|i| numbers[self.velocity + i] += 1.0);
            evaluate(self.graph, &[kinetic], &numbers)[0]
        };
        let alone: Vec<f64> = (0..self.n).map(|i| energy(&[i])).collect();
        for i in 0..self.n {
            mass[i][i] += 2.0 * alone[i];
            for j in 0..i {
                let both = energy(&[i, j]) - alone[i] - alone[j];
                mass[i][j] += both;
                mass[j][i] += both;
            }
        }
    }
}

fn pose(rotation: &Mat3, position: Vec3) -> Vec<Edge> {
    [rotation.concat(), position.to_vec()].concat()
}

fn placed(entries: &[ValueWithSlopes], n: usize) -> Placed {
    let rotation = std::array::from_fn(|i| std::array::from_fn(|j| entries[3 * i + j].value));
    let twists = (0..n).map(|i| {
        // ω̂ = Ṙ Rᵀ
        let skew = |row: usize, column: usize| -> f64 {
            let product = |k: usize| entries[3 * row + k].slope(i) * entries[3 * column + k].value;
            (0..3).map(product).sum()
        };
        Twist {
            spin: [skew(2, 1), skew(0, 2), skew(1, 0)],
            speed: std::array::from_fn(|k| entries[9 + k].slope(i)),
        }
    });
    let twists = twists.collect();
    Placed { rotation, twists }
}

/// Returns R a in numbers.
pub fn apply(rotation: &[[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    rotation.map(|row| dot(&row, &a))
}

/// Returns Rᵀ a in numbers.
pub fn back(rotation: &[[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| (0..3).map(|l| rotation[l][k] * a[l]).sum())
}

/// Returns a × b.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let entry = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [entry(1, 2), entry(2, 0), entry(0, 1)]
}

/// Returns ⟨a, b⟩.
pub fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
