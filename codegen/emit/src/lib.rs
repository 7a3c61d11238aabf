//! Prints a program as source text: Rust, C99 in [`c`], and Python in [`python`]. This crate does no algebra: the operations and their order
//! are given.
//!
#![doc = include_str!("../README.md")]
//!
//! | file | owns |
//! |---|---|
//! | `names` | all generated identifiers |
//! | `number` | decimal literals |
//! | `chunk` | splits statements into functions of bounded size; values shared between them go to slots |
//! | `locals` | names of the values within one function |
//! | `print` | prints a statement in any language |
//! | `constants` | the expressions of kept constants, as comments |
//! | `language` | the syntax in which languages differ, and its implementation for Rust |
//! | `function` | one generated function with its parts |
//! | `docs` | doc comments |
//! | `layout` | parses the generated text, and formats it for files |
//! | `parts` | a function that is split into parts |
//! | `together` | one function that computes both ξ̇ and [A B] |
//! | [`trace`] | every statement with its expression and its origin |
//! | `structure` | the type: fields, sizes, constructor, defaults |
//! | `parameters` | accessors of the parameters, and the constants computed from them |
//! | `system` | `impl hamel::System`, `impl hamel::Energies` |
//! | `externals` | external functions (implemented in Rust by the user): the trait that declares them |
//! | `views` | structures with the parameters, states and inputs by name |
//! | `methods` | `impl hamel::Split`, `impl hamel::Canonical`, `impl hamel::Tangent` |
//! | [`c`] | the same program as C99 |
//! | [`python`] | the same program as a Python module for arrays |
//!
//! Text is built first and parsed afterwards, so that all front ends produce exactly the same bytes. Text that is not
//! valid Rust is reported as an error and never leaves the generator.
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `files` | yes | formatted Rust files, and C99 |

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod c;
mod chunk;
mod constants;
mod docs;
mod externals;
mod function;
mod language;
mod layout;
mod limits;
mod locals;
mod methods;
pub mod names;
mod number;
mod parameters;
mod parts;
mod print;
pub mod python;
mod structure;
mod system;
mod together;
pub mod trace;
mod views;

use function::FunctionSpec;
use hamel_algebra::graph::{Edge, NodeId};
use hamel_program::places::{Places, Time};
use hamel_program::schedule::Schedule;
use hamel_program::{Function, Program};
pub use layout::InvalidRust;
use names::{ProgramNames, ReservedWords};
use proc_macro2::TokenStream;

/// Options of the generator: contents of the file header, and the size of functions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Hash of the description, quoted in the header.
    pub source_hash: u64,
    /// Command that regenerates the file, quoted in the header; none if empty.
    pub command: String,
    /// Text of the description, quoted in the header; none if empty.
    pub description: String,
    /// Largest number of `let`s in one function; rustc overflows its stack at about 3,000 when debug
    /// information is on.
    pub chunk: usize,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            source_hash: 0,
            command: String::new(),
            description: String::new(),
            chunk: 500,
        }
    }
}

/// A program with everything that is needed to print it.
struct Emitter<'a> {
    program: &'a Program,
    places: Places<'a>,
    schedule: Schedule,
    /// Constants stored in the field `k`, in order, including the pivots of a constant mass matrix.
    kept: Vec<Edge>,
    names: ProgramNames,
    words: ReservedWords,
    document: Document,
    chunk: usize,
    /// Whether statements have headings; they are comments, which tokens cannot have.
    headings: bool,
}

/// Writes the documentation of a function that evaluates the given nodes.
type Document = fn(&Program, &Function, &[NodeId]) -> Vec<String>;

impl<'a> Emitter<'a> {
    fn new(program: &'a Program, chunk: usize) -> Self {
        let names = ProgramNames::new(program);
        Emitter::with(
            program,
            chunk,
            names,
            ReservedWords::of_rust(),
            docs::function_docs,
        )
    }

    fn with(
        program: &'a Program,
        chunk: usize,
        names: ProgramNames,
        words: ReservedWords,
        document: Document,
    ) -> Self {
        let schedule = Schedule::of(program);
        let places = Places::new(program, &schedule.kept);
        let kept = places.kept();
        Emitter {
            program,
            places,
            schedule,
            kept,
            names,
            words,
            document,
            chunk,
            headings: false,
        }
    }

    /// `fn constants`, which computes everything that depends on parameters alone.
    fn constants(&self) -> FunctionSpec<'_> {
        let count = hamel_program::count::count_nodes(&self.program.graph, &self.schedule.hoisted);
        FunctionSpec {
            name: self.names.constants.clone(),
            public: false,
            docs: vec![
                "What depends on parameters alone.".into(),
                String::new(),
                docs::operation_counts(count, ""),
            ],
            arguments: &[],
            shape: hamel_program::Shape::Vector(self.kept.len()),
            beside: None,
            functions: Vec::new(),
            outputs: self.kept.clone(),
            guards: Vec::new(),
            fallible: false,
            nodes: self.schedule.hoisted.clone(),
            time: Time::Parameters,
        }
    }

    /// A function that is evaluated while the system moves.
    fn function(&self, index: usize, function: &'a Function) -> FunctionSpec<'a> {
        let guards = if function.fallible {
            function.guards.clone()
        } else {
            Vec::new()
        };
        let roots: Vec<Edge> = function.outputs.iter().chain(&guards).copied().collect();
        let nodes = self.program.graph.varying_nodes(&roots);
        FunctionSpec {
            name: self.names.functions[index].clone(),
            public: true,
            docs: (self.document)(self.program, function, &nodes),
            arguments: &function.arguments,
            shape: function.shape,
            beside: None,
            functions: vec![function],
            outputs: function.outputs.clone(),
            guards,
            fallible: function.fallible,
            nodes,
            time: Time::Call,
        }
    }

    fn specs(&self) -> Vec<FunctionSpec<'_>> {
        let functions = self.program.functions.iter().enumerate();
        let mut specs: Vec<FunctionSpec<'_>> = functions
            .map(|(index, function)| self.function(index, function))
            .collect();
        if !self.kept.is_empty() {
            specs.push(self.constants());
        }
        specs
    }
}

/// Returns the generated type as Rust items, without a file header.
pub fn rust_items(program: &Program, options: &Options) -> String {
    items(&Emitter::new(program, options.chunk))
}

/// Prints the generated items.
fn items(emitter: &Emitter) -> String {
    let program = emitter.program;
    let mut methods = structure::print_sizes_and_new(emitter);
    methods.push_str(&limits::limit_constants(program));
    let system = system::system_implementations(emitter);
    let together = together::pair_spec(emitter).filter(|_| !system.is_empty());
    for (index, spec) in emitter.specs().iter().enumerate() {
        methods.push_str(&match &together {
            Some((place, both)) if *place == index => together::print_pair(emitter, spec, both),
            _ => function::print_function(emitter, spec),
        });
    }
    methods.push_str(&parameters::print_accessors(emitter));
    let mut text = structure::print_struct(emitter);
    text.push_str(&externals::print_external_trait(emitter));
    text.push_str(&views::print_parameter_struct(emitter));
    text.push_str(&views::print_state_struct(emitter, !system.is_empty()));
    text.push_str(&views::print_input_struct(emitter));
    text.push_str(structure::FUNCTION_LINTS);
    text.push_str(&format!(
        "impl{} {} {{\n{methods}}}\n",
        externals::impl_generics(emitter),
        externals::type_with_arguments(emitter)
    ));
    text.push_str(&structure::print_default(emitter));
    if !system.is_empty() {
        text.push_str(&system);
        text.push_str(&methods::method_trait_implementations(
            emitter,
            together.is_some(),
        ));
    }
    text
}

/// Returns the text of [`rust_items`] as tokens, after parsing it.
///
/// # Errors
/// If the text is not valid Rust, which is a defect of the generator.
pub fn rust_tokens(program: &Program, options: &Options) -> Result<TokenStream, InvalidRust> {
    let text = rust_items(program, options);
    layout::parse_file(&text)?;
    text.parse()
        .map_err(|error: proc_macro2::LexError| InvalidRust {
            why: error.to_string(),
            line: None,
        })
}

/// Returns the text of [`rust_items`], formatted, below a header that says how it was generated.
///
/// # Errors
/// If the text is not valid Rust, which is a defect of the generator.
#[cfg(feature = "files")]
pub fn rust_file(program: &Program, options: &Options) -> Result<String, InvalidRust> {
    let emitter = Emitter {
        headings: true,
        ..Emitter::new(program, options.chunk)
    };
    let text = layout::format_file(&items(&emitter))?;
    let mut header = String::new();
    let origin = docs::generation_notice(
        options.source_hash,
        &docs::escape_bidi_controls(&options.command),
    );
    for line in [origin, docs::description_lines(&options.description)].concat() {
        header.push_str(format!("// {line}").trim_end());
        header.push('\n');
    }
    Ok(format!("{header}\n{text}"))
}

/// Counts the statements of all functions, a measure of the size of the generated code.
pub fn statement_count(program: &Program) -> usize {
    let emitter = Emitter::new(program, Options::default().chunk);
    let specs = emitter.specs();
    specs
        .iter()
        .map(|spec| function::lower_function(&emitter, spec).1.statements.len())
        .sum()
}
