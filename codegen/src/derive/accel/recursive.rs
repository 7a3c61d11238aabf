//! Trees: ξ̇, M and forces by recursion over links.

use super::best::{Acceleration, Best, Family};
use super::cheapest::Computation;
use super::parts::Parts;
use super::setting::Setting;
use super::solve::{Plan, Solution, solve};
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph, Node};
use crate::algebra::linear::{Vec3, zero3};
use crate::algebra::transplant::map_symbols;
use crate::derive::loads;
use crate::derive::tree::inverse::{Wrench, inverse, wrenches};
use crate::derive::tree::momentum::{swing, total};
use crate::derive::tree::nearby::slopes;
use crate::derive::tree::{Placement, Tree, articulated, composite};
use crate::model::Model;
use crate::program::count::{count, depth};

/// Trees with more links are not tried by other routes.
const SHORT: usize = 3;

/// A model whose inertia is that of links.
pub struct Recursion {
    /// The model, its graph holding constants and loads.
    model: Model,
    tree: Tree,
    /// −∂V of what is not gravity.
    elastic: Vec<Edge>,
    /// fᴱ.
    applied: Vec<Edge>,
}

impl Recursion {
    /// The recursion over a model's links, where they are a tree.
    pub fn of(setting: &Setting, placement: Placement) -> Option<Self> {
        let mut model = setting.model.clone();
        let mut calculus = setting.calculus.clone();
        if !model.constraints.is_empty() || setting.back.is_some() {
            return None;
        }
        let tree = Tree::of(&mut model, &mut calculus, placement)?;
        let elastic = loads::elastic(&mut model, &mut calculus);
        let loads = loads::applied(&mut model, &mut calculus);
        let applied = (0..model.n())
            .map(|i| {
                let column: Vec<Edge> = loads.iter().map(|load| load[i]).collect();
                model.graph.sum(&column)
            })
            .collect();
        Some(Recursion {
            model,
            tree,
            elastic,
            applied,
        })
    }

    /// Whether nothing else comes near the recursion.
    pub fn is_long(&self) -> bool {
        self.tree.links.len() > SHORT
    }

    /// What acts beside gravity.
    fn load(&self, graph: &mut Graph) -> Vec<Edge> {
        let both = self.elastic.iter().zip(&self.applied);
        both.map(|(&a, &b)| graph.add(a, b)).collect()
    }

    /// Counts articulated bodies, and M with elimination from the leaves and from the root.
    pub(super) fn search(&self, best: &mut Best) {
        let n = self.model.n();
        let rest = vec![self.model.graph.zero(); n];
        let (xi, gravity) = (&self.model.xi, self.model.gravity);
        if self.tree.is_plain(&self.model.graph, n) {
            let mut graph = self.model.graph.clone();
            let load = self.load(&mut graph);
            let forces = wrenches(&mut graph, &self.tree, xi, &rest, gravity);
            if let Some(solution) = articulated::forward(&mut graph, &self.tree, &forces, &load) {
                let route = "links traced, articulated bodies".to_string();
                let candidate = candidate(graph, solution.xi_dot, solution.pivots, route);
                best.keep(Family::Links, candidate);
            }
        }
        let mut graph = self.model.graph.clone();
        let load = self.load(&mut graph);
        let bias = inverse(&mut graph, &self.tree, xi, &rest, gravity);
        let mass = composite::mass_matrix(&mut graph, &self.tree, n);
        let right = load
            .iter()
            .zip(&bias)
            .map(|(&load, &bias)| graph.sub(load, bias))
            .collect();
        let given = Parts {
            mass,
            groups: vec![right],
            ..Parts::default()
        };
        for order in [(0..n).rev().collect::<Vec<_>>(), (0..n).collect()] {
            let way = if order.first() == Some(&0) {
                "from the first velocity to the last"
            } else {
                "from the last velocity to the first"
            };
            let plan = Plan {
                order,
                apart: 0,
                scale: false,
                inverse: false,
            };
            let mut graph = graph.clone();
            if let Some(solution) = solve(&mut graph, &given, &plan) {
                let route = format!("links traced, composite bodies, M eliminated {way}");
                let candidate = candidate(graph, solution.xi_dot, solution.pivots, route);
                best.keep(Family::Links, candidate);
            }
        }
    }

    /// M and forces.
    pub fn parts(&self) -> Computation {
        let mut graph = self.model.graph.clone();
        let n = self.model.n();
        let (xi, gravity) = (&self.model.xi, self.model.gravity);
        let (still, weightless) = (vec![graph.zero(); n], zero3(&graph));
        let whole = inverse(&mut graph, &self.tree, xi, &self.model.xi_dot, gravity);
        let inverse_dynamics = whole
            .iter()
            .zip(&self.elastic)
            .map(|(&whole, &elastic)| graph.sub(whole, elastic))
            .collect();
        let bias = inverse(&mut graph, &self.tree, xi, &still, weightless);
        let weight = inverse(&mut graph, &self.tree, &still, &still, gravity);
        let momentum = inverse(&mut graph, &self.tree, &still, xi, weightless);
        let mass = composite::mass_matrix(&mut graph, &self.tree, n);
        let conservative = self
            .elastic
            .iter()
            .zip(&weight)
            .map(|(&elastic, &weight)| graph.sub(elastic, weight))
            .collect();
        let parts = Parts {
            mass,
            groups: Vec::new(),
            inertia: bias.into_iter().map(|edge| -edge).collect(),
            conservative,
            applied: self.applied.clone(),
            inverse_dynamics: Some(inverse_dynamics),
            momentum: Some(momentum),
        };
        Computation { graph, parts }
    }

    /// ṗ of (x, ξ, u), in a graph of its own; `None` where a joint varies with x.
    pub fn momentum_rate(&self) -> Option<(Graph, Vec<Edge>)> {
        let mut graph = self.model.graph.clone();
        let still = vec![graph.zero(); self.model.n()];
        let swing = swing(&mut graph, &self.tree, &self.model.xi)?;
        let weight = inverse(&mut graph, &self.tree, &still, &still, self.model.gravity);
        let load = self.load(&mut graph);
        let rate = (0..self.model.n()).map(|i| {
            let terms = [swing[i], load[i], -weight[i]];
            graph.sum(&terms)
        });
        let rate = rate.collect();
        Some((graph, rate))
    }

    /// The momentum of everything in a graph of its own: linear and about the origin of the world, in its
    /// axes. The links have to be the description's: others move as these do and have other momenta.
    pub fn total_momentum(&self) -> (Graph, Vec3, Vec3) {
        let mut graph = self.model.graph.clone();
        let (linear, angular) = total(&mut graph, &self.tree, &self.model.xi);
        (graph, linear, angular)
    }

    /// ξ = M⁻¹ p by articulated bodies: what ξ̇ is where nothing but p acts; `None` where a velocity is not
    /// the rate of one freedom, or M is singular everywhere.
    pub fn velocity_from_momentum(&self) -> Option<(Graph, Solution)> {
        let mut graph = self.model.graph.clone();
        if !self.tree.is_plain(&graph, self.model.n()) {
            return None;
        }
        let none = zero3(&graph);
        let nothing = Wrench {
            force: none,
            torque: none,
        };
        let wrenches = vec![nothing; self.tree.links.len()];
        let momenta = &self.model.momenta;
        let solution = articulated::forward(&mut graph, &self.tree, &wrenches, momenta)?;
        Some((graph, solution))
    }

    /// ∂(f − M ξ̇ − Γ ξ ξ − ∂V) along displacements, velocities and inputs at constant ξ̇: n rows of
    /// 2 n + m, in `into`, where ξ̇ is F. `None` where a joint varies with x.
    pub fn slopes(&self, into: &mut Graph, rates: &[Edge]) -> Option<Vec<Vec<Edge>>> {
        let mut graph = self.model.graph.clone();
        let model = &self.model;
        let (xi, xi_dot) = (&model.xi, &model.xi_dot);
        let found = slopes(&mut graph, &self.tree, xi, xi_dot, model.gravity)?;
        let load = self.load(&mut graph);
        let one = graph.one();
        let mut along: Vec<Derivation> = (0..xi.len())
            .map(|j| {
                Derivation::new(
                    model
                        .x
                        .iter()
                        .zip(&model.a)
                        .map(|(x, row)| (x.node(), row[j])),
                )
            })
            .collect();
        let symbols = xi.iter().chain(&model.u);
        along.extend(symbols.map(|symbol| Derivation::new([(symbol.node(), one)])));
        let mut images: Vec<Edge> = into.symbols().iter().map(|s| Edge::of(s.node)).collect();
        for (symbol, &rate) in xi_dot.iter().zip(rates) {
            if let Node::Symbol(index) = graph.node(symbol.node()) {
                images[index as usize] = rate;
            }
        }
        let mut rows = Vec::new();
        for (i, &force) in load.iter().enumerate() {
            let mut row: Vec<Edge> = along.iter_mut().map(|d| d.of(&mut graph, force)).collect();
            let both = found.displacement[i].iter().chain(&found.velocity[i]);
            for (entry, &slope) in row.iter_mut().zip(both) {
                *entry = graph.sub(*entry, slope);
            }
            rows.push(map_symbols(&graph, into, &row, &images));
        }
        Some(rows)
    }
}

/// A candidate, counted.
fn candidate(graph: Graph, xi_dot: Vec<Edge>, pivots: Vec<Edge>, route: String) -> Acceleration {
    let mut roots = xi_dot.clone();
    roots.extend(pivots.iter().filter(|pivot| !graph.is_free(pivot.node())));
    Acceleration {
        other: None,
        count: count(&graph, &roots),
        depth: depth(&graph, &roots),
        graph,
        xi_dot,
        pivots,
        multipliers: Vec::new(),
        projections: None,
        loss: 0,
        route,
    }
}
