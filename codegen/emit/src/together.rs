//! One function for both ξ̇ and [A B], for steps with slopes: computing [A B] already needs most operations of ξ̇.

use super::function::{self, SLOPES, Spec, zeros};
use super::{Emitter, docs, names};
use hamel_program::Function;
use hamel_program::places::Time;
use hamel_program::together::{Together, together};

/// Name of the function.
pub const NAME: &str = "accel_and_linearize";

/// Returns the index of `linearize` among the functions, and a function that computes both ξ̇ and [A B]. `None` if
/// one of them is not generated, or if they have too little in common.
pub fn of<'a>(emitter: &'a Emitter) -> Option<(usize, Spec<'a>)> {
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
            "- `{SLOPES}`: {}, which are written",
            docs::result(slopes.shape)
        ),
        String::new(),
        format!("Returns {}.", docs::result(rates.shape)),
    ]);
    if slopes.fallible {
        lines.extend(docs::errors(program, &guards, "the arguments"));
    }
    Some((
        linearize,
        Spec {
            name: NAME.into(),
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
pub fn print_pair(emitter: &Emitter, linearize: &Spec, both: &Spec) -> String {
    let given: Vec<&str> = both
        .arguments
        .iter()
        .map(|&argument| names::argument(argument))
        .collect();
    let question = if both.fallible { "?" } else { "" };
    let value = match both.fallible {
        true => format!("::core::result::Result::Ok({SLOPES})"),
        false => SLOPES.into(),
    };
    let body = format!(
        "let mut {SLOPES} = {};\nself.{NAME}({}, &mut {SLOPES}){question};\n{value}\n",
        zeros(linearize.shape),
        given.join(", ")
    );
    function::print_function(emitter, both) + &function::head(emitter.program, linearize, &body)
}
