//! Columns of Y for the inertia of links: the generalised forces of the wrenches that a unit of each parameter
//! needs.
//!
//! A wrench (force f, torque t) has the generalised force S_ω·t + S_v·f at a joint with the column S = (S_ω, S_v).
//! If the joint and neighbouring joints turn about a common point c, this is S_ω·(t − c × f).

use super::parameters::Link;
use super::wrenches::{ALL_AXES, LinkMotions, WrenchAxes};
use crate::tree::inverse::to_parent;
use crate::tree::wrench::Wrench;
use crate::tree::{Link as TreeLink, Tree};
use hamel_algebra::graph::{Edge, Graph};
use hamel_algebra::linear::{Vec3, add3, cross, scale3, sub3, zero3};
use hamel_algebra::transplant::rebuild;
use hamel_language::model::Model;
use hamel_program::count::count;

/// Way to compute the generalised forces Sᵀ f of a wrench f at the joint of its link and at all joints before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Route {
    /// The wrench f is transformed from link to link.
    Wrenches,
    /// As `Wrenches` for wrenches with a force; for pure torques, which are those of second moments, the columns S
    /// of all joints are transformed to the link.
    Mixed,
    /// The columns S are transformed for all wrenches.
    Twists {
        /// Whether joints whose axes meet are treated as angular velocities alone, on which f acts by its torque
        /// about the common point.
        meeting: bool,
        /// Whether the columns are transformed only to the parent link, and f to the parent's origin; if both links
        /// share axes, this is a shift.
        carried: bool,
    },
}

const fn twists(meeting: bool, carried: bool) -> Route {
    Route::Twists { meeting, carried }
}

/// All routes.
const ROUTES: [Route; 6] = [
    Route::Wrenches,
    Route::Mixed,
    twists(false, false),
    twists(false, true),
    twists(true, false),
    twists(true, true),
];

/// Sets of routes from which the cheapest is chosen link by link: without common points of axes, and with them.
const ROUTE_SETS: [&[Route]; 2] = [
    &[
        Route::Wrenches,
        Route::Mixed,
        twists(false, false),
        twists(false, true),
    ],
    &[Route::Wrenches, twists(true, false)],
];

/// Largest number of changes of single routes that are tried.
const MAX_ROUTE_CHANGES: usize = 60;

/// Returns the columns of all links, ten for each, with second moments in place of the diagonal of Θ.
pub fn inertial_columns(model: &mut Model, tree: &Tree, links: &[Link]) -> Vec<Vec<Edge>> {
    let motions = LinkMotions::new(model, tree, WrenchAxes::Own);
    let all: Vec<usize> = (0..10).collect();
    let links = links.iter().enumerate();
    links
        .flat_map(|link| link_columns(&mut model.graph, &motions, link, &all, Route::Wrenches))
        .collect()
}

/// Returns the columns as `inertial` does, with the kept ones at the least cost: in the cheapest axes, and by the
/// cheapest route for each link.
pub fn cheapest_columns(
    model: &mut Model,
    tree: &Tree,
    links: &[Link],
    kept: &[usize],
) -> Vec<Vec<Edge>> {
    let kept: Vec<Vec<usize>> = (0..links.len())
        .map(|index| {
            let own = (0..10).filter(|k| kept.contains(&(10 * index + k)));
            own.collect()
        })
        .collect();
    let search = Search {
        model,
        tree,
        links,
        kept: &kept,
    };
    let Some(way) = search.best() else {
        return Vec::new();
    };
    // Compute the kept columns first: expressions that they have in common with others are then computed in the way
    // they need.
    let motions = LinkMotions::new(model, tree, way.axes);
    let mut columns: Vec<Option<Vec<Edge>>> = vec![None; 10 * links.len()];
    for first in [true, false] {
        for (index, link) in links.iter().enumerate() {
            let own = (0..10).filter(|k| kept[index].contains(k) == first);
            let own: Vec<usize> = own.collect();
            let route = way.routes[index];
            let found = link_columns(&mut model.graph, &motions, (index, link), &own, route);
            for (k, column) in own.into_iter().zip(found) {
                columns[10 * index + k] = Some(column);
            }
        }
    }
    columns.into_iter().flatten().collect()
}

/// Search for the cheapest way to compute the kept columns.
struct Search<'a> {
    model: &'a Model,
    tree: &'a Tree,
    links: &'a [Link],
    /// Kept parameters of each link.
    kept: &'a [Vec<usize>],
}

/// Axes of all links and the route of each, with their cost.
struct AxesAndRoutes {
    cost: usize,
    axes: WrenchAxes,
    routes: Vec<Route>,
}

impl Search<'_> {
    /// Returns the cheapest way: first chosen link by link, then improved by changing the routes of single links,
    /// since transformed quantities serve several links.
    fn best(&self) -> Option<AxesAndRoutes> {
        let ways = ALL_AXES.iter().flat_map(|&axes| {
            let mut tried = self.model.clone();
            let motions = LinkMotions::new(&mut tried, self.tree, axes);
            let graph = tried.graph;
            ROUTE_SETS.map(|allowed| {
                let (cost, routes) = self.one_by_one(&graph, &motions, allowed);
                AxesAndRoutes { cost, axes, routes }
            })
        });
        let mut best = ways.min_by_key(|way| way.cost)?;
        let mut tried = self.model.clone();
        let motions = LinkMotions::new(&mut tried, self.tree, best.axes);
        let mut left = MAX_ROUTE_CHANGES;
        loop {
            let before = best.cost;
            for (index, route) in self
                .costly()
                .rev()
                .flat_map(|i| ROUTES.map(|route| (i, route)))
            {
                if left == 0 || best.routes[index] == route {
                    continue;
                }
                left -= 1;
                let mut routes = best.routes.clone();
                routes[index] = route;
                let mut graph = tried.graph.clone();
                let all = self.costly();
                let roots = all.flat_map(|i| self.kept_columns(&mut graph, &motions, i, routes[i]));
                let roots: Vec<Edge> = roots.collect();
                let cost = count(&graph, &roots).weight();
                if cost < best.cost {
                    best = AxesAndRoutes {
                        cost,
                        routes,
                        ..best
                    };
                }
            }
            if best.cost == before {
                return Some(best);
            }
        }
    }

    fn costly(&self) -> impl DoubleEndedIterator<Item = usize> {
        (0..self.links.len()).filter(|&index| !self.kept[index].is_empty())
    }

    fn kept_columns(
        &self,
        graph: &mut Graph,
        motions: &LinkMotions,
        index: usize,
        route: Route,
    ) -> Vec<Edge> {
        let link = (index, &self.links[index]);
        link_columns(graph, motions, link, &self.kept[index], route).concat()
    }

    /// Picks the cheapest of some routes for one link after the other.
    fn one_by_one(
        &self,
        graph: &Graph,
        motions: &LinkMotions,
        allowed: &[Route],
    ) -> (usize, Vec<Route>) {
        let mut taken = vec![Route::Wrenches; self.links.len()];
        let (mut least, mut graph, mut roots) = (0, graph.clone(), Vec::new());
        for index in self.costly() {
            let tried = allowed.iter().map(|&route| {
                let mut graph = graph.clone();
                let found = self.kept_columns(&mut graph, motions, index, route);
                let roots = [&roots[..], &found].concat();
                (count(&graph, &roots).weight(), route, graph, roots)
            });
            if let Some(best) = tried.min_by_key(|(cost, ..)| *cost) {
                (least, taken[index], graph, roots) = best;
            }
        }
        (least, taken)
    }
}

/// Returns the columns of some parameters of a link.
fn link_columns(
    graph: &mut Graph,
    motions: &LinkMotions,
    (index, link): (usize, &Link),
    own: &[usize],
    route: Route,
) -> Vec<Vec<Edge>> {
    let tree = &motions.tree;
    let wrenches = motions.wrenches(graph, index, link);
    let zero = zero3(graph);
    let (meeting, carried) = match route {
        Route::Wrenches | Route::Mixed => (false, false),
        Route::Twists { meeting, carried } => (meeting, carried),
    };
    let before = tree.links[index].parent.filter(|_| carried);
    let mut path = Path::new(tree, before.unwrap_or(index));
    if meeting {
        path.find_meetings(graph, tree);
    }
    let mut of = |wrench: Wrench| match route {
        Route::Wrenches => by_wrenches(graph, tree, index, wrench),
        Route::Mixed if wrench.force != zero => by_wrenches(graph, tree, index, wrench),
        Route::Mixed => path.by_twists(graph, tree, wrench),
        Route::Twists { .. } if before.is_none() => path.by_twists(graph, tree, wrench),
        Route::Twists { .. } => {
            let link = &tree.links[index];
            let carried = to_parent(graph, link, &wrench);
            let mut forces = path.by_twists(graph, tree, carried);
            link.add_forces(graph, &wrench, &mut forces);
            forces
        }
    };
    own.iter().map(|&k| of(wrenches[k])).collect()
}

/// Links from the root to a given one.
struct Path {
    links: Vec<usize>,
    /// Common point, if any, of the axes of each link's joint and of neighbouring joints: the place on the path of
    /// a link to which the point is fixed, and the point in that link's axes. Filled in by `find_meetings`.
    meeting: Vec<Option<(usize, Vec3)>>,
}

/// Common point of the axes of one joint or several consecutive ones, in the axes of the last one's link.
#[derive(Clone, Copy)]
enum Meeting {
    /// Any point of this axis through the origin.
    On(Vec3),
    /// This point.
    At(Vec3),
}

impl Path {
    fn new(tree: &Tree, link: usize) -> Self {
        let before = |&index: &usize| tree.links[index].parent;
        let mut links: Vec<usize> = std::iter::successors(Some(link), before).collect();
        links.reverse();
        let meeting = vec![None; links.len()];
        Path { links, meeting }
    }

    /// Finds the points where axes meet.
    ///
    /// The search uses a copy of the graph, because a graph computes equal expressions in the way of the first one;
    /// only the points themselves are added to the graph.
    fn find_meetings(&mut self, graph: &mut Graph, tree: &Tree) {
        let mut found = graph.clone();
        let mut first = 0;
        let mut met: Option<Meeting> = None;
        for (place, &index) in self.links.iter().enumerate() {
            let link = &tree.links[index];
            let joined = met.and_then(|met| met.meet(&mut found, link));
            if joined.is_none() {
                first = place;
            }
            met = joined.or_else(|| Meeting::alone(&found, link));
            if let Some(Meeting::At(point)) = met {
                let point = rebuild(&found, graph, &point);
                self.meeting[first..=place].fill(Some((place, [point[0], point[1], point[2]])));
            }
        }
    }

    /// Returns the generalised forces of a wrench on the last link, from its power on the twists of all joints of
    /// the path.
    fn by_twists(&self, graph: &mut Graph, tree: &Tree, wrench: Wrench) -> Vec<Edge> {
        let zero = zero3(graph);
        let mut forces = vec![graph.zero(); tree.armature.len()];
        for (place, &index) in self.links.iter().enumerate() {
            let meeting = self.meeting[place].filter(|_| wrench.force != zero);
            let wrench = match meeting {
                // Torque about the point: torque − s × force.
                Some((at, point)) => {
                    let mut s = point;
                    for &after in &self.links[at + 1..] {
                        let link = &tree.links[after];
                        let seen = sub3(graph, s, link.position);
                        s = link.from_parent_axes(graph, seen);
                    }
                    let lever = cross(graph, s, wrench.force);
                    Wrench {
                        force: zero,
                        torque: sub3(graph, wrench.torque, lever),
                    }
                }
                None => wrench,
            };
            for freedom in &tree.links[index].freedoms {
                let mut twist = freedom.clone();
                for &after in &self.links[place + 1..] {
                    let link = &tree.links[after];
                    if wrench.force != zero {
                        let lever = cross(graph, twist.angular, link.position);
                        let linear = add3(graph, twist.linear, lever);
                        twist.linear = link.from_parent_axes(graph, linear);
                    }
                    twist.angular = link.from_parent_axes(graph, twist.angular);
                }
                twist.add_force(graph, &wrench, &mut forces);
            }
        }
        forces
    }
}

impl Meeting {
    /// Returns the common point of a single joint's axes, which must pass through the origin of its link; `None` if
    /// they do not.
    fn alone(graph: &Graph, link: &TreeLink) -> Option<Self> {
        let zero = zero3(graph);
        if link.freedoms.iter().any(|freedom| freedom.linear != zero) {
            return None;
        }
        match link.freedoms.as_slice() {
            [] => None,
            [freedom] => Some(Meeting::On(freedom.angular)),
            _ => Some(Meeting::At(zero)),
        }
    }

    /// Adds the axes of the next joint; `None` if they miss the common point at some configuration.
    fn meet(self, graph: &mut Graph, link: &TreeLink) -> Option<Self> {
        let zero = zero3(graph);
        let position = link.position;
        let point = match (self, Meeting::alone(graph, link)?) {
            (Meeting::At(point), Meeting::At(_)) => (point == position).then_some(position),
            (Meeting::On(axis), Meeting::At(_)) => {
                (cross(graph, axis, position) == zero).then_some(position)
            }
            (Meeting::At(point), Meeting::On(other)) => {
                let axis = link.to_parent_axes(graph, other);
                let from = sub3(graph, point, position);
                (cross(graph, axis, from) == zero).then_some(point)
            }
            (Meeting::On(axis), Meeting::On(other)) => {
                // Solve λ axis = position + μ other by taking the cross product with `other`.
                let other = link.to_parent_axes(graph, other);
                let normal = cross(graph, axis, other);
                let distance = cross(graph, position, other);
                let (over, under) = (graph.dot(&distance, &normal), graph.dot(&normal, &normal));
                let along = graph.div(over, under)?;
                let point = scale3(graph, along, axis);
                let from = sub3(graph, point, position);
                (cross(graph, other, from) == zero).then_some(point)
            }
        }?;
        let from = sub3(graph, point, position);
        Some(Meeting::At(link.from_parent_axes(graph, from)))
    }
}

/// Returns the generalised forces of a wrench on a link by transforming the wrench from link to link.
fn by_wrenches(graph: &mut Graph, tree: &Tree, link: usize, wrench: Wrench) -> Vec<Edge> {
    let mut forces = vec![graph.zero(); tree.armature.len()];
    let (mut at, mut wrench) = (Some(link), wrench);
    while let Some(index) = at {
        let link = &tree.links[index];
        link.add_forces(graph, &wrench, &mut forces);
        wrench = to_parent(graph, link, &wrench);
        at = link.parent;
    }
    forces
}
