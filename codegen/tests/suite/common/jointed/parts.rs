//! The parts of a description of joints: laws of motion, masses, joints, loops.

use crate::common::Random;
use crate::jet::Jet;

/// A sum of terms in the values of joints and the time, with its text.
#[derive(Clone)]
pub struct Law {
    /// The constant term.
    pub constant: f64,
    /// Terms c x.
    pub linear: Vec<(f64, Name)>,
    /// The term c sin x.
    pub sine: Option<(f64, Name)>,
    /// Terms c x y.
    pub products: Vec<(f64, Name, Name)>,
}

/// Variable of a law: the value of a joint, or the time.
#[derive(Clone, Copy, PartialEq)]
pub enum Name {
    /// The value of a joint.
    Joint(usize),
    /// The time.
    Time,
}

impl Name {
    /// The variable in the language.
    pub fn text(self) -> String {
        match self {
            Name::Joint(i) => format!("j{i}"),
            Name::Time => "t".into(),
        }
    }
}

/// Returns a number in ±1 with two decimals, never 0.
pub fn short(random: &mut Random) -> f64 {
    match (random.number() * 100.0).round() / 100.0 {
        0.0 => 0.5,
        number => number,
    }
}

impl Law {
    /// Returns a law of some names, nonlinear in half of all cases.
    pub fn random(random: &mut Random, names: &[Name]) -> Self {
        let name = |random: &mut Random| names[random.below(names.len())];
        let linear = (0..1 + random.below(2)).map(|_| {
            let factor = [1.0, -1.0, 2.0, 0.5, short(random)][random.below(5)];
            (factor, name(random))
        });
        let linear = linear.collect();
        let kind = random.below(4);
        Law {
            constant: [0.0, short(random)][random.below(2)],
            linear,
            sine: (kind == 1 || kind == 3).then(|| (short(random), name(random))),
            products: (0..usize::from(kind == 2))
                .map(|_| (short(random), name(random), name(random)))
                .collect(),
        }
    }

    /// Returns a constant law.
    pub fn constant(constant: f64) -> Self {
        Law {
            constant,
            linear: Vec::new(),
            sine: None,
            products: Vec::new(),
        }
    }

    /// a + b t + c sin t
    pub fn of_time(random: &mut Random) -> Self {
        Law {
            constant: short(random),
            linear: vec![(short(random), Name::Time)],
            sine: Some((short(random), Name::Time)),
            products: Vec::new(),
        }
    }

    /// Returns whether the law depends on a variable.
    pub fn mentions(&self, wanted: Name) -> bool {
        let linear = self.linear.iter().map(|(_, name)| *name);
        let sine = self.sine.iter().map(|(_, name)| *name);
        let products = self.products.iter().flat_map(|(_, a, b)| [*a, *b]);
        linear
            .chain(sine)
            .chain(products)
            .any(|name| name == wanted)
    }

    /// Returns its text.
    pub fn text(&self) -> String {
        let linear = self.linear.iter();
        let mut terms: Vec<String> = linear.map(|(c, n)| format!("{c} * {}", n.text())).collect();
        if let Some((c, name)) = self.sine {
            terms.push(format!("{c} * sin({})", name.text()));
        }
        for (c, a, b) in &self.products {
            terms.push(format!("{c} * {} * {}", a.text(), b.text()));
        }
        if self.constant != 0.0 {
            terms.push(self.constant.to_string());
        }
        terms.join(" + ")
    }

    /// Returns its value.
    pub fn value(&self, of: impl Fn(Name) -> Jet) -> Jet {
        let mut total = Jet::number(self.constant);
        for &(factor, name) in &self.linear {
            total = total + of(name) * factor;
        }
        if let Some((factor, name)) = self.sine {
            total = total + of(name).sin() * factor;
        }
        for &(factor, a, b) in &self.products {
            total = total + of(a) * of(b) * factor;
        }
        total
    }
}

/// Source of the motion of a joint.
#[derive(Clone)]
pub enum Motion {
    /// Forces only.
    Free,
    /// Other joints; it has no coordinate.
    Follows(Law),
    /// A law of time for its coordinate.
    Placed(Law),
    /// A law of time for its velocity.
    Driven(Law),
}

/// Load on the frame of a joint.
#[derive(Clone)]
pub enum Load {
    /// Nothing.
    Nothing,
    /// A mass and its position.
    Particle(f64, [f64; 3]),
    /// Six points of equal mass, two on each axis, at a different distance from the centre of mass for each axis.
    Body(f64, [f64; 3], [f64; 3]),
}

impl Load {
    /// Returns a random load, in half of all cases nothing.
    pub fn random(random: &mut Random) -> Self {
        let mass = 3.0 * (1 + random.below(3)) as f64;
        let place = [(); 3].map(|()| short(random));
        match random.below(4) {
            0 => Load::Particle(mass, place),
            1 => {
                let spread = [(); 3].map(|()| 0.5 + short(random).abs());
                Load::Body(mass, place, spread)
            }
            _ => Load::Nothing,
        }
    }

    /// Returns the masses with their positions in the frame.
    pub fn points(&self) -> Vec<(f64, [f64; 3])> {
        match *self {
            Load::Nothing => Vec::new(),
            Load::Particle(mass, place) => vec![(mass, place)],
            Load::Body(mass, centre, spread) => {
                let point = |i: usize| {
                    let mut place = centre;
                    place[i / 2] += [1.0, -1.0][i % 2] * spread[i / 2];
                    (mass / 6.0, place)
                };
                (0..6).map(point).collect()
            }
        }
    }

    /// Returns its statement.
    pub fn text(&self, frame: usize) -> Option<String> {
        match *self {
            Load::Nothing => None,
            Load::Particle(mass, place) => {
                Some(format!("particle mass {mass} at {place:?} on f{frame};"))
            }
            Load::Body(mass, centre, spread) => {
                // Exact to four digits if the mass is a multiple of three and the distances have two.
                let squares = spread.map(|s| mass / 3.0 * s * s);
                let total: f64 = squares.iter().sum();
                let exact = |moment: f64| (moment * 1e4).round() / 1e4;
                let [x, y, z] = squares.map(|square| exact(total - square));
                Some(format!(
                    "body on f{frame} {{ mass {mass}; com {centre:?}; inertia diag({x}, {y}, {z}) about com; }}"
                ))
            }
        }
    }
}

#[derive(Clone)]
pub struct Joint {
    /// The keyword of its kind.
    pub kind: &'static str,
    /// Its axis, of any length.
    pub axis: [f64; 3],
    /// The joint on whose frame it is mounted, or the world.
    pub on: Option<usize>,
    /// The origin of its frame, in the frame that it is mounted on.
    pub at: [f64; 3],
    /// The source of its motion.
    pub motion: Motion,
    /// The body or particle on its frame, if any.
    pub load: Load,
    /// Stiffness of its spring; 0 if it has none.
    pub stiffness: f64,
    /// The inertia of its drive.
    pub armature: f64,
}

impl Joint {
    /// Returns whether it has a coordinate.
    pub fn has_coordinate(&self) -> bool {
        !matches!(self.motion, Motion::Follows(_))
    }

    /// Returns its statement.
    pub fn text(&self, i: usize) -> String {
        let on = self.on.map_or(String::new(), |j| format!(" on f{j}"));
        let follows = match &self.motion {
            Motion::Follows(law) => format!(" follows {}", law.text()),
            _ => String::new(),
        };
        let armature = match self.armature {
            0.0 => ";".into(),
            armature => format!(" {{ armature {armature}; }}"),
        };
        let Joint { kind, axis, at, .. } = self;
        format!("joint j{i}: {kind} {axis:?}{on} at {at:?} moves f{i}{follows}{armature}")
    }
}

/// A closed loop; the constant closes it at the guesses.
#[derive(Clone)]
pub enum Loop {
    /// The value of a joint plus a law of others.
    Tie(usize, Law),
    /// A component of the difference of points in two frames, or in one and the world.
    Point([(Option<usize>, [f64; 3]); 2], usize),
}
