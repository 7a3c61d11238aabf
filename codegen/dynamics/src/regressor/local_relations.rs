//! Relations between the parameters of a link and those of its parent link, with exact coefficients.
//!
//! An inertia δ of a link that has no effect on the force of the link's joint acts on the parent like the same
//! inertia at rest there: δ transferred at any configuration of the joint. Here it is transferred at the
//! configuration in which all coordinates are zero or the identity, so that lengths and mounting angles enter as
//! the description has them. On a hinge, such δ are masses on its axis; those of other joints, and of links that
//! move together, are found at random states.

use super::parameters::{Link, inertia_of_standard, standard_parameters_of};
use super::samples::RegressorSamples;
use crate::tree::mass::LinkInertia;
use crate::tree::turn::RotationFactor;
use crate::tree::{Link as TreeLink, Tree};
use hamel_algebra::echelon::Echelon;
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{
    Mat3, Vec3, add3, apply_transposed, apply3, multiply3, scale3, sub3, transpose3, zero3,
};
use hamel_algebra::numeric::evaluate;
use hamel_algebra::residue_pair::ResiduePair;
use hamel_algebra::transplant::substitute;
use hamel_language::model::Model;
use hamel_language::model::layout::Block;
use rustc_hash::FxHashMap;

/// Largest number of bits of numerators and denominators of coefficients that are recognised by their values.
const MAX_COEFFICIENT_BITS: u32 = 29;

/// Relation Σ v_k Y_k = 0: its nonzero coefficients, with the places of their parameters.
pub type Relation = Vec<(usize, Edge)>;

/// Exact expressions of constants, found by their values modulo p.
pub struct ExactConstants {
    by_value: FxHashMap<ResiduePair, Edge>,
}

impl ExactConstants {
    /// Collects the entries of poses with all coordinates zero or the identity, their products and their quotients.
    pub fn new(model: &mut Model, samples: &RegressorSamples) -> Self {
        let poses: Vec<(Mat3, Vec3)> = model.frames.iter().map(|frame| frame.relative).collect();
        let entries: Vec<Edge> = poses
            .iter()
            .flat_map(|(turn, shift)| {
                turn.iter()
                    .flatten()
                    .chain(shift)
                    .copied()
                    .collect::<Vec<_>>()
            })
            .collect();
        let mut entries = at_zero(model, &entries);
        let graph = &mut model.graph;
        let (zero, one) = (graph.zero(), graph.one());
        entries.iter_mut().for_each(|entry| *entry = entry.abs());
        entries.retain(|entry| *entry != zero && *entry != one);
        entries.sort_unstable();
        entries.dedup();
        let mut all = entries.clone();
        for &a in &entries {
            for &b in &entries {
                all.push(graph.mul(a, b));
                all.extend(graph.div(a, b));
            }
            all.extend(graph.div(one, a));
        }
        let mut by_value = FxHashMap::default();
        for edge in all {
            if let Some(&[value]) = samples.constant_values(graph, &[edge]).as_deref() {
                by_value.entry(value).or_insert(edge);
                by_value.entry(-value).or_insert(-edge);
            }
        }
        ExactConstants { by_value }
    }

    /// Returns the expression of the exact constant with a given value modulo p: a small fraction or a known constant;
    /// `None` if it is neither.
    pub fn exact_constant(&self, graph: &mut Graph, value: ResiduePair) -> Option<Edge> {
        match value.to_small_rational(MAX_COEFFICIENT_BITS) {
            Some((n, d)) => Some(graph.ratio(n, d)),
            None => self.by_value.get(&value).copied(),
        }
    }

    /// Returns the expressions of the exact constants of all entries of a vector modulo p; `None` if one of them has
    /// none.
    pub fn exact_constants(&self, graph: &mut Graph, values: &[ResiduePair]) -> Option<Vec<Edge>> {
        values
            .iter()
            .map(|&value| self.exact_constant(graph, value))
            .collect()
    }
}

/// Returns relations Σ v_k Y_k = 0 with exact coefficients that hold at the samples: within each link, between each link
/// and its parent, and within groups of links that move together. There may be more.
pub fn local_relations(
    model: &mut Model,
    samples: &RegressorSamples,
    known: &ExactConstants,
    tree: &Tree,
    links: &[Link],
) -> Vec<Relation> {
    let mut groups: Vec<(Vec<usize>, Option<usize>)> = Vec::new();
    for (index, link) in links.iter().enumerate() {
        groups.push((vec![index], None));
        // The frame of a link on the world may be placed by expressions that follow another link.
        let parents = link.parent.map_or(0..index, |parent| parent..parent + 1);
        groups.extend(parents.map(|parent| (vec![index], Some(parent))));
    }
    groups.extend(coupled_links(tree));
    let mut relations = Vec::new();
    let numbers = model.numbers(&model.defaults, &model.start_x, &[], &[], &[]);
    for index in 0..links.len() {
        for masses in along_axis(
            &mut model.graph,
            &numbers,
            &tree.links[index],
            &links[index],
        ) {
            let exact = standard_parameters_of(&mut model.graph, &masses);
            let group = (&[index][..], links[index].parent);
            relations.push(rest_relation(model, links, group, &exact));
        }
        if let Some(masses) = along_earlier_axis(model, &numbers, tree, links, index) {
            let exact = standard_parameters_of(&mut model.graph, &masses);
            for parent in [None, links[index].parent] {
                relations.push(rest_relation(model, links, (&[index], parent), &exact));
            }
        }
    }
    for (group, anchor) in groups {
        relations.extend(relations_among(
            model,
            samples,
            known,
            links,
            (&group, anchor),
        ));
    }
    relations.retain(|relation| is_satisfied(&model.graph, samples, relation));
    relations
}

/// Returns masses on the axis a of a hinge through the frame's origin, which do not move relative to the parent
/// link: m, h = a and ∫ r rᵀ dm = a aᵀ, for any entries of a.
fn along_axis(
    graph: &mut Graph,
    numbers: &[f64],
    link: &TreeLink,
    frame: &Link,
) -> Vec<LinkInertia> {
    let Some(axis) = hinge(graph, link, frame) else {
        return Vec::new();
    };
    let Some(a) = scale_to_one(graph, numbers, axis) else {
        return Vec::new();
    };
    let (one, none) = (graph.one(), LinkInertia::zero(graph));
    let second = a.map(|entry| scale3(graph, entry, a));
    vec![
        LinkInertia { mass: one, ..none },
        LinkInertia { first: a, ..none },
        LinkInertia { second, ..none },
    ]
}

/// Returns the first moment of a slider along the axis of a hinge before it; if that axis does not move, no force
/// depends on this moment.
fn along_earlier_axis(
    model: &mut Model,
    numbers: &[f64],
    tree: &Tree,
    links: &[Link],
    index: usize,
) -> Option<LinkInertia> {
    let slides = |graph: &Graph, link: &TreeLink| match link.freedoms.as_slice() {
        [freedom] => freedom.angular == zero3(graph),
        _ => false,
    };
    let mut before = index;
    while slides(&model.graph, &tree.links[before]) {
        before = tree.links[before].parent?;
    }
    if before == index {
        return None;
    }
    let axis = hinge(&mut model.graph, &tree.links[before], &links[before])?;
    let (turn, _) = pose_at_zero(model, links[index].frame, links[before].frame);
    let graph = &mut model.graph;
    let axis = apply_transposed(graph, &turn, axis);
    let first = scale_to_one(graph, numbers, axis)?;
    Some(LinkInertia {
        first,
        ..LinkInertia::zero(graph)
    })
}

/// Returns the axis of a hinge through the origin of its frame, in the axes of the frame; `None` for other joints.
fn hinge(graph: &mut Graph, link: &TreeLink, frame: &Link) -> Option<Vec3> {
    let [freedom] = link.freedoms.as_slice() else {
        return None;
    };
    let turns = freedom.linear == zero3(graph);
    turns.then(|| apply_transposed(graph, &frame.axes, freedom.angular))
}

/// Scales a direction so that its largest entry is 1.
fn scale_to_one(graph: &mut Graph, numbers: &[f64], axis: Vec3) -> Option<Vec3> {
    let mut symbols = numbers.to_vec();
    symbols.resize(graph.symbols().len(), f64::NAN);
    let sizes = evaluate(graph, &axis, &symbols);
    let largest = (0..3).max_by(|&i, &j| sizes[i].abs().total_cmp(&sizes[j].abs()))?;
    let [x, y, z] = axis.map(|entry| graph.div(entry, axis[largest]));
    Some([x?, y?, z?])
}

/// Returns the groups of links whose joints have a velocity in common, alone and with the one link that all of them
/// hang on.
fn coupled_links(tree: &Tree) -> Vec<(Vec<usize>, Option<usize>)> {
    let rates = |index: usize| {
        let freedoms = tree.links[index].freedoms.iter();
        freedoms.flat_map(|freedom| freedom.rate.iter().map(|&(i, _)| i))
    };
    let mut groups = Vec::new();
    for i in 0..tree.armature.len() {
        let all = 0..tree.links.len();
        let group: Vec<usize> = all.filter(|&index| rates(index).any(|j| j == i)).collect();
        if group.len() < 2 {
            continue;
        }
        let parents = group.iter().map(|&index| tree.links[index].parent);
        let mut outside: Vec<usize> = parents
            .flatten()
            .filter(|parent| !group.contains(parent))
            .collect();
        outside.dedup();
        if let [anchor] = outside[..] {
            groups.push((group.clone(), Some(anchor)));
        }
        groups.push((group, None));
    }
    groups.sort();
    groups.dedup();
    groups
}

/// Returns the relations among the parameters of a group of links and, if given, of a link before them.
fn relations_among(
    model: &mut Model,
    samples: &RegressorSamples,
    known: &ExactConstants,
    links: &[Link],
    (group, anchor): (&[usize], Option<usize>),
) -> Vec<Relation> {
    let ten_of = |index: usize| 10 * index..10 * index + 10;
    let own: Vec<usize> = group.iter().flat_map(|&index| ten_of(index)).collect();
    let before: Vec<usize> = anchor.into_iter().flat_map(ten_of).collect();
    let found = samples.relations(&[&own[..], &before[..]].concat());
    let halves = found.iter().map(|values| values[..own.len()].to_vec());
    let mut relations = Vec::new();
    for values in Echelon::new(halves.collect()).rows {
        let Some(exact) = known.exact_constants(&mut model.graph, &values) else {
            continue;
        };
        relations.push(rest_relation(model, links, (group, anchor), &exact));
    }
    relations
}

/// Returns the relation that inertias of links, ten numbers each, are equivalent to the same inertias at rest in an
/// earlier link, if one is given; otherwise, that they have no effect.
fn rest_relation(
    model: &mut Model,
    links: &[Link],
    (group, anchor): (&[usize], Option<usize>),
    exact: &[Edge],
) -> Relation {
    let ten_of = |index: &usize| 10 * index..10 * index + 10;
    let own: Vec<usize> = group.iter().flat_map(ten_of).collect();
    let mut relation = relation_of(&model.graph, &own, exact);
    if let Some(anchor) = anchor {
        let mut all = vec![model.graph.zero(); 10];
        for (&index, exact) in group.iter().zip(exact.chunks(10)) {
            let pose = pose_at_zero(model, links[index].frame, links[anchor].frame);
            let graph = &mut model.graph;
            let moved = inertia_of_standard(graph, exact)
                .rotate_axes(graph, &RotationFactor::By(pose.0))
                .shift_origin(graph, pose.1);
            for (sum, entry) in all.iter_mut().zip(standard_parameters_of(graph, &moved)) {
                *sum = graph.sub(*sum, entry);
            }
        }
        let before: Vec<usize> = ten_of(&anchor).collect();
        relation.extend(relation_of(&model.graph, &before, &all));
    }
    relation
}

/// Returns a relation: the nonzero coefficients, each with its parameter.
pub fn relation_of(graph: &Graph, parameters: &[usize], factors: &[Edge]) -> Relation {
    let pairs = parameters.iter().copied().zip(factors.iter().copied());
    pairs
        .filter(|(_, factor)| *factor != graph.zero())
        .collect()
}

/// Returns whether a relation Σ v_k Y_k = 0 holds at the samples, modulo p.
pub fn is_satisfied(graph: &Graph, samples: &RegressorSamples, relation: &Relation) -> bool {
    let factors: Vec<Edge> = relation.iter().map(|&(_, factor)| factor).collect();
    let Some(values) = samples.constant_values(graph, &factors) else {
        return false;
    };
    let parameters = relation.iter().map(|&(k, _)| k);
    samples.is_zero_sum(&parameters.zip(values).collect::<Vec<_>>())
}

/// Returns the pose of a frame in another one, with all coordinates zero or the identity.
fn pose_at_zero(model: &mut Model, frame: usize, on: usize) -> (Mat3, Vec3) {
    let (turn, shift) = relative(model, frame, on);
    let entries: Vec<Edge> = turn.iter().flatten().chain(&shift).copied().collect();
    let entries = at_zero(model, &entries);
    let turn = std::array::from_fn(|i| std::array::from_fn(|j| entries[3 * i + j]));
    (turn, std::array::from_fn(|i| entries[9 + i]))
}

/// Returns the pose of a frame in one that it hangs on, or else from the poses of both frames in the world.
fn relative(model: &mut Model, frame: usize, on: usize) -> (Mat3, Vec3) {
    let (mut turn, mut shift) = model.frames[frame].relative;
    let mut at = model.frames[frame].parent;
    let graph = &mut model.graph;
    while let Some(index) = at {
        if index == on {
            return (turn, shift);
        }
        let (outer, origin) = model.frames[index].relative;
        turn = multiply3(graph, &outer, &turn);
        shift = apply3(graph, &outer, shift);
        shift = add3(graph, origin, shift);
        at = model.frames[index].parent;
    }
    let (outer, origin) = (model.frames[on].rotation, model.frames[on].position);
    let away = sub3(graph, model.frames[frame].position, origin);
    let turn = multiply3(graph, &transpose3(&outer), &model.frames[frame].rotation);
    (turn, apply_transposed(graph, &outer, away))
}

/// Returns expressions at the configuration in which all coordinates are zero or the identity.
fn at_zero(model: &mut Model, edges: &[Edge]) -> Vec<Edge> {
    let graph = &mut model.graph;
    let (zero, one) = (graph.zero(), graph.one());
    let values = model.blocks.iter().flat_map(|block| match block {
        Block::Flat(n) => vec![zero; *n],
        Block::Circle => vec![one, zero],
        Block::Quaternion => vec![one, zero, zero, zero],
        Block::Rotation => (0..9)
            .map(|k| if k % 4 == 0 { one } else { zero })
            .collect(),
    });
    let set: Vec<(usize, Edge)> = model
        .x
        .iter()
        .zip(values)
        .filter_map(|(x, value)| Some((graph.as_symbol(*x)?, value)))
        .collect();
    substitute(graph, edges, &set)
}
