//! The expressions of a model that are evaluated, as tapes, and how their values are read.

use super::motion::pose_entries;
use super::space::{Mat3, Vec3};
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::tape::Tape;
use hamel_dynamics::{energy, kinematics};
use hamel_language::model::Model;
use hamel_language::model::elements::Along;

/// A model with tapes of the expressions from which [`FormEvaluator`](super::FormEvaluator) computes the forms modulo
/// p.
pub struct FormTapes {
    /// The model; its graph contains Y and V.
    pub model: Model,
    /// A by rows, ẋ, Y by rows.
    pub kinematics: Tape,
    /// V, V without gravity on bodies and particles, the kinetic energy that the user wrote; frames; points of
    /// particles and lines.
    pub poses: Tape,
    /// The kinetic energy that the user wrote, the dissipation, the rates along which dampers act.
    pub velocity: Tape,
    /// ξ, ξ̇, gravity, inertias, loads.
    pub constants: Tape,
    /// Indices of the frames, in their order in `poses`.
    pub frames: Vec<usize>,
    x: Vec<usize>,
    xi: Vec<usize>,
    symbols: usize,
}

impl FormTapes {
    /// Collects what the forms are evaluated from: A, its left inverse Y, poses, energies and loads. `None` if A has no
    /// left inverse, or a number has no image modulo p.
    pub fn new(model: &Model) -> Option<Self> {
        let mut model = model.clone();
        let y = kinematics::left_inverse(&mut model)?;
        let potential = energy::potential(&mut model);
        let elements = &model.elements;
        let mut frames: Vec<usize> = model.bodies.iter().map(|body| body.frame).collect();
        frames.extend(elements.wrenches.iter().map(|wrench| wrench.frame));
        frames.sort_unstable();
        frames.dedup();

        let mut poses = vec![potential, model.potential, model.kinetic];
        for &index in &frames {
            let frame = model.frames.get(index)?;
            poses.extend(pose_entries(&frame.rotation, &frame.position));
        }
        poses.extend(
            model
                .particles
                .iter()
                .flat_map(|particle| particle.position),
        );
        let mut constants = [&model.xi[..], &model.xi_dot, &model.gravity].concat();
        for body in &model.bodies {
            constants.push(body.mass);
            constants.extend(body.com);
            constants.extend(body.inertia_com.iter().flatten());
            constants.extend(body.inertia_origin.iter().flatten());
        }
        constants.extend(model.particles.iter().map(|particle| particle.mass));
        constants.extend(&elements.generalized);
        for wrench in &elements.wrenches {
            constants.extend([wrench.at, wrench.force, wrench.torque].iter().flatten());
        }
        for push in &elements.pushes {
            if let Along::Line {
                from,
                to,
                length: Some(length),
            } = push.along
            {
                poses.extend(from.iter().chain(&to));
                constants.extend([push.force, length]);
            }
        }
        let mut velocity = vec![model.kinetic, elements.dissipation];
        for damper in &elements.dampers {
            constants.push(damper.coefficient);
            match damper.along {
                Along::Line { from, to, .. } => poses.extend(from.iter().chain(&to)),
                Along::Scalar(rate) => velocity.push(rate),
            }
        }
        let graph = &model.graph;
        let kinematics = [model.a.concat(), model.rate.clone(), y.concat()].concat();
        Some(FormTapes {
            kinematics: Tape::new(graph, &kinematics)?,
            poses: Tape::new(graph, &poses)?,
            velocity: Tape::new(graph, &velocity)?,
            constants: Tape::new(graph, &constants)?,
            frames,
            x: graph.symbol_places(&model.x),
            xi: graph.symbol_places(&model.xi),
            symbols: graph.symbols().len(),
            model,
        })
    }

    /// Returns whether the description has a `kinetic` statement, whose energy is added to that of bodies and
    /// particles.
    pub fn has_written_kinetic_energy(&self) -> bool {
        self.model.kinetic != self.model.graph.zero()
    }

    fn seed(&self, sets: [(&[usize], &[ResiduePair]); 2]) -> Vec<ResiduePair> {
        let mut seed = vec![ResiduePair::ZERO; self.symbols];
        for (places, values) in sets {
            for (&place, &value) in places.iter().zip(values) {
                if let Some(entry) = seed.get_mut(place) {
                    *entry = value;
                }
            }
        }
        seed
    }

    /// Extends a direction in x by zeros to a direction in all symbols of the graph.
    pub fn direction_of_x(&self, x: &[ResiduePair]) -> Vec<ResiduePair> {
        self.seed([(&self.x, x), (&[], &[])])
    }

    /// Extends a direction in ξ by zeros to a direction in all symbols of the graph.
    pub fn direction_of_xi(&self, xi: &[ResiduePair]) -> Vec<ResiduePair> {
        self.seed([(&self.xi, xi), (&[], &[])])
    }

    /// Returns the entries of ξ in a list with one entry for each symbol.
    pub fn xi_entries(&self, symbols: &[ResiduePair]) -> Vec<ResiduePair> {
        let entry = |&place: &usize| symbols.get(place).copied().unwrap_or(ResiduePair::ZERO);
        self.xi.iter().map(entry).collect()
    }

    /// Extends a direction in x and ξ by zeros to a direction in all symbols of the graph.
    pub fn direction_of_x_and_xi(&self, x: &[ResiduePair], xi: &[ResiduePair]) -> Vec<ResiduePair> {
        self.seed([(&self.x, x), (&self.xi, xi)])
    }
}

/// Reader of the values of a tape, in the order in which their expressions were listed.
pub struct TapeValueReader<'a> {
    rest: std::slice::Iter<'a, ResiduePair>,
}

impl<'a> TapeValueReader<'a> {
    /// Creates a reader at the first of these values.
    pub fn new(values: &'a [ResiduePair]) -> Self {
        TapeValueReader {
            rest: values.iter(),
        }
    }

    /// Reads one number modulo p; `None` at the end.
    pub fn read_number(&mut self) -> Option<ResiduePair> {
        self.rest.next().copied()
    }

    /// Reads a vector of three numbers; `None` at the end.
    pub fn read_vec3(&mut self) -> Option<Vec3> {
        Some([
            self.read_number()?,
            self.read_number()?,
            self.read_number()?,
        ])
    }

    /// Reads a 3×3 matrix by rows; `None` at the end.
    pub fn read_mat3(&mut self) -> Option<Mat3> {
        Some([self.read_vec3()?, self.read_vec3()?, self.read_vec3()?])
    }

    /// Reads `count` numbers; `None` if there are fewer.
    pub fn read_list(&mut self, count: usize) -> Option<Vec<ResiduePair>> {
        (0..count).map(|_| self.read_number()).collect()
    }
}
