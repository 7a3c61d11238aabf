//! Attacks tilted mounts: chains of hinges, sliders and ball joints behind products of constant rotations are compared
//! with d'Alembert's principle in numbers of 200 bits.
//!
//! M = Σ m Jᵥᵀ Jᵥ + J_ωᵀ Θ J_ω and h = Σ m Jᵥᵀ a + J_ωᵀ (Θ α + ω × Θ ω) at ξ̇ = 0, with Jacobians and accelerations of
//! absolute motion, link by link, independently of the generator. These descriptions contain many sines and cosines of
//! numbers, and roots of sums of their products; none may be refused or wrong. A few chains by default, dozens with
//! `HAMEL_ATTACK=more`, three thousand with `HAMEL_ATTACK=full`.

use crate::common::{Random, attack, value};
use crate::precise::{
    Matrix, Precise, Three, about, apply, cross, dot, identity, minus, normed, plus, product,
    scaled,
};
use hamel_codegen::generate::{Generated, from_text};
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::render::render;

/// Bound of the rounding of a program, relative to the size of the terms that it adds up.
const TOLERANCE: f64 = 1e-13;

fn zero() -> Precise {
    Precise::of(0.0)
}

fn origin() -> Three {
    std::array::from_fn(|_| zero())
}

fn unit(k: usize) -> Three {
    std::array::from_fn(|i| Precise::of(f64::from(u8::from(i == k))))
}

/// A text of the language with its value.
type Number = (String, Precise);

/// Returns a decimal as people write it: whole, with one digit, with three, or with all of them.
fn decimal(random: &mut Random) -> Number {
    let text = match random.below(4) {
        0 => format!("{}", random.below(7) as i64 - 3),
        1 => format!("{:.1}", 3.0 * random.number()),
        2 => format!("{:.3}", 3.0 * random.number()),
        _ => format!("{:.15}", 3.0 * random.number()),
    };
    (text.clone(), Precise::parse(&text))
}

/// The kind of angles in a chain: if all are of one kind, sines and cosines of the same number meet.
#[derive(Clone, Copy)]
enum Angles {
    Whole,
    Any,
    Decimal,
    PartOfPi,
    NearPi,
    Degrees,
}

/// Returns an angle: a decimal, a multiple of π, close to one, or degrees.
fn angle(random: &mut Random, angles: Angles) -> Number {
    let pi = Precise::pi();
    let kind = match angles {
        Angles::Any => 1 + random.below(6),
        kind => kind as usize,
    };
    match kind {
        0 => {
            let text = format!("{}", random.below(7) as i64 - 3);
            (text.clone(), Precise::parse(&text))
        }
        1 | 2 => decimal(random),
        3 => {
            let (part, whole) = ([1, 2, 3, 4, 6][random.below(5)], random.below(9) as i64 - 4);
            let value = &(&Precise::of(whole as f64) * &pi) / &Precise::of(f64::from(part));
            (format!("{whole} * pi / {part}"), value)
        }
        4 if random.below(2) == 0 => {
            let digits = 1 + random.below(9);
            let halves = 1 + random.below(4);
            let near = halves as f64 * std::f64::consts::FRAC_PI_2;
            let text = format!("{near:.digits$}");
            (text.clone(), Precise::parse(&text))
        }
        4 => {
            let power = 1 + random.below(9);
            let sign = ["+", "-"][random.below(2)];
            let step = Precise::parse(&format!("{sign}1e-{power}").replace('+', ""));
            (format!("(pi {sign} 1e-{power})"), &pi + &step)
        }
        _ => {
            let degrees = random.below(361) as i64 - 180;
            let value = &(&Precise::of(degrees as f64) * &pi) / &Precise::of(180.0);
            (format!("{degrees} * pi / 180"), value)
        }
    }
}

fn rotation(random: &mut Random, angles: Angles) -> (String, Matrix) {
    let one = |k: usize, angle: &Precise| about(&unit(k), &angle.cos(), &angle.sin());
    match random.below(4) {
        3 => {
            let [r, p, y] = [(); 3].map(|()| angle(random, angles));
            let turned = product(&one(2, &y.1), &product(&one(1, &p.1), &one(0, &r.1)));
            (format!("rpy({}, {}, {})", r.0, p.0, y.0), turned)
        }
        k => {
            let (text, value) = angle(random, angles);
            let name = ["rotx", "roty", "rotz"][k];
            (format!("{name}({text})"), one(k, &value))
        }
    }
}

/// Returns a product of one to four constant rotations.
fn turn(random: &mut Random, angles: Angles) -> (String, Matrix) {
    let (mut text, mut turn) = rotation(random, angles);
    for _ in 0..random.below(4) {
        let (factor, matrix) = rotation(random, angles);
        text = format!("{text} * {factor}");
        turn = product(&turn, &matrix);
    }
    (text, turn)
}

fn three(random: &mut Random) -> (String, Three) {
    let [a, b, c] = [(); 3].map(|()| decimal(random));
    (format!("[{}, {}, {}]", a.0, b.0, c.0), [a.1, b.1, c.1])
}

/// Returns a symmetric positive definite matrix that satisfies the triangle inequalities.
fn inertia(random: &mut Random) -> (String, Matrix) {
    let diagonal: [String; 3] =
        std::array::from_fn(|_| format!("{:.2}", 1.5 + 0.3 * random.number()));
    let off: [String; 3] = std::array::from_fn(|_| match random.below(2) {
        0 => "0".into(),
        _ => format!("{:.3}", 0.2 * random.number()),
    });
    let entry = |i: usize, j: usize| match (i, j) {
        (i, j) if i == j => diagonal[i].clone(),
        (i, j) => off[i + j - 1].clone(),
    };
    let rows: [[String; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
    let text = rows.iter().map(|row| format!("[{}]", row.join(", ")));
    let text = format!("[{}]", text.collect::<Vec<_>>().join(", "));
    (
        text,
        rows.map(|row| row.map(|entry| Precise::parse(&entry))),
    )
}

enum Joint {
    Hinge(Three),
    Slider(Three),
    Ball,
}

impl Joint {
    fn random(random: &mut Random) -> (String, Joint) {
        const AXES: [[i32; 3]; 6] = [
            [0, 0, 1],
            [0, 0, 1],
            [0, 1, 0],
            [1, 0, 0],
            [1, 1, 0],
            [2, -1, 3],
        ];
        let axis = AXES[random.below(AXES.len())];
        let direction = normed(&axis.map(|entry| Precise::of(f64::from(entry))));
        match random.below(8) {
            0 => (format!("prismatic {axis:?}"), Joint::Slider(direction)),
            1 => ("spherical".into(), Joint::Ball),
            _ => (format!("revolute {axis:?}"), Joint::Hinge(direction)),
        }
    }

    fn freedoms(&self) -> usize {
        match self {
            Joint::Ball => 3,
            _ => 1,
        }
    }

    /// Returns a configuration: an angle, a length, or a rotation matrix by rows.
    fn configuration(&self, random: &mut Random) -> Vec<f64> {
        match self {
            Joint::Ball => random.configuration(&[hamel_codegen::model::layout::Block::Rotation]),
            _ => vec![3.0 * random.number()],
        }
    }
}

struct Link {
    joint: Joint,
    turn: Matrix,
    place: Three,
    mass: Precise,
    com: Three,
    inertia: Matrix,
}

/// A spring ½ k (ℓ − l)² between a point of a link and one of the world.
struct Spring {
    link: usize,
    stiffness: Precise,
    length: Precise,
    from: Three,
    to: Three,
}

struct Chain {
    text: String,
    links: Vec<Link>,
    gravity: Three,
    springs: Vec<Spring>,
}

/// The motion of a link, in world axes.
struct Moving {
    frame: Matrix,
    origin: Three,
    omega: Three,
    alpha: Three,
    acceleration: Three,
}

/// One velocity of a joint: a rotation about an axis through a point, or a translation.
enum Freedom {
    Turn { axis: Three, through: Three },
    Slide { along: Three },
}

impl Freedom {
    fn point_velocity(&self, point: &Three) -> Three {
        match self {
            Freedom::Turn { axis, through } => cross(axis, &minus(point, through)),
            Freedom::Slide { along } => along.clone(),
        }
    }

    fn angular_velocity(&self) -> Three {
        match self {
            Freedom::Turn { axis, .. } => axis.clone(),
            Freedom::Slide { .. } => origin(),
        }
    }
}

fn transposed(r: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| r[j][i].clone()))
}

/// M, h and ∂V of a chain.
struct Dynamics {
    mass: Vec<Vec<Precise>>,
    bias: Vec<Precise>,
    slope: Vec<Precise>,
}

impl Chain {
    fn random(seed: u64) -> Self {
        let random = &mut Random::new(seed);
        let count = 1 + random.below(3) + random.below(4);
        const KINDS: [Angles; 7] = [
            Angles::Whole,
            Angles::Whole,
            Angles::Any,
            Angles::Decimal,
            Angles::PartOfPi,
            Angles::NearPi,
            Angles::Degrees,
        ];
        let angles = KINDS[random.below(KINDS.len())];
        let (mut lines, mut links, mut springs) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..count {
            let (joint_text, joint) = Joint::random(random);
            let (turn_text, turn) = turn(random, angles);
            let (place_text, place) = three(random);
            let on = match k {
                0 => String::new(),
                _ => format!(" on f{}", k - 1),
            };
            lines.push(format!(
                "joint j{k}: {joint_text}{on} at pose({turn_text}, {place_text}) moves f{k};"
            ));
            let ((com_text, com), (inertia_text, inertia)) = (three(random), inertia(random));
            let mass = 1 + random.below(4);
            lines.push(format!(
                "body on f{k} {{ mass {mass}; com {com_text}; inertia {inertia_text} about com; }}"
            ));
            if random.below(4) == 0 {
                let ((from_text, from), (to_text, to)) = (three(random), three(random));
                lines.push(format!(
                    "spring stiffness 3 length 0.5 from {from_text} on f{k} to {to_text} on world;"
                ));
                springs.push(Spring {
                    link: k,
                    stiffness: Precise::of(3.0),
                    length: Precise::of(0.5),
                    from,
                    to,
                });
            }
            links.push(Link {
                joint,
                turn,
                place,
                mass: Precise::of(mass as f64),
                com,
                inertia,
            });
        }
        let (gravity_text, gravity) = three(random);
        lines.push(format!("gravity {gravity_text};"));
        let text = format!("system Chain {{\n    {}\n}}\n", lines.join("\n    "));
        Chain {
            text,
            links,
            gravity,
            springs,
        }
    }

    fn freedoms(&self) -> usize {
        self.links.iter().map(|link| link.joint.freedoms()).sum()
    }

    /// Returns the motion of each link at ξ̇ = 0, with the degrees of freedom of its joint.
    fn motion(&self, x: &[Precise], xi: &[Precise]) -> Vec<(Moving, Vec<Freedom>)> {
        let (mut x, mut xi) = (x, xi);
        let mut all: Vec<(Moving, Vec<Freedom>)> = Vec::new();
        let world = Moving {
            frame: identity(),
            origin: origin(),
            omega: origin(),
            alpha: origin(),
            acceleration: origin(),
        };
        for link in &self.links {
            let before = all.last().map_or(&world, |(moving, _)| moving);
            let arm = apply(&before.frame, &link.place);
            let place = plus(&before.origin, &arm);
            let axes = product(&before.frame, &link.turn);
            let carried = |arm: &Three| -> Three {
                let tangential = cross(&before.alpha, arm);
                let centripetal = cross(&before.omega, &cross(&before.omega, arm));
                plus(&before.acceleration, &plus(&tangential, &centripetal))
            };
            let (moving, freedoms) = match &link.joint {
                Joint::Hinge(axis) => {
                    let axis_in_world = apply(&axes, axis);
                    let spin = scaled(&xi[0], &axis_in_world);
                    let moving = Moving {
                        frame: product(&axes, &about(axis, &x[0].cos(), &x[0].sin())),
                        acceleration: carried(&arm),
                        omega: plus(&before.omega, &spin),
                        alpha: plus(&before.alpha, &cross(&before.omega, &spin)),
                        origin: place.clone(),
                    };
                    let turn = Freedom::Turn {
                        axis: axis_in_world,
                        through: place,
                    };
                    (moving, vec![turn])
                }
                Joint::Slider(axis) => {
                    let along = apply(&axes, axis);
                    let arm = plus(&arm, &scaled(&x[0], &along));
                    let speed = scaled(&xi[0], &along);
                    let coriolis = scaled(&Precise::of(2.0), &cross(&before.omega, &speed));
                    let moving = Moving {
                        origin: plus(&before.origin, &arm),
                        acceleration: plus(&carried(&arm), &coriolis),
                        frame: axes,
                        omega: before.omega.clone(),
                        alpha: before.alpha.clone(),
                    };
                    (moving, vec![Freedom::Slide { along }])
                }
                Joint::Ball => {
                    let turn: Matrix =
                        std::array::from_fn(|i| std::array::from_fn(|j| x[3 * i + j].clone()));
                    let frame = product(&axes, &turn);
                    let own: Three = std::array::from_fn(|k| xi[k].clone());
                    let spin = apply(&frame, &own);
                    let moving = Moving {
                        acceleration: carried(&arm),
                        omega: plus(&before.omega, &spin),
                        // The components of the spin are constant in the link's axes.
                        alpha: plus(&before.alpha, &cross(&before.omega, &spin)),
                        origin: place.clone(),
                        frame,
                    };
                    let turns = (0..3).map(|k| Freedom::Turn {
                        axis: apply(&moving.frame, &unit(k)),
                        through: place.clone(),
                    });
                    let turns = turns.collect();
                    (moving, turns)
                }
            };
            let coordinates = match link.joint {
                Joint::Ball => 9,
                _ => 1,
            };
            (x, xi) = (&x[coordinates..], &xi[link.joint.freedoms()..]);
            all.push((moving, freedoms));
        }
        all
    }

    fn dynamics(&self, x: &[Precise], xi: &[Precise]) -> Dynamics {
        let n = self.freedoms();
        let mut of = Dynamics {
            mass: vec![vec![zero(); n]; n],
            bias: vec![zero(); n],
            slope: vec![zero(); n],
        };
        let motion = self.motion(x, xi);
        for (k, (link, (moving, _))) in self.links.iter().zip(&motion).enumerate() {
            let freedoms: Vec<&Freedom> = motion[..=k].iter().flat_map(|(_, own)| own).collect();
            let back = transposed(&moving.frame);
            let of_inertia = |v: &Three| -> Three {
                apply(&moving.frame, &apply(&link.inertia, &apply(&back, v)))
            };
            let arm = apply(&moving.frame, &link.com);
            let centre = plus(&moving.origin, &arm);
            let centripetal = cross(&moving.omega, &cross(&moving.omega, &arm));
            let acceleration = plus(
                &moving.acceleration,
                &plus(&cross(&moving.alpha, &arm), &centripetal),
            );
            let gyroscopic = cross(&moving.omega, &of_inertia(&moving.omega));
            let torque = plus(&of_inertia(&moving.alpha), &gyroscopic);
            for (i, one) in freedoms.iter().enumerate() {
                let (v, w) = (one.point_velocity(&centre), one.angular_velocity());
                let force = &(&link.mass * &dot(&v, &acceleration)) + &dot(&w, &torque);
                of.bias[i] = &of.bias[i] + &force;
                of.slope[i] = &of.slope[i] - &(&link.mass * &dot(&v, &self.gravity));
                let momentum = of_inertia(&w);
                for (j, other) in freedoms.iter().enumerate() {
                    let linear = &link.mass * &dot(&v, &other.point_velocity(&centre));
                    let entry = &linear + &dot(&momentum, &other.angular_velocity());
                    of.mass[i][j] = &of.mass[i][j] + &entry;
                }
            }
            for spring in self.springs.iter().filter(|spring| spring.link == k) {
                let end = plus(&moving.origin, &apply(&moving.frame, &spring.from));
                let line = minus(&end, &spring.to);
                let length = dot(&line, &line).sqrt();
                let pull = &(&spring.stiffness * &(&length - &spring.length)) / &length;
                for (i, one) in freedoms.iter().enumerate() {
                    let along = dot(&line, &one.point_velocity(&end));
                    of.slope[i] = &of.slope[i] + &(&pull * &along);
                }
            }
        }
        of
    }
}

fn numbers(values: &[Precise]) -> Vec<f64> {
    values.iter().map(Precise::to_f64).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

/// Derives a chain and compares its numbers with the definition; returns an error if it is refused or a number differs.
fn verdict(chain: &Chain, seed: u64) -> Result<(), String> {
    let of: Generated = match from_text(&chain.text) {
        Ok(of) => of,
        // Correctly refused: the end of a spring on the axis of the first hinge is at rest.
        Err(errors)
            if errors.iter().all(|e| {
                e.message
                    .contains("the distance between its endpoints never changes")
            }) =>
        {
            return Ok(());
        }
        Err(errors) => return Err(render(&errors, "chain", &chain.text, false)),
    };
    let n = chain.freedoms();
    let mut random = Random::new(seed ^ 0xf00d);
    for _ in 0..2 {
        let joints = chain.links.iter().map(|link| &link.joint);
        let x: Vec<f64> = joints
            .flat_map(|joint| joint.configuration(&mut random))
            .collect();
        let xi = random.numbers(n);
        let precise =
            |list: &[f64]| -> Vec<Precise> { list.iter().map(|&v| Precise::of(v)).collect() };
        let expected = chain.dynamics(&precise(&x), &precise(&xi));
        let mass: Vec<f64> = expected.mass.iter().flat_map(|row| numbers(row)).collect();
        let (bias, slope) = (numbers(&expected.bias), numbers(&expected.slope));
        let scale = largest(&mass).max(1.0);
        let weight = largest(&numbers(&chain.gravity)).max(3.0);
        let compare = |name: &str, expected: &[f64], scale: f64| {
            let found = value(&of, name, [&x, &xi, &[], &[]]);
            let differences = expected.iter().zip(&found).map(|(a, b)| (a - b).abs());
            // False for NaN as well.
            if differences
                .clone()
                .all(|difference| difference <= TOLERANCE * scale)
            {
                return Ok(());
            }
            let most = differences.fold(0.0, f64::max);
            Err(format!(
                "{name} at {x:?}, {xi:?}: off by {most:e} of {scale:e}: {found:?}, not {expected:?}"
            ))
        };
        compare("mass_matrix", &mass, scale)?;
        compare("bias", &bias, scale * n as f64)?;
        compare("potential_force", &slope, scale * weight * 4.0)?;
        let function = of.program.function("accel").expect("it was asked for");
        let compiled = Interpreter::new(&of.program, function, &of.program.defaults);
        let accel = compiled
            .call_with([&x, &xi, &[], &[], &[]])
            .map_err(|pivot| format!("accel at {x:?}: pivot {pivot} is refused"))?;
        // M ξ̇ + h + ∂V = 0 up to the rounding of a stable solution.
        let force = scale * largest(&accel) + largest(&bias) + largest(&slope) + scale;
        for i in 0..n {
            let row = (0..n).map(|j| mass[i * n + j] * accel[j]).sum::<f64>();
            let rest = row + bias[i] + slope[i];
            if rest.is_nan() || rest.abs() > 10.0 * TOLERANCE * force {
                return Err(format!(
                    "accel at {x:?}, {xi:?}: {accel:?} leaves {rest:e} of {force:e}"
                ));
            }
        }
    }
    Ok(())
}

#[test]
fn chains_behind_products_of_constant_rotations() {
    attack(8, 3000, |seed| {
        let chain = Chain::random(seed);
        let fault = verdict(&chain, seed).err();
        let said = fault.map(|fault| format!("seed {seed}: {fault}\n{}", chain.text));
        said.into_iter().collect()
    });
}

/// One hinge behind three mounts, in closed form: its axis is tilted by 2 rad from the vertical, M = Θ + m s² = 2.
#[test]
fn a_tilted_hinge_is_a_pendulum() {
    let text = "system TiltedHinge {
        frame mount = pose(rotz(1) * rotx(-1), [0, 0, 0]);
        joint j: revolute [0, 0, 1] on mount at pose(rotx(3) * rotz(1), [0, 0, 0]) moves rod;
        body on rod { mass 1; com [1, 0, 0]; inertia diag(0, 0, 1) about com; }
        gravity [0, 0, -10];
    }";
    let of =
        from_text(text).unwrap_or_else(|errors| panic!("{}", render(&errors, "", text, false)));
    for q in [0.0_f64, 0.4, -2.5] {
        let state = [&[q][..], &[0.7], &[], &[]];
        assert!((value(&of, "mass_matrix", state)[0] - 2.0).abs() < 1e-14);
        assert!(value(&of, "bias", state)[0].abs() < 1e-14);
        // z of the tip is sin(q + 1) sin 2
        let slope = 10.0 * 2.0_f64.sin() * (q + 1.0).cos();
        assert!((value(&of, "potential_force", state)[0] - slope).abs() < 1e-14);
    }
}

/// A mount rotated by almost π; M at rest by d'Alembert's principle.
#[test]
fn a_mount_that_is_almost_turned_over() {
    let text = "system T {
        joint j1: revolute [0, 0, 1] moves l1;
        joint j2: revolute [0, 0, 1] on l1 at pose(rotx(pi / 2), [0, 0, 0]) moves l2;
        joint j3: revolute [0, 0, 1] on l2 at pose(rpy(3.14, 0, 0.0003), [0.3, 0.004, 0]) moves l3;
        body on l3 { mass 1; com [0.2, 0.1, 0.3]; inertia diag(1, 0.9, 0.8) about com; }
    }";
    let of =
        from_text(text).unwrap_or_else(|errors| panic!("{}", render(&errors, "", text, false)));
    let mass = value(&of, "mass_matrix", [&[0.0; 3][..], &[0.0; 3], &[], &[]]);
    let expected = [
        1.23993413,
        -0.02906917,
        0.02853265,
        1.05932675,
        -0.90965586,
        0.85,
    ];
    for (place, expected) in [0, 1, 2, 4, 5, 8].into_iter().zip(expected) {
        assert!((mass[place] - expected).abs() < 1e-8, "{mass:?}");
    }
}
