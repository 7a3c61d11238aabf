//! Measures all cases and writes the report.

use clap::Parser;
use hamel_bench::cases::{ALL, Job};
use hamel_bench::output;
use hamel_bench::peers::{Peers, mujoco};
use hamel_bench::runner::{BenchError, Effort};
use hamel_report::data::{Machine, Report};
use hamel_report::{auto, json};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Speed against error on the hard cases, compared with other programs.
#[derive(Parser)]
struct Arguments {
    /// Folder of the report.
    #[arg(long, value_name = "DIR", default_value = "docs/report")]
    out: PathBuf,
    /// Only these cases; the book and its summary are then not written.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    cases: Vec<String>,
    /// Number of timings of each run.
    #[arg(long, value_name = "N", default_value_t = 7)]
    repeats: u32,
    /// Leave out the runs of a million steps.
    #[arg(long)]
    short: bool,
    /// Measure nothing: write the files again from the report.json of the folder.
    #[arg(long)]
    rewrite: bool,
    /// A Python that has the wheel `mujoco`.
    #[arg(long, value_name = "PYTHON", default_value = mujoco::PYTHON)]
    mujoco: PathBuf,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            anstream::eprintln!("\x1b[1;31merror\x1b[0m: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), BenchError> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let chosen = |job: &&Job| {
        arguments.cases.is_empty() || arguments.cases.iter().any(|name| name == job.name)
    };
    let jobs: Vec<&Job> = ALL.iter().filter(chosen).collect();
    if jobs.is_empty() {
        let names: Vec<&str> = ALL.iter().map(|job| job.name).collect();
        return Err(BenchError(format!(
            "no such case; there are {}",
            names.join(", ")
        )));
    }
    if arguments.rewrite {
        let path = arguments.out.join("report.json");
        let said = |error: String| BenchError(format!("{}: {error}", path.display()));
        let text = std::fs::read_to_string(&path).map_err(|error| said(error.to_string()))?;
        let report = json::read(&text).map_err(|error| said(error.to_string()))?;
        return write_report(&report, arguments, &root);
    }
    let peers = Peers::find(&arguments.mujoco);
    let effort = Effort {
        repeats: arguments.repeats,
        long: !arguments.short,
    };
    let mut report = Report {
        title: "Speed against error".into(),
        command:
            "cargo run --release --manifest-path lab/Cargo.toml -p hamel-bench -- --out docs/report"
                .into(),
        machine: machine(arguments.repeats),
        peers: peers.list.clone(),
        ..Report::default()
    };
    for (index, job) in jobs.iter().enumerate() {
        let bar = bar(&format!("{}/{} {}", index + 1, jobs.len(), job.name));
        let tick = |done: u64, all: u64| {
            bar.set_length(all);
            bar.set_position(done);
        };
        let (case, drifts) = job.run(&root.join("tests/reference"), effort, &peers, &tick)?;
        bar.finish_and_clear();
        report.cases.push(case);
        report.drifts.extend(drifts);
    }
    write_report(&report, arguments, &root)
}

fn write_report(report: &Report, arguments: &Arguments, root: &Path) -> Result<(), BenchError> {
    for path in output::write(report, &arguments.out)? {
        say(&format!("wrote {}", path.display()))?;
    }
    if let Some(verdict) = auto::verdict(report) {
        say(&verdict.to_string())?;
    }
    if arguments.cases.is_empty() {
        output::keep(report, root)?;
    }
    Ok(())
}

/// Writes a line to standard output.
fn say(line: &str) -> Result<(), BenchError> {
    let said = writeln!(anstream::stdout(), "{line}");
    said.map_err(|error| BenchError(format!("cannot write to standard output: {error}")))
}

fn bar(name: &str) -> ProgressBar {
    let bar = ProgressBar::new(1).with_message(name.to_string());
    match ProgressStyle::with_template("{msg} {bar:30} {elapsed}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Describes the machine: the kind of processor, not its name in a network.
fn machine(repeats: u32) -> Machine {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name"));
    let processor = model
        .and_then(|line| line.split_once(':'))
        .map_or("processor of unknown kind", |(_, name)| name.trim());
    Machine {
        processor: processor.to_string(),
        system: format!("{}, {}", std::env::consts::OS, std::env::consts::ARCH),
        code: "compiled".into(),
        repeats,
    }
}
