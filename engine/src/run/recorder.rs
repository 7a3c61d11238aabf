//! Records a run: the requested samples, and monitored values of all states.

use super::advance::{ObservationPoint, Observer};
use super::energy_balance::EnergyBalance;
use super::plan::{PLOT_POINTS, Spacing, SteppingPlan};
use super::sample::Sample;
use crate::mechanism::{Instance, StepEnergies};
use crate::reporter::Reporter;
use hamel::{Monitor, State};
use std::cell::Cell;

/// Largest number of samples that are kept unless they are requested.
const MAX_SAMPLES: usize = 20_000;
/// Number of steps from which a run shows progress.
const MIN_STEPS_FOR_PROGRESS: u64 = 20_000;
/// Steps between two reports of progress.
const STEPS_PER_REPORT: u64 = 500;

/// Observer that records the samples of a run and monitors its energy.
pub struct Recorder<'a> {
    system: &'a Instance,
    plan: &'a SteppingPlan,
    balance: &'a Cell<EnergyBalance>,
    recorded: Recorded,
    /// Numbers of steps between samples, and between points of the finer list.
    every: u64,
    stride: u64,
    reporter: &'a dyn Reporter,
    /// Whether it is known from the start that there are many steps.
    long: bool,
    /// Whether the energy is monitored.
    watches: bool,
}

/// Recorded results of a run.
pub struct Recorded {
    pub samples: Vec<Sample>,
    pub track: Vec<Sample>,
    pub monitor: Monitor<f64>,
    /// The number of steps plus one.
    pub steps: u64,
}

impl<'a> Recorder<'a> {
    /// Prepares to record a run.
    pub fn new(
        system: &'a Instance,
        plan: &'a SteppingPlan,
        balance: &'a Cell<EnergyBalance>,
        reporter: &'a dyn Reporter,
    ) -> Self {
        // How many steps a tolerance takes is not known: progress is shown when they are many.
        let long = plan.tolerance.is_none() && plan.steps >= MIN_STEPS_FOR_PROGRESS;
        Recorder {
            recorded: Recorded {
                samples: Vec::new(),
                track: Vec::new(),
                monitor: Monitor::new(system, &State::start(system)),
                steps: 0,
            },
            every: plan.every,
            stride: match plan.tolerance {
                Some(_) => 1,
                None => (plan.steps / PLOT_POINTS).max(1),
            },
            reporter,
            long,
            watches: plan.monitors_energy(system),
            system,
            plan,
            balance,
        }
    }

    /// Returns the results after the run.
    pub fn finish(self) -> Recorded {
        self.reporter.end();
        self.recorded
    }

    fn point(&mut self, state: &State<Instance>) {
        self.recorded.track.push(Sample::of(self.system, state));
        if thin(&mut self.recorded.track) {
            self.stride *= 2;
        }
    }
}

impl Observer for Recorder<'_> {
    fn observe(&mut self, state: &State<Instance>, place: ObservationPoint) {
        let (system, plan) = (self.system, self.plan);
        match place {
            ObservationPoint::Sample => {
                self.recorded.samples.push(Sample::of(system, state));
                return;
            }
            ObservationPoint::Within => return self.point(state),
            ObservationPoint::End => {}
        }
        self.recorded.monitor.observe(system, state);
        if self.watches {
            self.balance.set(self.balance.get().after(system, state));
        }
        let steps = self.recorded.steps;
        // Given times determine the samples completely.
        let asked = match plan.spacing {
            Spacing::Steps => steps.is_multiple_of(self.every),
            Spacing::Every(_) => steps == 0,
            Spacing::Times(_) => false,
        };
        if asked {
            self.recorded.samples.push(Sample::of(system, state));
            if plan.chosen && thin(&mut self.recorded.samples) {
                self.every *= 2;
            }
        }
        if steps.is_multiple_of(self.stride) {
            self.point(state);
        }
        if steps.is_multiple_of(STEPS_PER_REPORT) && (self.long || steps >= MIN_STEPS_FOR_PROGRESS)
        {
            let done = match plan.tolerance {
                Some(_) => (state.t / plan.until * plan.steps as f64) as u64,
                None => steps,
            };
            self.reporter.advance(done, plan.steps);
        }
        self.recorded.steps += 1;
    }

    fn unobserved_steps(&self) -> u64 {
        let steps = self.recorded.steps;
        // Zero if this step itself is to be observed.
        let ahead = |every: u64| (every - steps % every) % every;
        let asked = match self.plan.spacing {
            Spacing::Steps => ahead(self.every),
            Spacing::Every(_) | Spacing::Times(_) => u64::MAX,
        };
        asked.min(ahead(self.stride)).min(ahead(STEPS_PER_REPORT))
    }

    #[inline]
    fn observe_energies(&mut self, of: StepEnergies) {
        let monitor = &mut self.recorded.monitor;
        monitor.note(of.kinetic, of.potential, of.constraint);
        self.recorded.steps += 1;
    }
}

/// Drops every second sample if there are more than the limit; returns whether it did.
fn thin(samples: &mut Vec<Sample>) -> bool {
    if samples.len() < MAX_SAMPLES {
        return false;
    }
    let mut place = 0;
    samples.retain(|_| {
        place += 1;
        place % 2 == 1
    });
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reporter::Quiet;
    use crate::run::{Events, Stepping, advance};
    use crate::source::{OpenOptions, Source};
    use crate::state::State as Start;
    use hamel::StepError;
    use std::path::Path;
    use std::sync::Arc;

    /// An observer that looks at every step.
    struct Watchful<'a>(Recorder<'a>);

    impl Observer for Watchful<'_> {
        fn observe(&mut self, state: &State<Instance>, place: ObservationPoint) {
            self.0.observe(state, place);
        }
    }

    type Outcome = (Result<(), StepError>, Vec<u64>, u64, String);

    fn outcome(
        system: &Instance,
        run: Result<(), StepError>,
        end: &State<Instance>,
        before: u64,
        recorder: Recorder,
    ) -> Outcome {
        let Recorded {
            samples,
            track,
            monitor,
            steps,
        } = recorder.finish();
        let lists = samples.iter().chain(&track);
        let numbers = lists.flat_map(|sample| {
            let own = [sample.t, sample.energy];
            [&own[..], &sample.x, &sample.xi, &sample.outputs].concat()
        });
        let ends = [&[end.t][..], &end.x, &end.xi].concat();
        let bits = numbers.chain(ends).map(f64::to_bits).collect();
        let monitored = format!("{monitor:?} {steps} {} {}", samples.len(), track.len());
        (run, bits, system.evaluations() - before, monitored)
    }

    /// The record of a run with unobserved steps is bitwise equal to that of a run observed step by step, even
    /// if a step has no end.
    #[test]
    fn a_glance_sees_what_a_look_sees() {
        let mut failed = 0;
        let models = [
            "heavy_top",
            "kapitza",
            "lagging_drone",
            "rolling_disk",
            "drone",
            "free_body",
        ];
        for model in models {
            let path = Path::new("../tests/models").join(format!("{model}.eom"));
            let source = Source::open(&path, &OpenOptions::default(), Arc::new(Quiet));
            let source = source.expect("a description");
            let generated = source.derive_default_functions().expect("derived");
            let mut start = Start::start(&generated.active);
            for (method, speed) in [
                ("rkmk4", 1.0),
                ("rk4", 1.0),
                ("rkmk8", 1.0),
                ("rkmk4", 1e160),
            ] {
                for xi in &mut start.xi {
                    *xi = (*xi + 0.1) * speed;
                }
                let system = Instance::new(&generated, &start, &source.text).expect("a system");
                let long = std::env::var_os("HAMEL_ATTACK").is_some();
                let stepping = Stepping {
                    until: if long { 20.0 } else { 4.0 },
                    step: Some(1.3e-3),
                    method: method.into(),
                    tol: None,
                    lambda: None,
                };
                let plan = stepping.plan(&generated, &system, None).expect("a plan");
                let balance = Cell::new(EnergyBalance::new(&system, &State::start(&system)));
                let mut all = Vec::new();
                for glances in [true, false] {
                    let mut state = State::start(&system);
                    let before = system.evaluations();
                    let recorder = Recorder::new(&system, &plan, &balance, &Quiet);
                    let events = (&balance, &mut Events::default());
                    let (run, recorder) = if glances {
                        let mut recorder = recorder;
                        let run = advance(&system, &plan, &mut state, events, &mut recorder);
                        (run, recorder)
                    } else {
                        let mut watchful = Watchful(recorder);
                        let run = advance(&system, &plan, &mut state, events, &mut watchful);
                        (run, watchful.0)
                    };
                    all.push(outcome(&system, run, &state, before, recorder));
                }
                assert_eq!(all[0], all[1], "{model} {method} {speed}");
                assert!(all[0].0.is_ok() || speed > 1.0, "{model} {method}");
                failed += usize::from(all[0].0.is_err());
            }
        }
        assert!(failed >= 3, "{failed}");
    }
}
