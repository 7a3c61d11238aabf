//! Derivatives of inverse dynamics along displacements h and velocities, by composite bodies.
//!
//! Let the motion of a link vary by (δω, δα, δa), while the joints of its descendants move as
//! before. Its subtree then requires the additional torque Θ δα + h × δa + B δω and the additional
//! force
//! δα × h + m δa + C δω about the origin of the link.
//! Θ, h and m are those of the subtree. B and C follow from them as for a single body, and from the
//! motion within the subtree (P and D below). Joint forces are covectors on such variations, which
//! are transformed towards the root as wrenches are. After Carpentier and Mansard (2018) and Singh,
//! Russell and Wensing (2022), in axes of links.

use super::inverse::{LinkMotion, motions, to_parent, wrench};
use super::link::{Freedom, Link, Tree};
use super::mass::LinkInertia;
use super::wrench::Wrench;
use hamel_algebra::graph::{Edge, Graph, Label};
use hamel_algebra::linear::{Mat3, Vec3, add3, apply_transposed, apply3, cross, scale3, zero3};
use hamel_program::provenance::Quantity;

/// Derivatives ∂f/∂h and ∂f/∂ξ of the force f that ξ̇ requires.
pub struct InverseDynamicsDerivatives {
    /// ∂f/∂h; columns belong to displacements.
    pub displacement: Vec<Vec<Edge>>,
    /// ∂f/∂ξ; columns belong to velocities.
    pub velocity: Vec<Vec<Edge>>,
}

/// Motion of a subtree relative to its link: P = 2 ∫ v dm and D = 2 ∫ r vᵀ dm, where v is the
/// velocity relative to the link.
///
/// A variation δω changes the acceleration of every point by 2 δω × v.
#[derive(Clone, Copy)]
struct RelativeMomentum {
    first: Vec3,
    second: Mat3,
}

/// Variation (δω, δα, δa) of a link's motion, or a covector on such variations.
#[derive(Clone, Copy)]
struct Variation {
    omega: Vec3,
    alpha: Vec3,
    a: Vec3,
}

/// Computes ∂f/∂h and ∂f/∂ξ of the force f that ξ̇ requires, at constant ξ̇; `None` if a joint's freedoms vary with x
/// or their rates are not plain velocities.
pub fn inverse_dynamics_derivatives(
    graph: &mut Graph,
    tree: &Tree,
    xi: &[Edge],
    xi_dot: &[Edge],
    gravity: Vec3,
) -> Option<InverseDynamicsDerivatives> {
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
    let mut masses: Vec<LinkInertia> = tree.links.iter().map(|link| link.mass).collect();
    let mut totals = Vec::new();
    let mut relative_momenta = vec![RelativeMomentum::none(graph); tree.links.len()];
    for (link, motion) in tree.links.iter().zip(&motions) {
        totals.push(wrench(graph, &link.mass, motion));
    }
    for (index, link) in tree.links.iter().enumerate().rev() {
        if let Some(parent) = link.parent {
            let moved =
                relative_momenta[index].to_parent(graph, link, &masses[index], &motions[index]);
            relative_momenta[parent] = relative_momenta[parent].plus(graph, &moved);
            let mass = masses[index].to_parent(graph, link);
            masses[parent] = masses[parent].plus(graph, &mass);
            let total = to_parent(graph, link, &totals[index]);
            totals[parent] = totals[parent].plus(graph, &total);
        }
        let of = |quantity: Quantity| quantity.of(link.frame);
        masses[index].label(graph, of(Quantity::CompositeInertia));
        totals[index].label(graph, of(Quantity::JointWrench));
        let relative = &relative_momenta[index];
        graph.label(&relative.first, of(Quantity::RelativeMomentum));
        graph.label(&relative.second.concat(), of(Quantity::RelativeMomentum));
    }
    let mut slopes = InverseDynamicsDerivatives {
        displacement: vec![vec![graph.zero(); n]; n],
        velocity: vec![vec![graph.zero(); n]; n],
    };
    // Variations of a joint's own link with its displacements and with its velocities.
    let varied: Vec<Vec<(Variation, Variation)>> = tree
        .links
        .iter()
        .zip(&motions)
        .map(|(link, motion)| {
            let both = link.freedoms.iter();
            both.map(|f| {
                let both = (
                    displacement_variation(graph, f, motion),
                    velocity_variation(graph, f, motion),
                );
                for variation in [both.0, both.1] {
                    variation.label(graph, Quantity::LinkVariation.of(link.frame));
                }
                both
            })
            .collect()
        })
        .collect();
    for (index, link) in tree.links.iter().enumerate() {
        let composite = Composite {
            mass: masses[index],
            relative_momentum: relative_momenta[index],
            omega: motions[index].omega,
        };
        for (place, freedom) in link.freedoms.iter().enumerate() {
            let (i, _) = *freedom.rate.first()?;
            // Force of this joint as a covector on variations of its link and of its ancestors.
            let mut covector = composite.force(graph, freedom);
            covector.label(graph, Quantity::JointForceVariation.of(link.frame));
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
                    covector.to_parent(graph, &tree.links[here], motions[here].relative, before);
                covector.label(graph, Quantity::JointForceVariation.of(link.frame));
                here = parent;
            }
            // Wrench that a variation of this joint passes on to its ancestors.
            let (by_place, by_rate) = varied[index][place];
            let mut wrenches = [by_place, by_rate].map(|v| composite.wrench(graph, &v));
            let total = totals[index];
            wrenches[0] = transport_change(graph, &wrenches[0], freedom, &total);
            for wrench in &wrenches {
                wrench.label(graph, Quantity::WrenchVariation.of(link.frame));
            }
            let mut here = index;
            while let Some(parent) = tree.links[here].parent {
                wrenches = wrenches.map(|wrench| to_parent(graph, &tree.links[here], &wrench));
                for wrench in &wrenches {
                    wrench.label(graph, Quantity::WrenchVariation.of(link.frame));
                }
                for other in &tree.links[parent].freedoms {
                    let (j, _) = *other.rate.first()?;
                    slopes.displacement[j][i] = other.force_of(graph, &wrenches[0]);
                    slopes.velocity[j][i] = other.force_of(graph, &wrenches[1]);
                }
                here = parent;
            }
        }
    }
    Some(slopes)
}

/// Adds the change of the wrench that rotates and moves along with the joint: e × f, e × n + l × f.
fn transport_change(
    graph: &mut Graph,
    change: &Wrench,
    freedom: &Freedom,
    total: &Wrench,
) -> Wrench {
    let force = cross(graph, freedom.angular, total.force);
    let torque = cross(graph, freedom.angular, total.torque);
    let lever = cross(graph, freedom.linear, total.force);
    let turned = Wrench {
        force,
        torque: add3(graph, torque, lever),
    };
    change.plus(graph, &turned)
}

/// Variation of a link's motion with a displacement of its joint: the motion of the parent link as
/// seen from the displaced link.
fn displacement_variation(graph: &mut Graph, freedom: &Freedom, motion: &LinkMotion) -> Variation {
    let [omega, alpha, a] = motion.from_parent.map(|v| cross(graph, v, freedom.angular));
    let gyro = cross(graph, omega, motion.relative.0);
    let alpha = add3(graph, alpha, gyro);
    // The origin moves by l in the acceleration field of the parent link.
    let [before, turning, _] = motion.from_parent;
    let tangential = cross(graph, turning, freedom.linear);
    let inner = cross(graph, before, freedom.linear);
    let outer = cross(graph, before, inner);
    let coriolis = cross(graph, omega, motion.relative.1);
    let twice = add3(graph, coriolis, coriolis);
    let a = [tangential, outer, twice]
        .into_iter()
        .fold(a, |sum, term| add3(graph, sum, term));
    Variation { omega, alpha, a }
}

/// Variation of a link's motion with the velocity of its joint.
fn velocity_variation(graph: &mut Graph, freedom: &Freedom, motion: &LinkMotion) -> Variation {
    let before = motion.from_parent[0];
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
    fn label(&self, graph: &mut Graph, label: Option<Label>) {
        for part in [self.omega, self.alpha, self.a] {
            graph.label(&part, label);
        }
    }

    /// Returns the pairing of a covector (`self`) with a variation.
    fn on(&self, graph: &mut Graph, variation: &Variation) -> Edge {
        let terms = [
            graph.dot(&self.omega, &variation.omega),
            graph.dot(&self.alpha, &variation.alpha),
            graph.dot(&self.a, &variation.a),
        ];
        graph.sum(&terms)
    }

    /// Transforms a covector to variations of the parent link's motion.
    fn to_parent(
        self,
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
        let omega = link.to_parent_axes(graph, omega);
        let a = link.to_parent_axes(graph, self.a);
        let alpha = link.to_parent_axes(graph, self.alpha);
        let lever = cross(graph, link.position, a);
        let centripetal = centripetal(graph, before, link.position);
        let centripetal = apply3(graph, &centripetal, a);
        Variation {
            omega: add3(graph, omega, centripetal),
            alpha: add3(graph, alpha, lever),
            a,
        }
    }
}

/// Returns K = p ωᵀ − 2 ω pᵀ + (p·ω) I, for which a · (δω × (ω × p) + ω × (δω × p)) = δω · K a.
fn centripetal(graph: &mut Graph, omega: Vec3, p: Vec3) -> Mat3 {
    std::array::from_fn(|i| {
        std::array::from_fn(|k| {
            if i == k {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let (a, b) = (graph.mul(p[j], omega[j]), graph.mul(p[k], omega[k]));
                return graph.add(a, b);
            }
            let (a, b) = (graph.mul(p[i], omega[k]), graph.mul(omega[i], p[k]));
            let twice = graph.add(b, b);
            graph.sub(a, twice)
        })
    })
}

/// Subtree of a joint as one rigid body, in addition to the motion of its links relative to it.
struct Composite {
    mass: LinkInertia,
    relative_momentum: RelativeMomentum,
    omega: Vec3,
}

impl Composite {
    /// Returns the force of a joint as a covector on variations of its link.
    fn force(&self, graph: &mut Graph, freedom: &Freedom) -> Variation {
        let (e, l, omega) = (freedom.angular, freedom.linear, self.omega);
        let (force, torque) = self.mass.wrench(graph, e, l);
        // e × S ω + S (ω × e) + tr D e − D e.
        let spun = apply3(graph, &self.mass.second, omega);
        let first = cross(graph, e, spun);
        let across = cross(graph, omega, e);
        let second = apply3(graph, &self.mass.second, across);
        let coupled = self.relative_momentum.turned(graph, e, apply3);
        let turned = [second, coupled];
        let turned = turned
            .into_iter()
            .fold(first, |sum, term| add3(graph, sum, term));
        // (ω·l) h + (ω·h) l − 2 (h·l) ω + P × l.
        let h = self.mass.first;
        let coriolis = cross(graph, self.relative_momentum.first, l);
        let pushed = centripetal_force(graph, h, omega, l);
        let pushed = add3(graph, pushed, coriolis);
        Variation {
            omega: add3(graph, turned, pushed),
            alpha: torque,
            a: force,
        }
    }

    /// Returns the wrench that a variation requires.
    fn wrench(&self, graph: &mut Graph, by: &Variation) -> Wrench {
        let (mass, omega) = (&self.mass, self.omega);
        let (force, torque) = mass.wrench(graph, by.alpha, by.a);
        // ω (h·δω) + (ω·h) δω − 2 h (ω·δω) + δω × P.
        let coriolis = cross(graph, by.omega, self.relative_momentum.first);
        let centripetal = centripetal_force(graph, omega, mass.first, by.omega);
        let push = add3(graph, centripetal, coriolis);
        // S ω × δω − ω × S δω + tr D δω − Dᵀ δω.
        let spun = apply3(graph, &mass.second, omega);
        let first = cross(graph, spun, by.omega);
        let varied = apply3(graph, &mass.second, by.omega);
        let second = cross(graph, varied, omega);
        let coupled = self
            .relative_momentum
            .turned(graph, by.omega, apply_transposed);
        let turn = [second, coupled];
        let turn = turn
            .into_iter()
            .fold(first, |sum, term| add3(graph, sum, term));
        Wrench {
            force: add3(graph, force, push),
            torque: add3(graph, torque, turn),
        }
    }
}

/// Returns a (b·c) + (a·b) c − 2 b (a·c).
fn centripetal_force(graph: &mut Graph, a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let (bc, ab, ac) = (graph.dot(&b, &c), graph.dot(&a, &b), graph.dot(&a, &c));
    let twice = -graph.add(ac, ac);
    let terms = [
        scale3(graph, bc, a),
        scale3(graph, ab, c),
        scale3(graph, twice, b),
    ];
    let [first, rest @ ..] = terms;
    rest.into_iter()
        .fold(first, |sum, term| add3(graph, sum, term))
}

impl RelativeMomentum {
    fn none(graph: &Graph) -> Self {
        RelativeMomentum {
            first: zero3(graph),
            second: [zero3(graph); 3],
        }
    }

    fn plus(&self, graph: &mut Graph, other: &RelativeMomentum) -> Self {
        RelativeMomentum {
            first: add3(graph, self.first, other.first),
            second: std::array::from_fn(|i| add3(graph, self.second[i], other.second[i])),
        }
    }

    /// Returns (tr D) v − D v, or the same with Dᵀ.
    fn turned(
        &self,
        graph: &mut Graph,
        v: Vec3,
        apply: fn(&mut Graph, &Mat3, Vec3) -> Vec3,
    ) -> Vec3 {
        let mut rest = self.second;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            rest[i][i] = -graph.add(self.second[j][j], self.second[k][k]);
        }
        apply(graph, &rest, v).map(|entry| -entry)
    }

    /// Transforms to the motion relative to the parent, which includes the motion of the link
    /// itself.
    fn to_parent(
        self,
        graph: &mut Graph,
        link: &Link,
        mass: &LinkInertia,
        motion: &LinkMotion,
    ) -> Self {
        let (spin, speed) = motion.relative;
        let (spin, speed) = (add3(graph, spin, spin), add3(graph, speed, speed));
        let turning = cross(graph, spin, mass.first);
        let drift = scale3(graph, mass.mass, speed);
        let relative = add3(graph, turning, drift);
        let mut first = add3(graph, self.first, relative);
        let mut second: Mat3 = std::array::from_fn(|i| {
            let turning = cross(graph, spin, mass.second[i]);
            let drift = scale3(graph, mass.first[i], speed);
            let relative = add3(graph, turning, drift);
            add3(graph, self.second[i], relative)
        });
        for turn in link.turns.iter().rev() {
            first = turn.rotate(graph, first);
            second = turn.rotate_matrix(graph, &second);
        }
        for (row, &p) in second.iter_mut().zip(&link.position) {
            let far = scale3(graph, p, first);
            *row = add3(graph, *row, far);
        }
        RelativeMomentum { first, second }
    }
}
