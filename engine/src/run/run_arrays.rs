//! Results of runs as flat lists of numbers, for front ends with arrays.

use super::early_end::EarlyEnd;
use super::record::Run;
use super::sample::Sample;
use crate::mechanism::Output;
use crate::source::added_outputs;
use hamel_codegen::program::Shape;

/// Results of a run. Each list holds one sample after another, in the order of the times.
#[derive(Clone, Debug)]
pub struct RunArrays {
    /// Times of the samples.
    pub t: Vec<f64>,
    /// x of each sample.
    pub x: Vec<f64>,
    /// ξ and z of each sample.
    pub xi: Vec<f64>,
    /// Kinetic and potential energy of each sample, their sum.
    pub energy: Vec<f64>,
    /// Outputs: name, shape, and the entries of all samples.
    pub outputs: Vec<(String, Shape, Vec<f64>)>,
    /// Likewise the quantities that the description claims to be constant.
    pub invariants: Vec<(String, Shape, Vec<f64>)>,
    /// The method.
    pub method: &'static str,
    /// Reason for the choice, if it was not requested.
    pub reason: Option<&'static str>,
    /// Number of steps.
    pub steps: u64,
    /// Number of evaluations of accelerations, forces or rates of momenta.
    pub evaluations: u64,
    /// The largest relative change of the energy; infinite if all of it was supplied during the run.
    pub energy_deviation: f64,
    /// The largest |φ|.
    pub constraint: f64,
    /// Reason for which the run ended early.
    pub failure: Option<EarlyEnd>,
    /// Events in the order of the request: times, and x and ξ at them.
    pub events: Vec<EventOccurrences>,
    /// The event that ended the run.
    pub stopped_by: Option<String>,
}

/// Occurrences of an event during a run.
#[derive(Clone, Debug)]
pub struct EventOccurrences {
    /// Name.
    pub name: String,
    /// Times, in increasing order.
    pub t: Vec<f64>,
    /// x at each of them.
    pub x: Vec<f64>,
    /// ξ and z at each of them.
    pub xi: Vec<f64>,
}

impl RunArrays {
    /// Collects the results of a run.
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
                // Expressions of events are not outputs of the description.
                if added_outputs::is_added(&output.name) {
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
        let happened = happened.map(|(event, samples)| EventOccurrences {
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
        RunArrays {
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
