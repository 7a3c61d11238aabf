//! Closed-form rates, as edges and as statements.

use super::{MotionKind, VelocityKind};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Mat3, apply3, multiply3};
use hamel_language::model::layout::blocks;
use hamel_language::model::rotations::{hat, quaternion_matrix};
use hamel_language::model::{Coordinate, Model};
use hamel_language::syntax::ast::CoordKind;

/// Kinematic equations ẋ = A' ξ' in other velocities, under construction.
pub struct RateDraft<'a> {
    model: &'a Model,
    graph: &'a mut Graph,
    /// ẋ so far.
    pub rate: Vec<Edge>,
    /// Number of velocities used so far.
    used: usize,
    names: Names,
    /// The `rate` statements.
    statements: Vec<String>,
    /// Description of the choice in words.
    pub label: Vec<String>,
}

/// Names for velocities: v, w, u, numbered from the second one of a letter on.
#[derive(Default)]
struct Names {
    declared: Vec<String>,
    counts: [usize; 3],
}

impl Names {
    /// Returns a new name that the model uses for nothing other than velocities.
    fn new_name(&mut self, model: &Model, letter: usize, shape: &str) -> String {
        let base = ["v", "w", "u"][letter];
        let taken = |name: &str| {
            let params = model.params.iter().chain(&model.inputs);
            params.map(|group| &group.name).any(|known| known == name)
                || model.coordinates.iter().any(|c| c.name == name)
                || model.lets.iter().any(|(known, _)| known == name)
                || model.frames.iter().any(|frame| frame.name == name)
        };
        let name = loop {
            self.counts[letter] += 1;
            let name = match self.counts[letter] {
                1 => base.to_string(),
                count => format!("{base}{count}"),
            };
            if !taken(&name) {
                break name;
            }
        };
        self.declared.push(format!("{name}{shape}"));
        name
    }
}

impl<'a> RateDraft<'a> {
    /// Creates a draft without rates; `graph` is an extension of the model's graph.
    pub fn new(model: &'a Model, graph: &'a mut Graph) -> Self {
        RateDraft {
            model,
            rate: vec![graph.zero(); model.nu()],
            graph,
            used: 0,
            names: Names::default(),
            statements: Vec::new(),
            label: Vec::new(),
        }
    }

    /// Returns all statements, beginning with the declaration of the velocities.
    pub fn statements(&self) -> Vec<String> {
        let declared = format!("velocity {};", self.names.declared.join(", "));
        std::iter::once(declared)
            .chain(self.statements.iter().cloned())
            .collect()
    }

    /// Adds the rate of a part for one choice of velocity coordinates.
    pub fn add_part(&mut self, moves: &MotionKind, way: VelocityKind) {
        match moves {
            MotionKind::Rotation(index) => self.rotation(*index, way),
            MotionKind::Point(index) => self.point(*index, way),
            MotionKind::Chain(indices) => self.chain(indices, way),
            MotionKind::Plain(index) => self.plain(*index),
        }
    }

    fn velocities(&mut self, count: usize) -> Vec<Edge> {
        let first = self.used;
        self.used += count;
        self.model.xi[first..self.used].to_vec()
    }

    /// Returns the rotation matrix of a coordinate.
    fn matrix(&mut self, index: usize) -> Mat3 {
        let coordinate = &self.model.coordinates[index];
        let x = &self.model.x[rotation_offset(coordinate)..];
        match coordinate.kind {
            CoordKind::S3 => quaternion_matrix(self.graph, [x[0], x[1], x[2], x[3]]),
            _ => std::array::from_fn(|i| std::array::from_fn(|j| x[3 * i + j])),
        }
    }

    /// Adds the rate of a rotation: Ṙ = R ω̂ or ω̂ R; for quaternions q̇ = ½ q ∘ (0, ω) or ½ (0, ω) ∘ q.
    fn rotation(&mut self, index: usize, way: VelocityKind) {
        let coordinate = &self.model.coordinates[index];
        let w = self.velocities(3);
        let w = [w[0], w[1], w[2]];
        let name = self.names.new_name(self.model, 1, ": vec3");
        let world = way == VelocityKind::World;
        let target = match coordinate.kind {
            CoordKind::SE3 => format!("{}.R", coordinate.name),
            _ => coordinate.name.clone(),
        };
        let axes = if world { "world" } else { "body" };
        self.label.push(format!("{target} turned in {axes} axes"));
        let (rate, left, right) = if coordinate.kind == CoordKind::S3 {
            let x = self.model.x[coordinate.offset..coordinate.offset + 4].to_vec();
            let pure = format!("[0, {name}[1], {name}[2], {name}[3]]");
            (self.quaternion_rate(&x, w, world), target.clone(), pure)
        } else {
            let (r, spin) = (self.matrix(index), hat(self.graph, w));
            let product = if world {
                multiply3(self.graph, &spin, &r)
            } else {
                multiply3(self.graph, &r, &spin)
            };
            (product.concat(), target.clone(), format!("hat({name})"))
        };
        let (left, right) = if world { (right, left) } else { (left, right) };
        self.statements.push(match coordinate.kind {
            CoordKind::S3 => format!("rate {target} = qmul({left}, {right}) / 2;"),
            _ => format!("rate {target} = {left} * {right};"),
        });
        let first = rotation_offset(coordinate);
        self.rate[first..first + rate.len()].copy_from_slice(&rate);
    }

    /// Returns q̇; the vector parts of q ∘ (0, ω) and (0, ω) ∘ q differ in the sign of q × ω.
    fn quaternion_rate(&mut self, q: &[Edge], w: [Edge; 3], world: bool) -> Vec<Edge> {
        let graph = &mut *self.graph;
        let half = graph.ratio(1, 2);
        let along = graph.dot(&q[1..], &w);
        let mut rate = vec![graph.mul(half, -along)];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let straight = graph.mul(q[0], w[i]);
            let (plus, minus) = (graph.mul(q[1 + j], w[k]), graph.mul(q[1 + k], w[j]));
            let turned = graph.sub(plus, minus).signed(world);
            let sum = graph.add(straight, turned);
            rate.push(graph.mul(half, sum));
        }
        rate
    }

    fn point(&mut self, index: usize, way: VelocityKind) {
        let coordinate = &self.model.coordinates[index];
        let v = self.velocities(3);
        let name = self.names.new_name(self.model, 0, ": vec3");
        let target = match coordinate.kind {
            CoordKind::SE3 => format!("{}.p", coordinate.name),
            _ => coordinate.name.clone(),
        };
        let mut rate = [v[0], v[1], v[2]];
        match way {
            VelocityKind::Body(rotation) => {
                let r = self.matrix(rotation);
                rate = apply3(self.graph, &r, rate);
                let axes = &self.model.coordinates[rotation];
                let matrix = match axes.kind {
                    CoordKind::S3 => format!("rot({})", axes.name),
                    CoordKind::SE3 => format!("{}.R", axes.name),
                    _ => axes.name.clone(),
                };
                self.statements
                    .push(format!("rate {target} = {matrix} * {name};"));
                self.label
                    .push(format!("{target} moved in the axes of {}", axes.name));
            }
            _ => {
                self.statements.push(format!("rate {target} = {name};"));
                self.label.push(format!("{target} moved in world axes"));
            }
        }
        self.rate[coordinate.offset..coordinate.offset + 3].copy_from_slice(&rate);
    }

    fn chain(&mut self, indices: &[usize], way: VelocityKind) {
        let u = self.velocities(indices.len());
        let names: Vec<String> = indices
            .iter()
            .map(|_| self.names.new_name(self.model, 2, ""))
            .collect();
        for (place, &index) in indices.iter().enumerate() {
            let coordinate = &self.model.coordinates[index];
            let (turn, text) = match way {
                VelocityKind::Differences if place > 0 => (
                    self.graph.sub(u[place], u[place - 1]),
                    format!("{} - {}", names[place], names[place - 1]),
                ),
                VelocityKind::Sums => (self.graph.sum(&u[..=place]), names[..=place].join(" + ")),
                _ => (u[place], names[place].clone()),
            };
            let at = coordinate.offset;
            if coordinate.kind == CoordKind::S1 {
                let (c, s) = (self.model.x[at], self.model.x[at + 1]);
                self.rate[at] = -self.graph.mul(s, turn);
                self.rate[at + 1] = self.graph.mul(c, turn);
            } else {
                self.rate[at] = turn;
            }
            self.statements
                .push(format!("rate {} = {text};", coordinate.name));
        }
        let all: Vec<&str> = indices
            .iter()
            .map(|&index| self.model.coordinates[index].name.as_str())
            .collect();
        let how = match way {
            VelocityKind::Differences => "by differences of rates",
            VelocityKind::Sums => "by sums of rates",
            _ => "each by its own rate",
        };
        self.label.push(format!("{} turned {how}", all.join(", ")));
    }

    fn plain(&mut self, index: usize) {
        let coordinate = &self.model.coordinates[index];
        let count = blocks(coordinate.kind)
            .iter()
            .map(|block| block.len())
            .sum();
        let v = self.velocities(count);
        let shape = match coordinate.kind {
            CoordKind::Euclidean(n) => format!(": vec{n}"),
            _ => String::new(),
        };
        let name = self.names.new_name(self.model, 0, &shape);
        self.rate[coordinate.offset..coordinate.offset + count].copy_from_slice(&v);
        self.statements
            .push(format!("rate {} = {name};", coordinate.name));
    }
}

/// Returns the offset of a coordinate's rotation in x.
fn rotation_offset(coordinate: &Coordinate) -> usize {
    match coordinate.kind {
        CoordKind::SE3 => coordinate.offset + 3,
        _ => coordinate.offset,
    }
}
