//! Every statement of the generated code with its expression and its origin, for reviews.

use super::chunk::ResultWriting;
use super::function::{FunctionSpec, PreparedFunction, with_prepared};
use super::language::{Language, Operand, SharedArray};
use super::print::Printer;
use super::{Emitter, constants, parameters, together};
use hamel_algebra::graph::{Edge, Function, Graph, NodeId};
use hamel_program::origins::origins;
use hamel_program::provenance::Origin;
use hamel_program::statements::{Operation, Statement};
use hamel_program::{Cause, Program, Shape};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// A generated function with its statements, each with the quantity that it serves.
#[derive(Clone, Debug)]
pub struct FunctionStatements {
    /// Name of the function in Rust.
    pub function: String,
    /// Its statements, in order.
    pub statements: Vec<AnnotatedStatement>,
}

/// A value that a statement computes, or the check of a pivot.
#[derive(Clone, Debug)]
pub struct AnnotatedStatement {
    /// Name in Rust; empty for a check.
    pub name: String,
    /// Expression in the names of statements, arguments (`x[0]`), parameters (`self.m`) and constants (`k[2]`).
    pub expression: String,
    /// Node of the program's graph that the value belongs to; `None` for a part of a sum and for a check.
    pub node: Option<NodeId>,
    /// Quantity that the statement serves.
    pub origin: Option<Rc<Origin>>,
}

/// Lists the statements of all generated Rust functions, each with its expression and the quantity that it serves, for
/// reviews.
pub fn annotated_statements(program: &Program) -> Vec<FunctionStatements> {
    let emitter = Emitter::new(program, usize::MAX);
    let mut specs = emitter.specs();
    if let Some((place, both)) = together::pair_spec(&emitter) {
        specs[place] = both;
    }
    let parameters = parameters::parameter_expressions(program, &emitter.names.fields, "self.");
    let traced = |spec: &FunctionSpec| FunctionStatements {
        function: spec.name.clone(),
        statements: with_prepared(&emitter, spec, &Plain, &parameters, statements),
    };
    specs.iter().map(traced).collect()
}

/// Traces the statements of a function.
fn statements(drawing: &PreparedFunction) -> Vec<AnnotatedStatement> {
    let (emitter, spec) = (drawing.emitter, drawing.spec);
    let origins = match spec.functions.as_slice() {
        [] => constants::constant_origins(emitter, drawing.body),
        functions => origins(emitter.program, functions, drawing.body),
    };
    let mut printer = drawing.printer();
    let mut all: Vec<AnnotatedStatement> = Vec::new();
    for statement in &drawing.body.statements {
        match &statement.operation {
            Operation::Check(_, pivot) => {
                // A pivot that is an argument has no statement: its check belongs to the result.
                let result = || {
                    let function = spec.functions.first()?;
                    let provenance = &emitter.program.provenance;
                    Some(Rc::new(provenance.result(function.id, &function.name, 0)))
                };
                all.push(AnnotatedStatement {
                    name: String::new(),
                    expression: format!("{} > 0", printer.signed_value(*pivot)),
                    node: None,
                    origin: origins.get(&pivot.node()).cloned().or_else(result),
                });
            }
            _ => all.extend(values(drawing, &mut printer, statement, &origins)),
        }
        printer.here.extend(statement.defined());
    }
    all
}

/// Traces the values of a statement.
fn values(
    drawing: &PreparedFunction,
    printer: &mut Printer,
    statement: &Statement,
    origins: &FxHashMap<NodeId, Rc<Origin>>,
) -> Vec<AnnotatedStatement> {
    let graph = &drawing.emitter.program.graph;
    let traced = |node: NodeId, expression: String| AnnotatedStatement {
        name: drawing.locals.name_of(node).into(),
        expression,
        node: (!drawing.body.partial.contains(&node)).then_some(node),
        origin: origins.get(&node).cloned(),
    };
    match &statement.operation {
        Operation::SinCos(angle) => {
            let angle = printer.signed_value(*angle);
            let both = statement.results.into_iter().zip(["sin", "cos"]);
            both.filter_map(|(node, name)| Some(traced(node?, format!("{name}({angle})"))))
                .collect()
        }
        Operation::Call(call) => {
            let given = call.arguments.iter().map(|&a| printer.signed_value(a));
            let given = given.collect::<Vec<_>>().join(", ");
            let results = call.results.iter().copied().flatten();
            let called = results.map(|node| match graph.as_external_call(Edge::of(node)) {
                Some((component, _)) => traced(node, graph.external_call_text(component, &given)),
                None => traced(node, String::new()),
            });
            called.collect()
        }
        operation => {
            let expression = printer.expression(operation);
            let defined = statement.defined();
            defined
                .map(|node| traced(node, expression.clone()))
                .collect()
        }
    }
}

/// Expressions in the notation of descriptions.
struct Plain;

impl Language for Plain {
    fn when(&self, _: Shape, _: bool) -> ResultWriting {
        ResultWriting::AtTheEnd
    }

    fn entry(&self, array: SharedArray, _: Shape, place: usize) -> String {
        format!("{}[{place}]", array.name())
    }

    fn literal(&self, graph: &Graph, node: NodeId) -> String {
        match graph.as_rational(Edge::of(node)) {
            Some(number) if number.is_integer() => number.to_string(),
            Some(number) => format!("({number})"),
            None => "pi".into(),
        }
    }

    fn number(&self, graph: &Graph, node: NodeId, _: &str) -> String {
        self.literal(graph, node)
    }

    fn number_binding(&self, _: &Graph, _: NodeId, _: &str) -> String {
        String::new()
    }

    fn heading(&self, _: &str) -> String {
        String::new()
    }

    fn zero(&self) -> String {
        "0".into()
    }

    fn binding(&self, _: &str, value: &str) -> String {
        value.into()
    }

    fn pair(&self, _: [Option<&str>; 2], angle: &Operand) -> String {
        angle.with_sign()
    }

    fn fused(&self, [a, b, c]: &[Operand; 3]) -> String {
        let sign = if c.negative { "-" } else { "+" };
        format!("{} * {} {sign} {}", a.with_sign(), b.with_sign(), c.value)
    }

    fn atan2(&self, [y, x]: &[Operand; 2]) -> String {
        format!("atan2({}, {})", y.with_sign(), x.with_sign())
    }

    fn select(&self, [c, a, b]: &[Operand; 3]) -> String {
        let [c, a, b] = [c, a, b].map(Operand::with_sign);
        format!("if {c} > 0 {{ {a} }} else {{ {b} }}")
    }

    fn function(&self, function: Function, operand: &Operand) -> String {
        match function.name().strip_suffix(' ') {
            Some(factor) => format!("{factor} * {}", operand.with_sign()),
            None => format!("{}({})", function.name(), operand.with_sign()),
        }
    }

    fn check(&self, pivot: &Operand, _: Cause, _: &Program) -> String {
        format!("{} > 0", pivot.with_sign())
    }
}
