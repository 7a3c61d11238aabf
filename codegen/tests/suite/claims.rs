//! Attacks claims of invariance: random mechanisms with claims that are true by construction, and false twins of them.
//! Every true claim is accepted, and every false one is refused at its place.
//!
//! Momenta are those of a root on which neither gravity nor other loads act; energies require that nothing depends on
//! time; multiples of expressions that vanish on circles and on constraints may be added. In a twin, a number is
//! changed or a condition is missing. Both are checked numerically by the motion of a reference: a twin whose rate of
//! change is zero does not count.

mod mechanisms;
mod pieces;
mod surfaces;

use crate::common::{Random, attack, size};
use crate::jointed::System;
use hamel_codegen::generate::from_text;
use hamel_codegen::render::render;
use mechanisms::drawn;
use pieces::{Piece, View};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Least pivot, relative to the diagonal, of a matrix that counts as regular.
const MIN_PIVOT: f64 = 1e-3;
/// Rates of change below this, relative to those of the terms, count as 0.
const ZERO_TOLERANCE: f64 = 1e-9;
/// Rates of change above this cannot be rounding.
const CERTAIN_RATE: f64 = 1e-6;
/// Number of states at which claims are checked numerically.
const STATES_PER_SYSTEM: usize = 3;

/// The form in which a claim contains its terms.
#[derive(Clone, Copy)]
enum Form {
    Sum,
    Square,
    Logarithm,
}

#[derive(Clone)]
struct Claim {
    /// Its text, if it is a keyword claim such as `energy` instead of a sum of terms.
    named: Option<String>,
    pieces: Vec<Piece>,
    form: Form,
    /// The values of F and d in its conditions.
    when: [Option<f64>; 2],
}

impl Claim {
    fn new(pieces: Vec<Piece>) -> Self {
        Claim {
            named: None,
            pieces,
            form: Form::Sum,
            when: [None; 2],
        }
    }

    fn named(name: String, pieces: Vec<Piece>) -> Self {
        Claim {
            named: Some(name),
            ..Claim::new(pieces)
        }
    }

    fn text(&self, name: &str) -> String {
        let sum: Vec<String> = self.pieces.iter().map(Piece::text).collect();
        let sum = sum.join(" + ");
        let said = match (&self.named, self.form) {
            (Some(said), _) => said.clone(),
            (None, Form::Sum) => sum,
            (None, Form::Square) => format!("({sum})^2"),
            (None, Form::Logarithm) => format!("log(2 + ({sum})^2)"),
        };
        let values = ["F", "d"].iter().zip(self.when);
        let conditions: Vec<String> = values
            .filter_map(|(name, value)| Some(format!("{name} = {}", value?)))
            .collect();
        let when = match conditions.is_empty() {
            true => String::new(),
            false => format!(" when {}", conditions.join(", ")),
        };
        format!("invariant {name} = {said}{when};")
    }

    /// Returns the rate of change relative to those of the terms.
    fn rate(&self, system: &System, (q, v): &(Vec<f64>, Vec<f64>)) -> f64 {
        let mut system = system.clone();
        if let Some((_, values)) = &mut system.acted {
            for (value, set) in values.iter_mut().zip(self.when) {
                *value = set.unwrap_or(*value);
            }
        }
        let at = View::new(&system, q, v);
        let rates = self.pieces.iter().map(|piece| piece.rate(&at));
        let (sum, size) = rates.fold((0.0, 1.0), |(sum, size), rate: f64| {
            (sum + rate, size + rate.abs())
        });
        (sum / size).abs()
    }

    /// Returns the claim with a changed number or condition.
    fn twin(&self, random: &mut Random) -> Self {
        let mut twin = self.clone();
        let set: Vec<usize> = (0..2).filter(|&i| twin.when[i].is_some()).collect();
        if !set.is_empty() && (self.named.is_some() || random.below(3) == 0) {
            let place = set[random.below(set.len())];
            twin.when[place] = [None, Some(0.5)][random.below(2)];
            return twin;
        }
        // Keyword claims have no numbers to change.
        if twin.named.is_some() && random.below(2) == 0 {
            return twin;
        }
        twin.named = None;
        let place = random.below(twin.pieces.len());
        let factor = [-1.0, 2.0, 1.01, 0.5][random.below(4)];
        twin.pieces[place].factors.push(factor);
        twin
    }
}

/// Returns states that satisfy the constraints.
fn states(system: &System, random: &mut Random) -> Vec<(Vec<f64>, Vec<f64>)> {
    let mut all = Vec::new();
    for _ in 0..STATES_PER_SYSTEM {
        let near = system
            .start()
            .into_iter()
            .map(|q| q + 0.4 * random.number());
        let Some(q) = system.assembled(near.collect()) else {
            continue;
        };
        let v = system.moving(&q, random.numbers(system.own().len()));
        let (pivot, _, independent) = system.regularity(&q);
        if pivot > MIN_PIVOT && independent > MIN_PIVOT {
            all.push((q, v));
        }
    }
    all
}

/// Returns the largest rate of change of a claim at some states.
fn largest(claim: &Claim, system: &System, states: &[(Vec<f64>, Vec<f64>)]) -> f64 {
    let rates = states.iter().map(|state| claim.rate(system, state));
    rates.fold(0.0, f64::max)
}

/// Returns the lines of the refused claims in a text.
///
/// # Errors
/// Returns the rendered errors if one of them is not the refusal of a claim.
fn refused(text: &str) -> Result<Vec<usize>, String> {
    let Err(errors) = from_text(text) else {
        return Ok(Vec::new());
    };
    let mut lines = Vec::new();
    for error in &errors {
        let place = error.span.range().map(|range| range.start);
        let said = error.message.contains("is not constant along the motion");
        match place.filter(|_| said) {
            Some(place) => lines.push(text[..place].matches('\n').count()),
            None => return Err(render(&errors, "system", text, false)),
        }
    }
    Ok(lines)
}

/// Checks that the generator accepts all of `truths` and refuses each of `lies`; returns one text for each deviation.
fn faults_of(
    describe: impl Fn(&[String]) -> String,
    truths: &[String],
    lies: &[String],
) -> Vec<String> {
    let mut faults = Vec::new();
    let alone = describe(truths);
    match refused(&alone) {
        Ok(lines) if lines.is_empty() => {}
        Ok(lines) => {
            let text: Vec<&str> = alone.lines().collect();
            let refused = lines.iter().map(|&line| text[line].trim());
            let refused: Vec<&str> = refused.collect();
            faults.push(format!("true and refused: {refused:#?}\n{alone}"));
        }
        Err(said) => faults.push(format!("{said}\n{alone}")),
    }
    if lies.is_empty() {
        return faults;
    }
    // Inserts the false claims between the true ones.
    let mut claims = truths.to_vec();
    for (i, lie) in lies.iter().enumerate() {
        claims.insert((2 * i).min(claims.len()), lie.clone());
    }
    let text = describe(&claims);
    let lines = text.lines().enumerate();
    let expected: Vec<usize> = lines
        .filter(|(_, line)| lies.iter().any(|lie| line.contains(lie.as_str())))
        .map(|(i, _)| i)
        .collect();
    match refused(&text) {
        Ok(lines) if lines == expected => {}
        Ok(lines) => faults.push(format!(
            "lines {lines:?} are refused, those that are false are {expected:?}\n{text}"
        )),
        Err(said) => faults.push(format!("{said}\n{text}")),
    }
    faults
}

/// Checks the claims about one mechanism and returns one text for each deviation; adds the number of false claims to
/// `count`.
fn faults(seed: u64, count: &AtomicUsize) -> Vec<String> {
    let random = &mut Random::new(seed ^ 0xc1a1);
    let kept = drawn(random);
    let states = states(&kept.system, random);
    let (mut truths, mut lies) = (Vec::new(), Vec::new());
    for (i, claim) in kept.truths(random).iter().enumerate() {
        let largest = |claim: &Claim| largest(claim, &kept.system, &states);
        let text = claim.text(&format!("c{i}"));
        if largest(claim) > ZERO_TOLERANCE {
            let text = kept.system.text(&[text]);
            return vec![format!(
                "seed {seed}: not true in numbers: {}\n{text}",
                largest(claim)
            )];
        }
        truths.push(text);
        let twin = claim.twin(random);
        if largest(&twin) > CERTAIN_RATE {
            lies.push(twin.text(&format!("c{i}_false")));
        }
    }
    for (i, claim) in kept.doubtful(random).iter().enumerate() {
        if largest(claim, &kept.system, &states) > CERTAIN_RATE {
            lies.push(claim.text(&format!("w{i}")));
        }
    }
    count.fetch_add(lies.len(), Relaxed);
    let faults = faults_of(|claims| kept.system.text(claims), &truths, &lies);
    let faults = faults
        .into_iter()
        .map(|fault| format!("seed {seed}: {fault}"));
    faults.collect()
}

#[test]
fn true_claims_are_accepted_and_false_ones_refused() {
    let (few, many) = (12, 2000);
    let lies = AtomicUsize::new(0);
    attack(few, many, |seed| faults(seed, &lies));
    assert!(
        lies.into_inner() as u64 > size(few, many),
        "claims are hardly ever false"
    );
}
