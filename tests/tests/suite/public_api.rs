//! What the crates that users name offer to them, locked as text: a change of the public interface is seen in review.
//! What the generator's stages offer to one another is not.
//!
//! The sources are read by `syn`; what a macro of the crate itself writes is listed as its invocation.

mod crates;
mod signature;

use crates::Crate;
use std::path::Path;

/// The lines of one crate, whose folder has this name.
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
