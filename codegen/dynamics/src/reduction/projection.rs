//! Transfer of a model to a graph without the velocities that were solved for.

use super::kinetic::{VelocityParametrization, all_velocities, kinetic_terms, velocity_drift};
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::transplant::map_symbols;
use hamel_language::model::completion::Completion;
use hamel_language::model::pfaffian::Pfaffian;
use hamel_language::model::value::Value;
use hamel_language::model::{Group, KineticTerms, Model, class};
use hamel_language::syntax::ast::ShapeKind;

/// Projection of a model onto its active velocities: a graph without the others, and the images of all symbols.
pub struct ModelProjection {
    full: Model,
    graph: Graph,
    /// Image of each symbol of the full model's graph.
    pub images: Vec<Edge>,
    /// Graph with unconstrained points.
    free: Graph,
    free_images: Vec<Edge>,
    active: Vec<usize>,
    kinetic: Option<KineticTerms>,
}

impl ModelProjection {
    pub fn new(
        mut full: Model,
        active: &[usize],
        parametrization: &VelocityParametrization,
    ) -> Self {
        let xi_active: Vec<Edge> = active.iter().map(|&i| full.xi[i]).collect();
        let kinetic = kinetic_terms(&mut full, &xi_active, parametrization);
        // ξ = C ξₐ + c and ξ̇ = C ξ̇ₐ + Ċ ξₐ + ċ, in the full graph.
        let accelerations: Vec<Edge> = active.iter().map(|&i| full.xi_dot[i]).collect();
        let drift = velocity_drift(&mut full, &xi_active, parametrization);
        let graph = &mut full.graph;
        let xi = all_velocities(graph, &xi_active, parametrization);
        let xi_dot: Vec<Edge> = parametrization
            .complement
            .iter()
            .zip(&drift)
            .map(|(row, &drift)| {
                let part = graph.dot(row, &accelerations);
                graph.add(part, drift)
            })
            .collect();
        let (graph, images) = graph_of_active(&full, &full.graph, active, &xi, &xi_dot);
        let (free, free_images) = graph_of_active(&full, &full.points.free, active, &xi, &xi_dot);
        ModelProjection {
            full,
            graph,
            images,
            free,
            free_images,
            active: active.to_vec(),
            kinetic,
        }
    }

    fn project_free(&mut self, edges: &[Edge]) -> Vec<Edge> {
        map_symbols(
            &self.full.points.free,
            &mut self.free,
            edges,
            &self.free_images,
        )
    }

    /// Returns the model in ξₐ, with the given rows of constraints kept.
    pub fn model(
        mut self,
        kept_rows: &[(Vec<Edge>, Edge)],
        kept: &[usize],
        pivots: &[Edge],
    ) -> Model {
        let full = self.full.clone();
        let mut model = full.clone();
        let active = |all: &[Edge]| self.active.iter().map(|&i| all[i]).collect::<Vec<_>>();
        model.xi = active(&full.xi);
        model.xi_dot = active(&full.xi_dot);
        model.momenta = active(&full.momenta);
        model.velocity_spans = self
            .active
            .iter()
            .map(|&i| full.velocity_spans[i])
            .collect();
        model.start_xi = self.active.iter().map(|&i| full.start_xi[i]).collect();
        model.velocities = self.groups();
        model.independent = Vec::new();
        for (velocity, _) in &mut model.accelerated {
            *velocity = self.active.iter().position(|i| i == velocity).unwrap_or(0);
        }
        // Clear what is derived again below or is of no use in ξₐ.
        model.a = Vec::new();
        model.observed = Vec::new();
        model.armature = vec![full.graph.zero(); model.xi.len()];
        model.kinetic_terms = self.kinetic.take();
        model.constraints = kept
            .iter()
            .zip(kept_rows)
            .map(|(&i, (row, shift))| Pfaffian {
                row: row.clone(),
                shift: *shift,
                ..full.constraints[i].clone()
            })
            .collect();
        model.completion = Completion {
            y: Vec::new(),
            constants: [&full.completion.constants, pivots].concat(),
            ..full.completion.clone()
        };
        model.graph = full.graph.clone();
        let images = &self.images;
        let mut model = model.transplanted(self.graph.clone(), |from, into, edges| {
            map_symbols(from, into, edges, images)
        });
        // Prescribed coordinates stay in x, though nothing depends on them.
        let first = full.points.first;
        let symbols = model.graph.symbols();
        model.x = (first..first + full.nu())
            .map(|index| Edge::of(symbols[index].node))
            .collect();
        // A C = ∂ẋ/∂ξₐ.
        let graph = &mut model.graph;
        model.a = vec![Vec::new(); model.rate.len()];
        for &xi in &model.xi {
            let mut by = Derivation::new([(xi.node(), graph.one())]);
            for (row, &rate) in model.a.iter_mut().zip(&model.rate) {
                row.push(by.of(graph, rate));
            }
        }
        let xi = map_symbols(&full.graph, &mut model.graph, &full.xi, images);
        model.generalized = self.generalized(&mut model, &xi);
        for claim in &mut model.invariants {
            self.renumber(&mut claim.set, &model.graph);
        }
        let rows: Vec<Edge> = full.phi.iter().map(|(edge, _)| *edge).collect();
        for (row, edge) in model.phi.iter_mut().zip(self.project_free(&rows)) {
            row.0 = edge;
        }
        model.points.constraints = self.project_free(&full.points.constraints);
        model.points.symbols = self.free.symbols().len();
        model.points.free = self.free;
        model.points.require_roots(&model.graph);
        model.spans = false;
        model
    }

    /// Renumbers the symbols that a claim sets to their places in the new graph, and removes those that no longer
    /// exist.
    fn renumber(&self, set: &mut Vec<(usize, Edge)>, graph: &Graph) {
        set.retain_mut(|(symbol, _)| {
            let node = self.images[*symbol].node();
            let place = graph.symbols().iter().position(|known| known.node == node);
            place.inspect(|place| *symbol = *place).is_some()
        });
    }

    /// Returns Cᵀ f for the generalised forces written by the user.
    fn generalized(&self, model: &mut Model, xi: &[Edge]) -> Vec<Edge> {
        let graph = &mut model.graph;
        let rows = model.xi.iter().map(|active| {
            let mut by = Derivation::new([(active.node(), graph.one())]);
            let column: Vec<Edge> = xi.iter().map(|&xi| by.of(graph, xi)).collect();
            graph.dot(&column, &model.generalized)
        });
        rows.collect()
    }

    /// Returns the remaining velocities; if only a part of a vector velocity remains, its entries become scalars.
    fn groups(&self) -> Vec<Group> {
        let mut groups = Vec::new();
        let offset = |i: usize| self.active.iter().position(|&a| a == i).unwrap_or(0);
        for group in &self.full.velocities {
            let entries = group.offset..group.offset + group.len;
            let left: Vec<usize> = entries.filter(|i| self.active.contains(i)).collect();
            if left.len() == group.len {
                let offset = offset(group.offset);
                groups.push(Group {
                    offset,
                    ..group.clone()
                });
                continue;
            }
            groups.extend(left.into_iter().map(|i| Group {
                name: format!("{}_{}", group.name, i - group.offset + 1),
                shape: ShapeKind::Scalar,
                value: Value::Scalar(self.full.xi[i]),
                offset: offset(i),
                len: 1,
                unit: group.unit.clone(),
            }));
        }
        groups
    }
}

/// Creates a graph without the symbols of velocities that were solved for, and returns it with the images of all
/// symbols.
fn graph_of_active(
    full: &Model,
    from: &Graph,
    active: &[usize],
    xi: &[Edge],
    xi_dot: &[Edge],
) -> (Graph, Vec<Edge>) {
    let mut graph = from.empty_copy();
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
    // Replace prescribed coordinates by their prescribed values.
    let given: Vec<Edge> = full.prescribed.iter().map(|(_, edge)| *edge).collect();
    let made = map_symbols(&full.graph, &mut graph, &given, &images);
    for ((place, _), edge) in full.prescribed.iter().zip(made) {
        images[full.points.first + place] = edge;
    }
    // Express velocities that were solved for in the remaining symbols.
    let expressions: Vec<Edge> = solved.iter().map(|(_, edge)| *edge).collect();
    let made = map_symbols(&full.graph, &mut graph, &expressions, &images);
    for ((index, _), edge) in solved.into_iter().zip(made) {
        images[index] = edge;
    }
    (graph, images)
}
