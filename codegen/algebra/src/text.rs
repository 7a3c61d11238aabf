//! Short expressions as text, for messages.

use super::graph::{Edge, Graph, Node};

/// How tightly the outermost operation binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Whole,
}

/// Writes an expression as in a description; `None` if it has more than `most` characters.
pub fn short(graph: &Graph, edge: Edge, most: usize) -> Option<String> {
    let text = write(graph, edge, most, most)?.0;
    (text.chars().count() <= most).then_some(text)
}

fn write(graph: &Graph, edge: Edge, most: usize, depth: usize) -> Option<(String, Binding)> {
    let depth = depth.checked_sub(1)?;
    if let Some(number) = graph.as_rational(edge) {
        let binding = match number.is_integer() {
            true if !edge.is_negative() => Binding::Whole,
            _ => Binding::Sum,
        };
        return Some((number.to_string(), binding));
    }
    if edge.is_negative() {
        let inner = parenthesize(graph, edge.abs(), Binding::Product, most, depth)?;
        return Some((format!("-{inner}"), Binding::Sum));
    }
    let (text, binding) = match graph.node(edge.node()) {
        Node::Constant(_) => return None,
        Node::Symbol(index) => (
            graph.symbols().get(index as usize)?.name.clone(),
            Binding::Whole,
        ),
        Node::Add(a, b) => {
            let left = parenthesize(graph, a, Binding::Sum, most, depth)?;
            let sign = if b.is_negative() { '-' } else { '+' };
            let right = parenthesize(graph, b.abs(), Binding::Product, most, depth)?;
            (format!("{left} {sign} {right}"), Binding::Sum)
        }
        Node::Mul(a, b) if a == b => (
            format!("{}^2", parenthesize(graph, a, Binding::Whole, most, depth)?),
            Binding::Product,
        ),
        Node::Mul(a, b) => {
            let left = parenthesize(graph, a, Binding::Product, most, depth)?;
            let right = parenthesize(graph, b, Binding::Product, most, depth)?;
            (format!("{left} * {right}"), Binding::Product)
        }
        Node::Div(a, b) => {
            let left = parenthesize(graph, a, Binding::Product, most, depth)?;
            let right = parenthesize(graph, b, Binding::Whole, most, depth)?;
            (format!("{left} / {right}"), Binding::Product)
        }
        Node::Apply(function, a) => {
            let name = function.name();
            let inner = parenthesize(graph, a, Binding::Sum, most, depth)?;
            (format!("{name}({inner})"), Binding::Whole)
        }
        Node::Atan2(y, x) => {
            let y = parenthesize(graph, y, Binding::Sum, most, depth)?;
            let x = parenthesize(graph, x, Binding::Sum, most, depth)?;
            (format!("atan2({y}, {x})"), Binding::Whole)
        }
        Node::Listed(..) => return None,
        Node::External(component, list) => {
            let given = graph.list(list).into_iter();
            let given = given.map(|edge| parenthesize(graph, edge, Binding::Sum, most, depth));
            let given = given.collect::<Option<Vec<String>>>()?.join(", ");
            (graph.external_call_text(component, &given), Binding::Whole)
        }
        Node::Select(c, a, b) => {
            let [c, a, b] =
                [c, a, b].map(|edge| parenthesize(graph, edge, Binding::Sum, most, depth));
            (
                format!("(if {} > 0 {{ {} }} else {{ {} }})", c?, a?, b?),
                Binding::Whole,
            )
        }
    };
    (text.chars().count() <= most).then_some((text, binding))
}

/// Writes an operand, in parentheses if its operation binds less tightly than `least`.
fn parenthesize(
    graph: &Graph,
    edge: Edge,
    least: Binding,
    most: usize,
    depth: usize,
) -> Option<String> {
    let (text, binding) = write(graph, edge, most, depth)?;
    Some(if binding < least {
        format!("({text})")
    } else {
        text
    })
}
