//! From a program to text: Rust, and C99 in [`c`]. No algebra here: what is computed, and in which order, is given.
//!
#![doc = include_str!("../README.md")]
//!
//! | file | owns |
//! |---|---|
//! | `names` | every generated identifier |
//! | `number` | decimal literals |
//! | `chunk` | statements to functions of bounded size, values that cross them to slots |
//! | `locals` | names of the values of one function |
//! | `print` | a statement as text, in any language |
//! | `language` | what languages spell differently; Rust's way |
//! | `function` | one generated function with its parts |
//! | `docs` | doc comments |
//! | `layout` | the text parsed, and laid out for files |
//! | `parts` | a function that is cut |
//! | `together` | ξ̇ and [A B] by one function |
//! | `structure` | the type: fields, sizes, constructor, defaults |
//! | `parameters` | accessors, and the constants kept for parameters |
//! | `system` | `impl hamel::System` |
//! | `externals` | functions in Rust: the trait of those who have them |
//! | `views` | parameters, states and inputs by name |
//! | `methods` | `impl hamel::Split`, `impl hamel::Canonical` |
//! | [`c`] | the same program as C99 |
//!
//! Text is built first and parsed second, so that all front ends share every byte. What is no Rust is an
//! error, and does not leave the generator.
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `files` | yes | formatted files of Rust, and C99 |

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod c;
mod chunk;
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
mod structure;
mod system;
mod together;
mod views;

use function::Spec;
use hamel_algebra::graph::{Edge, NodeId};
use hamel_program::places::{Places, Time};
use hamel_program::schedule::Schedule;
use hamel_program::{Function, Program};
pub use layout::NotRust;
use names::{Names, Words};
use proc_macro2::TokenStream;

/// What the generated text says about itself, and how its functions are cut.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Hash of the description.
    pub source_hash: u64,
    /// The command that generates the file again.
    pub command: String,
    /// The most `let`s of one function; rustc overflows its stack at about 3,000 where debug
    /// information is on.
    pub chunk: usize,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            source_hash: 0,
            command: String::new(),
            chunk: 500,
        }
    }
}

/// The program with all that its text is made from.
struct Emitter<'a> {
    program: &'a Program,
    places: Places<'a>,
    schedule: Schedule,
    /// Constants kept in the field `k`, in order; pivots of a constant mass matrix among them.
    kept: Vec<Edge>,
    names: Names,
    words: Words,
    document: Document,
    chunk: usize,
}

/// How a function is documented, whose nodes are given.
type Document = fn(&Program, &Function, &[NodeId]) -> Vec<String>;

impl<'a> Emitter<'a> {
    fn new(program: &'a Program, chunk: usize) -> Self {
        let names = Names::new(program);
        Emitter::with(program, chunk, names, Words::rust(), docs::function)
    }

    fn with(
        program: &'a Program,
        chunk: usize,
        names: Names,
        words: Words,
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
        }
    }

    /// `fn constants`: everything that depends on parameters alone.
    fn constants(&self) -> Spec<'_> {
        let count = hamel_program::count::count_nodes(&self.program.graph, &self.schedule.hoisted);
        Spec {
            name: self.names.constants.clone(),
            public: false,
            docs: vec![
                "What depends on parameters alone.".into(),
                String::new(),
                docs::operations(count, ""),
            ],
            arguments: &[],
            shape: hamel_program::Shape::Vector(self.kept.len()),
            beside: None,
            outputs: self.kept.clone(),
            guards: Vec::new(),
            fallible: false,
            nodes: self.schedule.hoisted.clone(),
            time: Time::Parameters,
        }
    }

    /// A function that is called while the system moves.
    fn function(&self, index: usize, function: &'a Function) -> Spec<'a> {
        let guards = if function.fallible {
            function.guards.clone()
        } else {
            Vec::new()
        };
        let roots: Vec<Edge> = function.outputs.iter().chain(&guards).copied().collect();
        let nodes = self.program.graph.varying(&roots);
        Spec {
            name: self.names.functions[index].clone(),
            public: true,
            docs: (self.document)(self.program, function, &nodes),
            arguments: &function.arguments,
            shape: function.shape,
            beside: None,
            outputs: function.outputs.clone(),
            guards,
            fallible: function.fallible,
            nodes,
            time: Time::Call,
        }
    }

    fn specs(&self) -> Vec<Spec<'_>> {
        let functions = self.program.functions.iter().enumerate();
        let mut specs: Vec<Spec<'_>> = functions
            .map(|(index, function)| self.function(index, function))
            .collect();
        if !self.kept.is_empty() {
            specs.push(self.constants());
        }
        specs
    }
}

/// The generated type as items of Rust, without a file header.
pub fn rust(program: &Program, options: &Options) -> String {
    let emitter = Emitter::new(program, options.chunk);
    let mut methods = structure::sizes(&emitter);
    methods.push_str(&limits::constants(program));
    let system = system::implementation(&emitter);
    let together = together::of(&emitter).filter(|_| !system.is_empty());
    for (index, spec) in emitter.specs().iter().enumerate() {
        methods.push_str(&match &together {
            Some((place, both)) if *place == index => together::text(&emitter, spec, both),
            _ => function::text(&emitter, spec),
        });
    }
    methods.push_str(&parameters::accessors(&emitter));
    let mut text = structure::structure(&emitter);
    text.push_str(&externals::functions(&emitter));
    text.push_str(&views::parameters(&emitter));
    text.push_str(&views::state(&emitter, !system.is_empty()));
    text.push_str(&views::inputs(&emitter));
    text.push_str(structure::ALLOW);
    text.push_str(&format!(
        "impl{} {} {{\n{methods}}}\n",
        externals::generics(&emitter),
        externals::applied(&emitter)
    ));
    text.push_str(&structure::default(&emitter));
    if !system.is_empty() {
        text.push_str(&system);
        text.push_str(&methods::implementations(&emitter, together.is_some()));
    }
    text
}

/// The text of [`rust`], parsed.
///
/// # Errors
/// Where it is no Rust: an error in the generator.
pub fn tokens(program: &Program, options: &Options) -> Result<TokenStream, NotRust> {
    let text = rust(program, options);
    layout::parsed(&text)?;
    text.parse()
        .map_err(|error: proc_macro2::LexError| NotRust {
            why: error.to_string(),
            line: None,
        })
}

/// The text of [`rust`], formatted, below a header that says where it comes from.
///
/// # Errors
/// Where it is no Rust: an error in the generator.
#[cfg(feature = "files")]
pub fn file(program: &Program, options: &Options) -> Result<String, NotRust> {
    let text = layout::formatted(&rust(program, options))?;
    let mut header = format!(
        "// @generated by hamel-codegen {}; do not edit.\n// Input hash {:016x}.\n",
        env!("CARGO_PKG_VERSION"),
        options.source_hash
    );
    if !options.command.is_empty() {
        let command: Vec<&str> = options.command.split_whitespace().collect();
        let command = docs::spelled(&command.join(" "));
        header.push_str(&format!("// Regenerate with `{command}`.\n"));
    }
    Ok(format!("{header}\n{text}"))
}

/// Number of statements of all functions: the size of the generated code.
pub fn statements(program: &Program) -> usize {
    let emitter = Emitter::new(program, Options::default().chunk);
    let specs = emitter.specs();
    specs
        .iter()
        .map(|spec| function::lower(&emitter, spec).1.statements.len())
        .sum()
}
