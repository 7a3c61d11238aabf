//! Turns the scene of a mechanism into shapes of a picture.

use hamel_engine::drawing::{Frame, Joint, LineKind, Scene, Vector};
use hamel_report::plot::space::{Ink, Part, Shape};

/// Widths of links, joint axes, rails and frame axes (pixels).
const LINK_WIDTH: f64 = 3.4;
const HINGE_WIDTH: f64 = 6.5;
const RAIL_WIDTH: f64 = 2.2;
const AXIS_WIDTH: f64 = 1.5;
/// Radii of balls and rings (pixels).
const BALL_RADIUS: f64 = 7.0;
const RING_RADIUS: f64 = 4.2;
/// Lengths relative to the size of the mechanism: half axes of joints, axes of few and of many frames, the least radius
/// of a body.
const HALF_JOINT_AXIS: f64 = 0.022;
const AXIS_OF_FEW: f64 = 0.085;
const AXIS_OF_MANY: f64 = 0.04;
const MIN_LINK_RADIUS: f64 = 0.011;
/// Largest number of frames that counts as few.
const MAX_FEW_FRAMES: usize = 4;
/// Lengths below this, relative to the size, count as zero.
const NEGLIGIBLE: f64 = 1e-6;
/// The colours of the axes of a frame: red, green and blue.
const AXIS_COLORS: [Ink; 3] = [Ink::Series(4), Ink::Series(2), Ink::Series(0)];

/// Sizes of symbols, relative to the scene for which it is made.
pub struct Shapes {
    size: f64,
    heaviest: f64,
}

impl Shapes {
    /// Measures a scene.
    pub fn new(scene: &Scene) -> Self {
        let mut least = [f64::INFINITY; 3];
        let mut most = [f64::NEG_INFINITY; 3];
        let mut hold = |at: Vector, reach: f64| {
            for k in 0..3 {
                least[k] = least[k].min(at[k] - reach);
                most[k] = most[k].max(at[k] + reach);
            }
        };
        for frame in &scene.frames {
            hold(frame.position, 0.0);
        }
        for body in &scene.bodies {
            hold(body.centre, body.radii.into_iter().fold(0.0, f64::max));
        }
        for particle in &scene.particles {
            hold(particle.position, 0.0);
        }
        let ends = scene.lines.iter().map(|line| line.points);
        for end in ends.chain(scene.rods.iter().copied()).flatten() {
            hold(end, 0.0);
        }
        let size = distance(least, most);
        let masses = scene.particles.iter().map(|particle| particle.mass);
        Shapes {
            size: if size.is_finite() && size > 0.0 {
                size
            } else {
                1.0
            },
            heaviest: masses.fold(0.0, f64::max),
        }
    }

    /// Returns the shapes of a scene.
    pub fn of(&self, scene: &Scene) -> Vec<Part> {
        let mut parts = Vec::new();
        self.axes(scene, &mut parts);
        self.links(scene, &mut parts);
        self.joints(scene, &mut parts);
        self.masses(scene, &mut parts);
        self.elements(scene, &mut parts);
        parts
    }

    /// Returns the shapes of a faint pose: moving parts, without axes.
    pub fn faint(&self, scene: &Scene) -> Vec<Part> {
        let mut parts = Vec::new();
        self.links(scene, &mut parts);
        self.masses(scene, &mut parts);
        parts
    }

    fn axes(&self, scene: &Scene, parts: &mut Vec<Part>) {
        let part = if scene.frames.len() > MAX_FEW_FRAMES {
            AXIS_OF_MANY
        } else {
            AXIS_OF_FEW
        };
        for frame in &scene.frames {
            for (axis, ink) in AXIS_COLORS.into_iter().enumerate() {
                let tip = std::array::from_fn(|k| {
                    frame.position[k] + part * self.size * frame.rotation[k][axis]
                });
                let ends = [frame.position, tip];
                self.bar(ends, AXIS_WIDTH, ink, parts);
            }
        }
    }

    /// Links from each frame to the frames placed on it, and to its bodies.
    fn links(&self, scene: &Scene, parts: &mut Vec<Part>) {
        let joint = |frame: usize| scene.joints.iter().find(|joint| joint.frame == frame);
        for (index, frame) in scene.frames.iter().enumerate() {
            let joint = joint(index);
            let place = match joint {
                Some(joint) if floats(joint) => continue,
                Some(joint) => joint.place,
                None if frame.attached => frame.position,
                None => continue,
            };
            if let Some(parent) = frame.parent {
                let ends = [scene.frames[parent].position, place];
                self.bar(ends, LINK_WIDTH, ink(scene, parent), parts);
            }
            self.bar([place, frame.position], RAIL_WIDTH, Ink::Soft, parts);
        }
        for body in &scene.bodies {
            let ends = [scene.frames[body.frame].position, body.centre];
            self.bar(ends, LINK_WIDTH, ink(scene, body.frame), parts);
        }
        for particle in &scene.particles {
            if let Some(frame) = particle.frame {
                let ends = [scene.frames[frame].position, particle.position];
                self.bar(ends, LINK_WIDTH, ink(scene, frame), parts);
            }
        }
        for rod in &scene.rods {
            self.bar(*rod, LINK_WIDTH, Ink::Soft, parts);
        }
    }

    fn joints(&self, scene: &Scene, parts: &mut Vec<Part>) {
        for joint in &scene.joints {
            match joint.kind {
                "revolute" | "continuous" | "universal" | "cylindrical" => {
                    for axis in &joint.axes {
                        let half = HALF_JOINT_AXIS * self.size;
                        self.bar(
                            along(joint.place, *axis, half),
                            HINGE_WIDTH,
                            Ink::Dark,
                            parts,
                        );
                    }
                }
                "prismatic" => {
                    for axis in &joint.axes {
                        let half = 5.0 * HALF_JOINT_AXIS * self.size;
                        self.bar(
                            along(joint.place, *axis, half),
                            RAIL_WIDTH,
                            Ink::Soft,
                            parts,
                        );
                    }
                }
                "spherical" => parts.push(ring(joint.place, Ink::Dark)),
                _ => {}
            }
        }
        // Frames that turn about a point without a statement `joint`.
        let jointed = |index: usize| scene.joints.iter().any(|joint| joint.frame == index);
        let pivots = scene.frames.iter().enumerate();
        let pivots = pivots.filter(|(index, frame)| pivot(frame) && !jointed(*index));
        parts.extend(pivots.map(|(_, frame)| ring(frame.position, Ink::Dark)));
    }

    fn masses(&self, scene: &Scene, parts: &mut Vec<Part>) {
        for (index, body) in scene.bodies.iter().enumerate() {
            let radii = body.radii;
            let shape = if radii.iter().all(|radius| *radius <= NEGLIGIBLE * self.size) {
                Shape::Ball {
                    at: body.centre,
                    radius: BALL_RADIUS,
                }
            } else {
                let arms = |i: usize| {
                    body.axes[i].map(|axis| axis * radii[i].max(MIN_LINK_RADIUS * self.size))
                };
                Shape::Ellipsoid {
                    centre: body.centre,
                    arms: [arms(0), arms(1), arms(2)],
                }
            };
            let ink = Ink::Series(index);
            parts.push(Part { ink, shape });
        }
        for (index, particle) in scene.particles.iter().enumerate() {
            let share = particle.mass / self.heaviest;
            let radius = BALL_RADIUS * share.cbrt().clamp(0.5, 1.0);
            parts.push(Part {
                ink: Ink::Series(scene.bodies.len() + index),
                shape: Shape::Ball {
                    at: particle.position,
                    radius,
                },
            });
        }
    }

    /// Springs, dampers, forces and loops.
    fn elements(&self, scene: &Scene, parts: &mut Vec<Part>) {
        for line in &scene.lines {
            let ends = line.points;
            let (ink, shape) = match line.acts {
                LineKind::Spring => (Ink::Dark, Shape::Spring { ends }),
                LineKind::Damper => (Ink::Soft, Shape::Damper { ends }),
                LineKind::Force => (Ink::Series(4), Shape::Dashes { ends }),
            };
            parts.push(Part { ink, shape });
        }
        for &ends in &scene.loops {
            parts.push(ring(ends[0], Ink::Series(4)));
            if distance(ends[0], ends[1]) > NEGLIGIBLE * self.size {
                parts.push(ring(ends[1], Ink::Series(4)));
                parts.push(Part {
                    ink: Ink::Series(4),
                    shape: Shape::Dashes { ends },
                });
            }
        }
    }

    /// Adds a bar, unless its length is zero.
    fn bar(&self, ends: [Vector; 2], width: f64, ink: Ink, parts: &mut Vec<Part>) {
        if distance(ends[0], ends[1]) > NEGLIGIBLE * self.size {
            let shape = Shape::Bar { ends, width };
            parts.push(Part { ink, shape });
        }
    }
}

/// Returns whether a joint holds no point of the frame that it carries.
fn floats(joint: &Joint) -> bool {
    ["free", "planar"].contains(&joint.kind)
}

fn pivot(frame: &Frame) -> bool {
    frame.attached && frame.turns
}

/// Returns the colour of the first body of a frame, or of its nearest ancestor that has a body.
fn ink(scene: &Scene, frame: usize) -> Ink {
    let mut place = Some(frame);
    while let Some(frame) = place {
        if let Some(index) = scene.bodies.iter().position(|body| body.frame == frame) {
            return Ink::Series(index);
        }
        place = scene.frames[frame]
            .parent
            .filter(|_| !scene.frames[frame].turns);
    }
    Ink::Soft
}

fn ring(at: Vector, ink: Ink) -> Part {
    Part {
        ink,
        shape: Shape::Ring {
            at,
            radius: RING_RADIUS,
        },
    }
}

/// Both ends of an axis through a point.
fn along(at: Vector, axis: Vector, half: f64) -> [Vector; 2] {
    [-half, half].map(|part| std::array::from_fn(|k| at[k] + part * axis[k]))
}

fn distance(a: Vector, b: Vector) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}
