//! Warnings about links without mass and about inertias that are not physical.

use crate::plan::{Mobility, Plan};
use crate::problem::Problems;
use crate::robot::{Inertial, Robot};
use crate::tree::Tree;

/// Relative tolerance of principal moments, as a fraction of the largest: Viète's formula below loses half of its
/// digits where moments coincide, and inertias are printed with no more digits than that.
const ROUNDING: f64 = 1e-6;

/// Radius of gyration (m) above which an inertia is suspect.
const LARGE: f64 = 10.0;

/// Warns of moving links without mass and of inertias that are not physical. If no moving link has mass, that is the
/// only warning.
pub(crate) fn check(
    robot: &Robot,
    tree: &Tree,
    plan: &Plan,
    floating: bool,
    warnings: &mut Problems<'_>,
) {
    // Whether each link has mass; the loop below adds what it carries. Children come after their parents.
    let mut carries: Vec<bool> = robot
        .links
        .iter()
        .map(|link| {
            link.inertial
                .as_ref()
                .is_some_and(|inertial| !inertial.is_zero())
        })
        .collect();
    let has_mass = carries.clone();
    let mut moves = vec![floating; robot.links.len()];
    for edge in &tree.joints {
        let still = matches!(
            plan.motions[edge.joint],
            Mobility::Fixed | Mobility::Locked(_)
        );
        moves[edge.child] = moves[edge.parent] || !still;
    }
    let mut masses = moves.iter().zip(&has_mass);
    if moves.contains(&true) && !masses.any(|(&moves, &has_mass)| moves && has_mass) {
        warnings.push(
            &robot.links[tree.root].name.range,
            "no moving link of the robot has mass: there are poses, Jacobians and rates, but no mass matrix and no accelerations",
            "give the links an `<inertial>`, unless only kinematics is needed",
        );
        return;
    }
    for edge in tree.joints.iter().rev() {
        carries[edge.parent] |= carries[edge.child];
        let joint = &robot.joints[edge.joint];
        if !carries[edge.child] && plan.motions[edge.joint] == Mobility::Free {
            let link = &robot.links[edge.child].name;
            let name = &joint.name.name;
            let lock = match joint.kind.is_single() {
                true => format!(", lock the joint with `--lock {name}=0`"),
                false => String::new(),
            };
            warnings.push(
                &link.range,
                format!(
                    "`{name}` moves `{}`, but neither it nor what it carries has mass: the mass matrix is singular, and there are no accelerations",
                    link.name
                ),
                format!("give it an `<inertial>`{lock}, or make the joint fixed"),
            );
        }
    }
    bare(robot, tree, plan, floating, &carries, warnings);
    for (link, moves) in robot.links.iter().zip(moves) {
        if let Some(inertial) = link
            .inertial
            .as_ref()
            .filter(|inertial| moves && !inertial.is_zero())
        {
            physical(&link.name.name, inertial, warnings);
        }
    }
}

/// Warns of bodies that move by a joint of their own, carry mass and have no `<inertial>`. Links that are joined
/// rigidly count as one body.
fn bare(
    robot: &Robot,
    tree: &Tree,
    plan: &Plan,
    floating: bool,
    carries: &[bool],
    warnings: &mut Problems<'_>,
) {
    let mut given: Vec<bool> = robot
        .links
        .iter()
        .map(|link| link.inertial.is_some())
        .collect();
    let mut own = vec![floating; robot.links.len()];
    for edge in tree.joints.iter().rev() {
        let still = matches!(
            plan.motions[edge.joint],
            Mobility::Fixed | Mobility::Locked(_)
        );
        own[edge.child] = !still;
        given[edge.parent] |= still && given[edge.child];
    }
    for (index, link) in robot.links.iter().enumerate() {
        let moves = own[index] && (index != tree.root || floating);
        // If it carries no mass either, there has been a warning already.
        if moves && !given[index] && carries[index] {
            let name = &link.name.name;
            warnings.push(
                &link.name.range,
                format!("`{name}` moves but has no `<inertial>`: it is treated as massless"),
                "this is right for a frame between two joints; otherwise give it an `<inertial>`",
            );
        }
    }
}

/// Warns of an inertia that no body has: principal moments are not negative, and none exceeds the sum of the two
/// others.
fn physical(name: &str, inertial: &Inertial, warnings: &mut Problems<'_>) {
    if inertial.mass.is_zero() {
        let help = "a body with inertia needs mass: check the units";
        let message = format!("`{name}` has inertia but no mass");
        warnings.push(&inertial.range, message, help);
    }
    let entries = inertial.inertia.each_ref().map(|entry| entry.value);
    if entries.iter().all(|&entry| entry == 0.0) {
        let help = "it is treated as a particle at its centre of mass";
        let message = format!("`{name}` has mass but no inertia");
        warnings.push(&inertial.inertia_range, message, help);
        return;
    }
    let [least, middle, most] = moments(entries);
    let (mass, radius) = (inertial.mass.value, (most / inertial.mass.value).sqrt());
    if mass > 0.0 && radius > LARGE {
        warnings.push(
            &inertial.inertia_range,
            format!("the inertia of `{name}` is that of {mass} kg at a distance of {radius:.0} m"),
            "inertias are in kg m²",
        );
    }
    let rounding = ROUNDING * most.abs().max(least.abs());
    if least < -rounding {
        warnings.push(
            &inertial.inertia_range,
            format!("the inertia of `{name}` is not positive: a principal moment is {least:.3e}"),
            "check its products of inertia and their signs",
        );
    } else if most > least + middle + rounding {
        warnings.push(
            &inertial.inertia_range,
            format!(
                "the inertia of `{name}` is not that of a body: its principal moments are {least:.3e}, {middle:.3e}, {most:.3e}, but no moment may be larger than the sum of the two others"
            ),
            "check its entries; the axes may be exchanged",
        );
    }
}

/// Returns the principal moments in ascending order: roots of the characteristic polynomial by Viète's trigonometric
/// formula.
fn moments([xx, xy, xz, yy, yz, zz]: [f64; 6]) -> [f64; 3] {
    let mean = (xx + yy + zz) / 3.0;
    let (a, b, c) = (xx - mean, yy - mean, zz - mean);
    let off = xy * xy + xz * xz + yz * yz;
    let spread = ((a * a + b * b + c * c + 2.0 * off) / 6.0).sqrt();
    if spread == 0.0 {
        return [mean; 3];
    }
    let determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
    let cosine = (determinant / (2.0 * spread * spread * spread)).clamp(-1.0, 1.0);
    let angle = cosine.acos() / 3.0;
    let third = std::f64::consts::TAU / 3.0;
    let most = mean + 2.0 * spread * angle.cos();
    let least = mean + 2.0 * spread * (angle + third).cos();
    [least, 3.0 * mean - most - least, most]
}

#[cfg(test)]
mod tests {
    use super::moments;

    /// diag(1, 2, 3), turned by 0.3 about z and then by 0.4 about x.
    #[test]
    fn principal_moments_do_not_know_axes() {
        let (c, s) = (0.3_f64.cos(), 0.3_f64.sin());
        let (d, t) = (0.4_f64.cos(), 0.4_f64.sin());
        let rows = [[c, -s, 0.0], [d * s, d * c, -t], [t * s, t * c, d]];
        let entry = |i: usize, j: usize| -> f64 {
            (0..3)
                .map(|k| rows[i][k] * (k as f64 + 1.0) * rows[j][k])
                .sum()
        };
        let found = moments([
            entry(0, 0),
            entry(0, 1),
            entry(0, 2),
            entry(1, 1),
            entry(1, 2),
            entry(2, 2),
        ]);
        for (moment, expected) in found.into_iter().zip([1.0, 2.0, 3.0]) {
            // A few roundings of numbers near 1.
            assert!((moment - expected).abs() < 1e-14, "{found:?}");
        }
    }
}
