//! The proc macro front end of hamel: a shell over [`hamel_codegen::expand`].

use proc_macro::TokenStream;

/// Derives the equations of motion of the described system and expands to a Rust type with them.
///
/// The grammar is that of `.eom` files; errors are placed in the description. The expansion names
/// `::hamel`, so the crate `hamel` has to be a dependency.
///
/// Warnings, such as that of a parameter that nothing uses, are not shown: stable Rust has none for macros.
/// `hamel check` and the build script show them.
#[proc_macro]
pub fn rigid_eom(input: TokenStream) -> TokenStream {
    let description = proc_macro2::TokenStream::from(input);
    hamel_codegen::expand(description).into()
}
