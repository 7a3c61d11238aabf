//! Results of proofs.

use super::confidence::Confidence;
use hamel_algebra::field_point::Roots;
use hamel_algebra::graph::Edge;
use hamel_language::diagnostics::Diagnostic;
use hamel_language::model::Model;

/// Whether an identity is proved, agrees at random points, or fails.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Both sides have the same normal form modulo φ over the rationals.
    Proved,
    /// Both sides agree at random points of X.
    Checked(Confidence),
    /// Both sides differ, or could not be compared.
    Failed(String),
}

/// An identity, by its number and its equation in text, with its verdict.
#[derive(Clone, Debug)]
pub struct Identity {
    /// Number of the equation in KR18, or a name.
    pub label: &'static str,
    /// The equation.
    pub equation: String,
    /// Result.
    pub verdict: Verdict,
}

/// Both sides of an identity.
pub(super) struct Sides {
    pub(super) label: &'static str,
    pub(super) equation: &'static str,
    pub(super) left: Vec<Edge>,
    pub(super) right: Vec<Edge>,
}

/// Reports a fault of the generator; the program is not emitted.
pub(super) fn failure(model: &Model, what: &str) -> Diagnostic {
    fault(
        model,
        &format!("{what} was not confirmed"),
        &format!("{what} does not hold"),
    )
}

/// Reports that no point was found to compare at.
pub(super) fn nowhere(model: &Model) -> Diagnostic {
    let why = "no random point was found at which all functions have values";
    fault(model, why, why)
}

/// Explains why nothing is emitted: nested roots that the proof cannot evaluate, or else a fault of the generator.
fn fault(model: &Model, unproved: &str, wrong: &str) -> Diagnostic {
    if model.points.roots == Roots::Arbitrary {
        let message = format!("`{}` could not be proved: {unproved}", model.name);
        let help = "roots within roots have no values in the fields of the proof: replace the inner one by a parameter or a coordinate";
        return Diagnostic::new(model.span, message).help(help);
    }
    Diagnostic::new(
        model.span,
        format!("internal check failed for `{}`: {wrong}", model.name),
    )
    .help("this is a fault of the generator, nothing was emitted; please report the description")
    .about_proof()
}
