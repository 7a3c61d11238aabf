//! Builder of the functions of a program.

use super::accel::AccelerationCandidate;
use super::accel::cheapest::MassAndForces;
use super::accel::parts::EquationTerms;
use super::numerical_loss::NumericalLoss;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_language::model::value::Value;
use hamel_program::provenance::Quantity;
use hamel_program::{Cause, Function, FunctionId, Shape};

/// Largest number of velocities for which the literal M is used to detect missing inertia.
///
/// In larger models M is used as it is traced: computing the n² literal entries of all bodies would
/// take longer than everything else.
pub(super) const MAX_LITERAL_VELOCITIES: usize = 8;

/// Functions that have been added so far, and the quantities they are made from.
pub(super) struct ProgramBuilder<'a> {
    /// Model of the program.
    pub(super) model: &'a Model,
    /// Graph of all functions.
    pub(super) graph: Graph,
    /// Computation of ξ̇.
    pub(super) chosen: AccelerationCandidate,
    /// M and the forces.
    pub(super) parts: EquationTerms,
    /// M and the forces in a graph in which only ξ̇ is computed, sharing as much as possible with
    /// it.
    pub(super) shared: MassAndForces,
    /// Functions added so far.
    pub(super) functions: Vec<Function>,
    /// Criterion by which candidates are compared.
    pub(super) numerical_loss: NumericalLoss,
    /// Pivots of [Y; Φ].
    pub(super) kinematic_guards: Vec<Edge>,
    /// Meaning of each guard, should it not be positive.
    pub(super) causes: Vec<(Edge, Cause)>,
    /// Further expressions that have to be positive when parameters are set.
    ///
    /// These are the pivots of the inertias of a system that splits, if M has no constant ones, and
    /// the mass by which centres of mass are divided.
    pub(super) constant_guards: Vec<Edge>,
}

impl<'a> ProgramBuilder<'a> {
    pub(super) fn new(
        model: &'a Model,
        chosen: AccelerationCandidate,
        computed: MassAndForces,
        numerical_loss: &NumericalLoss,
    ) -> Self {
        let MassAndForces { mut graph, parts } = computed;
        let mut around = chosen.graph.clone();
        let shared = MassAndForces {
            parts: parts.rebuild_in(&graph, &mut around),
            graph: around,
        };
        let kinematic_guards = rebuild(&model.graph, &mut graph, &model.completion.pivots);
        let numbered = kinematic_guards.iter().copied().enumerate();
        let causes = numbered.map(|(number, pivot)| (pivot, Cause::Kinematics(number)));
        let mut builder = ProgramBuilder {
            model,
            graph,
            causes: causes.collect(),
            chosen,
            parts,
            shared,
            functions: Vec::new(),
            numerical_loss: numerical_loss.clone(),
            kinematic_guards,
            constant_guards: Vec::new(),
        };
        let causes = builder.causes_of(&builder.chosen);
        let pivots = builder.chosen.pivots.iter().copied();
        builder.causes.extend(pivots.zip(causes));
        builder.label_parts();
        builder
    }

    /// Labels the rows of the equations of motion.
    fn label_parts(&mut self) {
        let (graph, parts) = (&mut self.graph, &self.parts);
        for (i, row) in parts.mass.iter().enumerate() {
            graph.label(row, Quantity::MassMatrix.of(i));
        }
        let rows = [
            (&parts.inertia, Quantity::BiasForce),
            (&parts.conservative, Quantity::PotentialSlope),
            (&parts.applied, Quantity::AppliedForce),
            (&self.chosen.xi_dot, Quantity::Acceleration),
        ];
        for (entries, quantity) in rows {
            for (i, &entry) in entries.iter().enumerate() {
                graph.label(&[entry], quantity.of(i));
            }
        }
        if !self.chosen.twist {
            let pivots = self.chosen.pivots.iter().take(self.model.n());
            for (i, &pivot) in pivots.enumerate() {
                graph.label(&[pivot], Quantity::Pivot.of(i));
            }
        }
        graph.label(&self.kinematic_guards, Quantity::KinematicPivot.of(0));
        graph.label(&self.chosen.multipliers, Quantity::Multiplier.of(0));
    }

    /// Returns the meaning of the pivots of a computation of ξ̇.
    pub(super) fn causes_of(&self, motion: &AccelerationCandidate) -> Vec<Cause> {
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

    /// Adds a function that has a value only if the guards are positive.
    pub(super) fn push_guarded(&mut self, id: FunctionId, outputs: Vec<Edge>, guards: Vec<Edge>) {
        self.functions.push(Function {
            guards,
            fallible: true,
            ..Function::known(id, self.model.n(), outputs)
        });
    }

    /// Sets the number of columns of the function that was added last.
    pub(super) fn set_columns(&mut self, columns: usize) {
        if let Some(function) = self.functions.last_mut() {
            let rows = function.outputs.len() / columns.max(1);
            function.shape = Shape::Matrix(rows, columns);
        }
    }

    /// Returns the pivots that vary at run time.
    pub(super) fn guards(&self) -> Vec<Edge> {
        let pivots = self.chosen.pivots.iter().copied();
        pivots
            .filter(|p| !self.graph.is_free(p.node()))
            .chain(self.kinematic_guards.iter().copied())
            .collect()
    }
}

/// Returns the shape of a function with this value.
pub(super) fn shape_of(value: &Value) -> Shape {
    match value {
        Value::Scalar(_) => Shape::Scalar,
        Value::Vector(v) => Shape::Vector(v.len()),
        Value::Matrix(m) => Shape::Matrix(m.len(), m.first().map_or(0, Vec::len)),
        Value::Pose(..) => Shape::Vector(value.entries().len()),
    }
}
