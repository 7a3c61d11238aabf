//! Compares runs and sweeps by machine code made at run time with programs in Rust that do the same with generated
//! code. Final states are compared first; then the CPU times of the processes are measured alternately.
//!
//! Started by `lab/native/runs.sh`.

use cpu_time::ProcessTime;
use hamel::methods::{Method, Rkmk4, Rkmk8, Scheme, Splitting};
use hamel::wide::f64x8;
use hamel::{State, System, ensemble, integrate};
use hamel_engine::{OpenOptions, Quiet, RunArrays, Session, Simulation, Stepping};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

mod code {
    include!(concat!(env!("OUT_DIR"), "/heavy_top.rs"));
    include!(concat!(env!("OUT_DIR"), "/dzhanibekov.rs"));
}

const STEPS: u32 = 1_000_000;
const H: f64 = 1e-3;
const MEMBERS: usize = 20_000;
const MEMBER_STEPS: u32 = 1_000;
const TURNS: usize = 5;
/// Largest accepted difference of final states, after a million steps of a motion that is not chaotic.
const CLOSE: f64 = 1e-6;

fn seconds(act: impl FnOnce()) -> f64 {
    let start = ProcessTime::now();
    act();
    start.elapsed().as_secs_f64()
}

/// Returns the wall time and the CPU time of all threads, in s.
fn timed(act: impl FnOnce()) -> [f64; 2] {
    let start = Instant::now();
    let processors = seconds(act);
    [start.elapsed().as_secs_f64(), processors]
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Integrates the heavy top for a million steps by a method of generated code, and returns its final state.
fn compiled<M: Method<code::HeavyTop<f64>>>(method: &M) -> Vec<f64> {
    let system = code::HeavyTop::<f64>::default();
    let mut state = State::start(&system);
    let until = H * f64::from(STEPS);
    let held = |_, _: &_, _: &_| [];
    integrate(&system, method, &mut state, H, until, held, |_| ()).expect("a run");
    [&state.x[..], &state.xi[..]].concat()
}

fn runs() {
    let path = Path::new("tests/models/heavy_top.eom");
    let session = Session::open(path, &OpenOptions::default(), Arc::new(Quiet));
    let session = session.expect("a description");
    let start = session.start();
    let system = code::HeavyTop::<f64>::default();
    println!("A million steps of the heavy top\n");
    println!("| method | generated Rust, s | `simulate`, s | ratio |\n|---|---|---|---|");
    for name in ["auto", "rkmk4", "rkmk8"] {
        let simulation = Simulation::new(Stepping {
            step: Some(H),
            method: name.into(),
            ..Stepping::until(H * f64::from(STEPS))
        });
        let simulate = || {
            let run = session.simulate(&start, &simulation);
            RunArrays::of(&run.expect("a run"))
        };
        let first = simulate();
        let own = || match first.method {
            "rkmk4" => compiled(&Rkmk4),
            "rkmk8" => compiled(&Rkmk8),
            "splitting" => compiled(&Splitting::new(&system, Scheme::Nystrom4)),
            "splitting6" => compiled(&Splitting::new(&system, Scheme::Nystrom6)),
            other => panic!("{other} is not here"),
        };
        let end = own();
        let last = first.x.len() - 9;
        let found = first.x[last..]
            .iter()
            .chain(&first.xi[first.xi.len() - 3..]);
        for (a, b) in found.zip(&end) {
            assert!((a - b).abs() < CLOSE, "{name}: {a} {b}");
        }
        let (mut rust, mut ours) = (Vec::new(), Vec::new());
        for _ in 0..TURNS {
            rust.push(seconds(|| drop(own())));
            ours.push(seconds(|| drop(simulate())));
        }
        let (rust, ours) = (median(rust), median(ours));
        let name = match name {
            "auto" => format!("{}, as `auto` takes", first.method),
            name => name.into(),
        };
        println!("| {name} | {rust:.3} | {ours:.3} | {:.2} |", ours / rust);
    }
}

fn sweeps() {
    let folder = std::env::temp_dir().join(format!("hamel-runs-{}", std::process::id()));
    let until = H * f64::from(MEMBER_STEPS);
    let sweep = |threads: usize, turn: usize| {
        let out = folder.join(format!("{threads}-{turn}"));
        let words = format!(
            "hamel sweep examples/dzhanibekov.eom --vary start_w --keep end --members {MEMBERS} --until {until} --step {H} --method rkmk4 --threads {threads} --out"
        );
        let words = words.split(' ').map(|word| match word {
            "start_w" => "start w = uniform([-1, -1, -1], [1, 1, 1])".into(),
            word => word.into(),
        });
        let words = words.chain([out.into_os_string()]);
        timed(|| {
            hamel_cli::asked(words, None)
                .map_err(|why| why.render(false))
                .expect("a sweep");
        })
    };
    let wide = code::Dzhanibekov::<f64x8>::default();
    let narrow = code::Dzhanibekov::<f64>::default();
    let states = || -> Vec<State<code::Dzhanibekov<f64>>> {
        let members = 0..MEMBERS;
        let state = |member: usize| {
            let (x, _) = narrow.start();
            let entry = |k: usize| ((member * 3 + k) as f64 * 0.618).sin();
            State {
                t: 0.0,
                x,
                xi: [entry(0), entry(1), entry(2)],
            }
        };
        members.map(state).collect()
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let by_ensemble = |lanes: bool| {
        let mut states = states();
        let quietly = ensemble::quietly;
        let all = |states: &mut Vec<_>| match lanes {
            true => ensemble::integrate(&wide, &Rkmk4, states, H, until, |_, _, _, _| [], quietly),
            false => {
                ensemble::integrate(&narrow, &Rkmk4, states, H, until, |_, _, _, _| [], quietly)
            }
        };
        timed(|| assert!(all(&mut states).failures.is_empty()))
    };
    let [mut eight, mut one, mut ours, mut alone] = [(); 4].map(|()| Vec::new());
    for turn in 0..TURNS {
        eight.push(by_ensemble(true));
        one.push(by_ensemble(false));
        ours.push(sweep(threads, turn));
        alone.push(sweep(1, turn));
    }
    let _ = std::fs::remove_dir_all(&folder);
    let steps = MEMBERS as f64 * f64::from(MEMBER_STEPS);
    let ns = |times: Vec<[f64; 2]>| {
        [0, 1].map(|of| median(times.iter().map(|both| both[of]).collect()) / steps * 1e9)
    };
    let (eight, one, ours, alone) = (ns(eight), ns(one), ns(ours), ns(alone));
    println!(
        "\n{MEMBERS} members of {MEMBER_STEPS} steps of order 4, bodies that are free; ns of a step by the clock, and of all processors together, which other programs on the machine change least\n"
    );
    println!("| | threads | by the clock | of processors | speed of `sweep` beside it |");
    println!("|---|---|---|---|---|");
    for (name, threads, [clock, processors]) in [
        ("`sweep`", threads, ours),
        ("`sweep`", 1, alone),
        ("`ensemble`, generated Rust, one lane", threads, one),
        ("`ensemble`, generated Rust, eight lanes", threads, eight),
    ] {
        let beside = processors / ours[1];
        println!("| {name} | {threads} | {clock:.1} | {processors:.1} | {beside:.2} |");
    }
}

fn main() {
    runs();
    sweeps();
}
