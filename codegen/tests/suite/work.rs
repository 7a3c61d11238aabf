//! Bounded work: descriptions whose expansion would never end, and large ones with few dependencies. Work is measured
//! in nodes of the graph, which are exactly reproducible.

use crate::common::size;
use hamel_codegen::generate::{Generated, from_text};

fn derived(text: &str) -> Generated {
    match from_text(text) {
        Ok(generated) => generated,
        Err(errors) => {
            let messages: Vec<&str> = errors.iter().map(|error| error.message.as_str()).collect();
            panic!("{messages:?}\n{text}")
        }
    }
}

/// Returns a tower of `let` statements, each using the previous one, with the last one in a potential or an output.
fn tower(steps: &[String], of: &str) -> String {
    let mut text = "system Tower {\n coord a0; velocity v; rate a0 = v;\n".to_string();
    for (i, step) in steps.iter().enumerate() {
        text.push_str(&format!(" let a{} = {step};\n", i + 1));
    }
    text + &format!(
        " kinetic v^2 / 2;\n {of} a{};\n start a0 = 0.01;\n}}\n",
        steps.len()
    )
}

#[test]
fn towers_of_products_are_not_expanded() {
    let steps: Vec<String> = (0..22).map(|i| format!("a{i} * (1 + a{i})")).collect();
    for of in ["potential", "output y ="] {
        let generated = derived(&tower(&steps, of));
        let nodes = generated.program.graph.len();
        assert!(nodes < 2_000, "{of}: {nodes} nodes");
    }
}

#[test]
fn towers_of_anything_take_nodes_for_their_height() {
    let mut state = 13u64;
    let mut number = move |below: u64| {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) % below
    };
    for _ in 0..size(3, 300) {
        let height = 10 + number(20);
        let steps: Vec<String> = (0..height)
            .map(|i| match number(5) {
                0 => format!("a{i} * (1 + a{i})"),
                1 => format!("a{i} * (a0 - a{})", number(i + 1)),
                2 => format!("(a{i} + 1)^2 - a0"),
                3 => format!("sin(a{i}) * a{}", number(i + 1)),
                _ => format!("a{i} / (3 + a{}^2)", number(i + 1)),
            })
            .collect();
        let text = tower(&steps, "potential");
        let nodes = derived(&text).program.graph.len();
        assert!(
            nodes < 200 * height as usize + 2_000,
            "{nodes} nodes\n{text}"
        );
    }
}

#[test]
fn many_coordinates_take_nodes_for_their_number() {
    let chain = |n: usize| {
        let mut text = "system Chain {\n".to_string();
        for i in 0..n {
            text.push_str(&format!(
                " coord q{i}; velocity v{i}; rate q{i} = v{i}; kinetic v{i}^2 / 2;\n"
            ));
        }
        for i in 1..n {
            text.push_str(&format!(" potential (q{i} - q{})^2 / 2;\n", i - 1));
        }
        derived(&(text + "}\n")).program.graph.len()
    };
    let (some, more) = (chain(20), chain(80));
    assert!(more < 6 * some, "{some} nodes for 20, {more} for 80");
}
