//! Reports of the commands about a description: identities, costs, generated code, comparisons; imports of robots.

use super::Session;
use crate::check::{self, CheckedIdentity};
use crate::compare::{self, Comparison};
use crate::failure::{Captured, Failure, capture};
use crate::ops;
use crate::robot::RobotOptions;
use crate::source::Source;
use crate::state::State;
use hamel_codegen::builder;
use hamel_codegen::emit::c::{Files, Precision};
use hamel_codegen::syntax::ast::CoordKind;
use hamel_codegen::tables::{self, Table};

impl Session {
    /// The results of `hamel check`: the identities with their verdicts, and the lines below them.
    pub fn check(&self) -> (Vec<CheckedIdentity>, String) {
        let remarks = check::remarks(&self.generated, self.source.shown());
        (check::check_identities(&self.generated), remarks)
    }

    /// The output of `hamel ops --format json`.
    ///
    /// # Errors
    /// Errors of the derivation.
    pub fn operations(&self) -> Result<String, Failure> {
        ops::counts_json(&self.source)
    }

    /// The output of `hamel ops --advise --format json`.
    ///
    /// # Errors
    /// If there are no velocities to compare.
    pub fn advice(&self) -> Result<String, Failure> {
        ops::advice_json(&self.source)
    }

    /// The generated Rust, as for a description in a file of this name.
    ///
    /// # Errors
    /// Errors of the derivation or of the generated code.
    pub fn rust(&self, name: &str) -> Result<String, Failure> {
        let generated = self.source.derive()?;
        builder::written(&generated, name).map_err(|errors| self.source.refused(&errors))
    }

    /// The generated C99, as for a description in a file of this name.
    ///
    /// # Errors
    /// Errors of the derivation or of the generated code.
    pub fn c(&self, name: &str, stem: &str) -> Result<Files, Failure> {
        let generated = self.source.derive()?;
        builder::written_in_c(&generated, name, Some(stem), Precision::default())
            .map_err(|errors| self.source.refused(&errors))
    }

    /// Compares methods on a run from a state, as `hamel compare --format json` does for one description.
    ///
    /// # Errors
    /// Unknown methods, and runs that cannot begin.
    pub fn compare(&self, state: &State, asked: &Comparison) -> Result<String, Failure> {
        crate::method::known(&asked.methods)?;
        let case = compare::case(&self.generated, self.source.shown(), state, asked, None)?;
        compare::one(&case)
    }

    /// Kinds of the coordinates, as the language writes them: `real`, `R3`, `S1`, `S3`, `SO3` or `SE3`.
    pub fn kinds(&self) -> Vec<String> {
        let coordinates = self.generated.model.coordinates.iter();
        let named = coordinates.map(|coordinate| match coordinate.kind {
            CoordKind::Real => "real".into(),
            CoordKind::Euclidean(n) => format!("R{n}"),
            CoordKind::S1 => "S1".into(),
            CoordKind::S3 => "S3".into(),
            CoordKind::SO3 => "SO3".into(),
            CoordKind::SE3 => "SE3".into(),
        });
        named.collect()
    }

    /// Tables by name, as JSON with formulas in LaTeX.
    ///
    /// # Errors
    /// If a table is unknown, or does not exist.
    pub fn typeset(&self, of: &[String]) -> Result<String, Failure> {
        let named: Result<Vec<Table>, String> = of.iter().map(|name| Table::parse(name)).collect();
        let tables = named.and_then(|of| self.generated.tables(&of));
        let tables = tables.map_err(Failure::usage)?;
        Ok(tables::typeset(&tables).to_string())
    }
}

/// Converts a robot in URDF, which messages call `name`, into a description.
pub fn imported(
    text: String,
    name: &str,
    options: &RobotOptions,
) -> (Result<String, Failure>, Captured) {
    capture(|| {
        let source = Source::new(name.into(), text).robot(options)?;
        Ok(source.text)
    })
}
