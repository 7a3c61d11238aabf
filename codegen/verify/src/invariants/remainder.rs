//! Readable text of a polynomial: `m g s[1] R[3,2] - 1/2 d w^2`.

use hamel_algebra::graph::{Edge, Graph, Node};
use hamel_algebra::poly::monomial::Var;
use hamel_algebra::poly::polynomial::Poly;
use hamel_dynamics::normal::variable_node;
use num_rational::BigRational;
use num_traits::{One, Signed};

/// Number of terms that are written out; further terms are only counted.
const MAX_SHOWN_TERMS: usize = 6;

/// Returns the text of a polynomial, whose further terms are counted; `None` if one of its variables cannot be written briefly, such as a quotient.
pub fn polynomial_text(graph: &Graph, polynomial: &Poly<BigRational>) -> Option<String> {
    let mut text = String::new();
    let terms = polynomial.terms();
    for (index, (monomial, number)) in terms.iter().take(MAX_SHOWN_TERMS).enumerate() {
        let mut factors = Vec::new();
        for &(var, exponent) in monomial.powers() {
            let name = variable(graph, var)?;
            factors.push(match exponent {
                1 => name,
                _ => format!("{name}^{exponent}"),
            });
        }
        let size = number.abs();
        if factors.is_empty() || !size.is_one() {
            factors.insert(0, size.to_string());
        }
        text.push_str(match (index, number.is_negative()) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        });
        text.push_str(&factors.join(" "));
    }
    let more = terms.len().saturating_sub(MAX_SHOWN_TERMS);
    if more > 0 {
        text.push_str(&format!(" + … ({more} more terms)"));
    }
    Some(text)
}

fn variable(graph: &Graph, var: Var) -> Option<String> {
    expression(graph, variable_node(graph, var), 0)
}

/// Returns the text of a node: symbols, and functions of sums and products of them.
fn expression(graph: &Graph, edge: Edge, depth: usize) -> Option<String> {
    /// Depth from which arguments are no longer readable.
    const MAX_DEPTH: usize = 6;
    if depth > MAX_DEPTH {
        return None;
    }
    let of = |edge: Edge| expression(graph, edge, depth + 1);
    // A sum that is multiplied, subtracted or negated needs parentheses.
    let operand = |edge: Edge| match graph.node(edge.node()) {
        Node::Add(..) if !edge.is_negative() => of(edge).map(|text| format!("({text})")),
        _ => of(edge),
    };
    if edge.is_negative() {
        return operand(edge.abs()).map(|text| format!("-{text}"));
    }
    let text = match graph.node(edge.node()) {
        Node::Constant(index) => graph.constant(index).to_string(),
        Node::Symbol(index) => graph.symbols().get(index as usize)?.name.clone(),
        Node::Add(a, b) if b.is_negative() => format!("{} - {}", of(a)?, operand(b.abs())?),
        Node::Add(a, b) => format!("{} + {}", of(a)?, of(b)?),
        Node::Mul(a, b) => format!("{} {}", operand(a)?, operand(b)?),
        Node::Apply(function, a) => {
            let name = function.name();
            format!("{name}({})", of(a)?)
        }
        _ => return None,
    };
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::expression;
    use hamel_algebra::function::Function;
    use hamel_algebra::graph::Graph;
    use hamel_algebra::residue_pair::ResiduePair;

    /// The sign of a node belongs to the graph: either form is right, as long as it has the value of the expression.
    #[test]
    fn sums_behind_a_sign_have_parentheses() {
        let mut graph = Graph::new(7);
        let [a, b, c] = [("a", 1 << 50), ("b", 3 << 45), ("c", 5 << 41)]
            .map(|(name, value)| graph.symbol(name, 1, ResiduePair::from_i64(value)));
        let sum = graph.add(b, c);
        for operand in [sum, -sum] {
            let difference = graph.add(a, operand);
            let argument = graph.apply(Function::Cos, difference);
            let text = expression(&graph, argument, 0).expect("short");
            let forms: &[&str] = if operand == sum {
                &["cos(a + b + c)", "cos(b + c + a)", "cos(-(a + b + c))"]
            } else {
                &["cos(a - (b + c))", "cos(b + c - a)", "cos(-(b + c) + a)"]
            };
            assert!(forms.contains(&text.as_str()), "{text}");
        }
        let product = graph.mul(a, sum);
        let text = expression(&graph, -product, 0).expect("short");
        assert!(
            ["-a (b + c)", "-(b + c) a"].contains(&text.as_str()),
            "{text}"
        );
    }
}
