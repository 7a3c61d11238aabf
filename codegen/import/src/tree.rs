//! The tree of links and joints: one root, and one joint that moves each other link.

use crate::problem::Problems;
use crate::robot::{Named, Robot};
use std::collections::BTreeMap;

/// Links and joints in the order in which they are reached from the root.
#[derive(Debug)]
pub(crate) struct Tree {
    /// Link that no joint moves.
    pub(crate) root: usize,
    /// Joints in depth-first order, parents first; the joints on one link are sorted by name, as in programs that
    /// build on `urdfdom`, so that rows of matrices come in the same order.
    pub(crate) joints: Vec<Edge>,
}

/// A joint between two links, each given by its index.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    pub(crate) joint: usize,
    pub(crate) parent: usize,
    pub(crate) child: usize,
}

/// Finds the tree; `None` if there is none.
pub(crate) fn tree(robot: &Robot, errors: &mut Problems<'_>) -> Option<Tree> {
    let links = by_name(robot.links.iter().map(|link| &link.name), "link", errors);
    by_name(
        robot.joints.iter().map(|joint| &joint.name),
        "joint",
        errors,
    );
    if robot.links.is_empty() {
        if errors.is_empty() {
            errors.push(
                &robot.range,
                "the robot has no links",
                "add `<link name=\"…\">`",
            );
        }
        return None;
    }
    let mut edges: Vec<Edge> = Vec::new();
    let mut mover: Vec<Option<usize>> = vec![None; robot.links.len()];
    let mut sound = true;
    for (index, joint) in robot.joints.iter().enumerate() {
        let [parent, child] = [&joint.parent, &joint.child].map(|end| {
            let found = links.get(end.name.as_str()).copied();
            if found.is_none() {
                unknown("link", end, links.keys().copied(), errors);
            }
            found
        });
        let (Some(parent), Some(child)) = (parent, child) else {
            sound = false;
            continue;
        };
        if let Some(other) = mover[child].and_then(|other| robot.joints.get(other)) {
            sound = false;
            errors.push(
                &joint.child.range,
                format!(
                    "`{}` already moves with `{}`",
                    joint.child.name, other.name.name
                ),
                "URDF has only trees; write a closed loop as a `loop` statement in the description",
            );
            continue;
        }
        mover[child] = Some(index);
        edges.push(Edge {
            joint: index,
            parent,
            child,
        });
    }
    let roots: Vec<usize> = (0..mover.len())
        .filter(|&link| mover[link].is_none())
        .collect();
    // A joint with an error leaves its child without a joint, which is not a further error.
    let sound = sound && errors.is_empty();
    let cycles = cycles(&edges, robot.links.len());
    if sound && roots.is_empty() && cycles.len() == 1 {
        // Every link is moved by another link.
        errors.push(
            &robot.range,
            "no link is the base: the joints form a cycle",
            "remove the joint that moves the base",
        );
        return None;
    }
    for cycle in cycles {
        let joint = &robot.joints[cycle];
        errors.push(
            &joint.name.range,
            format!("`{}` is part of a cycle of joints", joint.name.name),
            "URDF has only trees; remove one joint of the cycle",
        );
    }
    let (&root, others) = roots.split_first()?;
    for &other in others.iter().filter(|_| sound) {
        let names = (&robot.links[other].name, &robot.links[root].name.name);
        errors.push(
            &names.0.range,
            format!(
                "no joint moves `{}`, but `{}` is the base",
                names.0.name, names.1
            ),
            "join it to the rest, or remove it",
        );
    }
    let mut order = Vec::new();
    let mut open = vec![root];
    while let Some(link) = open.pop() {
        order.extend(edges.iter().filter(|edge| edge.child == link));
        let mut children: Vec<&Edge> = edges.iter().filter(|edge| edge.parent == link).collect();
        children.sort_by_key(|edge| &robot.joints[edge.joint].name.name);
        open.extend(children.iter().rev().map(|edge| edge.child));
    }
    errors.is_empty().then_some(Tree {
        root,
        joints: order,
    })
}

/// Returns the first joint of each cycle, in the order of the file. Each link is the child of at most one edge.
fn cycles(edges: &[Edge], links: usize) -> Vec<usize> {
    let mut parents: Vec<Option<usize>> = vec![None; links];
    for edge in edges {
        parents[edge.child] = Some(edge.parent);
    }
    let mut known = vec![false; links];
    let mut first = Vec::new();
    for edge in edges.iter() {
        if known[edge.child] {
            continue;
        }
        // Go from parent to parent, at most once around: from a link of a cycle this leads back to it.
        let up = std::iter::successors(Some(edge.parent), |&link| parents[link]);
        let way: Vec<usize> = up
            .take(links)
            .take_while(|&link| link != edge.child)
            .collect();
        let last = way.last().copied().unwrap_or(edge.child);
        if last == edge.child || parents[last] == Some(edge.child) {
            known[edge.child] = true;
            way.iter().for_each(|&link| known[link] = true);
            first.push(edge.joint);
        }
    }
    first
}

/// Returns indices by name; a repeated name is an error.
fn by_name<'a>(
    names: impl Iterator<Item = &'a Named>,
    what: &str,
    errors: &mut Problems<'_>,
) -> BTreeMap<&'a str, usize> {
    let mut known = BTreeMap::new();
    for (index, name) in names.enumerate() {
        if known.contains_key(name.name.as_str()) {
            errors.push(
                &name.range,
                format!("more than one {what} is called `{}`", name.name),
                "the names of links have to differ, and so do those of joints",
            );
        } else {
            known.insert(name.name.as_str(), index);
        }
    }
    known
}

/// Reports a name that does not exist.
pub(crate) fn unknown<'a>(
    what: &str,
    name: &Named,
    known: impl Iterator<Item = &'a str>,
    errors: &mut Problems<'_>,
) {
    errors.push(
        &name.range,
        format!("there is no {what} `{}`", name.name),
        near(&name.name, known).map_or_else(
            || format!("name a {what} of this robot"),
            |near| format!("did you mean `{near}`?"),
        ),
    );
}

/// Returns the most similar name, if it is similar enough to be a misspelling.
pub(crate) fn near<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let most = name.chars().count().div_ceil(3);
    known
        .map(|other| (strsim::damerau_levenshtein(name, other), other))
        .filter(|(distance, other)| *distance <= most && *distance < other.chars().count())
        .min()
        .map(|(_, other)| other)
}
