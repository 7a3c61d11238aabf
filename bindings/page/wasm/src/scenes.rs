//! What is drawn of a run: what there is to draw, and one list of numbers that says where it is at each sample.

use hamel_engine::{Scene, Session};
use serde_json::{Value, json};

/// Scenes of a run, one after the other.
pub struct Scenes {
    /// What there is to draw, at the first sample.
    pub first: Value,
    /// Numbers of one scene.
    pub width: usize,
    /// Those of all scenes; what is drawn needs no more digits than these have.
    pub numbers: Vec<f32>,
}

/// The scenes of samples whose x lie one behind the other; none where nothing of the description can be drawn.
pub fn scenes(session: &Session, params: &[f64], x: &[f64]) -> Option<Scenes> {
    let drawing = session.drawing().ok()?;
    let drawn = drawing.with(params);
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

/// What moves in a scene, in the order in which `bindings/page/src/scene.ts` reads it.
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
