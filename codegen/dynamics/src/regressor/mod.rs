//! Generalised force of inverse dynamics as a linear function of inertial parameters, F = Y(x, ξ, ξ̇) π, and the
//! base parameters β, with F = Y_b β and independent columns of Y_b (Gautier and Khalil 1990; Khalil and Dombre,
//! *Modeling, Identification and Control of Robots*, chapter 9).
//!
//! | file | owns |
//! |---|---|
//! | `parameters` | the standard parameters: ten of each link, and those of joints; their names and values |
//! | `wrenches` | wrenches of unit parameters, in axes chosen by the generator |
//! | `columns` | the columns of Y: the generalised forces of these wrenches at the joints |
//! | `samples` | Y at random states, modulo p, with one value for everything that is constant at run time |
//! | `local_relations` | relations between a link and its parent, with exact coefficients |
//! | `relations` | elimination; remaining relations; the base parameters |
//! | `error` | reasons why a model has no regressor |
//!
//! A link is everything that moves rigidly together; its parameters are given in the frame that its joint carries.
//! They are ordered by link, from the root outwards: Θ, then m s, then m; armatures, dampers and springs come last.
//! Relations are found between these standard parameters, but solved in terms of the moments of each link: m, h,
//! the products of inertia and the second moments Σ_xx, Σ_yy and Σ_zz, Σ = tr(Θ)/2 I − Θ, about the frame's origin
//! or another point of the joint's axis. A moment whose column is a combination of those of earlier ones is
//! regrouped with them, and all others are kept. Moments are used because a column of Σ_xx takes three operations
//! at a joint where one of Θ_xx takes five.
//!
//! Rank and relations are found at random states in two fields of 2⁶² elements each, at one random value of every
//! run-time parameter. A relation is accepted only with exact coefficients, numbers or expressions in run-time
//! parameters, with which it holds there; if fewer relations are found than the rank requires, an error is
//! returned.

mod columns;
mod error;
mod local_relations;
mod parameters;
mod relations;
mod samples;
mod wrenches;

pub use error::RegressorError;
pub use parameters::{
    DIAGONAL_PARAMETERS, INERTIA_ENTRIES, ParameterKind, SECOND_MOMENT_NAMES, StandardParameter,
};

use super::calculus::Calculus;
use super::tree::Tree;
use hamel_algebra::graph::Edge;
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_program::count::count;
use samples::RegressorSamples;

/// Base parameter β = Σ k π, a combination of standard parameters.
#[derive(Clone, Debug)]
pub struct BaseParameter {
    /// Name: that of the standard parameter that it equals, apart from parameters of other links regrouped with it,
    /// or that of a second moment Σ_xx = (Θ_yy + Θ_zz − Θ_xx) / 2.
    pub name: String,
    /// Kind of parameter.
    pub kind: ParameterKind,
    /// Terms: places of standard parameters with their coefficients, those of its own link or joint first.
    pub terms: Vec<(usize, Edge)>,
    /// Column of Y.
    pub column: Vec<Edge>,
}

/// Regressor Y of F = Y π, as expressions, with the base parameters to which it is reduced.
#[derive(Clone, Debug)]
pub struct Regressor {
    /// Model, with a graph that holds all expressions below.
    pub model: Model,
    /// Names of the frames that represent links, in the order of the links with mass.
    pub links: Vec<String>,
    /// Standard parameters.
    pub standard: Vec<StandardParameter>,
    /// Column of Y of every standard parameter.
    pub columns: Vec<Vec<Edge>>,
    /// Base parameters, in the order of the parameters that are kept.
    pub base: Vec<BaseParameter>,
    /// Standard parameters that have no effect on the force.
    pub idle: Vec<usize>,
    /// Other forces in the model that are not linear functions of these parameters.
    pub besides: Vec<&'static str>,
    /// Force of the potentials that are not part of the regressor, ∂ᵢV.
    pub other_potentials: Vec<Edge>,
}

/// Derives the base parameters of a model, about the origins of its frames or about origins moved along hinges,
/// whichever makes Y cheaper.
///
/// # Errors
///
/// The reason why the model has none, or why their relations could not be found.
pub fn regressor(model: &Model) -> Result<Regressor, RegressorError> {
    check_supported(model)?;
    let described = regressor_about(model, false)?;
    let cost = |found: &Regressor| {
        let columns = found.base.iter().flat_map(|base| &base.column);
        count(&found.model.graph, &columns.copied().collect::<Vec<Edge>>()).weight()
    };
    Ok(match regressor_about(model, true) {
        Ok(moved) if cost(&moved) < cost(&described) => moved,
        _ => described,
    })
}

/// Derives the base parameters about the origins of frames, or about origins that are moved along hinges.
fn regressor_about(model: &Model, moved: bool) -> Result<Regressor, RegressorError> {
    let mut model = model.clone();
    let mut calculus = Calculus::new(&model);
    let (tree, joint_frames) =
        Tree::with_frames(&mut model, &mut calculus, moved).ok_or(RegressorError::OtherInertia)?;
    let links = parameters::links(&mut model, &tree, &joint_frames);
    let mut standard: Vec<StandardParameter> = links
        .iter()
        .flat_map(|link| link.standard.clone())
        .collect();
    let joints = parameters::joint_parameters(&mut model, &mut calculus);
    // Emitted expressions are derived in a separate graph, because a graph computes equal expressions only in the
    // way of the first one.
    let mut derived = model.clone();
    let moments = columns::inertial_columns(&mut model, &tree, &links);
    let mut columns = parameters::standard_columns(&mut model.graph, &links, &moments);
    for (parameter, column) in &joints.parameters {
        standard.push(parameter.clone());
        columns.push(column.clone());
    }
    let samples = RegressorSamples::new(&model, &columns).ok_or(RegressorError::NoValues)?;
    let found = relations::solve_relations(&mut model, &samples, &tree, &links, standard.len())?;
    let kept: Vec<usize> = found.iter().map(|(kept, _)| *kept).collect();
    let mut moments = columns::cheapest_columns(&mut derived, &tree, &links, &kept);
    let mut columns = parameters::standard_columns(&mut derived.graph, &links, &moments);
    let of_joints: Vec<Vec<Edge>> = joints
        .parameters
        .into_iter()
        .map(|(_, column)| column)
        .collect();
    moments.extend(of_joints.clone());
    columns.extend(of_joints);
    // Links without mass take part in the relations, but have no parameters.
    let present: Vec<usize> = (0..standard.len())
        .filter(|&k| standard[k].present)
        .collect();
    let place = |k: usize| present.binary_search(&k).ok();
    let mut base = Vec::with_capacity(found.len());
    for (kept, terms) in found {
        let factors: Vec<Edge> = terms.iter().map(|&(_, factor)| factor).collect();
        let factors = rebuild(&model.graph, &mut derived.graph, &factors);
        let terms = terms.iter().map(|&(k, _)| k).zip(factors);
        let terms = parameters::to_standard_terms(&mut derived.graph, &links, kept, terms);
        base.push(BaseParameter {
            name: parameters::name(&derived.graph, &standard, kept, &terms),
            kind: standard[kept].kind,
            terms: terms
                .into_iter()
                .filter_map(|(k, factor)| Some((place(k)?, factor)))
                .collect(),
            column: std::mem::take(&mut moments[kept]),
        });
    }
    let is_idle = |&k: &usize| samples.rows.iter().all(|row| row[k].is_zero());
    let idle = present.iter().copied().filter(is_idle);
    Ok(Regressor {
        base,
        idle: idle.filter_map(place).collect(),
        links: links
            .iter()
            .filter(|link| link.present)
            .map(|link| link.name.clone())
            .collect(),
        standard: present.iter().map(|&k| standard[k].clone()).collect(),
        columns: present.iter().map(|&k| columns[k].clone()).collect(),
        besides: joints.besides,
        other_potentials: joints.other_potentials,
        model: derived,
    })
}

/// Returns an error if the model is of a kind that has no regressor here.
fn check_supported(model: &Model) -> Result<(), RegressorError> {
    if model.clock.is_some() || !model.prescribed.is_empty() || !model.accelerated.is_empty() {
        return Err(RegressorError::PrescribedMotion);
    }
    if !model.constraints.is_empty() {
        return Err(RegressorError::ConstrainedVelocities);
    }
    if !model.points.constraints.is_empty() || !model.spans {
        return Err(RegressorError::ConstrainedCoordinates);
    }
    if model.bodies.is_empty() && model.particles.is_empty() {
        return Err(RegressorError::NoBodies);
    }
    Ok(())
}
