//! Random trees of bodies with some joints prescribed by time or by inputs: accelerations of the others and forces of
//! the drives, compared with the recursive Newton-Euler algorithm.

use crate::common::{Random, attack, difference, generated, value};
use crate::tree::{ALL, Kind, Link, Tree, text};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::model::Group;
use hamel_codegen::render::render;

/// Rounding of a few thousand operations, with forces of order 100, times the condition of M.
const TOLERANCE: f64 = 1e-9;
/// Number of states per tree.
const STATES_PER_TREE: usize = 3;

/// The prescription of a joint's velocity.
enum Given {
    /// Its rate is the input `r{joint}`.
    Rate,
    /// Every entry is a + b t + c sin(d t).
    Velocity([f64; 4]),
    /// The coordinate is a + b t + c sin(d t).
    Time([f64; 4]),
}

/// A prescribed velocity.
struct Drive {
    joint: usize,
    /// The name of the velocity.
    velocity: String,
    /// The number of its entries.
    size: usize,
    given: Given,
}

fn short(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}

/// Draws prescribed motions: at least one, and in a quarter of all cases one for every joint.
fn drives(random: &mut Random, links: &[Link]) -> Vec<Drive> {
    let mut drives = Vec::new();
    let free: Vec<usize> = (0..links.len())
        .filter(|&i| links[i].freedoms() > 0)
        .collect();
    let spared = free[random.below(free.len())];
    let all = random.below(4) == 0;
    for &joint in &free {
        if !all && (joint == spared || random.below(2) == 0) {
            continue;
        }
        let (ending, size) = match links[joint].kind {
            Kind::Spherical | Kind::Quaternion => ("_dot", 3),
            Kind::Universal => ("_1_dot", 1),
            Kind::Free => ("_w", 3),
            _ => ("_dot", 1),
        };
        let plain = matches!(
            links[joint].kind,
            Kind::Revolute | Kind::Prismatic | Kind::Continuous
        );
        let law = [(); 4].map(|()| short(random.number()));
        let given = match random.below(3) {
            0 if plain => Given::Time(law),
            1 => Given::Velocity(law),
            _ => Given::Rate,
        };
        let velocity = format!("q{joint}{ending}");
        drives.push(Drive {
            joint,
            velocity,
            size,
            given,
        });
    }
    drives
}

/// Returns the description with the prescribed motions, and with the time at a random place.
fn description(links: &[Link], drives: &[Drive]) -> String {
    let mut said = String::from("    time t;\n");
    for drive in drives {
        let joint = drive.joint;
        said += &match drive.given {
            Given::Rate => {
                let shape = if drive.size > 1 { ": vec3" } else { "" };
                let velocity = &drive.velocity;
                format!("    input r{joint}{shape};\n    prescribe rate({velocity}) = r{joint};\n")
            }
            Given::Velocity([a, b, c, d]) => {
                let law = format!("{a} + {b} * t + {c} * sin({d} * t)");
                let law = match drive.size {
                    1 => law,
                    _ => format!("[{law}, {law}, {law}]"),
                };
                format!("    prescribe {} = {law};\n", drive.velocity)
            }
            Given::Time([a, b, c, d]) => {
                format!("    prescribe q{joint} = {a} + {b} * t + {c} * sin({d} * t);\n")
            }
        };
    }
    let functions = "accel, inverse_dynamics, mass_matrix, energy, momentum, constraint_force";
    let text = text(links, functions);
    let end = text.find("    gravity").expect("gravity stands last");
    format!("{}{said}{}", &text[..end], &text[end..])
}

fn places<'a>(groups: &'a [Group], name: &str) -> Option<std::ops::Range<usize>> {
    let group: Option<&'a Group> = groups.iter().find(|group| group.name == name);
    group.map(|group| group.offset..group.offset + group.len)
}

/// A state of the tree: x, ξ and ξ̇ of all joints, from those of the free ones.
struct FullState {
    x: Vec<f64>,
    xi: Vec<f64>,
    dot: Vec<f64>,
    /// Indices in ξ without ξ⁰ of the velocities that are free, of those in the state, and of the driven ones.
    free: Vec<usize>,
    state: Vec<usize>,
    driven: Vec<usize>,
    /// The prescribed rates, in the order of the velocities.
    wanted: Vec<f64>,
}

fn whole(
    of: &Generated,
    (links, drives): (&[Link], &[Drive]),
    [x, xi, u, dot]: [&[f64]; 4],
) -> FullState {
    let clock = of.model.clock.expect("the time is declared");
    let t = x[clock.x];
    let mut x = x.to_vec();
    let (mut all, mut rates) = (Vec::new(), Vec::new());
    let (mut free, mut state, mut wanted) = (Vec::new(), Vec::new(), Vec::new());
    let mut driven = vec![Vec::new(); drives.len()];
    let mut count = 0;
    for group in of.model.velocities.iter().filter(|g| g.offset != clock.xi) {
        let drive = drives.iter().position(|drive| drive.velocity == group.name);
        match drive {
            None => {
                let range = places(&of.active.velocities, &group.name).expect("it is free");
                free.extend(count..count + range.len());
                state.extend(count..count + range.len());
                all.extend(&xi[range.clone()]);
                rates.extend(&dot[range]);
            }
            Some(index) => {
                let drive = &drives[index];
                driven[index].extend(count..count + drive.size);
                match drive.given {
                    Given::Rate => {
                        let range = places(&of.active.velocities, &group.name).expect("it stays");
                        state.extend(count..count + range.len());
                        all.extend(&xi[range.clone()]);
                        let name = format!("r{}", drive.joint);
                        wanted
                            .extend(&u[places(&of.active.inputs, &name).expect("it is declared")]);
                        rates.extend(&dot[range]);
                    }
                    Given::Velocity([a, b, c, d]) => {
                        for _ in 0..drive.size {
                            all.push(a + b * t + c * (d * t).sin());
                            rates.push(b + c * d * (d * t).cos());
                        }
                    }
                    Given::Time([a, b, c, d]) => {
                        let value = a + b * t + c * (d * t).sin();
                        let name = format!("q{}", drive.joint);
                        let mut coordinates = of.model.coordinates.iter();
                        let coordinate = coordinates.find(|c| c.name == name).expect("it is there");
                        let place = coordinate.offset;
                        match links[drive.joint].kind {
                            Kind::Continuous => (x[place + 1], x[place]) = value.sin_cos(),
                            _ => x[place] = value,
                        }
                        all.push(b + c * d * (d * t).cos());
                        rates.push(-c * d * d * (d * t).sin());
                    }
                }
            }
        }
        count += group.len;
    }
    x.remove(clock.x);
    // The forces of drives with prescribed rates come last.
    let (of_rates, of_time): (Vec<_>, Vec<_>) =
        (driven.into_iter().zip(drives)).partition(|(_, drive)| matches!(drive.given, Given::Rate));
    let [of_time, of_rates] = [of_time, of_rates].map(|list| {
        let places = list.into_iter().map(|(places, _)| places);
        places.collect::<Vec<Vec<usize>>>()
    });
    FullState {
        x,
        xi: all,
        dot: rates,
        free,
        state,
        driven: [of_time, of_rates].concat().concat(),
        wanted,
    }
}

/// Returns the faults of a random tree.
fn faults(seed: u64) -> Vec<String> {
    let mut random = Random::new(0x9e5c ^ seed);
    let mut links: Vec<Link> = Vec::new();
    let count = 2 + random.below(5);
    while links.len() < count || links.iter().all(|link| link.freedoms() == 0) {
        links.push(Link::random(&mut random, &links, &ALL));
    }
    let drives = drives(&mut random, &links);
    let text = description(&links, &drives);
    let system = match from_text(&text) {
        Ok(system) => system,
        Err(errors) => return vec![render(&errors, "tree", &text, false)],
    };
    let mut faults = Vec::new();
    for _ in 0..STATES_PER_TREE {
        let program = &system.program;
        let x = random.configuration(&program.blocks);
        let (xi, u) = (random.numbers(program.n), random.numbers(program.m));
        let dot = random.numbers(program.n);
        let of = |name: &str, dot: &[f64]| value(&system, name, [&x, &xi, &u, dot]);
        let accel = of("accel", &dot);
        let pick = |list: &[f64], places: &[usize]| -> Vec<f64> {
            places.iter().map(|&i| list[i]).collect()
        };
        let mut same = |what: &str, wanted: &[f64], found: &[f64]| {
            let apart = difference(wanted, found);
            if apart.is_nan() || apart > TOLERANCE {
                faults.push(format!("seed {seed}: {what} {apart:.1e} of\n{text}"));
            }
        };
        let parts = (links.as_slice(), drives.as_slice());
        // With arbitrary accelerations of the free velocities: inverse dynamics, momentum, energy.
        let at = whole(&system, parts, [&x, &xi, &u, &dot]);
        let tree = Tree::new(&links, &at.x, &at.xi);
        let needed = |dot: &[f64]| -> Vec<f64> {
            let springs = tree.springs();
            let rows = tree.needed(dot, 1.0);
            rows.iter().zip(&springs).map(|(a, b)| a + b).collect()
        };
        let wanted = pick(&needed(&at.dot), &at.state);
        same("inverse dynamics", &wanted, &of("inverse_dynamics", &dot));
        same("energy", &[tree.energy()], &of("energy", &dot));
        let still = vec![0.0; at.xi.len()];
        let bias = tree.needed(&still, 0.0);
        let moved = tree.needed(&at.xi, 0.0);
        let momentum: Vec<f64> = moved.iter().zip(&bias).map(|(a, b)| a - b).collect();
        same(
            "momentum",
            &pick(&momentum, &at.state),
            &of("momentum", &dot),
        );
        // With the emitted accelerations: no force on the free velocities, and the forces of the drives on the others.
        let at = whole(&system, parts, [&x, &xi, &u, &accel]);
        let forces = needed(&at.dot);
        let applied = tree.applied(u[0]);
        let left: Vec<f64> = forces.iter().zip(&applied).map(|(a, b)| a - b).collect();
        let size = accel.iter().fold(1.0, |most: f64, a| most.max(a.abs()));
        let scaled = |list: Vec<f64>| list.iter().map(|entry| entry / size).collect::<Vec<_>>();
        let rates: Vec<usize> = at
            .state
            .iter()
            .copied()
            .filter(|i| !at.free.contains(i))
            .collect();
        same("a given rate", &at.wanted, &pick(&at.dot, &rates));
        let free = scaled(pick(&left, &at.free));
        same("motion", &vec![0.0; free.len()], &free);
        if !at.driven.is_empty() {
            let found = scaled(of("constraint_force", &dot));
            same("force of a drive", &scaled(pick(&left, &at.driven)), &found);
        }
    }
    faults
}

#[test]
fn trees_with_drives_obey_newton_and_euler() {
    attack(8, 2000, faults);
}

/// A driven crank without mass has no effect on the solution: the piston falls, and the drive needs no torque.
#[test]
fn what_is_driven_needs_no_mass() {
    let of = generated(
        "system Driven {
            input F;
            joint a: revolute [0, 0, 1] moves crank;
            joint b: prismatic [0, 1, 0] on crank at [0.5, 0, 0] moves slide;
            joint c: prismatic [0, 1, 0] moves piston;
            body on piston { mass 2; }
            particle mass 3 at slide.p;
            gravity [0, -9.81, 0];
            prescribe rate(a_dot) = F;
            start b = 0.2, a_dot = 0.7;
        }",
    );
    let model = &of.active;
    let found = value(&of, "accel", [&model.start_x, &model.start_xi, &[0.4], &[]]);
    // Along the crank: b̈ = b ȧ² − 0.5 ä − g
    let expected = [0.4, 0.2 * 0.49 - 0.5 * 0.4 - 9.81, -9.81];
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
    }
}
