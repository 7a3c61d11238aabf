//! Reasons why a table is not available.

use super::kind::Table;
use std::fmt;

/// Reason why a table is not available.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TableError {
    /// No table has this name.
    Unknown {
        /// The name that was given.
        name: String,
    },
    /// The table needs M, which a system without inertia does not have.
    NoInertia(Table),
    /// The table needs a Y with Y A = I, which does not exist.
    DependentColumns(Table),
    /// The table shows a function that the description does not generate.
    NotGenerated(Table),
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (table, why) = match self {
            TableError::Unknown { name } => {
                let names = Table::names().join(", ");
                return write!(f, "there is no table `{name}`; the tables are {names}");
            }
            TableError::NoInertia(table) => (table, "the system has no inertia"),
            TableError::DependentColumns(table) => (
                table,
                "the columns of A are dependent, so no Y satisfies Y A = I",
            ),
            TableError::NotGenerated(table) => {
                (table, "the description does not generate the function")
            }
        };
        write!(f, "there is no table `{}`: {why}", table.name())
    }
}

impl std::error::Error for TableError {}
