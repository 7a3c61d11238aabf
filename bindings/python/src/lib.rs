//! `hamel._hamel`: what Python calls. The face that users see is written in Python, in `package/hamel`.
//!
//! | file | owns |
//! |---|---|
//! | `session` | a description, and everything that is asked of it |
//! | `run` | runs, with their options and what becomes of them |
//! | `function`, `states`, `rows` | generated functions over arrays: calls, evaluation, arrays of states |
//! | `law` | functions in Python that give inputs, or are watched for events |
//! | `failure`, `warnings` | exceptions, and warnings |

mod failure;
mod function;
mod law;
mod rows;
mod run;
mod session;
mod states;
mod warnings;

use pyo3::prelude::*;

/// Equations of motion from descriptions.
#[pymodule]
mod _hamel {
    #[pymodule_export]
    use super::failure::{HamelError, SingularError};
    #[pymodule_export]
    use super::function::Function;
    #[pymodule_export]
    use super::session::{Session, asked, command, decoded};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
