//! A description as C, with a function that calls all functions at a few states and prints their results.

use crate::common::Random;
use hamel_codegen::algebra::graph::Function::Raised;
use hamel_codegen::algebra::numbers::{Arithmetic, Step};
use hamel_codegen::algebra::numeric::Floats;
use hamel_codegen::algebra::rounding::{RoundedValue, evaluate_rounded};
use hamel_codegen::algebra::walk::evaluate;
use hamel_codegen::builder::written_in_c;
use hamel_codegen::emit::c::Precision;
use hamel_codegen::generate::Generated;
use hamel_codegen::model::states::states;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::{Argument, Cause, Function, Program};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Number of random states, in addition to those at which the generator measures its programs.
const RANDOM_STATES: usize = 3;
/// The arguments, in the order of [`State`].
const ARGUMENTS: [Argument; 5] = [
    Argument::Coordinates,
    Argument::Velocities,
    Argument::Inputs,
    Argument::Accelerations,
    Argument::Momenta,
];
const NAMES: [&str; 5] = ["x", "xi", "u", "xi_dot", "momentum"];

/// x, ξ, u, ξ̇, p.
type State = [Vec<f64>; 5];

/// A description with the states at which it is evaluated.
pub struct Case {
    generated: Generated,
    states: Vec<State>,
    /// Factor of the default parameters.
    times: f64,
}

/// The expected result of a function: values, or an error status.
pub struct Expected {
    pub what: String,
    pub value: Result<Vec<f64>, i64>,
    /// The values with the factor of `raised` in `float`.
    pub single: Vec<f64>,
    /// The change of the values due to rounding the arguments to `float`.
    pub doubt: f64,
    /// The error of the values in `f64`, measured in doubled precision.
    pub error: f64,
    /// Whether rounding to `float` is as large as a pivot.
    pub narrow: bool,
}

impl Case {
    /// Makes a case of a description, with another name if one is given.
    pub fn new(mut generated: Generated, name: Option<&str>, times: f64) -> Self {
        if let Some(name) = name {
            generated.program.name = name.into();
        }
        let mut states = near(&generated);
        let program = &generated.program;
        let mut random = Random::new(program.nu as u64);
        for _ in 0..RANDOM_STATES {
            let x = random.configuration(&program.blocks);
            let [xi, xi_dot] = [(); 2].map(|()| random.numbers(program.n + program.n_z));
            let (u, p) = (random.numbers(program.m), random.numbers(program.n));
            states.push([x, xi, u, xi_dot, p]);
        }
        Case {
            generated,
            states,
            times,
        }
    }

    pub fn name(&self) -> &str {
        &self.generated.program.name
    }

    /// Returns header and source in one text, and the function `run_NAME` that calls them.
    pub fn text(&self, precision: Precision) -> (String, String) {
        let files = written_in_c(&self.generated, "case.eom", None, precision).expect("C");
        let (prefix, functions) = declared(&files.header);
        let program = &self.generated.program;
        assert_eq!(functions.len(), program.functions.len());
        let real = format!("{prefix}_real");
        let [mut tables, mut used, mut calls] = [(); 3].map(|()| String::new());
        for (place, name) in NAMES.iter().enumerate() {
            let length = program.length(ARGUMENTS[place]);
            let rows = self.states.iter().map(|state| {
                let mut row: Vec<String> = state[place]
                    .iter()
                    .map(|v| format!("({real}){v:?}"))
                    .collect();
                row.resize(length.max(1), format!("({real})0"));
                format!("{{{}}}", row.join(", "))
            });
            let _ = writeln!(
                tables,
                "    static const {real} all_{name}[{}][{}] = {{{}}};",
                self.states.len(),
                length.max(1),
                rows.collect::<Vec<_>>().join(", ")
            );
            let _ = writeln!(used, "    (void)all_{name};");
        }
        for (function, (returned, name)) in program.functions.iter().zip(&functions) {
            calls.push_str(&call(program, function, returned, name));
        }
        let most = program.functions.iter().map(|f| f.outputs.len()).max();
        let (count, times) = (self.states.len(), self.times);
        let text = format!(
            "void run_{prefix}(void);\nvoid run_{prefix}(void)\n{{\n{tables}    {prefix}_parameters parameters;\n    {prefix}_system of;\n    {real} start_x[{}], start_xi[{}] = {{0}}, out[{}];\n    size_t state, entry;\n    {real} *const all = ({real} *)&parameters;\n\
             {used}    {prefix}_default_parameters(&parameters);\n    for (entry = 0; entry < sizeof parameters / sizeof({real}); entry++) {{\n        all[entry] *= ({real}){times:?};\n    }}\n\
             \x20   printf(\"%d\\n\", (int){prefix}_set_parameters(&of, &parameters));\n    {prefix}_start(start_x, start_xi);\n    show(0, start_x, {});\n    show(0, start_xi, {});\n\
             \x20   for (state = 0; state < {count}; state++) {{\n{calls}    }}\n}}\n",
            program.nu.max(1),
            (program.n + program.n_z).max(1),
            most.unwrap_or(0).max(1),
            program.nu,
            program.n + program.n_z,
        );
        (format!("{}\n{}", files.header, files.rest), text)
    }

    /// Returns the call of the function that [`Self::text`] defines.
    pub fn run(&self) -> String {
        let files = written_in_c(&self.generated, "case.eom", None, Precision::Double).expect("C");
        format!("    run_{}();\n", declared(&files.header).0)
    }

    /// Returns the expected output, line by line.
    pub fn expected(&self) -> Vec<Expected> {
        let program = &self.generated.program;
        let exact = |what: &str, value: &[f64]| Expected {
            what: format!("{}: {what}", self.name()),
            value: Ok(value.to_vec()),
            single: value.to_vec(),
            doubt: 0.0,
            error: 0.0,
            narrow: false,
        };
        let mut all = vec![
            exact("status", &[]),
            exact("x at the start", &program.start_x),
            exact("xi at the start", &program.start_xi),
        ];
        let params: Vec<f64> = program.defaults.iter().map(|v| self.times * v).collect();
        let functions: Vec<Interpreter> = program
            .functions
            .iter()
            .map(|function| Interpreter::new(program, function, &params))
            .collect();
        for (number, state) in self.states.iter().enumerate() {
            for (function, interpreter) in program.functions.iter().zip(&functions) {
                let (value, doubt) = interpreted(program, function, interpreter, state);
                let what = format!("{}: {} at state {number}", self.name(), function.name);
                let numbers = numbers(program, &params, state);
                let (error, narrow) = rounding(program, function, &numbers);
                all.push(Expected {
                    what,
                    value,
                    single: single(program, function, &numbers),
                    doubt,
                    error,
                    narrow,
                });
            }
        }
        all
    }
}

/// The states at which the generator measures its programs; first-order states are random.
fn near(generated: &Generated) -> Vec<State> {
    let program = &generated.program;
    if program.n_z > 0 || program.n == 0 {
        return Vec::new();
    }
    let [_, x, xi, u, z, xi_dot, p, end] = program.symbols();
    let fits = |numbers: &Vec<f64>| numbers.len() == end;
    let state = |numbers: Vec<f64>| {
        [x..xi, xi..u, u..z, xi_dot..p, p..end].map(|range| numbers[range].to_vec())
    };
    let all = states(&generated.active).into_iter().filter(fits);
    all.map(state).collect()
}

/// Returns the prefix, and every function with its return type.
fn declared(header: &str) -> (String, Vec<(String, String)>) {
    let prefix = header.lines().find_map(|line| {
        line.strip_prefix("typedef struct ")?
            .strip_suffix("_parameters {")
    });
    let opened = header.lines().filter_map(|line| line.strip_suffix('('));
    let functions = opened.filter_map(|line| line.split_once(' '));
    (
        prefix.expect("parameters").to_string(),
        functions
            .map(|(of, name)| (of.into(), name.into()))
            .collect(),
    )
}

fn call(program: &Program, function: &Function, returned: &str, name: &str) -> String {
    let mut arguments = vec!["&of".to_string()];
    for argument in &function.arguments {
        let place = ARGUMENTS.iter().position(|known| known == argument);
        let name = NAMES[place.expect("a known argument")];
        arguments.push(match program.length(*argument) {
            0 => "NULL".into(),
            _ => format!("all_{name}[state]"),
        });
    }
    let length = function.outputs.len();
    let given = |more: &[&str]| {
        let all = arguments
            .iter()
            .map(String::as_str)
            .chain(more.iter().copied());
        all.collect::<Vec<_>>().join(", ")
    };
    let out = given(&["out"]);
    match returned {
        "void" => format!("        {name}({out});\n        show(0, out, {length});\n"),
        _ if returned.ends_with("_status") => {
            format!("        show((int){name}({out}), out, {length});\n")
        }
        _ => format!(
            "        out[0] = {name}({});\n        show(0, out, {length});\n",
            given(&[])
        ),
    }
}

/// The value of a function, and its change due to rounding the arguments to `float`.
fn interpreted(
    program: &Program,
    function: &Function,
    interpreter: &Interpreter,
    state: &State,
) -> (Result<Vec<f64>, i64>, f64) {
    let value = interpreter.call_with(state.each_ref().map(Vec::as_slice));
    let mut doubt = 0.0_f64;
    for turn in 0..3 {
        let near = state.each_ref().map(|list| -> Vec<f64> {
            let entries = list.iter().enumerate();
            let step = |i: usize| {
                if (i + turn).is_multiple_of(3) {
                    -1.0
                } else {
                    1.0
                }
            };
            entries
                .map(|(i, entry)| entry + f64::from(f32::EPSILON) * step(i))
                .collect()
        });
        let near = interpreter.call_with(near.each_ref().map(Vec::as_slice));
        doubt = match (&value, near) {
            (Ok(value), Ok(near)) => doubt.max(distance(value, &near)),
            _ => f64::INFINITY,
        };
    }
    // Statuses number the causes in order; 0 is success.
    let guards = program
        .functions
        .iter()
        .filter(|function| function.fallible);
    let guards = guards.flat_map(|function| &function.guards);
    let guards = guards.chain(&program.constant_guards);
    let causes: BTreeSet<Cause> = guards.map(|&guard| program.cause(guard)).collect();
    let status = |pivot: usize| -> i64 {
        let cause = program.cause(function.guards[pivot]);
        1 + causes.range(..cause).count() as i64
    };
    (value.map_err(status), doubt)
}

/// The values of all symbols.
fn numbers(program: &Program, params: &[f64], [x, xi, u, xi_dot, p]: &State) -> Vec<f64> {
    let (xi, z) = xi.split_at(program.n);
    let xi_dot = &xi_dot[..program.n];
    [&[std::f64::consts::PI], params, x, xi, u, z, xi_dot, p].concat()
}

/// Numbers in `f64`, with the factor of `raised` in `float`.
struct Single<'a>(Floats<'a>);

impl Arithmetic for Single<'_> {
    type Number = f64;

    fn make(&mut self, step: Step<f64>) -> Option<f64> {
        match step {
            Step::Apply(Raised, a, _) => Some(a * (1.0 + 1.0 / f64::from(1 << 15))),
            step => self.0.make(step),
        }
    }

    fn is_positive(&self, a: &f64) -> Option<bool> {
        self.0.is_positive(a)
    }
}

/// Evaluates a function with the factor of `raised` in `float`.
fn single(program: &Program, function: &Function, numbers: &[f64]) -> Vec<f64> {
    let numbers = &mut Single(Floats(numbers));
    evaluate(&program.graph, &function.outputs, numbers).expect("numbers")
}

/// The rounding error of a function at a state, and whether a pivot is lost in rounding to `float`.
fn rounding(program: &Program, function: &Function, numbers: &[f64]) -> (f64, bool) {
    let (outputs, guards) = (&function.outputs, &function.guards);
    let values = evaluate_rounded(
        &program.graph,
        &[outputs.as_slice(), guards].concat(),
        numbers,
    );
    let (outputs, guards) = values.split_at(outputs.len());
    let error = outputs
        .iter()
        .map(|value| value.rounding_error())
        .fold(0.0, f64::max);
    let digits = f64::from(f32::EPSILON) / f64::EPSILON;
    let narrow =
        |pivot: &RoundedValue| pivot.exact.to_f64().abs() <= 16.0 * digits * pivot.rounding_error();
    (error, guards.iter().any(narrow))
}

/// The largest difference of two lists; NaN differs infinitely from all other numbers.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let apart = a.iter().zip(b).map(|(a, b)| match (a - b).abs() {
        _ if a == b || a.is_nan() && b.is_nan() => 0.0,
        apart if apart.is_nan() => f64::INFINITY,
        apart => apart,
    });
    apart.fold(0.0, f64::max)
}
