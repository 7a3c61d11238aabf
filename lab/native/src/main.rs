//! Times generated functions compiled by rustc, as machine code made at run time, and interpreted step by step,
//! alternately in one process. All results are compared first, bit by bit where the machine has a fused multiply-add.
//!
//! Started by `lab/native/run.sh`; rounds and medians are those of `lab/casadi`.

use hamel::manifold;
use hamel_codegen::generate::from_text;
use hamel_codegen::model::layout::Block;
use hamel_codegen::program::Program;
use hamel_codegen::program::interpret::Interpreter;
use hamel_lab::measure;
use hamel_lab::measure::INPUTS;
use hamel_native::{Compiled, Constants, Tapes};
use std::hint::black_box;
use std::time::Instant;

/// Largest accepted difference, relative to the largest result, where rounding differs.
const CLOSE: f64 = 1e-13;

/// Counts the current and the largest use of the heap.
#[global_allocator]
static HEAP: peak_alloc::PeakAlloc = peak_alloc::PeakAlloc;

mod code {
    include!(concat!(env!("OUT_DIR"), "/free_body.rs"));
    include!(concat!(env!("OUT_DIR"), "/heavy_top.rs"));
    include!(concat!(env!("OUT_DIR"), "/double_pendulum_angles.rs"));
    include!(concat!(env!("OUT_DIR"), "/ur5_robot.rs"));
    include!(concat!(env!("OUT_DIR"), "/solo12.rs"));
    include!(concat!(env!("OUT_DIR"), "/talos_reduced.rs"));
}

/// The text of a description of this build.
macro_rules! text {
    ($name:literal) => {
        include_str!(concat!(env!("OUT_DIR"), "/", $name, ".eom"))
    };
}

/// x, ξ and u.
type State = [Vec<f64>; 3];

/// Returns the program of a description.
fn program(text: &str) -> Program {
    match from_text(text) {
        Ok(generated) => generated.program,
        Err(errors) => panic!(
            "{}",
            hamel_codegen::render::render(&errors, "bench", text, false)
        ),
    }
}

/// The start displaced along its manifold, with different velocities and loads for every k.
fn state(program: &Program, k: usize) -> State {
    let fill = |list: &mut [f64], first: usize| {
        for (i, entry) in list.iter_mut().enumerate() {
            *entry = (((k * 37 + (first + i) * 11) as f64) * 0.618).sin();
        }
    };
    let blocks = program.blocks.iter().map(|block| match *block {
        Block::Flat(n) => hamel::Block::Flat(n),
        Block::Circle => hamel::Block::Circle,
        Block::Quaternion => hamel::Block::Quaternion,
        Block::Rotation => hamel::Block::Rotation,
    });
    let blocks: Vec<hamel::Block> = blocks.collect();
    let mut x = program.start_x.clone();
    let mut chart = vec![0.0; blocks.iter().map(|block| block.chart()).sum()];
    let (mut xi, mut u) = (vec![0.0; program.n + program.n_z], vec![0.0; program.m]);
    fill(&mut chart, 0);
    fill(&mut xi, 100);
    fill(&mut u, 200);
    manifold::retract(&blocks, &mut x, &chart);
    [x, xi, u]
}

/// A function as machine code and interpreted.
struct Case {
    compiled: Compiled,
    constants: Constants,
    interpreter: Interpreter,
    states: Vec<State>,
    steps: usize,
    /// Time of compilation, in ms.
    compiling: f64,
}

impl Case {
    fn new(program: &Program, name: &str) -> Self {
        let function = program
            .function(name)
            .expect("the build script asked for it");
        let tapes = Tapes::new(program, &[function]).expect("it calls nothing");
        let steps = tapes.functions[0].steps.len() + tapes.constants.steps.len();
        let compile = || {
            let tapes = tapes.clone();
            let start = Instant::now();
            let compiled = Compiled::of(tapes);
            (start.elapsed().as_secs_f64() * 1e3, compiled)
        };
        let mut all: Vec<(f64, Compiled)> = (0..5).map(|_| compile()).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (compiling, compiled) = all.swap_remove(0);
        assert!(compiled.interpreted_because().is_none(), "{name}");
        Case {
            constants: compiled.constants(&program.defaults),
            compiled,
            interpreter: Interpreter::new(program, function, &program.defaults),
            states: (0..INPUTS).map(|k| state(program, k)).collect(),
            steps,
            compiling,
        }
    }

    fn row(&self, name: &str, rust: f64, native: f64, interpreted: f64) -> f64 {
        println!(
            "| {name} | {} | {rust:.1} | {native:.1} | {:.2} | {interpreted:.0} | {:.2} | {:.1} |",
            self.steps,
            native / rust,
            self.compiling,
            (self.compiling - 0.3).max(0.0) * 1e3 / self.steps as f64,
        );
        native / rust
    }
}

/// Checks that two results agree.
fn assert_equal(name: &str, rust: &[f64], native: &[f64]) {
    assert_eq!(rust.len(), native.len(), "{name}");
    let exact = cfg!(target_feature = "fma");
    let scale = rust
        .iter()
        .fold(0.0, |most: f64, entry| most.max(entry.abs()));
    for (a, b) in rust.iter().zip(native) {
        let same = if exact {
            a.to_bits() == b.to_bits()
        } else {
            (a - b).abs() <= CLOSE * scale
        };
        assert!(same, "{name}: {a:?} by rustc, {b:?} by machine code");
    }
}

/// Vectors and matrices as lists.
trait Flat {
    fn flat(&self) -> &[f64];
}

impl<const N: usize> Flat for [f64; N] {
    fn flat(&self) -> &[f64] {
        self
    }
}

impl<const N: usize, const M: usize> Flat for [[f64; N]; M] {
    fn flat(&self) -> &[f64] {
        self.as_flattened()
    }
}

/// Prints a row of the table; evaluates to its ratio.
macro_rules! row {
    ($label:literal, $file:literal, $system:ty, $function:ident, $length:expr) => {{
        let program = program(text!($file));
        let case = Case::new(&program, stringify!($function));
        let system = <$system>::default();
        let states: Vec<_> = case
            .states
            .iter()
            .map(|[x, xi, u]| {
                (
                    x.as_slice().try_into().expect("as many coordinates"),
                    xi.as_slice().try_into().expect("as many velocities"),
                    u.as_slice().try_into().expect("as many inputs"),
                )
            })
            .collect();
        for ((x, xi, u), state) in states.iter().zip(&case.states) {
            let expected = system.$function(x, xi, u).expect("no pivot vanishes");
            let expected = expected.flat();
            let mut out = vec![0.0; expected.len()];
            let [x, xi, u] = state;
            let ended = case
                .compiled
                .call(0, &case.constants, [x, xi, u, &[], &[]], &mut out);
            assert_eq!(ended, Ok(()));
            assert_equal($label, expected, &out);
        }
        let rust = |count: u32| {
            for _ in 0..count {
                for (x, xi, u) in &states {
                    let _ = black_box(black_box(&system).$function(x, xi, u));
                }
            }
        };
        let sized = case.compiled.sized(0, &case.constants);
        let sized = sized.expect("these are the lengths");
        let native = |count: u32| {
            let mut out = [0.0; $length];
            for _ in 0..count {
                for (x, xi, u) in &states {
                    let _ = black_box(black_box(&sized).call(x, xi, u, &mut out));
                    black_box(&out);
                }
            }
        };
        let interpreted = |count: u32| {
            for _ in 0..count {
                for [x, xi, u] in &case.states {
                    let _ = black_box(case.interpreter.call(x, xi, u, &[]));
                }
            }
        };
        let (rust, native) = measure::by_turns(&rust, &native);
        let (slow, _) = measure::by_turns(&interpreted, &|_| ());
        case.row($label, rust, native, slow)
    }};
}

/// Measures time and memory of compiling the largest function here, [A B] of Talos, which is too large to be compiled
/// by rustc in a bench.
fn humanoid() {
    let text = text!("talos_reduced").replace("generate accel;", "generate linearize;");
    let program = program(&text);
    let function = program.function("linearize").expect("asked for");
    let tapes = Tapes::new(&program, &[function]).expect("it calls nothing");
    let steps = tapes.functions[0].steps.len();
    let before = HEAP.current_usage();
    HEAP.reset_peak_usage();
    let start = Instant::now();
    let compiled = Compiled::of(tapes);
    let taken = start.elapsed().as_secs_f64();
    let most = HEAP.peak_usage().saturating_sub(before) as f64 / 1e6;
    assert!(compiled.interpreted_because().is_none());
    println!(
        "\nTalos, [A B], {steps} steps: made in {taken:.2} s, with at most {most:.0} MB of the heap"
    );
}

fn main() {
    humanoid();
    println!(
        "| function | steps | rustc, ns | at once, ns | ratio | step by step, ns | made in ms | µs a step beyond 0.3 ms |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let ratios = [
        row!("free body", "free_body", code::FreeBody<f64>, accel, 6),
        row!("heavy top", "heavy_top", code::HeavyTop<f64>, accel, 3),
        row!(
            "double pendulum",
            "double_pendulum_angles",
            code::DoublePendulum<f64>,
            accel,
            2
        ),
        row!("UR5", "ur5_robot", code::Ur5<f64>, accel, 6),
        row!(
            "UR5, [A B]",
            "ur5_robot",
            code::Ur5<f64>,
            linearize,
            12 * 18
        ),
        row!("Solo12", "solo12", code::Solo<f64>, accel, 18),
        row!(
            "Solo12, [A B]",
            "solo12",
            code::Solo<f64>,
            linearize,
            36 * 54
        ),
        row!(
            "Talos, 38 freedoms",
            "talos_reduced",
            code::Talos<f64>,
            accel,
            38
        ),
    ];
    let product: f64 = ratios.iter().map(|ratio| ratio.ln()).sum();
    println!(
        "\nGeometric mean of the ratios: {:.2}",
        (product / ratios.len() as f64).exp()
    );
}
