//! The force that a motion needs as a linear function of inertial parameters, F = Y(x, ξ, ξ̇) π, and the base
//! parameters β, with F = Y_b β and the columns of Y_b independent (Gautier and Khalil 1990; Khalil and Dombre,
//! *Modeling, Identification and Control of Robots*, chapter 9).
//!
//! | file | owns |
//! |---|---|
//! | `parameters` | the standard parameters: ten of each link, and those of joints; their names and values |
//! | `wrenches` | what a unit of each parameter needs, in axes of the generator's choice |
//! | `columns` | the columns of Y: what these wrenches are at the joints |
//! | `samples` | Y at random states, modulo p, where what is constant at run time has one value |
//! | `candidates` | relations that hold between a link and the one before, with exact coefficients |
//! | `relations` | elimination; what remains to be found; the base parameters |
//!
//! A link is all that moves rigidly together; its parameters are those in the frame that its joint carries. They are
//! put in order: links from the root on, of each Θ, then m s, then m; armatures, dampers and springs at the end.
//! Relations are found between these, and solved between the moments of each link: m, h, products of inertia and the second
//! moments Σ_xx, Σ_yy and Σ_zz, Σ = tr(Θ)/2 I − Θ, about the frame's origin or another point of the joint's axis. A moment whose column is a
//! combination of those of earlier ones is regrouped with them, all others are kept: a column of Σ_xx takes three operations at a
//! joint where one of Θ_xx takes five.
//!
//! Rank and relations are found at random states in two fields of 2⁶² elements each, at one random value of every
//! run-time parameter. A relation is accepted only with exact coefficients, numbers or expressions in run-time
//! parameters, with which it holds there; if fewer are found than the rank asks for, nothing is returned.

mod candidates;
mod columns;
mod parameters;
mod relations;
mod samples;
mod wrenches;

pub use parameters::{DIAGONAL, ENTRIES, Kind, MOMENTS, Standard};

use super::calculus::Calculus;
use super::tree::Tree;
use hamel_algebra::graph::Edge;
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_program::count::count;
use samples::Samples;

/// A base parameter β = Σ k π over standard parameters.
#[derive(Clone, Debug)]
pub struct Base {
    /// What it is called: as the standard parameter that it is, those apart that are regrouped with it, or as a second moment
    /// Σ_xx = (Θ_yy + Θ_zz − Θ_xx) / 2.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// Its terms: places of standard parameters with their factors, those of its own link or joint first.
    pub terms: Vec<(usize, Edge)>,
    /// Its column of Y.
    pub column: Vec<Edge>,
}

/// F = Y π and what follows from it.
#[derive(Clone, Debug)]
pub struct Regressor {
    /// The model, its graph holding all expressions below.
    pub model: Model,
    /// Names of the frames that stand for links, in the order of the links that have mass.
    pub links: Vec<String>,
    /// The standard parameters.
    pub standard: Vec<Standard>,
    /// The column of every standard parameter.
    pub columns: Vec<Vec<Edge>>,
    /// The base parameters, in the order of the parameters that are kept.
    pub base: Vec<Base>,
    /// Standard parameters that have no effect on the force.
    pub idle: Vec<usize>,
    /// What acts besides and is no linear function of these parameters.
    pub besides: Vec<&'static str>,
    /// The force of potentials that are no part of it, ∂ᵢV.
    pub other_potentials: Vec<Edge>,
}

/// Derives the base parameters of a model: about the origins of its frames, or about origins that are moved along hinges
/// where Y is cheaper then.
///
/// # Errors
/// Why a model has none, or why their relations could not be found.
pub fn regressor(model: &Model) -> Result<Regressor, String> {
    refused(model)?;
    let described = about(model, false)?;
    let cost = |found: &Regressor| {
        let columns = found.base.iter().flat_map(|base| &base.column);
        count(&found.model.graph, &columns.copied().collect::<Vec<Edge>>()).weight()
    };
    Ok(match about(model, true) {
        Ok(moved) if cost(&moved) < cost(&described) => moved,
        _ => described,
    })
}

/// The base parameters about the origins of frames, or about origins that are moved.
fn about(model: &Model, moved: bool) -> Result<Regressor, String> {
    let mut model = model.clone();
    let mut calculus = Calculus::new(&model);
    let (tree, carriers) = Tree::with_frames(&mut model, &mut calculus, moved).ok_or(
        "its inertia is not that of bodies on frames and of armatures alone: describe it by `body` statements, without `kinetic` and `particle`",
    )?;
    let links = parameters::links(&mut model, &tree, &carriers);
    let mut standard: Vec<Standard> = links
        .iter()
        .flat_map(|link| link.standard.clone())
        .collect();
    let joints = parameters::of_joints(&mut model, &mut calculus);
    // What is emitted is derived apart: equal expressions of one graph are computed in one way.
    let mut derived = model.clone();
    let moments = columns::inertial(&mut model, &tree, &links);
    let mut columns = parameters::standard_columns(&mut model.graph, &links, &moments);
    for (parameter, column) in &joints.parameters {
        standard.push(parameter.clone());
        columns.push(column.clone());
    }
    let samples = Samples::new(&model, &columns)
        .ok_or("at random states its expressions have no values modulo p")?;
    let found = relations::find(&mut model, &samples, &tree, &links, standard.len())?;
    let kept: Vec<usize> = found.iter().map(|(kept, _)| *kept).collect();
    let mut moments = columns::cheapest(&mut derived, &tree, &links, &kept);
    let mut columns = parameters::standard_columns(&mut derived.graph, &links, &moments);
    let of_joints: Vec<Vec<Edge>> = joints
        .parameters
        .into_iter()
        .map(|(_, column)| column)
        .collect();
    moments.extend(of_joints.clone());
    columns.extend(of_joints);
    // Links without mass take part in the relations, and have no parameters.
    let present: Vec<usize> = (0..standard.len())
        .filter(|&k| standard[k].present)
        .collect();
    let place = |k: usize| present.binary_search(&k).ok();
    let mut base = Vec::with_capacity(found.len());
    for (kept, terms) in found {
        let factors: Vec<Edge> = terms.iter().map(|&(_, factor)| factor).collect();
        let factors = rebuild(&model.graph, &mut derived.graph, &factors);
        let terms = terms.iter().map(|&(k, _)| k).zip(factors);
        let terms = parameters::standard_terms(&mut derived.graph, &links, kept, terms);
        base.push(Base {
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

/// What has no regressor here.
fn refused(model: &Model) -> Result<(), String> {
    let no = |why: &str| Err(why.to_string());
    if model.clock.is_some() || !model.prescribed.is_empty() || !model.accelerated.is_empty() {
        return no(
            "its motion is prescribed or depends on the time; base parameters are those of a system that moves freely",
        );
    }
    if !model.constraints.is_empty() {
        return no(
            "constraints act on its velocities, so that inverse dynamics leaves their forces open; take the tree without loops and constraints",
        );
    }
    if !model.points.constraints.is_empty() || !model.spans {
        return no("its coordinates are tied by constraints; describe it by joints");
    }
    if model.bodies.is_empty() && model.particles.is_empty() {
        return no("it has no bodies, so that there are no inertial parameters");
    }
    Ok(())
}
