//! The measuring loop.
//!
//! Errors, drifts and evaluations are reproducible: one watched run gives them. Times are not: machines are noisy, in
//! phases longer than a run. Therefore every method is timed once at every step length before any is timed again, and
//! the median of the repeats is kept; ratios of such medians are steadier than the times themselves. Only the first
//! steps of a run are timed, at most [`MAX_TIMED_STEPS`] of them, and the time is scaled to the whole run (by steps, or
//! by evaluations where steps differ): a long run would be interrupted too often to be timed.

use crate::data::{Case, MethodRun, MethodRuns, round_to_three_digits};
use crate::entry::{Division, Entry, Worst};

/// A plan of measurements.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Numbers of steps, ascending.
    pub steps: Vec<u64>,
    /// Tolerances of methods that choose their steps, descending.
    pub tolerances: Vec<f64>,
    /// Number of timings of each run; 0 to measure no times.
    pub repeats: u32,
    /// Shortest duration of a timing, in s, for which a run is repeated.
    pub least: f64,
    /// A method is not run with smaller steps once its error is below this, or no longer decreases: the rest is
    /// rounding.
    pub floor: f64,
}

impl Plan {
    /// Returns `count` numbers of steps, each twice the previous.
    pub fn doublings(from: u64, count: u32) -> Vec<u64> {
        (0..count).map(|index| from << index).collect()
    }
}

/// Largest number of steps timed at once.
pub const MAX_TIMED_STEPS: u64 = 1000;

/// An error counts as reduced if it is less than this times the last one.
const ERROR_REDUCTION: f64 = 0.7;

/// Measures every entry, and adds the results to the case. `tick` is called before each piece of work with the number
/// of finished pieces and their total.
pub fn measure(case: &mut Case, entries: &[Entry], plan: &Plan, tick: &mut dyn FnMut(u64, u64)) {
    let all = entries.len() as u64 * (1 + u64::from(plan.repeats));
    let mut done = 0;
    let mut step = |tick: &mut dyn FnMut(u64, u64)| {
        tick(done, all);
        done += 1;
    };
    let mut methods: Vec<MethodRuns> = Vec::new();
    for entry in entries {
        step(tick);
        methods.push(MethodRuns {
            method: entry.method.clone(),
            kind: entry.kind,
            order: entry.order,
            runs: errors(entry, case.until, plan),
        });
    }
    let mut times: Vec<Vec<Vec<f64>>> = methods
        .iter()
        .map(|method| vec![Vec::new(); method.runs.len()])
        .collect();
    for _ in 0..plan.repeats {
        for ((entry, method), times) in entries.iter().zip(&methods).zip(&mut times) {
            step(tick);
            for (run, times) in method.runs.iter().zip(times) {
                if run.failure.is_none() {
                    times.extend(time(entry, run, plan.least));
                }
            }
        }
    }
    for (method, times) in methods.iter_mut().zip(times) {
        for (run, times) in method.runs.iter_mut().zip(times) {
            run.seconds = median(times).and_then(round_to_three_digits);
        }
    }
    case.methods.extend(methods);
}

/// Makes one watched run for each number of steps, or each tolerance.
fn errors(entry: &Entry, until: f64, plan: &Plan) -> Vec<MethodRun> {
    let mut runs: Vec<MethodRun> = Vec::new();
    let mut stalled = 0;
    let mut last = f64::INFINITY;
    for division in entry.divisions(&plan.steps, &plan.tolerances) {
        let mut worst = Worst::default();
        let Some(outcome) = entry.run(division, until, &mut |deviation| worst.take(deviation))
        else {
            continue;
        };
        let (steps, tolerance) = match division {
            Division::Steps(steps) => (steps, None),
            Division::Tolerance(tolerance) => {
                let taken = outcome.statistics.map_or(0, |counts| counts.accepted);
                (taken, Some(tolerance))
            }
        };
        runs.push(MethodRun {
            steps,
            tolerance,
            rejected: outcome.statistics.map(|counts| counts.rejected),
            evaluations: outcome.evaluations.filter(|_| outcome.failure.is_none()),
            error: round_to_three_digits(outcome.error),
            energy: round_to_three_digits(worst.energy),
            momentum: round_to_three_digits(worst.momentum),
            defect: round_to_three_digits(worst.defect),
            seconds: None,
            failure: outcome.failure,
        });
        // Before a method converges, its error may be constant for many runs.
        let small = outcome.error < 1e-3;
        stalled = if small && outcome.error > ERROR_REDUCTION * last {
            stalled + 1
        } else {
            0
        };
        if outcome.error < plan.floor || stalled >= 2 {
            break;
        }
        last = outcome.error;
    }
    runs
}

/// Returns the mean time of the runs that fill the least time, estimated from that of their first steps.
fn time(entry: &Entry, run: &MethodRun, least: f64) -> Option<f64> {
    let (mut sum, mut whole, mut count) = (0.0, 0.0, 0.0);
    while sum < least {
        let (seconds, all) = entry.clock(run, MAX_TIMED_STEPS)?;
        (sum, whole, count) = (sum + seconds, whole + all, count + 1.0);
        // A clock that does not advance must not block the other measurements.
        if count > 1e5 {
            break;
        }
    }
    (count > 0.0).then_some(whole / count)
}

/// Returns the middle value, or the mean of the two in the middle.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = values.get(middle).copied()?;
    if values.len() % 2 == 1 {
        return Some(upper);
    }
    let lower = values.get(middle.checked_sub(1)?).copied()?;
    Some(f64::midpoint(lower, upper))
}

#[cfg(test)]
mod tests {
    use super::{Plan, measure, median};
    use crate::data::{Case, Kind};
    use crate::entry::{Deviation, Entry, Outcome};
    use hamel::adaptive::Statistics;

    /// Returns a method with error = floor + hᵖ, whose clock returns 1 µs a step.
    fn entry<'a>(name: &str, p: i32, floor: f64) -> Entry<'a> {
        Entry::new(
            name,
            Kind::Method,
            Some(2),
            move |steps, _, watch| {
                for energy in [0.5, 2.0, 1.0] {
                    let (momentum, defect) = (f64::NAN, 0.0);
                    watch(Deviation {
                        energy,
                        momentum,
                        defect,
                    });
                }
                Outcome {
                    evaluations: Some(3 * steps),
                    error: floor + (steps as f64).powi(-p),
                    failure: (steps == 1).then(|| "too long".to_string()),
                    statistics: None,
                }
            },
            |_, part| Some(part as f64 * 1e-6),
        )
    }

    #[test]
    fn runs_end_at_the_floor_and_times_are_medians() {
        let entries = [entry("a", 4, 0.0), entry("b", 4, 1e-7)];
        let plan = Plan {
            steps: Plan::doublings(1, 12),
            tolerances: Vec::new(),
            repeats: 3,
            least: 1e-3,
            floor: 1e-9,
        };
        let mut case = Case::default();
        let mut ticks = Vec::new();
        measure(&mut case, &entries, &plan, &mut |done, all| {
            ticks.push((done, all))
        });
        let [a, b] = &case.methods[..] else {
            panic!("two methods");
        };
        // 256⁻⁴ = 2e-10 is the first error below the floor.
        assert_eq!(a.runs.last().map(|run| run.steps), Some(256));
        // 1e-7 is almost reached with 128 steps; two more runs do not reduce it by much.
        assert_eq!(b.runs.last().map(|run| run.steps), Some(512));
        let run = &a.runs[4];
        assert_eq!((run.steps, run.evaluations), (16, Some(48)));
        assert_eq!(
            (run.energy, run.momentum, run.defect),
            (Some(2.0), None, Some(0.0))
        );
        assert_eq!(run.seconds, Some(1.6e-5));
        assert_eq!(a.runs[0].seconds, None);
        assert_eq!(a.runs[0].evaluations, None);
        assert_eq!(a.runs[0].failure.as_deref(), Some("too long"));
        assert_eq!(ticks.len(), 8);
        assert_eq!(ticks.last(), Some(&(7, 8)));
    }

    #[test]
    fn the_time_of_a_controlled_run_is_in_proportion_of_evaluations() {
        // A run has 1/tolerance steps, every tenth of which is tried twice, with 5 evaluations an attempt, 1 µs an
        // evaluation, and 3 evaluations before the first step.
        let evaluations = |steps: u64| 3 + 5 * (steps + steps / 10);
        let run = move |tolerance: f64, _: f64, watch: crate::entry::Watch| {
            watch(Deviation {
                energy: tolerance,
                momentum: f64::NAN,
                defect: 0.0,
            });
            let accepted = (1.0 / tolerance).round() as u64;
            let evaluations = evaluations(accepted);
            Outcome {
                evaluations: Some(evaluations),
                error: 7.0 * tolerance,
                failure: None,
                statistics: Some(Statistics {
                    accepted,
                    rejected: accepted / 10,
                    evaluations,
                }),
            }
        };
        let clock = move |tolerance: f64, part: f64| {
            let count = evaluations((part / tolerance).round() as u64);
            Some((count as f64 * 1e-6, count))
        };
        let entries = [Entry::controlled("pair", 5, run, clock)];
        let plan = Plan {
            steps: vec![1, 2],
            tolerances: vec![1e-2, 1e-4, 1e-6],
            repeats: 1,
            least: 1e-6,
            floor: 1e-3,
        };
        let mut case = Case::default();
        measure(&mut case, &entries, &plan, &mut |_, _| ());
        let runs = &case.methods[0].runs;
        // The error 7e-4 is below the floor.
        let tolerances: Vec<_> = runs.iter().map(|run| run.tolerance).collect();
        assert_eq!(tolerances, [Some(1e-2), Some(1e-4)]);
        assert_eq!((runs[1].steps, runs[1].rejected), (10_000, Some(1000)));
        assert_eq!(runs[1].evaluations, Some(55_003));
        assert_eq!(runs[1].energy, Some(1e-4));
        assert_eq!(runs[1].seconds, Some(5.5e-2));
    }

    #[test]
    fn medians() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(Vec::new()), None);
    }
}
