//! Values with first and mixed second derivatives modulo p, by hyper-dual numbers: f, its slope f₁ along
//! one direction, its slopes f₂ along many others, and all f₁₂, without a derivative ever being written
//! as an expression.
//!
//! With symbols x(s, t) that have ∂x/∂s = x₁, ∂x/∂t = x₂ and ∂²x/∂s∂t = x₁₂,
//! f₁₂ = D²f [x₁, x₂] + Df(x₁₂).

use super::fp::Fp;
use super::graph::Function;
use super::lane::Lane;
use super::tape::{Operand, Step, Tape, linear_form};

/// How symbols move: one entry for each symbol, 0 beyond the end.
#[derive(Clone, Debug, Default)]
pub struct Seeds {
    /// x₁.
    pub along: Vec<Fp>,
    /// x₂ of every column.
    pub across: Vec<Vec<Fp>>,
    /// x₁₂ of every column, 0 for columns beyond the end.
    pub mixed: Vec<Vec<Fp>>,
}

/// f, f₁, and f₂, f₁₂ for every column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Jet {
    /// f.
    pub value: Fp,
    /// f₁.
    pub along: Fp,
    /// f₂ of every column; empty where nothing of it moves.
    pub across: Vec<Fp>,
    /// f₁₂ of every column; empty where nothing of it moves.
    pub mixed: Vec<Fp>,
}

impl Jet {
    /// f₂ of a column.
    pub fn across(&self, column: usize) -> Fp {
        self.across.get(column).copied().unwrap_or(Fp::ZERO)
    }

    /// f₁₂ of a column.
    pub fn mixed(&self, column: usize) -> Fp {
        self.mixed.get(column).copied().unwrap_or(Fp::ZERO)
    }

    /// Whether nothing of it moves.
    pub fn is_still(&self) -> bool {
        self.across.is_empty()
    }
}

/// Derivatives of all steps so far; those that do not move have no columns.
struct Columns {
    value: Vec<Fp>,
    along: Vec<Fp>,
    across: Vec<Vec<Fp>>,
    mixed: Vec<Vec<Fp>>,
}

impl Columns {
    /// An entry of a table that may be empty, with a sign.
    fn entry(table: &[Vec<Fp>], operand: Operand, column: usize) -> Fp {
        let row = table.get(operand.place).map_or(&[][..], Vec::as_slice);
        let value = row.get(column).copied().unwrap_or(Fp::ZERO);
        if operand.negative { -value } else { value }
    }

    fn moves(&self, operand: Operand) -> bool {
        self.across
            .get(operand.place)
            .is_some_and(|row| !row.is_empty())
    }
}

impl Tape {
    /// Jets of the expressions at a point; `None` where something has no value there.
    pub fn jets(&self, lane: &Lane, seeds: &Seeds) -> Option<Vec<Jet>> {
        let mut lane = lane.clone();
        let (size, width) = (self.steps.len(), seeds.across.len());
        let mut all = Columns {
            value: Vec::with_capacity(size),
            along: Vec::with_capacity(size),
            across: Vec::with_capacity(size),
            mixed: Vec::with_capacity(size),
        };
        for step in &self.steps {
            let (value, along, across, mixed) = self.step(step, &mut lane, &all, seeds)?;
            all.value.push(value);
            all.along.push(along);
            all.across.push(across);
            all.mixed.push(mixed);
        }
        let columns = |table: &[Vec<Fp>], root: Operand| -> Vec<Fp> {
            let width = if all.moves(root) { width } else { 0 };
            (0..width).map(|k| Columns::entry(table, root, k)).collect()
        };
        (!lane.is_stuck()).then(|| {
            let jet = |&root: &Operand| Jet {
                value: root.of(&all.value),
                along: root.of(&all.along),
                across: columns(&all.across, root),
                mixed: columns(&all.mixed, root),
            };
            self.roots.iter().map(jet).collect()
        })
    }

    fn step(
        &self,
        step: &Step,
        lane: &mut Lane,
        all: &Columns,
        seeds: &Seeds,
    ) -> Option<(Fp, Fp, Vec<Fp>, Vec<Fp>)> {
        let width = seeds.across.len();
        let still = |value: Fp| Some((value, Fp::ZERO, Vec::new(), Vec::new()));
        let pair =
            |f: &dyn Fn(usize) -> (Fp, Fp)| -> (Vec<Fp>, Vec<Fp>) { (0..width).map(f).unzip() };
        let second = |operand: Operand, k: usize| Columns::entry(&all.across, operand, k);
        let mixed = |operand: Operand, k: usize| Columns::entry(&all.mixed, operand, k);
        let value = |operand: Operand| operand.of(&all.value);
        let first = |operand: Operand| operand.of(&all.along);
        let done = |value: Fp, along: Fp, (across, mixed): (Vec<Fp>, Vec<Fp>)| {
            Some((value, along, across, mixed))
        };
        match step {
            Step::Constant(value) => still(*value),
            Step::Symbol(index) => {
                let at = |row: Option<&Vec<Fp>>| {
                    row.and_then(|row| row.get(*index))
                        .copied()
                        .unwrap_or(Fp::ZERO)
                };
                let along = at(Some(&seeds.along));
                let columns = pair(&|k| (at(seeds.across.get(k)), at(seeds.mixed.get(k))));
                let moves = |row: &[Fp]| row.iter().any(|entry| !entry.is_zero());
                if along.is_zero() && !moves(&columns.0) && !moves(&columns.1) {
                    return still(lane.symbol(*index));
                }
                done(lane.symbol(*index), along, columns)
            }
            Step::Add(a, b) => {
                let (a, b) = (*a, *b);
                let sum = value(a) + value(b);
                if !all.moves(a) && !all.moves(b) {
                    return still(sum);
                }
                let columns = pair(&|k| (second(a, k) + second(b, k), mixed(a, k) + mixed(b, k)));
                done(sum, first(a) + first(b), columns)
            }
            Step::Mul(a, b) => {
                let (a, b) = (*a, *b);
                let (va, vb, fa, fb) = (value(a), value(b), first(a), first(b));
                match (all.moves(a), all.moves(b)) {
                    (false, false) => still(va * vb),
                    (true, false) => done(
                        va * vb,
                        fa * vb,
                        pair(&|k| (second(a, k) * vb, mixed(a, k) * vb)),
                    ),
                    (false, true) => done(
                        va * vb,
                        va * fb,
                        pair(&|k| (va * second(b, k), va * mixed(b, k))),
                    ),
                    (true, true) => {
                        let columns = pair(&|k| {
                            let (sa, sb) = (second(a, k), second(b, k));
                            let cross = fa * sb + sa * fb;
                            (
                                sa * vb + va * sb,
                                mixed(a, k) * vb + va * mixed(b, k) + cross,
                            )
                        });
                        done(va * vb, fa * vb + va * fb, columns)
                    }
                }
            }
            Step::Div(a, b) => {
                let (a, b) = (*a, *b);
                let inverse = value(b).inv()?;
                let quotient = value(a) * inverse;
                if !all.moves(a) && !all.moves(b) {
                    return still(quotient);
                }
                let slope = (first(a) - quotient * first(b)) * inverse;
                let columns = pair(&|k| {
                    let across = (second(a, k) - quotient * second(b, k)) * inverse;
                    let rest = slope * second(b, k) + across * first(b) + quotient * mixed(b, k);
                    (across, (mixed(a, k) - rest) * inverse)
                });
                done(quotient, slope, columns)
            }
            Step::Apply(function, a, form) => {
                let a = *a;
                let form = linear_form(form, &all.value);
                let argument = value(a);
                let result = lane.function(*function, argument, &form);
                if !all.moves(a) {
                    return still(result);
                }
                // f′ and f″.
                let one = lane.slope(*function, argument, &form, result)?;
                let two = match function {
                    Function::Sin | Function::Cos => -result,
                    Function::Exp => result,
                    Function::Log => -(one * one),
                    Function::Sqrt => -(one * (argument + argument).inv()?),
                    // Two arguments: its own step.
                    Function::Atan2 => Fp::ZERO,
                };
                let bent = two * first(a);
                let columns =
                    pair(&|k| (one * second(a, k), bent * second(a, k) + one * mixed(a, k)));
                done(result, one * first(a), columns)
            }
            Step::Atan2(y, x) => {
                let (y, x) = (*y, *x);
                let result = lane.opaque(Function::Atan2, value(y), value(x));
                if !all.moves(y) && !all.moves(x) {
                    return still(result);
                }
                let inverse = (value(x) * value(x) + value(y) * value(y)).inv()?;
                let slope = (value(x) * first(y) - value(y) * first(x)) * inverse;
                let columns = pair(&|k| {
                    let across = (value(x) * second(y, k) - value(y) * second(x, k)) * inverse;
                    let turned = second(x, k) * first(y) + value(x) * mixed(y, k)
                        - second(y, k) * first(x)
                        - value(y) * mixed(x, k);
                    let half = value(x) * second(x, k) + value(y) * second(y, k);
                    (across, (turned - slope * (half + half)) * inverse)
                });
                done(result, slope, columns)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Seeds;
    use crate::derivation::Derivation;
    use crate::fp::{Fp, Random};
    use crate::graph::{Edge, Graph};
    use crate::lane::Lane;
    use crate::numeric::evaluate_at;
    use crate::tape::Tape;
    use crate::tests::quotients;

    /// Symbols s, t, a(s, t) = s t + s, b(s, t) = s² − t of the chain rule, and functions of a and b.
    #[test]
    fn mixed_derivatives_are_those_of_the_symbolic_derivative() {
        let mut random = Random::new(5);
        let mut graph = Graph::new(1, 0);
        let [s, t, a, b] = ["s", "t", "a", "b"].map(|name| graph.symbol(name, 2, random.element()));
        let product = graph.mul(a, b);
        let mut roots = vec![graph.sub(product, b)];
        roots.extend(quotients(&mut graph, roots[0], a));
        roots.push(graph.atan2(roots[0], b));
        let seeded = |graph: &mut Graph, seeds: [(Edge, Edge); 3]| {
            let _ = &graph;
            Derivation::new(seeds.map(|(symbol, seed)| (symbol.node(), seed)))
        };
        // a₁ = t + 1, b₁ = 2 s; a₂ = s, b₂ = −1; a₁₂ = 1, b₁₂ = 0.
        let one = graph.one();
        let (more, twice) = (graph.add(t, one), graph.add(s, s));
        let mut by_s = seeded(&mut graph, [(s, one), (a, more), (b, twice)]);
        let mut by_t = seeded(&mut graph, [(t, one), (a, s), (b, -one)]);
        let along = by_s.all(&mut graph, &roots);
        let across = by_t.all(&mut graph, &roots);
        let mixed = by_t.all(&mut graph, &along);
        let tape = Tape::new(&graph, &roots).expect("numbers");
        let mut found = 0;
        for seed in 0..40 {
            let mut lane = Lane::new(seed);
            (0..4).for_each(|_| lane.push_symbol(random.element()));
            let (s, t) = (lane.symbol(0), lane.symbol(1));
            let (zero, one) = (Fp::ZERO, Fp::ONE);
            let seeds = Seeds {
                along: vec![one, zero, t + one, s + s],
                across: vec![vec![zero, one, s, -one], vec![]],
                mixed: vec![vec![zero, zero, one, zero]],
            };
            let Some(jets) = tape.jets(&lane, &seeds) else {
                continue;
            };
            let expect =
                |edges: &[Edge]| evaluate_at(&graph, edges, &mut lane.clone()).expect("a value");
            let tables = [
                expect(&roots),
                expect(&along),
                expect(&across),
                expect(&mixed),
            ];
            for (i, jet) in jets.iter().enumerate() {
                assert_eq!(
                    [jet.value, jet.along, jet.across[0], jet.mixed[0]],
                    [tables[0][i], tables[1][i], tables[2][i], tables[3][i]],
                    "expression {i}"
                );
                assert_eq!([jet.across[1], jet.mixed[1]], [zero, zero]);
            }
            assert_eq!(tape.values(&lane), Some(tables[0].clone()));
            found += 1;
        }
        assert!(found > 5);
    }
}
