//! Collects the kept results of a member while it runs.

use super::keep::{Item, KeptItem, Quantity};
use hamel::State;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Shape;
use hamel_engine::mechanism::{Instance, Output};
use hamel_engine::method::Stepper;
use hamel_engine::names::{self, Time};
use hamel_engine::run::locate_event;
use hamel_engine::run::{ObservationPoint, Observer};
use hamel_engine::source::added_outputs;

/// The kind of an item, without its text.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    End,
    Quantity(Quantity),
}

/// The columns of the kept results, and how to fill them.
#[derive(Clone, Debug)]
pub struct KeptColumns {
    items: Vec<(Kind, String)>,
    columns: Vec<String>,
    /// Whether the end time has a separate column: not if the time is a coordinate.
    timed: bool,
}

impl KeptColumns {
    /// Names the columns; fails if an event compares anything other than numbers.
    pub fn new(kept: &[KeptItem], generated: &Generated) -> Result<Self, (usize, String)> {
        let (mut items, mut columns, mut timed) = (Vec::new(), Vec::new(), true);
        for (index, (piece, item)) in kept.iter().enumerate() {
            let name = added_outputs::name(index);
            let of = match item {
                Item::End => {
                    let coordinates = names::coordinates(&generated.model);
                    let moving = names::velocities_and_states(&generated.active);
                    let all: Vec<String> = coordinates.into_iter().chain(moving).collect();
                    let time = Time::of(&generated.model, &[&all]);
                    timed = time.place.is_none();
                    let time = timed.then_some(time.name);
                    let all = time.into_iter().chain(all);
                    columns.extend(all.map(|name| format!("end {name}")));
                    items.push((Kind::End, name));
                    continue;
                }
                Item::Quantity(of, _) => *of,
            };
            let function = generated.program.function(&name);
            let shape = function.map_or(Shape::Scalar, |function| function.shape);
            if matches!(of, Quantity::Event { .. }) && shape != Shape::Scalar {
                return Err((index, "an event compares numbers".into()));
            }
            columns.extend(names::entries(piece.text, shape));
            items.push((Kind::Quantity(of), name));
        }
        Ok(KeptColumns {
            items,
            columns,
            timed,
        })
    }

    /// Returns the names of the columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Sorted times at which values are requested.
    pub fn times(&self) -> Vec<f64> {
        let mut times: Vec<f64> = self
            .items
            .iter()
            .filter_map(|(kind, _)| match kind {
                Kind::Quantity(Quantity::At(time)) => Some(*time),
                _ => None,
            })
            .collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Returns whether an item depends on states within steps.
    pub fn looks_within(&self) -> bool {
        self.items
            .iter()
            .any(|(kind, _)| !matches!(kind, Kind::End | Kind::Quantity(Quantity::At(_))))
    }
}

/// Results of an item so far.
#[derive(Clone, Debug)]
struct PartialResult {
    of: Quantity,
    /// Index among the outputs of the system.
    output: usize,
    values: Vec<f64>,
    /// The values of the expression at the last state.
    last: Vec<f64>,
}

/// The observer of a running member.
pub struct MemberObserver<'a> {
    keeping: &'a KeptColumns,
    system: &'a Instance,
    stepper: &'a Stepper,
    known: Vec<PartialResult>,
    /// The time of the first, and the last observed state.
    begin: f64,
    last: Option<State<Instance>>,
}

impl<'a> MemberObserver<'a> {
    /// Prepares the observer of a run.
    pub fn new(keeping: &'a KeptColumns, system: &'a Instance, stepper: &'a Stepper) -> Self {
        let known = keeping.items.iter().filter_map(|(kind, name)| {
            let Kind::Quantity(of) = kind else {
                return None;
            };
            let mut outputs = system.outputs().iter();
            let output = outputs.position(|output| output.name == *name)?;
            Some(PartialResult {
                of: *of,
                output,
                values: Vec::new(),
                last: Vec::new(),
            })
        });
        MemberObserver {
            keeping,
            system,
            stepper,
            known: known.collect(),
            begin: 0.0,
            last: None,
        }
    }

    /// Observes a state.
    pub fn see(&mut self, state: &State<Instance>, place: ObservationPoint) {
        let value = |output: usize, state: &State<Instance>| match self.system.outputs().get(output)
        {
            Some(output) => value(self.system, output, state),
            None => Vec::new(),
        };
        if place == ObservationPoint::Sample {
            let asked = self
                .known
                .iter_mut()
                .filter(|known| known.of == Quantity::At(state.t));
            for known in asked {
                known.values = value(known.output, state);
            }
            return;
        }
        let before = self.last.as_ref();
        for known in &mut self.known {
            if matches!(known.of, Quantity::At(_)) {
                continue;
            }
            if matches!(known.of, Quantity::Event { .. }) && !known.values.is_empty() {
                continue;
            }
            let now = value(known.output, state);
            let h = before.map_or(0.0, |before| state.t - before.t);
            match known.of {
                Quantity::At(_) => {}
                Quantity::Max => extreme(&mut known.values, &now, |new, old| new > old),
                Quantity::Min => extreme(&mut known.values, &now, |new, old| new < old),
                Quantity::Mean => {
                    known.values.resize(now.len(), 0.0);
                    // Trapezoidal rule.
                    let ends = now.iter().zip(&known.last);
                    for (sum, (b, a)) in known.values.iter_mut().zip(ends) {
                        *sum += 0.5 * h * (a + b);
                    }
                }
                Quantity::Event { equal } => {
                    let holds = |values: &[f64]| match values.first() {
                        Some(value) if equal => *value <= 0.0,
                        Some(value) => *value < 0.0,
                        None => false,
                    };
                    if let Some(before) = before
                        && holds(&now)
                        && !holds(&known.last)
                    {
                        let at = |state: &State<Instance>| holds(&value(known.output, state));
                        let first = locate_event(self.system, self.stepper, (before, state), &at);
                        known.values = vec![first.t];
                    }
                }
            }
            known.last = now;
        }
        if before.is_none() {
            self.begin = state.t;
        }
        self.last = Some(state.clone());
    }

    /// Returns the kept results of a member that ended in a state.
    pub fn finish(self, end: &State<Instance>) -> Vec<Option<f64>> {
        let mut row = Vec::with_capacity(self.keeping.columns.len());
        let mut known = self.known.into_iter();
        let elapsed = end.t - self.begin;
        for (kind, _) in &self.keeping.items {
            if *kind == Kind::End {
                row.extend(self.keeping.timed.then_some(Some(end.t)));
                row.extend(end.x.iter().chain(end.xi.iter()).copied().map(Some));
                continue;
            }
            let Some(known) = known.next() else {
                continue;
            };
            match known.of {
                Quantity::Event { .. } => row.push(known.values.first().copied()),
                Quantity::Mean => row.extend(known.values.iter().map(|sum| Some(sum / elapsed))),
                _ => row.extend(known.values.into_iter().map(Some)),
            }
        }
        row
    }
}

impl Observer for MemberObserver<'_> {
    fn observe(&mut self, state: &State<Instance>, place: ObservationPoint) {
        self.see(state, place);
    }
}

fn value(system: &Instance, output: &Output, state: &State<Instance>) -> Vec<f64> {
    system.output(output, state.t, &state.x, &state.xi).to_vec()
}

/// Returns the greater or smaller of each entry; NaN is kept.
fn extreme(values: &mut Vec<f64>, now: &[f64], beyond: impl Fn(f64, f64) -> bool) {
    if values.is_empty() {
        values.extend_from_slice(now);
        return;
    }
    for (value, now) in values.iter_mut().zip(now) {
        if beyond(*now, *value) || now.is_nan() {
            *value = *now;
        }
    }
}
