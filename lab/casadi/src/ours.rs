//! Generated systems behind one interface.

use crate::Kind;
use crate::measure::INPUTS;
use hamel::{Singular, System, manifold};
use std::hint::black_box;

/// A generated system with its inputs.
pub trait Model {
    fn name(&self) -> &str;
    fn freedoms(&self) -> usize;
    /// Returns x, ξ, and τ or ξ̇ of every input.
    fn inputs(&self, kind: Kind) -> Vec<[Vec<f64>; 3]>;
    fn results(&self, kind: Kind) -> Vec<Vec<f64>>;
    /// Evaluates all inputs `count` times. Results are read in place, as the peer's are: a copy of pairs of numbers
    /// that were stored one by one waits for the stores, which costs 5 ns.
    fn run(&self, kind: Kind, count: u32);
}

type Inverse<Sys> = fn(
    &Sys,
    &<Sys as System>::Coordinates,
    &<Sys as System>::Velocities,
    &<Sys as System>::Velocities,
) -> <Sys as System>::Velocities;

type Forward<Sys> = fn(
    &Sys,
    &<Sys as System>::Coordinates,
    &<Sys as System>::Velocities,
    &<Sys as System>::Inputs,
) -> Result<<Sys as System>::Velocities, Singular>;

struct Input<Sys: System> {
    x: Sys::Coordinates,
    xi: Sys::Velocities,
    u: Sys::Inputs,
    xi_dot: Sys::Velocities,
}

pub struct Generated<Sys: System> {
    name: &'static str,
    system: Sys,
    forward: Forward<Sys>,
    inverse: Option<Inverse<Sys>>,
    inputs: Vec<Input<Sys>>,
}

impl<Sys: System<Scalar = f64>> Generated<Sys> {
    pub fn new(name: &'static str, system: Sys, inverse: Option<Inverse<Sys>>) -> Self {
        let inputs = (0..INPUTS).map(|k| input(&system, k)).collect();
        let forward: Forward<Sys> = |system, x, xi, u| system.forward_dynamics(x, xi, u);
        Self {
            name,
            system,
            forward,
            inverse,
            inputs,
        }
    }
}

/// The start of the description displaced along its manifold, with different velocities and loads for every k.
fn input<Sys: System<Scalar = f64>>(system: &Sys, k: usize) -> Input<Sys> {
    let wave = |i: usize| ((k * 37 + i * 11) as f64 * 0.618).sin();
    let fill = |list: &mut [f64], first: usize| {
        for (i, entry) in list.iter_mut().enumerate() {
            *entry = wave(first + i);
        }
    };
    let (mut x, mut xi) = system.start();
    let (mut chart, mut u) = (system.zero_chart(), system.zero_inputs());
    let mut xi_dot = system.zero_velocities();
    fill(chart.as_mut(), 0);
    fill(xi.as_mut(), 100);
    fill(u.as_mut(), 200);
    fill(xi_dot.as_mut(), 300);
    manifold::retract(system.blocks(), x.as_mut(), chart.as_ref());
    Input { x, xi, u, xi_dot }
}

impl<Sys: System<Scalar = f64>> Model for Generated<Sys> {
    fn name(&self) -> &str {
        self.name
    }

    fn freedoms(&self) -> usize {
        self.system.zero_velocities().as_ref().len()
    }

    fn inputs(&self, kind: Kind) -> Vec<[Vec<f64>; 3]> {
        let list = |input: &Input<Sys>| {
            let last = match kind {
                Kind::Accel => input.u.as_ref(),
                Kind::Inverse => input.xi_dot.as_ref(),
            };
            [input.x.as_ref(), input.xi.as_ref(), last].map(<[f64]>::to_vec)
        };
        self.inputs.iter().map(list).collect()
    }

    fn results(&self, kind: Kind) -> Vec<Vec<f64>> {
        let system = &self.system;
        let result = |input: &Input<Sys>| match (kind, self.inverse) {
            (Kind::Inverse, Some(inverse)) => inverse(system, &input.x, &input.xi, &input.xi_dot)
                .as_ref()
                .to_vec(),
            _ => (self.forward)(system, &input.x, &input.xi, &input.u)
                .map_or_else(|_| Vec::new(), |xi_dot| xi_dot.as_ref().to_vec()),
        };
        self.inputs.iter().map(result).collect()
    }

    fn run(&self, kind: Kind, count: u32) {
        let (forward, inverse) = (black_box(self.forward), black_box(self.inverse));
        for _ in 0..count {
            let system = black_box(&self.system);
            match (kind, inverse) {
                (Kind::Inverse, Some(inverse)) => {
                    for input in &self.inputs {
                        let result = inverse(system, &input.x, &input.xi, &input.xi_dot);
                        black_box(&result);
                    }
                }
                _ => {
                    for input in &self.inputs {
                        let result = forward(system, &input.x, &input.xi, &input.u);
                        black_box(&result);
                    }
                }
            }
        }
    }
}

include!(concat!(env!("OUT_DIR"), "/models.rs"));
