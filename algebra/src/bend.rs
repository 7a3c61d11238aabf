//! Rows of second derivatives modulo p by dual numbers that run backwards: the slopes of f′ along one
//! direction in all symbols at once, at the cost of a few evaluations however many symbols there are.

use super::fp::Fp;
use super::graph::Function;
use super::lane::Lane;
use super::tape::{Operand, Step, Tape, linear_form};

/// A value and its slope along the direction.
#[derive(Clone, Copy)]
struct Dual(Fp, Fp);

impl Dual {
    const ZERO: Dual = Dual(Fp::ZERO, Fp::ZERO);

    fn add(self, other: Dual) -> Dual {
        Dual(self.0 + other.0, self.1 + other.1)
    }

    fn negated(self, negative: bool) -> Dual {
        if negative {
            Dual(-self.0, -self.1)
        } else {
            self
        }
    }

    fn mul(self, other: Dual) -> Dual {
        Dual(self.0 * other.0, self.1 * other.0 + self.0 * other.1)
    }

    fn inv(self) -> Option<Dual> {
        let inverse = self.0.inv()?;
        Some(Dual(inverse, -(self.1 * inverse * inverse)))
    }

    fn is_zero(self) -> bool {
        self.0.is_zero() && self.1.is_zero()
    }
}

/// What a step is of, with its derivatives by these operands.
type Parts = [Option<(Operand, Dual)>; 2];

impl Tape {
    /// ∂(∂f/∂s)/∂xₖ for every symbol xₖ, f the first of the expressions and s along `direction`; `None`
    /// where something has no value at the point.
    pub fn bend(&self, lane: &Lane, direction: &[Fp]) -> Option<Vec<Fp>> {
        let mut lane = lane.clone();
        let mut values: Vec<Dual> = Vec::with_capacity(self.steps.len());
        let mut numbers: Vec<Fp> = Vec::with_capacity(self.steps.len());
        let mut parts: Vec<Parts> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let (value, part) = forwards(step, &mut lane, (&values, &numbers), direction)?;
            values.push(value);
            numbers.push(value.0);
            parts.push(part);
        }
        if lane.is_stuck() {
            return None;
        }
        let root = self.roots.first()?;
        let mut weights = vec![Dual::ZERO; self.steps.len()];
        *weights.get_mut(root.place)? = Dual(Fp::ONE, Fp::ZERO).negated(root.negative);
        let mut row = vec![Fp::ZERO; direction.len()];
        for (place, step) in self.steps.iter().enumerate().rev() {
            let weight = weights[place];
            if weight.is_zero() {
                continue;
            }
            if let Step::Symbol(index) = step
                && let Some(entry) = row.get_mut(*index)
            {
                *entry = *entry + weight.1;
            }
            for &(operand, slope) in parts[place].iter().flatten() {
                let share = weight.mul(slope).negated(operand.negative);
                weights[operand.place] = weights[operand.place].add(share);
            }
        }
        Some(row)
    }
}

/// The value of a step, and its derivatives by what it is of.
fn forwards(
    step: &Step,
    lane: &mut Lane,
    (values, numbers): (&[Dual], &[Fp]),
    direction: &[Fp],
) -> Option<(Dual, Parts)> {
    let read = |operand: Operand| values[operand.place].negated(operand.negative);
    let one = Dual(Fp::ONE, Fp::ZERO);
    Some(match step {
        Step::Constant(value) => (Dual(*value, Fp::ZERO), [None, None]),
        Step::Symbol(index) => {
            let slope = direction.get(*index).copied().unwrap_or(Fp::ZERO);
            (Dual(lane.symbol(*index), slope), [None, None])
        }
        Step::Add(a, b) => (read(*a).add(read(*b)), [Some((*a, one)), Some((*b, one))]),
        Step::Mul(a, b) => (
            read(*a).mul(read(*b)),
            [Some((*a, read(*b))), Some((*b, read(*a)))],
        ),
        Step::Div(a, b) => {
            let inverse = read(*b).inv()?;
            let quotient = read(*a).mul(inverse);
            let by_b = quotient.mul(inverse).negated(true);
            (quotient, [Some((*a, inverse)), Some((*b, by_b))])
        }
        Step::Apply(function, a, form) => {
            let argument = read(*a);
            let form = linear_form(form, numbers);
            let result = lane.function(*function, argument.0, &form);
            let slope = lane.slope(*function, argument.0, &form, result)?;
            let bent = match function {
                Function::Sin | Function::Cos => -result,
                Function::Exp => result,
                Function::Log => -(slope * slope),
                Function::Sqrt => -(slope * (argument.0 + argument.0).inv()?),
                // Two arguments: its own step.
                Function::Atan2 => Fp::ZERO,
            };
            (
                Dual(result, slope * argument.1),
                [Some((*a, Dual(slope, bent * argument.1))), None],
            )
        }
        Step::Atan2(y, x) => {
            let (dy, dx) = (read(*y), read(*x));
            let inverse = dx.mul(dx).add(dy.mul(dy)).inv()?;
            let (by_y, by_x) = (dx.mul(inverse), dy.mul(inverse).negated(true));
            let value = lane.opaque(Function::Atan2, dy.0, dx.0);
            let slope = by_y.0 * dy.1 + by_x.0 * dx.1;
            (Dual(value, slope), [Some((*y, by_y)), Some((*x, by_x))])
        }
    })
}

#[cfg(test)]
mod tests {
    use crate::fp::{Fp, Random};
    use crate::graph::Graph;
    use crate::jets::Seeds;
    use crate::lane::Lane;
    use crate::tape::Tape;
    use crate::tests::FUNCTIONS;

    #[test]
    fn rows_are_the_mixed_derivatives_of_jets() {
        let mut random = Random::new(11);
        let mut graph = Graph::new(1, 0);
        let mut symbol = |graph: &mut Graph, name: &str| {
            let value = random.element();
            graph.symbol(name, 2, value)
        };
        let symbols: Vec<_> = ["a", "b", "c"].map(|name| symbol(&mut graph, name)).into();
        let [a, b, c] = symbols[..] else {
            unreachable!("three symbols")
        };
        let product = graph.mul(a, b);
        let mut sum = graph.sub(c, product);
        for function in FUNCTIONS {
            let value = graph.apply(function, sum);
            let quotient = graph.div(value, product).expect("not 0");
            sum = graph.add(sum, quotient);
        }
        let angle = graph.atan2(sum, a);
        let root = graph.mul(angle, sum);
        let tape = Tape::new(&graph, &[root]).expect("has a tape");
        let first = graph.symbols().len() - 3;
        let unit = |k: usize| -> Vec<Fp> {
            (0..first + 3)
                .map(|i| if i == first + k { Fp::ONE } else { Fp::ZERO })
                .collect()
        };
        let mut found = 0;
        for seed in 0..60 {
            let mut lane = Lane::new(seed);
            (0..first + 3).for_each(|_| lane.push_symbol(random.element()));
            for k in 0..3 {
                let seeds = Seeds {
                    along: unit(k),
                    across: (0..3).map(unit).collect(),
                    mixed: Vec::new(),
                };
                let Some(jets) = tape.jets(&lane, &seeds) else {
                    continue;
                };
                let row = tape.bend(&lane, &unit(k)).expect("has a value there, too");
                assert_eq!(row[first..], jets[0].mixed[..]);
                found += 1;
            }
        }
        assert!(found > 10, "{found} points had values");
    }
}
