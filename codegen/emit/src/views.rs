//! Access by name: structures with the parameters, with x and ξ, and with the inputs of a generated type, and their
//! conversions to the arrays that its functions take.
//!
//! | type | contents | `default` |
//! |---|---|---|
//! | `NameParameters<S>` | the argument of `new` | parameters of the description |
//! | `NameState<S>` | x, ξ, and the states after ξ | initial state of the description |
//! | `NameInputs<S>` | u | zeros |

use super::names::{UniqueNames, to_distinct_snake_case};
use super::parameters::{group_type, shaped_expression};
use super::structure::{FUNCTION_LINTS, TRAIT_LINTS, TYPE_LINTS};
use super::{Emitter, docs, externals, number};
use hamel_language::model::{Coordinate, Group};
use hamel_language::syntax::ast::{CoordKind, ShapeKind};
use hamel_program::Program;

/// A field of a generated structure: a named range of entries of x, ξ, u or the parameters.
pub struct NamedRange {
    /// Its name in the generated text.
    pub name: String,
    /// Text of its doc comment.
    pub docs: String,
    /// Its shape.
    pub shape: ShapeKind,
    /// The array.
    pub array: &'static str,
    /// Index of its first entry in the array.
    pub offset: usize,
}

impl NamedRange {
    /// Returns the number of its entries.
    pub fn length(&self) -> usize {
        match self.shape {
            ShapeKind::Scalar => 1,
            ShapeKind::Vector(n) => n,
            ShapeKind::Matrix(n) => n * n,
            ShapeKind::Symmetric(n) => n * (n + 1) / 2,
        }
    }

    /// Returns its value; `entry` returns an entry by its index in the array.
    fn value(&self, entry: impl Fn(usize) -> String) -> String {
        shaped_expression(self.shape, |i, j| {
            entry(
                self.offset
                    + match self.shape {
                        ShapeKind::Matrix(n) => n * i + j,
                        ShapeKind::Symmetric(n) => symmetric_entry(n, i.min(j), i.max(j)),
                        ShapeKind::Scalar | ShapeKind::Vector(_) => j,
                    },
            )
        })
    }

    /// Returns its entries in the order of the array, as expressions.
    fn entries(&self) -> Vec<String> {
        let indices = super::parameters::index_expressions(self.shape).into_iter();
        let name = &self.name;
        indices.map(|index| format!("self.{name}{index}")).collect()
    }
}

/// Returns the fields of groups of symbols.
fn groups(groups: &[Group], what: &str, array: &'static str) -> Vec<(String, NamedRange)> {
    let field = |group: &Group| {
        let field = NamedRange {
            name: String::new(),
            docs: format!(
                "{what} {}, {}.",
                group.quoted(),
                docs::shape_in_words(group.shape)
            ),
            shape: group.shape,
            array,
            offset: group.offset,
        };
        (group.name.clone(), field)
    };
    groups.iter().map(field).collect()
}

/// Returns the fields of a coordinate: one, or two for a pose, namely its position and its rotation.
fn coordinate(coordinate: &Coordinate) -> Vec<(String, NamedRange)> {
    let Coordinate {
        name, kind, offset, ..
    } = coordinate;
    let field = |suffix: &str, shape: ShapeKind, what: &str, behind: usize| {
        let field = NamedRange {
            name: String::new(),
            docs: format!("Coordinate `{name}`{what}."),
            shape,
            array: "x",
            offset: offset + behind,
        };
        (format!("{name}{suffix}"), field)
    };
    match *kind {
        CoordKind::Real => vec![field("", ShapeKind::Scalar, "", 0)],
        CoordKind::Euclidean(n) => vec![field("", ShapeKind::Vector(n), "", 0)],
        CoordKind::S1 => vec![field("", ShapeKind::Vector(2), ": cosine and sine", 0)],
        CoordKind::S3 => vec![field(
            "",
            ShapeKind::Vector(4),
            ", a unit quaternion, scalar first",
            0,
        )],
        CoordKind::SO3 => vec![field(
            "",
            ShapeKind::Matrix(3),
            ", a rotation matrix by rows",
            0,
        )],
        CoordKind::SE3 => vec![
            field("_p", ShapeKind::Vector(3), ": its position", 0),
            field(
                "_R",
                ShapeKind::Matrix(3),
                ": its rotation matrix by rows",
                3,
            ),
        ],
    }
}

/// Gives the fields their names in Rust.
fn named(fields: Vec<(String, NamedRange)>) -> Vec<NamedRange> {
    let written: Vec<&str> = fields.iter().map(|(name, _)| name.as_str()).collect();
    let names = to_distinct_snake_case(&written);
    let mut unique = UniqueNames::default();
    let fields = fields.into_iter().zip(names);
    let field = |((_, field), name): ((String, NamedRange), String)| NamedRange {
        name: unique.claim(&name),
        ..field
    };
    fields.map(field).collect()
}

/// A structure with its documentation and its default.
struct View<'a> {
    name: String,
    docs: String,
    default: &'a str,
    fields: &'a [NamedRange],
}

impl View<'_> {
    /// Prints the structure and its `Default`.
    fn text(&self, public: &str, value: impl Fn(&NamedRange, usize) -> String) -> String {
        let View {
            name,
            docs,
            default,
            fields,
        } = self;
        let field = |field: &NamedRange| {
            let of = group_type(field.shape);
            format!(
                "/// {}\npub {}: {of},\n",
                docs::escape_bidi_controls(&field.docs),
                field.name
            )
        };
        let list: String = fields.iter().map(field).collect();
        let values = fields.iter().map(|field| {
            let value = field.value(|place| value(field, place));
            format!("{}: {value}", field.name)
        });
        let values: Vec<String> = values.collect();
        format!(
            "{docs}{TYPE_LINTS}#[derive(Clone, Copy, Debug, PartialEq)]\n{public}struct {name}<S = f64> {{\n{list}}}\n\n\
             {TRAIT_LINTS}impl<S: ::hamel::Scalar> ::core::default::Default for {name}<S> {{\n/// {default}\nfn default() -> Self {{\nSelf {{ {} }}\n}}\n}}\n\n",
            values.join(", ")
        )
    }
}

fn public(program: &Program) -> &'static str {
    if program.public { "pub " } else { "" }
}

/// Prints the Rust structure `NameParameters` with a field for each parameter; empty if there are none.
pub fn print_parameter_struct(emitter: &Emitter) -> String {
    let program = emitter.program;
    if program.params.is_empty() {
        return String::new();
    }
    let fields = groups(&program.params, "Parameter", "");
    let fields: Vec<NamedRange> = (fields.into_iter().zip(&emitter.names.fields))
        .map(|((_, field), name)| NamedRange {
            name: name.clone(),
            ..field
        })
        .collect();
    let of = &emitter.names.type_name;
    let symmetric = |group: &Group| matches!(group.shape, ShapeKind::Symmetric(_));
    let mut lines = vec![format!("The parameters of `{of}`, by name.")];
    if program.params.iter().any(symmetric) {
        lines.extend([
            String::new(),
            "Of symmetric matrices only the upper triangle is read.".into(),
        ]);
    }
    let view = View {
        name: format!("{of}Parameters"),
        docs: docs::doc_comment(&lines),
        default: "The parameters of the description.",
        fields: &fields,
    };
    view.text(public(program), |_, place| {
        number::scalar_expression(program.defaults.get(place).copied().unwrap_or_default())
    })
}

/// Prints the Rust structure `NameState` with a field for each coordinate and velocity; `system` tells whether the type
/// implements `System`.
pub fn print_state_struct(emitter: &Emitter, system: bool) -> String {
    let program = emitter.program;
    let of = &emitter.names.type_name;
    let fields = state_fields(program);
    let name = format!("{of}State");
    let view = View {
        name: name.clone(),
        docs: docs::doc_comment(&[format!(
            "A state of `{of}`: coordinates and velocities by name."
        )]),
        default: "The start of the description.",
        fields: &fields,
    };
    let mut text = view.text(public(program), |field, place| {
        let start = match field.array {
            "x" => &program.start_x,
            _ => &program.start_xi,
        };
        number::scalar_expression(start.get(place).copied().unwrap_or_default())
    });
    let (nu, n) = (program.nu, program.n + program.n_z);
    let entries = |array: &str| {
        let fields = fields.iter().filter(|field| field.array == array);
        fields
            .flat_map(NamedRange::entries)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let values: Vec<String> = fields
        .iter()
        .map(|field| {
            let value = field.value(|place| format!("{}[{place}]", field.array));
            format!("{}: {value}", field.name)
        })
        .collect();
    let mut ranges = UniqueNames::default();
    let ranges: String = fields
        .iter()
        .map(|field| {
            let name = ranges.claim(&field.name.to_ascii_uppercase());
            let (from, to) = (field.offset, field.offset + field.length());
            format!(
                "/// The place of `{}` in `{}`.\npub const {name}: ::core::ops::Range<usize> = {from}..{to};\n\n",
                field.name, field.array
            )
        })
        .collect();
    text.push_str(&format!(
        "{}impl<S: ::hamel::Scalar> {name}<S> {{\n{ranges}/// The state that x and ξ are.\n#[must_use]\npub fn from_arrays(x: &[S; {nu}], xi: &[S; {n}]) -> Self {{\nSelf {{ {} }}\n}}\n\n\
         /// x and ξ, as the functions of `{of}` take them.\n#[must_use]\npub fn to_arrays(&self) -> ([S; {nu}], [S; {n}]) {{\n([{}], [{}])\n}}\n}}\n\n",
        FUNCTION_LINTS,
        values.join(", "),
        entries("x"),
        entries("xi"),
    ));
    if system {
        let (generics, of) = (
            externals::impl_generics(emitter),
            externals::type_with_arguments(emitter),
        );
        text.push_str(&format!(
            "{TRAIT_LINTS}impl{generics} ::core::convert::From<{name}<S>> for ::hamel::State<{of}> {{\n/// The state at t = 0.\nfn from(state: {name}<S>) -> Self {{\nlet (x, xi) = state.to_arrays();\nSelf {{ t: 0.0, x, xi }}\n}}\n}}\n\n\
             {TRAIT_LINTS}impl{generics} ::core::convert::From<&::hamel::State<{of}>> for {name}<S> {{\nfn from(state: &::hamel::State<{of}>) -> Self {{\nSelf::from_arrays(&state.x, &state.xi)\n}}\n}}\n\n"
        ));
    }
    text
}

/// Returns the entries of x and ξ by name; the states z are part of ξ.
pub fn state_fields(program: &Program) -> Vec<NamedRange> {
    let mut fields: Vec<(String, NamedRange)> =
        program.coordinates.iter().flat_map(coordinate).collect();
    fields.extend(groups(&program.velocities, "Velocity", "xi"));
    fields.extend(groups(
        &hamel_language::model::behind(&program.states, program.n),
        "State",
        "xi",
    ));
    named(fields)
}

/// Returns the entries of u by name.
pub fn input_fields(program: &Program) -> Vec<NamedRange> {
    named(groups(&program.inputs, "Input", "u"))
}

/// Prints the Rust structure `NameInputs` with a field for each input; empty if there are none.
pub fn print_input_struct(emitter: &Emitter) -> String {
    let program = emitter.program;
    if program.inputs.is_empty() {
        return String::new();
    }
    let of = &emitter.names.type_name;
    let fields = input_fields(program);
    let name = format!("{of}Inputs");
    let view = View {
        name: name.clone(),
        docs: docs::doc_comment(&[format!("The inputs of `{of}`, by name.")]),
        default: "No input: zeros.",
        fields: &fields,
    };
    let mut text = view.text(public(program), |_, _| "S::default()".into());
    let m = program.m;
    let entries: Vec<String> = fields.iter().flat_map(NamedRange::entries).collect();
    let values = fields.iter().map(|field| {
        let value = field.value(|place| format!("u[{place}]"));
        format!("{}: {value}", field.name)
    });
    let values: Vec<String> = values.collect();
    text.push_str(&format!(
        "{}impl<S: ::hamel::Scalar> {name}<S> {{\n/// The inputs that u is.\n#[must_use]\npub fn from_array(u: &[S; {m}]) -> Self {{\nSelf {{ {} }}\n}}\n\n\
         /// u, as the functions of `{of}` take it.\n#[must_use]\npub fn to_array(&self) -> [S; {m}] {{\n[{}]\n}}\n}}\n\n",
        FUNCTION_LINTS,
        values.join(", "),
        entries.join(", "),
    ));
    text
}

/// Index of entry (i, j), i ≤ j, of a symmetric matrix among the entries on and above its diagonal, row by row.
fn symmetric_entry(n: usize, i: usize, j: usize) -> usize {
    i * n - i * (i + 1) / 2 + j
}
