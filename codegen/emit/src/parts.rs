//! A long function as a sequence of calls: its parts share one array of slots and write the results.

use super::function::{Drawing, SLOPES, Spec, shape_type, statements, zeros};
use super::language::{Array, Language, Rust};
use super::names;
use super::print::{Access, Used};
use hamel_algebra::graph::NodeId;
use hamel_program::Shape;
use hamel_program::places::Place;
use rustc_hash::FxHashMap;

/// Number of statements above which the parts of a function are never inlined: this compiles fastest, and a
/// call costs little compared with a part.
const INLINE: usize = 2000;

impl Drawing<'_> {
    /// Returns the text of the function in parts: one function for each part, then the function that calls them.
    pub fn split(&self) -> String {
        let Spec { name, .. } = self.spec;
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
            let text = statements(&mut printer, self.body, part, |printer, node| {
                let indices = targets.get(&node).map_or(&[][..], Vec::as_slice);
                let writes = indices.iter().map(|&index| {
                    let (array, _, place) = self.spec.place(index);
                    printer.used.touch(array, place, Access::Written);
                    let value = printer.signed(self.body.outputs[index]);
                    format!("{} = {value};\n", target(self.spec, index, true))
                });
                writes.collect()
            });
            let used = printer.used;
            crossing |= used.access(Array::Slots) > Access::None;
            let part_name = self.emitter.names.part(name, index + 1);
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
        text.push_str(&format!("let {mutable}out = {};\n", zeros(self.spec.shape)));
        if let Some(shape) = self.spec.beside {
            text.push_str(&self.cleared(shape));
        }
        text.push_str(&calls);
        for index in rest
            .into_iter()
            .filter(|&index| self.body.outputs[index] != zero)
        {
            let value = main.result(self.body.outputs[index]);
            text.push_str(&format!("{} = {value};\n", target(self.spec, index, false)));
        }
        let kept = self.bind_kept(&main.used);
        let body = format!("{kept}{text}{}", self.value("out"));
        parts + &self.head(&body)
    }

    /// Clears the argument `slopes`. A function in short parts clears only the entries that stay zero: this is more
    /// code, but it writes less.
    fn cleared(&self, shape: Shape) -> String {
        let columns = match shape {
            Shape::Matrix(_, columns) if !self.written.is_empty() => columns,
            _ => return format!("*{SLOPES} = {};\n", zeros(shape)),
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
                    return format!("{SLOPES}[{row}] = [S::default(); {columns}];\n");
                }
                let entries = zeros.iter();
                let entries =
                    entries.map(|column| format!("{SLOPES}[{row}][{column}] = S::default();\n"));
                entries.collect()
            });
        rows.collect()
    }

    /// Returns the parameter list of a part, and the arguments of the call.
    fn part_arguments(&self, used: &Used) -> (String, String) {
        let mut arguments = vec!["&self".to_string()];
        let mut values = Vec::new();
        for &argument in self
            .spec
            .arguments
            .iter()
            .filter(|argument| used.arguments.contains(argument))
        {
            let name = names::argument(argument);
            arguments.push(format!(
                "{name}: &[S; {}]",
                self.emitter.program.length(argument)
            ));
            values.push(name.to_string());
        }
        let mutable = |array: Array| match used.access(array) {
            Access::None => None,
            Access::Read => Some(""),
            Access::Written => Some("mut "),
        };
        if let Some(mutable) = mutable(Array::Slots) {
            arguments.push(format!("slots: &{mutable}[S; {}]", self.plan.size));
            values.push(format!("&{mutable}slots"));
        }
        if let Some(mutable) = mutable(Array::Out) {
            let shape = shape_type(self.spec.shape);
            arguments.push(format!("out: &{mutable}{shape}"));
            values.push(format!("&{mutable}out"));
        }
        if let (Some(mutable), Some(shape)) = (mutable(Array::Slopes), self.spec.beside) {
            arguments.push(format!("{SLOPES}: &{mutable}{}", shape_type(shape)));
            values.push(SLOPES.into());
        }
        (arguments.join(", "), values.join(", "))
    }
}

/// Returns an output as the target of an assignment; `reference` tells whether the array is behind a reference.
fn target(spec: &Spec, index: usize, reference: bool) -> String {
    match spec.place(index) {
        (array, Shape::Scalar, _) if reference => format!("*{}", array.name()),
        (array, Shape::Scalar, _) => array.name().into(),
        (array, shape, place) => Rust.entry(array, shape, place),
    }
}
