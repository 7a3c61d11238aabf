//! What commands report of a description, for other front ends: identities, costs, generated code, tables, comparisons.

use crate::check::{self, Checked};
use crate::compare::{self, Comparison};
use crate::failure::Failure;
use crate::ops;
use crate::tables::{Format, written};
use hamel_codegen::builder;
use hamel_codegen::emit::c::{Files, Precision};
use hamel_engine::{Error, Session, State, method};

/// What `hamel check` says: the identities with their verdicts, and the lines below them.
pub fn check(session: &Session) -> (Vec<Checked>, String) {
    let remarks = check::remarks(session.generated(), session.source().shown());
    (check::checked(session.generated()), remarks)
}

/// What `hamel ops --format json` prints.
///
/// # Errors
/// What cannot be derived.
pub fn operations(session: &Session) -> Result<String, Failure> {
    ops::counted(session.source())
}

/// What `hamel ops --advise --format json` prints.
///
/// # Errors
/// Where there are no velocities to compare.
pub fn advice(session: &Session) -> Result<String, Failure> {
    ops::advised(session.source())
}

/// The generated Rust, as of a description in a file of this name.
///
/// # Errors
/// What cannot be derived or written.
pub fn rust(session: &Session, name: &str) -> Result<String, Error> {
    let generated = session.source().derive()?;
    builder::written(&generated, name).map_err(|errors| session.source().refused(&errors))
}

/// The generated C99, as of a description in a file of this name.
///
/// # Errors
/// What cannot be derived or written.
pub fn c(session: &Session, name: &str, stem: &str) -> Result<Files, Error> {
    let generated = session.source().derive()?;
    builder::written_in_c(&generated, name, Some(stem), Precision::default())
        .map_err(|errors| session.source().refused(&errors))
}

/// Tables by their names, those that matter where none is named; every entry, where `all`.
///
/// # Errors
/// Where a table is not known, or cannot be had.
pub fn tables(
    session: &Session,
    of: &[String],
    format: Format,
    all: bool,
) -> Result<String, Error> {
    Ok(written(&session.tables(of)?, format, all))
}

/// Methods compared on a run from a state, as `hamel compare --format json` has them for one description.
///
/// # Errors
/// Methods that do not exist, and runs that cannot begin.
pub fn compare(session: &Session, state: &State, asked: &Comparison) -> Result<String, Failure> {
    method::known(&asked.methods)?;
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
