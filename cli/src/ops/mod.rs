//! `hamel ops`: counts the operations of a call of each generated function.

mod advice;

use crate::columns;
use crate::failure::{Failure, print};
use crate::json::Json;
use crate::robot::RobotOptions;
use crate::source;
use clap::{Args, ValueEnum};
use hamel_codegen::algebra::function::Cost;
use hamel_codegen::algebra::graph::{Edge, Graph, Node};
use hamel_codegen::functions::Asked;
use hamel_codegen::generate::Generated;
use hamel_codegen::program::Program;
use hamel_codegen::program::count::{Count, count_nodes};
use hamel_codegen::program::schedule::Schedule;
use hamel_engine::Source;
use std::path::PathBuf;

/// Counts the operations of every generated function.
///
/// "shared" counts the operations of a call of the generated code; "unshared" those of the same expressions written out
/// in full, where nothing is reused and nothing is precomputed when parameters are set. flops are add + mul + div;
/// negation is free. A count that does not fit into 128 bits is written as `> 3.4e38`, and as null in JSON.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  hamel ops heavy_top.eom\n  hamel ops heavy_top.eom --format json\n  hamel ops heavy_top.eom --advise"
)]
pub struct Arguments {
    /// Description, or robot in URDF; `-` for standard input.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Output format of the counts.
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Compare ξ̇ in other velocity coordinates: rotations in body or world axes, points in either, angles absolute or
    /// relative; the cheapest first, with the statements to write.
    #[arg(long)]
    advise: bool,
    #[command(flatten)]
    robot: RobotOptions,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// Counts of add, mul, div, sqrt, sincos, other.
type Operations = [u128; 6];
/// Counts of the expressions written out; `None` if a count does not fit into 128 bits.
type Written = [Option<u128>; 6];
const KINDS: [&str; 6] = ["add", "mul", "div", "sqrt", "sincos", "other"];

/// A function with its counts.
struct Row {
    name: String,
    shared: Operations,
    unshared: Written,
}

/// Returns the counts as JSON.
pub fn counts_json(source: &Source) -> Result<String, Failure> {
    Ok(Counts::of(source)?.json())
}

/// Returns the counts of other velocity coordinates as JSON.
pub fn advice_json(source: &Source) -> Result<String, Failure> {
    let model = source.derive()?.model;
    advice::write(source, &model, true)
}

/// The counts of all functions of a description.
struct Counts {
    generated: Generated,
    rows: Vec<Row>,
    /// Operations performed when parameters are set, and the number of constants kept.
    hoisted: Operations,
    kept: usize,
}

impl Counts {
    fn of(source: &Source) -> Result<Self, Failure> {
        // Count functions that are generated only on request as well, unless functions were chosen.
        let generated = match source.model()?.asked == Asked::everything() {
            true => source.derive_counted()?,
            false => source.derive()?,
        };
        let program = &generated.program;
        let schedule = Schedule::of(program);
        Ok(Counts {
            rows: rows(program, &schedule),
            hoisted: operations(count_nodes(&program.graph, &schedule.hoisted)),
            kept: schedule.kept.len(),
            generated,
        })
    }

    fn json(&self) -> String {
        json(&self.generated.program, &self.rows, self.hoisted, self.kept).pretty()
    }
}

/// Counts and prints the operations.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source = source::open(&arguments.file, &arguments.robot)?;
    if arguments.advise {
        let model = source.derive()?.model;
        let as_json = matches!(arguments.format, Format::Json);
        return print(&advice::write(&source, &model, as_json)?);
    }
    let counts = Counts::of(&source)?;
    print(&match arguments.format {
        Format::Text => text(&counts.rows, counts.hoisted, counts.kept),
        Format::Json => counts.json(),
    })
}

/// Returns the operations of one call of each function: add, mul, div, sqrt, sincos, other.
pub fn calls(program: &Program) -> Vec<(String, Operations)> {
    let schedule = Schedule::of(program);
    let functions = program.functions.iter().zip(&schedule.bodies);
    functions
        .map(|(function, body)| {
            let counted = operations(count_nodes(&program.graph, body));
            (function.name.clone(), counted)
        })
        .collect()
}

fn rows(program: &Program, schedule: &Schedule) -> Vec<Row> {
    let functions = program.functions.iter().zip(&schedule.bodies);
    functions
        .map(|(function, body)| {
            let roots: Vec<Edge> = function
                .outputs
                .iter()
                .chain(&function.guards)
                .copied()
                .collect();
            Row {
                name: function.name.clone(),
                shared: operations(count_nodes(&program.graph, body)),
                unshared: tree(&program.graph, &roots),
            }
        })
        .collect()
}

fn operations(count: Count) -> Operations {
    [
        count.add,
        count.mul,
        count.div,
        count.sqrt,
        count.sincos,
        count.other,
    ]
    .map(|count| count as u128)
}

fn flops(operations: &Operations) -> u128 {
    operations[..3].iter().sum()
}

/// Returns the flops of expressions written out.
fn flops_written(operations: &Written) -> Option<u128> {
    operations[..3]
        .iter()
        .try_fold(0, |sum: u128, count| sum.checked_add((*count)?))
}

fn sum(a: Written, b: Written) -> Written {
    std::array::from_fn(|kind| a[kind]?.checked_add(b[kind]?))
}

/// Counts the operations of the roots as trees, each use of a node anew.
fn tree(graph: &Graph, roots: &[Edge]) -> Written {
    const NO_OPERATIONS: Written = [Some(0); 6];
    let mut costs = vec![NO_OPERATIONS; graph.len()];
    for id in graph.reachable(roots) {
        let mut cost = graph
            .node(id)
            .children()
            .fold(NO_OPERATIONS, |cost, child| {
                sum(cost, costs[child.node() as usize])
            });
        let kind = match graph.node(id) {
            Node::Constant(_) | Node::Symbol(_) | Node::Listed(..) => None,
            Node::Add(..) | Node::Select(..) => Some(0),
            Node::Mul(..) => Some(1),
            Node::Div(..) => Some(2),
            Node::Apply(function, _) => Some(match function.row().cost {
                Cost::Comparison => 0,
                Cost::Product => 1,
                Cost::Quotient => 2,
                Cost::Root => 3,
                Cost::SineOrCosine => 4,
                Cost::Other => 5,
            }),
            Node::Atan2(..) | Node::External(..) => Some(5),
        };
        if let Some(kind) = kind {
            cost[kind] = cost[kind].and_then(|count| count.checked_add(1));
        }
        costs[id as usize] = cost;
    }
    roots.iter().fold(NO_OPERATIONS, |cost, root| {
        sum(cost, costs[root.node() as usize])
    })
}

/// Formats a count in few characters: `123456`, `1.2e9`, `> 3.4e38`.
fn compact(count: Option<u128>) -> String {
    match count {
        Some(count) if count < 10_000_000 => count.to_string(),
        Some(count) => format!("{:.1e}", count as f64),
        None => format!("> {:.1e}", u128::MAX as f64),
    }
}

fn text(rows: &[Row], hoisted: Operations, kept: usize) -> String {
    let heading = std::iter::once("function")
        .chain(KINDS)
        .chain(["flops", "unshared"]);
    let mut lines: Vec<Vec<String>> = vec![heading.map(String::from).collect()];
    for row in rows {
        let mut line = vec![row.name.clone()];
        line.extend(row.shared.iter().map(u128::to_string));
        line.push(flops(&row.shared).to_string());
        line.push(compact(flops_written(&row.unshared)));
        lines.push(line);
    }
    let mut text = columns::headed(&lines);
    let operations: u128 = hoisted.iter().sum();
    text.push_str(&match (operations, kept) {
        (0, _) => "nothing to be computed when parameters are set\n".to_string(),
        (1, _) => "1 operation is done when parameters are set\n".to_string(),
        (_, 1) => format!(
            "{operations} operations are done when parameters are set, 1 constant is kept\n"
        ),
        _ => format!(
            "{operations} operations are done when parameters are set, {kept} constants are kept\n"
        ),
    });
    text
}

fn json(program: &Program, rows: &[Row], hoisted: Operations, kept: usize) -> Json {
    let number = |count: Option<u128>| count.map_or(Json::Null, Json::Count);
    let written = |operations: Written| {
        let members = KINDS.into_iter().zip(operations.map(number));
        let flops = ("flops", number(flops_written(&operations)));
        Json::object(members.chain([flops]))
    };
    let counts = |operations: &Operations| written(operations.map(Some));
    let functions = rows.iter().map(|row| {
        let members = [
            ("shared", counts(&row.shared)),
            ("unshared", written(row.unshared)),
        ];
        (row.name.as_str(), Json::object(members))
    });
    Json::object([
        ("system", Json::Text(program.name.clone())),
        ("functions", Json::object(functions)),
        (
            "parameters",
            Json::object([
                ("hoisted", counts(&hoisted)),
                ("kept", Json::Count(kept as u128)),
            ]),
        ),
    ])
}

#[cfg(test)]
mod tests {
    use super::{Row, text};

    #[test]
    fn counts_of_any_width_stand_apart() {
        let row = |name: &str, count: u128, unshared| Row {
            name: name.into(),
            shared: [count; 6],
            unshared: [unshared; 6],
        };
        let rows = [
            row("accel", 1_074_233_000, Some(u128::MAX / 4)),
            row("rate", 7, None),
        ];
        let table = text(&rows, [0; 6], 0);
        for line in table.lines().take(3) {
            let cells = line.split("  ").filter(|cell| !cell.is_empty());
            assert_eq!(cells.count(), 9, "{table}");
        }
        assert!(
            table.contains("  2.6e38\n") && table.contains("  > 3.4e38\n"),
            "{table}"
        );
    }
}
