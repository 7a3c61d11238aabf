//! Locks the public interface of the crates that users name as text, so that a change of it is seen in review.
//! The interfaces between the stages of the generator are not locked.
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
