//! The lists of the reference that are derived from the code: the functions of expressions, the functions that can be
//! generated, and the options of the command line.

use std::fmt::Write;

use clap::{Arg, Command};
use hamel_codegen::functions::{Argument, FunctionId, Row, Serves};
use hamel_codegen::vocabulary::functions;

/// Lists the functions of expressions.
pub fn expressions() -> String {
    let mut table = String::from("| function | takes |\n|---|---|\n");
    for (name, usage) in functions() {
        let _ = writeln!(table, "| `{name}` | {} |", cell(&usage));
    }
    table
}

/// Lists the functions that `generate` can name, and those generated with them.
pub fn generated() -> String {
    let named = FunctionId::ALL
        .iter()
        .map(|id| id.row())
        .filter(|row| row.named);
    let others = FunctionId::ALL
        .iter()
        .map(|id| id.row())
        .filter(|row| !row.named);
    let mut text = String::from(
        "| function | arguments | what it is | part of `generate all` |\n|---|---|---|---|\n",
    );
    for row in named {
        let asked = matches!(row.serves, Serves::Asked | Serves::Split | Serves::Tangent);
        let _ = writeln!(
            text,
            "| {} | {} |",
            function(row),
            if asked { "no" } else { "yes" }
        );
    }
    text += "\nThese have no name in `generate`. They are there where something that is asked for calls them:\n\n";
    text += "| function | arguments | what it is |\n|---|---|---|\n";
    for row in others {
        let _ = writeln!(text, "| {} |", function(row));
    }
    text
}

fn function(row: &Row) -> String {
    let arguments: Vec<&str> = row
        .arguments
        .iter()
        .map(|argument| symbol(*argument))
        .collect();
    format!(
        "`{}` | {} | {}",
        row.name,
        arguments.join(", "),
        cell(row.docs.join(" ").trim_end_matches(':'))
    )
}

fn symbol(argument: Argument) -> &'static str {
    match argument {
        Argument::Coordinates => "x",
        Argument::Velocities => "ξ",
        Argument::Accelerations => "ξ̇",
        Argument::Momenta => "p",
        Argument::Inputs => "u",
    }
}

/// Lists every subcommand with its arguments and options.
pub fn options() -> String {
    let mut text = String::new();
    for command in subcommands() {
        let _ = writeln!(text, "## `hamel {}`\n", command.get_name());
        let about = command.get_long_about().or(command.get_about());
        let about = about.map(ToString::to_string).unwrap_or_default();
        let _ = writeln!(text, "{}\n", about.trim());
        text += "| argument | meaning | default |\n|---|---|---|\n";
        for argument in arguments(&command) {
            let (spelling, help) = (spelling(argument), help(argument));
            let default: Vec<String> = argument
                .get_default_values()
                .iter()
                .map(|value| format!("`{}`", value.to_string_lossy()))
                .collect();
            let _ = writeln!(
                text,
                "| `{}` | {} | {} |",
                cell(&spelling),
                cell(&help),
                default.join(", ")
            );
        }
        if let Some(more) = command.get_after_long_help().or(command.get_after_help()) {
            let _ = write!(text, "\n```text\n{}\n```\n", more.to_string().trim());
        }
        text.push('\n');
    }
    text
}

/// Returns the subcommands, complete with the options that they share.
pub fn subcommands() -> Vec<Command> {
    let mut line = hamel_cli::described();
    line.build();
    line.get_subcommands()
        .filter(|command| command.get_name() != "help")
        .cloned()
        .collect()
}

/// Returns the arguments and options of a subcommand, except for help.
pub fn arguments(command: &Command) -> impl Iterator<Item = &Arg> {
    command
        .get_arguments()
        .filter(|argument| !argument.is_hide_set() && argument.get_id() != "help")
}

/// Returns the syntax of an argument.
pub fn spelling(argument: &Arg) -> String {
    let takes = argument.get_action().takes_values();
    let names = argument.get_value_names().unwrap_or_default();
    let value = names
        .iter()
        .map(|name| name.as_str())
        .collect::<Vec<_>>()
        .join(" ");
    match (argument.get_long(), argument.get_short()) {
        (None, None) => value,
        (Some(long), _) if !takes => format!("--{long}"),
        (Some(long), Some(short)) => format!("-{short}, --{long} {value}"),
        (Some(long), None) => format!("--{long} {value}"),
        (None, Some(short)) => format!("-{short} {value}"),
    }
}

/// Returns the purpose of an argument and its possible values.
pub fn help(argument: &Arg) -> String {
    let help = argument.get_long_help().or(argument.get_help());
    let mut help = help.map(ToString::to_string).unwrap_or_default();
    let values = argument.get_possible_values();
    let values: Vec<String> = values
        .iter()
        .filter(|value| !value.is_hide_set())
        .map(|value| format!("`{}`", value.get_name()))
        .collect();
    if !values.is_empty() && argument.get_action().takes_values() {
        let _ = write!(help, " One of {}.", values.join(", "));
    }
    help
}

/// Formats a text for a cell of a table.
pub fn cell(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    line.replace('|', "\\|")
}
