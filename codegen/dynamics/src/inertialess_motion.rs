//! Advice on models with a singular M: finds the motion of a joint that has no inertia, such as
//! the spin of a slender rod between two ball joints about its own axis.

use hamel_language::model::Model;
use hamel_language::model::joints::Joint;
use hamel_language::syntax::ast::JointKind;

/// Relative size below which an entry of a direction v, or of M v, counts as 0.
const NEGLIGIBLE_ENTRY: f64 = 1e-6;

/// Suggests how to change a description whose mass matrix M is singular because a single joint can move without
/// resistance; `None` if there is another reason.
///
/// `mass` holds the numbers of M by rows, and `pivot` is the index of the first velocity whose pivot in the elimination of M is
/// zero. The result is `None` if a motion without resistance takes several joints, or if these numbers do not determine it.
pub fn advise_on_singular_mass(model: &Model, mass: &[f64], pivot: usize) -> Option<String> {
    let direction = kernel(mass, model.n(), pivot)?;
    let moving = |place: &usize| direction[*place] != 0.0;
    let moved: Vec<usize> = (0..direction.len()).filter(moving).collect();
    let (joint, places) = model.joints.iter().find_map(|joint| {
        let places = velocities_of_joint(model, joint);
        let alone = moved.iter().all(|place| places.contains(place));
        alone.then_some((joint, places))
    })?;
    let Joint { name, frame, .. } = joint;
    let along: Vec<f64> = places.iter().map(|&place| direction[place]).collect();
    Some(match (&joint.kind, along.as_slice()) {
        (JointKind::Spherical | JointKind::SphericalS3, &[x, y, z]) => {
            let (spin, across) = axes([x, y, z]);
            format!(
                "nothing resists the spin of `{frame}` about its axis {}, which `{name}` allows: write `joint {name}: universal {}, {}` in place of `spherical`, to leave this spin out, or give `{frame}` inertia about that axis",
                format_axis(spin),
                format_axis(across[0]),
                format_axis(across[1])
            )
        }
        _ => format!(
            "nothing resists the motion of the joint `{name}`: what it moves needs mass, inertia about its axis or an armature; `generate inverse_dynamics, mass_matrix;` and similar selections do not need the inverse"
        ),
    })
}

/// Returns the indices of the velocities of a joint; empty if constraints have removed some of
/// them.
fn velocities_of_joint(model: &Model, joint: &Joint) -> Vec<usize> {
    let mut places = Vec::new();
    for name in &joint.velocities {
        match model.velocities.iter().find(|group| group.name == *name) {
            Some(group) => places.extend(group.offset..group.offset + group.len),
            None => return Vec::new(),
        }
    }
    places
}

/// Returns v with M v = 0, where the entries after `pivot` are zero, scaled to a largest entry of
/// 1.
///
/// The pivot at index `pivot` vanishes, and the leading block of M before it is regular.
fn kernel(mass: &[f64], n: usize, pivot: usize) -> Option<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = (0..pivot)
        .map(|i| {
            let row = (0..pivot).map(|j| mass[i * n + j]);
            row.chain([-mass[i * n + pivot]]).collect()
        })
        .collect();
    for c in 0..pivot {
        let best = (c..pivot).max_by(|&a, &b| rows[a][c].abs().total_cmp(&rows[b][c].abs()))?;
        rows.swap(c, best);
        let row = rows[c].clone();
        if row[c] == 0.0 {
            return None;
        }
        for (r, other) in rows.iter_mut().enumerate() {
            let factor = if r == c { 0.0 } else { other[c] / row[c] };
            let pairs = other.iter_mut().zip(&row);
            pairs.for_each(|(entry, by)| *entry -= factor * by);
        }
    }
    let mut v = vec![0.0; n];
    for (i, row) in rows.iter().enumerate() {
        v[i] = row[pivot] / row[i];
    }
    v[pivot] = 1.0;
    let largest = v.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
    for entry in &mut v {
        *entry /= largest;
        if entry.abs() < NEGLIGIBLE_ENTRY {
            *entry = 0.0;
        }
    }
    let scale = mass
        .iter()
        .fold(0.0_f64, |most, entry| most.max(entry.abs()));
    let rests = mass.chunks(n).all(|row| {
        let sum: f64 = row.iter().zip(&v).map(|(a, b)| a * b).sum();
        sum.abs() <= NEGLIGIBLE_ENTRY * scale
    });
    rests.then_some(v)
}

/// Returns the axis of a direction, with its largest entry positive, and two axes perpendicular to
/// it.
fn axes(direction: [f64; 3]) -> ([f64; 3], [[f64; 3]; 2]) {
    let length = direction
        .iter()
        .map(|entry| entry * entry)
        .sum::<f64>()
        .sqrt();
    let largest = (0..3).fold(0, |best, k| {
        match direction[k].abs() > direction[best].abs() {
            true => k,
            false => best,
        }
    });
    let sign = direction[largest].signum();
    let spin = direction.map(|entry| sign * entry / length);
    let mut first = [0.0; 3];
    first[(largest + 1) % 3] = 1.0;
    let along: f64 = first.iter().zip(&spin).map(|(a, b)| a * b).sum();
    let first: [f64; 3] = std::array::from_fn(|k| first[k] - along * spin[k]);
    let length = first.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    let first = first.map(|entry| entry / length);
    let second = std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        spin[i] * first[j] - spin[j] * first[i]
    });
    (spin, [first, second])
}

/// Formats an axis with four digits.
fn format_axis(axis: [f64; 3]) -> String {
    let entries = axis.map(|entry| {
        let rounded = (entry * 1e4).round() / 1e4;
        // No −0.
        (rounded + 0.0).to_string()
    });
    format!("[{}]", entries.join(", "))
}
