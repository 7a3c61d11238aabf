//! Locks the public interface of the crates for users as text, so that a review shows every change. The interfaces
//! between the stages of the generator are not locked.
//!
//! The sources are parsed by `syn`; the output of a macro of the crate is listed as its invocation.

mod crates;
mod signature;

use crates::Crate;
use std::path::Path;

/// Returns the lines of the crate in this folder.
fn public(folder: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let lines = Crate::read(&root.join(folder).join("src")).public();
    assert!(!lines.is_empty(), "{folder} offers nothing");
    lines.join("\n")
}

macro_rules! locked {
    ($($name:ident: $folder:literal),*) => {$(
        #[test]
        fn $name() {
            insta::assert_snapshot!(stringify!($name), public($folder));
        }
    )*};
}

locked!(
    codegen: "codegen",
    import: "codegen/import",
    macros: "macros",
    runtime: "runtime"
);
