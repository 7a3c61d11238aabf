//! Alternative velocity coordinates for the same motion, and the cost of ξ̇ in them.
//!
//! With ξ = B(x) ξ', where B = Y A' for the A' of closed-form rates, the description in ξ' has A' = A B and f' = Bᵀ
//! f; everything else is unchanged. Rotations turn in body or world axes, points move in world axes or in those of
//! a body, and chains of angles use absolute or relative rates.

mod rates;

use super::accel::forward_dynamics;
use super::kinematics;
use super::numerical_loss::NumericalLoss;
use hamel_algebra::derivation::Derivation;
use hamel_algebra::graph::{Edge, Function, Node};
use hamel_algebra::linear::transpose;
use hamel_algebra::transplant::substitute;
use hamel_language::model::{Coordinate, Model};
use hamel_language::syntax::ast::CoordKind;
use hamel_program::count::{Count, count};
use rates::RateDraft;
use std::fmt;

/// Largest number of combinations that are tried.
const MAX_COMBINATIONS: usize = 24;

/// One choice of velocity coordinates for a model, with its cost.
#[derive(Clone, Debug)]
pub struct VelocityChoice {
    /// Description of the choice in words.
    pub label: String,
    /// Statements of the description that make this choice.
    pub statements: Vec<String>,
    /// Whether the description already has these velocities, up to their order.
    pub as_written: bool,
    /// Operations of ξ̇.
    pub accel: Count,
    /// Operations of ẋ.
    pub rate: Count,
    /// Model in these velocities.
    pub model: Model,
}

/// Reason why a model has no alternative velocities to compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AdviseError {
    /// The description has constraints on its coordinates.
    ConstrainedCoordinates,
    /// The description has `time`.
    Time,
    /// Constraints act on the velocities.
    ConstrainedVelocities,
    /// There are fewer velocities than directions of the coordinates.
    FewVelocities,
    /// The columns of A are dependent.
    DependentColumns,
    /// The mass matrix is singular for every configuration.
    SingularMass,
}

impl fmt::Display for AdviseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AdviseError::ConstrainedCoordinates => {
                "the coordinates satisfy constraints of the description: their rates have no other closed form"
            }
            AdviseError::Time => "the description has `time`, which keeps its velocity 1",
            AdviseError::ConstrainedVelocities => {
                "its velocities are constrained, by a loop, `nonholonomic`, `inactive` or `prescribe`: ξ̇ is counted before the constraints act"
            }
            AdviseError::FewVelocities => {
                "there are fewer velocities than directions of the coordinates"
            }
            AdviseError::DependentColumns => {
                "the rates of this description leave A without a left inverse"
            }
            AdviseError::SingularMass => "the mass matrix is singular for every configuration",
        })
    }
}

impl std::error::Error for AdviseError {}

/// Returns the choices of velocity coordinates that a model allows, the cheapest first.
///
/// # Errors
///
/// The reason why the model has no alternative velocities.
pub fn advise(model: &Model) -> Result<Vec<VelocityChoice>, AdviseError> {
    if !model.points.constraints.is_empty() {
        return Err(AdviseError::ConstrainedCoordinates);
    }
    if model.clock.is_some() {
        return Err(AdviseError::Time);
    }
    if model.is_constrained() {
        return Err(AdviseError::ConstrainedVelocities);
    }
    let dimension: usize = model.blocks.iter().map(|block| block.dimension()).sum();
    if dimension != model.n() {
        return Err(AdviseError::FewVelocities);
    }
    let mut choices = vec![described_choice(model)?];
    for combination in combinations(&moving_parts(model)) {
        let choice = evaluate_choice(model, &combination)?;
        if choice.as_written {
            choices[0].label = format!("{}, as written", choice.label);
            choices[0].statements = choice.statements;
        } else {
            choices.push(choice);
        }
    }
    choices.sort_by_key(|choice| (choice.accel.weight(), choice.rate.weight()));
    Ok(choices)
}

/// A moving part and the ways in which its velocity can be described.
struct MovingPart {
    moves: MotionKind,
    options: Vec<VelocityKind>,
}

/// Kind of moving part.
#[derive(Clone)]
enum MotionKind {
    /// Rotation, by its coordinate.
    Rotation(usize),
    /// Point, by its coordinate.
    Point(usize),
    /// Chain of angles, by their coordinates.
    Chain(Vec<usize>),
    /// Anything else, by its coordinate.
    Plain(usize),
}

/// Choice of velocity coordinates for a part.
#[derive(Clone, Copy, PartialEq)]
enum VelocityKind {
    /// World axes, or each coordinate's own rate.
    World,
    /// Axes of the rotation with this coordinate.
    Body(usize),
    /// Differences q̇ᵢ = uᵢ − uᵢ₋₁: relative angles with absolute rates.
    Differences,
    /// Sums q̇ᵢ = u₁ + … + uᵢ: absolute angles with relative rates.
    Sums,
}

fn is_rotation(kind: CoordKind) -> bool {
    matches!(kind, CoordKind::SO3 | CoordKind::S3 | CoordKind::SE3)
}

fn moving_parts(model: &Model) -> Vec<MovingPart> {
    let rotations: Vec<usize> = (0..model.coordinates.len())
        .filter(|&index| is_rotation(model.coordinates[index].kind))
        .collect();
    let mut all = Vec::new();
    let mut chain = Vec::new();
    for (index, coordinate) in model.coordinates.iter().enumerate() {
        match coordinate.kind {
            CoordKind::S1 => chain.push(index),
            CoordKind::Real if is_angle(model, coordinate) => chain.push(index),
            CoordKind::Real => all.push(MovingPart {
                moves: MotionKind::Plain(index),
                options: vec![VelocityKind::World],
            }),
            CoordKind::Euclidean(3) => all.push(MovingPart {
                moves: MotionKind::Point(index),
                options: std::iter::once(VelocityKind::World)
                    .chain(
                        rotations
                            .iter()
                            .map(|&rotation| VelocityKind::Body(rotation)),
                    )
                    .collect(),
            }),
            CoordKind::Euclidean(_) => all.push(MovingPart {
                moves: MotionKind::Plain(index),
                options: vec![VelocityKind::World],
            }),
            CoordKind::SE3 => {
                let options = vec![VelocityKind::World, VelocityKind::Body(index)];
                all.push(MovingPart {
                    moves: MotionKind::Point(index),
                    options: options.clone(),
                });
                all.push(MovingPart {
                    moves: MotionKind::Rotation(index),
                    options,
                });
            }
            CoordKind::SO3 | CoordKind::S3 => all.push(MovingPart {
                moves: MotionKind::Rotation(index),
                options: vec![VelocityKind::Body(index), VelocityKind::World],
            }),
        }
    }
    if !chain.is_empty() {
        let options = match chain.len() {
            1 => vec![VelocityKind::World],
            _ => vec![
                VelocityKind::World,
                VelocityKind::Differences,
                VelocityKind::Sums,
            ],
        };
        all.push(MovingPart {
            moves: MotionKind::Chain(chain),
            options,
        });
    }
    all
}

/// Returns whether a coordinate occurs in the argument of a sine or cosine.
fn is_angle(model: &Model, coordinate: &Coordinate) -> bool {
    let graph = &model.graph;
    let symbol = model.x.get(coordinate.offset).map(|edge| edge.node());
    (0..graph.len() as u32).any(|id| match graph.node(id) {
        Node::Apply(Function::Sin | Function::Cos, argument) => graph
            .reachable(&[argument])
            .into_iter()
            .any(|inner| Some(inner) == symbol),
        _ => false,
    })
}

/// Returns all combinations of ways, up to `MAX_COMBINATIONS`; combinations of the first ways come first.
fn combinations(parts: &[MovingPart]) -> Vec<Vec<(MotionKind, VelocityKind)>> {
    let mut all: Vec<Vec<(MotionKind, VelocityKind)>> = vec![Vec::new()];
    for part in parts {
        all = all
            .into_iter()
            .flat_map(|head| {
                part.options.iter().map(move |&way| {
                    let mut longer = head.clone();
                    longer.push((part.moves.clone(), way));
                    longer
                })
            })
            .take(MAX_COMBINATIONS)
            .collect();
    }
    all
}

fn described_choice(model: &Model) -> Result<VelocityChoice, AdviseError> {
    VelocityChoice::with_counts("as written".into(), Vec::new(), true, model.clone())
}

impl VelocityChoice {
    fn with_counts(
        label: String,
        statements: Vec<String>,
        as_written: bool,
        model: Model,
    ) -> Result<Self, AdviseError> {
        let (chosen, _) =
            forward_dynamics(&model, &NumericalLoss::default()).ok_or(AdviseError::SingularMass)?;
        Ok(VelocityChoice {
            label,
            statements,
            as_written,
            accel: chosen.count,
            rate: count(&model.graph, &model.rate),
            model,
        })
    }
}

/// Rewrites the model in other velocities and counts its operations.
fn evaluate_choice(
    model: &Model,
    combination: &[(MotionKind, VelocityKind)],
) -> Result<VelocityChoice, AdviseError> {
    let mut own = model.clone();
    let rows = kinematics::left_inverse(&mut own).ok_or(AdviseError::DependentColumns)?;
    let mut rates = RateDraft::new(model, &mut own.graph);
    for (moves, way) in combination {
        rates.add_part(moves, *way);
    }
    let (lines, label) = (rates.statements(), rates.label.join(", "));
    let rate = rates.rate;
    let graph = &mut own.graph;
    // Compute A' and B = Y A'.
    let mut by: Vec<Derivation> = own
        .xi
        .iter()
        .map(|xi| Derivation::new([(xi.node(), graph.one())]))
        .collect();
    let a: Vec<Vec<Edge>> = rate
        .iter()
        .map(|&entry| by.iter_mut().map(|d| d.of(graph, entry)).collect())
        .collect();
    let columns = |a: &[Vec<Edge>]| {
        let mut columns = transpose(a);
        columns.sort();
        columns
    };
    let as_written = columns(&a) == columns(&model.a);
    let b: Vec<Vec<Edge>> = rows
        .iter()
        .map(|row| {
            (0..own.xi.len())
                .map(|j| {
                    let column: Vec<Edge> = a.iter().map(|entries| entries[j]).collect();
                    graph.dot(row, &column)
                })
                .collect()
        })
        .collect();
    let old: Vec<Edge> = b.iter().map(|row| graph.dot(row, &own.xi)).collect();
    let set: Vec<(usize, Edge)> = own
        .xi
        .iter()
        .zip(&old)
        .filter_map(|(xi, &value)| Some((graph.as_symbol(*xi)?, value)))
        .collect();
    // Substitute ξ wherever it occurs.
    own.kinetic = substitute(graph, &[own.kinetic], &set)[0];
    let force = substitute(graph, &own.generalized, &set);
    own.generalized = transpose(&b)
        .iter()
        .map(|column| graph.dot(column, &force))
        .collect();
    for wrench in &mut own.wrenches {
        for part in [&mut wrench.force, &mut wrench.torque] {
            let moved = substitute(graph, &part[..], &set);
            part.copy_from_slice(&moved);
        }
    }
    own.a = a;
    own.rate = rate;
    VelocityChoice::with_counts(label, lines, as_written, own)
}
