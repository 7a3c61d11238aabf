//! `impl hamel::Split` and `impl hamel::Canonical`, where all that they consist of was generated.

use super::{Emitter, externals, structure};
use crate::program::structure::{Inertia, RotorForm, Symmetry};

/// The implementations for a type that implements `System`.
pub fn implementations(emitter: &Emitter) -> String {
    split(emitter).unwrap_or_default() + &canonical(emitter).unwrap_or_default()
}

/// The generated name of a function.
fn generated<'a>(emitter: &'a Emitter, name: &str) -> Option<&'a str> {
    let functions = emitter.program.functions.iter();
    let index = functions.into_iter().position(|f| f.name == name)?;
    emitter.names.functions.get(index).map(String::as_str)
}

fn head(emitter: &Emitter, of: &str, body: &str) -> String {
    format!(
        "{}impl{} ::hamel::{of} for {} {{\n{body}}}\n\n",
        structure::ALLOW_TRAIT,
        externals::generics(emitter),
        externals::applied(emitter)
    )
}

fn split(emitter: &Emitter) -> Option<String> {
    let splitting = emitter.program.structure.split.as_ref().ok()?;
    let [momenta, velocities, kick] = [
        generated(emitter, "split_momenta")?,
        generated(emitter, "split_velocities")?,
        generated(emitter, "kick")?,
    ];
    // Where no plain coordinate moves to a centre of mass, y is x.
    let moved = |name: &str, argument: &str| match generated(emitter, name) {
        Some(function) => format!("self.{function}({argument})"),
        None => format!("*{argument}"),
    };
    let (centre, uncentre) = (moved("centre", "x"), moved("uncentre", "y"));
    let rotors = rotors(emitter, &splitting.rotors)?;
    let body = format!(
        "type Rotors = [::hamel::Rotor<S>; {}];\n\nconst FREE: bool = {};\n\nfn rotors(&self) -> Self::Rotors {{\n{rotors}\n}}\n\n\
         fn centre(&self, x: &Self::Coordinates) -> Self::Coordinates {{\n{centre}\n}}\n\n\
         fn uncentre(&self, y: &Self::Coordinates) -> Self::Coordinates {{\n{uncentre}\n}}\n\n\
         fn split_momenta(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Chart {{\nself.{momenta}(x, xi)\n}}\n\n\
         fn split_velocities(&self, x: &Self::Coordinates, p: &Self::Chart) -> Self::Velocities {{\nself.{velocities}(x, p)\n}}\n\n\
         fn kick(&self, x: &Self::Coordinates, u: &Self::Inputs) -> Self::Chart {{\nself.{kick}(x, u)\n}}\n",
        splitting.rotors.len(),
        splitting.free,
    );
    Some(head(emitter, "Split", &body))
}

/// The rotors from the numbers of `rotor_inertia`, each with what is known of it.
fn rotors(emitter: &Emitter, forms: &[RotorForm]) -> Option<String> {
    if forms.is_empty() {
        return Some("[]".into());
    }
    let inertia = generated(emitter, "rotor_inertia")?;
    let mut place = 0;
    let rotors = forms.iter().map(|form| {
        let j: Vec<String> = (place..place + form.inertia.entries())
            .map(|index| format!("j[{index}]"))
            .collect();
        place += j.len();
        match form.inertia {
            Inertia::Principal(symmetry) => {
                let symmetry = match symmetry {
                    Symmetry::Spherical => "Spherical".into(),
                    Symmetry::Axial(axis) => format!("Axial({axis})"),
                    Symmetry::None => "None".into(),
                };
                format!(
                    "::hamel::Rotor::principal([{}], ::hamel::rotor::Symmetry::{symmetry})",
                    j.join(", ")
                )
            }
            Inertia::Moments => format!("::hamel::Rotor::of_moments([{}])", j.join(", ")),
            Inertia::General => format!("::hamel::Rotor::general([{}])", j.join(", ")),
        }
    });
    let rotors: Vec<String> = rotors.collect();
    Some(format!(
        "let j = self.{inertia}();\n[{}]",
        rotors.join(", ")
    ))
}

fn canonical(emitter: &Emitter) -> Option<String> {
    let program = emitter.program;
    // There ξ has no entries but velocities.
    if program.n_z > 0 {
        return None;
    }
    let [momentum, rate, velocity] = [
        generated(emitter, "momentum")?,
        generated(emitter, "momentum_rate")?,
        generated(emitter, "velocity_from_momentum")?,
    ];
    let fallible = program.function("velocity_from_momentum")?.fallible;
    let call = format!("self.{velocity}(x, p)");
    let call = if fallible {
        call
    } else {
        format!("Ok({call})")
    };
    let body = format!(
        "fn momentum(&self, x: &Self::Coordinates, xi: &Self::Velocities) -> Self::Velocities {{\nself.{momentum}(x, xi)\n}}\n\n\
         fn momentum_rate(&self, x: &Self::Coordinates, xi: &Self::Velocities, u: &Self::Inputs) -> Self::Velocities {{\nself.{rate}(x, xi, u)\n}}\n\n\
         fn velocity_from_momentum(&self, x: &Self::Coordinates, p: &Self::Velocities) -> ::core::result::Result<Self::Velocities, ::hamel::Singular> {{\n{call}\n}}\n",
    );
    Some(head(emitter, "Canonical", &body))
}
