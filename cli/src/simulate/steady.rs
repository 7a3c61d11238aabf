//! Runs in equal steps, from each time that matters to the next: one on its own, or two side by side.

use super::record::{Place, Plan, Spacing};
use crate::mechanism::{Instance, Numbers, Whole};
use hamel::{State, StepError, integrate};

/// A run in equal steps, who looks at it, and where it is.
pub struct Steady<'a, O> {
    /// What moves.
    pub system: &'a Instance,
    /// How.
    pub plan: &'a Plan,
    /// Where it is.
    pub state: &'a mut State<Instance>,
    /// Is shown the start and the ends of steps, or of stretches where nobody looks at steps; and samples.
    pub observe: O,
}

impl<'a, O: FnMut(&State<Instance>, Place)> Steady<'a, O> {
    /// The run on its own, to its end.
    ///
    /// # Errors
    /// Why it has ended early; its state is then the last one that it had.
    pub fn alone(mut self) -> Result<(), StepError> {
        (self.observe)(self.state, Place::End);
        let mut ends = self.ends().into_iter();
        ends.try_for_each(|end| self.go(end))
    }

    /// Two runs of one mechanism to their ends. As long as both of them take the same steps, two of these are taken by one
    /// call of machine code. Each run is, to the bit, what it would be on its own.
    pub fn both([mut first, mut second]: [Self; 2]) -> [Result<(), StepError>; 2] {
        let ends = first.ends();
        if ends != second.ends() {
            return [first.alone(), second.alone()];
        }
        (first.observe)(first.state, Place::End);
        (second.observe)(second.state, Place::End);
        let mut outcomes = [Ok(()), Ok(())];
        for end in ends {
            let [one, other] = &mut outcomes;
            if one.is_ok() && other.is_ok() && first.go_with(&mut second, end) {
                continue;
            }
            *one = one.and_then(|()| first.go(end));
            *other = other.and_then(|()| second.go(end));
        }
        outcomes
    }

    /// Times that steps end at: those of samples, those at which inputs jump, and the last one.
    fn ends(&self) -> Vec<f64> {
        let Plan { until, .. } = *self.plan;
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

    fn whole(&self, end: f64) -> Whole<'a> {
        let Plan { method, step, .. } = self.plan;
        Whole::new(self.system, &method.stepper, *step, end - self.state.t)
    }

    /// To a time.
    fn go(&mut self, end: f64) -> Result<(), StepError> {
        let from = self.state.t;
        if end > from {
            self.system.go_from(from);
            let whole = self.whole(end);
            let mut observe = |state: &State<Instance>| {
                if state.t > from {
                    (self.observe)(state, Place::End);
                }
            };
            if self.plan.quiet && whole.run(self.system, self.state, end) {
                observe(self.state);
            } else {
                let (system, step) = (self.system, self.plan.step);
                let inputs = |t, x: &Numbers, xi: &Numbers| system.inputs(t, x, xi);
                integrate(system, &whole, self.state, step, end, inputs, observe)?;
            }
        }
        self.sample(end);
        Ok(())
    }

    /// To a time together with another run; whether both are there. Else neither has moved.
    fn go_with(&mut self, other: &mut Self, end: f64) -> bool {
        let quiet = self.plan.quiet && other.plan.quiet;
        if !quiet || end <= self.state.t {
            return false;
        }
        self.system.go_from(self.state.t);
        other.system.go_from(other.state.t);
        let wholes = [self.whole(end), other.whole(end)];
        let systems = [self.system, other.system];
        let states = [&mut *self.state, &mut *other.state];
        if !Whole::run_both(&wholes, systems, states, end) {
            return false;
        }
        for run in [self, other] {
            (run.observe)(run.state, Place::End);
            run.sample(end);
        }
        true
    }

    /// Shows a sample where one is asked for.
    fn sample(&mut self, end: f64) {
        if self.samples().contains(&end) {
            (self.observe)(self.state, Place::Sample);
        }
    }
}
