//! Advances a run from its start to its end, in equal steps or in steps chosen by a tolerance.

use super::energy_balance::EnergyBalance;
use super::events::Events;
use super::fixed_step_run::FixedStepRun;
use super::plan::{Spacing, SteppingPlan};
use super::sample::Sample;
use crate::mechanism::{Instance, Numbers, StepEnergies};
use crate::method::{InputFunction, Stepper};
use hamel::adaptive::{Adaptive, Event, Report};
use hamel::methods::General;
use hamel::{Clock, State, StepError};
use std::cell::Cell;

/// Kind of an observed state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ObservationPoint {
    /// The start, or the end of a step.
    End,
    /// A state within a step, for plots: steps chosen by their error may be few.
    Within,
    /// A requested sample.
    Sample,
}

/// Observer of a run.
pub trait Observer {
    /// Observes a state.
    fn observe(&mut self, state: &State<Instance>, place: ObservationPoint);

    /// Returns the number of following steps at whose ends [`observe_energies`](Self::observe_energies) suffices.
    fn unobserved_steps(&self) -> u64 {
        0
    }

    /// Observes the energies and constraints at the end of a step.
    fn observe_energies(&mut self, _: StepEnergies) {}
}

impl<F: FnMut(&State<Instance>, ObservationPoint)> Observer for F {
    fn observe(&mut self, state: &State<Instance>, place: ObservationPoint) {
        self(state, place);
    }
}

/// Shows the end of a step chosen by a tolerance, preceded by intermediate points for a plot.
fn show<const D: usize>(
    report: Report<'_, Instance, D>,
    spacing: f64,
    samples: &Spacing,
    observer: &mut dyn Observer,
) {
    let Report::Step(step) = report else {
        return;
    };
    let (from, to) = (step.start().t, step.end().t);
    let parts = ((to - from) / spacing).ceil();
    for part in 1..parts as u64 {
        let t = from + (to - from) * (part as f64 / parts);
        observer.observe(&step.at(t), ObservationPoint::Within);
    }
    for t in samples.within(from, to) {
        observer.observe(&step.at(t), ObservationPoint::Sample);
    }
    observer.observe(step.end(), ObservationPoint::End);
}

/// Runs from the start to the end, in equal steps or in steps chosen by a tolerance. If `plan.quiet`, only the start,
/// samples and the ends of segments of equal steps are shown.
pub fn advance(
    system: &Instance,
    plan: &SteppingPlan,
    state: &mut State<Instance>,
    (balance, watched): (&Cell<EnergyBalance>, &mut Events),
    observer: &mut dyn Observer,
) -> Result<(), StepError> {
    // In the form for which methods are compiled.
    let inputs: InputFunction<Instance> = &|t, x: &Numbers, xi: &Numbers| system.inputs(t, x, xi);
    let (Some(tolerance), Stepper::General(general)) = (plan.tolerance, &plan.method.stepper)
    else {
        let run = FixedStepRun {
            system,
            plan,
            state,
            events: Some(watched),
            observer,
        };
        return run.run();
    };
    observer.observe(state, ObservationPoint::End);
    if let Spacing::Times(times) = &plan.spacing
        && times.first() == Some(&state.t)
    {
        observer.observe(state, ObservationPoint::Sample);
    }
    let until = plan.until;
    let spacing = until / plan.points as f64;
    // The run ends when it has lost the motion, or when it is cancelled.
    let followed = |state: &State<Instance>| {
        if plan.is_cancelled() {
            return f64::NAN;
        }
        let here = balance.get().after(system, state);
        if here.lost(Some(tolerance)).is_some() {
            -1.0
        } else {
            1.0
        }
    };
    let mut happened = std::mem::take(&mut watched.happened);
    let gauges: Vec<_> = (0..watched.list().len())
        .map(|index| {
            let watched = &*watched;
            move |state: &State<Instance>| watched.value(index, system, state)
        })
        .collect();
    // The event that follows the motion is the last.
    let mut events = Vec::with_capacity(gauges.len() + 1);
    for (event, gauge) in watched.list().iter().zip(&gauges) {
        events.push(event.to_adaptive(gauge));
    }
    events.push(Event::new(&followed).stopping());
    let clock = Clock::new(system, state);
    let mut stopped_by = None;
    let mut outcome = Ok(());
    let jumps = system.jumps().iter().filter(|jump| **jump < until);
    for end in jumps.copied().chain([until]) {
        system.begin_interval(state.t);
        let run = match general {
            General::Rkmk8 => {
                let method = Adaptive::rkmk8(tolerance);
                method.integrate(system, state, end, inputs, &events, |report| {
                    note(&report, system, &mut happened);
                    show(report, spacing, &plan.spacing, observer);
                })
            }
            _ => {
                let method = Adaptive::rkmk54(tolerance);
                method.integrate(system, state, end, inputs, &events, |report| {
                    note(&report, system, &mut happened);
                    show(report, spacing, &plan.spacing, observer);
                })
            }
        };
        if let Some(clock) = clock {
            clock.set(state);
        }
        match run {
            Ok(run) => stopped_by = run.stopped_by,
            Err(error) => outcome = Err(error),
        }
        if outcome.is_err() || stopped_by.is_some() {
            break;
        }
    }
    watched.stopped_by = stopped_by.filter(|event| *event < watched.list().len());
    watched.happened = happened;
    outcome
}

/// Records an occurrence of an event.
fn note<const D: usize>(
    report: &Report<'_, Instance, D>,
    system: &Instance,
    happened: &mut [Vec<Sample>],
) {
    if let Report::Event { index, state } = report
        && let Some(happened) = happened.get_mut(*index)
    {
        happened.push(Sample::of(system, state));
    }
}
