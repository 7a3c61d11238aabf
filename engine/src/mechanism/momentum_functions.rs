//! Functions and trait implementations for methods that step momenta. A system without these functions is refused
//! before a run begins.

use super::functions::find_function;
use super::singular::FailedFunction;
use super::{FunctionIndex, Functions, Instance, Numbers};
use crate::error::Error;
use crate::run::Inputs;
use hamel::rotor::{Rotor, Symmetry};
use hamel::{Canonical, Singular, Split};
use hamel_codegen::program::Program;
use hamel_codegen::program::structure::{self, Inertia, Reason, Structure};
use hamel_native::Compiled;

/// Functions for splitting methods and for generalised momenta.
#[derive(Default)]
pub struct MomentumFunctions {
    forms: Vec<Inertia>,
    /// Whether kicks are ever nonzero.
    has_forces: bool,
    inertia: Option<FunctionIndex>,
    centre: Option<FunctionIndex>,
    uncentre: Option<FunctionIndex>,
    momenta: Option<FunctionIndex>,
    velocities: Option<FunctionIndex>,
    kick: Option<FunctionIndex>,
    rate: Option<FunctionIndex>,
    velocity: Option<FunctionIndex>,
}

/// Names of these functions.
pub const NAMES: &[&str] = &[
    "rotor_inertia",
    "centre",
    "uncentre",
    "split_momenta",
    "split_velocities",
    "kick",
    "momentum_rate",
    "velocity_from_momentum",
];

impl MomentumFunctions {
    /// Finds the functions that a program has.
    pub fn new(program: &Program, compiled: &Compiled) -> Self {
        let known = |name: &str| find_function(compiled, name);
        let split = program.structure.split.as_ref().ok();
        MomentumFunctions {
            forms: split.map_or_else(Vec::new, |splitting| {
                splitting.rotors.iter().map(|form| form.inertia).collect()
            }),
            has_forces: split.is_some_and(|splitting| !splitting.free),
            inertia: known("rotor_inertia"),
            centre: known("centre"),
            uncentre: known("uncentre"),
            momenta: known("split_momenta"),
            velocities: known("split_velocities"),
            kick: known("kick"),
            rate: known("momentum_rate"),
            velocity: known("velocity_from_momentum"),
        }
    }

    /// Returns the rotors for the parameters of the functions.
    pub fn rotors(&self, functions: &Functions) -> Result<Vec<Rotor<f64>>, Error> {
        let Some(inertia) = self.inertia else {
            return Ok(Vec::new());
        };
        let value = functions.call(inertia, [&[]; 5]);
        let mut numbers = value.iter().flat_map(|numbers| numbers.iter().copied());
        let mut one = |&form: &Inertia| {
            let entries: Vec<f64> = numbers.by_ref().take(form.entries()).collect();
            rotor(form, &entries)
        };
        self.forms.iter().map(&mut one).collect()
    }
}

fn rotor(inertia: Inertia, numbers: &[f64]) -> Result<Rotor<f64>, Error> {
    let symmetry = |symmetry| match symmetry {
        structure::Symmetry::Spherical => Symmetry::Spherical,
        structure::Symmetry::Axial(axis) => Symmetry::Axial(axis),
        structure::Symmetry::None => Symmetry::None,
    };
    let moments = <[f64; 3]>::try_from(numbers);
    let rotor = match inertia {
        Inertia::Principal(known) => {
            moments.map(|moments| Rotor::principal(moments, symmetry(known)))
        }
        Inertia::Moments => moments.map(Rotor::of_moments),
        Inertia::General => <[f64; 9]>::try_from(numbers).map(Rotor::general),
    };
    rotor.map_err(|_| Error::RotorInertia)
}

impl Instance {
    /// Evaluates a function; NaN, which ends a run with an error, if it does not exist.
    fn found(
        &self,
        function: Option<FunctionIndex>,
        arguments: [&[f64]; 5],
        length: usize,
    ) -> Numbers {
        let value = function.map(|function| self.functions.call(function, arguments));
        let value = value.and_then(Result::ok);
        value.unwrap_or_else(|| Numbers::filled(f64::NAN, length))
    }

    /// Returns the structure of the system, including the symmetries of the inertias for these parameters.
    pub fn structure(&self, program: &Program) -> Structure {
        let mut structure = program.structure.clone();
        if let Ok(splitting) = &mut structure.split {
            for (form, rotor) in splitting.rotors.iter_mut().zip(&self.rotors) {
                form.inertia = Inertia::Principal(match rotor.symmetry {
                    Symmetry::Spherical => structure::Symmetry::Spherical,
                    Symmetry::Axial(axis) => structure::Symmetry::Axial(axis),
                    Symmetry::None => structure::Symmetry::None,
                });
            }
        }
        if let Some(what) = self.varying_inputs().and_then(Inputs::moving) {
            moved(&mut structure, what);
        }
        structure
    }

    /// Returns the structure for choosing a method: an external controller is assumed to depend on velocities.
    pub fn structure_for_choice(&self, program: &Program) -> Structure {
        let mut structure = self.structure(program);
        if structure.split.is_ok() && self.varying_inputs().is_some_and(Inputs::is_law) {
            moved(&mut structure, "a controller".into());
        }
        structure
    }
}

/// Marks forces as dependent on velocities because of `what`, unless no force acts.
fn moved(structure: &mut Structure, what: String) {
    let reason = Reason::Velocities { what };
    match &mut structure.split {
        Ok(splitting) if splitting.free => return,
        Ok(_) => structure.split = Err(vec![reason.clone()]),
        Err(reasons) => reasons.push(reason.clone()),
    }
    structure.damped.push(reason);
}

impl Split for Instance {
    type Rotors = Vec<Rotor<f64>>;

    // Known only at run time; the method `free` checks the structure.
    const FREE: bool = false;

    fn rotors(&self) -> Vec<Rotor<f64>> {
        self.rotors.clone()
    }

    fn centre(&self, x: &Numbers) -> Numbers {
        match self.of.momenta.centre {
            Some(centre) => self.found(Some(centre), [x, &[], &[], &[], &[]], x.len()),
            None => x.clone(),
        }
    }

    fn uncentre(&self, y: &Numbers) -> Numbers {
        match self.of.momenta.uncentre {
            Some(uncentre) => self.found(Some(uncentre), [y, &[], &[], &[], &[]], y.len()),
            None => y.clone(),
        }
    }

    fn split_momenta(&self, x: &Numbers, xi: &Numbers) -> Numbers {
        self.found(
            self.of.momenta.momenta,
            [x, xi, &[], &[], &[]],
            self.of.chart,
        )
    }

    fn split_velocities(&self, x: &Numbers, p: &Numbers) -> Numbers {
        self.found(self.of.momenta.velocities, [x, &[], &[], &[], p], p.len())
    }

    fn kick(&self, x: &Numbers, u: &Numbers) -> Numbers {
        if self.of.momenta.has_forces {
            self.count();
        }
        self.found(self.of.momenta.kick, [x, &[], u, &[], &[]], self.of.chart)
    }
}

impl Canonical for Instance {
    fn momentum(&self, x: &Numbers, xi: &Numbers) -> Numbers {
        Instance::momentum(self, x, xi)
    }

    fn momentum_rate(&self, x: &Numbers, xi: &Numbers, u: &Numbers) -> Numbers {
        self.count();
        self.found(self.of.momenta.rate, [x, xi, u, &[], &[]], xi.len())
    }

    fn velocity_from_momentum(&self, x: &Numbers, p: &Numbers) -> Result<Numbers, Singular> {
        let arguments = [&**x, &[], &[], &[], p];
        match self.of.momenta.velocity {
            Some(velocity) => self.functions.call(velocity, arguments).map_err(|_| {
                self.record_failure(FailedFunction::Motion(x.to_vec()));
                Singular::Mass
            }),
            None => Ok(Numbers::filled(f64::NAN, p.len())),
        }
    }
}
