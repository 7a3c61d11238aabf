//! From a description to its program: what all front ends call.

use crate::algebra::graph::{Function, Graph, Node};
use crate::derive;
use crate::derive::assemble::assemble;
use crate::derive::reduction::{Reduction, reduce, warnings};
use crate::derive::regressor::Regressor;
use crate::diagnostics::Diagnostic;
use crate::emit::NotRust;
use crate::functions::{Asked, FunctionId, Needs};
use crate::inertia;
use crate::lower;
use crate::model::Model;
use crate::program::Program;
use crate::proof;
use crate::syntax::{self, Places, ast};
use crate::tables::{self, Derivation, Table, Tables};
use proc_macro2::TokenStream;
use std::path::Path;

/// A description, read and derived.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The system that it describes, in the full frame.
    pub model: Model,
    /// The same in the velocities that constraints leave: what states and functions are about.
    pub active: Model,
    /// The velocities that constraints give by others: places in ξ of the full frame, each with that of its
    /// constraint.
    pub solved: Vec<(usize, usize)>,
    /// Its functions, validated.
    pub program: Program,
    /// Hash of the description's tokens: the same through every front end.
    pub hash: u64,
}

/// Points that are tried after the first.
const READINGS: u64 = 6;

/// Derives the description in a stream of tokens; errors are at places of these. What it includes and tables in files
/// are opened as `open` says.
pub fn from_tokens(
    tokens: TokenStream,
    open: &mut Open<'_>,
) -> (Places, Result<Generated, Vec<Diagnostic>>) {
    let canonical = syntax::canonical(&tokens);
    let (places, system) = syntax::parse_tokens(tokens);
    let generated = system.and_then(|mut system| {
        let texts = syntax::read_files(&mut system, open)?;
        derive(&system, fingerprint(&(canonical + &texts.concat())))
    });
    (places, generated)
}

/// Gives the text of a file by the name that a description has for it.
pub type Open<'a> = dyn FnMut(&str) -> std::io::Result<String> + 'a;

/// The text of a file.
///
/// # Errors
/// Where it cannot be read, or is no text; the message says from which byte on.
pub fn text_of(path: &Path) -> std::io::Result<String> {
    String::from_utf8(std::fs::read(path)?).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        std::io::Error::other(format!("byte {place} is not UTF-8; save it as UTF-8"))
    })
}

/// Derives the description in a text; what it includes and its tables in files are opened as `open` says.
#[cfg(feature = "files")]
pub fn from_file(text: &str, open: &mut Open<'_>) -> Result<Generated, Vec<Diagnostic>> {
    let mut system = syntax::parse_text(text)?;
    let texts = syntax::read_files(&mut system, open)?;
    derive(&system, fingerprint(&(canonical(text) + &texts.concat())))
}

/// The same but for functions with M⁻¹ in them where M is not positive definite, and for all that need inertia where there
/// is none; then the error that they would have is returned, too. Robots say what they are, and not what is wanted of them.
///
/// # Errors
/// What is wrong with the description beyond that.
#[cfg(feature = "files")]
pub fn available_in(text: &str) -> Result<(Generated, Option<LeftOut>), Vec<Diagnostic>> {
    let mut system = syntax::parse_text(text)?;
    system.starts_anywhere = true;
    let hash = fingerprint(&canonical(text));
    at_some_point(&system, |model| Generated::available(model, hash))
}

/// What is left out where M is not positive definite, or nothing has inertia.
#[derive(Clone, Debug)]
pub struct LeftOut {
    /// The error that the functions which are left out would have.
    pub error: Diagnostic,
    /// Claims about the motion that are not proved.
    pub claims: Vec<String>,
}

impl LeftOut {
    /// A warning.
    pub fn said(&self) -> String {
        let mut said = match self.error.lacking {
            Some(Needs::Inertia) => {
                "the system has no inertia; functions that need it, such as `accel`, are not there"
                    .into()
            }
            _ => format!(
                "{}; functions that need its inverse, such as `accel`, are not there",
                self.error.message
            ),
        };
        if !self.claims.is_empty() {
            let claims: Vec<String> = self.claims.iter().map(|name| format!("`{name}`")).collect();
            said.push_str(&format!(", and no claim is proved: {}", claims.join(", ")));
        }
        said
    }
}

/// Derives the description in a text.
#[cfg(feature = "files")]
pub fn from_text(text: &str) -> Result<Generated, Vec<Diagnostic>> {
    of_system(&syntax::parse_text(text)?, text)
}

/// Derives a description that was parsed from a text.
#[cfg(feature = "files")]
pub(crate) fn of_system(system: &ast::System, text: &str) -> Result<Generated, Vec<Diagnostic>> {
    derive(system, fingerprint(&canonical(text)))
}

#[cfg(feature = "files")]
fn canonical(text: &str) -> String {
    let tokens = text.parse::<TokenStream>();
    tokens.map_or_else(|_| String::new(), |tokens| syntax::canonical(&tokens))
}

fn derive(system: &ast::System, hash: u64) -> Result<Generated, Vec<Diagnostic>> {
    at_some_point(system, |model| Generated::of(model, hash))
}

/// Reads a description, and derives something of its model.
///
/// Where √(e²) happens to have the value of e in both fields, and e is positive at real points, the two are one
/// node, which is right; but at other points the root is −e, and the proof fails. Such a description is read
/// anew at another point.
pub fn at_some_point<T>(
    system: &ast::System,
    derive: impl Fn(Model) -> Result<T, Vec<Diagnostic>>,
) -> Result<T, Vec<Diagnostic>> {
    let mut reading = 0;
    loop {
        let model = lower::build_at(system, reading)?;
        let rooted = has_roots(&model.graph);
        match derive(model) {
            Err(errors) if rooted && reading < READINGS && errors.iter().any(|e| e.unproved) => {
                reading += 1;
            }
            derived => return derived,
        }
    }
}

/// Whether there are square roots of what is no number.
fn has_roots(graph: &Graph) -> bool {
    let is_root = |id: u32| match graph.node(id) {
        Node::Apply(Function::Sqrt, square) => graph.class(square.node()) != 0,
        _ => false,
    };
    (0..graph.len() as u32).any(is_root)
}

impl Generated {
    /// Derives a model, and refuses what it claims falsely.
    pub fn of(model: Model, hash: u64) -> Result<Self, Vec<Diagnostic>> {
        let linearized = model.asked.names(FunctionId::Linearize);
        Generated::with(model, hash, linearized)
    }

    /// Derives all functions of a model, the linearisation among them, whatever `generate` says.
    pub fn all(mut model: Model, hash: u64) -> Result<Self, Vec<Diagnostic>> {
        model.asked = Asked::everything();
        model.asked.functions.push(FunctionId::Linearize);
        Generated::with(model, hash, true)
    }

    /// Derives what a model is asked for or, where M is not positive definite, all of that but the
    /// functions with M⁻¹ in them; where nothing has inertia, all but what needs it. Then claims about the motion are
    /// left out as well, and what is left out is returned, too.
    ///
    /// # Errors
    /// What is wrong beyond that, or where nothing remains.
    pub fn available(
        mut model: Model,
        hash: u64,
    ) -> Result<(Self, Option<LeftOut>), Vec<Diagnostic>> {
        let errors = match Generated::of(model.clone(), hash) {
            Ok(generated) => return Ok((generated, None)),
            Err(errors) => errors,
        };
        let [error] = errors.as_slice() else {
            return Err(errors);
        };
        let Some(lacking) = error.lacking else {
            return Err(errors);
        };
        model.asked = model.asked.without(lacking);
        // Nothing can be claimed of a motion that is not determined.
        let claims = std::mem::take(&mut model.invariants).into_iter();
        let left_out = LeftOut {
            error: error.clone(),
            claims: claims.map(|claim| claim.name).collect(),
        };
        Ok((Generated::of(model, hash)?, Some(left_out)))
    }

    /// Tables of coefficients: all of [`Table::DEFAULT`] that the system has where none is named.
    ///
    /// # Errors
    /// Which table cannot be had, and why.
    pub fn tables(&self, asked: &[Table]) -> Result<Tables, String> {
        let derivation = Derivation {
            model: &self.model,
            active: &self.active,
            program: &self.program,
        };
        tables::tables(derivation, asked)
    }

    /// What is said where the generated text is no Rust.
    pub fn fault(&self, error: &NotRust) -> Diagnostic {
        let name = &self.model.name;
        let message = format!("internal check failed for `{name}`: {error}");
        Diagnostic::new(self.model.span, message).help(
            "nothing was written; this is an error in hamel: please report it with the description",
        )
    }

    fn with(model: Model, hash: u64, linearized: bool) -> Result<Self, Vec<Diagnostic>> {
        let origins = model.origins.clone();
        let generated = Generated::proved(model, hash, linearized);
        generated.map_err(|errors| origins.located_all(errors))
    }

    fn proved(mut model: Model, hash: u64, linearized: bool) -> Result<Self, Vec<Diagnostic>> {
        let claims = model.invariants.iter().map(|claim| claim.name.as_str());
        let lacking = inertia::lacking(model.span, model.has_inertia, &model.asked, claims);
        lacking.map_or(Ok(()), |error| Err(vec![error]))?;
        let reduction = reduce(&model).map_err(|error| vec![error])?;
        let dropped = reduction.iter().flat_map(|reduction| &reduction.dropped);
        for &row in dropped.clone() {
            model.constraints[row].redundant = true;
        }
        let dropped: Vec<usize> = dropped.copied().collect();
        let warnings = warnings(&model.constraints, &dropped);
        let warnings = model.origins.located_all(warnings);
        model.warnings.extend(warnings);
        let regressor = regressor(&model).map_err(|error| vec![error])?;
        let program = assemble(&model, reduction.as_ref(), regressor.as_ref(), linearized);
        let program = program.map_err(|error| vec![error])?;
        curved(&model, &program).map_or(Ok(()), |error| Err(vec![error]))?;
        let motion = moving(&model, reduction.as_ref(), &program)?;
        let motion = motion.as_ref().unwrap_or(&program);
        let regressor = regressor.as_ref();
        proof::prove(&model, reduction.as_ref(), regressor, [&program, motion])?;
        let solved = reduction.as_ref().map_or(Vec::new(), |reduction| {
            reduction
                .solved
                .iter()
                .map(|&(row, velocity)| (velocity, row))
                .collect()
        });
        Ok(Generated {
            solved,
            active: reduction.map_or_else(|| model.clone(), |reduction| reduction.model),
            model,
            program,
            hash,
        })
    }
}

/// ξ̇ alone, proved, for claims about a constrained motion of a program that has no ξ̇: what is asked for does not decide what
/// can be claimed.
fn moving(
    model: &Model,
    reduction: Option<&Reduction>,
    program: &Program,
) -> Result<Option<Program>, Vec<Diagnostic>> {
    let Some(reduction) = reduction else {
        return Ok(None);
    };
    if model.invariants.is_empty() || program.xi_dot().is_some() {
        return Ok(None);
    }
    let (mut model, mut reduction) = (model.clone(), reduction.clone());
    for model in [&mut model, &mut reduction.model] {
        model.asked = Asked::only(&[FunctionId::Accel]);
        model.outputs.clear();
        model.invariants.clear();
    }
    let one = |error| vec![error];
    let program = assemble(&model, Some(&reduction), None, false).map_err(one)?;
    proof::prove(&model, Some(&reduction), None, [&program; 2])?;
    Ok(Some(program))
}

/// The base parameters of a model, where they are asked for.
fn regressor(model: &Model) -> Result<Option<Regressor>, Diagnostic> {
    let asked = [FunctionId::Regressor, FunctionId::BaseParameters];
    if !asked.iter().any(|&id| model.asked.names(id)) {
        return Ok(None);
    }
    derive::regressor::regressor(model)
        .map(Some)
        .map_err(|why| {
            let message = format!("`{}` has no regressor: {why}", model.name);
            Diagnostic::new(model.span, message).help("leave `regressor` out of `generate`")
        })
}

/// What is wrong where a function of the program needs slopes of slopes of a function in Rust, which has none.
fn curved(model: &Model, program: &Program) -> Option<Diagnostic> {
    let graph = &program.graph;
    for function in &program.functions {
        let Some((component, _)) = graph.find_external(&function.outputs, 2) else {
            continue;
        };
        let place = usize::from(component.function);
        let name = &graph.externals().get(place)?.name;
        let message = format!(
            "`{}` needs second derivatives of `{name}`, a function in Rust that has the first ones",
            function.name
        );
        let span = model.externals.get(place).copied().unwrap_or(model.span);
        return Some(Diagnostic::new(span, message).help(
            "leave out what is a rate of the function, or write it as an expression or a `table`",
        ));
    }
    None
}

/// FNV-1a, 64 bits.
fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
