//! Times generated Rust against C that CasADi generated for the same model, alternately in one process.
//!
//! Started by `lab/casadi/run.sh`. Every function gets 32 different inputs through a pointer, so that nothing is
//! hoisted. Times are thread CPU times; batches of both functions alternate. A figure is the lowest of the rounds'
//! medians, because the machine may have other work. Results are compared before anything is timed.

mod ours;
mod peer;

use hamel_lab::measure;
use serde::Deserialize;
use std::error::Error;
use std::path::Path;

/// Largest accepted difference of results, relative to the largest component.
const AGREEMENT: f64 = 1e-9;

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// (x, ξ, τ) → ξ̇
    Accel,
    /// (x, ξ, ξ̇) → τ
    Inverse,
}

/// A row of `cases.json`.
#[derive(Debug, Deserialize)]
struct Case {
    model: String,
    kind: Kind,
    symbol: String,
    operations: u32,
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("the folder of the peers is missing")?;
    let folder = Path::new(&folder);
    let cases: Vec<Case> =
        serde_json::from_str(&std::fs::read_to_string(folder.join("cases.json"))?)?;
    let library = peer::open(&folder.join("libpeers.so"))?;
    let models = ours::models();

    println!(
        "| model | function | operations of CasADi | CasADi, ns | hamel, ns | CasADi / hamel |"
    );
    println!("|---|---|---:|---:|---:|---:|");
    let mut rows = Vec::new();
    for case in &cases {
        let model = models.iter().find(|model| model.name() == case.model);
        let model = model.ok_or_else(|| format!("no generated model `{}`", case.model))?;
        let inputs = model.inputs(case.kind);
        let peer = peer::Function::new(&library, &case.symbol, inputs, model.freedoms())?;
        agree(&case.symbol, &model.results(case.kind), &peer.results())?;
        let (theirs, ours) = measure::by_turns(&|n| peer.run(n), &|n| model.run(case.kind, n));
        let ratio = theirs / ours;
        let kind = match case.kind {
            Kind::Accel => "forward dynamics",
            Kind::Inverse => "inverse dynamics",
        };
        println!(
            "| {} | {kind} | {} | {theirs:.1} | {ours:.1} | {ratio:.2} |",
            case.model, case.operations
        );
        rows.push(serde_json::json!({
            "model": case.model, "function": kind, "casadi_operations": case.operations,
            "casadi_ns": theirs, "hamel_ns": ours, "ratio": ratio,
        }));
    }
    hamel_files::write(
        &folder.join("report.json"),
        &serde_json::to_string_pretty(&rows)?,
    )?;
    Ok(())
}

fn agree(name: &str, ours: &[Vec<f64>], theirs: &[Vec<f64>]) -> Result<(), String> {
    for (ours, theirs) in ours.iter().zip(theirs) {
        let scale = ours.iter().fold(1.0_f64, |largest, v| largest.max(v.abs()));
        for (a, b) in ours.iter().zip(theirs) {
            // This is false if either one is NaN.
            let near = (a - b).abs() <= AGREEMENT * scale;
            if !near {
                return Err(format!("{name}: {ours:?} of hamel, {theirs:?} of CasADi"));
            }
        }
    }
    Ok(())
}
