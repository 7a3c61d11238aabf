//! Carries a model over to a graph without the velocities that were solved for.

use super::kinetic::{drift, kinetic_terms};
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::transplant::map_symbols;
use crate::model::completion::Completion;
use crate::model::invariants::{Invariant, Quantity};
use crate::model::pfaffian::Pfaffian;
use crate::model::value::Value;
use crate::model::{Group, KineticTerms, Model, class};
use crate::syntax::ast::ShapeKind;

/// Carries a model over to a graph without the velocities that were solved for.
pub struct Carrier {
    full: Model,
    graph: Graph,
    /// What every symbol of the full model's graph becomes.
    pub images: Vec<Edge>,
    /// The same in the graph with unconstrained points.
    free: Graph,
    free_images: Vec<Edge>,
    active: Vec<usize>,
    kinetic: Option<KineticTerms>,
}

impl Carrier {
    pub fn new(mut full: Model, active: &[usize], complement: &[Vec<Edge>]) -> Self {
        let xi_active: Vec<Edge> = active.iter().map(|&i| full.xi[i]).collect();
        let kinetic = kinetic_terms(&mut full, &xi_active, complement);
        // ξ = C ξₐ and ξ̇ = C ξ̇ₐ + Ċ ξₐ, in the full graph.
        let accelerations: Vec<Edge> = active.iter().map(|&i| full.xi_dot[i]).collect();
        let drift = drift(&mut full, &xi_active, complement);
        let graph = &mut full.graph;
        let xi: Vec<Edge> = complement
            .iter()
            .map(|row| graph.dot(row, &xi_active))
            .collect();
        let xi_dot: Vec<Edge> = complement
            .iter()
            .zip(&drift)
            .map(|(row, &drift)| {
                let part = graph.dot(row, &accelerations);
                graph.add(part, drift)
            })
            .collect();
        let (graph, images) = restricted(&full, &full.graph, active, &xi, &xi_dot);
        let (free, free_images) = restricted(&full, &full.points.free, active, &xi, &xi_dot);
        Carrier {
            full,
            graph,
            images,
            free,
            free_images,
            active: active.to_vec(),
            kinetic,
        }
    }

    fn carry(&mut self, edges: &[Edge]) -> Vec<Edge> {
        map_symbols(&self.full.graph, &mut self.graph, edges, &self.images)
    }

    fn carry_free(&mut self, edges: &[Edge]) -> Vec<Edge> {
        map_symbols(
            &self.full.points.free,
            &mut self.free,
            edges,
            &self.free_images,
        )
    }

    fn one(&mut self, edge: Edge) -> Edge {
        self.carry(&[edge])[0]
    }

    fn three(&mut self, v: [Edge; 3]) -> [Edge; 3] {
        v.map(|edge| self.one(edge))
    }

    fn value(&mut self, value: &Value) -> Value {
        value.map(|edge| self.one(edge))
    }

    fn rows(&mut self, rows: &[Vec<Edge>]) -> Vec<Vec<Edge>> {
        rows.iter().map(|row| self.carry(row)).collect()
    }

    /// The model in ξₐ, with some rows of constraints kept.
    pub fn model(mut self, kept_rows: &[Vec<Edge>], kept: &[usize], pivots: &[Edge]) -> Model {
        let mut model = self.full.clone();
        let full = self.full.clone();
        model.x = self.carry(&full.x);
        let xi: Vec<Edge> = self.active.iter().map(|&i| full.xi[i]).collect();
        model.xi = self.carry(&xi);
        let xi_dot: Vec<Edge> = self.active.iter().map(|&i| full.xi_dot[i]).collect();
        model.xi_dot = self.carry(&xi_dot);
        model.u = self.carry(&full.u);
        let momenta: Vec<Edge> = self.active.iter().map(|&i| full.momenta[i]).collect();
        model.momenta = self.carry(&momenta);
        model.rate = self.carry(&full.rate);
        // A C = ∂ẋ/∂ξₐ.
        let graph = &mut self.graph;
        model.a = vec![Vec::new(); model.rate.len()];
        for &xi in &model.xi {
            let mut by = Derivation::new([(xi.node(), graph.one())]);
            for (row, &rate) in model.a.iter_mut().zip(&model.rate) {
                row.push(by.of(graph, rate));
            }
        }
        for frame in &mut model.frames {
            frame.rotation = frame.rotation.map(|row| self.three(row));
            frame.position = self.three(frame.position);
            let (turn, shift) = frame.relative;
            frame.relative = (turn.map(|row| self.three(row)), self.three(shift));
        }
        for body in &mut model.bodies {
            body.mass = self.one(body.mass);
            body.com = self.three(body.com);
            body.inertia_com = body.inertia_com.map(|row| self.three(row));
            body.inertia_origin = body.inertia_origin.map(|row| self.three(row));
        }
        for particle in &mut model.particles {
            particle.mass = self.one(particle.mass);
            particle.position = self.three(particle.position);
        }
        model.wrenches = full
            .wrenches
            .iter()
            .map(|w| w.map(&mut |e| self.one(e)))
            .collect();
        model.elements = full.elements.map(&mut |edge| self.one(edge));
        model.dissipation = self.one(full.dissipation);
        model.observed.clear();
        model.kinetic = self.one(full.kinetic);
        model.armature = vec![self.graph.zero(); model.xi.len()];
        model.kinetic_terms = self.kinetic.take().map(|terms| KineticTerms {
            mass: self.rows(&terms.mass),
            bias: self.carry(&terms.bias),
        });
        model.potential = self.one(full.potential);
        model.gravity = self.three(full.gravity);
        model.generalized = self.generalized();
        model.outputs = self.named(&full.outputs);
        model.invariants = full
            .invariants
            .iter()
            .map(|claim| self.claim(claim))
            .collect();
        model.lets = self.named(&full.lets);
        model.constraints = kept
            .iter()
            .zip(kept_rows)
            .map(|(&i, row)| Pfaffian {
                row: self.carry(row),
                residual: self.one(full.constraints[i].residual),
                stabilized: full.constraints[i].stabilized.map(|edge| self.one(edge)),
                ..full.constraints[i].clone()
            })
            .collect();
        let completion = &full.completion;
        model.completion = Completion {
            y: Vec::new(),
            independent: completion.independent.clone(),
            pivots: self.carry(&completion.pivots),
            constants: self.carry(&[completion.constants.as_slice(), pivots].concat()),
        };
        self.groups(&mut model, &full);
        model.start_xi = self.active.iter().map(|&i| full.start_xi[i]).collect();
        model.velocity_spans = self
            .active
            .iter()
            .map(|&i| full.velocity_spans[i])
            .collect();
        let rows: Vec<Edge> = full.phi.iter().map(|(edge, _)| *edge).collect();
        for (row, edge) in model.phi.iter_mut().zip(self.carry_free(&rows)) {
            row.0 = edge;
        }
        model.points.constraints = self.carry_free(&full.points.constraints);
        model.points.symbols = self.free.symbols().len();
        model.points.free = self.free;
        model.points.require_roots(&self.graph);
        model.spans = false;
        model.graph = self.graph;
        model
    }

    fn claim(&mut self, claim: &Invariant) -> Invariant {
        let quantity = match &claim.quantity {
            Quantity::Energy => Quantity::Energy,
            Quantity::LinearMomentum { of, along } => Quantity::LinearMomentum {
                of: *of,
                along: along.map(|along| self.three(along)),
            },
            Quantity::AngularMomentum { of, about, along } => Quantity::AngularMomentum {
                of: *of,
                about: self.three(*about),
                along: along.map(|along| self.three(along)),
            },
            Quantity::Value(value) => Quantity::Value(self.value(value)),
        };
        let place = |graph: &Graph, edge: Edge| {
            let symbols = graph.symbols();
            symbols.iter().position(|symbol| symbol.node == edge.node())
        };
        let set = claim
            .set
            .iter()
            .filter_map(|&(symbol, value)| {
                let value = self.one(value);
                Some((place(&self.graph, self.images[symbol])?, value))
            })
            .collect();
        Invariant {
            quantity,
            set,
            ..claim.clone()
        }
    }

    /// Cᵀ f of the generalised forces that the user wrote.
    fn generalized(&mut self) -> Vec<Edge> {
        let full = self.full.clone();
        let forces = self.carry(&full.generalized);
        let xi = self.carry(&full.xi);
        let active: Vec<Edge> = self.active.iter().map(|&i| xi[i]).collect();
        let graph = &mut self.graph;
        active
            .iter()
            .map(|a| {
                let mut by = Derivation::new([(a.node(), graph.one())]);
                let column: Vec<Edge> = xi.iter().map(|&xi| by.of(graph, xi)).collect();
                graph.dot(&column, &forces)
            })
            .collect()
    }

    fn named(&mut self, list: &[(String, Value)]) -> Vec<(String, Value)> {
        list.iter()
            .map(|(name, value)| (name.clone(), self.value(value)))
            .collect()
    }

    /// Parameters and inputs in the new graph; of a velocity of which a part is left, that part.
    fn groups(&mut self, model: &mut Model, full: &Model) {
        for groups in [&mut model.params, &mut model.inputs] {
            for group in groups {
                group.value = self.value(&group.value);
            }
        }
        model.velocities.clear();
        for group in &full.velocities {
            let entries = group.offset..group.offset + group.len;
            let left: Vec<usize> = entries.filter(|i| self.active.contains(i)).collect();
            let active = self.active.clone();
            let offset = |i: usize| active.iter().position(|&a| a == i).unwrap_or(0);
            if left.len() == group.len {
                let offset = offset(group.offset);
                model.velocities.push(Group {
                    value: self.value(&group.value),
                    offset,
                    ..group.clone()
                });
                continue;
            }
            for i in left {
                let offset = offset(i);
                model.velocities.push(Group {
                    name: format!("{}_{}", group.name, i - group.offset + 1),
                    shape: ShapeKind::Scalar,
                    value: Value::Scalar(self.one(full.xi[i])),
                    offset,
                    len: 1,
                });
            }
        }
    }
}

/// A graph without the symbols of velocities that were solved for, and what all symbols become.
fn restricted(
    full: &Model,
    from: &Graph,
    active: &[usize],
    xi: &[Edge],
    xi_dot: &[Edge],
) -> (Graph, Vec<Edge>) {
    let mut graph = from.fresh();
    let mut images = Vec::new();
    let (mut velocity, mut acceleration, mut momentum) = (0, 0, 0);
    let mut solved = Vec::new();
    let mut reals = Vec::new();
    for (index, symbol) in from.symbols().iter().enumerate() {
        let counter = match symbol.class {
            class::VELOCITY => Some((&mut velocity, xi)),
            class::ACCEL => Some((&mut acceleration, xi_dot)),
            class::MOMENTUM => Some((&mut momentum, xi)),
            _ => None,
        };
        if let Some((count, by)) = counter {
            let i = *count;
            *count += 1;
            if !active.contains(&i) {
                solved.push((index, by[i]));
                images.push(graph.zero());
                continue;
            }
        }
        let value = from.value(Edge::of(symbol.node));
        images.push(graph.symbol(&symbol.name, symbol.class, value));
        reals.push(from.reals(index));
    }
    graph.set_reals(reals);
    // What was solved for is written in symbols that stay.
    let expressions: Vec<Edge> = solved.iter().map(|(_, edge)| *edge).collect();
    let made = map_symbols(&full.graph, &mut graph, &expressions, &images);
    for ((index, _), edge) in solved.into_iter().zip(made) {
        images[index] = edge;
    }
    (graph, images)
}
