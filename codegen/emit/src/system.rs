//! `impl hamel::System` and `impl hamel::Energies`, each if all functions that it needs are generated.

use super::methods::impl_header;
use super::{Emitter, docs, names, number};
use hamel_program::{Argument, Shape};

const X: Argument = Argument::Coordinates;
const XI: Argument = Argument::Velocities;
const U: Argument = Argument::Inputs;

/// A method that evaluates a function: name of the function, arguments, and result type.
type Method = (&'static str, &'static [Argument], &'static str);

/// Methods of `System` that evaluate functions.
const SYSTEM: &[Method] = &[
    ("rate", &[X, XI], "Self::Coordinates"),
    ("chart_rate", &[X, XI], "Self::Chart"),
    (
        "accel",
        &[X, XI, U],
        "::core::result::Result<Self::Velocities, ::hamel::Singular>",
    ),
    ("correction", &[X], "Self::Coordinates"),
    ("constraint", &[X], "S"),
];

/// Methods of `Energies`.
const ENERGIES: &[Method] = &[
    ("kinetic_energy", &[X, XI], "S"),
    ("potential_energy", &[X], "S"),
];

/// Prints the implementations of `System` and `Energies`; empty if a function of `System` is missing.
pub fn system_implementations(emitter: &Emitter) -> String {
    let Some(motion) = methods(emitter, SYSTEM) else {
        return String::new();
    };
    let energies = methods(emitter, ENERGIES)
        .map(|methods| format!("\n{} {{\n{methods}}}\n", impl_header(emitter, "Energies")));
    system(emitter, motion) + &energies.unwrap_or_default()
}

/// Whether the type implements `Energies`, if it implements `System`.
pub fn has_energies(emitter: &Emitter) -> bool {
    methods(emitter, ENERGIES).is_some()
}

/// Prints the methods of a trait; `None` if a function is missing.
fn methods(emitter: &Emitter, rows: &[Method]) -> Option<String> {
    rows.iter().map(|row| method(emitter, row)).collect()
}

fn system(emitter: &Emitter, mut methods: String) -> String {
    let program = emitter.program;
    if let Some(place) = program.clock {
        methods.push_str(&format!(
            "fn clock(&self) -> ::core::option::Option<usize> {{\n::core::option::Option::Some({place})\n}}\n\n"
        ));
    }
    if program.embedded {
        methods.push_str(
            "fn project_coordinates(&self, x: &Self::Coordinates) -> ::core::option::Option<Self::Coordinates> {\n::core::option::Option::Some(::hamel::System::correction(self, x))\n}\n\n",
        );
    }
    for name in ["project_position", "project_velocity"] {
        methods.push_str(&projection(emitter, name));
    }
    let chart: usize = program.blocks.iter().map(|block| block.dimension()).sum();
    let sizes = [
        ("Coordinates", program.nu),
        ("Velocities", program.n + program.n_z),
        ("Chart", chart),
        ("Inputs", program.m),
    ];
    let types: String = sizes
        .iter()
        .map(|(name, n)| format!("type {name} = [S; {n}];\n"))
        .collect();
    let blocks: Vec<String> = program
        .blocks
        .iter()
        .map(|&block| docs::block_expression(block))
        .collect();
    let [x, xi] = [&program.start_x, &program.start_xi].map(|start| {
        let entries: Vec<String> = start
            .iter()
            .map(|&value| number::scalar_expression(value))
            .collect();
        entries.join(", ")
    });
    format!(
        "{} {{\ntype Scalar = S;\n{types}\nfn blocks(&self) -> &[::hamel::Block] {{\n&[{}]\n}}\n\nfn start(&self) -> (Self::Coordinates, Self::Velocities) {{\n([{x}], [{xi}])\n}}\n\n{methods}}}\n",
        impl_header(emitter, "System"),
        blocks.join(", ")
    )
}

/// Prints one method, which calls the generated function.
fn method(emitter: &Emitter, row: &Method) -> Option<String> {
    let &(name, arguments, result) = row;
    let index = emitter
        .program
        .functions
        .iter()
        .position(|function| function.name == name)?;
    let function = &emitter.program.functions[index];
    let generated = &emitter.names.functions[index];
    if !function
        .arguments
        .iter()
        .all(|argument| arguments.contains(argument))
    {
        return None;
    }
    let given = arguments.iter().map(|argument| {
        let used = function.arguments.contains(argument);
        let name = if used {
            names::argument_name(*argument)
        } else {
            "_"
        };
        let of = match argument {
            Argument::Coordinates => "Coordinates",
            Argument::Inputs => "Inputs",
            _ => "Velocities",
        };
        format!("{name}: &Self::{of}")
    });
    let signature = given.collect::<Vec<_>>().join(", ");
    let values: Vec<&str> = function
        .arguments
        .iter()
        .map(|&argument| names::argument_name(argument))
        .collect();
    let call = format!("self.{generated}({})", values.join(", "));
    if name != "accel" && function.fallible
        || name == "constraint" && function.shape == Shape::Scalar
    {
        return None;
    }
    Some(match name {
        "accel" if !function.fallible => {
            format!("fn forward_dynamics(&self, {signature}) -> {result} {{\nOk({call})\n}}\n\n")
        }
        "accel" => {
            format!("fn forward_dynamics(&self, {signature}) -> {result} {{\n{call}\n}}\n\n")
        }
        "constraint" => format!(
            "fn constraint_norm(&self, {signature}) -> {result} {{\nlet mut norm = S::default();\nfor value in {call} {{\nnorm = norm.max(value.abs());\n}}\nnorm\n}}\n\n"
        ),
        _ => format!("fn {name}(&self, {signature}) -> {result} {{\n{call}\n}}\n\n"),
    })
}

/// Prints a projection onto the constraints that are enforced by multipliers; empty if it is not generated.
fn projection(emitter: &Emitter, name: &str) -> String {
    let Some(index) = emitter
        .program
        .functions
        .iter()
        .position(|f| f.name == name)
    else {
        return String::new();
    };
    let generated = &emitter.names.functions[index];
    let (signature, values) = match name {
        "project_position" => ("x: &Self::Coordinates", "x"),
        _ => ("x: &Self::Coordinates, xi: &Self::Velocities", "x, xi"),
    };
    format!(
        "fn {name}(&self, {signature}) -> ::core::result::Result<::core::option::Option<Self::Velocities>, ::hamel::Singular> {{\nself.{generated}({values}).map(Some)\n}}\n\n"
    )
}
