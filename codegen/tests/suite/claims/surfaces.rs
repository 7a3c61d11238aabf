//! Claims about a particle on a surface, with added terms that vanish on it; rates tangent to the surface; velocities
//! given twice, by rates and by their definition. Each with false twins.

use super::mechanisms::{of_law, value};
use super::pieces::{Piece, kinetic, moment, potential};
use super::{CERTAIN_RATE, Claim, Form, ZERO_TOLERANCE, faults_of, largest, states};
use crate::common::{Random, attack};
use crate::jet::Jet;
use crate::jointed::{Joint, Law, Load, Loop, Motion, Name, System, short};
use hamel_codegen::generate::from_text;

/// A particle on z + a (x² + y²) + b z² + c x z = constant, in a potential; c = 0 if the system is symmetric about the
/// vertical.
struct Surface {
    system: System,
    law: Law,
    round: bool,
}

const PARTICLE: f64 = 2.0;

impl Surface {
    fn random(random: &mut Random) -> Self {
        let round = random.below(2) == 0;
        let joint = |k: usize, stiffness: f64| {
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            Joint {
                kind: "prismatic",
                axis,
                on: k.checked_sub(1),
                at: [0.0; 3],
                motion: Motion::Free,
                load: match k {
                    2 => Load::Particle(PARTICLE, [0.0; 3]),
                    _ => Load::Nothing,
                },
                stiffness,
                armature: 0.0,
            }
        };
        let (level, steep) = ([0.0, 3.0][random.below(2)], [0.0, 5.0][random.below(2)]);
        let [x, y, z] = [0, 1, 2].map(Name::Joint);
        let across = short(random);
        let mut products = vec![(across, x, x), (across, y, y), (short(random), z, z)];
        if !round {
            products.push((short(random), x, z));
        }
        let law = Law {
            constant: 0.0,
            linear: Vec::new(),
            sine: None,
            products,
        };
        let mut system = System {
            joints: vec![joint(0, level), joint(1, level), joint(2, steep)],
            loops: Vec::new(),
            guess: vec![short(random), short(random), short(random)],
            gravity: [0.0, 0.0, -9.81],
            timed: false,
            rows: Vec::new(),
            acted: None,
        };
        let tie = Loop::Tie(2, law.clone());
        let constant = system.placed(&system.start()).closed(&tie).value;
        system.loops.push((tie, constant));
        Surface { system, law, round }
    }

    /// Returns the value of the function of the surface at the start, in exact decimals.
    fn constant(&self) -> String {
        let mut text = format!("(j2 + {})", self.law.text());
        for (i, guess) in self.system.guess.iter().enumerate() {
            text = text.replace(&format!("j{i}"), &format!("({guess})"));
        }
        text
    }

    /// Returns the gradient, optionally with a changed factor in one entry.
    fn slopes(&self, changed: Option<(usize, f64)>) -> [String; 3] {
        let products = &self.law.products;
        let [across, z] = [products[0].0, products[2].0];
        let oblique = products.get(3).map_or(0.0, |product| product.0);
        let mut factors = [2.0, 2.0, 2.0];
        if let Some((entry, factor)) = changed {
            factors[entry] = factor;
        }
        [
            format!("({} * {across} * j0 + {oblique} * j2)", factors[0]),
            format!("({} * {across} * j1)", factors[1]),
            format!("(1 + {} * {z} * j2 + {oblique} * j0)", factors[2]),
        ]
    }

    /// Returns the description, with the rates u₁ e₁ × ∇φ + u₂ e₂ × ∇φ.
    fn text(&self, slopes: [String; 3], claims: &[String]) -> String {
        let [x, y, z] = slopes;
        let mut lines = vec![
            "coord j0, j1, j2;".to_owned(),
            "velocity u1, u2;".to_owned(),
            format!("constraint j2 + {} = {};", self.law.text(), self.constant()),
            format!("rate j0 = u2 * {z}, j1 = -u1 * {z}, j2 = u1 * {y} - u2 * {x};"),
            "frame f2 = pose(identity(3), [j0, j1, j2]);".to_owned(),
            format!("particle mass {PARTICLE} at [0, 0, 0] on f2;"),
            "gravity [0, 0, -9.81];".to_owned(),
        ];
        for (i, joint) in self.system.joints.iter().enumerate() {
            lines.push(format!("spring stiffness {} on j{i};", joint.stiffness));
            lines.push(format!("start j{i} = {};", self.system.guess[i]));
        }
        lines.extend_from_slice(claims);
        format!("system S {{\n    {}\n}}\n", lines.join("\n    "))
    }

    /// Returns the terms of φ, times a velocity or a coordinate.
    fn vanishing(&self, random: &mut Random) -> Vec<Piece> {
        let one = |law: Law| of_law(&law, 1.0);
        let mut terms = vec![value(2)];
        for product in &self.law.products {
            let mut law = self.law.clone();
            law.products = vec![*product];
            terms.push(one(law));
        }
        let constant = self.system.loops[0].1;
        terms.push(Piece::constant(-1.0, self.constant(), constant));
        let entry = random.below(3);
        let factor = match random.below(2) {
            0 => value(entry),
            _ => Piece::speed((2, [0.0; 3]), entry),
        };
        terms.iter().map(|term| term.times(&factor)).collect()
    }

    fn truths(&self, random: &mut Random) -> Vec<Claim> {
        let mut energy = kinetic(&self.system, true);
        energy.extend(potential(&self.system));
        let mut all = vec![
            Claim::named("energy".into(), energy.clone()),
            Claim::new(energy.clone()),
            Claim::new(energy),
        ];
        if self.round {
            let upright = [0.0, 0.0, 1.0];
            let terms = moment(&self.system, [0.0; 3], upright);
            let name = format!("angular_momentum along {upright:?}");
            all.extend([Claim::named(name, terms.clone()), Claim::new(terms)]);
        }
        for claim in all.iter_mut().filter(|claim| claim.named.is_none()) {
            claim.pieces.extend(self.vanishing(random));
            claim.form = [Form::Sum, Form::Square, Form::Logarithm][random.below(3)];
        }
        all
    }
}

fn faults(seed: u64) -> Vec<String> {
    let random = &mut Random::new(seed ^ 0x5f);
    let surface = Surface::random(random);
    let states = states(&surface.system, random);
    let (mut truths, mut lies) = (Vec::new(), Vec::new());
    for (i, claim) in surface.truths(random).iter().enumerate() {
        let text = claim.text(&format!("c{i}"));
        let rate = largest(claim, &surface.system, &states);
        if rate > ZERO_TOLERANCE {
            return vec![format!("seed {seed}: not true in numbers: {rate}\n{text}")];
        }
        truths.push(text);
        let twin = claim.twin(random);
        if largest(&twin, &surface.system, &states) > CERTAIN_RATE {
            lies.push(twin.text(&format!("c{i}_false")));
        }
    }
    let describe = |claims: &[String]| surface.text(surface.slopes(None), claims);
    let faults = faults_of(describe, &truths, &lies);
    let mut faults: Vec<String> = faults
        .into_iter()
        .map(|fault| format!("seed {seed}: {fault}"))
        .collect();
    // A rate that leaves the surface.
    let text = surface.text(surface.slopes(Some((random.below(3), 1.5))), &truths);
    faults.extend(unless_refused(&text, "leaves a constraint", "rate "));
    faults
}

/// Returns a fault unless a description is refused, and all of its errors contain `why` and are at `statement`.
fn unless_refused(text: &str, why: &str, statement: &str) -> Option<String> {
    let errors = from_text(text).err().unwrap_or_default();
    let placed = errors.iter().all(|error| {
        let place = error.span.range().map_or(0, |range| range.start);
        let line = text[..place].matches('\n').count();
        let line = text.lines().nth(line).unwrap_or_default();
        error.message.contains(why) && line.trim().starts_with(statement)
    });
    let refused = placed && !errors.is_empty();
    (!refused).then(|| format!("{why} is not said of `{statement}`: {errors:?}\n{text}"))
}

/// Checks rates q̇ = A w with A in echelon form, and w by their definition, solved from the last one. In the false
/// twin, one entry of A has the other sign in the definition only.
fn frames(seed: u64) -> Vec<String> {
    let random = &mut Random::new(seed ^ 0xf4a);
    let n = 2 + random.below(3);
    let names: Vec<Name> = (0..n).map(Name::Joint).collect();
    let laws: Vec<Vec<Law>> = (0..n)
        .map(|i| (i + 1..n).map(|_| Law::random(random, &names)).collect())
        .collect();
    let entries: Vec<Vec<String>> = laws
        .iter()
        .map(|row| row.iter().map(|law| format!("({})", law.text())).collect())
        .collect();
    let pivots: Vec<String> = (0..n)
        .map(|i| match random.below(2) {
            0 => "2".into(),
            _ => format!("(2 + sin(j{}))", (i + 1) % n),
        })
        .collect();
    let changed = (0, random.below(n - 1));
    let describe = |sign: &str| {
        let mut lines = Vec::new();
        for i in 0..n {
            let mut rate = format!("{} * w{i}", pivots[i]);
            let mut rest = format!("rate(j{i})");
            for (k, factor) in entries[i].iter().enumerate() {
                let j = i + 1 + k;
                let sign = if (i, k) == changed { sign } else { "-" };
                rate += &format!(" + {factor} * w{j}");
                rest += &format!(" {sign} {factor} * {}", solved(&pivots, &entries, j));
            }
            lines.push(format!("coord j{i};"));
            lines.push(format!("velocity w{i} = ({rest}) / {};", pivots[i]));
            lines.push(format!("rate j{i} = {rate};"));
            lines.push(format!("kinetic w{i}^2 / 2;"));
        }
        format!("system F {{\n    {}\n}}\n", lines.join("\n    "))
    };
    let text = describe("-");
    let mut faults = Vec::new();
    if let Err(errors) = from_text(&text) {
        faults.push(format!("seed {seed}: {errors:?}\n{text}"));
    }
    // The sign matters only if the entry is not zero.
    let places = random.numbers(n);
    let value = laws[0][changed.1].value(|name| match name {
        Name::Joint(i) => Jet::number(places[i]),
        Name::Time => Jet::number(0.0),
    });
    if value.value.abs() > CERTAIN_RATE {
        let twin = describe("+");
        faults.extend(unless_refused(&twin, "Y A differs from I", "velocity "));
    }
    faults
}

/// Solves for a velocity in terms of the rates of its coordinate and of the following ones.
fn solved(pivots: &[String], entries: &[Vec<String>], i: usize) -> String {
    let mut text = format!("rate(j{i})");
    for (k, factor) in entries[i].iter().enumerate() {
        text += &format!(" - {factor} * {}", solved(pivots, entries, i + 1 + k));
    }
    format!("(({text}) / {})", pivots[i])
}

#[test]
fn claims_hold_on_the_surface_alone() {
    attack(8, 600, faults);
}

#[test]
fn velocities_that_are_given_twice_agree() {
    attack(8, 600, frames);
}
