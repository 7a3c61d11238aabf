//! Powers: those of sums, and those with a half-integer exponent, which are products with a root.

use super::{Edge, Function, Graph, Node, NodeId};

/// Products of more factors are not looked at.
const MOST_FACTORS: usize = 12;

/// w a √s, where a is a constant multiple of s, but for signs of its factors.
pub(crate) struct Power {
    /// The factors of w.
    pub rest: Vec<Edge>,
    /// Those of a.
    pub base: Vec<Edge>,
    /// √s.
    pub root: Edge,
    /// The factors of s that are constant at run time.
    pub constants: Vec<Edge>,
}

impl Graph {
    /// A product as such a power; of a factor |v| of s there may be v beside the root.
    pub(crate) fn half_integer_power(&self, id: NodeId) -> Option<Power> {
        let factors = self.whole_factors(Edge::of(id))?;
        (0..factors.len()).find_map(|place| {
            let root = factors[place];
            let Node::Apply(Function::Sqrt, square) = self.node(root.node()) else {
                return None;
            };
            let mut rest = factors.clone();
            rest.remove(place);
            let (mut base, mut constants) = (Vec::new(), Vec::new());
            for factor in self.whole_factors(square)? {
                if self.is_free(factor.node()) {
                    constants.push(factor);
                    continue;
                }
                let is_there = |wanted: Edge| rest.iter().position(|f| f.abs() == wanted.abs());
                let place = is_there(factor).or_else(|| match self.node(factor.node()) {
                    Node::Apply(Function::Abs, signed) => is_there(signed),
                    _ => None,
                })?;
                base.push(rest.remove(place).abs());
            }
            (!base.is_empty()).then(|| {
                // Signs of what was taken out stay with the rest, that of the root too.
                let negative = factors.iter().filter(|f| f.is_negative()).count();
                let left = rest.iter().filter(|f| f.is_negative()).count();
                if (negative - left) % 2 == 1 {
                    rest.push(-self.one());
                }
                Power {
                    rest,
                    base,
                    root: root.abs(),
                    constants,
                }
            })
        })
    }

    /// The sum whose third or a higher power a product has as a factor.
    pub(crate) fn power_of_sum(&self, id: NodeId) -> Option<NodeId> {
        let Node::Mul(..) = self.node(id) else {
            return None;
        };
        let factors = self.whole_factors(Edge::of(id))?;
        let times = |base: NodeId| factors.iter().filter(|f| f.node() == base).count();
        let sum = |factor: &Edge| matches!(self.node(factor.node()), Node::Add(..));
        let mut sums = factors.iter().filter(|factor| sum(factor));
        sums.find(|sum| times(sum.node()) > 2).map(|sum| sum.node())
    }

    /// The factors of a product, the sign of an edge with one of them; `None` where there are too many.
    fn whole_factors(&self, edge: Edge) -> Option<Vec<Edge>> {
        let (mut factors, mut stack) = (Vec::new(), vec![edge]);
        while let Some(edge) = stack.pop() {
            match self.node(edge.node()) {
                Node::Mul(a, b) => stack.extend([b, a.signed(edge.is_negative())]),
                _ => factors.push(edge),
            }
            if factors.len() + stack.len() > MOST_FACTORS {
                return None;
            }
        }
        Some(factors)
    }
}
