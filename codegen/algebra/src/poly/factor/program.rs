//! Straight-line programs: lists of products and sums of earlier values.

use super::super::field::Field;
use super::super::monomial::Var;
use rustc_hash::FxHashMap;

/// A value that is available to a step.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Value {
    /// 0; only as an output.
    Zero,
    /// A run-time constant; id 0 is the number 1.
    Coefficient(u32),
    /// A run-time variable.
    Var(Var),
    /// The result of an earlier step.
    Step(usize),
}

/// A value with a sign, which costs nothing.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Operand {
    /// The value.
    pub value: Value,
    /// Whether it is negated.
    pub negative: bool,
}

impl Operand {
    /// The value, unsigned.
    pub fn new(value: Value) -> Self {
        let negative = false;
        Operand { value, negative }
    }

    /// The operand, negated if the condition holds.
    pub fn negated_if(self, negative: bool) -> Self {
        let negative = self.value != Value::Zero && self.negative != negative;
        Operand { negative, ..self }
    }
}

/// One operation. The operands of a product are unsigned, and so is the first operand of a sum.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Step {
    /// a b.
    Mul(Operand, Operand),
    /// a ± b.
    Add(Operand, Operand),
}

/// A straight-line program; operands refer to earlier steps only.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Program {
    /// The operations, in order.
    pub steps: Vec<Step>,
    /// Results, one for each polynomial.
    pub outputs: Vec<Operand>,
}

impl Program {
    /// The number of multiplications and additions.
    pub fn operations(&self) -> usize {
        self.steps.len()
    }

    /// Evaluates the outputs for given constants and variables.
    pub fn evaluate<F: Field>(
        &self,
        coefficient: &dyn Fn(u32) -> F,
        variable: &dyn Fn(Var) -> F,
    ) -> Vec<F> {
        let mut values: Vec<F> = Vec::with_capacity(self.steps.len());
        let value = |operand: Operand, values: &[F]| {
            let unsigned = match operand.value {
                Value::Zero => F::zero(),
                Value::Coefficient(0) => F::one(),
                Value::Coefficient(id) => coefficient(id),
                Value::Var(v) => variable(v),
                Value::Step(index) => values[index].clone(),
            };
            if operand.negative {
                unsigned.neg()
            } else {
                unsigned
            }
        };
        for step in &self.steps {
            let result = match *step {
                Step::Mul(a, b) => value(a, &values).mul(&value(b, &values)),
                Step::Add(a, b) => value(a, &values).add(&value(b, &values)),
            };
            values.push(result);
        }
        let outputs = self.outputs.iter();
        outputs.map(|&output| value(output, &values)).collect()
    }
}

/// Builder of a program that never contains the same step twice.
#[derive(Default)]
pub(super) struct Builder {
    pub(super) program: Program,
    known: FxHashMap<Step, usize>,
}

impl Builder {
    /// a b.
    pub(super) fn mul(&mut self, a: Operand, b: Operand) -> Operand {
        let negative = a.negative != b.negative;
        let (a, b) = (a.value.min(b.value), a.value.max(b.value));
        let result = match (a, b) {
            (Value::Zero, _) => Operand::new(Value::Zero),
            (Value::Coefficient(0), other) => Operand::new(other),
            _ => self.step(Step::Mul(Operand::new(a), Operand::new(b))),
        };
        result.negated_if(negative)
    }

    /// a + b.
    pub(super) fn add(&mut self, a: Operand, b: Operand) -> Operand {
        let (a, b) = (a.min(b), a.max(b));
        if a.value == Value::Zero {
            return b;
        }
        if a.value == b.value && a.negative != b.negative {
            return Operand::new(Value::Zero);
        }
        // A difference starts with the positive operand; −a − b is −(a + b).
        match (a.negative, b.negative) {
            (true, false) => self.step(Step::Add(b, a)),
            (true, true) => {
                let sum = Step::Add(a.negated_if(true), b.negated_if(true));
                self.step(sum).negated_if(true)
            }
            _ if !b.negative => self.step(Step::Add(a, b)),
            _ => self.difference(a, b),
        }
    }

    /// Returns a − b, or −(b − a) if b − a has already been computed.
    fn difference(&mut self, a: Operand, b: Operand) -> Operand {
        let opposite = Step::Add(b.negated_if(true), a.negated_if(true));
        match self.known.get(&opposite) {
            Some(&index) => Operand::new(Value::Step(index)).negated_if(true),
            None => self.step(Step::Add(a, b)),
        }
    }

    fn step(&mut self, step: Step) -> Operand {
        let index = *self.known.entry(step).or_insert_with(|| {
            self.program.steps.push(step);
            self.program.steps.len() - 1
        });
        Operand::new(Value::Step(index))
    }
}
