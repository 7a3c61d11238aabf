//! A program as C99, with the same computations as in Rust: a header with documented prototypes, and a source file.
//!
//! | file | owns |
//! |---|---|
//! | `names` | identifiers |
//! | `words` | words reserved by C and C++ |
//! | `language` | statements, numbers, `double` or `float` |
//! | `nearest` | the origins from which parts address arrays |
//! | `body` | bodies of functions, with their parts |
//! | `helpers` | functions that `<math.h>` does not have |
//! | `comment` | comments |
//! | `header` | `name.h`: sizes, indices by name, types, prototypes |
//! | `source` | `name.c`: functions |
//!
//! Both files are valid C++17, too. Nothing is allocated, nothing is kept between calls, and there is no recursion.
//! Functions read and write only their arguments: arrays of numbers as in Rust, matrices by rows. Statements, their
//! order, and names are the same as in Rust.

mod body;
mod comment;
mod header;
mod helpers;
mod language;
mod names;
mod nearest;
mod source;
mod words;

use super::function::{FunctionSpec, with_prepared};
use super::{Emitter, docs};
use hamel_algebra::graph::NodeId;
use hamel_program::{Function, Program};
use language::CLanguage;
pub use language::Precision;
use names::CIdentifiers;

/// Options of the C generator: contents of the file headers, and the floating-point type.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Options {
    /// Hash of the description, quoted in the file headers.
    pub source_hash: u64,
    /// Command that regenerates the files, quoted in the file headers; none if empty.
    pub command: String,
    /// Text of the description, quoted in the header file; none if empty.
    pub description: String,
    /// Name of the header file, as included by the source.
    pub header: String,
    /// Floating-point type of the generated code.
    pub precision: Precision,
}

/// Texts of a C header and its source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CFiles {
    /// `name.h`
    pub header: String,
    /// `name.c`
    pub source: String,
    /// `name.c` without the `#include` of the header: the header followed by this text is a complete source file.
    pub rest: String,
}

/// Everything that is needed to print the files.
struct Texts<'a> {
    emitter: Emitter<'a>,
    names: CIdentifiers,
    precision: Precision,
}

impl<'a> Texts<'a> {
    fn new(program: &'a Program, precision: Precision) -> Self {
        let (identifiers, names) = CIdentifiers::of(program);
        let words = identifiers.reserved_words();
        // C compilers take functions of any length, so that only functions that run faster that way are split.
        let emitter = Emitter {
            headings: true,
            ..Emitter::with(program, usize::MAX, names, words, documentation)
        };
        Texts {
            emitter,
            names: identifiers,
            precision,
        }
    }

    fn program(&self) -> &'a Program {
        self.emitter.program
    }

    /// Returns the functions that are called while the system moves, with their names.
    fn functions(&self) -> impl Iterator<Item = (FunctionSpec<'a>, &str)> {
        let functions = self.program().functions.iter().enumerate();
        let specs = functions.map(|(index, function)| self.emitter.function(index, function));
        specs.zip(self.names.functions.iter().map(String::as_str))
    }
}

/// Generates C: returns the header and the source of a program.
pub fn files(program: &Program, options: &Options) -> CFiles {
    let texts = Texts::new(program, options.precision);
    let origin = docs::generation_notice(options.source_hash, &options.command);
    let description = docs::description_lines(&options.description);
    let described = comment::plain_comment(&[origin.clone(), description].concat());
    let origin = comment::plain_comment(&origin);
    let rest = source::print_source(&texts);
    let include = format!("#include \"{}\"\n\n", options.header);
    CFiles {
        header: format!("{described}\n{}", header::print_header(&texts)),
        source: format!("{origin}\n{include}{rest}"),
        rest,
    }
}

/// Standard headers of C, without `.h`. A file with such a name would hide the standard one if its folder is searched.
const HEADERS: &[&str] = &[
    "assert",
    "complex",
    "ctype",
    "errno",
    "fenv",
    "float",
    "inttypes",
    "iso646",
    "limits",
    "locale",
    "math",
    "setjmp",
    "signal",
    "stdalign",
    "stdarg",
    "stdatomic",
    "stdbit",
    "stdbool",
    "stdckdint",
    "stddef",
    "stdint",
    "stdio",
    "stdlib",
    "stdnoreturn",
    "string",
    "tgmath",
    "threads",
    "time",
    "uchar",
    "wchar",
    "wctype",
];

/// Whether `stem` with `.h` is a usable header name: it can be included, and does not hide a standard header.
pub fn is_includable(stem: &str) -> bool {
    let strange = |letter: char| letter.is_control() || matches!(letter, '"' | '\\' | '?');
    // Some file systems do not distinguish `Math.h` from `math.h`.
    let known = HEADERS
        .iter()
        .any(|header| header.eq_ignore_ascii_case(stem));
    !stem.is_empty() && !stem.contains(strange) && !known
}

/// Returns the linker symbols of a program's functions.
#[cfg(feature = "files")]
pub fn linker_symbols(program: &Program) -> Vec<String> {
    let (names, _) = CIdentifiers::of(program);
    let own = ["default_parameters", "set_parameters", "start"].map(|name| names.identifier(name));
    own.into_iter().chain(names.functions).collect()
}

/// Returns the C documentation of a function: what it evaluates, its cost, arguments and result.
fn documentation(program: &Program, function: &Function, nodes: &[NodeId]) -> Vec<String> {
    let mut lines = docs::summary_and_arguments(program, function, nodes);
    let result = docs::result_in_words(function.shape);
    if returns_number(function.shape, function.fallible) {
        lines.extend([String::new(), format!("Returns {result}.")]);
        return lines;
    }
    if function.arguments.is_empty() {
        lines.push(String::new());
    }
    let rows = match function.shape {
        hamel_program::Shape::Matrix(..) => ", row by row",
        _ => "",
    };
    lines.push(format!("- `out`: {result}{rows}"));
    if function.fallible {
        let why = match docs::singular_conditions(program, &function.guards) {
            Some(why) => {
                format!("Returns a status other than 0, and leaves `out` alone, where {why}.")
            }
            None => "Returns 0: no pivot depends on the arguments.".into(),
        };
        lines.extend([String::new(), why]);
    }
    lines
}

/// Whether a function returns its result; others write it to `out`.
fn returns_number(shape: hamel_program::Shape, fallible: bool) -> bool {
    shape == hamel_program::Shape::Scalar && !fallible
}
