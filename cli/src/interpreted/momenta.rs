//! The traits by which methods step momenta; a system that lacks their functions is refused before a
//! run begins.

use super::Interpreted;
use crate::failure::Failure;
use crate::singular::Failed;
use hamel::rotor::{Rotor, Symmetry};
use hamel::{Canonical, Singular, Split};
use hamel_codegen::program::Program;
use hamel_codegen::program::interpret::Interpreter;
use hamel_codegen::program::structure::{self, Inertia, Structure};

/// The functions of a system that splits, and those of generalised momenta.
#[derive(Default)]
pub struct Functions {
    rotors: Vec<Rotor<f64>>,
    centre: Option<Interpreter>,
    uncentre: Option<Interpreter>,
    momenta: Option<Interpreter>,
    velocities: Option<Interpreter>,
    kick: Option<Interpreter>,
    rate: Option<Interpreter>,
    velocity: Option<Interpreter>,
}

impl Functions {
    /// Those that a program has, for given parameters.
    pub fn new(program: &Program, params: &[f64]) -> Result<Self, Failure> {
        let function = |name: &str| {
            let function = program.function(name)?;
            Some(Interpreter::new(program, function, params))
        };
        let mut rotors = Vec::new();
        if let (Ok(splitting), Some(inertia)) =
            (&program.structure.split, function("rotor_inertia"))
        {
            let value = inertia.call(&[], &[], &[], &[]).unwrap_or_default();
            let mut numbers = value.into_iter();
            for form in &splitting.rotors {
                let entries = numbers.by_ref().take(form.inertia.entries());
                rotors.push(rotor(form.inertia, &entries.collect::<Vec<f64>>())?);
            }
        }
        Ok(Functions {
            rotors,
            centre: function("centre"),
            uncentre: function("uncentre"),
            momenta: function("split_momenta"),
            velocities: function("split_velocities"),
            kick: function("kick"),
            rate: function("momentum_rate"),
            velocity: function("velocity_from_momentum"),
        })
    }
}

fn rotor(inertia: Inertia, numbers: &[f64]) -> Result<Rotor<f64>, Failure> {
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
    rotor.map_err(|_| Failure::failed("an inertia has the wrong number of entries"))
}

/// The value of a function; NaN where there is none, which ends a run with an error.
fn value(function: Option<&Interpreter>, arguments: [&[f64]; 5], length: usize) -> Vec<f64> {
    let value = function.and_then(|function| function.call_with(arguments).ok());
    value.unwrap_or_else(|| vec![f64::NAN; length])
}

impl Interpreted {
    /// The structure with the symmetry that the inertias have for these parameters.
    pub fn structure(&self, program: &Program) -> Structure {
        let mut structure = program.structure.clone();
        if let Ok(splitting) = &mut structure.split {
            for (form, rotor) in splitting.rotors.iter_mut().zip(&self.functions.rotors) {
                form.inertia = Inertia::Principal(match rotor.symmetry {
                    Symmetry::Spherical => structure::Symmetry::Spherical,
                    Symmetry::Axial(axis) => structure::Symmetry::Axial(axis),
                    Symmetry::None => structure::Symmetry::None,
                });
            }
        }
        structure
    }
}

impl Split for Interpreted {
    type Rotors = Vec<Rotor<f64>>;

    // Known at run time only; the method `free` asks the structure.
    const FREE: bool = false;

    fn rotors(&self) -> Vec<Rotor<f64>> {
        self.functions.rotors.clone()
    }

    fn centre(&self, x: &Vec<f64>) -> Vec<f64> {
        match &self.functions.centre {
            Some(centre) => value(Some(centre), [x, &[], &[], &[], &[]], x.len()),
            None => x.clone(),
        }
    }

    fn uncentre(&self, y: &Vec<f64>) -> Vec<f64> {
        match &self.functions.uncentre {
            Some(uncentre) => value(Some(uncentre), [y, &[], &[], &[], &[]], y.len()),
            None => y.clone(),
        }
    }

    fn split_momenta(&self, x: &Vec<f64>, xi: &Vec<f64>) -> Vec<f64> {
        let momenta = self.functions.momenta.as_ref();
        value(momenta, [x, xi, &[], &[], &[]], self.chart)
    }

    fn split_velocities(&self, x: &Vec<f64>, p: &Vec<f64>) -> Vec<f64> {
        let velocities = self.functions.velocities.as_ref();
        value(velocities, [x, &[], &[], &[], p], p.len())
    }

    fn kick(&self, x: &Vec<f64>, u: &Vec<f64>) -> Vec<f64> {
        self.count();
        let kick = self.functions.kick.as_ref();
        value(kick, [x, &[], u, &[], &[]], self.chart)
    }
}

impl Canonical for Interpreted {
    fn momentum(&self, x: &Vec<f64>, xi: &Vec<f64>) -> Vec<f64> {
        Interpreted::momentum(self, x, xi)
    }

    fn momentum_rate(&self, x: &Vec<f64>, xi: &Vec<f64>, u: &Vec<f64>) -> Vec<f64> {
        self.count();
        let rate = self.functions.rate.as_ref();
        value(rate, [x, xi, u, &[], &[]], xi.len())
    }

    fn velocity_from_momentum(&self, x: &Vec<f64>, p: &Vec<f64>) -> Result<Vec<f64>, Singular> {
        match &self.functions.velocity {
            Some(velocity) => velocity.call_with([x, &[], &[], &[], p]).map_err(|_| {
                self.fails(Failed::Motion(x.clone()));
                Singular::Mass
            }),
            None => Ok(vec![f64::NAN; p.len()]),
        }
    }
}
