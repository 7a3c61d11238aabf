//! Visits every expression of a model, for passes that need all of them, such as moving a model to another graph.
//!
//! Each structure is destructured without `..`, so that a new field has to be listed here before the project
//! compiles.

use super::completion::Completion;
use super::elements::{Along, Damper, Elements, Push, Spring};
use super::invariants::{Invariant, Quantity};
use super::motion::Observed;
use super::pfaffian::Pfaffian;
use super::value::Value;
use super::{Body, Frame, FullFrame, Group, KineticTerms, Model, Particle, Wrench};
use crate::algebra::graph::{Edge, Graph};

/// A structure that holds expressions of a graph.
pub trait Edges {
    /// Visits each expression, always in the same order.
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge));
}

impl Model {
    /// Returns the model with its expressions in another graph, where `build` creates them. φ and the points of X
    /// stay in a graph of their own.
    pub fn transplanted(
        &self,
        mut graph: Graph,
        build: impl FnOnce(&Graph, &mut Graph, &[Edge]) -> Vec<Edge>,
    ) -> Model {
        let mut model = Model {
            graph: Graph::new(0),
            ..self.clone()
        };
        let mut edges = Vec::new();
        model.for_each_edge(&mut |edge| edges.push(*edge));
        let mut images = build(&self.graph, &mut graph, &edges).into_iter();
        model.for_each_edge(&mut |edge| *edge = images.next().unwrap_or(*edge));
        model.graph = graph;
        model
    }
}

impl Model {
    /// Returns every expression of the model.
    pub fn all_edges(&mut self) -> Vec<Edge> {
        let mut edges = Vec::new();
        self.for_each_edge(&mut |edge| edges.push(*edge));
        edges
    }
}

impl Edges for Edge {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        f(self);
    }
}

impl<T: Edges> Edges for Vec<T> {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        self.iter_mut().for_each(|one| one.for_each_edge(f));
    }
}

impl<T: Edges, const N: usize> Edges for [T; N] {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        self.iter_mut().for_each(|one| one.for_each_edge(f));
    }
}

impl<T: Edges> Edges for Option<T> {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        self.iter_mut().for_each(|one| one.for_each_edge(f));
    }
}

impl<A: Edges, B: Edges> Edges for (A, B) {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        self.0.for_each_edge(f);
        self.1.for_each_edge(f);
    }
}

impl Edges for Value {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        match self {
            Value::Scalar(edge) => edge.for_each_edge(f),
            Value::Vector(entries) => entries.for_each_edge(f),
            Value::Matrix(rows) => rows.for_each_edge(f),
            Value::Pose(rotation, position) => {
                rotation.for_each_edge(f);
                position.for_each_edge(f);
            }
        }
    }
}

/// Expressions with their indices.
impl Edges for (usize, Edge) {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        self.1.for_each_edge(f);
    }
}

/// Expressions with names.
impl Edges for (String, Value) {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        self.1.for_each_edge(f);
    }
}

/// Implements [`Edges`] for a structure: visits the fields before `;` in the given order; those after it hold no
/// expressions.
macro_rules! fields {
    ($of:ty { $($field:ident),*; $($plain:ident),* }) => {
        impl Edges for $of {
            fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
                let Self { $($field,)* $($plain: _,)* } = self;
                $($field.for_each_edge(f);)*
            }
        }
    };
}

fields!(Group { value; name, shape, offset, len, unit });
fields!(Frame { rotation, position, relative; name, parent });
fields!(Body { mass, com, inertia_com, inertia_origin; frame });
fields!(Particle { mass, position; span });
fields!(Wrench { at, force, torque; frame, axes });
fields!(FullFrame { images; full, active });
fields!(KineticTerms { mass, bias; });
fields!(Pfaffian { row, shift, residual, stabilized; kind, written, entry, redundant, span });
fields!(Completion { y, pivots, constants; independent });
fields!(Observed { rotation, position, point, value; quantity });
fields!(Spring { stiffness, length, along, wrenches; });
fields!(Damper { coefficient, along; });
fields!(Push { force, along; });
fields!(Elements {
    springs, dampers, pushes, potential, dissipation, generalized, wrenches, scalar_potential,
    scalar_dissipation;
});
fields!(Model {
    x, xi, xi_dot, u, momenta, rate, a, frames, closures, bodies, particles, wrenches, elements, dissipation, observed,
    kinetic, gyroscopic, armature, kinetic_terms, potential, gravity, generalized, outputs, invariants, lets, constraints,
    completion, params, velocities, inputs, states, state_rates, prescribed, accelerated, full_frame;
    name, public, docs, graph, points, has_inertia, defaults, coordinates, blocks, phi, velocity_spans, spans, overconstrained, augmented, starts_anywhere, clock,
    joints, start_x, start_xi, start_z, initial_conditions, asked, dimensions, span, statements, origins, warnings, independent, externals
});

impl Edges for Along {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        match self {
            Along::Line { from, to, length } => {
                from.for_each_edge(f);
                to.for_each_edge(f);
                length.for_each_edge(f);
            }
            Along::Scalar(edge) => edge.for_each_edge(f),
        }
    }
}

impl Edges for Quantity {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        match self {
            Quantity::Energy => {}
            Quantity::LinearMomentum { of: _, along } => along.for_each_edge(f),
            Quantity::AngularMomentum {
                of: _,
                about,
                along,
            } => {
                about.for_each_edge(f);
                along.for_each_edge(f);
            }
            Quantity::Value(value) => value.for_each_edge(f),
        }
    }
}

impl Edges for Invariant {
    fn for_each_edge(&mut self, f: &mut dyn FnMut(&mut Edge)) {
        let Invariant {
            quantity,
            set,
            name: _,
            span: _,
            when: _,
        } = self;
        quantity.for_each_edge(f);
        set.iter_mut().for_each(|(_, value)| value.for_each_edge(f));
    }
}
