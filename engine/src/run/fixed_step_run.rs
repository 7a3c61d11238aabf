//! Runs in equal steps, one system alone or two together.

use super::advance::{ObservationPoint, Observer};
use super::events::Events;
use super::plan::{Spacing, SteppingPlan};
use super::segment::{Segment, segments};
use crate::mechanism::{CompiledStepper, Instance, Numbers};
use hamel::methods::Method;
use hamel::{Clock, State, StepError, integrate_while};
use std::ops::ControlFlow;

/// Run in equal steps, with its observer and current state.
pub struct FixedStepRun<'a> {
    /// System.
    pub system: &'a Instance,
    /// Plan.
    pub plan: &'a SteppingPlan,
    /// Current state.
    pub state: &'a mut State<Instance>,
    /// Events that may end the run early.
    pub events: Option<&'a mut Events>,
    /// Observer of the start, of the ends of steps or unobserved segments, and of samples.
    pub observer: &'a mut dyn Observer,
}

impl<'a> FixedStepRun<'a> {
    /// Runs to the end.
    ///
    /// # Errors
    /// The run ends early; the state is then the last one reached.
    pub fn run(mut self) -> Result<(), StepError> {
        self.observer.observe(self.state, ObservationPoint::End);
        if let Some(events) = &mut self.events {
            events.begin(self.system, self.state)?;
        }
        let clock = Clock::new(self.system, self.state);
        for end in self.ends() {
            self.run_to(end, clock)?;
            if self.is_stopped() {
                break;
            }
        }
        Ok(())
    }

    /// Returns whether an event has ended the run, or it is cancelled.
    fn is_stopped(&self) -> bool {
        let events = self.events.as_ref();
        events.is_some_and(|events| events.stopped_by.is_some()) || self.plan.is_cancelled()
    }

    /// Runs two instances of one mechanism to their ends. While both take the same steps, machine code takes two of
    /// these in one call. Each run is bitwise equal to that alone.
    pub fn run_pair([mut first, mut second]: [Self; 2]) -> [Result<(), StepError>; 2] {
        let ends = first.ends();
        if ends != second.ends() {
            return [first.run(), second.run()];
        }
        first.observer.observe(first.state, ObservationPoint::End);
        second.observer.observe(second.state, ObservationPoint::End);
        let mut outcomes = [Ok(()), Ok(())];
        let clocks = [&first, &second].map(|run| Clock::new(run.system, run.state));
        for end in ends {
            let [one, other] = &mut outcomes;
            if one.is_ok() && other.is_ok() && first.run_pair_to(&mut second, end, clocks) {
                continue;
            }
            *one = one.and_then(|()| first.run_to(end, clocks[0]));
            *other = other.and_then(|()| second.run_to(end, clocks[1]));
        }
        outcomes
    }

    /// Times at which steps end: those of samples, those at which inputs jump, and the last one.
    fn ends(&self) -> Vec<f64> {
        let SteppingPlan { until, .. } = *self.plan;
        let mut ends = [self.samples(), self.system.jumps(), &[until]].concat();
        ends.retain(|end| *end <= until);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends
    }

    fn samples(&self) -> &[f64] {
        match &self.plan.spacing {
            Spacing::Times(times) => times,
            _ => &[],
        }
    }

    fn compiled_stepper(&self, end: f64) -> CompiledStepper<'a> {
        let SteppingPlan { method, step, .. } = self.plan;
        CompiledStepper::new(self.system, &method.stepper, *step, end - self.state.t)
    }

    /// Runs to a time, with the clock of the run.
    fn run_to(&mut self, end: f64, clock: Option<Clock<f64>>) -> Result<(), StepError> {
        let from = self.state.t;
        if end > from {
            self.system.begin_interval(from);
            for segment in segments(&self.plan.spacing, self.plan.step, from, end)? {
                self.run_segment(&segment)?;
                self.set_clock(clock);
                if self.is_stopped() {
                    break;
                }
            }
        }
        if self.state.t == end {
            self.sample(end);
        }
        Ok(())
    }

    /// Runs to the end of a segment.
    fn run_segment(&mut self, segment: &Segment) -> Result<(), StepError> {
        let (from, end) = (self.state.t, segment.end);
        let compiled = self.compiled_stepper(end);
        let (system, plan, step) = (self.system, self.plan, self.plan.step);
        let watches = self.events.as_ref().is_some_and(|e| !e.list().is_empty());
        let skips = self.plan.quiet && !watches && !self.plan.has_multiples();
        if skips && compiled.run(system, self.state, end) {
            self.observer.observe(self.state, ObservationPoint::End);
            return Ok(());
        }
        if self.can_run_monitored(&compiled, watches, end) {
            return self.run_monitored(&compiled, segment);
        }
        let inputs = |t, x: &Numbers, xi: &Numbers| system.inputs(t, x, xi);
        let (stepper, observer) = (&self.plan.method.stepper, &mut self.observer);
        let events = &mut self.events;
        // The state at which an event ends the run, or the reason why it cannot be watched.
        let mut stop = None;
        let mut index = 0;
        let clock = Clock::new(system, self.state);
        let look = |state: &State<Instance>| {
            if state.t <= from {
                return ControlFlow::Continue(());
            }
            index += 1;
            let seen = match events {
                Some(events) => events.see(system, stepper, state),
                None => Ok(None),
            };
            match seen {
                Ok(None) => {
                    observer.observe(state, ObservationPoint::End);
                    show(*observer, (segment, clock), index, state);
                    match plan.is_cancelled() {
                        true => ControlFlow::Break(()),
                        false => ControlFlow::Continue(()),
                    }
                }
                Ok(Some(at)) => {
                    observer.observe(&at, ObservationPoint::End);
                    stop = Some(Ok(at));
                    ControlFlow::Break(())
                }
                Err(error) => {
                    observer.observe(state, ObservationPoint::End);
                    stop = Some(Err(error));
                    ControlFlow::Break(())
                }
            }
        };
        integrate_while(system, &compiled, self.state, step, end, inputs, look)?;
        if let Some(stop) = stop {
            *self.state = stop?;
        }
        Ok(())
    }

    /// Returns whether most steps to a time may be taken without observing their ends.
    fn can_run_monitored(&self, compiled: &CompiledStepper, watches: bool, end: f64) -> bool {
        let free = !watches && self.observer.unobserved_steps() > 0 && self.state.is_finite();
        free && compiled.can_run_monitored(self.system, self.state.t, end)
    }

    /// Takes the steps of a segment: unobserved steps many at once, the others one by one.
    fn run_monitored(
        &mut self,
        compiled: &CompiledStepper,
        segment: &Segment,
    ) -> Result<(), StepError> {
        let (system, grid) = (self.system, &segment.grid);
        let inputs = |t, x: &Numbers, xi: &Numbers| system.inputs(t, x, xi);
        let clock = Clock::new(system, self.state);
        let mut done = 0;
        while done < grid.count() && !self.plan.is_cancelled() {
            let observer = &mut *self.observer;
            let free = observer
                .unobserved_steps()
                .min(segment.steps_to_sample(done));
            if free > 0 {
                let steps = (grid, done, free);
                let taken = compiled.run_monitored(system, self.state, steps, clock, |glance| {
                    observer.observe_energies(glance);
                });
                done += taken;
                if taken == free {
                    show(observer, (segment, clock), done, self.state);
                    continue;
                }
            }
            // If the code fails, the method reports the reason.
            let mut next =
                compiled.step_reusing_force(system, self.state, grid.step(), &inputs, &mut None)?;
            if !next.is_finite() {
                return Err(StepError::NonFinite { time: next.t });
            }
            done += 1;
            next.t = grid.time(done);
            *self.state = next;
            self.set_clock(clock);
            let observer = &mut *self.observer;
            observer.observe(self.state, ObservationPoint::End);
            show(observer, (segment, clock), done, self.state);
        }
        Ok(())
    }

    /// Sets the description's time, which equals that of the run up to rounding at the end of a segment, to the time of
    /// the run.
    fn set_clock(&mut self, clock: Option<Clock<f64>>) {
        if let Some(clock) = clock {
            clock.set(self.state);
        }
    }

    /// Runs to a time together with another run; returns whether both did, otherwise both are unchanged.
    fn run_pair_to(&mut self, other: &mut Self, end: f64, clocks: [Option<Clock<f64>>; 2]) -> bool {
        let quiet = self.plan.quiet && other.plan.quiet;
        if !quiet || self.plan.has_multiples() || end <= self.state.t {
            return false;
        }
        self.system.begin_interval(self.state.t);
        other.system.begin_interval(other.state.t);
        let steppers = [self.compiled_stepper(end), other.compiled_stepper(end)];
        let systems = [self.system, other.system];
        let states = [&mut *self.state, &mut *other.state];
        if !CompiledStepper::run_pair(&steppers, systems, states, end) {
            return false;
        }
        for (run, clock) in [self, other].into_iter().zip(clocks) {
            run.observer.observe(run.state, ObservationPoint::End);
            run.set_clock(clock);
            run.sample(end);
        }
        true
    }

    /// Shows a sample if one is requested at this time.
    fn sample(&mut self, end: f64) {
        if self.samples().contains(&end) {
            self.observer.observe(self.state, ObservationPoint::Sample);
        }
    }
}

/// Shows the sample after `index` steps of a segment, if there is one.
fn show(
    observer: &mut dyn Observer,
    (segment, clock): (&Segment, Option<Clock<f64>>),
    index: u64,
    state: &State<Instance>,
) {
    if let Some(t) = segment.sample_time(index) {
        let mut state = State { t, ..state.clone() };
        if let Some(clock) = clock {
            clock.set(&mut state);
        }
        observer.observe(&state, ObservationPoint::Sample);
    }
}
