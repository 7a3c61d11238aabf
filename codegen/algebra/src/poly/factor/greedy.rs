//! Greedy extraction of divisors: the one that saves most comes first, until none saves anything.

use super::divisor::{Divisor, Occurrence, Strategy};
use super::network::{Network, Node};
use super::system::{Literal, Literals, System};
use std::cmp::Reverse;

/// Returns the system after extraction, and the work it took. Stops early once the work exceeds `most`.
pub(super) fn extract_divisors(system: &System, strategy: Strategy, most: u64) -> (System, u64) {
    let mut network = Network::new(system, strategy);
    while network.work <= most {
        let Some((score, Reverse(divisor))) = network.queue.pop() else {
            break;
        };
        let saved = match divisor {
            Divisor::Kernel(index) => network.kernel_saving(index),
            Divisor::Cube(index) => network.cube_saving(index),
        };
        if saved <= 0 {
            continue;
        }
        // Entries of the queue are out of date once a product that they count has been removed.
        if network.strategy.score(divisor, saved) < score {
            network.push(divisor, saved);
            continue;
        }
        match divisor {
            Divisor::Kernel(index) => network.extract_kernel(index),
            Divisor::Cube(index) => network.extract_cube(index),
        }
    }
    let sums = network.products();
    let system = System {
        sums,
        ..system.clone()
    };
    (system.compact(), network.work)
}

impl Network {
    /// Returns occurrences of a kernel that can be replaced together, with its definition first; and
    /// whether there is a definition, that is, a sum that consists of the kernel alone.
    fn disjoint_occurrences(&mut self, kernel: usize) -> (Vec<Occurrence>, bool) {
        let mut candidates = self.occurrences(kernel);
        let defines = |o: &Occurrence| o.size == 0 && self.sums[self.nodes[o.first].sum].len() == 2;
        candidates.sort_by_key(|o| (Reverse(defines(o)), Reverse(o.saved), o.first, o.second));
        let mut chosen: Vec<Occurrence> = Vec::new();
        for o in candidates {
            let taken = |p: &Occurrence| {
                [p.first, p.second].contains(&o.first) || [p.first, p.second].contains(&o.second)
            };
            if !chosen.iter().any(taken) {
                chosen.push(o);
            }
        }
        let defined = chosen.first().is_some_and(defines);
        (chosen, defined)
    }

    /// Number of operations that extracting a kernel saves at present.
    fn kernel_saving(&mut self, kernel: usize) -> i64 {
        let (chosen, _) = self.disjoint_occurrences(kernel);
        chosen.iter().map(|o| o.saved).sum::<i64>() - self.kernels[kernel].cost
    }

    /// Number of operations that extracting a cube saves at present.
    fn cube_saving(&mut self, cube: usize) -> i64 {
        let nodes = &self.nodes;
        let entry = &mut self.cubes[cube];
        entry.nodes.retain(|&node| nodes[node].alive);
        self.work += entry.nodes.len() as u64;
        let counts = entry.nodes.iter();
        let counts = counts.map(|&node| count(&nodes[node].literals, entry.pair) as i64);
        entry.saved = counts.sum::<i64>() - 1;
        entry.saved
    }

    fn extract_kernel(&mut self, kernel: usize) {
        let (chosen, defined) = self.disjoint_occurrences(kernel);
        let Some(&model) = chosen.first() else {
            return;
        };
        let (_, first, second) = self.divide(model);
        let sign = self.nodes[model.first].negative;
        let definition = if defined {
            self.nodes[model.first].sum
        } else {
            let relative = sign != self.nodes[model.second].negative;
            let sum = self.new_sum();
            self.insert(sum, false, first.clone());
            self.insert(sum, relative, second.clone());
            sum
        };
        let literal = self.literal(definition);
        for &o in chosen.iter().skip(usize::from(defined)) {
            let (mut cofactor, a, b) = self.divide(o);
            // Products with equal hashes are almost certainly equal; this comparison makes sure. In
            // addition, a product may have been removed because a literal in it was forwarded.
            let alive = self.nodes[o.first].alive && self.nodes[o.second].alive;
            if !alive || a != first || b != second {
                continue;
            }
            cofactor.push(literal);
            let node = &self.nodes[o.first];
            let (sum, negative) = (node.sum, node.negative != (defined && sign));
            self.remove(o.first);
            self.remove(o.second);
            self.insert(sum, negative, cofactor);
            self.forward(sum);
        }
    }

    fn extract_cube(&mut self, cube: usize) {
        let (a, b) = self.cubes[cube].pair;
        let nodes = self.cubes[cube].nodes.clone();
        let bare = |&&node: &&usize| {
            let node: &Node = &self.nodes[node];
            node.literals[..] == [a, b] && !node.negative && self.sums[node.sum].len() == 1
        };
        let known = nodes.iter().find(bare).copied();
        let definition = match known {
            Some(node) => self.nodes[node].sum,
            None => {
                let sum = self.new_sum();
                self.insert(sum, false, Literals::from_slice(&[a, b]));
                sum
            }
        };
        let literal = self.literal(definition);
        for node in nodes.into_iter().filter(|&node| Some(node) != known) {
            if !self.nodes[node].alive {
                continue;
            }
            let mut literals = self.nodes[node].literals.clone();
            for _ in 0..count(&literals, (a, b)) {
                for factor in [a, b] {
                    if let Ok(position) = literals.binary_search(&factor) {
                        literals.remove(position);
                    }
                }
                literals.push(literal);
                literals.sort_unstable();
            }
            let (sum, negative) = (self.nodes[node].sum, self.nodes[node].negative);
            self.remove(node);
            self.insert(sum, negative, literals);
            self.forward(sum);
        }
    }

    /// Returns the cofactor m and the parts c₁, c₂ of an occurrence.
    fn divide(&self, o: Occurrence) -> (Literals, Literals, Literals) {
        let (mut m, mut first) = (Literals::new(), Literals::new());
        let mut second = self.nodes[o.second].literals.clone();
        for &literal in &self.nodes[o.first].literals {
            match second.binary_search(&literal) {
                Ok(position) => m.push(second.remove(position)),
                Err(_) => first.push(literal),
            }
        }
        (m, first, second)
    }

    fn new_sum(&mut self) -> usize {
        self.sums.push(Vec::new());
        self.sums.len() - 1
    }

    /// If a sum has become a single literal, replaces the sum by it everywhere.
    fn forward(&mut self, sum: usize) {
        let &[node] = self.sums[sum].as_slice() else {
            return;
        };
        let &[target] = self.nodes[node].literals.as_slice() else {
            return;
        };
        let (own, negative) = (self.literal(sum), self.nodes[node].negative);
        for user in 0..self.nodes.len() {
            if !self.nodes[user].alive || !self.nodes[user].literals.contains(&own) {
                continue;
            }
            let mut literals = self.nodes[user].literals.clone();
            let mut flipped = self.nodes[user].negative;
            for literal in literals.iter_mut().filter(|literal| **literal == own) {
                *literal = target;
                flipped ^= negative;
            }
            let user_sum = self.nodes[user].sum;
            self.remove(user);
            self.insert(user_sum, flipped, literals);
        }
    }
}

/// Number of times that a pair of literals can be taken from a product.
fn count(literals: &[Literal], (a, b): (Literal, Literal)) -> usize {
    let of = |l: Literal| literals.iter().filter(|&&other| other == l).count();
    if a == b { of(a) / 2 } else { of(a).min(of(b)) }
}
