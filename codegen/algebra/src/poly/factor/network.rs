//! The products of a system under rewriting, with an index of all divisors in them.

use super::divisor::{Cube, Divisor, Kernel, Occurrence, Strategy, common, mix, multiplications};
use super::system::{Literal, Literals, Product, System};
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A product in a sum.
pub(super) struct Node {
    pub(super) sum: usize,
    pub(super) negative: bool,
    pub(super) literals: Literals,
    hash: u64,
    pub(super) alive: bool,
}

/// A system under rewriting, with an index of its divisors.
pub(super) struct Network {
    pub(super) inputs: usize,
    pub(super) nodes: Vec<Node>,
    /// The alive nodes of each sum.
    pub(super) sums: Vec<Vec<usize>>,
    pub(super) kernels: Vec<Kernel>,
    occurrences: Vec<Occurrence>,
    pub(super) cubes: Vec<Cube>,
    kernel_index: FxHashMap<(u64, u64, bool), usize>,
    cube_index: FxHashMap<(Literal, Literal), usize>,
    /// Divisors with upper bounds of their scores, which are checked when an entry is popped.
    pub(super) queue: BinaryHeap<(i64, Reverse<Divisor>)>,
    pub(super) strategy: Strategy,
    /// Number of pairs of products examined so far.
    pub(super) work: u64,
    /// Whether the network is still being built, in which case nothing is queued yet.
    indexing: bool,
}

impl Network {
    /// Builds the network of a system.
    pub(super) fn new(system: &System, strategy: Strategy) -> Self {
        let mut network = Network {
            inputs: system.inputs.len(),
            nodes: Vec::new(),
            sums: vec![Vec::new(); system.sums.len()],
            kernels: Vec::new(),
            occurrences: Vec::new(),
            cubes: Vec::new(),
            kernel_index: FxHashMap::default(),
            cube_index: FxHashMap::default(),
            queue: BinaryHeap::new(),
            strategy,
            work: 0,
            indexing: true,
        };
        for (sum, products) in system.sums.iter().enumerate() {
            for product in products {
                network.insert(sum, product.negative, product.literals.clone());
            }
        }
        network.indexing = false;
        for index in 0..network.kernels.len() {
            network.push(Divisor::Kernel(index), network.kernels[index].saved);
        }
        for index in 0..network.cubes.len() {
            network.push(Divisor::Cube(index), network.cubes[index].saved);
        }
        network
    }

    /// Returns the present sums.
    pub(super) fn products(&self) -> Vec<Vec<Product>> {
        let product = |&node: &usize| Product {
            negative: self.nodes[node].negative,
            literals: self.nodes[node].literals.clone(),
        };
        let sums = self.sums.iter();
        sums.map(|nodes| nodes.iter().map(product).collect())
            .collect()
    }

    /// Returns the literal that stands for a sum.
    pub(super) fn literal(&self, sum: usize) -> Literal {
        (self.inputs + sum) as Literal
    }

    /// Removes a product.
    pub(super) fn remove(&mut self, node: usize) {
        self.nodes[node].alive = false;
        self.sums[self.nodes[node].sum].retain(|&other| other != node);
    }

    /// Adds a product to a sum, and its divisors to the index.
    pub(super) fn insert(&mut self, sum: usize, negative: bool, mut literals: Literals) {
        literals.sort_unstable();
        let hash = literals
            .iter()
            .fold(0, |h: u64, &l| h.wrapping_add(mix(l.into())));
        let node = self.nodes.len();
        self.nodes.push(Node {
            sum,
            negative,
            literals,
            hash,
            alive: true,
        });
        for position in 0..self.sums[sum].len() {
            self.pair(self.sums[sum][position], node);
        }
        self.sums[sum].push(node);
        self.pairs_of_literals(node);
    }

    /// Indexes the kernel of two products in a sum.
    fn pair(&mut self, a: usize, b: usize) {
        self.work += 1;
        let (size, common) = common(&self.nodes[a].literals, &self.nodes[b].literals);
        let rest = |node: usize| self.nodes[node].hash.wrapping_sub(common);
        if rest(a) == rest(b) {
            return;
        }
        let (first, second) = if rest(a) < rest(b) { (a, b) } else { (b, a) };
        let negative = self.nodes[a].negative != self.nodes[b].negative;
        let key = (rest(first), rest(second), negative);
        let new = self.kernels.len();
        let kernel = *self.kernel_index.entry(key).or_insert(new);
        let length = |node: usize| self.nodes[node].literals.len();
        if kernel == new {
            let parts = [first, second].map(|node| multiplications(length(node) - size));
            let cost = parts[0] + parts[1] + 1;
            self.kernels.push(Kernel {
                cost,
                saved: -cost,
                latest: None,
            });
        }
        let entry = &mut self.kernels[kernel];
        let before = multiplications(length(first)) + multiplications(length(second)) + 1;
        let saved = before - size as i64;
        let occurrence = Occurrence {
            first,
            second,
            size,
            saved,
            previous: entry.latest,
        };
        entry.latest = Some(self.occurrences.len());
        entry.saved += saved;
        self.occurrences.push(occurrence);
        let saved = entry.saved;
        self.push(Divisor::Kernel(kernel), saved);
    }

    /// Returns the occurrences of a kernel whose products are alive.
    pub(super) fn occurrences(&mut self, kernel: usize) -> Vec<Occurrence> {
        let mut result = Vec::new();
        let entry = &mut self.kernels[kernel];
        let mut next = entry.latest.take();
        entry.saved = -entry.cost;
        while let Some(index) = next {
            let occurrence = &mut self.occurrences[index];
            next = occurrence.previous;
            self.work += 1;
            if self.nodes[occurrence.first].alive && self.nodes[occurrence.second].alive {
                occurrence.previous = entry.latest;
                entry.latest = Some(index);
                entry.saved += occurrence.saved;
                result.push(*occurrence);
            }
        }
        result
    }

    /// Indexes the cubes of a product.
    fn pairs_of_literals(&mut self, node: usize) {
        let literals = self.nodes[node].literals.clone();
        let powers: Vec<(Literal, i64)> = literals
            .chunk_by(|a, b| a == b)
            .map(|power| (power[0], power.len() as i64))
            .collect();
        for (position, &(b, n)) in powers.iter().enumerate() {
            let squares = (b, n / 2);
            let mixed = powers[..position].iter().map(|&(a, m)| (a, m.min(n)));
            for (a, count) in mixed.chain([squares]).filter(|entry| entry.1 > 0) {
                let new = self.cubes.len();
                let cube = *self.cube_index.entry((a, b)).or_insert(new);
                if cube == new {
                    self.cubes.push(Cube {
                        pair: (a, b),
                        saved: -1,
                        nodes: Vec::new(),
                    });
                }
                let entry = &mut self.cubes[cube];
                entry.nodes.push(node);
                entry.saved += count;
                let saved = entry.saved;
                self.push(Divisor::Cube(cube), saved);
            }
        }
    }

    /// Queues a divisor that may save this number of operations.
    pub(super) fn push(&mut self, divisor: Divisor, saved: i64) {
        if saved > 0 && !self.indexing {
            let score = self.strategy.score(divisor, saved);
            self.queue.push((score, Reverse(divisor)));
        }
    }
}
