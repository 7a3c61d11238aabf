//! The front end of the macro: tokens in, tokens out, and errors as `compile_error!` at their places.

use crate::diagnostics::Diagnostic;
use crate::emit;
use crate::generate::{from_tokens, text_of};
use crate::render::{to_compile_errors, to_compile_warnings};
use proc_macro2::TokenStream;
use std::path::PathBuf;

/// Largest number of statements for which the macro expands: rustc copes better with larger programs as split files.
pub const MACRO_STATEMENTS: usize = 10_000;

/// Returns the expansion of `rigid_eom! { … }`. Paths of included files and of tables are relative to the folder of the
/// package. The expansion contains `include_bytes!` of all files that were read, so that the compiler tracks them.
pub fn expand(input: TokenStream) -> TokenStream {
    let folder = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let folder = folder.unwrap_or_default();
    let mut read = TokenStream::new();
    let open = &mut |name: &str| {
        let path = folder.join(name);
        let text = text_of(&path)?;
        let path = path.to_string_lossy();
        read.extend(quote::quote!(
            const _: &[u8] = ::core::include_bytes!(#path);
        ));
        Ok(text)
    };
    let (places, generated) = from_tokens(input, open);
    let generated = match generated {
        Ok(generated) => generated,
        Err(errors) => return to_compile_errors(&errors, &places),
    };
    let statements = emit::statement_count(&generated.program);
    if statements > MACRO_STATEMENTS {
        let error = Diagnostic::new(
            generated.model.span,
            format!("`{}` has {statements} statements, more than the {MACRO_STATEMENTS} that a macro should expand to", generated.model.name),
        )
        .help("put the description in an `.eom` file and call `hamel_codegen::Builder` in build.rs");
        return to_compile_errors(&[error], &places);
    }
    match emit::rust_tokens(&generated.program, &emit::Options::default()) {
        Ok(tokens) => {
            let warnings = to_compile_warnings(&generated.model.warnings, &places);
            tokens.into_iter().chain(read).chain(warnings).collect()
        }
        Err(error) => to_compile_errors(&[generated.fault(&error)], &places),
    }
}
