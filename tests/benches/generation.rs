//! Time from a description's text to formatted code.

use hamel_codegen::builder::source;

fn main() {
    divan::main();
}

#[divan::bench(args = ["free_body", "heavy_top", "cart_pole", "double_pendulum_angles"])]
fn parse_to_formatted_code(bencher: divan::Bencher, name: &str) {
    let path = format!("{}/models/{name}.eom", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the model is in the repository");
    bencher.bench(|| source(divan::black_box(&text), name).expect("the model is correct"));
}
