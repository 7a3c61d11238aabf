//! Edges, nodes and symbols of the expression graph.

pub use super::external::Component;
pub use super::function::Function;
use super::function::Law;
use std::ops::Range;

/// Index of a node.
pub type NodeId = u32;

/// A node with a sign.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Edge(u32);

impl Edge {
    /// The node under the sign.
    pub fn node(self) -> NodeId {
        self.0 >> 1
    }

    /// Whether the sign is −.
    pub fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    /// The same node with sign +.
    pub fn abs(self) -> Edge {
        Edge(self.0 & !1)
    }

    /// The positive edge of a node.
    pub fn of(node: NodeId) -> Edge {
        Edge(node << 1)
    }

    /// Returns the same edge after nodes have been renumbered by `places`.
    pub fn renumber(self, places: &[NodeId]) -> Edge {
        Edge::of(places[self.node() as usize]).signed(self.is_negative())
    }

    /// Returns this edge, negated if `negative`.
    pub fn signed(self, negative: bool) -> Edge {
        if negative { -self } else { self }
    }
}

impl std::ops::Neg for Edge {
    type Output = Edge;
    /// Node 0 is the number 0, which is its own negative.
    fn neg(self) -> Edge {
        Edge(if self.node() == 0 { 0 } else { self.0 ^ 1 })
    }
}

/// Operation of a node.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// An exact rational, by its place in the table of constants.
    Constant(u32),
    /// A symbol, by its place in the table of symbols.
    Symbol(u32),
    /// a + b, where operands may be negative.
    Add(Edge, Edge),
    /// a · b, neither operand negative.
    Mul(Edge, Edge),
    /// a / b, neither operand negative.
    Div(Edge, Edge),
    /// A function of one argument.
    Apply(Function, Edge),
    /// atan2(y, x).
    Atan2(Edge, Edge),
    /// (c, a, b): a where c > 0, else b.
    Select(Edge, Edge, Edge),
    /// A list of arguments: the list of the earlier numbers, and the last number. The empty list is 0.
    Listed(Edge, Edge),
    /// A component of an external function, or a derivative of one, applied to a list.
    External(Component, Edge),
}

impl Node {
    /// Returns the children, in order.
    pub fn children(self) -> Children {
        let none = Edge(0);
        let (list, count) = match self {
            Node::Constant(_) | Node::Symbol(_) => ([none; 3], 0),
            Node::Apply(_, a) | Node::External(_, a) => ([a, none, none], 1),
            Node::Add(a, b)
            | Node::Mul(a, b)
            | Node::Div(a, b)
            | Node::Atan2(a, b)
            | Node::Listed(a, b) => ([a, b, none], 2),
            Node::Select(c, a, b) => ([c, a, b], 3),
        };
        Children {
            list,
            left: 0..count,
        }
    }

    /// Whether it is a square root.
    pub fn is_root(self) -> bool {
        matches!(self, Node::Apply(function, _) if function.row().law == Law::Radical)
    }

    /// Returns the same operation on other children, to which `child` maps the present ones.
    pub fn map_children(self, mut child: impl FnMut(Edge) -> Edge) -> Node {
        match self {
            Node::Constant(_) | Node::Symbol(_) => self,
            Node::Apply(function, a) => Node::Apply(function, child(a)),
            Node::Add(a, b) => Node::Add(child(a), child(b)),
            Node::Mul(a, b) => Node::Mul(child(a), child(b)),
            Node::Div(a, b) => Node::Div(child(a), child(b)),
            Node::Atan2(a, b) => Node::Atan2(child(a), child(b)),
            Node::Select(c, a, b) => Node::Select(child(c), child(a), child(b)),
            Node::Listed(rest, a) => Node::Listed(child(rest), child(a)),
            Node::External(component, list) => Node::External(component, child(list)),
        }
    }
}

/// The children of a node, in order.
#[derive(Clone, Debug)]
pub struct Children {
    list: [Edge; 3],
    left: Range<usize>,
}

impl Iterator for Children {
    type Item = Edge;

    fn next(&mut self) -> Option<Edge> {
        self.left.next().map(|place| self.list[place])
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.left.size_hint()
    }
}

impl DoubleEndedIterator for Children {
    fn next_back(&mut self) -> Option<Edge> {
        self.left.next_back().map(|place| self.list[place])
    }
}

impl ExactSizeIterator for Children {}

/// A symbol: its name and the class of inputs that it belongs to, one bit each.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// Name as written by the user.
    pub name: String,
    /// Class bit; the meaning of the bits is up to the caller.
    pub class: u8,
    /// Node of the symbol.
    pub node: NodeId,
}
