//! One function for both ξ̇ and [A B], for steps with slopes: computing [A B] already needs most operations of ξ̇.

use super::function::{self, FunctionSpec, SLOPES_ARGUMENT, zero_of_shape};
use super::{Emitter, docs, names};
use hamel_program::Function;
use hamel_program::places::Time;
use hamel_program::together::{Together, together};

/// Name of the function that computes both ξ̇ and [A B].
pub const PAIR_NAME: &str = "accel_and_linearize";

/// Returns a function that computes both ξ̇ and [A B], with the index of `linearize` among the functions. `None` if one
/// of them is not generated, or if they have too little in common.
pub fn pair_spec<'a>(emitter: &'a Emitter) -> Option<(usize, FunctionSpec<'a>)> {
    let program = emitter.program;
    let Together {
        accel,
        linearize,
        outputs,
        guards,
        nodes,
    } = together(program)?;
    let [rates, slopes] = [accel, linearize].map(|index| &program.functions[index]);
    let described = Function {
        docs: vec![
            "ξ̇ of `accel` and [A B] of `linearize`, which have most of their operations in common, in one function."
                .into(),
        ],
        ..slopes.clone()
    };
    let mut lines = docs::summary_and_arguments(program, &described, &nodes);
    lines.extend([
        format!(
            "- `{SLOPES_ARGUMENT}`: {}, which are written",
            docs::result_in_words(slopes.shape)
        ),
        String::new(),
        format!("Returns {}.", docs::result_in_words(rates.shape)),
    ]);
    if slopes.fallible {
        lines.extend(docs::error_section(program, &guards, "the arguments"));
    }
    Some((
        linearize,
        FunctionSpec {
            name: PAIR_NAME.into(),
            public: true,
            docs: lines,
            arguments: &slopes.arguments,
            shape: rates.shape,
            beside: Some(slopes.shape),
            functions: vec![rates, slopes],
            outputs,
            guards,
            fallible: slopes.fallible,
            nodes,
            time: Time::Call,
        },
    ))
}

/// Prints `accel_and_linearize`, which computes ξ̇ and [A B] together, and a `linearize` that calls it.
pub fn print_pair(emitter: &Emitter, linearize: &FunctionSpec, both: &FunctionSpec) -> String {
    let given: Vec<&str> = both
        .arguments
        .iter()
        .map(|&argument| names::argument_name(argument))
        .collect();
    let question = if both.fallible { "?" } else { "" };
    let value = match both.fallible {
        true => format!("::core::result::Result::Ok({SLOPES_ARGUMENT})"),
        false => SLOPES_ARGUMENT.into(),
    };
    let body = format!(
        "let mut {SLOPES_ARGUMENT} = {};\nself.{PAIR_NAME}({}, &mut {SLOPES_ARGUMENT}){question};\n{value}\n",
        zero_of_shape(linearize.shape),
        given.join(", ")
    );
    function::print_function(emitter, both)
        + &function::wrap_in_signature(emitter.program, linearize, &body)
}
