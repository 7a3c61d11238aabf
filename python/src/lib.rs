//! `hamel._hamel`: what Python calls. The face that users see is written in Python, in `package/hamel`.
//!
//! | file | owns |
//! |---|---|
//! | `session` | a description, and everything that is asked of it |
//! | `function` | generated functions over arrays |
//! | `law` | inputs that a function in Python gives |
//! | `failure` | exceptions |

mod failure;
mod function;
mod law;
mod session;

use pyo3::prelude::*;

/// Equations of motion from descriptions.
#[pymodule]
mod _hamel {
    #[pymodule_export]
    use super::failure::{HamelError, SingularError};
    #[pymodule_export]
    use super::function::Function;
    #[pymodule_export]
    use super::session::{Session, asked, command};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
