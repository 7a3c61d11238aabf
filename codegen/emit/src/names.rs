//! All generated identifiers.
//!
//! | identifier | pattern |
//! |---|---|
//! | type | as written |
//! | functions that every description can have | `rate`, `accel` …, reserved even if they are not generated |
//! | field and accessor of a parameter | `snake_case` of the name as written |
//! | the same for `M` if there is a parameter `m`, too | `m_upper` |
//! | setter of a parameter | `set_` + accessor |
//! | function of an output or an invariant | `snake_case` of the name as written |
//! | the same if that name is taken | `snake_case` + `_output` |
//! | field of kept constants | `k` |
//! | private functions | `constants`, `update`, function + `_part1` … |
//! | external functions: their trait, their field | type + `Functions`, `functions` |
//! | methods of external functions | `snake_case` of the name as written, the same + `_jacobian` |
//! | function for both ξ̇ and [A B], if generated | `accel_and_linearize` |
//! | arguments | `x`, `xi`, `u`, `xi_dot`, `slopes`; in parts `slots`, `out` |
//! | temporaries | the user's name, `t1` …, `sin1`, `sin_q` …, `minus_` + name for a negated one |
//! | numbers | `zero`, `one`, `two`, `half` …, `c1` … |
//!
//! Identifiers are ASCII only: Greek letters are spelled out, combining dots become `_dot`, and other letters `u` + hex
//! code. A name that is taken gets `_2`, `_3` …; a keyword gets `_`.
//!
//! Names are given in the order of the table, and within a row in the order of the text. So the names of parameters
//! depend on the parameters alone: adding or removing an output, or a function under `generate`, does not change them.
//! Fields have a scope of their own, since Rust distinguishes them from methods.

use hamel_language::functions::FunctionId;
use hamel_program::{Argument, Program};
use rustc_hash::FxHashSet;

const GREEK: &[(&str, &str)] = &[
    ("αΑ", "alpha"),
    ("βΒϐ", "beta"),
    ("γΓ", "gamma"),
    ("δΔ", "delta"),
    ("εΕϵ", "epsilon"),
    ("ζΖ", "zeta"),
    ("ηΗ", "eta"),
    ("θΘϑϴ", "theta"),
    ("ιΙ", "iota"),
    ("κΚϰ", "kappa"),
    ("λΛ", "lambda"),
    ("μΜµ", "mu"),
    ("νΝ", "nu"),
    ("ξΞ", "xi"),
    ("οΟ", "omicron"),
    ("πΠϖ", "pi"),
    ("ρΡϱ", "rho"),
    ("σΣς", "sigma"),
    ("τΤ", "tau"),
    ("υΥ", "upsilon"),
    ("φΦϕ", "phi"),
    ("χΧ", "chi"),
    ("ψΨ", "psi"),
    ("ωΩΩ", "omega"),
];

const KEYWORDS: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate",
    "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl",
    "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref",
    "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield", "Self",
];

/// Methods of every generated type, or of the traits that it implements. `into` and `try_into` are among them because
/// they take `self` by value, and Rust prefers them to a method of the type that takes a reference.
const METHODS: &[&str] = &[
    "new",
    "default",
    "clone",
    "clone_from",
    "into",
    "try_into",
    "fmt",
    "blocks",
    "zero_coordinates",
    "zero_velocities",
    "zero_chart",
    "zero_inputs",
    "start",
    "constraint_norm",
    "forward_dynamics",
    "rotors",
    super::together::PAIR_NAME,
];

/// Local names that a function may use in addition to the names of its values.
const LOCALS: &[&str] = &[
    "x", "xi", "u", "xi_dot", "momentum", "k", "slots", "out", "slopes",
];

/// The generic parameter, the primitive types, and the tool of `#[rustfmt::skip]`: generated text uses some of them.
const TYPES: &[&str] = &[
    "S", "rustfmt", "bool", "char", "str", "f16", "f32", "f64", "f128", "i8", "i16", "i32", "i64",
    "i128", "isize", "u8", "u16", "u32", "u64", "u128", "usize",
];

/// Returns the name of an argument of generated functions, such as `x` or `xi_dot`.
pub fn argument_name(argument: Argument) -> &'static str {
    match argument {
        Argument::Coordinates => "x",
        Argument::Velocities => "xi",
        Argument::Accelerations => "xi_dot",
        Argument::Momenta => "momentum",
        Argument::Inputs => "u",
    }
}

/// Converts a name to lower snake case; never empty, never a keyword.
pub fn to_snake_case(name: &str) -> String {
    let mut text = String::new();
    let mut last = ' ';
    for letter in name.trim_start_matches("r#").chars() {
        let spelled = spell(letter);
        let is_word = spelled.len() > 1;
        // A new word begins at each capital after a small letter, and before and after a spelled-out letter.
        let starts = letter.is_ascii_uppercase() && last.is_ascii_lowercase();
        let borders = (is_word && last.is_alphabetic())
            || (letter.is_alphabetic() && !last.is_ascii() && last.is_alphabetic());
        if starts || borders {
            text.push('_');
        }
        text.push_str(&spelled.to_ascii_lowercase());
        last = letter;
    }
    let words: Vec<&str> = text.split('_').filter(|word| !word.is_empty()).collect();
    legal(words.join("_"), KEYWORDS)
}

/// Converts a name to the name of the type; its case is kept.
pub fn type_name(name: &str) -> String {
    let mut text = String::new();
    for letter in name.trim_start_matches("r#").chars() {
        let spelled = spell(letter);
        let mut letters = spelled.chars();
        if spelled.len() > 1
            && let Some(first) = letters.next()
        {
            text.push(first.to_ascii_uppercase());
        }
        text.push_str(letters.as_str());
    }
    let text = legal(text, KEYWORDS);
    legal(text, TYPES)
}

/// Converts names to lower snake case; if two differ by case alone, the one with capitals gets `_upper`.
pub fn to_distinct_snake_case(names: &[&str]) -> Vec<String> {
    let is_lower = |name: &str| !name.chars().any(char::is_uppercase);
    let snakes: Vec<String> = names.iter().map(|name| to_snake_case(name)).collect();
    let each = || names.iter().zip(&snakes);
    let lower = each().filter(|(name, _)| is_lower(name));
    let lower: FxHashSet<&String> = lower.map(|(_, snake)| snake).collect();
    each()
        .map(
            |(name, snake)| match lower.contains(snake) && !is_lower(name) {
                true => format!("{}_upper", snake.trim_end_matches('_')),
                false => snake.clone(),
            },
        )
        .collect()
}

fn spell(letter: char) -> String {
    let greek = GREEK.iter().find(|(letters, _)| letters.contains(letter));
    match (letter, greek) {
        (_, Some((_, name))) => (*name).into(),
        ('\u{307}', _) => "_dot".into(),
        ('\u{308}', _) => "_ddot".into(),
        (letter, _) if letter.is_ascii_alphanumeric() => letter.into(),
        (letter, _) if letter.is_ascii() => "_".into(),
        (letter, _) => format!("u{:x}", u32::from(letter)),
    }
}

fn legal(text: String, reserved: &[&str]) -> String {
    match text.chars().next() {
        None => "v".into(),
        Some('0'..='9') => format!("v{text}"),
        Some(_) if text.chars().all(|letter| letter == '_') => "v".into(),
        Some(_) if reserved.contains(&text.as_str()) => format!("{text}_"),
        Some(_) => text,
    }
}

/// The names of one scope, each given out once.
#[derive(Clone, Debug, Default)]
pub struct UniqueNames {
    taken: FxHashSet<String>,
}

impl UniqueNames {
    /// Creates a scope in which some names are taken.
    pub fn new(taken: &[&str]) -> Self {
        UniqueNames {
            taken: taken.iter().map(|&name| name.into()).collect(),
        }
    }

    /// Takes the wanted name if it is free, or else the first free one of `name_2`, `name_3` ….
    pub fn claim(&mut self, wanted: &str) -> String {
        let name = self.free_where(wanted, |_| true);
        self.taken.insert(name.clone());
        name
    }

    /// Returns the name that `claim` would give, without taking it.
    pub fn free_name(&self, wanted: &str) -> String {
        self.free_where(wanted, |_| true)
    }

    /// Whether `claim` would return exactly this name.
    pub fn is_free(&self, name: &str) -> bool {
        !self.taken.contains(name)
    }

    fn free_where(&self, wanted: &str, accept: impl Fn(&str) -> bool) -> String {
        let mut name = wanted.to_string();
        let mut number = 2;
        while self.taken.contains(&name) || !accept(&name) {
            name = format!("{}_{number}", wanted.trim_end_matches('_'));
            number += 1;
        }
        name
    }
}

/// Words of the target language that cannot be names of values in a function.
#[derive(Clone, Debug)]
pub(crate) struct ReservedWords {
    /// Names that are taken in every function.
    pub locals: UniqueNames,
    /// Replaces a reserved word; the identity for Rust, where names in snake case are legal already.
    pub legal: fn(String) -> String,
}

impl ReservedWords {
    /// Returns the reserved words of Rust.
    pub fn of_rust() -> Self {
        ReservedWords {
            locals: UniqueNames::new(LOCALS),
            legal: |name| name,
        }
    }
}

/// Names related to a program's external functions.
#[derive(Clone, Debug, Default)]
pub struct ExternalNames {
    /// The trait that declares them.
    pub of: String,
    /// The type that implements the trait, a parameter of the program's type.
    pub parameter: String,
    /// The field that holds a value of this type.
    pub field: String,
    /// Names of the methods for the components and the slopes of each function.
    pub methods: Vec<[String; 2]>,
    /// Names of the arguments of each function.
    pub arguments: Vec<Vec<String>>,
}

impl ExternalNames {
    fn new(program: &Program, type_name: &str, fields: &mut UniqueNames) -> Self {
        let externals = program.graph.externals();
        if externals.is_empty() {
            return ExternalNames::default();
        }
        let mut methods = UniqueNames::new(METHODS);
        let written: Vec<&str> = externals.iter().map(|one| one.name.as_str()).collect();
        let values: Vec<String> = to_distinct_snake_case(&written)
            .iter()
            .map(|wanted| methods.claim(wanted))
            .collect();
        let both = values.into_iter().map(|value| {
            let slopes = methods.claim(&format!("{}_jacobian", value.trim_end_matches('_')));
            [value, slopes]
        });
        let arguments = externals.iter().map(|one| {
            let mut own = UniqueNames::default();
            let wanted: Vec<&str> = one.arguments.iter().map(String::as_str).collect();
            to_distinct_snake_case(&wanted)
                .iter()
                .map(|name| own.claim(name))
                .collect()
        });
        ExternalNames {
            of: format!("{type_name}Functions"),
            parameter: if type_name == "F" { "G" } else { "F" }.into(),
            field: fields.claim("functions"),
            methods: both.collect(),
            arguments: arguments.collect(),
        }
    }
}

/// The Rust names of a program's type, fields and methods.
#[derive(Clone, Debug)]
pub struct ProgramNames {
    /// The type.
    pub type_name: String,
    /// Functions, in order.
    pub functions: Vec<String>,
    /// Fields of the parameter groups, in order.
    pub fields: Vec<String>,
    /// Accessors of the parameter groups, in order.
    pub accessors: Vec<String>,
    /// The field of kept constants.
    pub kept: String,
    /// The function that computes the kept constants.
    pub constants: String,
    /// The function that computes the kept constants and checks the pivots among them.
    pub update: String,
    /// Names related to external functions.
    pub externals: ExternalNames,
    methods: UniqueNames,
}

impl ProgramNames {
    /// Chooses the Rust names of a program: first those that are public, then the private ones.
    pub fn new(program: &Program) -> Self {
        ProgramNames::with_reserved_names(program, &[])
    }

    /// Chooses the Rust names of a program, none of which is one of `taken`, besides the names that methods of every
    /// generated type have.
    pub(crate) fn with_reserved_names(program: &Program, taken: &[&str]) -> Self {
        let mut methods = UniqueNames::new(&[METHODS, taken].concat());
        let known = FunctionId::ALL.iter();
        methods.taken.extend(known.map(|id| id.name().to_string()));
        let mut fields = UniqueNames::default();
        let groups = program.params.iter();
        let params =
            to_distinct_snake_case(&groups.map(|group| group.name.as_str()).collect::<Vec<_>>());
        let mut accessors = Vec::new();
        for wanted in &params {
            let setter = |name: &str| format!("set_{name}");
            let accessor = methods.free_where(wanted, |name| methods.is_free(&setter(name)));
            methods.claim(&accessor);
            methods.claim(&setter(&accessor));
            accessors.push(accessor);
        }
        let own = program.functions.iter().filter(|f| f.id.is_none());
        let own: Vec<&str> = own.map(|function| function.name.as_str()).collect();
        let mut own = to_distinct_snake_case(&own).into_iter();
        let mut named = Vec::new();
        for function in &program.functions {
            let wanted = match function.id {
                Some(_) => None,
                None => own.next(),
            };
            named.push(match wanted {
                None => function.name.clone(),
                Some(wanted) if methods.is_free(&wanted) => methods.claim(&wanted),
                Some(wanted) => methods.claim(&format!("{}_output", wanted.trim_end_matches('_'))),
            });
        }
        let type_name = type_name(&program.name);
        let all = params.iter().map(|wanted| fields.claim(wanted)).collect();
        let kept = fields.claim("k");
        ProgramNames {
            externals: ExternalNames::new(program, &type_name, &mut fields),
            type_name,
            functions: named,
            fields: all,
            accessors,
            kept,
            constants: methods.claim("constants"),
            update: methods.claim("update"),
            methods,
        }
    }

    /// Returns the name of the function for one part of a long function; parts are counted from 1.
    pub fn part_name(&self, function: &str, number: usize) -> String {
        // Two parts never want the same name, so nothing has to be remembered.
        let function = function.trim_end_matches('_');
        self.methods.free_name(&format!("{function}_part{number}"))
    }
}
