//! A member: its state, its run, and its row of results.

use super::vary::Variations;
use super::watch::{KeptColumns, MemberObserver};
use hamel::{State, StepError};
use hamel_codegen::generate::Generated;
use hamel_engine::mechanism::{Instance, Mechanism};
use hamel_engine::run::{
    EarlyEnd, EnergyBalance, Events, FixedStepRun, Inputs, SteppingPlan, advance,
};
use hamel_engine::state::StateProblem;
use hamel_engine::{Error, state};
use serde_json::{Map, Value};
use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

/// The parts from which the systems of all members are made.
pub struct Family {
    /// The system, with outputs for the kept items.
    pub generated: Generated,
    /// Its compiled functions.
    pub mechanism: Arc<Mechanism>,
    /// The text of the description, for states and messages.
    pub text: String,
    /// The inputs, which act on members from outside.
    pub given: Option<Inputs>,
}

/// Data that all members share.
pub struct Sweep {
    /// The source of their systems.
    pub family: Family,
    /// The varied entries.
    pub vary: Variations,
    /// The kept items.
    pub keeping: KeptColumns,
    /// The plan of runs, with the method of the first member.
    pub plan: SteppingPlan,
    /// The state that members modify, in JSON.
    pub base: Map<String, Value>,
}

/// The results of a member.
#[derive(Clone, Debug)]
pub struct Row {
    /// Number of the member.
    pub index: u64,
    /// Varied values.
    pub varied: Vec<f64>,
    /// Kept values; empty if the member failed.
    pub kept: Vec<Option<f64>>,
    /// Reason of the failure.
    pub error: Option<String>,
}

/// Reason for which a member has no results.
#[derive(Clone, Debug)]
pub struct Failed {
    /// Kind of failure, in a word or two.
    pub kind: &'static str,
    /// Message, in a sentence.
    pub why: String,
}

/// A member at its start.
struct Member {
    index: u64,
    varied: Vec<f64>,
    system: Instance,
    plan: SteppingPlan,
}

/// A running member.
struct Running<'a> {
    member: &'a Member,
    state: State<Instance>,
    balance: Cell<EnergyBalance>,
    watch: MemberObserver<'a>,
}

impl Sweep {
    /// Runs members and returns their rows in any order; two run in parallel lanes if single steps are not observed.
    pub fn rows(&self, members: Range<u64>) -> Vec<Row> {
        let side_by_side = self.plan.quiet && self.plan.tolerance.is_none();
        let mut rows = Vec::new();
        let mut waiting: Option<Member> = None;
        for index in members {
            match (self.begin(index), waiting.take()) {
                (Err(row), other) => {
                    rows.push(row);
                    waiting = other;
                }
                (Ok(member), Some(other)) => rows.extend(self.both(&other, &member)),
                (Ok(member), None) if side_by_side => waiting = Some(member),
                (Ok(member), None) => rows.push(self.run_alone(&member)),
            }
        }
        rows.extend(waiting.map(|member| self.run_alone(&member)));
        rows
    }

    /// Prepares a member at its start, or its row if it cannot start.
    fn begin(&self, index: u64) -> Result<Member, Row> {
        let varied = self.vary.values(index);
        match self.family.member(&self.vary.state(&varied, &self.base)) {
            Ok(system) => Ok(Member {
                plan: SteppingPlan {
                    method: self.plan.method.adapt(&system),
                    ..self.plan.clone()
                },
                index,
                varied,
                system,
            }),
            Err(failed) => Err(Row::new(index, varied, Err(failed))),
        }
    }

    fn run_alone(&self, member: &Member) -> Row {
        let mut running = Running::new(member, &self.keeping);
        let outcome = running.advance();
        running.row(outcome)
    }

    fn both(&self, first: &Member, second: &Member) -> [Row; 2] {
        let mut first = Running::new(first, &self.keeping);
        let mut second = Running::new(second, &self.keeping);
        let [one, other] =
            FixedStepRun::run_pair([first.fixed_step_run(), second.fixed_step_run()]);
        [first.row(one), second.row(other)]
    }
}

impl<'a> Running<'a> {
    fn new(member: &'a Member, keeping: &'a KeptColumns) -> Self {
        let Member { system, plan, .. } = member;
        let state = State::start(system);
        Running {
            balance: Cell::new(EnergyBalance::new(system, &state)),
            watch: MemberObserver::new(keeping, system, &plan.method.stepper),
            state,
            member,
        }
    }

    fn advance(&mut self) -> Result<(), StepError> {
        let Member { system, plan, .. } = self.member;
        let balance = &self.balance;
        let watches = plan.monitors_energy(system);
        // Kept items detect their events themselves.
        let watched = (balance, &mut Events::default());
        let watch = &mut self.watch;
        let mut observe = |state: &State<Instance>, place| {
            if watches {
                balance.set(balance.get().after(system, state));
            }
            watch.see(state, place);
        };
        advance(system, plan, &mut self.state, watched, &mut observe)
    }

    fn fixed_step_run(&mut self) -> FixedStepRun<'_> {
        FixedStepRun {
            system: &self.member.system,
            plan: &self.member.plan,
            state: &mut self.state,
            events: None,
            observer: &mut self.watch,
        }
    }

    fn row(self, outcome: Result<(), StepError>) -> Row {
        let Member {
            index,
            varied,
            system,
            plan,
        } = self.member;
        let early = EarlyEnd::explain(system, plan, outcome, &self.state, self.balance.get());
        let kept = match early {
            Ok(None) => Ok(self.watch.finish(&self.state)),
            Ok(Some(early)) => Err(Failed {
                kind: early.kind(),
                why: early.to_string(),
            }),
            Err(error) => Err(Failed::of("start", &error)),
        };
        Row::new(*index, varied.clone(), kept)
    }
}

impl Row {
    fn new(index: u64, varied: Vec<f64>, kept: Result<Vec<Option<f64>>, Failed>) -> Self {
        let (kept, error) = match kept {
            Ok(kept) => (kept, None),
            Err(Failed { kind, why }) => (Vec::new(), Some(format!("{kind}: {why}"))),
        };
        Row {
            index,
            varied,
            kept,
            error,
        }
    }
}

impl Family {
    /// Creates the system of a member with this state: the only place where systems of members are made.
    pub fn member(&self, state: &Value) -> Result<Instance, Failed> {
        let state =
            state::State::of(&self.generated, &self.text, state).map_err(|errors| Failed {
                kind: "start",
                why: joined(&errors),
            })?;
        let system = Instance::of(&self.mechanism, &state);
        let system = system.map_err(|error| Failed::of("start", &error))?;
        let given = self.given.clone().map(|given| given.started(&state));
        let given = given.transpose().map_err(|problem| Failed {
            kind: "start",
            why: format!("--inputs: {problem}"),
        })?;
        let system = system.with_inputs(given);
        let checked = system.check_parameters(&state.x);
        checked.map_err(|error| Failed::of("singular", &error))?;
        Ok(system)
    }
}

/// Joins all errors in a start to one line.
fn joined(problems: &[StateProblem]) -> String {
    let all: Vec<String> = problems.iter().map(ToString::to_string).collect();
    all.join("; ")
}

impl Failed {
    /// Writes an error in one line.
    fn of(kind: &'static str, error: &Error) -> Self {
        let why = error.to_string();
        let words: Vec<&str> = why.split_whitespace().collect();
        Failed {
            kind,
            why: words.join(" "),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Arguments, prepare};
    use super::{Row, Sweep};
    use crate::source;
    use clap::Parser;
    use std::path::{Path, PathBuf};

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: Arguments,
    }

    fn sweep(path: &Path, options: &[&str]) -> Sweep {
        let file = path.display().to_string();
        let words = ["sweep", &file, "--out", "nowhere"].into_iter();
        let words = words.chain(options.iter().copied());
        let arguments = Line::try_parse_from(words).expect("options").arguments;
        let source = source::open(path, &arguments.robot).expect("a description");
        let (Some(vary), Some(stepping)) = (&arguments.vary, &arguments.stepping) else {
            panic!("--vary and --until are needed");
        };
        let sweep = prepare(&arguments, &source.for_evaluation(), vary, &stepping.into());
        sweep.expect("a sweep").0
    }

    fn model(name: &str) -> PathBuf {
        Path::new("../tests/models").join(format!("{name}.eom"))
    }

    /// Writes a description to a temporary file.
    fn write_temporary(name: &str, text: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("hamel-{name}-{}.eom", std::process::id()));
        std::fs::write(&path, text).expect("a description");
        path
    }

    fn bits(row: &Row) -> (u64, Vec<u64>, Vec<Option<u64>>, Option<String>) {
        let varied = row.varied.iter().map(|number| number.to_bits());
        let kept = row.kept.iter().map(|number| number.map(f64::to_bits));
        (
            row.index,
            varied.collect(),
            kept.collect(),
            row.error.clone(),
        )
    }

    /// Returns the rows of members that share lanes, checked to be bitwise equal to those of members that run alone.
    fn rows(path: &Path, options: &[&str]) -> Vec<Row> {
        let sweep = sweep(path, options);
        let members = sweep.vary.members();
        let mut together = sweep.rows(0..members);
        together.sort_by_key(|row| row.index);
        // Other neighbours, and none.
        let mut others = sweep.rows(1..members);
        others.extend(sweep.rows(0..1));
        others.sort_by_key(|row| row.index);
        let alone = (0..members).flat_map(|index| sweep.rows(index..index + 1));
        for ((a, b), c) in together.iter().zip(&others).zip(alone) {
            assert_eq!(bits(a), bits(&c), "{path:?} {options:?}");
            assert_eq!(bits(b), bits(&c), "{path:?} {options:?}");
        }
        together
    }

    #[test]
    fn members_do_not_feel_their_neighbours() {
        let cases = [
            ("heavy_top", "m = uniform(1, 2); start R = uniform(-1, 1)"),
            ("heavy_top_quaternion", "start q = uniform(-1, 1)"),
            (
                "kapitza",
                "Omega = uniform(30, 60); start q = uniform(-3, 3)",
            ),
            (
                "lagging_drone",
                "input wind = normal(0, 1); T = uniform(0.05, 0.1)",
            ),
            ("rolling_disk", "a = uniform(0.4, 0.6)"),
            ("four_bar_loop", "start q1 = uniform(1, 1.2)"),
            // Beyond a million turns a sine is not computed inline.
            ("double_pendulum_angles", "start th1 = grid(0, 2e6, 7)"),
        ];
        for (case, (name, vary)) in cases.into_iter().enumerate() {
            let count = ["--members", "7"];
            let long = std::env::var_os("HAMEL_ATTACK").is_some();
            let until = if long { "2" } else { "1" };
            let options = ["--vary", vary, "--until", until, "--step", "1e-3"];
            let methods = ["rkmk4", "rk4", "auto"].into_iter().enumerate();
            // One of these methods in turn, and all with `HAMEL_ATTACK`.
            for (_, method) in methods.filter(|(turn, _)| long || case % 3 == *turn) {
                let options = [&options[..], &count, &["--method", method]].concat();
                let rows = rows(&model(name), &options);
                assert_eq!(rows.len(), 7);
                let failed = rows.iter().find_map(|row| row.error.as_ref());
                assert_eq!(failed, None, "{name} {method}");
            }
        }
    }

    /// Intermediate samples, one of them at the start, and segments that are too short to be compiled.
    #[test]
    fn samples_are_those_of_members_alone() {
        let options = "--members 5 --until 3 --step 1e-3 --method rkmk4".split(' ');
        let vary = "m = uniform(1, 2); start w[3] = latin(-5, 5)";
        let keep = "at(0, w); at(1.3, w); at(1.301, R[1,2]); end; at(3, w)";
        let mut options: Vec<&str> = options.collect();
        options.extend(["--vary", vary, "--keep", keep]);
        for row in rows(&model("heavy_top"), &options) {
            assert!(row.error.is_none() && row.kept.iter().all(Option::is_some));
            let [at, end] = [
                &row.kept[10 + 9 + 1..][..3],
                &row.kept[row.kept.len() - 3..],
            ];
            assert_eq!(at, end);
        }
    }

    /// Members that cannot start, that reach a singular M, or that reach infinite numbers, together with members that
    /// succeed.
    #[test]
    fn members_that_fail_do_so_alone() {
        let text = "system Bead {
            param m = 1;
            coord q;
            velocity w;
            rate q = w;
            kinetic m * (1 - q) * w^2 / 2;
            start w = 0;
        }";
        let path = write_temporary("bead", text);
        let mut kinds = Vec::new();
        for vary in [
            "m = grid(0, 1, 2); start w = grid(-1, 1, 3)",
            "start w = grid(-1, 1e200, 2)",
        ] {
            let options = "--until 2 --step 1e-3 --method rkmk4 --vary".split(' ');
            let options: Vec<&str> = options.chain([vary]).collect();
            for row in rows(&path, &options) {
                let kind = row.error.as_ref().and_then(|error| error.split(':').next());
                kinds.push(kind.unwrap_or("none").to_string());
            }
        }
        std::fs::remove_file(&path).expect("it was written");
        let singular = ["singular"; 3];
        let others = ["none", "none", "singular", "none", "not finite"];
        assert_eq!(kinds, [&singular[..], &others].concat());
    }
}
