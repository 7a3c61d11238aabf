//! Every description of the repository with every command, and every option of every command at least once.
//!
//! By default a third of all pairs of a file and a command, each file with some command; all with `HAMEL_ATTACK`.
//! Expected refusals of commands and of options are listed in tables, with their reasons.

use crate::common::{hamel, text};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Commands run for each file; `OUT` is a folder.
const COMMANDS: [&str; 6] = [
    "draw FILE --out OUT/picture.svg",
    "check FILE",
    "eval FILE",
    "simulate FILE --until 0.02",
    "linearize FILE",
    "emit FILE --out OUT/code.rs",
];

/// Expected refusals: a file, the command, a part of the message, and the reason.
const REFUSED: [[&str; 4]; 4] = [
    [
        "tests/models/drifting_oscillator.eom",
        "draw",
        "nothing of DriftingOscillator can be drawn",
        "it has energies alone, and no point of it is anywhere",
    ],
    [
        "tests/models/heisenberg.eom",
        "draw",
        "nothing of Heisenberg can be drawn",
        "as above",
    ],
    [
        "tests/models/tabled/wing.eom",
        "draw",
        "nothing of Wing can be drawn",
        "as above",
    ],
    [
        "tests/models/torque_curve.eom",
        "draw",
        "nothing of TorqueCurve can be drawn",
        "as above",
    ],
];

/// Options with at most this many possible values must be used with each of them.
const MOST_VALUES: usize = 4;

/// A description with parts for all options.
const TOY: &str = "system Toy {
    const n = 2;
    param m = 1.5;
    input F;
    joint s: prismatic [1, 0, 0] moves cart { force F; damping 0.1; };
    joint q: revolute [0, 0, 1] on cart moves rod;
    body on cart { mass m; inertia diag(0.1, 0.1, 0.1) about com; }
    body on rod { mass 1 / n; com [0, -0.3, 0]; inertia diag(0.1, 0.1, 0.1) about com; }
    gravity [0, -9.81, 0];
    start q = 0.4;
    output height = 0.3 * cos(q);
}";

/// A robot with a joint that mimics another one.
const ROBOT: &str = r#"<robot name="toy"><link name="base">INERTIA</link><link name="one">INERTIA</link><link name="two">INERTIA</link><link name="three">INERTIA</link>
<joint name="a" type="continuous"><parent link="base"/><child link="one"/><axis xyz="0 0 1"/><origin xyz="0 0 0.3"/></joint>
<joint name="b" type="continuous"><parent link="one"/><child link="two"/><axis xyz="0 1 0"/><origin xyz="0.2 0 0"/></joint>
<joint name="c" type="continuous"><parent link="two"/><child link="three"/><axis xyz="0 1 0"/><origin xyz="0.2 0 0"/><mimic joint="a" multiplier="2"/></joint></robot>"#;

/// Mass and inertia of each link.
const INERTIA: &str = r#"<inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>"#;

/// Options for robots, common to all commands.
const FOR_ROBOTS: [&str; 2] = [
    "--lock b=0.1 --params --mimic free --name Named",
    "--floating --lock a=0.1 --lock b=0.1 --mimic follow --rounding 0",
];

/// Required arguments of commands in addition to a file.
const NEEDED: [(&str, &str); 9] = [
    ("simulate", "--until 0.01"),
    ("compare", "--until 0.01 --steps 4 --methods rkmk4"),
    (
        "sweep",
        "--until 0.01 --members 2 --vary VARIED --out OUT/NEW",
    ),
    ("draw", "--out OUT/robot.svg"),
    ("emit", "--out OUT/robot.rs"),
    ("report", "--out OUT/robot.html"),
    ("trim", "--free FREE"),
    ("step", "CHANNEL"),
    ("bode", "CHANNEL"),
];

/// Uses of all other options, as words separated by spaces; `~` is a space within a word.
const USES: [&str; 43] = [
    "tables TOY --of A,M --format text --all",
    "tables TOY --format markdown",
    "tables TOY --format latex",
    "tables TOY --format json",
    "regressor TOY --format text",
    "regressor TOY --format markdown",
    "regressor TOY --format latex",
    "regressor TOY --format json --identified OUT/beta.json",
    "ops TOY --format text",
    "ops TOY --format json --advise",
    "emit TOY --language rust --out OUT/toy.rs --trace OUT/toy.json",
    "emit TOY --language c --precision float --out OUT/toy",
    "emit TOY --language python --out OUT/toy.py",
    "eval TOY --at OUT/state.json --frame rod --tables",
    "linearize TOY --at OUT/state.json --full --format text",
    "linearize TOY --format json --modes",
    "linearize TOY --format csv --step 0.01",
    "trim TOY --at OUT/state.json --steady --free F --fix s~=~0.1 --out OUT/trim.json --format text",
    "trim TOY --free F --rate q_dot~=~0.1 --format json",
    "lqr TOY --at OUT/state.json --step 0.01 --q h=1 --r F=2 --out OUT/gain.rs --format text",
    "lqr TOY --out OUT/gain.json --format json",
    "step TOY --at OUT/state.json --from F --to height --step 0.01 --until 2 --out OUT/step.csv --plot OUT/step.svg",
    "bode TOY --at OUT/state.json --from F --to height --step 0.01 --range 0.1,9 --out OUT/bode.csv --plot OUT/bode.svg",
    "simulate TOY --until 0.05 --step 0.01 --method rk4 --lambda 3 --at OUT/state.json --out OUT/run.csv --every 2",
    "simulate TOY --until 0.05 --tol 1e-6 --method rkmk54 --times OUT/times.csv --tables --plot OUT/run.svg",
    "simulate TOY --until 0.05 --inputs OUT/inputs.csv --hold",
    "simulate TOY --until 0.05 --input F~=~sin(t)",
    "draw TOY --at OUT/state.json --motion 0.05 --poses 2 --trace rod --view -60,20 --out OUT/toy.svg",
    "draw TOY --time 0.05 --inputs OUT/inputs.csv --hold",
    "draw TOY --time 0.05 --input F~=~t",
    "sweep TOY --vary m~=~uniform(1,~2) --members 4 --until 0.02 --keep end --out OUT/NEW --seed 1 --threads 1 --shard-size 2 --shard 1/2",
    "sweep TOY --vary m~=~uniform(1,~2) --members 4 --until 0.02 --out OUT/runs --method rkmk4 --step 0.01 --plot OUT/runs.svg",
    "sweep TOY --vary m~=~uniform(1,~2) --members 2 --until 0.02 --out OUT/NEW --method rkmk54 --tol 1e-6 --at OUT/state.json",
    "sweep TOY --vary m~=~uniform(1,~2) --members 2 --until 0.02 --out OUT/NEW --method rk4 --lambda 5 --input F~=~t",
    "sweep TOY --vary m~=~uniform(1,~2) --members 2 --until 0.02 --out OUT/NEW --inputs OUT/inputs.csv --hold",
    "sweep TOY --vary m~=~uniform(1,~2) --members 4 --until 0.02 --out OUT/NEW --submit slurm --tasks 2 --wait",
    "sweep TOY --vary m~=~uniform(1,~2) --members 4 --until 0.02 --out OUT/NEW --submit hyperqueue",
    "compare TOY --methods rkmk4,cf4 --until 0.05 --steps 5,10 --at OUT/state.json --out OUT/compared --format json",
    "compare TOP --reference REFERENCE --until 0.01 --steps 40,80 --methods rkmk4 --format markdown",
    "import ROBOT --out OUT/robot.eom",
    "import ROBOT --const n=3",
    "check TOY ROBOT",
    "draw TOY --view isometric",
];

/// Uses that read the output of others.
const LATER: [&str; 2] = [
    "emit TOY --out OUT/toy.rs --check",
    "sweep --status OUT/runs",
];

/// Uses that are always refused here: the words that they contain, a part of the message, and the reason.
const NO_USE: [[&str; 3]; 3] = [
    [
        "--submit slurm",
        "cannot run `sbatch`",
        "this machine is no cluster; other tests have an engine that is made up",
    ],
    ["--submit hyperqueue", "cannot run `hq`", "as above"],
    [
        "import ROBOT --const",
        "--const is for descriptions",
        "an import reads no description",
    ],
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// An empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    // It may not exist yet.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// The descriptions below a folder, by their paths from the root.
fn descriptions(below: &str, found: &mut Vec<String>) {
    let entries = std::fs::read_dir(root().join(below)).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").file_name())
        .map(|name| format!("{below}/{}", name.to_string_lossy()))
        .collect();
    names.sort();
    for name in names {
        if root().join(&name).is_dir() {
            descriptions(&name, found);
        } else if name.ends_with(".eom") && is_whole(&name) {
            found.push(name);
        }
    }
}

/// Whether a file is a system, as opposed to a part that others include.
fn is_whole(name: &str) -> bool {
    let text = std::fs::read_to_string(root().join(name)).expect("a text");
    let starts = |line: &str| line.starts_with("system ") || line.starts_with("pub system ");
    text.lines().any(starts)
}

/// Runs a command and returns its fault, unless it succeeds or is refused as expected.
fn fault(words: &[String], refused: Option<(&str, &str)>) -> Option<String> {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let output = hamel(&words, "");
    let said = text(&output.stderr);
    let right = match refused {
        None => output.status.success(),
        Some((part, _)) => {
            matches!(output.status.code(), Some(1 | 2))
                && said.contains(part)
                && !said.contains("internal")
        }
    };
    let why = refused.map_or(String::new(), |(part, why)| {
        format!("; `{part}` was expected, because {why}")
    });
    (!right).then(|| {
        format!(
            "hamel {}: {:?}{why}\n{said}",
            words.join(" "),
            output.status
        )
    })
}

/// The faults of all of these, computed in parallel.
fn faults<T: Sync>(all: &[T], fault: impl Fn(usize, &T) -> Option<String> + Sync) -> Vec<String> {
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let workers = std::thread::available_parallelism().map_or(1, |n| n.get().min(8));
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(one) = all.get(place) else { return };
                    if let Some(fault) = fault(place, one) {
                        found.lock().expect("no panic").push(fault);
                    }
                }
            });
        }
    });
    found.into_inner().expect("no panic")
}

#[test]
fn every_description_by_every_command() {
    let mut files = Vec::new();
    for below in ["examples", "tests/models"] {
        descriptions(below, &mut files);
    }
    assert!(files.len() > 100, "{files:?}");
    let apart = if std::env::var_os("HAMEL_ATTACK").is_some() {
        1
    } else {
        3
    };
    let pairs = files.iter().enumerate().flat_map(|(number, file)| {
        let commands = COMMANDS.iter().enumerate();
        let mine = commands.filter(move |(place, _)| (number + place) % apart == 0);
        mine.map(move |(_, command)| (file, command))
    });
    let pairs: Vec<(&String, &&str)> = pairs.collect();
    let out = folder("every_description");
    let found = faults(&pairs, |place, (file, command)| {
        let own = out.join(place.to_string());
        std::fs::create_dir_all(&own).expect("a folder");
        let path = root().join(file).display().to_string();
        let words: Vec<String> = command
            .split(' ')
            .map(|word| match word {
                "FILE" => path.clone(),
                _ => word.replace("OUT", &own.display().to_string()),
            })
            .collect();
        let mut refused = REFUSED.iter();
        let refused = refused.find(|row| row[0] == file.as_str() && row[1] == words[0]);
        fault(&words, refused.map(|row| (row[2], row[3])))
    });
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The files of expected refusals exist.
#[test]
fn refused_descriptions_exist() {
    for [file, command, ..] in REFUSED {
        assert!(root().join(file).is_file(), "{file}");
        let names = |known: &&str| known.split(' ').next() == Some(command);
        assert!(COMMANDS.iter().any(names), "{command}");
    }
}

/// An option by its long name, with its possible values.
type Listed = (String, Vec<String>);

/// The subcommands with their options.
fn options() -> Vec<(String, Vec<Listed>)> {
    let line = hamel_cli::described();
    let commands = line.get_subcommands();
    commands
        .map(|command| {
            let options = command.get_arguments().filter(|one| !one.is_positional());
            let options = options.filter_map(|option| {
                let long = option.get_long().filter(|long| *long != "help")?;
                let values = option.get_possible_values();
                let takes = option.get_action().takes_values();
                let values = values.iter().filter(|_| takes);
                let values = values.map(|value| value.get_name().to_string());
                Some((format!("--{long}"), values.collect()))
            });
            (command.get_name().to_string(), options.collect())
        })
        .collect()
}

/// All uses except the later ones: those of the table, and for each command those of robots and of constants.
fn uses() -> Vec<String> {
    let mut all: Vec<String> = USES.iter().map(ToString::to_string).collect();
    for (command, _) in options() {
        let needed = NEEDED.iter().find(|(of, _)| *of == command);
        let needed = needed.map_or("", |(_, needed)| *needed);
        for robots in FOR_ROBOTS {
            let (varied, channel, free) = match robots.contains("--params") {
                true => (
                    "one_mass~=~uniform(1,~2)",
                    "--from a_tau --to h(a_dot)",
                    "a_tau",
                ),
                false => (
                    "start~root_joint_w~=~uniform([0,0,0],~[1,1,1])",
                    "--from root_joint_force[1] --to h(root_joint_v[1])",
                    "root_joint_force",
                ),
            };
            let needed = needed.replace("VARIED", varied).replace("CHANNEL", channel);
            let needed = needed.replace("FREE", free);
            all.push(format!("{command} ROBOT {needed} {robots}"));
        }
        if command != "import" {
            let needed = needed
                .replace("VARIED", "m~=~uniform(1,~2)")
                .replace("CHANNEL", "")
                .replace("FREE", "F");
            all.push(format!("{command} TOY {needed} --const n=3"));
        }
    }
    all
}

/// A new option must be added to the uses.
#[test]
fn every_option_has_a_use() {
    let mut uses = uses();
    uses.extend(LATER.map(String::from));
    for (command, options) in options() {
        let of = |one: &&String| one.split(' ').next() == Some(command.as_str());
        let mine: Vec<Vec<&str>> = uses
            .iter()
            .filter(of)
            .map(|one| one.split_whitespace().collect())
            .collect();
        assert!(!mine.is_empty(), "no use of `hamel {command}`");
        for (option, values) in options {
            let given: BTreeSet<&str> = mine
                .iter()
                .flat_map(|words| words.windows(2).chain(words.chunks(words.len())))
                .filter(|pair| pair[0] == option || pair.last() == Some(&option.as_str()))
                .map(|pair| if pair[0] == option { pair[1] } else { "" })
                .collect();
            assert!(
                !given.is_empty(),
                "no use of `hamel {command} {option}`: add one to USES"
            );
            if values.len() <= MOST_VALUES {
                for value in values {
                    assert!(
                        given.contains(value.as_str()),
                        "no use of `hamel {command} {option} {value}`: add one to USES"
                    );
                }
            }
        }
    }
}

#[test]
fn every_option_works() {
    let out = folder("every_option");
    let write = |name: &str, text: &str| std::fs::write(out.join(name), text).expect("a file");
    write("toy.eom", TOY);
    write("toy.urdf", &ROBOT.replace("INERTIA", INERTIA));
    write("state.json", r#"{"coord": {"q": 0.2}}"#);
    write("inputs.csv", "t,F\n0,0\n0.05,1\n");
    write("times.csv", "t\n0\n0.02\n");
    write("beta.json", "{}");
    let path = |name: &str| out.join(name).display().to_string();
    let tests = |name: &str| root().join("tests").join(name).display().to_string();
    let run = |number: usize, one: &String| {
        let words = one.split_whitespace().map(|word| match word {
            "TOY" => path("toy.eom"),
            "ROBOT" => path("toy.urdf"),
            "TOP" => tests("models/heavy_top_axis.eom"),
            "REFERENCE" => tests("reference/heavy-top-benchmark-150.json"),
            "OUT/NEW" => path(&format!("sweep_{number}")),
            _ if word.starts_with("OUT/") => path(&word["OUT/".len()..]),
            _ => word.replace('~', " "),
        });
        let refused = NO_USE.iter().find(|row| one.contains(row[0]));
        let words: Vec<String> = words.collect();
        fault(&words, refused.map(|row| (row[1], row[2])))
    };
    let mut found = faults(&uses(), run);
    found.extend(faults(&LATER.map(String::from), run));
    for [part, ..] in NO_USE {
        assert!(uses().iter().any(|one| one.contains(part)), "{part}");
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
