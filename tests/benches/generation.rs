//! Time from a description's text to formatted code, all checks included.

use hamel_codegen::builder::source;

#[path = "../src/chain.rs"]
mod chain;

fn main() {
    divan::main();
}

#[divan::bench(args = ["free_body", "heavy_top", "cart_pole", "double_pendulum_angles"])]
fn parse_to_formatted_code(bencher: divan::Bencher, name: &str) {
    let path = format!("{}/models/{name}.eom", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the model is in the repository");
    bencher.bench(|| source(divan::black_box(&text), name).expect("the model is correct"));
}

/// Spatial chains, every parameter a run-time one: forward dynamics and rates.
#[divan::bench(args = [6, 12, 18, 32, 38], sample_count = 3, sample_size = 1)]
fn chains(bencher: divan::Bencher, links: usize) {
    let text = chain::chain(links);
    bencher.bench(|| source(divan::black_box(&text), "chain").expect("the chain is correct"));
}
