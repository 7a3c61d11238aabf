//! Checks that the extension module is built with the tests; `tests/python/run.sh` takes it from the same folder.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

#[test]
fn the_module_is_there() -> std::io::Result<()> {
    let module = format!("{DLL_PREFIX}_hamel{DLL_SUFFIX}");
    let own = std::env::current_exe()?;
    assert!(own.with_file_name(&module).is_file(), "{module}");
    Ok(())
}
