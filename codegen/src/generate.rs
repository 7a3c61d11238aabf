//! From a description to its program: what all doors call.

use crate::derive::assemble::assemble;
use crate::derive::invariants;
use crate::diagnostics::Diagnostic;
use crate::model::{self, Model};
use crate::program::Program;
use crate::syntax::{self, ast};
use proc_macro2::TokenStream;

/// A description, read and derived.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The system that it describes.
    pub model: Model,
    /// Its functions, validated.
    pub program: Program,
    /// Hash of the description's tokens: the same through every door.
    pub hash: u64,
}

/// Derives the description in a stream of tokens.
pub fn from_tokens(tokens: TokenStream) -> Result<Generated, Vec<Diagnostic>> {
    let hash = fingerprint(&syntax::canonical(&tokens));
    derive(&syntax::parse_tokens(tokens)?, hash)
}

/// Derives the description in a text.
pub fn from_text(text: &str) -> Result<Generated, Vec<Diagnostic>> {
    let system = syntax::parse_text(text)?;
    let canonical = text
        .parse::<TokenStream>()
        .map(|tokens| syntax::canonical(&tokens))
        .unwrap_or_default();
    derive(&system, fingerprint(&canonical))
}

fn derive(system: &ast::System, hash: u64) -> Result<Generated, Vec<Diagnostic>> {
    let model = model::build(system)?;
    let program = assemble(&model).map_err(|error| vec![error])?;
    invariants::refute(&model)?;
    Ok(Generated {
        model,
        program,
        hash,
    })
}

/// FNV-1a, 64 bits.
fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
