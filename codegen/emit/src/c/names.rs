//! Identifiers of generated C.
//!
//! | identifier | pattern |
//! |---|---|
//! | functions | prefix + name as in Rust: `free_body_accel` |
//! | types | prefix + `_real`, `_parameters`, `_system`, `_status` |
//! | macros, constants | the same in capitals: `FREE_BODY_RESTRICT`, `FREE_BODY_X_R`, `FREE_BODY_STATUS_OK` |
//! | fields of parameters, temporaries | as in Rust |
//!
//! The prefix is the name of the system in snake case. A word that is reserved by C, C++, their headers or Rust always
//! gets `_`, even where it would be legal: so a name depends on nothing but itself.

use super::words::legal_identifier;
use crate::names::{ProgramNames, ReservedWords, UniqueNames, to_snake_case};
use hamel_program::{Cause, Program};

/// Local names that a function may use in addition to the names of its values.
const LOCALS: &[&str] = &[
    "x",
    "xi",
    "u",
    "xi_dot",
    "momentum",
    "k",
    "slots",
    "out",
    "system",
    "parameters",
    "next",
    "status",
];

/// Names of the generated types and helper functions, without the prefix.
const OWN: &[&str] = &[
    "real",
    "parameters",
    "system",
    "status",
    "set_parameters",
    "default_parameters",
    "sin_cos",
    "sin",
    "cos",
    "sign",
    "select",
    "inverse_of_length",
    "raised",
    "is_positive",
    "far",
    "zeros",
];

/// The C identifiers of a program.
pub struct CIdentifiers {
    /// Prefix of all other identifiers.
    pub prefix: String,
    /// The prefix in capitals.
    pub capitals: String,
    /// The functions with their prefix, in order.
    pub functions: Vec<String>,
    /// Fields of the parameter groups, in order.
    pub fields: Vec<String>,
}

impl CIdentifiers {
    /// Returns the identifiers of a program in C, and its names in Rust, from which they are made.
    pub fn of(program: &Program) -> (Self, ProgramNames) {
        let names = ProgramNames::with_reserved_names(program, OWN);
        let prefix = to_snake_case(&program.name)
            .trim_end_matches('_')
            .to_string();
        // In C++ a member cannot have the name of a type that its struct mentions.
        let own: Vec<String> = OWN.iter().map(|name| format!("{prefix}_{name}")).collect();
        let mut members = UniqueNames::new(&own.iter().map(String::as_str).collect::<Vec<_>>());
        let identifiers = CIdentifiers {
            capitals: prefix.to_ascii_uppercase(),
            functions: (names.functions.iter())
                .map(|name| legal_identifier(format!("{prefix}_{name}")))
                .collect(),
            fields: (names.fields.iter())
                .map(|name| members.claim(&legal_identifier(name.clone())))
                .collect(),
            prefix,
        };
        (identifiers, names)
    }

    /// Returns the C identifier of a generated type or helper function, prefixed by the name of the program.
    pub fn identifier(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix)
    }

    /// Returns the name of the type of numbers.
    pub fn real(&self) -> String {
        self.identifier("real")
    }

    /// Returns the words that cannot be names of values in a function.
    pub fn reserved_words(&self) -> ReservedWords {
        let own: Vec<String> = OWN.iter().map(|name| self.identifier(name)).collect();
        let own = own.iter().map(String::as_str);
        let taken: Vec<&str> = LOCALS.iter().copied().chain(own).collect();
        ReservedWords {
            locals: UniqueNames::new(&taken),
            legal: legal_identifier,
        }
    }

    /// Returns the status code for a cause of failure.
    pub fn status_code(&self, cause: Cause) -> String {
        let capitals = &self.capitals;
        match cause {
            Cause::Velocity(place) => format!("{capitals}_STATUS_INERTIA_{place}"),
            Cause::Mass => format!("{capitals}_STATUS_INERTIA"),
            Cause::Constraint(row) => format!("{capitals}_STATUS_CONSTRAINT_{row}"),
            Cause::Kinematics(number) => format!("{capitals}_STATUS_KINEMATICS_{number}"),
        }
    }

    /// Returns the status code for success.
    pub fn success_code(&self) -> String {
        format!("{}_STATUS_OK", self.capitals)
    }
}
