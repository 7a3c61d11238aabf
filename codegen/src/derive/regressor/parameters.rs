//! The standard parameters: of every link Θ about its frame's origin, m s and m, of joints their armatures, dampers
//! and springs.

use crate::algebra::graph::{Edge, Node};
use crate::algebra::linear::{Mat3, Vec3, transpose3, zero3};
use crate::derive::calculus::Calculus;
use crate::derive::tree::Tree;
use crate::derive::tree::draft::Carrier;
use crate::derive::tree::mass::Mass;
use crate::derive::tree::turn::Turn;
use crate::model::Model;
use crate::model::elements::Along;

/// The ten parameters of a link, in their order.
pub const PLACES: [&str; 10] = [
    "Theta_xx", "Theta_xy", "Theta_xz", "Theta_yy", "Theta_yz", "Theta_zz", "h_x", "h_y", "h_z",
    "m",
];

/// Rows and columns of the entries of Θ in this order.
pub const ENTRIES: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// What a parameter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Of a link: Θxx, Θxy, Θxz, Θyy, Θyz, Θzz, h = m s, m, by their places in this order.
    Inertia(usize),
    /// J of a joint.
    Armature,
    /// Coefficient of a damper.
    Damping,
    /// Stiffness of a spring.
    Stiffness,
}

/// A standard parameter.
#[derive(Clone, Debug)]
pub struct Standard {
    /// What it is.
    pub kind: Kind,
    /// The frame of the link, or the velocity or coordinate that it belongs to.
    pub of: String,
    /// Its value in the description.
    pub value: Edge,
    /// Whether it is there: links without mass have parameters for the sake of relations alone.
    pub present: bool,
}

impl Standard {
    /// Its name in the text.
    pub fn name(&self) -> String {
        let own = match self.kind {
            Kind::Inertia(place) => PLACES[place],
            Kind::Armature => "armature",
            Kind::Damping => "damping",
            Kind::Stiffness => "stiffness",
        };
        format!("{}.{own}", self.of)
    }
}

/// A link with the frame that stands for it.
#[derive(Clone, Debug)]
pub struct Link {
    /// The frame's name.
    pub name: String,
    /// The frame's index in the model.
    pub frame: usize,
    /// The frame's axes in those of the link.
    pub axes: Mat3,
    /// The link before.
    pub parent: Option<usize>,
    /// Whether it has mass.
    pub present: bool,
    /// Its parameters.
    pub standard: Vec<Standard>,
}

/// The links of a tree.
pub fn links(model: &mut Model, tree: &Tree, carriers: &[Carrier]) -> Vec<Link> {
    let pairs = tree.links.iter().zip(carriers);
    pairs
        .map(|(link, &(frame, axes))| {
            let graph = &mut model.graph;
            let back = Turn::By(transpose3(&axes));
            let mass = link.mass.turned(graph, &back);
            let name = model.frames[frame].name.clone();
            let mut values: Vec<Edge> = {
                let inertia = mass.inertia(graph);
                ENTRIES.iter().map(|&(i, j)| inertia[i][j]).collect()
            };
            values.extend(mass.first);
            values.push(mass.mass);
            let present = values.iter().any(|&value| value != graph.zero());
            let standard = values.into_iter().enumerate();
            Link {
                standard: standard
                    .map(|(place, value)| Standard {
                        kind: Kind::Inertia(place),
                        of: name.clone(),
                        value,
                        present,
                    })
                    .collect(),
                name,
                frame,
                axes,
                parent: link.parent,
                present,
            }
        })
        .collect()
}

/// The ten parameters as m, m s and second moments.
pub fn moments(graph: &mut crate::algebra::graph::Graph, ten: &[Edge]) -> Mass {
    let mut theta: Mat3 = [zero3(graph); 3];
    for (&(i, j), &entry) in ENTRIES.iter().zip(ten) {
        theta[i][j] = entry;
        theta[j][i] = entry;
    }
    let trace = graph.sum(&[theta[0][0], theta[1][1], theta[2][2]]);
    let half = graph.ratio(1, 2);
    let half = graph.mul(half, trace);
    let second = std::array::from_fn(|i| {
        std::array::from_fn(|j| match i == j {
            true => graph.sub(half, theta[i][j]),
            false => -theta[i][j],
        })
    });
    let first: Vec3 = std::array::from_fn(|i| ten[6 + i]);
    Mass {
        mass: ten[9],
        first,
        second,
    }
}

/// The ten parameters of m, m s and second moments.
pub fn ten(graph: &mut crate::algebra::graph::Graph, mass: &Mass) -> Vec<Edge> {
    let theta = mass.inertia(graph);
    let mut ten: Vec<Edge> = ENTRIES.iter().map(|&(i, j)| theta[i][j]).collect();
    ten.extend(mass.first);
    ten.push(mass.mass);
    ten
}

/// Parameters of joints with their columns, and what is no parameter.
pub struct OfJoints {
    /// The parameters, each with its column.
    pub parameters: Vec<(Standard, Vec<Edge>)>,
    /// What else acts.
    pub besides: Vec<&'static str>,
    /// ∂ᵢ of all potentials but those of gravity and of these springs.
    pub other_potentials: Vec<Edge>,
}

/// Armatures, dampers and springs.
pub fn of_joints(model: &mut Model, calculus: &mut Calculus) -> OfJoints {
    let n = model.n();
    let zero = model.graph.zero();
    let mut parameters = Vec::new();
    let standard = |kind, of: String, value| Standard {
        kind,
        of,
        value,
        present: true,
    };
    for i in 0..n {
        if model.armature[i] != zero {
            let mut column = vec![zero; n];
            column[i] = model.xi_dot[i];
            let name = named(model, model.xi[i]).unwrap_or_default();
            parameters.push((standard(Kind::Armature, name, model.armature[i]), column));
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
                crate::algebra::derivation::Derivation::new(seeds).of(&mut model.graph, rate);
            model.graph.mul(rate, slope)
        });
        let column = column.collect();
        let name = named(model, rate).unwrap_or_else(|| format!("damper_{}", place + 1));
        parameters.push((standard(Kind::Damping, name, damper.coefficient), column));
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
        let name = named(model, length).unwrap_or_else(|| format!("spring_{}", place + 1));
        parameters.push((standard(Kind::Stiffness, name, spring.stiffness), column));
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
    OfJoints {
        parameters,
        besides,
        other_potentials,
    }
}

/// The name of a symbol.
fn named(model: &Model, edge: Edge) -> Option<String> {
    match model.graph.node(edge.node()) {
        Node::Symbol(index) => Some(model.graph.symbols()[index as usize].name.clone()),
        _ => None,
    }
}
