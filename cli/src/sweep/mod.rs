//! `hamel sweep`: runs one system many times, with different parameters, starts and inputs.
//!
//! | file | owns |
//! |---|---|
//! | `vary`, `target`, `distribution` | the varied entries and their distributions |
//! | `draws`, `permutation` | random numbers that depend only on the seed and the member |
//! | `keep`, `watch` | the kept results of a member, compiled as outputs of the description |
//! | `member`, `work` | one run, or two in parallel lanes, and all runs on threads |
//! | `shard`, `manifest`, `folder` | the files that are written, and those that exist |
//! | `status`, `submit`, `plot` | `--status`, `--submit` and `--plot` |

mod distribution;
mod draws;
mod folder;
mod keep;
mod manifest;
mod member;
mod permutation;
mod plot;
mod shard;
mod status;
mod submit;
mod target;
mod vary;
mod watch;
mod work;

use crate::failure::{Failure, print};
use crate::json::Json;
use crate::outputs;
use crate::parse::Expected;
use crate::robot::RobotOptions;
use crate::simulate::{InputArguments, SteppingArguments};
use crate::source;
use clap::Args;
use folder::{Folder, Part};
use hamel_codegen::generate::Generated;
use hamel_codegen::program::count::count;
use hamel_engine::CancellationToken;
use hamel_engine::State;
use hamel_engine::mechanism::Mechanism;
use hamel_engine::method;
use hamel_engine::option_text;
use hamel_engine::run::{Inputs, Spacing};
use hamel_engine::source::added_outputs;
use hamel_engine::state::StateFile;
use hamel_engine::{Error, Source, Stepping};
use hamel_files::number::group_thousands;
use manifest::Manifest;
use member::{Family, Sweep};
use serde_json::{Map, Value};
use shard::Columns;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use submit::{Engine, Job};
use vary::Variations;
use watch::KeptColumns;
use work::{Cancellation, SweepResult, Work};

/// The default of --shard-size: this fraction of all members, within these limits.
const DEFAULT_SHARDS: u64 = 64;
const MIN_SHARD_SIZE: u64 = 64;
const MAX_SHARD_SIZE: u64 = 10_000;
/// Largest number of shards in a folder.
const MAX_SHARDS: u64 = 1_000_000;
/// Default of --tasks.
const DEFAULT_TASKS: u64 = 16;

/// Runs a system many times, with parameters, starts and inputs that differ from run to run.
///
/// Each run, called a member, gives a row of a table in Parquet files, in a folder. A member depends only on the seed
/// and on its number. The command may be stopped at any time: run again, it computes the missing members.
#[derive(Args)]
#[command(after_help = "Examples:
  hamel sweep drone.eom --vary \"m = normal(1.3, 0.1); start w = uniform([-1, -1, -1], [1, 1, 1])\" \\
      --members 100000 --until 10 --keep \"end; max(norm(w)); event(r[3] < 0)\" --out runs --seed 7
  hamel sweep cart_pole.eom --vary \"start theta = grid(-1, 1, 21); start w = grid(-2, 2, 41)\" --until 5 --out map
  hamel sweep --status runs
  hamel sweep drone.eom … --out runs --shard 3/16               one of 16 parts, on this machine
  hamel sweep drone.eom … --out runs --submit slurm --tasks 16  all of them, on a cluster", after_long_help = format!("{LONG_HELP}\n\n{}", method::descriptions()))]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE", required_unless_present = "status")]
    file: Option<PathBuf>,
    /// Entries that differ from member to member; see --help for the syntax.
    #[arg(
        long,
        value_name = "ITEMS",
        required_unless_present = "status",
        allow_hyphen_values = true
    )]
    vary: Option<String>,
    /// Number of members; default: the points of all grids.
    #[arg(long, value_name = "N", value_parser = members, allow_negative_numbers = true)]
    members: Option<u64>,
    #[command(flatten)]
    stepping: Option<SteppingArguments>,
    /// Results to keep of each member; see --help for the syntax.
    #[arg(
        long,
        value_name = "ITEMS",
        default_value = "end",
        allow_hyphen_values = true
    )]
    keep: String,
    /// Folder of the results.
    #[arg(long, value_name = "FOLDER", required_unless_present = "status")]
    out: Option<PathBuf>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed, allow_negative_numbers = true)]
    seed: u64,
    /// Start and parameters that are not varied, by coordinates; see `hamel eval --help`.
    #[arg(long, value_name = "STATE.json")]
    at: Option<PathBuf>,
    #[command(flatten)]
    inputs: InputArguments,
    /// Threads that run members; default: one for each core.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    threads: Option<u16>,
    /// Members in each file, held in memory until it is written; default: 64 to 10,000.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000), allow_negative_numbers = true)]
    shard_size: Option<u64>,
    /// Compute only the i-th of N parts of the files; several machines may do so at once. Either all of them or none
    /// must have a fused multiply-add: the last digits differ, and a machine of the other kind is refused.
    #[arg(long, value_name = "i/N", value_parser = Part::read)]
    shard: Option<Part>,
    /// Draw the kept results over the varied entries, as SVG: a diagram for each pair of the first columns, with a
    /// point for each finished member.
    #[arg(long, value_name = "F.svg", conflicts_with = "submit")]
    plot: Option<PathBuf>,
    /// Let an engine compute the parts, as an array of tasks; all machines must share the folder.
    #[arg(long, value_name = "ENGINE", conflicts_with = "shard")]
    submit: Option<Engine>,
    /// Number of tasks of --submit; default: 16.
    #[arg(long, value_name = "N", requires = "submit", value_parser = clap::value_parser!(u64).range(1..=MAX_SHARDS), allow_negative_numbers = true)]
    tasks: Option<u64>,
    /// With --submit, return when all tasks have finished.
    #[arg(long, requires = "submit")]
    wait: bool,
    /// Show the finished and the missing parts of a folder.
    #[arg(long, value_name = "FOLDER", exclusive = true)]
    status: Option<PathBuf>,
    #[command(flatten)]
    robot: RobotOptions,
}

const LONG_HELP: &str = "\
--vary takes items, `;` between them:
  m = normal(1.3, 0.1)                           a parameter, by mean and standard deviation
  start w = uniform([-1, -1, -1], [1, 1, 1])     coordinates or velocities, each entry between two numbers
  start w[2] = latin(-1, 1)                      a Latin hypercube: [-1, 1] in as many equal parts as there are
                                                 members, with one member in each
  input F = grid(0, 10, 11)                      11 numbers from 0 to 10; several grids make all combinations
  start R = normal(0, 0.1)                       a rotation, by the vector of a turn from its start, about axes of the
                                                 body (rad); of a pose X so X.R, and its position as X.p
A single number applies to all entries. Arguments may be expressions of parameters that other items do not vary:
`m = normal(m, m / 10)` is about the value that m has. A member begins at the start that the description would have
if it contained its numbers: what is not varied is unchanged, unless prescribed motion, loops or other constraints
determine it.

--keep takes items, `;` between them:
  end                      the time at which the run ended, coordinates and velocities; where the description declares
                           `time t;` its `t` is that time, and else it counts from the start of the run
  max(EXPR), min(EXPR)     the extreme values of an expression, over the ends of steps
  mean(EXPR)               its mean over the time, by trapezia between these
  at(TIME, EXPR)           its value at a time from the start of the run
  event(A < B)             the first time at which a comparison begins to hold, empty where it never does;
                           one that holds at the start must first cease to hold
Expressions are those of the description, over its parameters, coordinates, velocities, inputs and outputs.

Columns are `index`, what is varied, what is kept, by their texts above, and `error`: where a member fails, what is kept of
it is empty, and `error` says why. Readers take all files of a folder at once:
  polars.read_parquet(\"runs/*.parquet\")
  duckdb.sql(\"SELECT * FROM 'runs/*.parquet'\")
  pandas.read_parquet(\"runs\")";

/// Runs the command: computes, submits or shows the status. `stop` can cancel the computation.
pub fn run(arguments: &Arguments, stop: Option<&CancellationToken>) -> Result<(), Failure> {
    if let Some(folder) = &arguments.status {
        return status::run(folder);
    }
    let (Some(file), Some(vary), Some(out), Some(stepping)) = (
        &arguments.file,
        &arguments.vary,
        &arguments.out,
        &arguments.stepping,
    ) else {
        return Err(Failure::usage(
            "FILE, --vary, --until and --out are required",
        ));
    };
    let stepping = &Stepping::from(stepping);
    stepping.check().map_err(Error::from)?;
    let plot = arguments.plot.as_deref();
    outputs::svg("--plot", plot)?;
    outputs::apart(
        [("--plot", plot)],
        [
            Some(file.as_path()),
            arguments.at.as_deref(),
            arguments.inputs.inputs.as_deref(),
        ],
    )?;
    let source = source::open(file, &arguments.robot)?.for_evaluation();
    if arguments.submit.is_some() && source.is_stdin() {
        return Err(Failure::usage(
            "--submit takes a description in a file: the tasks also read it",
        ));
    }
    let (mut sweep, columns) = prepare(arguments, &source, vary, stepping)?;
    let manifest = fix_manifest(arguments, &source, &sweep, vary, stepping)?;
    let part = arguments.shard.unwrap_or(Part::ALL_SHARDS);
    let threads = arguments.threads.map(usize::from);
    if let Some(engine) = arguments.submit {
        // Create the folder here, and release its lock before tasks begin.
        drop(Folder::take(out, &manifest, Part::ALL_SHARDS)?);
        let tasks = arguments
            .tasks
            .unwrap_or(DEFAULT_TASKS)
            .min(manifest.shards());
        let job = Job {
            engine,
            folder: out,
            tasks,
            threads: threads.unwrap_or(1),
            wait: arguments.wait,
        };
        job.submit()?;
        return match arguments.wait {
            true => status::run(out),
            false => Ok(()),
        };
    }
    let folder = Folder::take(out, &manifest, part)?;
    let there = folder::find_finished(out, &manifest)?;
    let own = (0..manifest.shards()).filter(|shard| part.has(*shard));
    let missing = own.filter(|shard| there.shards.binary_search(shard).is_err());
    let cancellation = stop.map(Cancellation::new);
    sweep.plan.stop = cancellation.as_ref().map(Cancellation::of_members);
    let work = Work {
        cancellation,
        sweep: &sweep,
        manifest: &manifest,
        columns: &columns,
        about: &operations(&sweep.family.generated),
        folder: &folder,
    };
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let done = work.compute_shards(missing.collect(), threads.unwrap_or_else(cores))?;
    print(&summary(out, done, there.members))?;
    if let Some(place) = &arguments.plot {
        let there = folder::find_finished(out, &manifest)?;
        let name = &sweep.family.generated.model.name;
        plot::run(place, name, &columns, &folder, &there)?;
        print(&format!("wrote {}\n", place.display()))?;
    }
    Ok(())
}

/// Parses a number of members.
fn members(text: &str) -> Result<u64, Expected> {
    let number = text.parse::<u64>().ok();
    let number = number.filter(|number| (1..=i64::MAX as u64).contains(number));
    number.ok_or(Expected::Members)
}

/// Parses a seed.
fn seed(text: &str) -> Result<u64, Expected> {
    text.parse().map_err(|_| Expected::Seed)
}

/// Prepares the data that members share, and the columns of their rows.
fn prepare(
    arguments: &Arguments,
    source: &Source,
    vary: &str,
    stepping: &Stepping,
) -> Result<(Sweep, Columns), Failure> {
    let varied =
        |generated: &Generated| -> Result<(Map<String, Value>, State, Variations), Failure> {
            let (base, state) = start(arguments, source, generated)?;
            let vary =
                Variations::read(vary, generated, &state, arguments.seed, arguments.members)?;
            Ok((base, state, vary))
        };
    // Report errors in --vary together with those in --keep.
    let both = |error: Error, generated: &Generated| match varied(generated) {
        Err(more) => Failure::from(error).and(more),
        Ok(_) => error.into(),
    };
    let (kept, wrong) = keep::read(&arguments.keep, stepping.until);
    let option = (keep::OPTION, arguments.keep.as_str());
    let generated = added_outputs::derive(
        source,
        option,
        &keep::outputs_to_add(&kept),
        wrong,
        Source::try_derive_default_functions,
    )
    .map_err(|error| match source.try_derive_default_functions() {
        Ok(generated) => both(error, &generated),
        Err(_) => error.into(),
    })?;
    let keeping = KeptColumns::new(&kept, &generated).map_err(|(item, why)| {
        let error = kept[item].0.wrong(why);
        both(
            option_text::invalid_option(option.0, option.1, &[error]),
            &generated,
        )
    })?;
    let (base, state, vary) = varied(&generated)?;
    let inputs = arguments.inputs.read()?;
    let given = Inputs::new(&inputs, stepping.until, &generated, &state).map_err(Error::from)?;
    let both = vary.inputs(&generated);
    if let Some((_, name)) = both
        .iter()
        .find(|(place, _)| given.as_ref().is_some_and(|given| given.has(*place)))
    {
        return Err(Failure::usage(format!(
            "`{name}` is varied and also given by --input or --inputs: remove one of the two"
        )));
    }
    let columns = Columns {
        varied: vary.columns().map(String::from).collect(),
        kept: keeping.columns().to_vec(),
    };
    if let Some(name) = columns.twice() {
        return Err(Failure::usage(format!(
            "two columns would be called `{name}`: give what is varied another name in the description"
        )));
    }
    let unvaried = vary.nominal_state(&base);
    let family = Family {
        mechanism: Arc::new(Mechanism::new(&generated, source.shown())?),
        text: source.text.clone(),
        given,
        generated,
    };
    let system = family.member(&unvaried).map_err(|failed| {
        let message = "no member can start, even if nothing is varied";
        Failure::failed(format!("{message}: {}", failed.why))
    })?;
    let mut plan = stepping.plan(&family.generated, &system, None)?;
    if !keeping.looks_within() {
        plan.points = 1;
        plan.quiet = true;
    }
    let times = keeping.times();
    if !times.is_empty() {
        plan.spacing = Spacing::Times(times);
    }
    let sweep = Sweep {
        family,
        vary,
        keeping,
        plan,
        base,
    };
    Ok((sweep, columns))
}

/// Reads the start of all members, in JSON as in --at, and in numbers.
fn start(
    arguments: &Arguments,
    source: &Source,
    generated: &Generated,
) -> Result<(Map<String, Value>, State), Failure> {
    let Some(at) = &arguments.at else {
        return Ok((Map::new(), State::start(&generated.active)));
    };
    let file = StateFile::read(at, source)?;
    let state = file.state(source, generated)?;
    match file.json {
        Value::Object(members) if !file.is_by_joints() => Ok((members, state)),
        _ => {
            let message = format!("{}: a sweep takes a state by coordinates", file.path);
            Err(Failure::usage(message))
        }
    }
}

/// Collects everything on which rows depend in the manifest.
fn fix_manifest(
    arguments: &Arguments,
    source: &Source,
    sweep: &Sweep,
    vary: &str,
    stepping: &Stepping,
) -> Result<Manifest, Failure> {
    let read = |path: &Path| {
        std::fs::read_to_string(path)
            .map_err(|error| Failure::usage(format!("cannot read {}: {error}", path.display())))
    };
    let text = |text: Option<String>| text.map_or(Json::Null, Json::Text);
    let number = |number: Option<f64>| number.map_or(Json::Null, Json::Number);
    let members = sweep.vary.members();
    let size = arguments.shard_size.unwrap_or_else(|| {
        members
            .div_ceil(DEFAULT_SHARDS)
            .clamp(MIN_SHARD_SIZE, MAX_SHARD_SIZE)
    });
    if members.div_ceil(size) > MAX_SHARDS {
        return Err(Failure::usage(format!(
            "{} members make more than {} files: use a larger --shard-size",
            group_thousands(members),
            group_thousands(MAX_SHARDS)
        )));
    }
    let step = match sweep.plan.tolerance {
        Some(_) => None,
        None => Some(sweep.plan.step),
    };
    // Functions use this machine's arithmetic, methods that for which this program was compiled.
    let compiled = cfg!(any(target_feature = "fma", target_arch = "aarch64"));
    let arithmetic = match (sweep.family.mechanism.is_fused(), compiled) {
        (true, true) => "fused multiply-add",
        (true, false) => "fused multiply-add in functions",
        (false, _) => "separate multiply and add",
    };
    let asked = &arguments.inputs;
    let inputs = asked.inputs.as_deref().map(read).transpose()?;
    let fixed = vec![
        ("vary", Json::Text(vary.trim().into())),
        ("keep", Json::Text(arguments.keep.trim().into())),
        ("seed", Json::Count(arguments.seed.into())),
        ("until", Json::Number(stepping.until)),
        ("method", Json::Text(sweep.plan.method.name.into())),
        ("step", number(step)),
        ("tolerance", number(sweep.plan.tolerance)),
        ("lambda", number(stepping.lambda)),
        ("input", Json::texts(&asked.input)),
        ("inputs", text(inputs)),
        ("hold", Json::Text(asked.hold.to_string())),
        // Last digits differ between machines with and without a fused multiply-add.
        ("arithmetic", Json::Text(arithmetic.into())),
        (
            "start",
            Json::Text(Value::from(sweep.base.clone()).to_string()),
        ),
        ("description", Json::Text(source.text.clone())),
        ("files of the description", Json::texts(&source.texts()?)),
    ];
    let manifest = Manifest::new(members, size, fixed);
    manifest.map_err(|why| Failure::usage(format!("this sweep cannot be recorded: {why}")))
}

/// Operations of each function that members evaluate.
fn operations(generated: &Generated) -> Vec<(String, String)> {
    let program = &generated.program;
    let counted = program.functions.iter().map(|function| {
        let counted = count(&program.graph, &function.outputs);
        (function.name.as_str(), Json::Count(counted.flops() as u128))
    });
    let counts = Json::object(counted).line();
    vec![("hamel.operations".into(), counts)]
}

/// Summarises the new and the earlier work.
fn summary(out: &Path, done: SweepResult, before: u64) -> String {
    let mut text = format!(
        "{}: {} {} computed, {} of them failed",
        out.display(),
        group_thousands(done.members),
        if done.members == 1 {
            "member"
        } else {
            "members"
        },
        group_thousands(done.failed)
    );
    if before > 0 {
        text.push_str(&format!("; {} existed before", group_thousands(before)));
    }
    text.push('\n');
    text
}
