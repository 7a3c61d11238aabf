//! Panels of a plot over time: coordinates, velocities, outputs.

use hamel::{s3, so3};
use hamel_codegen::program::Shape;
use hamel_codegen::syntax::ast::CoordKind;
use hamel_engine::run::{Run, Sample};
use hamel_report::plot::Panel;
use std::f64::consts::{PI, TAU};

/// A name with its values over time.
type Line = (String, Vec<f64>);

/// Panels of coordinates, velocities and outputs, with a separate one for each vector. If the only attitude is
/// drawn on a sphere, it is omitted here.
pub fn panels(run: &Run, on_sphere: bool) -> Vec<Panel> {
    let system = &run.system;
    let mut panels = coordinates(run, on_sphere);
    let groups = run.generated.program.velocities.iter();
    let groups = groups.map(|group| (group.name.as_str(), group.len));
    let line = |i: usize| tracked(run, &run.velocity_names[i], |sample| sample.xi[i]);
    panels.extend(grouped(["velocity", "velocities"], groups, line));
    let outputs = system.outputs().iter();
    let outputs = outputs.map(|output| (output.name.as_str(), entries(output.shape)));
    let states = run.generated.program.states.iter();
    let states = states.map(|group| (group.name.as_str(), group.len));
    let line = |i: usize| {
        let place = run.generated.program.n + i;
        tracked(run, &run.velocity_names[place], |sample| sample.xi[place])
    };
    panels.extend(grouped(["state", "states"], states, line));
    let line = |i: usize| tracked(run, &run.output_names[i], |sample| sample.outputs[i]);
    panels.extend(grouped(["output", "outputs"], outputs, line));
    panels
}

/// The values of an entry over time, and its name with its unit, if the description has units.
fn tracked(run: &Run, name: &str, of: impl Fn(&Sample) -> f64) -> Line {
    let group = name.split(['[', '.']).next().unwrap_or(name);
    let dimensions = run.generated.model.dimensions.as_ref();
    let unit = dimensions.and_then(|found| found.units.get(group));
    let name = match unit.filter(|unit| *unit != "1") {
        Some(unit) => format!("{name} [{unit}]"),
        None => name.to_string(),
    };
    (name, run.track.iter().map(of).collect())
}

/// Coordinates: numbers directly, circles by their angles, attitudes by their angles from the axes of
/// the world or of the joint.
fn coordinates(run: &Run, on_sphere: bool) -> Vec<Panel> {
    let mut panels = Vec::new();
    let mut numbers = Panel::new("coordinates");
    let mut turns = Panel::new("angles of rotation");
    let position = |name: &str, at: usize, len: usize| {
        let mut panel = Panel::new(&format!("coordinate {name}"));
        let line = |i: usize| tracked(run, &format!("{name}[{}]", i + 1), |s| s.x[at + i]);
        panel.lines = (0..len).map(line).collect();
        panel
    };
    let attitude = |name: &str, of: &dyn Fn(&[f64]) -> [f64; 9]| {
        tracked(run, name, |sample| norm(so3::log(of(&sample.x))))
    };
    for coordinate in &run.generated.program.coordinates {
        let (name, at) = (coordinate.name.as_str(), coordinate.offset);
        // It is the horizontal axis.
        if run.time.place == Some(at) {
            continue;
        }
        match coordinate.kind {
            CoordKind::Real => numbers
                .lines
                .push(tracked(run, name, |sample| sample.x[at])),
            CoordKind::S1 => {
                let (name, angles) =
                    tracked(run, name, |sample| sample.x[at + 1].atan2(sample.x[at]));
                numbers.lines.push((name, unwound(angles)));
            }
            CoordKind::Euclidean(len) => panels.push(position(name, at, len)),
            CoordKind::S3 => turns.lines.push(attitude(name, &|x| {
                s3::to_matrix(std::array::from_fn(|i| x[at + i]))
            })),
            CoordKind::SO3 => turns
                .lines
                .push(attitude(name, &|x| std::array::from_fn(|i| x[at + i]))),
            CoordKind::SE3 => {
                panels.push(position(&format!("{name}.p"), at, 3));
                let name = format!("{name}.R");
                turns
                    .lines
                    .push(attitude(&name, &|x| std::array::from_fn(|i| x[at + 3 + i])));
            }
        }
    }
    if on_sphere {
        turns.lines.clear();
    }
    panels.extend(
        [numbers, turns]
            .into_iter()
            .filter(|panel| !panel.lines.is_empty()),
    );
    panels
}

/// One panel for each vector, then one for all scalars; groups follow one another.
fn grouped<'a>(
    [one, several]: [&str; 2],
    groups: impl Iterator<Item = (&'a str, usize)>,
    line: impl Fn(usize) -> Line,
) -> Vec<Panel> {
    let (mut panels, mut numbers) = (Vec::new(), Panel::new(several));
    let mut offset = 0;
    for (name, len) in groups {
        if len == 1 {
            numbers.lines.push(line(offset));
        } else if len > 1 {
            let mut panel = Panel::new(&format!("{one} {name}"));
            panel.lines = (offset..offset + len).map(&line).collect();
            panels.push(panel);
        }
        offset += len;
    }
    panels.extend((!numbers.lines.is_empty()).then_some(numbers));
    panels
}

fn entries(shape: Shape) -> usize {
    match shape {
        Shape::Scalar => 1,
        Shape::Vector(n) => n,
        Shape::Matrix(rows, columns) => rows * columns,
    }
}

/// Removes jumps by full turns from angles.
fn unwound(mut angles: Vec<f64>) -> Vec<f64> {
    let mut before = None;
    for angle in &mut angles {
        if let Some(before) = before {
            let change: f64 = *angle - before;
            *angle = before + (change + PI).rem_euclid(TAU) - PI;
        }
        // Turns are counted anew after a value that is not finite.
        before = Some(*angle).filter(|angle| angle.is_finite());
    }
    angles
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::unwound;

    #[test]
    fn a_wheel_turns_on() {
        let turning: Vec<f64> = (0..100).map(|i| f64::from(i) * -0.7).collect();
        let seen = turning.iter().map(|angle| angle.sin().atan2(angle.cos()));
        for (found, angle) in unwound(seen.collect()).iter().zip(&turning) {
            assert!((found - angle).abs() < 1e-12, "{found} is not {angle}");
        }
    }
}
