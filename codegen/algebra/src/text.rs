//! Short expressions as text, for messages.

use super::graph::{Edge, Graph, Node, NodeId};

/// How tightly the outermost operation binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Whole,
}

/// Names of nodes that are not written out.
type Names<'a> = &'a dyn Fn(NodeId) -> Option<String>;

/// Writes an expression as in a description; `None` if it has more than `most` characters.
pub fn short(graph: &Graph, edge: Edge, most: usize) -> Option<String> {
    let text = write(graph, edge, &|_| None, (most, most))?.0;
    (text.chars().count() <= most).then_some(text)
}

/// Writes an expression as [`short`] does, with the nodes within it that have a name written by that name.
pub fn short_with(graph: &Graph, edge: Edge, most: usize, names: Names) -> Option<String> {
    let whole = |id: NodeId| names(id).filter(|_| id != edge.node());
    let text = write(graph, edge, &whole, (most, most))?.0;
    (text.chars().count() <= most).then_some(text)
}

fn write(
    graph: &Graph,
    edge: Edge,
    names: Names,
    (most, depth): (usize, usize),
) -> Option<(String, Binding)> {
    let depth = depth.checked_sub(1)?;
    let limits = (most, depth);
    if let Some(name) = names(edge.node()) {
        return Some(match edge.is_negative() {
            true => (format!("-{name}"), Binding::Sum),
            false => (name, Binding::Whole),
        });
    }
    if let Some(number) = graph.as_rational(edge) {
        let binding = match number.is_integer() {
            true if !edge.is_negative() => Binding::Whole,
            _ => Binding::Sum,
        };
        return Some((number.to_string(), binding));
    }
    if edge.is_negative() {
        let inner = parenthesize(graph, edge.abs(), Binding::Product, names, limits)?;
        return Some((format!("-{inner}"), Binding::Sum));
    }
    let (text, binding) = match graph.node(edge.node()) {
        Node::Constant(_) => return None,
        Node::Symbol(index) => (
            graph.symbols().get(index as usize)?.name.clone(),
            Binding::Whole,
        ),
        Node::Add(a, b) => {
            let left = parenthesize(graph, a, Binding::Sum, names, limits)?;
            let sign = if b.is_negative() { '-' } else { '+' };
            let right = parenthesize(graph, b.abs(), Binding::Product, names, limits)?;
            (format!("{left} {sign} {right}"), Binding::Sum)
        }
        Node::Mul(a, b) if a == b => (
            format!(
                "{}^2",
                parenthesize(graph, a, Binding::Whole, names, limits)?
            ),
            Binding::Product,
        ),
        Node::Mul(a, b) => {
            let left = parenthesize(graph, a, Binding::Product, names, limits)?;
            let right = parenthesize(graph, b, Binding::Product, names, limits)?;
            (format!("{left} * {right}"), Binding::Product)
        }
        Node::Div(a, b) => {
            let left = parenthesize(graph, a, Binding::Product, names, limits)?;
            let right = parenthesize(graph, b, Binding::Whole, names, limits)?;
            (format!("{left} / {right}"), Binding::Product)
        }
        Node::Apply(function, a) => {
            let name = function.name();
            let inner = parenthesize(graph, a, Binding::Sum, names, limits)?;
            (format!("{name}({inner})"), Binding::Whole)
        }
        Node::Atan2(y, x) => {
            let y = parenthesize(graph, y, Binding::Sum, names, limits)?;
            let x = parenthesize(graph, x, Binding::Sum, names, limits)?;
            (format!("atan2({y}, {x})"), Binding::Whole)
        }
        Node::Listed(..) => return None,
        Node::External(component, list) => {
            let given = graph.list(list).into_iter();
            let given = given.map(|edge| parenthesize(graph, edge, Binding::Sum, names, limits));
            let given = given.collect::<Option<Vec<String>>>()?.join(", ");
            (graph.external_call_text(component, &given), Binding::Whole)
        }
        Node::Select(c, a, b) => {
            let [c, a, b] =
                [c, a, b].map(|edge| parenthesize(graph, edge, Binding::Sum, names, limits));
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
    names: Names,
    limits: (usize, usize),
) -> Option<String> {
    let (text, binding) = write(graph, edge, names, limits)?;
    Some(if binding < least {
        format!("({text})")
    } else {
        text
    })
}
