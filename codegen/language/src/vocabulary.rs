//! The words of the language, for references and editors, read from the tables that the parser and the evaluator use.

use crate::symbols::words;
use crate::syntax::{body_fields, joint_fields, joint_kinds, statement_forms};

/// Returns the statements, each with a sentence that shows its syntax.
pub fn statements() -> impl Iterator<Item = (&'static str, &'static str)> {
    statement_forms()
}

/// Returns the names of the joint kinds.
pub fn kinds_of_joints() -> impl Iterator<Item = &'static str> {
    joint_kinds()
}

/// Returns the fields allowed in the braces of a joint, each with a sentence that shows its syntax.
pub fn fields_of_joints() -> impl Iterator<Item = (&'static str, &'static str)> {
    joint_fields()
}

/// Returns the fields allowed in the braces of a body, each with a sentence that shows its syntax.
pub fn fields_of_bodies() -> impl Iterator<Item = (&'static str, &'static str)> {
    body_fields()
}

/// Returns whether a name is that of a function or constant that descriptions cannot redefine.
pub fn is_reserved(name: &str) -> bool {
    words::reserved()
        .chain(words::FUNCTIONS)
        .any(|word| word == name)
}

/// Returns the functions that expressions can call, each with a description of its arguments.
pub fn functions() -> impl Iterator<Item = (&'static str, String)> {
    words::names().filter_map(|name| Some((name, words::usage(name)?.into_owned())))
}
