//! The proc macro door of hamel: a shell over `hamel_codegen::expand`.

use proc_macro::TokenStream;

/// Derives and expands the equations of motion of the described system.
///
/// The grammar is that of `.eom` files; see the `hamel` crate for an example.
#[proc_macro]
pub fn rigid_eom(input: TokenStream) -> TokenStream {
    hamel_codegen::expand(input.into()).into()
}
