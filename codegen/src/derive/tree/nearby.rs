//! ∂ of inverse dynamics along displacements h and velocities, by composite bodies.
//!
//! A link whose motion varies by (δω, δα, δa), inner joints going on as they do, passes on the
//! torque Θ δα + h × δa + B δω and the force δα × h + m δa + C δω about its origin: Θ, h, m are those of
//! all that hangs on it, and so are B and C, which gather what varies with angular velocity alone.
//! Forces of a joint are covectors on such variations, carried towards the root as wrenches are.
//! After Carpentier and Mansard (2018) and Singh, Russell and Wensing (2022), in axes of links.

use super::inverse::{LinkMotion, Wrench, carried, motions, wrench};
use super::mass::Mass;
use super::{Freedom, Link, Tree};
use crate::algebra::graph::{Edge, Graph};
use crate::algebra::linear::{
    Mat3, Vec3, add3, apply_transposed, apply3, cross, multiply3, scale3, zero3,
};
use crate::model::rotations::hat;

/// ∂f/∂h and ∂f/∂ξ of the force f that ξ̇ needs.
pub struct Slopes {
    /// Columns: displacements.
    pub displacement: Vec<Vec<Edge>>,
    /// Columns: velocities.
    pub velocity: Vec<Vec<Edge>>,
}

/// How a wrench answers δω, besides δα and δa.
#[derive(Clone, Copy)]
struct Response {
    torque: Mat3,
    force: Mat3,
}

/// A variation of a link's motion.
#[derive(Clone, Copy)]
struct Variation {
    omega: Vec3,
    alpha: Vec3,
    a: Vec3,
}

/// The slopes; `None` where a joint's freedoms vary with x or are not plain velocities.
pub fn slopes(
    graph: &mut Graph,
    tree: &Tree,
    xi: &[Edge],
    xi_dot: &[Edge],
    gravity: Vec3,
) -> Option<Slopes> {
    let n = xi.len();
    let steady = |link: &Link| {
        let entries = link
            .freedoms
            .iter()
            .flat_map(|f| f.angular.into_iter().chain(f.linear));
        entries.into_iter().all(|entry| graph.is_free(entry.node()))
    };
    if !tree.is_plain(graph, n, &[]) || !tree.links.iter().all(steady) {
        return None;
    }
    let motions = motions(graph, tree, xi, xi_dot, gravity);
    let mut masses: Vec<Mass> = tree.links.iter().map(|link| link.mass).collect();
    let mut totals = Vec::new();
    let mut answers = Vec::new();
    for (link, motion) in tree.links.iter().zip(&motions) {
        totals.push(wrench(graph, &link.mass, motion));
        answers.push(Response::own(graph, &link.mass, motion.omega));
    }
    for (index, link) in tree.links.iter().enumerate().rev() {
        if let Some(parent) = link.parent {
            let before = motions[parent].omega;
            let moved =
                answers[index].carried(graph, link, &masses[index], &motions[index], before);
            answers[parent] = answers[parent].plus(graph, &moved);
            let mass = masses[index].carried(graph, link);
            masses[parent] = masses[parent].plus(graph, &mass);
            let total = carried(graph, link, &totals[index]);
            totals[parent] = totals[parent].plus(graph, &total);
        }
    }
    let mut slopes = Slopes {
        displacement: vec![vec![graph.zero(); n]; n],
        velocity: vec![vec![graph.zero(); n]; n],
    };
    // Variations of a joint's own link, by displacement and by velocity.
    let varied: Vec<Vec<(Variation, Variation)>> = tree
        .links
        .iter()
        .zip(&motions)
        .map(|(link, motion)| {
            let both = link.freedoms.iter();
            both.map(|f| (displaced(graph, f, motion), faster(graph, f, motion)))
                .collect()
        })
        .collect();
    for (index, link) in tree.links.iter().enumerate() {
        let (mass, answer) = (masses[index], answers[index]);
        for (place, freedom) in link.freedoms.iter().enumerate() {
            let (i, _) = *freedom.rate.first()?;
            // The force of this joint, by variations of its link and of those before.
            let (force, torque) = mass.wrench(graph, freedom.angular, freedom.linear);
            let turned = apply_transposed(graph, &answer.torque, freedom.angular);
            let pushed = apply_transposed(graph, &answer.force, freedom.linear);
            let mut covector = Variation {
                omega: add3(graph, turned, pushed),
                alpha: torque,
                a: force,
            };
            let mut here = index;
            loop {
                for (other, (by_place, by_rate)) in
                    tree.links[here].freedoms.iter().zip(&varied[here])
                {
                    let (j, _) = *other.rate.first()?;
                    slopes.displacement[i][j] = covector.on(graph, by_place);
                    slopes.velocity[i][j] = covector.on(graph, by_rate);
                }
                let Some(parent) = tree.links[here].parent else {
                    break;
                };
                let before = motions[parent].omega;
                covector =
                    covector.carried(graph, &tree.links[here], motions[here].relative, before);
                here = parent;
            }
            // The wrench that a variation of this joint passes on to those before.
            let (by_place, by_rate) = varied[index][place];
            let mut wrenches = [by_place, by_rate].map(|v| answer.wrench(graph, &mass, &v));
            let total = totals[index];
            wrenches[0] = follow(graph, &wrenches[0], freedom, &total);
            let mut here = index;
            while let Some(parent) = tree.links[here].parent {
                wrenches = wrenches.map(|wrench| carried(graph, &tree.links[here], &wrench));
                for other in &tree.links[parent].freedoms {
                    let (j, _) = *other.rate.first()?;
                    slopes.displacement[j][i] = other.felt(graph, &wrenches[0]);
                    slopes.velocity[j][i] = other.felt(graph, &wrenches[1]);
                }
                here = parent;
            }
        }
    }
    Some(slopes)
}

/// The wrench turns and moves along with the joint: e × f, e × n + l × f.
fn follow(graph: &mut Graph, change: &Wrench, freedom: &Freedom, total: &Wrench) -> Wrench {
    let force = cross(graph, freedom.angular, total.force);
    let torque = cross(graph, freedom.angular, total.torque);
    let lever = cross(graph, freedom.linear, total.force);
    let turned = Wrench {
        force,
        torque: add3(graph, torque, lever),
    };
    change.plus(graph, &turned)
}

/// What the link before does, as seen from a link that is displaced.
fn displaced(graph: &mut Graph, freedom: &Freedom, motion: &LinkMotion) -> Variation {
    let [omega, alpha, a] = motion.carried.map(|v| cross(graph, v, freedom.angular));
    let gyro = cross(graph, omega, motion.relative.0);
    let alpha = add3(graph, alpha, gyro);
    // Its origin moves by l in the field of accelerations of the link before.
    let [before, growth, _] = motion.carried;
    let swing = cross(graph, growth, freedom.linear);
    let inner = cross(graph, before, freedom.linear);
    let outer = cross(graph, before, inner);
    let coriolis = cross(graph, omega, motion.relative.1);
    let twice = add3(graph, coriolis, coriolis);
    let a = [swing, outer, twice]
        .into_iter()
        .fold(a, |sum, term| add3(graph, sum, term));
    Variation { omega, alpha, a }
}

/// A faster joint.
fn faster(graph: &mut Graph, freedom: &Freedom, motion: &LinkMotion) -> Variation {
    let before = motion.carried[0];
    let twice = add3(graph, before, motion.omega);
    let (a, b) = (
        cross(graph, freedom.angular, motion.relative.1),
        cross(graph, twice, freedom.linear),
    );
    Variation {
        omega: freedom.angular,
        alpha: cross(graph, before, freedom.angular),
        a: add3(graph, a, b),
    }
}

impl Variation {
    /// The pairing of a covector with a variation.
    fn on(&self, graph: &mut Graph, variation: &Variation) -> Edge {
        let terms = [
            graph.dot(&self.omega, &variation.omega),
            graph.dot(&self.alpha, &variation.alpha),
            graph.dot(&self.a, &variation.a),
        ];
        graph.sum(&terms)
    }

    /// A covector on variations of the link before.
    fn carried(
        &self,
        graph: &mut Graph,
        link: &Link,
        relative: (Vec3, Vec3),
        before: Vec3,
    ) -> Self {
        let gyro = cross(graph, relative.0, self.alpha);
        let coriolis = cross(graph, relative.1, self.a);
        let twice = add3(graph, coriolis, coriolis);
        let omega = add3(graph, self.omega, gyro);
        let omega = add3(graph, omega, twice);
        let omega = link.out(graph, omega);
        let a = link.out(graph, self.a);
        let alpha = link.out(graph, self.alpha);
        let lever = cross(graph, link.position, a);
        let speed = cross(graph, before, link.position);
        let first = cross(graph, speed, a);
        let inner = cross(graph, a, before);
        let second = cross(graph, link.position, inner);
        let centripetal = add3(graph, first, second);
        Variation {
            omega: add3(graph, omega, centripetal),
            alpha: add3(graph, alpha, lever),
            a,
        }
    }
}

fn plus(graph: &mut Graph, a: &Mat3, b: &Mat3) -> Mat3 {
    std::array::from_fn(|i| add3(graph, a[i], b[i]))
}

impl Response {
    /// Of a link alone: C = ω hᵀ + (ω·h) I − 2 h ωᵀ, B δω = δω × Θ ω + ω × Θ δω.
    fn own(graph: &mut Graph, mass: &Mass, omega: Vec3) -> Self {
        let h = mass.first;
        let along = graph.dot(&omega, &h);
        let force = std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                let (a, b) = (graph.mul(omega[i], h[k]), graph.mul(h[i], omega[k]));
                let twice = graph.add(b, b);
                let entry = graph.sub(a, twice);
                if i == k {
                    graph.add(entry, along)
                } else {
                    entry
                }
            })
        });
        let momentum = mass.spun(graph, omega);
        let spin = hat(graph, omega);
        let theta = mass.inertia(graph);
        let turned = multiply3(graph, &spin, &theta);
        let back = hat(graph, momentum);
        let torque =
            std::array::from_fn(|i| std::array::from_fn(|k| graph.sub(turned[i][k], back[i][k])));
        Response { torque, force }
    }

    fn plus(&self, graph: &mut Graph, other: &Response) -> Self {
        Response {
            torque: plus(graph, &self.torque, &other.torque),
            force: plus(graph, &self.force, &other.force),
        }
    }

    /// The wrench that answers a variation.
    fn wrench(&self, graph: &mut Graph, mass: &Mass, by: &Variation) -> Wrench {
        let (force, torque) = mass.wrench(graph, by.alpha, by.a);
        let (push, turn) = (
            apply3(graph, &self.force, by.omega),
            apply3(graph, &self.torque, by.omega),
        );
        let whole = Wrench { force, torque };
        let own = Wrench {
            force: push,
            torque: turn,
        };
        whole.plus(graph, &own)
    }

    /// Of the link before, whose δω is also a δα and δa of this one.
    fn carried(
        &self,
        graph: &mut Graph,
        link: &Link,
        mass: &Mass,
        motion: &LinkMotion,
        before: Vec3,
    ) -> Self {
        // δα = δω × ω_rel, δa = 2 δω × v_rel.
        let (spin, speed) = motion.relative;
        let mut columns = [Wrench {
            force: zero3(graph),
            torque: zero3(graph),
        }; 3];
        for (k, column) in columns.iter_mut().enumerate() {
            let mut unit = zero3(graph);
            unit[k] = graph.one();
            let alpha = cross(graph, unit, spin);
            let coriolis = cross(graph, unit, speed);
            let a = add3(graph, coriolis, coriolis);
            (column.force, column.torque) = mass.wrench(graph, alpha, a);
        }
        let grown = |graph: &mut Graph, own: &Mat3, pick: fn(&Wrench) -> Vec3| -> Mat3 {
            std::array::from_fn(|i| {
                std::array::from_fn(|k| graph.add(own[i][k], pick(&columns[k])[i]))
            })
        };
        let mut force = grown(graph, &self.force, |column| column.force);
        let mut torque = grown(graph, &self.torque, |column| column.torque);
        let mut first = mass.first;
        for turn in link.turns.iter().rev() {
            force = turn.general(graph, &force);
            torque = turn.general(graph, &torque);
            first = turn.out(graph, first);
        }
        // δa = (δω × (ω × p) + ω × (δω × p)) at the joint, p its place.
        let p = link.position;
        let speed = cross(graph, before, p);
        let (whirl, arm) = (hat(graph, speed), hat(graph, p));
        let spin = hat(graph, before);
        let product = multiply3(graph, &spin, &arm);
        let swing: Mat3 = std::array::from_fn(|i| {
            std::array::from_fn(|k| -graph.add(whirl[i][k], product[i][k]))
        });
        let push = swing.map(|row| scale3(graph, mass.mass, row));
        let lever = multiply3(graph, &hat(graph, first), &swing);
        let force = plus(graph, &force, &push);
        let torque = plus(graph, &torque, &lever);
        let levered = multiply3(graph, &arm, &force);
        Response {
            torque: plus(graph, &torque, &levered),
            force,
        }
    }
}
