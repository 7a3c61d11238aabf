//! ξ̇ and [A B] by one function, for steps with slopes: [A B] contains nearly all that ξ̇ is made from.

use super::function::{self, SLOPES, Spec, zeros};
use super::{Emitter, docs, names};
use crate::algebra::graph::Edge;
use crate::program::count::count_nodes;
use crate::program::places::Time;
use crate::program::schedule::body;
use crate::program::{Function, FunctionId};

/// What the function is called.
pub const NAME: &str = "accel_and_linearize";

/// [A B] is not computed apart where ξ̇ beside it takes at most one in so many of its operations.
const LITTLE: usize = 100;

/// The place of `linearize` among the functions, and ξ̇ with [A B] in a tuple; nothing where one of them was not
/// generated, or where too little is common to both.
pub fn of<'a>(emitter: &'a Emitter) -> Option<(usize, Spec<'a>)> {
    let program = emitter.program;
    let place = |id: FunctionId| program.functions.iter().position(|f| f.id == Some(id));
    let (accel, linearize) = (place(FunctionId::Accel)?, place(FunctionId::Linearize)?);
    let [rates, slopes] = [accel, linearize].map(|index| &program.functions[index]);
    if rates.arguments != slopes.arguments || rates.fallible != slopes.fallible {
        return None;
    }
    let mut guards = slopes.guards.clone();
    guards.extend(
        rates
            .guards
            .iter()
            .filter(|&guard| !slopes.guards.contains(guard)),
    );
    let roots = |lists: &[&[Edge]]| body(&program.graph, &lists.concat());
    let nodes = roots(&[&rates.outputs, &slopes.outputs, &guards]);
    let alone = roots(&[&slopes.outputs, &slopes.guards]);
    let [both, alone] = [&nodes, &alone].map(|nodes| count_nodes(&program.graph, nodes).weight());
    if (both - alone) * LITTLE > alone {
        return None;
    }
    let described = Function {
        docs: vec![
            "ξ̇ of `accel` and [A B] of `linearize`, which have most of their operations in common, in one function."
                .into(),
        ],
        ..slopes.clone()
    };
    let mut lines = docs::described(program, &described, &nodes);
    lines.extend([
        format!(
            "- `{SLOPES}`: {}, which are written",
            docs::result(slopes.shape)
        ),
        String::new(),
        format!("Returns {}.", docs::result(rates.shape)),
    ]);
    if slopes.fallible {
        lines.extend(docs::errors(program, slopes));
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
            outputs: [&rates.outputs[..], &slopes.outputs].concat(),
            guards,
            fallible: slopes.fallible,
            nodes,
            time: Time::Call,
        },
    ))
}

/// The function, and after it `linearize` by it.
pub fn text(emitter: &Emitter, linearize: &Spec, both: &Spec) -> String {
    let given: Vec<&str> = both
        .arguments
        .iter()
        .map(|&argument| names::argument(argument))
        .collect();
    let question = if both.fallible { "?" } else { "" };
    let value = match both.fallible {
        true => format!("Ok({SLOPES})"),
        false => SLOPES.into(),
    };
    let body = format!(
        "let mut {SLOPES} = {};\nself.{NAME}({}, &mut {SLOPES}){question};\n{value}\n",
        zeros(linearize.shape),
        given.join(", ")
    );
    function::text(emitter, both) + &function::head(emitter.program, linearize, |_| true, &body)
}
