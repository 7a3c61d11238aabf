//! Identifiers of generated Python: those of Rust, with `_` behind words that Python reserves.

use crate::names::{ProgramNames, ReservedWords, UniqueNames};

/// Keywords of Python that are not keywords of Rust, in the case of generated names, which have no capitals but in
/// the name of the class.
const KEYWORDS: &[&str] = &[
    "and", "assert", "class", "def", "del", "elif", "except", "finally", "from", "global",
    "import", "is", "lambda", "nonlocal", "not", "or", "pass", "raise", "with", "None", "True",
    "False",
];

/// Names that no function and no parameter can have: arguments of the constructor, and modules.
pub const RESERVED: &[&str] = &["xp", "numpy", "math", "valid"];

/// Local names that a function may use in addition to the names of its values.
const LOCALS: &[&str] = &[
    "self", "xp", "math", "numpy", "x", "xi", "u", "xi_dot", "momentum", "k", "valid",
];

fn legal(name: String) -> String {
    match KEYWORDS.contains(&name.as_str()) {
        true => format!("{name}_"),
        false => name,
    }
}

/// Returns the words of Python that cannot be names of values in a function.
pub fn reserved_words() -> ReservedWords {
    ReservedWords {
        locals: UniqueNames::new(LOCALS),
        legal,
    }
}

/// Returns the names of a program with those of its class and functions made legal in Python.
pub fn legal_names(mut names: ProgramNames) -> ProgramNames {
    names.type_name = legal(names.type_name);
    names.functions = names.functions.into_iter().map(legal).collect();
    names
}

/// Returns the Python attributes that hold the parameter groups. Parameters and functions share the names of one class,
/// as the accessors of Rust do.
pub fn parameter_attributes(names: &ProgramNames) -> Vec<String> {
    names.accessors.iter().cloned().map(legal).collect()
}
