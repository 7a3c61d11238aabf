//! Several sums of products at once: f_k = Σ ± Π literals, where a literal is an input (a constant
//! or a variable) or the value of another sum.

use super::program::{Builder, Operand, Program, Value};
use smallvec::SmallVec;
use std::collections::{BTreeMap, BTreeSet};

/// An input by its index, or a sum by `inputs.len()` + its index.
pub(super) type Literal = u32;

/// Literals of a product; short lists need no heap allocation.
pub(super) type Literals = SmallVec<[Literal; 8]>;

/// ± Π literals, ascending, repeated for powers.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Product {
    pub(super) negative: bool,
    pub(super) literals: Literals,
}

/// Sums of products. The first sums are the outputs; no sum depends on itself.
#[derive(Clone, Debug)]
pub(super) struct System {
    pub(super) inputs: Vec<Value>,
    pub(super) outputs: usize,
    pub(super) sums: Vec<Vec<Product>>,
}

impl System {
    /// Returns the sum that a literal stands for, if it is not an input.
    pub(super) fn sum_of(&self, literal: Literal) -> Option<usize> {
        (literal as usize).checked_sub(self.inputs.len())
    }

    /// Returns the sums in use, each after those it depends on.
    fn schedule(&self) -> Vec<usize> {
        let mut done = vec![false; self.sums.len()];
        let mut result = Vec::new();
        // (sum, whether its dependencies are scheduled)
        let mut stack: Vec<(usize, bool)> = (0..self.outputs).rev().map(|k| (k, false)).collect();
        while let Some((sum, ready)) = stack.pop() {
            if done[sum] {
                continue;
            }
            if ready {
                done[sum] = true;
                result.push(sum);
                continue;
            }
            stack.push((sum, true));
            let literals = self.sums[sum].iter().flat_map(|product| &product.literals);
            let needed: Vec<usize> = literals.filter_map(|&l| self.sum_of(l)).collect();
            stack.extend(needed.into_iter().rev().map(|sum| (sum, false)));
        }
        result
    }

    /// Number of operations, where nothing is shared except through literals.
    pub(super) fn operations(&self) -> usize {
        let sums = self.schedule();
        let cost = |&sum: &usize| {
            let products = &self.sums[sum];
            let factors = products.iter().map(|p| p.literals.len().saturating_sub(1));
            factors.sum::<usize>() + products.len().saturating_sub(1)
        };
        sums.iter().map(cost).sum()
    }

    /// Builds the program that evaluates the sums in use.
    pub(super) fn program(&self) -> Program {
        let mut builder = Builder::default();
        let mut values = vec![Operand::new(Value::Zero); self.sums.len()];
        for sum in self.schedule() {
            let mut total = Operand::new(Value::Zero);
            for product in &self.sums[sum] {
                let factors = product
                    .literals
                    .iter()
                    .map(|&literal| match self.sum_of(literal) {
                        Some(sum) => values[sum],
                        None => Operand::new(self.inputs[literal as usize]),
                    });
                let one = Operand::new(Value::Coefficient(0));
                let value = factors.fold(one, |value, factor| builder.mul(value, factor));
                total = builder.add(total, value.negated_if(product.negative));
            }
            values[sum] = total;
        }
        let mut program = builder.program;
        program.outputs = values[..self.outputs].to_vec();
        program
    }

    /// Multiplies out the chosen sums where they are used, as long as no product grows into more than
    /// `most` products, and drops sums that are not in use.
    pub(super) fn expanded(&self, chosen: &BTreeSet<usize>, most: usize) -> System {
        let mut sums: Vec<Vec<Product>> = vec![Vec::new(); self.sums.len()];
        let schedule = self.schedule();
        for &sum in &schedule {
            let products = self.sums[sum].iter();
            sums[sum] = cancelled(products.flat_map(|product| {
                let mut result = vec![Product {
                    negative: product.negative,
                    literals: Literals::new(),
                }];
                for &literal in &product.literals {
                    let inner = self.sum_of(literal).filter(|inner| chosen.contains(inner));
                    match inner.map(|inner| &sums[inner]) {
                        Some(inner) if inner.len() * result.len() <= most => {
                            result = multiply(&result, inner);
                        }
                        _ => result.iter_mut().for_each(|p| p.literals.push(literal)),
                    }
                }
                result
            }));
        }
        System {
            sums,
            ..self.clone()
        }
        .compact()
    }

    /// Drops the sums that are not in use.
    pub(super) fn compact(self) -> System {
        let mut kept: Vec<usize> = (0..self.outputs).collect();
        let scheduled = self.schedule().into_iter();
        kept.extend(scheduled.filter(|&sum| sum >= self.outputs));
        let mut renamed: Vec<usize> = vec![0; self.sums.len()];
        for (position, &sum) in kept.iter().enumerate() {
            renamed[sum] = position;
        }
        let rename = |product: &Product| {
            let literals = product.literals.iter();
            let literals = literals.map(|&literal| match self.sum_of(literal) {
                Some(sum) => (self.inputs.len() + renamed[sum]) as Literal,
                None => literal,
            });
            let mut literals: Literals = literals.collect();
            literals.sort_unstable();
            Product {
                literals,
                ..*product
            }
        };
        let sums = kept
            .iter()
            .map(|&sum| self.sums[sum].iter().map(rename).collect());
        System {
            sums: sums.collect(),
            ..self
        }
    }
}

/// Returns the products of each product in a with each in b.
fn multiply(a: &[Product], b: &[Product]) -> Vec<Product> {
    let pairs = a.iter().flat_map(|p| b.iter().map(move |q| (p, q)));
    let product = |(p, q): (&Product, &Product)| Product {
        negative: p.negative != q.negative,
        literals: p.literals.iter().chain(&q.literals).copied().collect(),
    };
    pairs.map(product).collect()
}

/// Returns the products in their order, with sorted literals and without pairs that cancel.
pub(super) fn cancelled(products: impl Iterator<Item = Product>) -> Vec<Product> {
    let mut result: Vec<Product> = Vec::new();
    let mut open: BTreeMap<(Literals, bool), Vec<usize>> = BTreeMap::new();
    let mut dropped = BTreeSet::new();
    for mut product in products {
        product.literals.sort_unstable();
        let opposite = (product.literals.clone(), !product.negative);
        if let Some(index) = open.get_mut(&opposite).and_then(Vec::pop) {
            dropped.insert(index);
            continue;
        }
        let key = (product.literals.clone(), product.negative);
        open.entry(key).or_default().push(result.len());
        result.push(product);
    }
    let kept = result.into_iter().enumerate();
    kept.filter_map(|(index, product)| (!dropped.contains(&index)).then_some(product))
        .collect()
}
