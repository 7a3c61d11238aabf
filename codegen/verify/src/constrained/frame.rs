//! The full frame, before constraints act.
//!
//! Reduced systems are compared with M, Γ ξ ξ, ∂V, f, T and V of the full frame, which follow from the same rules of
//! derivation as in the generator. Here these are compared with the three forms (30a), (30b), (30c) in numbers, which
//! share none of these rules.

use crate::kernel::places;
use crate::numbers::FormEvaluator;
use crate::points::{Disagreement, compare_at_fresh_points};
use crate::reference::ReferenceQuantities;
use crate::states;
use hamel_algebra::field_point::FieldPoint;
use hamel_algebra::graph::{Edge, Function, Graph};
use hamel_algebra::numeric::evaluate_at;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::transplant::{substitute, substitute_under_roots};
use hamel_dynamics::accel::kkt;
use hamel_dynamics::calculus::Calculus;
use hamel_dynamics::reduction::{Reduction, velocity_drift};
use hamel_dynamics::{kinematics, quantity};
use hamel_language::model::{Model, class};
use hamel_program::{FunctionId, Program};
use num_rational::BigRational;

/// Quantities of the full frame, with which reduced systems are compared.
pub(super) struct FullFrameQuantities {
    pub(super) reference: ReferenceQuantities,
    /// Whether the full frame agrees with the three forms in numbers; `None` if no point was found to compare at.
    pub(super) frame: Option<bool>,
    /// Ċ ξₐ + ċ.
    pub(super) drift: Vec<Edge>,
    /// C by rows, then c.
    pub(super) complement: Vec<Edge>,
    /// B, all rows.
    pub(super) rows: Vec<Edge>,
    /// The part of T that counts as energy.
    pub(super) in_energy: Edge,
    /// d/dt (T + V) at ξ̇ = 0.
    pub(super) change: Edge,
    /// Symbols of the velocities that were solved for, with their expressions in ξₐ.
    pub(super) solved: Vec<(usize, Edge)>,
    /// Linear forms that stand for these velocities in arguments of functions, in the reduced graph: atoms and
    /// coefficients.
    pub(super) forms: Vec<Vec<(Edge, BigRational)>>,
    /// The reduced model; its constraints are the kept rows, in ξₐ, with their right-hand sides in `right`.
    pub(super) reduced: Model,
    pub(super) right: Vec<Edge>,
    /// Quantities that are claimed to be constant, by their definitions.
    pub(super) claims: Vec<(String, Vec<Edge>)>,
}

impl FullFrameQuantities {
    pub(super) fn new(model: &Model, reduction: &Reduction, program: &Program) -> Option<Self> {
        let full = Model {
            graph: reduction.graph.clone(),
            ..model.clone()
        };
        let mut reference = ReferenceQuantities::new(&full)?;
        let frame = reference_agrees(model, &reference);
        let full = &mut reference.model;
        let xi: Vec<Edge> = reduction.active.iter().map(|&i| full.xi[i]).collect();
        let drift = velocity_drift(full, &xi, &reduction.parametrization);
        let parametrization = &reduction.parametrization;
        let lifted = [
            parametrization.complement.concat(),
            parametrization.shift.clone(),
        ]
        .concat();
        let mut calculus = Calculus::new(full);
        let energy = full.graph.add(reference.kinetic, reference.potential);
        let change = calculus.rate(&mut full.graph, energy);
        let in_energy = in_energy(full, reference.kinetic)?;
        let energies = (in_energy, reference.potential);
        let claims = model.invariants.iter();
        let claims = claims.map(|claim| {
            let value = quantity::quantity_value(full, &mut calculus, energies, &claim.quantity);
            (claim.name.clone(), value.entries())
        });
        let claims = claims.collect();
        let place = places(&full.graph, class::VELOCITY);
        let solved = reduction.solved.iter();
        let solved: Vec<(usize, Edge)> = solved
            .map(|&(_, i)| {
                let moved = full.graph.dot(&parametrization.complement[i], &xi);
                (place[i], full.graph.add(moved, parametrization.shift[i]))
            })
            .collect();
        let mut reduced = states::with_rates(&reduction.model, program);
        let forms = solved.iter().map(|(symbol, _)| {
            let image = reduction.images[*symbol];
            let form = reduced.graph.form(Function::Exp, image);
            let edges = form.into_iter().map(|(atom, c)| (Edge::of(atom), c));
            edges.collect()
        });
        let forms = forms.collect();
        let mut calculus = Calculus::new(&reduced);
        let right = kkt::constraint_accelerations(&mut reduced, &mut calculus);
        let mut full = FullFrameQuantities {
            drift,
            complement: lifted,
            rows: model
                .constraints
                .iter()
                .flat_map(|c| c.row.clone())
                .collect(),
            in_energy,
            change,
            solved,
            forms,
            reduced,
            right,
            claims,
            reference,
            frame,
        };
        full.prescribe();
        Some(full)
    }

    /// Extends multipliers to all rows, with 0 for redundant rows, followed by the forces of drives.
    pub(super) fn of_all_rows(&self, lambda: Vec<ResiduePair>) -> Vec<ResiduePair> {
        let mut next = lambda.into_iter();
        let constraints = self.reference.model.constraints.iter();
        let rows = constraints.map(|row| match row.redundant {
            true => ResiduePair::ZERO,
            false => next.next().unwrap_or(ResiduePair::ZERO),
        });
        let mut all: Vec<ResiduePair> = rows.collect();
        all.extend(next);
        all
    }

    /// Returns whether the forces of drives, which contribute to d/dt (T + V), are known: they have to be emitted, and
    /// the multipliers of loops have to be unique.
    pub(super) fn power_is_known(&self, program: &Program) -> bool {
        let model = &self.reference.model;
        let driven = model.clock.is_some() || !model.accelerated.is_empty();
        let forces = program.function(FunctionId::ConstraintForce).is_some()
            || self.rows.is_empty() && model.accelerated.is_empty();
        program.xi_dot().is_some() && (!driven || forces && !self.reduced.overconstrained)
    }

    /// Substitutes prescribed coordinates and ξ⁰ = 1, after all derivatives have been taken.
    ///
    /// At a point, sin q of a symbol q and sin f of a sum f with the same value would differ. So would, by their sign,
    /// the roots of v² + 1 and of (4/9) u² + 1 where 3 v = 2 u: under roots, velocities that were solved for are
    /// substituted, too.
    fn prescribe(&mut self) {
        let reference = &mut self.reference;
        let model = &mut reference.model;
        let (set, graph) = (prescribed_values(model), &mut model.graph);
        let solved = self.solved.iter_mut();
        solved.for_each(|(_, edge)| *edge = substitute(graph, &[*edge], &set)[0]);
        let put = |graph: &mut Graph, edges: &[Edge]| {
            let edges = substitute(graph, edges, &set);
            substitute_under_roots(graph, &edges, &self.solved)
        };
        let rows = [&mut reference.mass, &mut model.a];
        let rows = rows.into_iter().flatten();
        let lists = [
            &mut reference.bias,
            &mut reference.slope,
            &mut reference.force,
            &mut self.drift,
            &mut self.complement,
            &mut self.rows,
        ];
        let claims = self.claims.iter_mut().map(|(_, entries)| entries);
        for list in rows.chain(lists).chain(claims) {
            *list = put(graph, list);
        }
        let single = [
            &mut reference.kinetic,
            &mut reference.potential,
            &mut reference.dissipation,
            &mut self.in_energy,
            &mut self.change,
        ];
        for edge in single {
            *edge = put(graph, &[*edge])[0];
        }
    }
}

/// Returns the part of T that counts as energy: T less T₁ + 2 T₀ of the kinetic energy that the user wrote.
///
/// T₁ + 2 T₀ is ½ (T(2) − T(0)), where T is a function of ṫ with the rates of all other coordinates held constant.
fn in_energy(full: &mut Model, kinetic: Edge) -> Option<Edge> {
    let Some(clock) = full.clock.filter(|_| full.kinetic != full.graph.zero()) else {
        return Some(kinetic);
    };
    let y = kinematics::left_inverse(full)?;
    let symbols = places(&full.graph, class::VELOCITY);
    let graph = &mut full.graph;
    let [still, twice] = [-1, 1].map(|more| {
        let more = graph.ratio(more, 1);
        let moved = full.xi.iter().zip(&y).zip(&symbols);
        let moved = moved.map(|((&xi, row), &symbol)| {
            let part = graph.mul(more, row[clock.x]);
            (symbol, graph.add(xi, part))
        });
        let moved: Vec<(usize, Edge)> = moved.collect();
        substitute(graph, &[full.kinetic], &moved)[0]
    });
    let difference = graph.sub(twice, still);
    let half = graph.ratio(1, 2);
    let beyond = graph.mul(half, difference);
    Some(graph.sub(kinetic, beyond))
}

/// Returns the symbols of prescribed coordinates with their prescribed values, and ξ⁰ with 1.
pub(super) fn prescribed_values(model: &Model) -> Vec<(usize, Edge)> {
    let first = model.points.first;
    let given = model.prescribed.iter();
    let given = given.map(|(place, edge)| (first + place, *edge));
    let velocities = places(&model.graph, class::VELOCITY);
    let time = model
        .clock
        .map(|clock| (velocities[clock.xi], model.graph.one()));
    given.chain(time).collect()
}

/// Returns whether the reference (M, h, ∂V, f, T, V, D) has the values that the three forms give modulo p, and whether
/// these forms agree; `None` if there are no points to compare at.
///
/// The points are fresh points of X, or points of a prescribed motion if roots have values only there.
pub fn reference_agrees(model: &Model, reference: &ReferenceQuantities) -> Option<bool> {
    let numbers = FormEvaluator::new(model)?;
    let mut roots = reference.mass.concat();
    for list in [&reference.bias, &reference.slope, &reference.force] {
        roots.extend(list);
    }
    roots.extend([
        reference.kinetic,
        reference.potential,
        reference.dissipation,
    ]);
    let graph = &reference.model.graph;
    let at = |point: &FieldPoint| {
        let found = evaluate_at(graph, &roots, &mut point.clone())?;
        let Ok(values) = numbers.at(point)? else {
            return Some(Err(()));
        };
        let mut expected: Vec<ResiduePair> = values.mass.concat();
        for list in [&values.bias, &values.slope, &values.force] {
            expected.extend(list);
        }
        expected.extend([values.kinetic, values.potential, values.dissipation]);
        let [hamel, gibbs, levi_civita] = &values.left;
        let same = hamel == gibbs && gibbs == levi_civita && found == expected;
        Some(if same { Ok(()) } else { Err(()) })
    };
    let anywhere = |number| model.points.lane(0xf4a_3e0 + number);
    let given = prescribed_values(model);
    let prescribed = |number| {
        let unmoved = |_| Some(Vec::new());
        (model.points).lane_moved(0xf4a_3e0 + number, &model.graph, &given, &unmoved)
    };
    let compared = match compare_at_fresh_points(anywhere, |point, _| at(point)) {
        Err(Disagreement::Nowhere) => compare_at_fresh_points(prescribed, |point, _| at(point)),
        compared => compared,
    };
    match compared {
        Ok(()) => Some(true),
        Err(Disagreement::Differs(())) => Some(false),
        Err(Disagreement::Nowhere) => None,
    }
}
