//! The velocities that constraints B(x) ξ = 0 leave: ξ = C(x) ξₐ, and the model in ξₐ.
//!
//! A row is solved for a velocity whose factor is constant at run time, so that nothing is divided
//! by what may vanish on X; rows without such a factor are kept and get multipliers. With C the
//! equations of motion are Cᵀ (M ξ̇ + Γ ξ ξ + ∂V − f) = 0: for an inactive velocity of an adapted
//! frame these are the active rows of KR18 (30).

use super::calculus::Calculus;
use super::{commutation, connection, inertia, kinematics};
use crate::algebra::derivation::Derivation;
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::numeric::evaluate;
use crate::algebra::transplant::substitute;
use crate::diagnostics::Diagnostic;
use crate::model::pfaffian::{Kind, Pfaffian};
use crate::model::value::Value;
use crate::model::{Group, KineticTerms, Model, class};
use crate::syntax::ast::ShapeKind;

/// Rows whose part across those before is smaller than this, relative to the largest, are redundant.
const REDUNDANT: f64 = 1e-8;

/// The active velocities, and the model in them.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// The model in ξₐ; its constraints are the rows that are kept.
    pub model: Model,
    /// Places of ξₐ in ξ.
    pub active: Vec<usize>,
    /// Rows that were solved, and the velocities that they give.
    pub solved: Vec<(usize, usize)>,
    /// Rows that are kept, by their places among the constraints.
    pub kept: Vec<usize>,
    /// C, n rows of as many entries as ξₐ has, in the graph below.
    pub complement: Vec<Vec<Edge>>,
    /// The graph of the full model, with C.
    pub graph: Graph,
    /// What every symbol of the full model becomes, in the graph of the reduced one.
    pub images: Vec<Edge>,
}

/// Solves the constraints of a model as far as constant factors allow.
pub fn reduce(model: &Model) -> Result<Reduction, Diagnostic> {
    let mut full = model.clone();
    let (rows, solved) = eliminate(&mut full)?;
    let n = full.n();
    let active: Vec<usize> = (0..n)
        .filter(|i| solved.iter().all(|(_, velocity)| velocity != i))
        .collect();
    let kept = keep(&full, &rows, &solved)?;
    if active.len() <= kept.len() {
        let span = model.constraints.last().map_or(model.span, |c| c.span);
        return Err(Diagnostic::new(
            span,
            format!(
                "the constraints leave no motion: {} rows for {n} velocities",
                solved.len() + kept.len()
            ),
        )
        .help("remove a constraint, or add velocities"));
    }
    let graph = &mut full.graph;
    let mut complement = vec![vec![graph.zero(); active.len()]; n];
    for (place, &i) in active.iter().enumerate() {
        complement[i][place] = graph.one();
    }
    let mut pivots = Vec::new();
    for &(row, velocity) in &solved {
        let pivot = rows[row][velocity];
        for (place, &i) in active.iter().enumerate() {
            complement[velocity][place] = graph
                .div(-rows[row][i], pivot)
                .ok_or_else(|| Diagnostic::new(model.constraints[row].span, "division by zero"))?;
        }
        if graph.as_rational(pivot).is_none() {
            pivots.push(graph.mul(pivot, pivot));
        }
    }
    let rows: Vec<Vec<Edge>> = kept
        .iter()
        .map(|&row| active.iter().map(|&i| rows[row][i]).collect())
        .collect();
    let graph = full.graph.clone();
    let carrier = Carrier::new(full, &active, &complement);
    let images = carrier.images.clone();
    Ok(Reduction {
        model: carrier.model(&rows, &kept, &pivots),
        graph,
        images,
        active,
        solved,
        kept,
        complement,
    })
}

/// B in echelon form by constant pivots, and the pivots: (row, velocity).
type Echelon = (Vec<Vec<Edge>>, Vec<(usize, usize)>);

fn eliminate(model: &mut Model) -> Result<Echelon, Diagnostic> {
    let numbers = start_numbers(model);
    let constraints = model.constraints.clone();
    let graph = &mut model.graph;
    let zero = graph.zero();
    let mut rows: Vec<Vec<Edge>> = constraints.iter().map(|c| c.row.clone()).collect();
    let mut solved: Vec<(usize, usize)> = Vec::new();
    loop {
        let mut best = None;
        for (i, constraint) in constraints.iter().enumerate() {
            if constraint.stabilized.is_some() || solved.iter().any(|&(row, _)| row == i) {
                continue;
            }
            for (j, &entry) in rows[i].iter().enumerate() {
                if entry == zero || !graph.is_free(entry.node()) {
                    continue;
                }
                let effort = match graph.as_rational(entry) {
                    Some(_) if entry.abs() == graph.one() => 0,
                    Some(_) => 1,
                    None if evaluate(graph, &[entry], &numbers)[0].abs() > 1e-9 => 2,
                    None => continue,
                };
                let others = rows.iter().filter(|row| row[j] != zero).count();
                let key = (effort, others, i, j);
                if best.is_none_or(|least| key < least) {
                    best = Some(key);
                }
            }
        }
        let Some((_, _, row, velocity)) = best else {
            break;
        };
        let pivot_row = rows[row].clone();
        for (other, entries) in rows.iter_mut().enumerate() {
            if other == row || entries[velocity] == zero {
                continue;
            }
            let Some(factor) = graph.div(entries[velocity], pivot_row[velocity]) else {
                continue;
            };
            for (entry, &pivot) in entries.iter_mut().zip(&pivot_row) {
                let product = graph.mul(factor, pivot);
                *entry = graph.sub(*entry, product);
            }
        }
        solved.push((row, velocity));
    }
    for (i, row) in rows.iter().enumerate() {
        if row.iter().all(|&entry| entry == zero) {
            return Err(redundant(&constraints, i));
        }
    }
    Ok((rows, solved))
}

fn redundant(constraints: &[Pfaffian], row: usize) -> Diagnostic {
    let error = Diagnostic::new(
        constraints[row].span,
        "this constraint is redundant: it follows from the others",
    )
    .help("remove it; its multiplier would have no value");
    match constraints.iter().enumerate().find(|(i, _)| *i != row) {
        Some((_, other)) => error.note(other.span, "one of the others"),
        None => error,
    }
}

fn start_numbers(model: &Model) -> Vec<f64> {
    let (m, n) = (model.u.len(), model.n());
    let zeros = vec![0.0; n];
    model.numbers(
        &model.defaults,
        &model.start_x,
        &model.start_xi,
        &vec![0.0; m],
        &zeros,
    )
}

/// The rows to keep: those that are independent at the start, the largest first. A loop may have
/// redundant rows (an overconstrained mechanism); a nonholonomic constraint may not.
fn keep(
    model: &Model,
    rows: &[Vec<Edge>],
    solved: &[(usize, usize)],
) -> Result<Vec<usize>, Diagnostic> {
    let open: Vec<usize> = (0..rows.len())
        .filter(|i| solved.iter().all(|(row, _)| row != i))
        .collect();
    let edges: Vec<Edge> = open.iter().flat_map(|&i| rows[i].iter().copied()).collect();
    let values = evaluate(&model.graph, &edges, &start_numbers(model));
    let mut left: Vec<Vec<f64>> = values.chunks(model.n()).map(<[f64]>::to_vec).collect();
    let norm = |row: &[f64]| row.iter().map(|v| v * v).sum::<f64>().sqrt();
    let most = left.iter().map(|row| norm(row)).fold(0.0, f64::max);
    let mut kept = Vec::new();
    loop {
        let sizes = left.iter().map(|row| norm(row)).enumerate();
        let largest = sizes.fold(None, |best: Option<(usize, f64)>, (i, size)| match best {
            Some((_, found)) if size <= found => best,
            _ => Some((i, size)),
        });
        let Some((row, size)) = largest.filter(|(_, size)| *size > REDUNDANT * most) else {
            break;
        };
        kept.push(open[row]);
        let unit: Vec<f64> = left[row].iter().map(|v| v / size).collect();
        for other in &mut left {
            let along: f64 = other.iter().zip(&unit).map(|(a, b)| a * b).sum();
            other.iter_mut().zip(&unit).for_each(|(a, b)| *a -= along * b);
        }
        left[row].fill(0.0);
    }
    kept.sort_unstable();
    let dropped = open.iter().find(|i| {
        !kept.contains(i) && model.constraints[**i].kind != Kind::Loop
    });
    match dropped {
        Some(&row) => Err(redundant(&model.constraints, row)),
        None => Ok(kept),
    }
}

/// Carries a model over to a graph without the velocities that were solved for.
struct Carrier {
    full: Model,
    graph: Graph,
    /// What every symbol of the full model's graph becomes.
    images: Vec<Edge>,
    /// The same in the graph with unconstrained points.
    free: Graph,
    free_images: Vec<Edge>,
    active: Vec<usize>,
    kinetic: Option<KineticTerms>,
}

impl Carrier {
    fn new(mut full: Model, active: &[usize], complement: &[Vec<Edge>]) -> Self {
        let xi_active: Vec<Edge> = active.iter().map(|&i| full.xi[i]).collect();
        let kinetic = kinetic_terms(&mut full, &xi_active, complement);
        // ξ = C ξₐ and ξ̇ = C ξ̇ₐ + Ċ ξₐ, in the full graph.
        let accelerations: Vec<Edge> = active.iter().map(|&i| full.xi_dot[i]).collect();
        let drift = drift(&mut full, &xi_active, complement);
        let graph = &mut full.graph;
        let xi: Vec<Edge> = complement.iter().map(|row| graph.dot(row, &xi_active)).collect();
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
        substitute(&self.full.graph, &mut self.graph, edges, &self.images)
    }

    fn carry_free(&mut self, edges: &[Edge]) -> Vec<Edge> {
        substitute(
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
    fn model(mut self, kept_rows: &[Vec<Edge>], kept: &[usize], pivots: &[Edge]) -> Model {
        let mut model = self.full.clone();
        let full = self.full.clone();
        model.x = self.carry(&full.x);
        let xi: Vec<Edge> = self.active.iter().map(|&i| full.xi[i]).collect();
        model.xi = self.carry(&xi);
        let xi_dot: Vec<Edge> = self.active.iter().map(|&i| full.xi_dot[i]).collect();
        model.xi_dot = self.carry(&xi_dot);
        model.u = self.carry(&full.u);
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
        for wrench in &mut model.wrenches {
            wrench.at = self.three(wrench.at);
            wrench.force = self.three(wrench.force);
            wrench.torque = self.three(wrench.torque);
        }
        model.kinetic = self.one(full.kinetic);
        model.kinetic_terms = self.kinetic.take().map(|terms| KineticTerms {
            mass: self.rows(&terms.mass),
            bias: self.carry(&terms.bias),
        });
        model.potential = self.one(full.potential);
        model.gravity = self.three(full.gravity);
        model.generalized = self.generalized();
        model.outputs = self.named(&full.outputs);
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
        model.constant_pivots.extend(self.carry(pivots));
        self.groups(&mut model, &full);
        model.start_xi = self.active.iter().map(|&i| full.start_xi[i]).collect();
        model.velocity_spans = self.active.iter().map(|&i| full.velocity_spans[i]).collect();
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

/// Ċ ξₐ along ẋ = A C ξₐ.
pub fn drift(full: &mut Model, xi_active: &[Edge], complement: &[Vec<Edge>]) -> Vec<Edge> {
    let graph = &mut full.graph;
    let xi: Vec<Edge> = complement.iter().map(|row| graph.dot(row, xi_active)).collect();
    let rate: Vec<Edge> = full.a.iter().map(|row| graph.dot(row, &xi)).collect();
    let mut along = Derivation::new(full.x.iter().zip(&rate).map(|(x, &rate)| (x.node(), rate)));
    xi.iter().map(|&xi| along.of(graph, xi)).collect()
}

/// Cᵀ K C and Cᵀ (h + K Ċ ξₐ) of the kinetic energy that the user wrote, with Hamel's h before the
/// constraints are put in; still in terms of ξ.
fn kinetic_terms(
    full: &mut Model,
    xi_active: &[Edge],
    complement: &[Vec<Edge>],
) -> Option<KineticTerms> {
    if full.kinetic == full.graph.zero() {
        return None;
    }
    let mut calculus = Calculus::new(full);
    let mass = inertia::kinetic_mass(full);
    let rows = kinematics::left_inverse(full)?;
    let gamma = commutation::gamma(full, &mut calculus, &rows);
    let h = connection::quadratic(full, &mut calculus, &mass, &gamma);
    let drift = drift(full, xi_active, complement);
    let graph = &mut full.graph;
    let columns = crate::algebra::linear::transpose(complement);
    let sum: Vec<Edge> = mass
        .iter()
        .zip(&h)
        .map(|(row, &h)| {
            let part = graph.dot(row, &drift);
            graph.add(h, part)
        })
        .collect();
    let half = crate::algebra::linear::multiply(graph, &mass, complement);
    Some(KineticTerms {
        mass: crate::algebra::linear::multiply(graph, &columns, &half),
        bias: columns.iter().map(|column| graph.dot(column, &sum)).collect(),
    })
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
    let (mut velocity, mut acceleration) = (0, 0);
    let mut solved = Vec::new();
    for (index, symbol) in from.symbols().iter().enumerate() {
        let counter = match symbol.class {
            class::VELOCITY => Some((&mut velocity, xi)),
            class::ACCEL => Some((&mut acceleration, xi_dot)),
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
    }
    // What was solved for is written in symbols that stay.
    let expressions: Vec<Edge> = solved.iter().map(|(_, edge)| *edge).collect();
    let made = substitute(&full.graph, &mut graph, &expressions, &images);
    for ((index, _), edge) in solved.into_iter().zip(made) {
        images[index] = edge;
    }
    (graph, images)
}
