//! Inputs of the structure analyses.

use super::rates::Part;
use super::variation::Variation;
use hamel_language::model::Model;

/// Model with its blocks, and the point from which symbols are varied.
pub struct Setting<'a> {
    pub model: &'a Model,
    pub parts: &'a [Part],
    pub variation: &'a Variation<'a>,
}
