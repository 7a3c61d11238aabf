//! Simplifications by the constructor of nodes, in addition to merging equal values: run-time constants are
//! grouped, and arguments of sin, cos and exp are read as linear forms.

use super::function::Law;
use super::graph::Graph;
use super::node::{Edge, Function, Node, NodeId};
use super::residue_pair::ResiduePair;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use rustc_hash::FxHashMap;
use std::cmp::Reverse;

impl Graph {
    /// Square root of a rational that is a square.
    pub(super) fn exact_root(&mut self, argument: Edge) -> Option<Edge> {
        let value = self
            .as_rational(argument)
            .filter(|value| !value.is_negative())?;
        let (n, d) = (value.numer().sqrt(), value.denom().sqrt());
        let root = BigRational::new(n, d);
        (&root * &root == value).then(|| self.rational(&root))
    }

    /// Finds a node e with e² = `square` on the constraint variety, of either sign, that is not itself a
    /// square root.
    pub fn known_root(&self, square: Edge) -> Option<Edge> {
        let root = self.value(square).sqrt()?;
        let is_root = |edge: &Edge| self.node(edge.node()).is_root();
        [root, root.flipped()]
            .into_iter()
            .filter_map(|value| self.lookup(value))
            .find(|edge| !is_root(edge))
    }

    /// Chooses the value of √(e²) = |e|. Modulo p, roots of both signs are roots; the value is chosen such
    /// that |e| is neither e nor −e, unless e is itself a root or a number.
    pub(super) fn distinguish_from_root(&self, square: Edge, root: ResiduePair) -> ResiduePair {
        match self.lookup(root).map(|known| self.node(known.node())) {
            None | Some(Node::Constant(_)) => root,
            Some(node) if node.is_root() => root,
            Some(_) if self.value(square) == root * root => root.flipped(),
            Some(_) => root,
        }
    }

    /// Factors p·y + q·y = (p + q)·y for run-time constants p, q: the sum of constants costs nothing at run
    /// time.
    pub(super) fn factor(&mut self, a: Edge, b: Edge) -> Option<Edge> {
        let (p, y) = self.free_factor(a)?;
        let (q, z) = self.free_factor(b)?;
        if y != z {
            return None;
        }
        let coefficient = self.add(p, q);
        Some(self.mul(coefficient, y))
    }

    /// Splits an edge into p · y, with p constant and y varying at run time.
    fn free_factor(&self, edge: Edge) -> Option<(Edge, Edge)> {
        if self.is_free(edge.node()) {
            return None;
        }
        if let Node::Mul(a, b) = self.node(edge.node()) {
            if self.is_free(a.node()) {
                return Some((a.signed(edge.is_negative()), b));
            }
            if self.is_free(b.node()) {
                return Some((b.signed(edge.is_negative()), a));
            }
        }
        Some((self.one().signed(edge.is_negative()), edge.abs()))
    }

    /// Regroups p ∘ (q ∘ y) = (p ∘ q) ∘ y for run-time constants p, q, where ∘ is + or ·.
    pub(super) fn regroup(
        &mut self,
        a: Edge,
        b: Edge,
        kind: fn(Edge, Edge) -> Node,
    ) -> Option<Edge> {
        let (p, rest) = match (self.is_free(a.node()), self.is_free(b.node())) {
            (true, false) => (a, b),
            (false, true) => (b, a),
            _ => return None,
        };
        let is_sum = matches!(kind(a, b), Node::Add(..));
        let (x, y) = match self.node(rest.node()) {
            Node::Add(x, y) if is_sum => {
                (x.signed(rest.is_negative()), y.signed(rest.is_negative()))
            }
            Node::Mul(x, y) if !is_sum => (x.signed(rest.is_negative()), y),
            _ => return None,
        };
        let (q, y) = match (self.is_free(x.node()), self.is_free(y.node())) {
            (true, false) => (x, y),
            (false, true) => (y, x),
            _ => return None,
        };
        if is_sum {
            let constant = self.add(p, q);
            Some(self.add(constant, y))
        } else {
            let constant = self.mul(p, q);
            Some(self.mul(constant, y))
        }
    }

    /// Simplifies sin or cos of an angle that contains a whole multiple of π/2, by taking the multiple out.
    pub(super) fn without_right_angles(
        &mut self,
        function: Function,
        argument: Edge,
        form: &[(NodeId, BigRational)],
    ) -> Option<Edge> {
        let is_pi = |atom: NodeId| self.value(Edge::of(atom)) == ResiduePair::PI;
        let (pi, halves) = form
            .iter()
            .find(|(atom, _)| is_pi(*atom))
            .map(|(atom, c)| (*atom, c * BigRational::from_integer(2.into())))?;
        let quarters = halves
            .is_integer()
            .then(|| halves.to_integer().to_i64())??;
        if form.len() == 1 {
            return Some(match (function, quarters.rem_euclid(4)) {
                (Function::Sin, 1) | (Function::Cos, 0) => self.one(),
                (Function::Sin, 3) | (Function::Cos, 2) => -self.one(),
                _ => self.zero(),
            });
        }
        let turn = self.ratio(quarters, 2);
        let turn = self.mul(turn, Edge::of(pi));
        let rest = self.sub(argument, turn);
        let (sin, cos) = (Function::Sin, Function::Cos);
        Some(match (function, quarters.rem_euclid(4)) {
            (Function::Sin, 0) => self.apply(sin, rest),
            (Function::Sin, 1) => self.apply(cos, rest),
            (Function::Sin, 2) => -self.apply(sin, rest),
            (Function::Sin, _) => -self.apply(cos, rest),
            (_, 0) => self.apply(cos, rest),
            (_, 1) => -self.apply(sin, rest),
            (_, 2) => -self.apply(cos, rest),
            (_, _) => self.apply(sin, rest),
        })
    }

    /// Returns what a `FieldPoint` needs to know about a function's argument in addition to its value. For
    /// functions with a group law, or with a derivative that has one, this is the linear form of the argument. For a square root, it is the
    /// rational factor of the argument, or nothing if the argument is a number that is not rational and
    /// positive.
    pub fn form(&self, function: Function, argument: Edge) -> Vec<(NodeId, BigRational)> {
        match function.row().law {
            _ if function.needs_linear_form() => self.linear_form(argument),
            Law::Radical => {
                let number = self.as_rational(argument);
                let is_number = self.class(argument.node()) == 0;
                if is_number && !number.is_some_and(|number| number.is_positive()) {
                    return Vec::new();
                }
                vec![(argument.node(), self.noted_content(argument))]
            }
            _ => Vec::new(),
        }
    }

    /// Computes a positive rational factor of an expression, which does not depend on how the expression is
    /// grouped.
    pub(super) fn content(&self, edge: Edge) -> BigRational {
        let mut contents: FxHashMap<NodeId, BigRational> = FxHashMap::default();
        let one = BigRational::one();
        for id in self.reachable(&[edge]) {
            let of = |edge: Edge| contents.get(&edge.node()).unwrap_or(&one);
            let content = match self.node(id) {
                Node::Constant(index) => self.constant(index).abs(),
                Node::Mul(a, b) => of(a) * of(b),
                Node::Div(a, b) => of(a) / of(b),
                Node::Add(a, b) => {
                    let (a, b) = (of(a), of(b));
                    BigRational::new(a.numer().gcd(b.numer()), a.denom().lcm(b.denom()))
                }
                _ => continue,
            };
            contents.insert(id, content);
        }
        contents.remove(&edge.node()).unwrap_or(one)
    }

    /// Writes the argument of a function with a group law as Σ coefficient · atom, with the atoms in the
    /// order in which they occur in it.
    pub fn linear_form(&self, edge: Edge) -> Vec<(NodeId, BigRational)> {
        let mut scales: FxHashMap<NodeId, BigRational> = FxHashMap::default();
        let (mut sums, mut atoms) = (Vec::new(), Vec::new());
        let mut stack = vec![edge.node()];
        while let Some(id) = stack.pop() {
            if scales.insert(id, BigRational::zero()).is_some() {
                continue;
            }
            let parts = self.linear_parts(id);
            stack.extend(parts.iter().rev().map(|(part, _)| part.node()));
            match parts.is_empty() {
                true => atoms.push(id),
                false => sums.push((id, parts)),
            }
        }
        let sign = if edge.is_negative() {
            -BigRational::one()
        } else {
            BigRational::one()
        };
        scales.insert(edge.node(), sign);
        // The factor of a sum is known once all nodes above it have been visited. These were created later.
        sums.sort_unstable_by_key(|(id, _)| Reverse(*id));
        for (id, parts) in sums {
            let scale = scales.remove(&id).unwrap_or_default();
            for (part, factor) in parts {
                let scale = if part.is_negative() {
                    -&scale
                } else {
                    scale.clone()
                };
                *scales.entry(part.node()).or_default() += scale * factor;
            }
        }
        let form = atoms.into_iter().map(|atom| {
            let scale = scales.remove(&atom).unwrap_or_default();
            (atom, scale)
        });
        form.filter(|(_, scale)| !scale.is_zero()).collect()
    }

    /// Writes a node as a linear combination of others, with the factors; empty if it is an atom.
    fn linear_parts(&self, id: NodeId) -> Vec<(Edge, BigRational)> {
        match self.node(id) {
            Node::Add(a, b) => vec![(a, BigRational::one()), (b, BigRational::one())],
            Node::Mul(a, b) => match (self.as_rational(a), self.as_rational(b)) {
                (Some(factor), _) => vec![(b, factor)],
                (_, Some(factor)) => vec![(a, factor)],
                _ => Vec::new(),
            },
            Node::Constant(index) if id != self.one().node() => {
                vec![(self.one(), self.constant(index).clone())]
            }
            _ => Vec::new(),
        }
    }
}
