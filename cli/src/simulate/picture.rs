//! Contents of the plot of a run.

use super::panels::panels;
use super::rotor::poinsot;
use hamel::s3;
use hamel_codegen::model::layout::Block;
use hamel_engine::run::{Run, Sample};
use hamel_report::plot::{Panel, Path, Picture};

/// Returns the plot: coordinates, velocities, outputs, conserved quantities, and the rotation of a body.
pub fn picture(run: &Run) -> Picture {
    let time = run.track.iter();
    let time: Vec<f64> = time.map(|s| run.time.at(s.t, &s.x)).collect();
    let path = attitude(run);
    let mut panels = panels(run, path.is_some());
    panels.push(drift(run));
    let subtitle = run
        .generated
        .program
        .docs
        .first()
        .map_or(String::new(), |line| line.trim().to_string());
    Picture {
        title: run.generated.program.name.clone(),
        subtitle,
        time,
        panels,
        path,
        poinsot: poinsot(&run.system, &run.track),
    }
}

/// Relative changes of the energy and of the invariants that the description claims; absolute changes if there is
/// no reference value.
fn drift(run: &Run) -> Panel {
    let first = run.monitor.initial_energy();
    let scale = run.monitor.energy_deviation() / run.monitor.relative_energy_deviation();
    // All energy was supplied during the run.
    let from_nothing = scale == 0.0;
    let scale = match scale.is_finite() && !from_nothing {
        true => scale,
        false => 1.0,
    };
    let lines = &run.invariant_names;
    let title = match (lines.is_empty(), from_nothing) {
        (true, false) => "energy, relative change",
        (true, true) => "energy, change",
        (false, false) => "energy and invariants, relative change",
        (false, true) => "energy, change, and invariants, relative change",
    };
    let mut panel = Panel::new(title);
    let change = |of: &dyn Fn(&Sample) -> f64, first: f64, scale: f64| -> Vec<f64> {
        let changes = run.track.iter().map(|sample| (of(sample) - first) / scale);
        changes.collect()
    };
    let energy = change(&|sample| sample.energy, first, scale);
    panel.lines.push(("E".into(), energy));
    for (index, name) in lines.iter().enumerate() {
        let value = |sample: &Sample| sample.invariants.get(index).copied().unwrap_or(f64::NAN);
        let first = run.track.first().map_or(0.0, value);
        let scale = if first == 0.0 { 1.0 } else { first.abs() };
        panel
            .lines
            .push((name.clone(), change(&value, first, scale)));
    }
    panel
}

/// Returns the path of a body axis in the world, if exactly one coordinate is an attitude: the axis about which the
/// body turns most at first.
fn attitude(run: &Run) -> Option<Path> {
    let (mut offset, mut found) = (0, Vec::new());
    for &block in &run.generated.program.blocks {
        if matches!(block, Block::Quaternion | Block::Rotation) {
            found.push((offset, block));
        }
        offset += block.len();
    }
    let [(offset, block)] = found[..] else {
        return None;
    };
    let rotation = |sample: &Sample| match block {
        Block::Quaternion => sample.x[offset..].first_chunk().map(|q| s3::to_matrix(*q)),
        _ => sample.x[offset..].first_chunk().copied(),
    };
    let rotations: Vec<[f64; 9]> = run.track.iter().filter_map(rotation).collect();
    let [first, second, ..] = rotations[..] else {
        return None;
    };
    // Entry (i, j) of R₀ᵀ R₁: the increment of rotation, in body axes.
    let entry = |i: usize, j: usize| {
        (0..3)
            .map(|k| first[3 * k + i] * second[3 * k + j])
            .sum::<f64>()
    };
    let turn = [
        entry(2, 1) - entry(1, 2),
        entry(0, 2) - entry(2, 0),
        entry(1, 0) - entry(0, 1),
    ]
    .map(f64::abs);
    let mut axis = 2;
    for candidate in [1, 0] {
        if turn[candidate] > turn[axis] * (1.0 + 1e-9) {
            axis = candidate;
        }
    }
    let points = rotations
        .iter()
        .map(|r| [r[axis], r[3 + axis], r[6 + axis]])
        .collect();
    Some(Path {
        title: format!("body axis {} in the world", axis + 1),
        points,
    })
}
