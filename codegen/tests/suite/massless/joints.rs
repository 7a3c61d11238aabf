//! Trees of joints, many of which move no mass: some follow others, some are functions of time, and loops relate
//! others. Emitted accelerations are compared with Lagrange's equations in numbers. A refusal is right if the reference
//! finds a direction without inertia at the start, or no remaining motion.

use super::{MIN_PIVOT, TOLERANCE};
use crate::common::{Random, attack, value};
use crate::dense::kernel;
use crate::jointed::{Joint, Law, Load, Loop, Motion, Name, System, short};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::render::render;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Number of states per system.
const STATES_PER_SYSTEM: usize = 2;
/// Axes of joints.
const AXES: [[f64; 3]; 5] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -2.0, 2.0],
];

/// Returns three to six joints in any mixture, with up to two loops; the last one moves a body.
fn system(random: &mut Random) -> System {
    let count = 3 + random.below(4);
    let mut joints: Vec<Joint> = (0..count).map(|i| joint(random, i)).collect();
    joints[count - 1].load = Load::Body(6.0, [0.3, 0.2, -0.1], [0.6, 0.7, 0.9]);
    let mut system = System {
        joints,
        loops: Vec::new(),
        guess: (0..count).map(|_| short(random)).collect(),
        gravity: [0.0, 0.0, -9.81],
        timed: true,
        rows: Vec::new(),
        acted: None,
    };
    for _ in 0..random.below(3) {
        tie(&mut system, random);
    }
    system
}

/// Returns a joint on an earlier one, or on the world.
fn joint(random: &mut Random, i: usize) -> Joint {
    let motion = motion(random, i);
    let free = matches!(motion, Motion::Free);
    let kinds = ["revolute", "prismatic", "continuous"];
    let kind = match motion {
        Motion::Follows(_) => kinds[random.below(3)],
        _ => kinds[random.below(2)],
    };
    Joint {
        kind,
        axis: AXES[random.below(5)],
        on: (i > 0 && random.below(4) > 0).then(|| random.below(i)),
        at: [(); 3].map(|()| short(random)),
        motion,
        load: Load::random(random),
        stiffness: [0.0, 3.0][random.below(2)],
        armature: match free && random.below(5) == 0 {
            true => 0.5,
            false => 0.0,
        },
    }
}

/// Draws the source of the motion of a joint; the first joint is free.
fn motion(random: &mut Random, i: usize) -> Motion {
    match random.below(6) {
        2 | 3 if i > 0 => {
            let mut names: Vec<Name> = (0..i).map(Name::Joint).collect();
            if random.below(4) == 0 {
                names.push(Name::Time);
            }
            Motion::Follows(Law::random(random, &names))
        }
        4 if i > 0 => Motion::Placed(Law::of_time(random)),
        5 if i > 0 && random.below(2) == 0 => Motion::Driven(Law::of_time(random)),
        _ => Motion::Free,
    }
}

/// Adds a loop if one of several candidates is independent of the others at the guesses.
fn tie(system: &mut System, random: &mut Random) {
    let count = system.joints.len();
    let free: Vec<usize> = (0..count)
        .filter(|&i| matches!(system.joints[i].motion, Motion::Free))
        .collect();
    if free.len() < system.loops.len() + 1 {
        return;
    }
    for _ in 0..8 {
        let tie = match random.below(2) {
            0 => {
                let own = free[random.below(free.len())];
                let others = (0..count).filter(|&i| i != own).map(Name::Joint);
                let names: Vec<Name> = others.chain([Name::Time]).collect();
                Loop::Tie(own, Law::random(random, &names))
            }
            _ => {
                let mut end = |world: bool| {
                    let frame = (!world).then(|| random.below(count));
                    (frame, [(); 3].map(|()| short(random)))
                };
                let (first, second) = (end(false), end(true));
                let other = [end(false), second][random.below(2)];
                Loop::Point([first, other], random.below(3))
            }
        };
        let constant = system.placed(&system.start()).closed(&tie).value;
        system.loops.push((tie, constant));
        let rows = system.rows_of(&system.placed(&system.start()));
        if kernel(&rows, system.own().len()).1 > 0.05 {
            return;
        }
        system.loops.pop();
    }
}

/// Returns whether the reason of a refusal is right.
fn rightly_refused(system: &System, said: &str) -> bool {
    let (pivot, left, _) = system.regularity(&system.start());
    let idle = pivot <= MIN_PIVOT && said.contains("the mass matrix is not positive definite");
    let still = left == 0 && said.contains("the constraints leave no motion");
    idle || still || said.contains("this spring does nothing") && system.has_idle_spring()
}

/// Parses the index of the joint of a velocity, `j3_dot`.
fn number(name: &str) -> usize {
    let digits: String = name.chars().filter(char::is_ascii_digit).collect();
    digits.parse().expect("a joint has a number")
}

/// Evaluates the emitted accelerations at a state; each is paired with the index of its joint.
fn found(of: &Generated, system: &System, q: &[f64], v: &[f64]) -> Vec<(usize, f64)> {
    let own = system.own();
    let model = &of.active;
    let mut x = vec![0.0; model.nu()];
    x[model.clock.expect("the time is declared").x] = q[own.len()];
    for coordinate in model.coordinates.iter().filter(|c| c.name.starts_with('j')) {
        let place = own.iter().position(|&i| i == number(&coordinate.name));
        x[coordinate.offset] = q[place.expect("it has a coordinate")];
    }
    let places: Vec<usize> = (model.xi.iter())
        .map(|edge| {
            let symbols = model.graph.symbols().iter();
            let name = symbols.clone().find(|s| s.node == edge.node());
            let moved = number(&name.expect("a velocity").name);
            own.iter().position(|&i| i == moved).expect("it has one")
        })
        .collect();
    let xi: Vec<f64> = places.iter().map(|&place| v[place]).collect();
    let rates = value(of, "accel", [&x, &xi, &[], &[]]);
    places.into_iter().zip(rates).collect()
}

/// The result of comparing a system with the reference.
enum Outcome {
    /// It is derived, and its rates agree with the reference at some states.
    Compared,
    /// It is rightly refused.
    Refused,
    /// It is derived, but nearly singular at all tested states.
    Singular,
}

fn outcome(system: &System, text: &str, random: &mut Random) -> Result<Outcome, String> {
    let n = system.own().len();
    let of = match from_text(text) {
        Ok(of) => of,
        Err(errors) => {
            let said = render(&errors, "system", text, false);
            return match rightly_refused(system, &said) {
                true => Ok(Outcome::Refused),
                false => Err(format!("{said}{:?}", system.regularity(&system.start()))),
            };
        }
    };
    let (start, left, _) = system.regularity(&system.start());
    if start == 0.0 && left > 0 {
        return Err("it is derived, although directions without inertia are left".into());
    }
    let mut outcome = Outcome::Singular;
    for _ in 0..STATES_PER_SYSTEM {
        let near = system
            .start()
            .into_iter()
            .map(|q| q + 0.4 * random.number());
        let Some(q) = system.assembled(near.collect()) else {
            continue;
        };
        let v = system.moving(&q, random.numbers(n));
        let (pivot, left, independent) = system.regularity(&q);
        if left == 0 || pivot <= MIN_PIVOT || independent <= MIN_PIVOT {
            continue;
        }
        outcome = Outcome::Compared;
        let expected = system.acceleration(&q, &v);
        let size = expected.iter().fold(10.0, |most: f64, a| most.max(a.abs()));
        for (place, rate) in found(&of, system, &q, &v) {
            let difference = (rate - expected[place]).abs();
            if difference.is_nan() || difference > TOLERANCE * size {
                let joint = system.own()[place];
                return Err(format!(
                    "rate of j{joint} at {q:?}, {v:?}: {rate}, not {}; pivots {pivot} {independent}",
                    expected[place]
                ));
            }
        }
    }
    Ok(outcome)
}

/// Draws a system; one with massless directions is rejected in three quarters of all cases.
fn drawn(random: &mut Random) -> System {
    loop {
        let system = system(random);
        let (pivot, ..) = system.regularity(&system.start());
        if pivot > MIN_PIVOT || random.below(4) == 0 {
            return system;
        }
    }
}

#[test]
fn joints_that_follow_or_are_driven_need_no_mass() {
    let (cases, compared) = (AtomicUsize::new(0), AtomicUsize::new(0));
    attack(40, 3000, |seed| {
        let random = &mut Random::new(seed ^ 0xf0110);
        let system = drawn(random);
        let text = system.text(&[]);
        let outcome = outcome(&system, &text, random);
        cases.fetch_add(1, Relaxed);
        if let Ok(Outcome::Compared) = outcome {
            compared.fetch_add(1, Relaxed);
        }
        let said = outcome
            .err()
            .map(|fault| format!("seed {seed}: {fault}\n{text}"));
        said.into_iter().collect()
    });
    let [cases, compared] = [cases, compared].map(AtomicUsize::into_inner);
    assert!(2 * compared > cases, "{compared} of {cases} are compared");
}
