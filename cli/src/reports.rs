//! Reports of the commands for other front ends: identities, costs, generated code, tables, comparisons.

use crate::check::{self, CheckedIdentity};
use crate::compare::{self, Comparison};
use crate::failure::Failure;
use crate::ops;
use crate::tables::{Format, written};
use hamel_codegen::builder;
use hamel_codegen::emit::c::{CFiles, Precision};
use hamel_engine::{Error, Session, State, method};

/// Returns the results of `hamel check`: the identities with their verdicts, and the lines below them.
pub fn check(session: &Session) -> (Vec<CheckedIdentity>, String) {
    let remarks = check::remarks(session.generated(), session.source().shown());
    (check::check_identities(session.generated()), remarks)
}

/// Returns the output of `hamel ops --format json`.
///
/// # Errors
/// Errors of the derivation.
pub fn operations(session: &Session) -> Result<String, Failure> {
    ops::counts_json(session.source())
}

/// Returns the output of `hamel ops --advise --format json`.
///
/// # Errors
/// If there are no velocities to compare.
pub fn advice(session: &Session) -> Result<String, Failure> {
    ops::advice_json(session.source())
}

/// Returns the generated Rust, as for a description in a file of this name.
///
/// # Errors
/// Errors of the derivation or of the generated code.
pub fn rust(session: &Session, name: &str) -> Result<String, Error> {
    let generated = session.source().derive()?;
    builder::written(&generated, name).map_err(|errors| session.source().description_error(&errors))
}

/// Returns the generated C99, as for a description in a file of this name.
///
/// # Errors
/// Errors of the derivation or of the generated code.
pub fn c(session: &Session, name: &str, stem: &str) -> Result<CFiles, Error> {
    let generated = session.source().derive()?;
    builder::written_in_c(&generated, name, Some(stem), Precision::default())
        .map_err(|errors| session.source().description_error(&errors))
}

/// Tables by name, the most important ones if none is named; with `all`, every entry.
///
/// # Errors
/// If a table is unknown, or does not exist.
pub fn tables(
    session: &Session,
    of: &[String],
    format: Format,
    all: bool,
) -> Result<String, Error> {
    Ok(written(&session.tables(of)?, format, all))
}

/// Compares methods on a run from a state, as `hamel compare --format json` does for one description.
///
/// # Errors
/// Unknown methods, and runs that cannot begin.
pub fn compare(session: &Session, state: &State, asked: &Comparison) -> Result<String, Failure> {
    method::check_names(&asked.methods)?;
    let shown = session.source().shown();
    let case = compare::case(
        session.generated(),
        shown,
        state,
        asked,
        None,
        &mut |_, _| {},
    )?;
    compare::one(&case)
}
