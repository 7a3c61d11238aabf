//! What a run has been, as lists of numbers.

use super::early::EarlyEnd;
use super::record::Run;
use super::sample::Sample;
use crate::mechanism::Output;
use crate::source::added;
use hamel_codegen::program::Shape;

/// A run: samples one after the other, each entry of a list beside the time.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Times of the samples.
    pub t: Vec<f64>,
    /// x of each sample.
    pub x: Vec<f64>,
    /// ξ and z of each sample.
    pub xi: Vec<f64>,
    /// Kinetic and potential energy of each sample, their sum.
    pub energy: Vec<f64>,
    /// Outputs by their names with the entries of each sample.
    pub outputs: Vec<(String, Shape, Vec<f64>)>,
    /// The same of what the description claims to be constant.
    pub invariants: Vec<(String, Shape, Vec<f64>)>,
    /// The method.
    pub method: &'static str,
    /// Why it was taken, where it was not asked for.
    pub reason: Option<&'static str>,
    /// How many steps there were.
    pub steps: u64,
    /// How often accelerations, forces or rates of momenta were evaluated.
    pub evaluations: u64,
    /// The largest change of the energy, relative; infinite where the run has got all of it from outside.
    pub energy_deviation: f64,
    /// The largest |φ|.
    pub constraint: f64,
    /// Why it ended early.
    pub failure: Option<EarlyEnd>,
    /// Events by their names, in the order in which they were asked for: times, and x and ξ at them.
    pub events: Vec<Happened>,
    /// The event at which it ended.
    pub stopped_by: Option<String>,
}

/// What became of an event.
#[derive(Clone, Debug)]
pub struct Happened {
    /// Its name.
    pub name: String,
    /// Times, in order.
    pub t: Vec<f64>,
    /// x at each of them.
    pub x: Vec<f64>,
    /// ξ and z at each of them.
    pub xi: Vec<f64>,
}

impl Motion {
    /// That of a run.
    pub fn of(run: &Run) -> Self {
        let system = &run.system;
        let all = |of: fn(&Sample) -> &[f64]| -> Vec<f64> {
            let entries = run.samples.iter().flat_map(of);
            entries.copied().collect()
        };
        let parts = |of: fn(&Sample) -> &[f64], list: &[Output]| {
            let mut first = 0;
            let mut parts = Vec::new();
            for output in list {
                let place = first..first + output.shape.entries();
                first = place.end;
                // What events watch is no output of the description.
                if added::is_added(&output.name) {
                    continue;
                }
                let entries = run
                    .samples
                    .iter()
                    .flat_map(|sample| &of(sample)[place.clone()]);
                parts.push((
                    output.name.clone(),
                    output.shape,
                    entries.copied().collect(),
                ));
            }
            parts
        };
        let named = |event: usize| run.events.list()[event].name.clone();
        let happened = run.events.happened.iter().enumerate();
        let happened = happened.map(|(event, samples)| Happened {
            name: named(event),
            t: samples.iter().map(|sample| sample.t).collect(),
            x: samples
                .iter()
                .flat_map(|sample| &sample.x)
                .copied()
                .collect(),
            xi: samples
                .iter()
                .flat_map(|sample| &sample.xi)
                .copied()
                .collect(),
        });
        Motion {
            t: run.samples.iter().map(|sample| sample.t).collect(),
            x: all(|sample| &sample.x),
            xi: all(|sample| &sample.xi),
            energy: run.samples.iter().map(|sample| sample.energy).collect(),
            outputs: parts(|sample| &sample.outputs, system.outputs()),
            invariants: parts(|sample| &sample.invariants, system.invariants()),
            method: run.plan.method.name,
            reason: run.plan.method.reason,
            steps: run.steps,
            evaluations: run.evaluations,
            energy_deviation: run.monitor.relative_energy_deviation(),
            constraint: run.monitor.constraint(),
            failure: run.failure.clone(),
            events: happened.collect(),
            stopped_by: run.events.stopped_by.map(named),
        }
    }
}
