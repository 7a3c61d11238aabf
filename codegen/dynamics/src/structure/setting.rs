//! What the analyses of structure look at.

use super::rates::Part;
use super::variation::Variation;
use hamel_language::model::Model;

/// A model with its blocks and a point from which symbols are moved.
pub struct Setting<'a> {
    pub model: &'a Model,
    pub parts: &'a [Part],
    pub variation: &'a Variation<'a>,
}
