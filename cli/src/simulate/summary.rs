//! Summary of a run for a terminal.

use crate::columns::aligned;
use hamel_codegen::syntax::ast::CoordKind;
use hamel_engine::run::{Run, Sample};
use hamel_files::number::{digits, error, group_thousands, short};

/// Number of rows of the table.
const ROWS: usize = 20;
/// Number of columns of velocities.
const COLUMNS: usize = 8;
/// Relative change below which a momentum is reported as conserved.
const KEPT: f64 = 1e-6;

/// Returns a table of about twenty rows of t and velocities.
pub fn table(run: &Run) -> String {
    let shown = run.velocity_names.len().min(COLUMNS);
    let header = std::iter::once(run.time.name.clone())
        .chain(run.velocity_names.iter().take(shown).cloned());
    let mut rows: Vec<Vec<String>> = vec![header.collect()];
    let last = run.samples.len().saturating_sub(1);
    let stride = last.div_ceil(ROWS).max(1);
    let mut indices: Vec<usize> = (0..last).step_by(stride).collect();
    indices.push(last);
    for index in indices {
        let sample = &run.samples[index];
        let values = std::iter::once(run.time.at(sample.t, &sample.x))
            .chain(sample.xi.iter().take(shown).copied());
        rows.push(values.map(short).collect());
    }
    let mut text = aligned(&rows, "");
    if run.velocity_names.len() > shown {
        text.push_str(&format!(
            "({} more velocities: use --out)\n",
            run.velocity_names.len() - shown
        ));
    }
    text.push('\n');
    text
}

/// Returns the method, the last state and the invariants.
pub fn text(run: &Run, default_step: bool) -> String {
    let (Some(first), Some(last)) = (run.samples.first(), run.samples.last()) else {
        return String::new();
    };
    let chosen = &run.plan.method;
    let method = format!("{}{}", chosen.name, chosen.stepper.settings());
    let plural = |count: u64, word: &str| {
        format!(
            "{} {word}{}",
            group_thousands(count),
            if count == 1 { "" } else { "s" }
        )
    };
    let default = if default_step { " (default)" } else { "" };
    let steps = match run.plan.tolerance {
        Some(tolerance) => format!(
            "{} by tolerance {}",
            plural(run.steps, "step"),
            short(tolerance)
        ),
        None => format!(
            "{} of {}{default}",
            plural(run.steps, "step"),
            short(match run.plan.has_multiples() {
                true => run.plan.step,
                false => run.plan.until / run.plan.steps as f64,
            })
        ),
    };
    let mut text = format!(
        "\x1b[1m{}\x1b[0m  {method}, {steps}, {} of {}\n",
        run.generated.program.name,
        plural(run.evaluations, "evaluation"),
        chosen.stepper.evaluated(),
    );
    if let Some(reason) = chosen.reason {
        text.push_str(&format!("{method} was chosen: {reason}\n"));
    }
    let time = short(run.time.at(last.t, &last.x));
    text.push_str(&format!("\n\x1b[1m{} = {time}\x1b[0m\n", run.time.name));
    text.push_str(&state(run, last));
    text.push_str(&invariants(run, first, last));
    text
}

/// Returns the last state by names, with rotation matrices as matrices.
fn state(run: &Run, last: &Sample) -> String {
    let mut groups: Vec<(String, Vec<&[f64]>)> = Vec::new();
    for coordinate in &run.generated.program.coordinates {
        if run.time.place == Some(coordinate.offset) {
            continue;
        }
        let at = &last.x[coordinate.offset..];
        let name = coordinate.name.clone();
        match coordinate.kind {
            CoordKind::Real => groups.push((name, vec![&at[..1]])),
            CoordKind::Euclidean(n) => groups.push((name, vec![&at[..n]])),
            CoordKind::S1 => groups.push((name, vec![&at[..2]])),
            CoordKind::S3 => groups.push((name, vec![&at[..4]])),
            CoordKind::SO3 => groups.push((name, at[..9].chunks(3).collect())),
            CoordKind::SE3 => {
                groups.push((format!("{name}.p"), vec![&at[..3]]));
                groups.push((format!("{name}.R"), at[3..12].chunks(3).collect()));
            }
        }
    }
    for group in &run.generated.program.moving() {
        groups.push((
            group.name.clone(),
            vec![&last.xi[group.offset..group.offset + group.len]],
        ));
    }
    let mut rows = Vec::new();
    for (name, lines) in &groups {
        for (index, line) in lines.iter().enumerate() {
            let label = if index == 0 {
                name.clone()
            } else {
                String::new()
            };
            rows.push(
                std::iter::once(label)
                    .chain(line.iter().map(|&value| short(value)))
                    .collect(),
            );
        }
    }
    aligned(&rows, "  ")
}

/// Energy, conserved momenta, outputs, φ.
fn invariants(run: &Run, first: &Sample, last: &Sample) -> String {
    let row = |name: &str, start: f64, end: f64, change: String| {
        vec![name.to_string(), digits(start, 9), digits(end, 9), change]
    };
    let mut rows = vec![
        ["", "start", "end", "largest change"]
            .map(String::from)
            .to_vec(),
    ];
    let mut change = error(run.monitor.energy_deviation());
    let relative = run.monitor.relative_energy_deviation();
    // There is no reference value if all energy was supplied during the run.
    if !relative.is_infinite() {
        change.push_str(&format!(", {} relative", error(relative)));
    }
    rows.push(row("energy", first.energy, last.energy, change));
    // States of first order have no momentum.
    for (index, name) in run
        .velocity_names
        .iter()
        .enumerate()
        .take(run.generated.program.n)
    {
        let (size, change) = spread(run, |sample| sample.momentum[index]);
        if size > 0.0 && change <= KEPT * size {
            rows.push(row(
                &format!("momentum of {name}"),
                first.momentum[index],
                last.momentum[index],
                error(change),
            ));
        }
    }
    for (index, name) in run.invariant_names.iter().enumerate() {
        let (_, change) = spread(run, |sample| sample.invariants[index]);
        rows.push(row(
            &format!("invariant {name}"),
            first.invariants[index],
            last.invariants[index],
            error(change),
        ));
    }
    for (index, name) in run.output_names.iter().enumerate() {
        let (_, change) = spread(run, |sample| sample.outputs[index]);
        rows.push(row(
            name,
            first.outputs[index],
            last.outputs[index],
            error(change),
        ));
    }
    let mut text = format!("\n{}", aligned(&rows, "  "));
    for (index, name) in run.output_names.iter().enumerate() {
        if let Some(gaps) = gaps(run, |sample| sample.outputs[index]) {
            text.push_str(&format!("  {name} {gaps}\n"));
        }
    }
    if run.generated.program.phi > 0 {
        text.push_str(&format!(
            "  max |phi|  {}\n",
            error(run.monitor.constraint())
        ));
    }
    text
}

/// Reports samples without a value, as beyond the end of a table or for the root of a negative number.
fn gaps(run: &Run, of: impl Fn(&Sample) -> f64) -> Option<String> {
    let missing = run.samples.iter().filter(|sample| !of(sample).is_finite());
    let first = missing.clone().next()?;
    Some(format!(
        "has no finite value at {} of {} samples, first at {} = {}",
        group_thousands(missing.count() as u64),
        group_thousands(run.samples.len() as u64),
        run.time.name,
        short(run.time.at(first.t, &first.x))
    ))
}

/// Largest absolute value of a quantity, and its largest distance from the first value.
fn spread(run: &Run, of: impl Fn(&Sample) -> f64) -> (f64, f64) {
    let first = run.samples.first().map_or(0.0, &of);
    run.samples
        .iter()
        .map(of)
        .fold((0.0, 0.0), |(size, change), value| {
            (
                f64::max(size, value.abs()),
                f64::max(change, (value - first).abs()),
            )
        })
}
