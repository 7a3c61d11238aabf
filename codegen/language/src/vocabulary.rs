//! The words of the language, from the tables that the parser and the evaluator read: for references and for editors.

use crate::symbols::words;
use crate::syntax::{body_fields, joint_fields, joint_kinds, statement_forms};

/// The statements, each with the sentence that shows how it is written.
pub fn statements() -> impl Iterator<Item = (&'static str, &'static str)> {
    statement_forms()
}

/// The kinds of joints.
pub fn kinds_of_joints() -> impl Iterator<Item = &'static str> {
    joint_kinds()
}

/// What the braces of a joint can hold, each with the sentence that shows how it is written.
pub fn fields_of_joints() -> impl Iterator<Item = (&'static str, &'static str)> {
    joint_fields()
}

/// What the braces of a body can hold, each with the sentence that shows how it is written.
pub fn fields_of_bodies() -> impl Iterator<Item = (&'static str, &'static str)> {
    body_fields()
}

/// The functions that expressions can call, each with what it takes.
pub fn functions() -> impl Iterator<Item = (&'static str, String)> {
    words::names().filter_map(|name| Some((name, words::usage(name)?.into_owned())))
}
