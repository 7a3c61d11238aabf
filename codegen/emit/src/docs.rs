//! Doc comments of the generated code.

use super::names;
use hamel_algebra::graph::{Edge, NodeId};
use hamel_language::model::layout::Block;
use hamel_language::model::{Coordinate, Group};
use hamel_language::syntax::ast::{CoordKind, ShapeKind};
use hamel_program::count::{Count, count_nodes};
use hamel_program::{Argument, Cause, Function, Program, Shape};

/// Width at which lists of names are wrapped.
const WIDTH: usize = 90;

/// Prints lines as a doc comment.
pub fn comment(lines: &[String]) -> String {
    let mut text = String::new();
    for line in lines.iter().flat_map(|line| line.split(['\n', '\r'])) {
        let line = line.trim_end();
        let space = if line.is_empty() || line.starts_with(' ') {
            ""
        } else {
            " "
        };
        text.push_str(&format!("///{space}{}\n", spelled(line)));
    }
    text
}

/// Escapes characters of a comment line that change the direction of writing, which rustc rejects.
pub fn spelled(line: &str) -> String {
    let turns = |letter| matches!(letter, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let mut text = String::with_capacity(line.len());
    for letter in line.chars() {
        match turns(letter) {
            true => text.extend(letter.escape_unicode()),
            false => text.push(letter),
        }
    }
    text
}

/// Prints operation counts, as in "Operations: 66 mul, 54 add; parameters hoisted."
pub fn operations(count: Count, end: &str) -> String {
    let counts = [
        (count.mul, "mul"),
        (count.add, "add"),
        (count.div, "div"),
        (count.sqrt, "sqrt"),
        (count.sincos, "sincos"),
        (count.other, "other functions"),
    ];
    let nonzero = counts.iter().filter(|(number, _)| *number > 0);
    let list: Vec<String> = nonzero
        .map(|(number, name)| format!("{number} {name}"))
        .collect();
    if list.is_empty() {
        "No operations.".into()
    } else {
        format!("Operations: {}{end}.", list.join(", "))
    }
}

/// Returns the Rust documentation of a function: what it evaluates, its cost, arguments, result and errors.
pub fn function(program: &Program, function: &Function, nodes: &[NodeId]) -> Vec<String> {
    let mut lines = described(program, function, nodes);
    let result = result(function.shape);
    lines.extend([String::new(), format!("Returns {result}.")]);
    if function.fallible {
        lines.extend(errors(program, &function.guards, "the arguments"));
    }
    lines
}

/// Returns the section on errors of a function with these guards. `depends` completes "no pivot depends on".
pub fn errors(program: &Program, guards: &[Edge], depends: &str) -> [String; 3] {
    let text = match singular(program, guards) {
        Some(why) => format!("`Singular` where {why}."),
        None => format!("None: no pivot depends on {depends}."),
    };
    [String::new(), "# Errors".into(), text]
}

/// Returns the conditions under which one of the guards is not positive; `None` if there is none.
pub fn singular(program: &Program, guards: &[Edge]) -> Option<String> {
    let causes: Vec<Cause> = guards.iter().map(|&guard| program.cause(guard)).collect();
    let has = |of: fn(&Cause) -> bool| causes.iter().any(of);
    let reasons = [
        (
            has(|cause| matches!(cause, Cause::Velocity(_) | Cause::Mass)),
            "the mass matrix is not positive definite",
        ),
        (
            has(|cause| matches!(cause, Cause::Constraint(_))),
            "constraints depend on one another",
        ),
        (
            has(|cause| matches!(cause, Cause::Kinematics(_))),
            "the mechanism is at a kinematic singularity, where a pivot of [Y; Φ] changes its sign",
        ),
    ];
    let reasons = reasons.iter().filter(|(holds, _)| *holds);
    let reasons: Vec<&str> = reasons.map(|&(_, reason)| reason).collect();
    (!reasons.is_empty()).then(|| reasons.join(", or "))
}

/// Returns the lines of a description, indented, below a blank line; none for an empty text.
pub fn description(text: &str) -> Vec<String> {
    if text.is_empty() {
        return Vec::new();
    }
    let lines = text.trim_end().lines();
    let lines = lines.map(|line| format!("    {}", spelled(line.trim_end())));
    std::iter::once(String::new()).chain(lines).collect()
}

/// Returns the description of a function, its cost and its arguments.
pub fn described(program: &Program, function: &Function, nodes: &[NodeId]) -> Vec<String> {
    let mut lines = function.docs.clone();
    if lines.is_empty() {
        lines.push(format!("`{}`.", function.name));
    }
    let count = count_nodes(&program.graph, nodes);
    let hoisted = if program.params.is_empty() {
        ""
    } else {
        "; parameters hoisted"
    };
    lines.extend([String::new(), operations(count, hoisted)]);
    if !function.arguments.is_empty() {
        lines.push(String::new());
    }
    for &argument in &function.arguments {
        let prefix = match argument {
            Argument::Accelerations => "derivatives of ",
            Argument::Momenta => "momenta dual to ",
            _ => "",
        };
        let size = numbers(program.length(argument));
        lines.push(format!(
            "- `{}`: {size}, {prefix}`[{}]`",
            names::argument(argument),
            groups(program, argument).join(", ")
        ));
    }
    lines
}

/// Returns a result's shape in words.
pub fn result(shape: Shape) -> String {
    match shape {
        Shape::Scalar => "a number".into(),
        Shape::Vector(n) => numbers(n),
        Shape::Matrix(1, columns) => format!("1 row of {}", numbers(columns)),
        Shape::Matrix(rows, columns) => format!("{rows} rows of {}", numbers(columns)),
    }
}

fn numbers(n: usize) -> String {
    if n == 1 {
        "1 number".into()
    } else {
        format!("{n} numbers")
    }
}

/// Returns the names of which an argument consists; those of a vector as a range.
pub fn groups(program: &Program, argument: Argument) -> Vec<String> {
    match argument {
        Argument::Coordinates => program.coordinates.iter().flat_map(coordinate).collect(),
        Argument::Velocities | Argument::Accelerations => {
            let groups = program.velocities.iter().chain(&program.states);
            groups.map(group).collect()
        }
        Argument::Momenta => program.velocities.iter().map(group).collect(),
        Argument::Inputs => program.inputs.iter().map(group).collect(),
    }
}

fn coordinate(coordinate: &Coordinate) -> Vec<String> {
    let name = &coordinate.name;
    match coordinate.kind {
        CoordKind::Real => vec![name.clone()],
        CoordKind::Euclidean(n) => vec![vector(name, n)],
        CoordKind::S1 => vec![format!("{name}.c"), format!("{name}.s")],
        CoordKind::S3 => vec![vector(name, 4)],
        CoordKind::SO3 => vec![matrix(name, 3)],
        CoordKind::SE3 => vec![
            vector(&format!("{name}.p"), 3),
            matrix(&format!("{name}.R"), 3),
        ],
    }
}

fn group(group: &Group) -> String {
    match group.shape {
        ShapeKind::Scalar => group.name.clone(),
        ShapeKind::Vector(n) => vector(&group.name, n),
        ShapeKind::Matrix(n) | ShapeKind::Symmetric(n) => matrix(&group.name, n),
    }
}

fn vector(name: &str, n: usize) -> String {
    if n == 1 {
        format!("{name}[1]")
    } else {
        format!("{name}[1..{n}]")
    }
}

fn matrix(name: &str, n: usize) -> String {
    format!("{name}[1..{n}, 1..{n}]")
}

/// Returns a shape in words, as it is declared in a description.
pub fn shape(shape: ShapeKind) -> String {
    match shape {
        ShapeKind::Scalar => "a number".into(),
        ShapeKind::Vector(n) => format!("a vector of {n}"),
        ShapeKind::Matrix(n) => format!("a {n}×{n} matrix by rows"),
        ShapeKind::Symmetric(n) => format!("a symmetric {n}×{n} matrix by rows"),
    }
}

/// Returns the size constants: name, documentation, number of the first symbol, and size.
pub fn sizes(program: &Program) -> Vec<(&'static str, &'static str, usize, usize)> {
    let [_, x, xi, u, z, ..] = program.symbols();
    let states =
        "The number of states of first order z, which stand behind the velocities: `xi` is (ξ, z).";
    let mut sizes = vec![
        (
            "COORDINATES",
            "ν, the number of coordinates x.",
            x,
            program.nu,
        ),
        (
            "VELOCITIES",
            "n, the number of velocities ξ.",
            xi,
            program.n,
        ),
        ("STATES", states, z, program.n_z),
        ("INPUTS", "The number of inputs u.", u, program.m),
    ];
    sizes.retain(|(name, .., size)| *name != "STATES" || *size > 0);
    sizes
}

/// Returns `what` followed by the names of the entries, in wrapped lines; `first` is the number of the first symbol.
pub fn entries(program: &Program, what: &str, first: usize, length: usize) -> Vec<String> {
    let symbols = program.graph.symbols().iter().skip(first).take(length);
    let mut lines = vec![what.to_string()];
    let names: Vec<String> = symbols.map(|symbol| format!("`{}`", symbol.name)).collect();
    if names.is_empty() {
        return lines;
    }
    lines.push(String::new());
    let mut line = "In order:".to_string();
    for (index, name) in names.iter().enumerate() {
        if line.chars().count() + name.chars().count() > WIDTH {
            lines.push(std::mem::take(&mut line));
        }
        let space = if line.is_empty() { "" } else { " " };
        let end = if index + 1 == names.len() { "." } else { "," };
        line.push_str(&format!("{space}{name}{end}"));
    }
    lines.push(line);
    lines
}

/// Returns a block of x as a Rust expression.
pub fn block(block: Block) -> String {
    match block {
        Block::Flat(n) => format!("::hamel::Block::Flat({n})"),
        Block::Circle => "::hamel::Block::Circle".into(),
        Block::Quaternion => "::hamel::Block::Quaternion".into(),
        Block::Rotation => "::hamel::Block::Rotation".into(),
    }
}
