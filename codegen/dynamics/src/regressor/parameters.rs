//! Standard parameters: for every link Θ (kg m²) about its frame's origin, m s (kg m) and m (kg); for joints their
//! armatures, dampers and springs. Also the moments of a link about its origin, in terms of which they are
//! expressed.

use super::local_relations::Relation;
use crate::calculus::Calculus;
use crate::tree::Tree;
use crate::tree::draft::JointFrame;
use crate::tree::mass::LinkInertia;
use crate::tree::turn::RotationFactor;
use hamel_algebra::graph::{Edge, Graph, Node};
use hamel_algebra::linear::{Mat3, transpose3, zero3};
use hamel_language::model::Model;
use hamel_language::model::elements::Along;

/// Names of the ten parameters of a link, in their order.
pub const PARAMETER_NAMES: [&str; 10] = [
    "Theta_xx", "Theta_xy", "Theta_xz", "Theta_yy", "Theta_yz", "Theta_zz", "h_x", "h_y", "h_z",
    "m",
];

/// Rows and columns of the entries of Θ in this order.
pub const INERTIA_ENTRIES: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// Kind of a standard parameter: an entry of a link's inertia, or armature, damping or stiffness of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// Parameter of a link, by its place in the order Θxx, Θxy, Θxz, Θyy, Θyz, Θzz, h = m s, m.
    Inertia(usize),
    /// Armature inertia J of a joint.
    Armature,
    /// Coefficient of a damper.
    Damping,
    /// Stiffness of a spring.
    Stiffness,
}

/// A standard parameter: an entry of (Θ, m s, m) of a link, about its frame's origin, or a parameter of a joint.
#[derive(Clone, Debug)]
pub struct StandardParameter {
    /// Kind of parameter.
    pub kind: ParameterKind,
    /// Name of the frame of the link, or of the velocity or coordinate, that the parameter belongs to.
    pub of: String,
    /// Value in the description.
    pub value: Edge,
    /// Whether the parameter exists in the model; links without mass have parameters only for the sake of
    /// relations.
    pub present: bool,
}

impl StandardParameter {
    /// Returns the name of the parameter in text.
    pub fn name(&self) -> String {
        let own = match self.kind {
            ParameterKind::Inertia(place) => PARAMETER_NAMES[place],
            ParameterKind::Armature => "armature",
            ParameterKind::Damping => "damping",
            ParameterKind::Stiffness => "stiffness",
        };
        format!("{}.{own}", self.of)
    }
}

/// A link with the frame that represents it.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name of the frame.
    pub name: String,
    /// Index of the frame in the model.
    pub frame: usize,
    /// Axes of the frame in those of the link.
    pub axes: Mat3,
    /// Parent link.
    pub parent: Option<usize>,
    /// Whether the link has mass.
    pub present: bool,
    /// Standard parameters of the link.
    pub standard: Vec<StandardParameter>,
    /// Moments about the link's origin of a unit of each parameter.
    moments: Vec<Vec<Edge>>,
}

/// Returns the links of a tree with their standard parameters.
pub fn links(model: &mut Model, tree: &Tree, joint_frames: &[JointFrame]) -> Vec<Link> {
    let pairs = tree.links.iter().zip(joint_frames);
    pairs
        .map(|(link, joint_frame)| {
            let graph = &mut model.graph;
            let back = RotationFactor::By(transpose3(&joint_frame.axes));
            let mass = joint_frame.mass.rotate_axes(graph, &back);
            let name = model.frames[joint_frame.frame].name.clone();
            let values = standard_parameters_of(graph, &mass);
            let present = values.iter().any(|&value| value != graph.zero());
            let standard = values.into_iter().enumerate();
            let (zero, one) = (graph.zero(), graph.one());
            let back = joint_frame.origin.map(|entry| -entry);
            let unit = |place: usize| {
                let mut ten = [zero; 10];
                ten[place] = one;
                let mass = inertia_of_standard(graph, &ten).shift_origin(graph, back);
                moments_of(&mass)
            };
            Link {
                moments: (0..10).map(unit).collect(),
                standard: standard
                    .map(|(place, value)| StandardParameter {
                        kind: ParameterKind::Inertia(place),
                        of: name.clone(),
                        value,
                        present,
                    })
                    .collect(),
                name,
                frame: joint_frame.frame,
                axes: joint_frame.axes,
                parent: link.parent,
                present,
            }
        })
        .collect()
}

/// Returns the inertia with these ten standard parameters.
pub fn inertia_of_standard(graph: &mut Graph, ten: &[Edge]) -> LinkInertia {
    let mut second: Mat3 = [zero3(graph); 3];
    let trace = graph.sum(&DIAGONAL_PARAMETERS.map(|k| ten[k]));
    let half = graph.ratio(1, 2);
    let half = graph.mul(half, trace);
    for (&(i, j), &entry) in INERTIA_ENTRIES.iter().zip(ten) {
        second[i][j] = if i == j {
            graph.sub(half, entry)
        } else {
            -entry
        };
        second[j][i] = second[i][j];
    }
    LinkInertia {
        mass: ten[9],
        first: std::array::from_fn(|i| ten[6 + i]),
        second,
    }
}

/// Returns the ten standard parameters of an inertia.
pub fn standard_parameters_of(graph: &mut Graph, mass: &LinkInertia) -> Vec<Edge> {
    let theta = mass.inertia_matrix(graph);
    let mut ten = INERTIA_ENTRIES.map(|(i, j)| theta[i][j]).to_vec();
    ten.extend(mass.first);
    ten.push(mass.mass);
    ten
}

/// Places of the diagonal of Θ among the ten parameters.
pub const DIAGONAL_PARAMETERS: [usize; 3] = [0, 3, 5];

/// Names of the second moments, which take the places of the diagonal.
pub const SECOND_MOMENT_NAMES: [&str; 3] = ["Sigma_xx", "Sigma_yy", "Sigma_zz"];

/// Returns the ten moments of an inertia: Σ_xx, −Σ_xy, −Σ_xz, Σ_yy, −Σ_yz, Σ_zz, h, m.
fn moments_of(mass: &LinkInertia) -> Vec<Edge> {
    let second = INERTIA_ENTRIES.map(|(i, j)| {
        let entry = mass.second[i][j];
        if i == j { entry } else { -entry }
    });
    let mut ten = second.to_vec();
    ten.extend(mass.first);
    ten.push(mass.mass);
    ten
}

/// Returns the columns of the standard parameters from those of the moments: the force that a parameter needs is
/// the sum of those of its moments.
pub fn standard_columns(
    graph: &mut Graph,
    links: &[Link],
    moments: &[Vec<Edge>],
) -> Vec<Vec<Edge>> {
    let pairs = links.iter().zip(moments.chunks(10));
    let column = |graph: &mut Graph, ten: &[Vec<Edge>], unit: &[Edge]| {
        let rows = 0..ten[0].len();
        let row = |row: usize| {
            let entries: Vec<Edge> = ten.iter().map(|column| column[row]).collect();
            graph.dot(unit, &entries)
        };
        rows.map(row).collect()
    };
    pairs
        .flat_map(|(link, ten)| link.moments.iter().map(move |unit| (ten, unit)))
        .map(|(ten, unit)| column(graph, ten, unit))
        .collect()
}

/// Rewrites a linear relation between regressor columns of (Θ, m s, m) of the links as one between columns of (Σ, m s,
/// m), Σ = tr(Θ)/2 I − Θ.
pub fn to_second_moments(graph: &mut Graph, links: &[Link], relation: &Relation) -> Relation {
    let zero = graph.zero();
    let mut factors = vec![zero; 10 * links.len()];
    let mut all = Relation::new();
    for &(k, factor) in relation {
        let Some(link) = links.get(k / 10) else {
            all.push((k, factor));
            continue;
        };
        let ten = &mut factors[k - k % 10..][..10];
        for (entry, &unit) in ten.iter_mut().zip(&link.moments[k % 10]) {
            let share = graph.mul(factor, unit);
            *entry = graph.add(*entry, share);
        }
    }
    let of_links = factors.into_iter().enumerate();
    all.extend(of_links.filter(|(_, factor)| *factor != zero));
    all
}

/// Rewrites a linear combination of (Σ, m s, m) of the links, Σ = tr(Θ)/2 I − Θ, as one of the standard parameters (Θ,
/// m s, m); those of the kept parameter's own link or joint come first.
pub fn to_standard_terms(
    graph: &mut Graph,
    links: &[Link],
    kept: usize,
    terms: impl Iterator<Item = (usize, Edge)>,
) -> Vec<(usize, Edge)> {
    let zero = graph.zero();
    let mut factors = vec![zero; 10 * links.len()];
    let mut all = Vec::new();
    for (k, factor) in terms {
        match factors.get_mut(k) {
            Some(entry) => *entry = factor,
            None => all.push((k, factor)),
        }
    }
    for (index, (link, ten)) in links.iter().zip(factors.chunks(10)).enumerate() {
        for (place, unit) in link.moments.iter().enumerate() {
            let factor = graph.dot(unit, ten);
            if factor != zero {
                all.push((10 * index + place, factor));
            }
        }
    }
    let own = kept < factors.len();
    all.sort_by_key(|&(k, _)| {
        let of_own = match own {
            true => k / 10 == kept / 10,
            false => k == kept,
        };
        (!of_own, k)
    });
    all
}

/// Returns the name of a base parameter: that of the single standard parameter of its link in it, or else that of
/// the kept moment.
pub fn name(
    graph: &Graph,
    standard: &[StandardParameter],
    kept: usize,
    terms: &[(usize, Edge)],
) -> String {
    let ParameterKind::Inertia(place) = standard[kept].kind else {
        return standard[kept].name();
    };
    let Some(axis) = DIAGONAL_PARAMETERS.iter().position(|&k| k == place) else {
        return standard[kept].name();
    };
    let of_link = |&&(k, _): &&(usize, Edge)| {
        matches!(standard[k].kind, ParameterKind::Inertia(_)) && k / 10 == kept / 10
    };
    match terms.iter().filter(of_link).collect::<Vec<_>>()[..] {
        [&(k, factor)] if factor == graph.one() => standard[k].name(),
        _ => format!("{}.{}", standard[kept].of, SECOND_MOMENT_NAMES[axis]),
    }
}

/// Parameters of joints with their columns, and forces that have no such parameters.
pub struct JointParameters {
    /// Parameters, each with its column of Y.
    pub parameters: Vec<(StandardParameter, Vec<Edge>)>,
    /// Descriptions of other forces that act.
    pub besides: Vec<&'static str>,
    /// Derivatives ∂ᵢ of all potentials other than gravity and these springs.
    pub other_potentials: Vec<Edge>,
}

/// Collects armatures, dampers and springs.
pub fn joint_parameters(model: &mut Model, calculus: &mut Calculus) -> JointParameters {
    let n = model.n();
    let zero = model.graph.zero();
    let mut parameters = Vec::new();
    let standard = |kind, of: String, value| StandardParameter {
        kind,
        of,
        value,
        present: true,
    };
    for i in 0..n {
        if model.armature[i] != zero {
            let mut column = vec![zero; n];
            column[i] = model.xi_dot[i];
            let name = symbol_name(model, model.xi[i]).unwrap_or_default();
            parameters.push((
                standard(ParameterKind::Armature, name, model.armature[i]),
                column,
            ));
        }
    }
    let mut lines = false;
    for (place, damper) in model.elements.dampers.clone().into_iter().enumerate() {
        let Along::Scalar(rate) = damper.along else {
            lines = true;
            continue;
        };
        let column = (0..n).map(|i| {
            let seeds = [(model.xi[i].node(), model.graph.one())];
            let slope =
                hamel_algebra::derivation::Derivation::new(seeds).of(&mut model.graph, rate);
            model.graph.mul(rate, slope)
        });
        let column = column.collect();
        let name = symbol_name(model, rate).unwrap_or_else(|| format!("damper_{}", place + 1));
        parameters.push((
            standard(ParameterKind::Damping, name, damper.coefficient),
            column,
        ));
    }
    let mut potential = model.potential;
    for (place, spring) in model.elements.springs.clone().into_iter().enumerate() {
        let Along::Scalar(length) = spring.along else {
            lines = true;
            continue;
        };
        let stretch = model.graph.sub(length, spring.length);
        let half = model.graph.ratio(1, 2);
        let energy = [half, spring.stiffness, stretch, stretch].into_iter();
        let energy = energy.fold(model.graph.one(), |product, by| {
            model.graph.mul(product, by)
        });
        potential = model.graph.sub(potential, energy);
        let column = (0..n).map(|i| {
            let slope = calculus.along(&mut model.graph, i, length);
            model.graph.mul(stretch, slope)
        });
        let column = column.collect();
        let name = symbol_name(model, length).unwrap_or_else(|| format!("spring_{}", place + 1));
        parameters.push((
            standard(ParameterKind::Stiffness, name, spring.stiffness),
            column,
        ));
    }
    let slopes = (0..n).map(|i| calculus.along(&mut model.graph, i, potential));
    let other_potentials = slopes.collect();
    let elements = &model.elements;
    let mut besides = Vec::new();
    let all = [
        (lines, "springs and dampers along lines"),
        (elements.potential != zero, "the potential"),
        (elements.dissipation != zero, "the dissipation"),
    ];
    besides.extend(
        all.iter()
            .filter(|(there, _)| *there)
            .map(|(_, what)| *what),
    );
    JointParameters {
        parameters,
        besides,
        other_potentials,
    }
}

/// Returns the name of a symbol; `None` for other expressions.
fn symbol_name(model: &Model, edge: Edge) -> Option<String> {
    match model.graph.node(edge.node()) {
        Node::Symbol(index) => Some(model.graph.symbols()[index as usize].name.clone()),
        _ => None,
    }
}
