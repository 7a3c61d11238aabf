//! Random mechanisms with claims that are true by construction: some joints carry all others, and only gravity acts on
//! them.

use super::pieces::{Piece, Rate, kinetic, moment, momentum, potential};
use super::{Claim, Form, MIN_PIVOT};
use crate::common::Random;
use crate::jointed::{Joint, Law, Load, Loop, Motion, Name, System, short};

/// A mechanism with conserved quantities that are known by construction.
pub struct ConservativeMechanism {
    /// The mechanism.
    pub system: System,
    /// The number of joints that carry the others, and on which only gravity acts.
    roots: usize,
    /// Whether they give the rest of the mechanism all six degrees of freedom.
    free: bool,
    /// Whether the mechanism is independent of time.
    lasting: bool,
}

/// Returns axis and kind of a slider along an axis of the world.
fn prismatic(k: usize) -> ([f64; 3], &'static str) {
    let mut axis = [0.0; 3];
    axis[k] = 1.0;
    (axis, "prismatic")
}

/// Returns a joint that carries the following ones, without a spring.
fn root((axis, kind): ([f64; 3], &'static str), i: usize, random: &mut Random) -> Joint {
    Joint {
        kind,
        axis,
        on: i.checked_sub(1),
        at: [0.0, 0.0, short(random)],
        motion: Motion::Free,
        load: Load::Nothing,
        stiffness: 0.0,
        armature: 0.0,
    }
}

impl ConservativeMechanism {
    fn random(random: &mut Random) -> Self {
        let upright = ([0.0, 0.0, 1.0], "revolute");
        let kind = random.below(6);
        let free = kind == 5;
        let kinds = match kind {
            0 | 1 => vec![upright],
            2 => vec![prismatic(random.below(3))],
            3 => vec![prismatic(2), upright],
            5 => {
                let turns = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
                let turns = turns.map(|axis| (axis, "revolute"));
                (0..3).map(prismatic).chain(turns).collect()
            }
            _ => vec![prismatic(0), prismatic(1), upright],
        };
        let roots = kinds.len();
        let kinds = kinds.into_iter().enumerate();
        let mut joints: Vec<Joint> = kinds.map(|(i, kind)| root(kind, i, random)).collect();
        let timed = random.below(3) == 0;
        let most = if free { 1 } else { 3 };
        if free {
            joints[roots - 1].load = Load::Body(12.0, [0.1, 0.0, -0.2], [0.5, 0.8, 0.6]);
        }
        for i in roots..roots + 1 + random.below(most) {
            joints.push(inner(random, &joints, roots, i, timed));
        }
        let last = joints.len() - 1;
        joints[last].load = Load::Body(6.0, [0.3, 0.2, -0.1], [0.6, 0.7, 0.9]);
        let level = roots == 1 && joints[0].kind == "prismatic";
        let gravity = match random.below(3) {
            0 => [0.0; 3],
            1 if level => [0.7, -0.4, -9.81],
            _ => [0.0, 0.0, -9.81],
        };
        let guess = joints.iter().map(|joint| match joint.kind {
            "continuous" => 0.0,
            _ => short(random),
        });
        let guess = guess.collect();
        let mut system = System {
            joints,
            loops: Vec::new(),
            guess,
            gravity,
            timed,
            rows: Vec::new(),
            acted: None,
        };
        tie(&mut system, random, roots);
        constrain(&mut system, random, roots);
        act(&mut system, random);
        let lasting = !depends_on_time(&system);
        ConservativeMechanism {
            system,
            roots,
            free,
            lasting,
        }
    }

    /// Returns claims that are true.
    pub fn truths(&self, random: &mut Random) -> Vec<Claim> {
        let mut all = Vec::new();
        if self.lasting {
            let mut terms = kinetic(&self.system, random.below(4) == 0);
            terms.extend(potential(&self.system));
            let named = Claim::named("energy".into(), terms.clone());
            all.extend([named, Claim::new(terms)].map(|claim| self.where_unforced(claim)));
        }
        for i in 0..self.roots {
            all.extend(
                self.momenta(random, i)
                    .into_iter()
                    .map(|claim| match self.system.acted {
                        Some((joint, _)) if joint < self.roots => self.where_unforced(claim),
                        _ => claim,
                    }),
            );
        }
        all.extend(self.ties().into_iter().map(Claim::new));
        for claim in &mut all {
            if claim.named.is_none() {
                claim.form = [Form::Sum, Form::Sum, Form::Square, Form::Logarithm][random.below(4)];
                if random.below(2) == 0 {
                    claim.pieces.extend(self.vanishing(random));
                }
            }
        }
        all
    }

    /// Adds the condition that neither input nor damper acts.
    fn where_unforced(&self, mut claim: Claim) -> Claim {
        if self.system.acted.is_some() {
            claim.when = [Some(0.0); 2];
        }
        claim
    }

    /// Returns claims about the momentum along or about the axis of a root, as a keyword and written out; for a free
    /// base, about any point, or along all axes.
    fn momenta(&self, random: &mut Random, i: usize) -> Vec<Claim> {
        let system = &self.system;
        let (mut axis, mut about) = (system.joints[i].axis, [0.0, 0.0, short(random)]);
        if self.free {
            axis = prismatic(i % 3).0;
            about = [(); 3].map(|()| short(random));
        }
        let linear = system.joints[i].kind == "prismatic";
        let (mut name, terms) = match linear {
            true => ("linear_momentum".into(), momentum(system, axis)),
            false => (
                format!("angular_momentum about {about:?}"),
                moment(system, about, axis),
            ),
        };
        let falls = |axis: [f64; 3]| (0..3).any(|k| axis[k] * system.gravity[k] != 0.0);
        if self.free && system.gravity != [0.0; 3] && !linear {
            return Vec::new();
        }
        if !self.free || system.gravity != [0.0; 3] || random.below(2) == 0 {
            name += &format!(" along {axis:?}");
        }
        // Without the time, the contribution of gravity along the axis cannot be expressed.
        let falls = linear && falls(axis);
        let written = (!falls || system.timed).then(|| Claim::new(terms.clone()));
        let named = (!falls).then(|| Claim::named(name, terms));
        written.into_iter().chain(named).collect()
    }

    /// Claims about quantities that loops and prescribed motions hold constant.
    fn ties(&self) -> Vec<Vec<Piece>> {
        let mut all = Vec::new();
        for (i, joint) in self.system.joints.iter().enumerate() {
            if let Motion::Placed(law) = &joint.motion {
                all.push(vec![value(i), of_law(law, -1.0)]);
            }
        }
        for (tie, _) in &self.system.loops {
            if let Loop::Tie(i, law) = tie {
                all.push(vec![value(*i), of_law(law, 1.0)]);
            }
        }
        all
    }

    /// Claims that hold only by coincidence: the energy of a driven system, and momenta about other points and axes.
    pub fn doubtful(&self, random: &mut Random) -> Vec<Claim> {
        let mut terms = kinetic(&self.system, false);
        terms.extend(potential(&self.system));
        let energy = Claim::named("energy".into(), terms);
        let tilted = [short(random), 0.0, 1.0];
        let about = [short(random), 0.25, 0.0];
        let mut all = vec![energy];
        for (about, along) in [(about, [0.0, 0.0, 1.0]), ([0.0; 3], tilted)] {
            let name = format!("angular_momentum about {about:?} along {along:?}");
            all.push(Claim::named(name, moment(&self.system, about, along)));
        }
        if self.system.gravity == [0.0; 3] || self.system.timed {
            let name = format!("linear_momentum along {tilted:?}");
            let terms = momentum(&self.system, tilted);
            // Includes the contribution of gravity, which the keyword does not.
            let falls = self.system.gravity != [0.0; 3];
            all.push(match falls {
                true => Claim::new(terms),
                false => Claim::named(name, terms),
            });
        }
        all
    }

    /// Returns terms whose sum vanishes on the constraints, times a common factor.
    fn vanishing(&self, random: &mut Random) -> Vec<Piece> {
        let joints = &self.system.joints;
        let own = self.system.own();
        let factor = match random.below(2) {
            0 => rate(own[random.below(own.len())]),
            _ => rate(0).times(&rate(own[random.below(own.len())])),
        };
        let circle = (0..joints.len()).find(|&i| is_circle(&joints[i]));
        let mut all = Vec::new();
        if let Some(i) = circle {
            all.push(Piece::new(&[], format!("j{i}.c^2"), move |at| {
                at.joint(i).cos() * at.joint(i).cos()
            }));
            all.push(Piece::new(&[], format!("j{i}.s^2"), move |at| {
                at.joint(i).sin() * at.joint(i).sin()
            }));
            all.push(Piece::new(&[-1.0], "1".into(), |_| Rate::number(1.0)));
        } else if let Some(row) = self.system.rows.first() {
            all.extend(row.iter().map(|(k, law)| of_law(law, 1.0).times(&rate(*k))));
        }
        all.iter().map(|piece| piece.times(&factor)).collect()
    }
}

/// Returns whether the coordinate of a joint is a circle, so that the angle has no value.
fn is_circle(joint: &Joint) -> bool {
    joint.kind == "continuous" && joint.has_coordinate()
}

/// Returns the value of a joint.
pub fn value(i: usize) -> Piece {
    Piece::new(&[], format!("j{i}"), move |at| at.joint(i))
}

/// Returns the rate of a joint.
fn rate(i: usize) -> Piece {
    Piece::new(&[], format!("j{i}_dot"), move |at| at.joint_rate(i))
}

/// Returns a law times a number.
pub fn of_law(law: &Law, factor: f64) -> Piece {
    let own = law.clone();
    Piece::new(&[factor], format!("({})", law.text()), move |at| {
        at.of(|placed| own.value(|name| placed.of(name)))
    })
}

/// Returns the names of the inner joints with a plain value, and the time if it is declared.
fn names(joints: &[Joint], roots: usize, timed: bool) -> Vec<Name> {
    let plain = (roots..joints.len()).filter(|&i| !is_circle(&joints[i]));
    let time = timed.then_some(Name::Time);
    plain.map(Name::Joint).chain(time).collect()
}

/// Returns a joint that is independent of the roots.
fn inner(random: &mut Random, before: &[Joint], roots: usize, i: usize, timed: bool) -> Joint {
    const AXES: [[f64; 3]; 4] = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, -2.0, 2.0],
    ];
    let names = names(before, roots, timed);
    let motion = match random.below(6) {
        0 | 1 if !names.is_empty() => Motion::Follows(Law::random(random, &names)),
        2 if timed => Motion::Placed(Law::of_time(random)),
        3 if timed => Motion::Driven(Law::of_time(random)),
        _ => Motion::Free,
    };
    let free = matches!(motion, Motion::Free);
    let kinds = ["revolute", "prismatic", "continuous"];
    let kind = match motion {
        Motion::Free | Motion::Follows(_) => kinds[random.below(3)],
        _ => kinds[random.below(2)],
    };
    let circle = free && kind == "continuous";
    Joint {
        kind,
        axis: AXES[random.below(4)],
        on: Some(roots - 1 + random.below(i + 1 - roots)),
        at: [(); 3].map(|()| short(random)),
        motion,
        load: Load::random(random),
        stiffness: if circle {
            0.0
        } else {
            [0.0, 3.0][random.below(2)]
        },
        armature: match free && random.below(5) == 0 {
            true => 0.5,
            false => 0.0,
        },
    }
}

/// Returns the inner joints that are free.
fn free(system: &System, roots: usize) -> Vec<usize> {
    let inner = roots..system.joints.len();
    inner
        .filter(|&i| matches!(system.joints[i].motion, Motion::Free))
        .collect()
}

/// Adds a loop between inner joints, in half of all cases.
fn tie(system: &mut System, random: &mut Random, roots: usize) {
    let own = free(system, roots);
    let own: Vec<usize> = own
        .into_iter()
        .filter(|&i| !is_circle(&system.joints[i]))
        .collect();
    if own.is_empty() || random.below(2) > 0 {
        return;
    }
    let own = own[random.below(own.len())];
    let mut names = names(&system.joints, roots, system.timed);
    // Joints that follow this one would relate it to itself.
    names.retain(|name| match *name {
        Name::Joint(i) => i != own && system.joints[i].has_coordinate(),
        Name::Time => true,
    });
    if !names.is_empty() {
        let tie = Loop::Tie(own, Law::random(random, &names));
        let constant = system.placed(&system.start()).closed(&tie).value;
        system.loops.push((tie, constant));
    }
}

/// Adds a constraint on the velocities of two inner joints, in half of all cases.
fn constrain(system: &mut System, random: &mut Random, roots: usize) {
    let own = free(system, roots);
    let names = names(&system.joints, roots, false);
    if own.len() < 2 || names.is_empty() || random.below(2) > 0 {
        return;
    }
    let mut first = Law::random(random, &names);
    if random.below(2) == 0 {
        // With a constant factor, the velocity is eliminated.
        first = Law::constant(2.0);
    }
    let second = Law::random(random, &names);
    system.rows.push(vec![(own[0], first), (own[1], second)]);
}

/// Adds an input and a damper to a joint, in a third of all cases.
fn act(system: &mut System, random: &mut Random) {
    let free = free(system, 0);
    if !free.is_empty() && random.below(3) == 0 {
        system.acted = Some((free[random.below(free.len())], [0.7, 0.3]));
    }
}

/// Returns whether the energy may change with time.
fn depends_on_time(system: &System) -> bool {
    let joints = system.joints.iter().any(|joint| match &joint.motion {
        Motion::Free => false,
        Motion::Follows(law) => law.mentions(Name::Time),
        Motion::Placed(_) | Motion::Driven(_) => true,
    });
    let loops = system.loops.iter().any(|(tie, _)| match tie {
        Loop::Tie(_, law) => law.mentions(Name::Time),
        Loop::Point(..) => false,
    });
    joints || loops
}

/// Draws a system that moves, and in which every spring moves.
pub fn drawn(random: &mut Random) -> ConservativeMechanism {
    loop {
        let kept = ConservativeMechanism::random(random);
        let (pivot, left, independent) = kept.system.regularity(&kept.system.start());
        let moves = pivot > MIN_PIVOT && left > 0 && independent > 0.05;
        if moves && !kept.system.has_idle_spring() {
            return kept;
        }
    }
}
