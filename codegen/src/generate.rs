//! Derives the program of a description; all front ends call this module.

use crate::algebra::graph::{Function, Graph, Node};
use crate::derive;
use crate::derive::assemble::assemble;
use crate::derive::reduction::{Reduction, dropped_row_warnings, reduce};
use crate::derive::regressor::Regressor;
use crate::diagnostics::Diagnostic;
use crate::emit::InvalidRust;
use crate::functions::{Asked, FunctionId, Needs};
use crate::inertia;
use crate::lower;
use crate::model::Model;
use crate::program::Program;
use crate::program::provenance::label_quantities;
use crate::proof;
use crate::syntax::{self, Places, ast};
#[cfg(feature = "files")]
use crate::tables::{self, Derivation, Table, TableError, Tables};
use proc_macro2::TokenStream;
use std::path::Path;

/// The derivation of a description.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The described system, in the full frame.
    pub model: Model,
    /// The system in the independent velocities that remain after constraints are solved, as used by states and
    /// functions.
    pub active: Model,
    /// Velocities that are expressed by others through constraints: pairs of an index in ξ of the full frame, and the
    /// index of the constraint.
    pub solved: Vec<(usize, usize)>,
    /// Its functions, proved.
    pub program: Program,
    /// Hash of the description's tokens, the same for all front ends.
    pub hash: u64,
    /// Text of the description; empty if it was read from tokens.
    pub text: String,
}

/// Number of further evaluation points that are tried if a proof fails at the first.
const READINGS: u64 = 6;

/// Derives the description in a token stream; errors have positions in the stream. Included files and tables in files
/// are read with `open`.
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

/// Returns the text of a file, given its name in a description.
pub type Open<'a> = dyn FnMut(&str) -> std::io::Result<String> + 'a;

/// Reads a text file.
///
/// # Errors
/// If it cannot be read or is not UTF-8; the message then contains the position of the first wrong byte.
pub fn text_of(path: &Path) -> std::io::Result<String> {
    String::from_utf8(std::fs::read(path)?).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        std::io::Error::other(format!("byte {place} is not UTF-8; save it as UTF-8"))
    })
}

/// Derives the description in a text; included files and tables in files are read with `open`.
#[cfg(feature = "files")]
pub fn from_file(text: &str, open: &mut Open<'_>) -> Result<Generated, Vec<Diagnostic>> {
    let mut system = syntax::parse_text(text)?;
    let texts = syntax::read_files(&mut system, open)?;
    let hash = fingerprint(&(canonical(text) + &texts.concat()));
    Ok(derive(&system, hash)?.described(text))
}

/// Derives the description of a robot as far as possible. If M is not positive definite, functions that need M⁻¹ are
/// left out; if nothing has inertia, all functions that need inertia. Then the error of the functions that are left out
/// is returned, too. This is for robots, whose files do not say which functions are wanted.
///
/// # Errors
/// Everything else that is wrong with the description.
#[cfg(feature = "files")]
pub fn available_in(system: &ast::System) -> Result<(Generated, Option<LeftOut>), Vec<Diagnostic>> {
    // The hash is that of the printed description, so that the code generated from it is the same.
    let text = syntax::print::print_description(system);
    let hash = fingerprint(&canonical(&text));
    let (generated, left_out) = at_some_point(system, |model| Generated::available(model, hash))?;
    Ok((generated.described(&text), left_out))
}

/// What was left out because M is not positive definite, or because nothing has inertia.
#[derive(Clone, Debug)]
pub struct LeftOut {
    /// Error that the functions left out would cause.
    pub error: Diagnostic,
    /// Names of the claims about the motion that are left out, and so not proved.
    pub claims: Vec<String>,
}

impl LeftOut {
    /// Returns the warning about what is left out.
    pub fn said(&self) -> String {
        let mut said = match self.error.lacking {
            Some(Needs::Inertia) => {
                "the system has no inertia; functions that need it, such as `accel`, are not generated"
                    .into()
            }
            _ => format!(
                "{}; functions that need its inverse, such as `accel`, are not generated",
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
    Ok(derive(system, fingerprint(&canonical(text)))?.described(text))
}

#[cfg(feature = "files")]
fn canonical(text: &str) -> String {
    let tokens = text.parse::<TokenStream>();
    tokens.map_or_else(|_| String::new(), |tokens| syntax::canonical(&tokens))
}

fn derive(system: &ast::System, hash: u64) -> Result<Generated, Vec<Diagnostic>> {
    at_some_point(system, |model| Generated::of(model, hash))
}

/// Builds the model of a description, and derives something from it.
///
/// If √(e²) happens to have the value of e in both prime fields, and e is positive at the real sample points, the graph
/// merges the two into one node. This is right for real numbers, but at other points of the fields the root is −e, and
/// the proof fails. Such a description is built again at another point.
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

/// Whether a graph contains square roots of expressions that are not numbers.
fn has_roots(graph: &Graph) -> bool {
    let is_root = |id: u32| match graph.node(id) {
        Node::Apply(Function::Sqrt, square) => graph.class(square.node()) != 0,
        _ => false,
    };
    (0..graph.len() as u32).any(is_root)
}

impl Generated {
    /// Sets the text of the description.
    #[cfg(feature = "files")]
    fn described(self, text: &str) -> Self {
        Generated {
            text: text.into(),
            ..self
        }
    }

    /// Derives a model, and refuses false claims.
    pub fn of(model: Model, hash: u64) -> Result<Self, Vec<Diagnostic>> {
        let linearized = model.asked.names(FunctionId::Linearize);
        Generated::with(model, hash, linearized)
    }

    /// Derives all functions of a model, including the linearisation, whatever `generate` says.
    pub fn all(mut model: Model, hash: u64) -> Result<Self, Vec<Diagnostic>> {
        model.asked = Asked::everything();
        model.asked.functions.push(FunctionId::Linearize);
        Generated::with(model, hash, true)
    }

    /// Derives the functions that a model asks for, as far as they are available. If M is not positive definite,
    /// functions that need M⁻¹ are left out; if nothing has inertia, all functions that need inertia. Claims about the
    /// motion are then left out as well, and everything left out is returned.
    ///
    /// # Errors
    /// Everything else that is wrong, or if no function remains.
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
        // Nothing can be claimed about a motion that is not determined.
        let claims = std::mem::take(&mut model.invariants).into_iter();
        let left_out = LeftOut {
            error: error.clone(),
            claims: claims.map(|claim| claim.name).collect(),
        };
        Ok((Generated::of(model, hash)?, Some(left_out)))
    }

    /// Derives tables of coefficients. If none is requested: all of [`Table::DEFAULT`] that the system has.
    ///
    /// # Errors
    /// If a table is not available, with the reason.
    #[cfg(feature = "files")]
    pub fn tables(&self, asked: &[Table]) -> Result<Tables, TableError> {
        let derivation = Derivation {
            model: &self.model,
            active: &self.active,
            program: &self.program,
        };
        tables::tables(derivation, asked)
    }

    /// Returns the error for generated text that is not valid Rust.
    pub fn fault(&self, error: &InvalidRust) -> Diagnostic {
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
        label_quantities(&mut model);
        let claims = model.invariants.iter().map(|claim| claim.name.as_str());
        let lacking = inertia::lacking(model.span, model.has_inertia, &model.asked, claims);
        lacking.map_or(Ok(()), |error| Err(vec![error]))?;
        let reduction = reduce(&model).map_err(|error| vec![error])?;
        let dropped = reduction.iter().flat_map(|reduction| &reduction.dropped);
        for &row in dropped.clone() {
            model.constraints[row].redundant = true;
        }
        let dropped: Vec<usize> = dropped.copied().collect();
        let warnings = dropped_row_warnings(&model.constraints, &dropped);
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
            text: String::new(),
        })
    }
}

/// Derives and proves a program with ξ̇ alone, for claims about a constrained motion if the system's own program has no
/// ξ̇: which claims can be made does not depend on the requested functions.
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

/// Derives the regressor and base parameters of a model, if they are requested.
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

/// Returns an error if a function of the program needs second derivatives of an external function, which has none.
fn curved(model: &Model, program: &Program) -> Option<Diagnostic> {
    let graph = &program.graph;
    for function in &program.functions {
        let Some((component, _)) = graph.find_external(&function.outputs, 2) else {
            continue;
        };
        let place = usize::from(component.function);
        let name = &graph.externals().get(place)?.name;
        let message = format!(
            "`{}` needs second derivatives of `{name}`, a function in Rust that has only first derivatives",
            function.name
        );
        let span = model.externals.get(place).copied().unwrap_or(model.span);
        return Some(Diagnostic::new(span, message).help(
            "remove the rate of the function, or write the function as an expression or a `table`",
        ));
    }
    None
}

/// Returns the 64-bit FNV-1a hash of a text.
fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
