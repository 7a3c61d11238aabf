//! Measures the time from a description's text to formatted code, including all checks.

use hamel_codegen::builder::source;
use hamel_codegen::urdf::{Options, import};

#[path = "../src/chain.rs"]
mod chain;
#[path = "../../cli/tests/suite/common/installed.rs"]
mod installed;

fn main() {
    divan::main();
}

#[divan::bench(args = ["free_body", "heavy_top", "cart_pole", "double_pendulum_angles"])]
fn parse_to_formatted_code(bencher: divan::Bencher, name: &str) {
    let path = format!("{}/models/{name}.eom", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the model is in the repository");
    bencher.bench(|| source(divan::black_box(&text), name).expect("the model is correct"));
}

/// Spatial chains with run-time parameters: forward dynamics and rates.
#[divan::bench(args = [6, 12, 18, 32, 38], sample_count = 3, sample_size = 1)]
fn chains(bencher: divan::Bencher, links: usize) {
    let text = chain::chain(links);
    bencher.bench(|| source(divan::black_box(&text), "chain").expect("the chain is correct"));
}

/// Thousands of parameters, all of them used: the time should be linear in their number.
#[divan::bench(args = [1250, 2500, 5000], sample_count = 3, sample_size = 1)]
fn parameters(bencher: divan::Bencher, count: usize) {
    let declared: String = (0..count).map(|k| format!("param p{k} = {k};\n")).collect();
    let sum = |start: usize| {
        let end = (start + 50).min(count);
        let terms: Vec<String> = (start..end).map(|k| format!("p{k}")).collect();
        format!("let s{start} = {};\n", terms.join(" + "))
    };
    let sums: String = (0..count).step_by(50).map(sum).collect();
    let all: Vec<String> = (0..count).step_by(50).map(|k| format!("s{k}")).collect();
    let text = format!(
        "system Many {{ {declared} coord x; velocity v; rate x = v; particle mass 1 at [x, 0, 0];
        {sums} generalized force v = -x * ({}); }}",
        all.join(" + ")
    );
    bencher.bench(|| source(divan::black_box(&text), "many").expect("the description is correct"));
}

/// Robots, and whether they have a floating base.
const ROBOTS: [(&str, &str, bool); 3] = [
    ("ur5", "ur_description/urdf/ur5_robot.urdf", false),
    ("solo12", "solo_description/robots/solo12.urdf", true),
    (
        "anymal_b",
        "anymal_b_simple_description/robots/anymal.urdf",
        true,
    ),
];

/// Robots, from their URDF to formatted code of all functions; skipped if they are not installed.
#[divan::bench(args = ROBOTS.map(|(name, ..)| name), sample_count = 3, sample_size = 1)]
fn robots(bencher: divan::Bencher, robot: &str) {
    let found = ROBOTS.iter().find(|(name, ..)| *name == robot);
    let (Some(folder), Some((_, urdf, floating))) = (installed::installed(), found) else {
        return;
    };
    let text = std::fs::read_to_string(folder.join(urdf)).expect("the wheel has it");
    let options = Options {
        floating: *floating,
        ..Options::default()
    };
    bencher.bench(|| {
        let imported = import(divan::black_box(&text), &options);
        let description = imported.expect("a sound robot").text();
        source(&description, robot).expect("the description is correct")
    });
}
