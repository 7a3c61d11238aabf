//! Extension module `hamel._hamel`. The public interface is written in Python, in `package/hamel`.
//!
//! | file | owns |
//! |---|---|
//! | `session` | a description, and all requests to it |
//! | `run` | runs, with their options and results |
//! | `function`, `states`, `rows` | generated functions over arrays: calls, evaluation, arrays of states |
//! | `linear` | linear systems: steps, modes, zeros, regulators |
//! | `law` | functions in Python that give inputs, or are watched for events |
//! | `failure`, `warnings` | exceptions, and warnings |

mod failure;
mod function;
mod law;
mod linear;
mod rows;
mod run;
mod session;
mod states;
mod warnings;

use pyo3::prelude::*;

/// Equations of motion of mechanical systems.
#[pymodule]
mod _hamel {
    #[pymodule_export]
    use super::failure::{HamelError, SingularError};
    #[pymodule_export]
    use super::function::Function;
    #[pymodule_export]
    use super::linear::Linear;
    #[pymodule_export]
    use super::session::{Session, asked, command, decoded};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
