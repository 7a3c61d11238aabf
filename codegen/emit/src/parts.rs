//! A long function as a sequence of calls: its parts share one array of slots and write the results.

use super::function::{
    FunctionSpec, PreparedFunction, SLOPES_ARGUMENT, print_statements, shape_type, zero_of_shape,
};
use super::language::{Language, Rust, SharedArray};
use super::names;
use super::print::{ArrayAccess, UsedNames};
use hamel_algebra::graph::NodeId;
use hamel_program::Shape;
use hamel_program::places::Place;
use rustc_hash::FxHashMap;

/// Number of statements above which the parts of a function are never inlined: this compiles fastest, and a
/// call costs little compared with a part.
const INLINE: usize = 2000;

impl PreparedFunction<'_> {
    /// Returns the text of the function in parts: one function for each part, then the function that calls them.
    pub fn print_in_parts(&self) -> String {
        let FunctionSpec { name, .. } = self.spec;
        let entries = self.spec.shape.entries();
        let inline = if self.body.statements.len() > INLINE {
            "#[inline(never)]\n"
        } else {
            "#[inline]\n"
        };
        let mut targets: FxHashMap<NodeId, Vec<usize>> = FxHashMap::default();
        let mut rest = Vec::new();
        for (index, edge) in self.body.outputs.iter().enumerate() {
            match self.emitter.places.of(edge.node(), self.spec.time) {
                Place::Temporary => targets.entry(edge.node()).or_default().push(index),
                _ => rest.push(index),
            }
        }
        let mut main = self.printer();
        let (mut parts, mut calls) = (String::new(), String::new());
        let mut crossing = false;
        for (index, part) in self.plan.parts.iter().enumerate() {
            let mut printer = self.printer();
            let text = print_statements(&mut printer, self.body, part, |printer, node| {
                let indices = targets.get(&node).map_or(&[][..], Vec::as_slice);
                let writes = indices.iter().map(|&index| {
                    let (array, _, place) = self.spec.result_place(index);
                    printer
                        .used
                        .record_shared_access(array, place, ArrayAccess::Written);
                    let value = printer.signed_value(self.body.outputs[index]);
                    format!("{} = {value};\n", target(self.spec, index, true))
                });
                writes.collect()
            });
            let used = printer.used;
            crossing |= used.access(SharedArray::Slots) > ArrayAccess::None;
            let part_name = self.emitter.names.part_name(name, index + 1);
            let (arguments, values) = self.part_arguments(&used);
            let (result, end) = match used.checks {
                true => (
                    "-> ::core::result::Result<(), ::hamel::Singular> ",
                    "::core::result::Result::Ok(())\n",
                ),
                false => ("", ""),
            };
            let kept = self.bind_kept(&used);
            parts.push_str(&format!(
                "/// Part {} of {} of `{name}`.\n{inline}fn {part_name}({arguments}) {result}{{\n{kept}{text}{end}}}\n\n",
                index + 1,
                self.plan.parts.len(),
            ));
            let question = if used.checks { "?" } else { "" };
            calls.push_str(&format!("self.{part_name}({values}){question};\n"));
        }
        let mut text = String::new();
        if crossing {
            text.push_str(&format!(
                "let mut slots = [S::default(); {}];\n",
                self.plan.size
            ));
        }
        let zero = self.emitter.program.graph.zero();
        let written = self.body.outputs.iter().take(entries);
        let mutable = match written.clone().any(|&output| output != zero) {
            true => "mut ",
            false => "",
        };
        text.push_str(&format!(
            "let {mutable}out = {};\n",
            zero_of_shape(self.spec.shape)
        ));
        if let Some(shape) = self.spec.beside {
            text.push_str(&self.cleared(shape));
        }
        text.push_str(&calls);
        for index in rest
            .into_iter()
            .filter(|&index| self.body.outputs[index] != zero)
        {
            let value = main.result_expression(self.body.outputs[index]);
            text.push_str(&format!("{} = {value};\n", target(self.spec, index, false)));
        }
        let kept = self.bind_kept(&main.used);
        let body = format!("{kept}{text}{}", self.final_expression("out"));
        parts + &self.print_with_body(&body)
    }

    /// Clears the argument `slopes`. A function in short parts clears only the entries that stay zero: this is more
    /// code, but it writes less.
    fn cleared(&self, shape: Shape) -> String {
        let columns = match shape {
            Shape::Matrix(_, columns) if !self.written.is_empty() => columns,
            _ => return format!("*{SLOPES_ARGUMENT} = {};\n", zero_of_shape(shape)),
        };
        let (_, besides) = self.body.outputs.split_at(self.spec.shape.entries());
        let zero = self.emitter.program.graph.zero();
        let rows = besides
            .chunks(columns.max(1))
            .enumerate()
            .map(|(row, entries)| {
                let zeros = (0..columns).filter(|&column| entries[column] == zero);
                let zeros: Vec<usize> = zeros.collect();
                if 2 * zeros.len() >= columns {
                    return format!("{SLOPES_ARGUMENT}[{row}] = [S::default(); {columns}];\n");
                }
                let entries = zeros.iter();
                let entries = entries
                    .map(|column| format!("{SLOPES_ARGUMENT}[{row}][{column}] = S::default();\n"));
                entries.collect()
            });
        rows.collect()
    }

    /// Returns the parameter list of a part, and the arguments of the call.
    fn part_arguments(&self, used: &UsedNames) -> (String, String) {
        let mut arguments = vec!["&self".to_string()];
        let mut values = Vec::new();
        for &argument in self
            .spec
            .arguments
            .iter()
            .filter(|argument| used.arguments.contains(argument))
        {
            let name = names::argument_name(argument);
            arguments.push(format!(
                "{name}: &[S; {}]",
                self.emitter.program.length(argument)
            ));
            values.push(name.to_string());
        }
        let mutable = |array: SharedArray| match used.access(array) {
            ArrayAccess::None => None,
            ArrayAccess::Read => Some(""),
            ArrayAccess::Written => Some("mut "),
        };
        if let Some(mutable) = mutable(SharedArray::Slots) {
            arguments.push(format!("slots: &{mutable}[S; {}]", self.plan.size));
            values.push(format!("&{mutable}slots"));
        }
        if let Some(mutable) = mutable(SharedArray::Out) {
            let shape = shape_type(self.spec.shape);
            arguments.push(format!("out: &{mutable}{shape}"));
            values.push(format!("&{mutable}out"));
        }
        if let (Some(mutable), Some(shape)) = (mutable(SharedArray::Slopes), self.spec.beside) {
            arguments.push(format!(
                "{SLOPES_ARGUMENT}: &{mutable}{}",
                shape_type(shape)
            ));
            values.push(SLOPES_ARGUMENT.into());
        }
        (arguments.join(", "), values.join(", "))
    }
}

/// Returns an output as the target of an assignment; `reference` tells whether the array is behind a reference.
fn target(spec: &FunctionSpec, index: usize, reference: bool) -> String {
    match spec.result_place(index) {
        (array, Shape::Scalar, _) if reference => format!("*{}", array.name()),
        (array, Shape::Scalar, _) => array.name().into(),
        (array, shape, place) => Rust.entry(array, shape, place),
    }
}
