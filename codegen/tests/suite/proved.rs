//! Every emitted function is proved: a wrong sign in an entry of any function of any model is refused.

use crate::models::{asked_for, models};
use crate::thinning::thin_out;
use hamel_codegen::algebra::graph::Edge;
use hamel_codegen::derive::reduction::reduce;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Program;
use hamel_codegen::proof::prove;
use rayon::prelude::*;
use std::path::Path;

/// The largest request that a model may support, then smaller ones.
const REQUESTS: [&str; 3] = [
    "all, linearize, inverse_dynamics_slopes, parameter_slopes, centre_of_mass, centroidal_momentum, centroidal_map, centroidal_bias",
    "all, linearize",
    "all",
];

/// Returns the functions of a model in which a wrong sign goes unnoticed, and the number of trials.
fn unnoticed(generated: &Generated) -> (Vec<String>, usize) {
    let (model, program) = (&generated.model, &generated.program);
    let reduction = reduce(model).expect("it was derived");
    let proved = |program: &Program| prove(model, reduction.as_ref(), None, [program; 2]).is_ok();
    assert!(proved(program), "{}", model.name);
    let (mut found, mut tried) = (Vec::new(), 0);
    for (index, function) in program.functions.iter().enumerate() {
        let varies = |edge: &Edge| program.graph.class(edge.node()) != 0;
        let outputs = &function.outputs;
        let first = outputs.iter().position(varies);
        let last = outputs.iter().rposition(varies);
        let constant = || {
            outputs
                .iter()
                .position(|&edge| edge != program.graph.zero())
        };
        let mut places = vec![first.or_else(constant), last];
        places.dedup();
        for place in places.into_iter().flatten() {
            let mut wrong = program.clone();
            let entry = &mut wrong.functions[index].outputs[place];
            *entry = -*entry;
            tried += 1;
            if proved(&wrong) {
                found.push(format!("{}[{place}]", function.name));
            }
        }
    }
    (found, tried)
}

#[test]
fn a_wrong_sign_in_any_function_is_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/models");
    // Each model is changed in more than thirty places: every ninth model, or all with `HAMEL_ATTACK`.
    let all: Vec<(String, Vec<String>, usize)> = (thin_out(thin_out(models(&folder))).par_iter())
        .map(|path| {
            let name = path.display().to_string();
            let mut asked = REQUESTS.iter().map(|asked| asked_for(path, asked));
            let generated = asked.find_map(Result::ok);
            let (found, tried) = unnoticed(&generated.unwrap_or_else(|| panic!("{name}")));
            (name, found, tried)
        })
        .collect();
    let holes: Vec<_> = all
        .iter()
        .filter(|(_, found, _)| !found.is_empty())
        .collect();
    assert!(holes.is_empty(), "{holes:#?}");
    let tried: usize = all.iter().map(|(_, _, tried)| tried).sum();
    assert!(tried > 30 * all.len(), "{tried} of {}", all.len());
}
