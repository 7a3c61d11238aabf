//! Inputs of the structure analyses.

use super::rates::CoordinateBlock;
use super::variation::Variation;
use hamel_language::model::Model;

/// Model under analysis, its blocks of coordinates, and the point from which symbols are varied.
pub struct StructureContext<'a> {
    pub model: &'a Model,
    pub parts: &'a [CoordinateBlock],
    pub variation: &'a Variation<'a>,
}
