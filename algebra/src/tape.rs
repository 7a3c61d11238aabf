//! Expressions as a list of steps, to be evaluated modulo p at many points.
//!
//! The steps of an expression are found once; a point then costs one pass over them, whether values are
//! wanted or derivatives (`jets`).

use super::fp::Fp;
use super::graph::{Edge, Function, Graph, Node};
use super::lane::{Lane, LinearForm};
use num_rational::BigRational;

/// An earlier step with a sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Operand {
    /// Its place.
    pub(super) place: usize,
    /// Whether the sign is −.
    pub(super) negative: bool,
}

impl Operand {
    /// The entry with its sign.
    pub(super) fn of(self, values: &[Fp]) -> Fp {
        let value = values.get(self.place).copied().unwrap_or(Fp::ZERO);
        if self.negative { -value } else { value }
    }
}

/// What a step computes.
#[derive(Clone, Debug)]
pub(super) enum Step {
    Constant(Fp),
    Symbol(usize),
    Add(Operand, Operand),
    Mul(Operand, Operand),
    Div(Operand, Operand),
    /// With the linear form of the argument; the atom of constant angles has no place.
    Apply(Function, Operand, Vec<(Option<usize>, BigRational)>),
    Atan2(Operand, Operand),
}

/// Expressions to be evaluated.
#[derive(Clone, Debug)]
pub struct Tape {
    pub(super) steps: Vec<Step>,
    pub(super) roots: Vec<Operand>,
}

impl Tape {
    /// The steps of expressions; `None` where p divides the denominator of a number.
    pub fn new(graph: &Graph, roots: &[Edge]) -> Option<Self> {
        let nodes = graph.reachable(roots);
        let mut places = vec![0; graph.len()];
        for (place, &id) in nodes.iter().enumerate() {
            places[id as usize] = place;
        }
        let operand = |edge: Edge| Operand {
            place: places[edge.node() as usize],
            negative: edge.is_negative(),
        };
        let step = |&id: &u32| {
            Some(match graph.node(id) {
                Node::Constant(index) => Step::Constant(Fp::from_rational(graph.constant(index))?),
                Node::Symbol(index) => Step::Symbol(index as usize),
                Node::Add(a, b) => Step::Add(operand(a), operand(b)),
                Node::Mul(a, b) => Step::Mul(operand(a), operand(b)),
                Node::Div(a, b) => Step::Div(operand(a), operand(b)),
                Node::Atan2(y, x) => Step::Atan2(operand(y), operand(x)),
                Node::Apply(function, a) => {
                    // The number 1 is the atom of constant angles.
                    let place = |atom: u32| (atom != 1).then(|| places[atom as usize]);
                    let form = graph.form(function, a).into_iter();
                    let form = form.map(|(atom, c)| (place(atom), c));
                    Step::Apply(function, operand(a), form.collect())
                }
            })
        };
        Some(Tape {
            steps: nodes.iter().map(step).collect::<Option<_>>()?,
            roots: roots.iter().map(|&root| operand(root)).collect(),
        })
    }

    /// The values of the expressions at a point; `None` where something has no value there.
    pub fn values(&self, lane: &Lane) -> Option<Vec<Fp>> {
        let mut lane = lane.clone();
        let mut values = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let value = match step {
                Step::Constant(value) => *value,
                Step::Symbol(index) => lane.symbol(*index),
                Step::Add(a, b) => a.of(&values) + b.of(&values),
                Step::Mul(a, b) => a.of(&values) * b.of(&values),
                Step::Div(a, b) => a.of(&values) * b.of(&values).inv()?,
                Step::Apply(function, a, form) => {
                    let form = linear_form(form, &values);
                    lane.function(*function, a.of(&values), &form)
                }
                Step::Atan2(y, x) => lane.opaque(Function::Atan2, y.of(&values), x.of(&values)),
            };
            values.push(value);
        }
        (!lane.is_stuck()).then(|| self.roots.iter().map(|root| root.of(&values)).collect())
    }
}

/// A linear form with the values of its atoms.
pub(super) fn linear_form(form: &[(Option<usize>, BigRational)], values: &[Fp]) -> LinearForm {
    let atom =
        |place: &Option<usize>| place.map_or(Some(Fp::ONE), |place| values.get(place).copied());
    form.iter()
        .map(|(place, c)| (atom(place).unwrap_or(Fp::ZERO), c.clone()))
        .collect()
}
