//! Takes steps as machine code: one by one, many in one call, or those of two systems together.

use super::step_code::StepCode;
use super::{Instance, largest};
use crate::method::Stepper;
use hamel::methods::Method;
use hamel::{Clock, Grid, State, StepError, System};
use hamel_native::{Compiled, Constants};
use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

/// Least number of equal steps for which a step is compiled.
const MIN_STEPS_TO_COMPILE: f64 = 1000.0;

/// A compiled step with the parameters of one system.
struct ParametrizedStep {
    code: Arc<StepCode>,
    compiled: Compiled,
    constants: Constants,
    /// The step with energies at its end.
    with_energies: OnceCell<Option<(Compiled, Constants)>>,
}

/// Energies and constraint violation at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct StepEnergies {
    /// T.
    pub kinetic: f64,
    /// V.
    pub potential: f64,
    /// The largest |φ|.
    pub constraint: f64,
}

/// Method whose steps run as machine code if all have the same length and inputs are constant.
pub struct CompiledStepper<'a> {
    stepper: &'a Stepper,
    /// The code for the length of the first step.
    code: OnceCell<Option<ParametrizedStep>>,
    /// Buffer for x and ξ at the end of a step.
    end: RefCell<Vec<f64>>,
    worthwhile: bool,
    length: f64,
}

impl<'a> CompiledStepper<'a> {
    /// Prepares a method for steps of this length over a total time; the step is compiled on first use.
    pub fn new(system: &Instance, stepper: &'a Stepper, length: f64, time: f64) -> Self {
        CompiledStepper {
            stepper,
            code: OnceCell::new(),
            end: RefCell::default(),
            worthwhile: time / length >= MIN_STEPS_TO_COMPILE && system.given.is_none(),
            length,
        }
    }

    fn code(&self, system: &Instance, h: f64) -> Option<&ParametrizedStep> {
        if !self.worthwhile {
            return None;
        }
        let ready = self.code.get_or_init(|| {
            let Stepper::General(method) = self.stepper else {
                return None;
            };
            let code = system.of.compiled_step(*method, h);
            let compiled = code.compiled.clone()?;
            let constants = compiled.constants(system.functions.params());
            Some(ParametrizedStep {
                code,
                compiled,
                constants,
                with_energies: OnceCell::new(),
            })
        });
        ready.as_ref().filter(|ready| ready.code.h == h)
    }

    /// Returns the code of the steps to a time and their grid, if they can be taken in one call.
    fn at_once(
        &self,
        system: &Instance,
        from: f64,
        until: f64,
    ) -> Option<(&ParametrizedStep, Grid)> {
        // The code contains neither projections after a step nor varying inputs.
        let of = &system.of;
        if of.embedded || of.project_position.is_some() || of.project_velocity.is_some() {
            return None;
        }
        let grid = Grid::new(from, until, self.length).ok()?;
        Some((self.code(system, grid.step())?, grid))
    }

    /// Takes all steps to a time in one call, without observing intermediate states; returns whether it did, which
    /// requires that the step can be compiled. If a step fails, the state is unchanged, and single steps report the
    /// reason.
    pub fn run(&self, system: &Instance, state: &mut State<Instance>, until: f64) -> bool {
        let Some((ready, grid)) = self.at_once(system, state.t, until) else {
            return false;
        };
        let (count, clock) = (grid.count(), Clock::new(system, state));
        let given = |number| at(clock, grid.time(number));
        let u = system.inputs(state.t, &state.x, &state.xi);
        let mut all = [&*state.x, &*state.xi].concat();
        let ParametrizedStep {
            compiled,
            constants,
            ..
        } = ready;
        if compiled.repeat(0, constants, &mut all, &u, given, count) < count {
            return false;
        }
        ready.finish(system, state, &all, (until, count));
        true
    }

    /// Returns whether all of the equal steps to a time can be taken by [`run_monitored`](Self::run_monitored).
    pub fn can_run_monitored(&self, system: &Instance, from: f64, until: f64) -> bool {
        let ready = self.at_once(system, from, until);
        ready.is_some_and(|(ready, _)| ready.with_energies(system).is_some())
    }

    /// Takes `count` steps of a grid from one of its times on, with the clock of its start, while only energies and
    /// constraints at their ends are observed; returns the number of steps taken. If it is smaller, the code failed at
    /// the next step.
    pub fn run_monitored(
        &self,
        system: &Instance,
        state: &mut State<Instance>,
        (grid, from, count): (&Grid, u64, u64),
        clock: Option<Clock<f64>>,
        mut see: impl FnMut(StepEnergies),
    ) -> u64 {
        let ready = self.code(system, grid.step());
        let Some((ready, (compiled, constants))) =
            ready.and_then(|ready| Some((ready, ready.with_energies(system)?)))
        else {
            return 0;
        };
        let u = system.inputs(state.t, &state.x, &state.xi);
        let mut all = [&*state.x, &*state.xi].concat();
        let given = |number| at(clock, grid.time(from + number));
        let all_of = (&mut all[..], &u[..]);
        let done = compiled.repeat_watched(0, constants, all_of, given, count, |more| {
            if let [kinetic, potential, residuals @ ..] = more {
                see(StepEnergies {
                    kinetic: *kinetic,
                    potential: *potential,
                    constraint: largest(residuals),
                });
            }
        });
        if done > 0 {
            ready.finish(system, state, &all, (grid.time(from + done), done));
        }
        done
    }

    /// Like [`run`](Self::run) for two systems of one mechanism, by code that takes both of their steps at once. If a
    /// step of either fails, both states are unchanged.
    pub fn run_pair(
        of: &[CompiledStepper; 2],
        systems: [&Instance; 2],
        states: [&mut State<Instance>; 2],
        until: f64,
    ) -> bool {
        let at_once = |lane: usize| of[lane].at_once(systems[lane], states[lane].t, until);
        let (Some((first, grid)), Some((second, other_grid))) = (at_once(0), at_once(1)) else {
            return false;
        };
        let count = grid.count();
        if count != other_grid.count() || !Arc::ptr_eq(&first.code, &second.code) {
            return false;
        }
        let Some(paired) = first.code.paired() else {
            return false;
        };
        let constants = paired.constants([&first.constants, &second.constants]);
        let u = [0, 1].map(|lane| {
            let state = &states[lane];
            systems[lane].inputs(state.t, &state.x, &state.xi)
        });
        let [mut one, mut other] =
            [0, 1].map(|lane| [&*states[lane].x, &*states[lane].xi].concat());
        let clocks = [0, 1].map(|lane| Clock::new(systems[lane], states[lane]));
        let given = |number| {
            let times = [grid.time(number), other_grid.time(number)];
            [at(clocks[0], times[0]), at(clocks[1], times[1])]
        };
        let both = [one.as_mut_slice(), other.as_mut_slice()];
        if paired.repeat(0, &constants, both, [&u[0], &u[1]], given, count) < count {
            return false;
        }
        let [state, another] = states;
        first.finish(systems[0], state, &one, (until, count));
        second.finish(systems[1], another, &other, (until, count));
        true
    }
}

/// Returns the description's time at a time of a run; an arbitrary number if it declares none.
fn at(clock: Option<Clock<f64>>, t: f64) -> f64 {
    clock.map_or(0.0, |clock| clock.at(t))
}

impl ParametrizedStep {
    fn with_energies(&self, system: &Instance) -> Option<&(Compiled, Constants)> {
        let make = || {
            let compiled = system.of.compiled_step_with_energies(&self.code)?.clone();
            let constants = compiled.constants(system.functions.params());
            Some((compiled, constants))
        };
        self.with_energies.get_or_init(make).as_ref()
    }

    /// Sets the state to that after `count` steps.
    fn finish(
        &self,
        system: &Instance,
        state: &mut State<Instance>,
        all: &[f64],
        (until, count): (f64, u64),
    ) {
        let evaluated = system.evaluations.get() + self.code.evaluations * count;
        system.evaluations.set(evaluated);
        let (x, xi) = all.split_at(state.x.len());
        *state = State {
            t: until,
            x: x.into(),
            xi: xi.into(),
        };
    }
}

impl Method<Instance> for CompiledStepper<'_> {
    fn order(&self) -> u32 {
        Method::<Instance>::order(self.stepper)
    }

    fn preserves_constraints(&self) -> bool {
        Method::<Instance>::preserves_constraints(self.stepper)
    }

    fn step<U>(
        &self,
        system: &Instance,
        state: &State<Instance>,
        h: f64,
        inputs: &U,
    ) -> Result<State<Instance>, StepError>
    where
        U: Fn(
            f64,
            &<Instance as System>::Coordinates,
            &<Instance as System>::Velocities,
        ) -> <Instance as System>::Inputs,
    {
        self.step_reusing_force(system, state, h, inputs, &mut None)
    }

    fn step_reusing_force<U>(
        &self,
        system: &Instance,
        state: &State<Instance>,
        h: f64,
        inputs: &U,
        force: &mut Option<<Instance as System>::Chart>,
    ) -> Result<State<Instance>, StepError>
    where
        U: Fn(
            f64,
            &<Instance as System>::Coordinates,
            &<Instance as System>::Velocities,
        ) -> <Instance as System>::Inputs,
    {
        if let Some(ParametrizedStep {
            code,
            compiled,
            constants,
            ..
        }) = self.code(system, h)
        {
            let u = inputs(state.t, &state.x, &state.xi);
            let given = [at(Clock::new(system, state), state.t + h)];
            let arguments: [&[f64]; 5] = [&state.x, &state.xi, &u, &given, &[]];
            let mut end = self.end.borrow_mut();
            end.resize(state.x.len() + state.xi.len(), f64::NAN);
            let ended = compiled.call(0, constants, arguments, &mut end);
            // If the code fails, the method reports the reason.
            if ended.is_ok() && end.iter().all(|number| number.is_finite()) {
                let evaluated = system.evaluations.get() + code.evaluations;
                system.evaluations.set(evaluated);
                let (x, xi) = end.split_at(state.x.len());
                return Ok(State {
                    t: state.t + h,
                    x: x.into(),
                    xi: xi.into(),
                });
            }
        }
        self.stepper
            .step_reusing_force(system, state, h, inputs, force)
    }
}

#[cfg(test)]
mod tests;
