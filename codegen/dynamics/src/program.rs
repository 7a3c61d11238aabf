//! The functions of a program while it is put together.

use super::accel::Acceleration;
use super::accel::cheapest::Computation;
use super::accel::parts::Parts;
use super::care::Care;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_language::model::value::Value;
use hamel_program::{Cause, Function, FunctionId, Shape};

/// Models with more velocities are looked at for lack of inertia by M as it is traced: the literal one, n²
/// entries of all bodies, would take longer than all else.
pub(super) const MOST_LITERAL: usize = 8;

/// The functions so far, and what they are made from.
pub(super) struct Builder<'a> {
    /// The model.
    pub(super) model: &'a Model,
    /// The graph of all functions.
    pub(super) graph: Graph,
    /// ξ̇.
    pub(super) chosen: Acceleration,
    /// M and forces.
    pub(super) parts: Parts,
    /// The same in a graph where nothing but ξ̇ is computed, sharing what they can with it.
    pub(super) shared: Computation,
    /// The functions.
    pub(super) functions: Vec<Function>,
    /// How candidates are compared.
    pub(super) care: Care,
    /// Pivots of [Y; Φ].
    pub(super) kinematic_guards: Vec<Edge>,
    /// What it means where a guard is not positive.
    pub(super) causes: Vec<(Edge, Cause)>,
    /// What else has to be positive when parameters are set: pivots of the inertias of a system that splits, where M has
    /// none that are constant; the mass that centres of mass are divided by.
    pub(super) constant_guards: Vec<Edge>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(
        model: &'a Model,
        chosen: Acceleration,
        computed: Computation,
        care: &Care,
    ) -> Self {
        let Computation { mut graph, parts } = computed;
        let mut around = chosen.graph.clone();
        let shared = Computation {
            parts: parts.shared(&graph, &mut around),
            graph: around,
        };
        let kinematic_guards = rebuild(&model.graph, &mut graph, &model.completion.pivots);
        let numbered = kinematic_guards.iter().copied().enumerate();
        let causes = numbered.map(|(number, pivot)| (pivot, Cause::Kinematics(number)));
        let mut builder = Builder {
            model,
            graph,
            causes: causes.collect(),
            chosen,
            parts,
            shared,
            functions: Vec::new(),
            care: care.clone(),
            kinematic_guards,
            constant_guards: Vec::new(),
        };
        let causes = builder.causes_of(&builder.chosen);
        let pivots = builder.chosen.pivots.iter().copied();
        builder.causes.extend(pivots.zip(causes));
        builder
    }

    /// What the pivots of a computation of ξ̇ belong to.
    pub(super) fn causes_of(&self, motion: &Acceleration) -> Vec<Cause> {
        let n = self.model.n();
        let of = |number: usize| match number.checked_sub(n) {
            None if motion.twist => Cause::Mass,
            None => Cause::Velocity(number),
            Some(row) => Cause::Constraint(row),
        };
        (0..motion.pivots.len()).map(of).collect()
    }

    /// Adds a function that always has a value.
    pub(super) fn push(&mut self, id: FunctionId, outputs: Vec<Edge>) {
        self.functions
            .push(Function::known(id, self.model.n(), outputs));
    }

    /// Adds a function that has a value where the guards are positive.
    pub(super) fn push_guarded(&mut self, id: FunctionId, outputs: Vec<Edge>, guards: Vec<Edge>) {
        self.functions.push(Function {
            guards,
            fallible: true,
            ..Function::known(id, self.model.n(), outputs)
        });
    }

    /// Gives the function that was added last so many columns.
    pub(super) fn shaped(&mut self, columns: usize) {
        if let Some(function) = self.functions.last_mut() {
            let rows = function.outputs.len() / columns.max(1);
            function.shape = Shape::Matrix(rows, columns);
        }
    }

    /// Pivots that vary at run time.
    pub(super) fn guards(&self) -> Vec<Edge> {
        let pivots = self.chosen.pivots.iter().copied();
        pivots
            .filter(|p| !self.graph.is_free(p.node()))
            .chain(self.kinematic_guards.iter().copied())
            .collect()
    }
}

/// The shape of a function with this value.
pub(super) fn shape_of(value: &Value) -> Shape {
    match value {
        Value::Scalar(_) => Shape::Scalar,
        Value::Vector(v) => Shape::Vector(v.len()),
        Value::Matrix(m) => Shape::Matrix(m.len(), m.first().map_or(0, Vec::len)),
        Value::Pose(..) => Shape::Vector(value.entries().len()),
    }
}
