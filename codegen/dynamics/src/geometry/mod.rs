//! Geometric properties of a system: integrable velocity coordinates, the Lie algebra of the frame, the pattern of
//! M, symmetries.
//!
//! | file | object |
//! |---|---|
//! | `potential` | f with ξᵏ = df/dt |
//! | `lie_algebra` | structure constants and what they imply in any basis |
//! | `recognise` | the names of Lie algebras |
//! | `side` | left- or right-invariant |
//! | `blocks` | blocks of γ and of M |
//! | `symmetry` | symmetries of T and V |

pub mod blocks;
pub mod lie_algebra;
pub mod potential;
pub mod recognise;
pub mod side;
pub mod symmetry;

use super::calculus::Calculus;
use super::loads::applied_force;
use super::normal::eliminate_coordinates;
use super::tables::EquationTables;
use blocks::EntryDependence;
use hamel_algebra::graph::{Edge, Graph, Node};
use hamel_algebra::linear::matrix;
use hamel_language::model::{Model, class};
use lie_algebra::LieAlgebra;
use num_rational::BigRational;
use num_traits::Zero;
use recognise::{AlgebraName, abelian_name, identify_algebra};
use side::{Side, is_constant};
use symmetry::Symmetry;

/// A velocity coordinate and its properties.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VelocityProperties {
    /// Name of the velocity.
    pub name: String,
    /// Whether γᵢⱼᵏ = 0 for all i, j, so that the velocity is the rate of a function, at least locally.
    pub integrable: bool,
    /// Function whose rate the velocity is, as text, if one was found.
    pub potential: Option<String>,
    /// Symmetries along the direction of the velocity.
    pub symmetry: Symmetry,
}

/// Block of velocity coordinates that do not commute with one another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VelocityBlock {
    /// Indices of its velocities.
    pub members: Vec<usize>,
    /// Whether its γ are the same at every x.
    pub constant: bool,
    /// Name of its Lie algebra; `None` if γ depends on x, or is not a rational function of parameters.
    pub algebra: Option<AlgebraName>,
    /// Whether γ depends on parameters, so that their default values were used.
    pub at_defaults: bool,
    /// Left-invariant (body axes) or right-invariant (world axes), if that is known.
    pub side: Option<Side>,
}

/// Geometry of a model's velocity coordinates: their Lie algebra, symmetries, integrability, and which entries of M
/// depend on x.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inspection {
    /// The velocity coordinates, in order.
    pub velocities: Vec<VelocityProperties>,
    /// Blocks of γ that are not zero.
    pub blocks: Vec<VelocityBlock>,
    /// Velocities that commute with all others.
    pub commuting: Vec<usize>,
    /// Whether x = q and ξ = q̇, that is, A = I, so that Γ are the Christoffel symbols of M.
    pub coordinate_rates: bool,
    /// Whether the model has inertia; otherwise nothing is reported on M, and only symmetries of V are.
    pub has_inertia: bool,
    /// Dependence of every entry of M on x.
    pub pattern: Vec<Vec<EntryDependence>>,
    /// Blocks of M.
    pub inertia_blocks: Vec<Vec<usize>>,
}

impl Inspection {
    /// Derives these properties of a model; `None` if AᵀA is singular, which the model's checks exclude.
    pub fn new(model: &Model) -> Option<Self> {
        let mut geometry = EquationTables::new(model)?;
        let n = geometry.model.n();
        let integrable: Vec<usize> = (0..n)
            .filter(|&k| potential::is_integrable(&geometry, k))
            .collect();
        let found = potential::find_potentials(&mut geometry, &integrable);
        let applied = applied_force(&mut geometry.model, &mut geometry.calculus);
        let symmetries = symmetry::symmetries(&mut geometry, &applied);
        let velocities = names(&geometry.model)
            .into_iter()
            .zip(symmetries)
            .enumerate()
            .map(|(k, (name, symmetry))| {
                let place = integrable.iter().position(|&i| i == k);
                let potential = place.and_then(|place| found.get(place).cloned().flatten());
                VelocityProperties {
                    name,
                    integrable: place.is_some(),
                    potential,
                    symmetry,
                }
            })
            .collect();
        let groups = blocks::commuting_blocks(&geometry.model.graph, &geometry.gamma);
        let (noncommuting, single): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|members| members.len() > 1);
        let blocks = noncommuting
            .into_iter()
            .map(|members| block(&mut geometry, members))
            .collect();
        let pattern = pattern(&mut geometry);
        Some(Inspection {
            velocities,
            blocks,
            commuting: single.concat(),
            coordinate_rates: rates_of_coordinates(&geometry.model),
            has_inertia: geometry.model.has_inertia,
            inertia_blocks: blocks::inertia_blocks(&pattern),
            pattern,
        })
    }

    /// Returns whether no entry of M depends on x.
    pub fn has_constant_mass_matrix(&self) -> bool {
        let mut entries = self.pattern.iter().flatten();
        entries.all(|&entry| entry != EntryDependence::Varying)
    }

    /// Returns the name of the Lie algebra of the whole frame, such as `se(3) ⊕ R`; `None` if some γ depends on x,
    /// or if a block has no name.
    pub fn algebra_name(&self) -> Option<String> {
        let mut parts = Vec::new();
        for block in &self.blocks {
            match &block.algebra {
                Some(AlgebraName::Sum(names)) => parts.extend(names.iter().cloned()),
                _ => return None,
            }
        }
        if !self.commuting.is_empty() {
            parts.push(abelian_name(self.commuting.len()));
        }
        Some(parts.join(" ⊕ "))
    }

    /// Returns the side that all blocks have in common; if M is constant, the inertia is invariant on this side.
    pub fn side(&self) -> Option<Side> {
        let first = self.blocks.first()?.side?;
        self.blocks
            .iter()
            .all(|block| block.side == Some(first))
            .then_some(first)
    }

    /// Returns the names of some velocities, separated by commas.
    pub fn join_names(&self, members: &[usize]) -> String {
        let names = members.iter().filter_map(|&i| self.velocities.get(i));
        let names: Vec<&str> = names.map(|velocity| velocity.name.as_str()).collect();
        names.join(", ")
    }
}

fn names(model: &Model) -> Vec<String> {
    let symbols = model.graph.symbols();
    let name = |edge: &Edge| match model.graph.node(edge.node()) {
        Node::Symbol(index) => symbols.get(index as usize).map(|s| s.name.clone()),
        _ => None,
    };
    model.xi.iter().filter_map(name).collect()
}

/// Inspects a block of γ: its Lie algebra and its side.
fn block(geometry: &mut EquationTables, members: Vec<usize>) -> VelocityBlock {
    let mut entries: Vec<Edge> = members
        .iter()
        .flat_map(|&i| members.iter().map(move |&j| (i, j)))
        .flat_map(|(i, j)| members.iter().map(move |&k| (i, j, k)))
        .map(|(i, j, k)| geometry.gamma[i][j][k])
        .collect();
    let (graph, calculus) = (&mut geometry.model.graph, &mut geometry.calculus);
    let mut forms = None;
    for entry in &mut entries {
        let points = &geometry.model.points;
        *entry = eliminate_coordinates(graph, calculus, points, &mut forms, *entry);
    }
    let constant = entries
        .iter()
        .all(|&edge| is_constant(graph, calculus, edge));
    let at_defaults = constant
        && entries
            .iter()
            .any(|edge| graph.class(edge.node()) & class::PARAM != 0);
    let numbers = constant
        .then(|| default_values(&geometry.model, &entries))
        .flatten();
    let m = members.len();
    let algebra = numbers.and_then(|numbers| {
        let planes = numbers.chunks((m * m).max(1));
        let constants = planes.map(|plane| matrix(plane, m));
        LieAlgebra::new(constants.collect())
    });
    VelocityBlock {
        constant,
        algebra: algebra.as_ref().map(identify_algebra),
        at_defaults,
        side: side::side(geometry, &members),
        members,
    }
}

/// Returns exact values of expressions at the parameters' default values; `None` if they contain more than
/// parameters and the four arithmetic operations.
fn default_values(model: &Model, edges: &[Edge]) -> Option<Vec<BigRational>> {
    let graph = &model.graph;
    let mut values = vec![BigRational::zero(); graph.len()];
    let read = |values: &[BigRational], edge: Edge| {
        let value = values[edge.node() as usize].clone();
        if edge.is_negative() { -value } else { value }
    };
    for id in graph.reachable(edges) {
        values[id as usize] = match graph.node(id) {
            Node::Constant(index) => graph.constant(index).clone(),
            Node::Symbol(index) => {
                // Symbol 0 is π; parameters follow.
                let place = (index as usize).checked_sub(1)?;
                BigRational::from_float(*model.defaults.get(place)?)?
            }
            Node::Add(a, b) => read(&values, a) + read(&values, b),
            Node::Mul(a, b) => read(&values, a) * read(&values, b),
            Node::Div(a, b) => {
                let divisor = read(&values, b);
                if divisor.is_zero() {
                    return None;
                }
                read(&values, a) / divisor
            }
            _ => return None,
        };
    }
    Some(edges.iter().map(|&edge| read(&values, edge)).collect())
}

/// Returns whether A = I.
fn rates_of_coordinates(model: &Model) -> bool {
    let graph: &Graph = &model.graph;
    model.nu() == model.n()
        && model.a.iter().enumerate().all(|(alpha, row)| {
            row.iter().enumerate().all(|(i, &entry)| {
                entry
                    == if alpha == i {
                        graph.one()
                    } else {
                        graph.zero()
                    }
            })
        })
}

fn pattern(geometry: &mut EquationTables) -> Vec<Vec<EntryDependence>> {
    let zero = geometry.model.graph.zero().node();
    let (graph, calculus): (&mut Graph, &mut Calculus) =
        (&mut geometry.model.graph, &mut geometry.calculus);
    geometry
        .mass
        .iter()
        .map(|row| {
            row.iter()
                .map(|&entry| match entry.node() == zero {
                    true => EntryDependence::Zero,
                    false if is_constant(graph, calculus, entry) => EntryDependence::Constant,
                    false => EntryDependence::Varying,
                })
                .collect()
        })
        .collect()
}
