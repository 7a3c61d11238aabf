//! `impl hamel::Split`, `hamel::Canonical` and `hamel::Tangent`, if all functions that they need are generated.

use super::{Emitter, externals, names, structure, system, together};
use hamel_algebra::graph::Edge;
use hamel_language::model::layout::Block;
use hamel_language::syntax::ast::ShapeKind;
use hamel_program::sparsity::Sparsity;
use hamel_program::structure::{Inertia, RotorForm, Symmetry};
use hamel_program::{Argument, FunctionId, Program, Shape};
use num_traits::{One, Zero};

/// Prints the implementations of `Split`, `Canonical` and `Tangent` for a type that implements `System`. `together`
/// tells whether one function computes both ξ̇ and [A B].
pub fn method_trait_implementations(emitter: &Emitter, together: bool) -> String {
    let all = [
        split(emitter),
        canonical(emitter),
        tangent(emitter, together),
    ];
    all.into_iter().flatten().collect()
}

/// Returns the generated name of a function, if it is generated.
fn generated<'a>(emitter: &'a Emitter, name: &str) -> Option<&'a str> {
    let functions = emitter.program.functions.iter();
    let index = functions.into_iter().position(|f| f.name == name)?;
    emitter.names.functions.get(index).map(String::as_str)
}

fn head(emitter: &Emitter, of: &str, body: &str) -> String {
    format!("{} {{\n{body}}}\n\n", impl_header(emitter, of))
}

/// Returns the first line of the implementation of a trait of `hamel`, with its attributes.
pub fn impl_header(emitter: &Emitter, of: &str) -> String {
    format!(
        "{}impl{} ::hamel::{of} for {}",
        structure::TRAIT_LINTS,
        externals::impl_generics(emitter),
        externals::type_with_arguments(emitter)
    )
}

fn split(emitter: &Emitter) -> Option<String> {
    let splitting = emitter.program.structure.split.as_ref().ok()?;
    let [momenta, velocities, kick] = [
        generated(emitter, "split_momenta")?,
        generated(emitter, "split_velocities")?,
        generated(emitter, "kick")?,
    ];
    // If no plain coordinate is shifted to a centre of mass, y = x.
    let moved = |name: &str, argument: &str| match generated(emitter, name) {
        Some(function) => format!("self.{function}({argument})"),
        None => format!("*{argument}"),
    };
    let (centre, uncentre) = (moved("centre", "x"), moved("uncentre", "y"));
    let rotors = rotors(emitter, &splitting.rotors)?;
    let body = format!(
        "type Rotors = [::hamel::Rotor<S>; {}];\n\nconst FREE: bool = {};\n\nfn rotors(&self) -> Self::Rotors {{\n{rotors}\n}}\n\n\
         fn centre(&self, x: &Self::Coordinates) -> Self::Coordinates {{\n{centre}\n}}\n\n\
         fn uncentre(&self, y: &Self::Coordinates) -> Self::Coordinates {{\n{uncentre}\n}}\n\n\
         fn split_momenta(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart {{\nself.{momenta}(x, xi)\n}}\n\n\
         fn split_velocities(&self, x: &Self::Coordinates, p: &Self::Chart) -> Self::Velocities {{\nself.{velocities}(x, p)\n}}\n\n\
         fn kick(&self, x: &Self::Coordinates, u: &Self::Inputs) -> Self::Chart {{\nself.{kick}(x, u)\n}}\n",
        splitting.rotors.len(),
        splitting.free,
    );
    Some(head(emitter, "Split", &body))
}

/// Returns the array of rotors, from the numbers of `rotor_inertia` and the known symmetry of each.
fn rotors(emitter: &Emitter, forms: &[RotorForm]) -> Option<String> {
    if forms.is_empty() {
        return Some("[]".into());
    }
    let inertia = generated(emitter, "rotor_inertia")?;
    let mut place = 0;
    let rotors = forms.iter().map(|form| {
        let j: Vec<String> = (place..place + form.inertia.entries())
            .map(|index| format!("j[{index}]"))
            .collect();
        place += j.len();
        match form.inertia {
            Inertia::Principal(symmetry) => {
                let symmetry = match symmetry {
                    Symmetry::Spherical => "Spherical".into(),
                    Symmetry::Axial(axis) => format!("Axial({axis})"),
                    Symmetry::None => "None".into(),
                };
                format!(
                    "::hamel::Rotor::principal([{}], ::hamel::rotor::Symmetry::{symmetry})",
                    j.join(", ")
                )
            }
            Inertia::Moments => format!("::hamel::Rotor::of_moments([{}])", j.join(", ")),
            Inertia::General => format!("::hamel::Rotor::general([{}])", j.join(", ")),
        }
    });
    let rotors: Vec<String> = rotors.collect();
    Some(format!(
        "let j = self.{inertia}();\n[{}]",
        rotors.join(", ")
    ))
}

fn canonical(emitter: &Emitter) -> Option<String> {
    let program = emitter.program;
    // With states z, ξ has entries that are not velocities, and so no momenta.
    if program.n_z > 0 {
        return None;
    }
    let [momentum, rate, velocity] = [
        generated(emitter, "momentum")?,
        generated(emitter, "momentum_rate")?,
        generated(emitter, "velocity_from_momentum")?,
    ];
    let fallible = program.function("velocity_from_momentum")?.fallible;
    let call = format!("self.{velocity}(x, p)");
    let call = if fallible {
        call
    } else {
        format!("::core::result::Result::Ok({call})")
    };
    let body = format!(
        "fn momentum(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Velocities {{\nself.{momentum}(x, xi)\n}}\n\n\
         fn momentum_rate(&self, x: &Self::Coordinates, xi: &Self::Velocities, u: &Self::Inputs) -> Self::Velocities {{\nself.{rate}(x, xi, u)\n}}\n\n\
         fn velocity_from_momentum(&self, x: &Self::Coordinates, p: &Self::Velocities) -> ::core::result::Result<Self::Velocities, ::hamel::Singular> {{\n{call}\n}}\n",
    );
    Some(head(emitter, "Canonical", &body))
}

/// Steps with slopes: the system in dual numbers, the frame of displacements, and the sparsity of a step in the chart.
fn tangent(emitter: &Emitter, together: bool) -> Option<String> {
    if !system::has_energies(emitter) {
        return None;
    }
    let program = emitter.program;
    let matrix = |id: FunctionId| match program.function(id)?.shape {
        Shape::Matrix(rows, columns) => Some((rows, columns)),
        _ => None,
    };
    let (rows, columns) = matrix(FunctionId::Linearize)?;
    let call = |id: FunctionId| -> Option<(String, String)> {
        let index = program.functions.iter().position(|f| f.id == Some(id))?;
        let arguments = &program.functions[index].arguments;
        let given = arguments
            .iter()
            .map(|&argument| names::argument_name(argument));
        let given = given.collect::<Vec<_>>().join(", ");
        let x = if arguments.is_empty() { "_" } else { "x" };
        let name = &emitter.names.functions[index];
        Some((x.to_string(), format!("self.{name}({given})")))
    };
    let table = |id: FunctionId, of: &str, name: &str| {
        let ((x, call), (rows, columns)) = (call(id)?, matrix(id)?);
        Some([
            format!("type {of} = [[S; {columns}]; {rows}];\n"),
            format!("\nfn {name}(&self, {x}: &Self::Coordinates) -> Self::{of} {{\n{call}\n}}\n"),
        ])
    };
    let [frame, frame_of] = table(FunctionId::DisplacementFrame, "Frame", "frame")?;
    let [coframe, coframe_of] = table(FunctionId::DisplacementCoframe, "Coframe", "coframe")?;
    let constant = "::hamel::Dual::constant";
    let fields = program.params.iter().zip(&emitter.names.fields);
    let fields = fields.map(|(group, field)| match group.shape {
        ShapeKind::Scalar => format!("{field}: {constant}(self.{field}),\n"),
        ShapeKind::Vector(_) => format!("{field}: self.{field}.map({constant}),\n"),
        _ => format!("{field}: self.{field}.map(|row| row.map({constant})),\n"),
    });
    let mut fields: String = fields.collect();
    if structure::has_constants_field(emitter) {
        let kept = &emitter.names.kept;
        fields += &format!("{kept}: self.{kept}.map({constant}),\n");
    }
    let number = format!("::hamel::Dual<S, {columns}>");
    let sparsity = Sparsity::of(program)?;
    let mut few = format!("::hamel::Dual<S, {}>", sparsity.directions());
    let mut generics = externals::impl_generics(emitter);
    if externals::has_externals(emitter) {
        // External functions take dual numbers, too, but of one length only.
        let names = &emitter.names.externals;
        let own = format!("{}<S>", names.of);
        generics = generics.replace(&own, &format!("{own} + {}<{number}>", names.of));
        fields += &format!("{0}: self.{0}.clone(),\n", names.field);
        few.clone_from(&number);
    }
    let of = externals::type_with_arguments(emitter);
    let [applied, compressed] =
        [&number, &few].map(|number| of.replacen("<S", &format!("<{number}"), 1));
    let name = &emitter.names.type_name;
    let slopes = slopes(emitter, together)?;
    // Whether the only constraints are those that the coordinate kinds themselves bring (such as unit length).
    let own: usize = program.blocks.iter().map(|block| block.constraints()).sum();
    let constraint = program.function(FunctionId::Constraint);
    let charted = constraint.is_none_or(|phi| phi.outputs.len() == own);
    let projection = [FunctionId::ProjectPosition, FunctionId::ProjectVelocity];
    let projected = projection.iter().any(|id| program.function(id).is_some());
    let plain = charted && !projected && plain(program);
    let list = |entries: &[usize]| {
        let entries: Vec<String> = entries.iter().map(usize::to_string).collect();
        format!("&[{}]", entries.join(", "))
    };
    let pattern = |rows: &[Vec<usize>]| {
        let rows: Vec<String> = rows.iter().map(|row| list(row)).collect();
        format!("&[{}]", rows.join(", "))
    };
    let sparsity = format!(
        "::hamel::Sparsity {{ frame: {}, coframe: {}, motion: {}, seeds: {} }}",
        pattern(&sparsity.frame),
        pattern(&sparsity.coframe),
        pattern(&sparsity.motion),
        list(&sparsity.seeds)
    );
    let body = format!(
        "const CHARTED: bool = {charted};\nconst PROJECTED: bool = {projected};\nconst PLAIN: bool = {plain};\n\nconst SPARSITY: ::hamel::Sparsity = {sparsity};\n\ntype Number = {number};\ntype Dual = {applied};\ntype CompressedNumber = {few};\ntype Compressed = {compressed};\n{frame}{coframe}\
         type Slopes = [[S; {columns}]; {rows}];\n\nfn dual(&self) -> Self::Dual {{\n{name} {{\n{fields}}}\n}}\n\nfn compressed(&self) -> Self::Compressed {{\n{name} {{\n{fields}}}\n}}\n{frame_of}{coframe_of}{slopes}"
    );
    Some(format!(
        "{}impl{generics} ::hamel::Tangent for {of} {{\n{body}}}\n\n",
        structure::TRAIT_LINTS
    ))
}

/// Whether all coordinates are plain numbers and the displacement frame is the identity, so that ẋ = ξ.
fn plain(program: &Program) -> bool {
    let flat = |block: &Block| matches!(block, Block::Flat(_));
    let Some(frame) = program.function(FunctionId::DisplacementFrame) else {
        return false;
    };
    let n = program.n;
    let entry = |(place, edge): (usize, &Edge)| {
        let number = program.graph.as_rational(*edge);
        number.is_some_and(|number| match place / n == place % n {
            true => number.is_one(),
            false => number.is_zero(),
        })
    };
    let identity = frame.shape == Shape::Matrix(n, n);
    let mut entries = frame.outputs.iter().enumerate();
    program.nu == n && program.blocks.iter().all(flat) && identity && entries.all(entry)
}

/// Prints `slopes`, the trait's method for ξ̇ and the linearization.
fn slopes(emitter: &Emitter, together: bool) -> Option<String> {
    let functions = &emitter.program.functions;
    let place = |id: FunctionId| functions.iter().position(|f| f.id == Some(id));
    let index = place(FunctionId::Linearize)?;
    let function = &functions[index];
    let argument = |argument: Argument, of: &str| {
        let name = match function.arguments.contains(&argument) {
            true => names::argument_name(argument),
            false => "_",
        };
        format!("{name}: &Self::{of}")
    };
    let arguments = [
        argument(Argument::Coordinates, "Coordinates"),
        argument(Argument::Velocities, "Velocities"),
        argument(Argument::Inputs, "Inputs"),
    ];
    let given = function.arguments.iter().map(|&a| names::argument_name(a));
    let given = given.collect::<Vec<_>>().join(", ");
    let call = |index: usize| format!("self.{}({given})", emitter.names.functions[index]);
    let (table, rates, fallible) = match together {
        true => {
            let both = format!("self.{}({given}, slopes)", together::PAIR_NAME);
            (String::new(), both, function.fallible)
        }
        false => {
            let accel = place(FunctionId::Accel)?;
            let question = if function.fallible { "?" } else { "" };
            let table = format!("*slopes = {}{question};\n", call(index));
            (table, call(accel), functions[accel].fallible)
        }
    };
    let body = match fallible {
        true => table + &rates,
        false => format!("{table}::core::result::Result::Ok({rates})"),
    };
    let arguments = arguments.join(", ");
    Some(format!(
        "\nfn slopes(&self, {arguments}, slopes: &mut Self::Slopes) -> ::core::result::Result<Self::Velocities, ::hamel::Singular> {{\n{body}\n}}\n"
    ))
}
