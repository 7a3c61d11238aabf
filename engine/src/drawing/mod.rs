//! Drawable parts of a mechanism: the places of its frames, bodies, joints, springs and loops at each state.
//!
//! The required functions are compiled once, like those of the description; a scene is then a call of this code:
//!
//! ```
//! use hamel_engine::{OpenOptions, Quiet, Session};
//! use std::sync::Arc;
//!
//! let text = "pub system Pendulum {
//!     joint q: revolute [0, 1, 0] moves arm;
//!     body on arm { mass 2; com [0, 0, -0.5]; inertia diag(0.1, 0.1, 0) about com; }
//!     gravity [0, 0, -9.81];
//! }";
//! let options = OpenOptions::default();
//! let session = Session::read(text.into(), "pendulum.eom", &options, Arc::new(Quiet))?;
//! let start = session.start();
//! let drawing = session.drawing()?;
//! let scene = drawing.with_parameters(&start.params).scene(&start.x);
//! assert_eq!(scene.bodies[0].centre, [0.0, 0.0, -0.5]);
//! # Ok::<(), hamel_engine::Error>(())
//! ```

mod ellipsoid;
mod points;
mod scene;
mod unplaced_parts;

pub use scene::{Body, Frame, Joint, Line, LineKind, Particle, Scene, Vector};

use crate::error::Error;
use crate::mechanism::{FunctionIndex, Functions, compile_functions, find_function};
use ellipsoid::Ellipsoid;
use hamel_codegen::algebra::transplant::graft;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::{Argument, Function, Program, Shape};
use hamel_codegen::syntax::joint_kind;
use hamel_native::Compiled;
use points::Points;

/// The function of masses, centres of mass and inertias, which depend on parameters alone.
const BODIES_FUNCTION: &str = "drawn_bodies";
/// The function of poses and points, which depend on x as well.
const POINTS_FUNCTION: &str = "drawn_points";

/// The drawable parts of a mechanism, compiled, for any parameters.
#[derive(Clone, Debug)]
pub struct Drawing {
    compiled: Compiled,
    /// The functions [`BODIES_FUNCTION`] and [`POINTS_FUNCTION`].
    places: [FunctionIndex; 2],
    frames: Vec<DrawnFrame>,
    /// The frame of each body.
    bodies: Vec<usize>,
    particles: Vec<Option<usize>>,
    joints: Vec<DrawnJoint>,
    lines: Vec<(LineKind, [Option<usize>; 2])>,
    rods: usize,
    loops: usize,
    missing: Vec<String>,
}

#[derive(Clone, Debug)]
struct DrawnFrame {
    name: String,
    parent: Option<usize>,
    attached: bool,
    turns: bool,
}

#[derive(Clone, Debug)]
struct DrawnJoint {
    name: String,
    kind: &'static str,
    frame: usize,
    /// Axes, each with the frame in whose axes it is given.
    axes: Vec<(usize, Vector)>,
    /// The index in x of the displacement along its first axis.
    slid: Option<usize>,
}

/// A [`Drawing`] with its parameters set.
#[derive(Clone, Debug)]
pub struct ParametrizedDrawing<'a> {
    of: &'a Drawing,
    functions: Functions,
    /// Mass, centre of mass in the frame, ellipsoid in the frame's axes.
    bodies: Vec<(f64, Vector, Ellipsoid)>,
    masses: Vec<f64>,
}

impl Drawing {
    /// Compiles the drawable parts of a description.
    pub fn new(generated: &Generated) -> Result<Self, Error> {
        let model = &generated.active;
        let mut graph = model.graph.clone();
        let points = Points::new(model, &mut graph);
        let mut program: Program = generated.program.clone();
        let mut function = |name: &str, arguments: &[Argument], edges: &[_]| {
            let outputs = graft(&graph, &mut program.graph, edges);
            let shape = Shape::Vector(outputs.len());
            Function::described(name, String::new(), arguments, shape, outputs)
        };
        let fixed = function(BODIES_FUNCTION, &[], &points.masses);
        let moving = function(POINTS_FUNCTION, &[Argument::Coordinates], &points.moving);
        program.functions = vec![fixed, moving];
        let compiled = compile_functions(&program, &[BODIES_FUNCTION, POINTS_FUNCTION])?;
        let place = |name: &str| {
            let place = find_function(&compiled, name);
            place.ok_or_else(|| Error::NotDrawable {
                system: program.name.clone(),
            })
        };
        let places = [place(BODIES_FUNCTION)?, place(POINTS_FUNCTION)?];
        let moved = points.attached.into_iter().zip(points.turns);
        let frames = model.frames.iter().zip(moved);
        let frames = frames.map(|(frame, (attached, turns))| DrawnFrame {
            name: frame.name.clone(),
            parent: frame.parent,
            attached,
            turns,
        });
        let joints = model.joints.iter().filter_map(|joint| {
            let named = |name: &str| model.frames.iter().position(|frame| frame.name == name);
            let carried = named(&joint.frame)?;
            // The first axis of a universal joint is fixed in its cross.
            let cross = named(&format!("{}_cross", joint.name)).filter(|_| joint.axes.len() == 2);
            let on = [cross.unwrap_or(carried), carried];
            let sliding = ["prismatic", "cylindrical"].contains(&joint_kind(joint.kind));
            let slid = joint.coordinates.last().filter(|_| sliding);
            let slid = slid.and_then(|name| {
                let mut all = model.coordinates.iter();
                all.find(|coordinate| coordinate.name == *name)
            });
            Some(DrawnJoint {
                name: joint.name.clone(),
                kind: joint_kind(joint.kind),
                frame: carried,
                axes: on.into_iter().zip(joint.axes.iter().copied()).collect(),
                slid: slid.map(|coordinate| coordinate.offset),
            })
        });
        Ok(Drawing {
            places,
            frames: frames.collect(),
            bodies: model.bodies.iter().map(|body| body.frame).collect(),
            particles: points.particles,
            joints: joints.collect(),
            lines: points.lines,
            rods: points.rods,
            loops: model.closures.len(),
            missing: unplaced_parts::unplaced_parts(&generated.model),
            compiled,
        })
    }

    /// Returns a sentence for each part that is not drawn because the description does not place it.
    pub fn unplaced_parts(&self) -> &[String] {
        &self.missing
    }

    /// Returns the drawing for these parameters; a missing parameter makes everything that depends on it NaN.
    pub fn with_parameters(&self, params: &[f64]) -> ParametrizedDrawing<'_> {
        let functions = Functions::new(&self.compiled, params);
        let values = call(&functions, self.places[0], &[]);
        let (bodies, masses) = values.split_at((13 * self.bodies.len()).min(values.len()));
        let bodies = bodies.chunks_exact(13).map(|entries| {
            let (mass, com) = (entries[0], vector(&entries[1..4]));
            let inertia = [4, 7, 10].map(|first| vector(&entries[first..first + 3]));
            (mass, com, Ellipsoid::new(mass, inertia))
        });
        ParametrizedDrawing {
            of: self,
            bodies: bodies.collect(),
            masses: masses.to_vec(),
            functions,
        }
    }
}

impl ParametrizedDrawing<'_> {
    /// Returns the scene at x.
    pub fn scene(&self, x: &[f64]) -> Scene {
        let of = self.of;
        let values = call(&self.functions, of.places[1], x);
        let mut vectors = values.chunks_exact(3).map(vector);
        let mut next = || vectors.next().unwrap_or([f64::NAN; 3]);
        let frames = of.frames.iter().map(|frame| Frame {
            name: frame.name.clone(),
            parent: frame.parent,
            attached: frame.attached,
            turns: frame.turns,
            rotation: [next(), next(), next()],
            position: next(),
        });
        let frames: Vec<Frame> = frames.collect();
        let particles = of.particles.iter().zip(&self.masses);
        let particles = particles.map(|(&frame, &mass)| Particle {
            mass,
            position: next(),
            frame,
        });
        let particles: Vec<Particle> = particles.collect();
        let lines = of.lines.iter().map(|&(acts, frames)| Line {
            acts,
            points: [next(), next()],
            frames,
        });
        let lines = lines.collect();
        let rods = (0..of.rods).map(|_| [next(), next()]).collect();
        let loops = (0..of.loops).map(|_| [next(), next()]).collect();
        let gravity = next();
        let bodies = of.bodies.iter().zip(&self.bodies);
        let bodies: Vec<Body> = bodies
            .map(|(&frame, (mass, com, ellipsoid))| Body {
                frame,
                mass: *mass,
                centre: frames[frame].point(*com),
                axes: ellipsoid.axes.map(|axis| frames[frame].direction(axis)),
                radii: ellipsoid.radii,
            })
            .collect();
        let joints = of.joints.iter().map(|joint| {
            let axes = joint.axes.iter();
            let axes: Vec<Vector> = axes
                .map(|(on, axis)| frames[*on].direction(*axis))
                .collect();
            let origin = frames[joint.frame].position;
            let slid = joint.slid.and_then(|place| x.get(place));
            let place = match (slid, axes.first()) {
                (Some(slid), Some(axis)) => std::array::from_fn(|k| origin[k] - slid * axis[k]),
                _ => origin,
            };
            Joint {
                name: joint.name.clone(),
                kind: joint.kind,
                frame: joint.frame,
                place,
                axes,
            }
        });
        let joints = joints.collect();
        Scene {
            centre: centre(&bodies, &particles),
            frames,
            bodies,
            particles,
            joints,
            lines,
            rods,
            loops,
            gravity,
        }
    }
}

impl Frame {
    /// Returns a direction in the frame's axes, in world axes.
    fn direction(&self, a: Vector) -> Vector {
        self.rotation
            .map(|row| row[0] * a[0] + row[1] * a[1] + row[2] * a[2])
    }

    /// Returns a point of the frame, in world coordinates.
    pub(crate) fn point(&self, at: Vector) -> Vector {
        let arm = self.direction(at);
        std::array::from_fn(|k| self.position[k] + arm[k])
    }
}

/// Returns the centre of mass of bodies and particles.
fn centre(bodies: &[Body], particles: &[Particle]) -> Option<Vector> {
    let bodies = bodies.iter().map(|body| (body.mass, body.centre));
    let particles = particles.iter();
    let particles = particles.map(|particle| (particle.mass, particle.position));
    let all: Vec<(f64, Vector)> = bodies.chain(particles).collect();
    let mass: f64 = all.iter().map(|(mass, _)| mass).sum();
    let moment = |k: usize| all.iter().map(|(mass, at)| mass * at[k]).sum::<f64>();
    (mass > 0.0).then(|| std::array::from_fn(|k| moment(k) / mass))
}

/// These functions have no pivots, and are defined wherever the description is.
fn call(functions: &Functions, place: FunctionIndex, x: &[f64]) -> Vec<f64> {
    let value = functions.call(place, [x, &[], &[], &[], &[]]);
    value.map_or_else(|_| vec![f64::NAN; place.length()], |value| value.to_vec())
}

fn vector(entries: &[f64]) -> Vector {
    std::array::from_fn(|k| entries.get(k).copied().unwrap_or(f64::NAN))
}
