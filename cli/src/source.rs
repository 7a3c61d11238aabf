//! A description's file: reading and deriving it, with errors shown in its text.

use crate::failure::Failure;
use hamel_codegen::diagnostics::Diagnostic;
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::render::render;
use std::io::Read;
use std::path::Path;

/// A text and where it comes from.
pub struct Source {
    /// The path as given, or `<stdin>`.
    pub path: String,
    /// The text.
    pub text: String,
}

impl Source {
    /// Reads a file, or standard input where the path is `-`.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let stdin = path.as_os_str() == "-";
        let name = if stdin {
            "<stdin>".to_string()
        } else {
            path.display().to_string()
        };
        let bytes = if stdin {
            let mut bytes = Vec::new();
            std::io::stdin()
                .lock()
                .read_to_end(&mut bytes)
                .map(|_| bytes)
        } else {
            std::fs::read(path)
        };
        let bytes =
            bytes.map_err(|error| Failure::usage(format!("cannot read {name}: {error}")))?;
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Source { path: name, text }),
            Err(error) => {
                let place = error.utf8_error().valid_up_to();
                Err(Failure::usage(format!(
                    "cannot read {name}: byte {place} is not UTF-8"
                )))
            }
        }
    }

    /// Derives the functions that the description asks for.
    pub fn derive(&self) -> Result<Generated, Failure> {
        from_text(&self.text).map_err(|errors| self.refused(&errors))
    }

    /// Derives all functions, whatever the description's `generate` says.
    pub fn derive_all(&self) -> Result<Generated, Failure> {
        let mut generated = self.derive()?;
        if !generated.model.generate.is_empty() {
            generated.model.generate.clear();
            generated = Generated::of(generated.model, generated.hash)
                .map_err(|errors| self.refused(&errors))?;
        }
        Ok(generated)
    }

    /// Derives all functions and the linearisation, whatever the description's `generate` says.
    pub fn derive_linearized(&self) -> Result<Generated, Failure> {
        let generated = self.derive()?;
        Generated::all(generated.model, generated.hash).map_err(|errors| self.refused(&errors))
    }

    /// The errors with their source underlined.
    pub fn refused(&self, errors: &[Diagnostic]) -> Failure {
        Failure::Failed(render(errors, &self.path, &self.text, true))
    }
}
