//! Functions of a system that splits, as the trait `Split` of the runtime declares them.
//!
//! Let η = T B ξ be the rates of the shifted coordinates. The momenta are ẏ and θ̇ themselves, and
//! P = J ω for rotors. The generalised force in the rates η is T⁻ᵀ Nᵀ f: for a rotor the torque
//! about its centre of mass or fixed point, and for everything else a force that D⁻¹ turns into an
//! acceleration.

use super::centre::rotation_matrix_of;
use super::constant::eliminate_symbols;
use super::context::StructureContext;
use super::inertia::SplitInertia;
use super::rates::CoordinateBlock;
use crate::candidates::Candidates;
use crate::program::ProgramBuilder;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{
    Mat3, Vec3, apply_transposed, apply3, multiply, solve_symmetric, transpose,
};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::class;
use hamel_language::model::layout::Block;
use hamel_program::FunctionId;
use hamel_program::count::count;
use hamel_program::structure::{Inertia, RotorForm, Symmetry};

/// Functions of a system that splits, in a graph of their own.
pub struct SplitFunctions {
    graph: Graph,
    /// Shifted coordinates y(x); `None` if y = x.
    centre: Option<Vec<Edge>>,
    uncentre: Option<Vec<Edge>>,
    momenta: Vec<Edge>,
    /// Alternative computations of the momenta, each in a graph of its own.
    turned: Vec<(Graph, Vec<Edge>)>,
    velocities: Vec<Edge>,
    kick: Vec<Edge>,
    /// J₁, J₂, J₃ or J by rows, for each rotor in turn.
    inertia: Vec<Edge>,
    /// Pivots that have to be positive for J and D to be inertias.
    pivots: Vec<Edge>,
    /// Forms of the rotors' inertias.
    pub rotors: Vec<RotorForm>,
}

impl SplitFunctions {
    /// Builds the functions; `None` if an inertia is singular for all parameters.
    pub(super) fn new(
        context: &StructureContext,
        mut graph: Graph,
        separated: &SplitInertia,
        force: &[Edge],
    ) -> Option<Self> {
        let model = context.model;
        let before = graph.clone();
        let graph = &mut graph;
        let n = model.n();
        let SplitInertia {
            rates,
            shift,
            rotors,
            uniform,
            block,
        } = separated;
        let (one, zero) = (graph.one(), graph.zero());
        let unit = |n: usize| -> Vec<Vec<Edge>> {
            (0..n)
                .map(|i| (0..n).map(|j| if i == j { one } else { zero }).collect())
                .collect()
        };
        let mut pivots = Vec::new();
        let turning: Vec<_> = context
            .parts
            .iter()
            .filter(|part| part.is_rotor())
            .collect();

        // η = w + K w, computed by vectors and by one matrix; the cheaper of the two is used.
        let matrix = |graph: &mut Graph, sign: bool| -> Vec<Vec<Edge>> {
            let mut rows = unit(n);
            for (row, rate) in rows.iter_mut().zip(&shift.rate) {
                for (entry, &k) in row.iter_mut().zip(rate) {
                    *entry = graph.add(*entry, k.signed(sign));
                }
            }
            rows
        };
        let forward = matrix(graph, false);
        let backward = matrix(graph, true);
        let times = |graph: &mut Graph, rows: &[Vec<Edge>], v: &[Edge]| -> Vec<Edge> {
            rows.iter().map(|row| graph.dot(row, v)).collect()
        };
        let w = times(graph, &rates.of_velocities, &model.xi);
        let stepwise = times(graph, &forward, &w);
        let product = multiply(graph, &forward, &rates.of_velocities);
        let at_once = times(graph, &product, &model.xi);
        let of_velocities = product;
        let mut momenta = cheaper(graph, stepwise, at_once);
        let mut eta = model.momenta.clone();
        for (part, inertia) in turning.iter().zip(rotors) {
            let spin: Vec<Edge> = part.rates().map(|i| momenta[i]).collect();
            let p: Vec<Edge> = part.rates().map(|i| eta[i]).collect();
            let rows: Vec<Vec<Edge>> = inertia.iter().map(|row| row.to_vec()).collect();
            pivots.extend(symmetric_pivots(graph, &rows));
            let inverse = solve_symmetric(graph, &rows, &unit(3))?;
            for (i, place) in part.rates().enumerate() {
                momenta[place] = graph.dot(&rows[i], &spin);
                eta[place] = graph.dot(&inverse[i], &p);
            }
        }
        let w = times(graph, &backward, &eta);
        let stepwise = times(graph, &rates.to_velocities, &w);
        let product = multiply(graph, &rates.to_velocities, &backward);
        let at_once = times(graph, &product, &eta);
        let velocities = cheaper(graph, stepwise, at_once);

        // T⁻ᵀ Nᵀ f.
        let stepwise = times(graph, &transpose(&rates.to_velocities), force);
        let stepwise = times(graph, &transpose(&backward), &stepwise);
        let at_once = times(graph, &transpose(&product), force);
        let kick = cheaper(graph, stepwise, at_once);
        let settled = |graph: &mut Graph, edges: &[Edge]| {
            eliminate_symbols(model, graph, context.parts, context.variation, edges)
        };
        let mut kick = settled(graph, &kick);
        pivots.extend(symmetric_pivots(graph, block));
        let inverse = solve_symmetric(graph, block, &unit(uniform.len()))?;
        let push: Vec<Edge> = uniform.iter().map(|&i| kick[i]).collect();
        for (row, &place) in inverse.iter().zip(uniform) {
            kick[place] = graph.dot(row, &push);
        }
        let kick = settled(graph, &kick);

        let shifted = |graph: &mut Graph, sign: bool| -> Option<Vec<Edge>> {
            let moved = shift.offset.iter().any(|&edge| edge != zero);
            moved.then(|| {
                let sum = |(&x, &by): (&Edge, &Edge)| graph.add(x, by.signed(sign));
                model.x.iter().zip(&shift.offset).map(sum).collect()
            })
        };
        let centre = shifted(graph, false);
        let uncentre = shifted(graph, true);
        let forms: Vec<RotorForm> = turning
            .iter()
            .zip(rotors)
            .map(|(part, inertia)| RotorForm {
                name: part.name.clone(),
                inertia: inertia_form(graph, inertia),
                steered: kick[part.rates()]
                    .iter()
                    .any(|edge| graph.class(edge.node()) & class::CONFIGURATION != 0),
            })
            .collect();
        let inertia = forms
            .iter()
            .zip(rotors)
            .flat_map(|(form, j)| match form.inertia.entries() {
                3 => vec![j[0][0], j[1][1], j[2][2]],
                _ => j.concat(),
            })
            .collect();
        let positive = |pivot: &Edge| graph.as_rational(*pivot).is_none();
        pivots.retain(positive);
        Some(SplitFunctions {
            turned: in_body_axes(graph, &before, context, &of_velocities, rotors),
            centre,
            uncentre,
            momenta,
            velocities,
            kick,
            inertia,
            pivots,
            rotors: forms,
            graph: graph.clone(),
        })
    }

    /// Returns whether no force acts, so that kicks change nothing.
    pub fn is_force_free(&self) -> bool {
        self.kick.iter().all(|&edge| edge == self.graph.zero())
    }

    /// Returns the outputs of a function; `None` if it is not needed.
    fn value(&self, id: FunctionId) -> Option<&Vec<Edge>> {
        match id {
            FunctionId::Centre => self.centre.as_ref(),
            FunctionId::Uncentre => self.uncentre.as_ref(),
            FunctionId::SplitMomenta => Some(&self.momenta),
            FunctionId::SplitVelocities => Some(&self.velocities),
            FunctionId::Kick => Some(&self.kick),
            FunctionId::RotorInertia => (!self.rotors.is_empty()).then_some(&self.inertia),
            _ => None,
        }
    }

    /// Adds the functions to a program, and returns the pivots that have to be positive.
    ///
    /// Each function is the cheapest of the variants here and in `others`, which were found from
    /// other computations of M and the forces.
    pub fn add_to_program(
        &self,
        others: &[SplitFunctions],
        builder: &mut ProgramBuilder,
    ) -> Vec<Edge> {
        for &id in FunctionId::ALL {
            let Some(outputs) = self.value(id) else {
                continue;
            };
            let mut candidates = Candidates::new(&builder.numerical_loss);
            candidates.offer_both(self.graph.clone(), outputs.clone(), &builder.graph);
            if id == FunctionId::SplitMomenta {
                for (graph, momenta) in &self.turned {
                    candidates.offer(graph, momenta.clone());
                }
            }
            for other in others.iter().filter(|other| other.rotors == self.rotors) {
                if let Some(outputs) = other.value(id) {
                    candidates.offer_both(other.graph.clone(), outputs.clone(), &builder.graph);
                }
            }
            let outputs = candidates.cheapest(&mut builder.graph);
            builder.push(id, outputs);
        }
        rebuild(&self.graph, &mut builder.graph, &self.pivots)
    }
}

/// Returns the momenta with the rates of points computed in the axes of a rotor, ẏ = R (Rᵀ ẏ).
///
/// For a point of a body, Rᵀ ẏ is v + ω × s. There is one candidate for every rotor, in a graph in
/// which ẏ has not been computed yet; η = `rows` ξ, where `rows` are in the graph `from`.
fn in_body_axes(
    from: &Graph,
    before: &Graph,
    context: &StructureContext,
    rows: &[Vec<Edge>],
    rotors: &[Mat3],
) -> Vec<(Graph, Vec<Edge>)> {
    let (model, parts) = (context.model, context.parts);
    let points = parts.iter().filter(|part| part.block == Block::Flat(3));
    let points: Vec<&CoordinateBlock> = points.collect();
    let turning: Vec<&CoordinateBlock> = parts.iter().filter(|part| part.is_rotor()).collect();
    let mut candidates = Vec::new();
    for rotor in turning.iter().filter(|_| !points.is_empty()) {
        let mut graph = before.clone();
        let rows: Vec<Vec<Edge>> = rows
            .iter()
            .map(|row| rebuild(from, &mut graph, row))
            .collect();
        let Some(axes) = rotation_matrix_of(&mut graph, rotor, rotor.entries(&model.x)) else {
            continue;
        };
        let mut momenta: Vec<Option<Edge>> = vec![None; rows.len()];
        for point in &points {
            let first = point.rates().start;
            let columns: Vec<Vec3> = (0..model.n())
                .map(|j| {
                    let column = std::array::from_fn(|i| rows[first + i][j]);
                    apply_transposed(&mut graph, &axes, column)
                })
                .collect();
            let inner = std::array::from_fn(|i| {
                let row: Vec<Edge> = columns.iter().map(|column| column[i]).collect();
                graph.dot(&row, &model.xi)
            });
            let rate = apply3(&mut graph, &axes, inner);
            (0..3).for_each(|i| momenta[first + i] = Some(rate[i]));
        }
        let mut rate = |graph: &mut Graph, place: usize| {
            *momenta[place].get_or_insert_with(|| graph.dot(&rows[place], &model.xi))
        };
        let mut all: Vec<Edge> = (0..rows.len()).map(|i| rate(&mut graph, i)).collect();
        for (part, inertia) in turning.iter().zip(rotors) {
            let spin: Vec<Edge> = part.rates().map(|i| all[i]).collect();
            for (row, place) in inertia.iter().zip(part.rates()) {
                let row = rebuild(from, &mut graph, row);
                all[place] = graph.dot(&row, &spin);
            }
        }
        candidates.push((graph, all));
    }
    candidates
}

/// Returns the cheaper of two equivalent computations.
fn cheaper(graph: &Graph, a: Vec<Edge>, b: Vec<Edge>) -> Vec<Edge> {
    if count(graph, &b).weight() < count(graph, &a).weight() {
        b
    } else {
        a
    }
}

/// Returns the pivots of a symmetric matrix.
fn symmetric_pivots(graph: &mut Graph, rows: &[Vec<Edge>]) -> Vec<Edge> {
    let n = rows.len();
    let mut rows = rows.to_vec();
    for k in 0..n {
        for i in k + 1..n {
            let Some(factor) = graph.div(rows[i][k], rows[k][k]) else {
                return Vec::new();
            };
            for j in k..n {
                let product = graph.mul(factor, rows[k][j]);
                rows[i][j] = graph.sub(rows[i][j], product);
            }
        }
    }
    (0..n).map(|k| rows[k][k]).collect()
}

/// Returns the form that an inertia has for all values of the parameters.
fn inertia_form(graph: &Graph, j: &Mat3) -> Inertia {
    let zero = graph.zero();
    let diagonal = (0..3).all(|a| (0..3).all(|b| a == b || j[a][b] == zero));
    if !diagonal {
        return Inertia::General;
    }
    let equal: Vec<usize> = (0..3)
        .filter(|&axis| j[(axis + 1) % 3][(axis + 1) % 3] == j[(axis + 2) % 3][(axis + 2) % 3])
        .collect();
    let numbers = (0..3).all(|a| graph.as_rational(j[a][a]).is_some());
    match equal.as_slice() {
        [] if numbers => Inertia::Principal(Symmetry::None),
        [] => Inertia::Moments,
        [axis] => Inertia::Principal(Symmetry::Axial(*axis)),
        _ => Inertia::Principal(Symmetry::Spherical),
    }
}
