//! Scenes of a run: the drawable parts, and one list of numbers that places them at each sample.

use hamel_engine::{Scene, Session};
use serde_json::{Value, json};

/// Scenes of a run.
pub struct Scenes {
    /// The scene at the first sample, with all drawable parts.
    pub first: Value,
    /// Number of numbers of one scene.
    pub width: usize,
    /// Numbers of all scenes; single precision suffices for drawing.
    pub numbers: Vec<f32>,
}

/// Returns the scenes of samples, whose x are concatenated; `None` if nothing of the description can be drawn.
pub fn scenes(session: &Session, params: &[f64], x: &[f64]) -> Option<Scenes> {
    let drawing = session.drawing().ok()?;
    let drawn = drawing.with_parameters(params);
    let mut samples = x.chunks_exact(session.coordinates().entries.len().max(1));
    let first = drawn.scene(samples.next()?);
    let mut numbers = listed(&first);
    let width = numbers.len();
    if width == 0 {
        return None;
    }
    for sample in samples {
        numbers.extend(listed(&drawn.scene(sample)));
    }
    Some(Scenes {
        first: json!(first),
        width,
        numbers,
    })
}

/// Lists the moving vectors of a scene, in the order in which `bindings/page/src/scene.ts` reads them.
fn listed(scene: &Scene) -> Vec<f32> {
    let frames = scene.frames.iter();
    let frames = frames.flat_map(|frame| [&frame.rotation[..], &[frame.position]].concat());
    let bodies = scene.bodies.iter();
    let bodies = bodies.flat_map(|body| [&[body.centre], &body.axes[..]].concat());
    let particles = scene.particles.iter().map(|particle| particle.position);
    let joints = scene.joints.iter();
    let joints = joints.flat_map(|joint| [&[joint.place], &joint.axes[..]].concat());
    let lines = scene.lines.iter().flat_map(|line| line.points);
    let ends = scene.rods.iter().chain(&scene.loops).flatten().copied();
    let vectors = frames.chain(bodies).chain(particles).chain(joints);
    let vectors = vectors.chain(lines).chain(ends).chain(scene.centre);
    vectors.flatten().map(|number| number as f32).collect()
}
