//! Every generated system at pseudo-random states, as a trait object.

use super::lists::{assert_close, largest};
use crate::derived;
use hamel::methods::Rkmk4;
use hamel::{Block, Singular, State, System, manifold};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Number of states per system and law.
const STATES_PER_LAW: u64 = 24;
/// The inputs are halved while accelerations exceed this (SI units), at most this often, so that motions are smooth on
/// the scale of differences.
const MAX_ACCELERATION: f64 = 1e3;
const MAX_INPUT_HALVINGS: usize = 12;
/// Tolerance of f32 against f64: 6e-8 of rounding times the operations and the condition of M.
const F32_TOLERANCE: f64 = 1e-4;

/// A system at a state, with lists of any length. Functions without arguments are evaluated at the state.
pub trait Point {
    /// Name and seed.
    fn label(&self) -> &str;
    fn x(&self) -> &[f64];
    fn xi(&self) -> &[f64];
    fn accel(&self) -> Vec<f64>;
    fn load(&self) -> Vec<f64>;
    fn rate(&self, x: &[f64], xi: &[f64]) -> Vec<f64>;
    fn chart_rate(&self) -> Vec<f64>;
    fn retracted(&self, u: &[f64]) -> Vec<f64>;
    fn correction(&self, x: &[f64]) -> Vec<f64>;
    fn mass(&self, x: &[f64]) -> Vec<Vec<f64>>;
    fn bias(&self) -> Vec<f64>;
    fn slope(&self) -> Vec<f64>;
    fn momentum(&self, x: &[f64], xi: &[f64]) -> Vec<f64>;
    fn momentum_rate(&self) -> Vec<f64>;
    fn velocity_of(&self, momentum: &[f64]) -> Vec<f64>;
    fn needed(&self, xi_dot: &[f64]) -> Vec<f64>;
    fn kinetic(&self, x: &[f64]) -> f64;
    fn potential(&self, x: &[f64]) -> f64;
    fn energy(&self) -> f64;
    fn phi(&self, x: &[f64]) -> Vec<f64>;
    /// T + V after a time h, with constant inputs.
    fn energy_after(&self, h: f64) -> f64;
    /// Numbers in ±1, different for every state.
    fn random(&self, count: usize) -> Vec<f64>;
}

/// A system, a state on its manifold, and inputs.
struct At<Sys: System> {
    label: String,
    system: Sys,
    state: State<Sys>,
    inputs: Sys::Inputs,
    random: Random,
}

/// The generator SplitMix64.
#[derive(Clone)]
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn fill(&mut self, list: &mut [f64], size: f64) {
        list.iter_mut().for_each(|v| *v = size * self.number());
    }
}

impl<Sys: System<Scalar = f64> + Default> At<Sys> {
    /// Starts from a random displacement of the start along circles and rotations, then moves along a random constant
    /// ξ, so that plain coordinates satisfy their constraints.
    fn new(name: &str, seed: u64) -> Self {
        let system = Sys::default();
        let mut random = Random(seed);
        let mut tries = 0;
        let state = loop {
            tries += 1;
            assert!(tries < 1000, "{name}: no state was found");
            let mut state = Self::random_state(&system, &mut random);
            let usual = largest(&columns(&system, &State::start(&system).x).concat());
            let moderate = largest(&columns(&system, &state.x).concat()) <= 2.0 * usual.max(1.0);
            // A linkage may have reached its other assembly, in which the kinematics are refused.
            let assembled = system.forward_dynamics(&state.x, &state.xi, &system.zero_inputs());
            let assembled = !matches!(assembled, Err(Singular::Kinematics { .. }));
            if moderate && assembled {
                random.fill(state.xi.as_mut(), 2.0);
                break state;
            } // otherwise the frame A is near one of its poles (1/ρ), where differences are inaccurate
        };
        let mut inputs = system.zero_inputs();
        random.fill(inputs.as_mut(), 2.0);
        // Light parts get small inputs.
        for _ in 0..MAX_INPUT_HALVINGS {
            let accel = system.forward_dynamics(&state.x, &state.xi, &inputs);
            if accel.is_ok_and(|accel| largest(accel.as_ref()) <= MAX_ACCELERATION) {
                break;
            }
            inputs.as_mut().iter_mut().for_each(|u| *u *= 0.5);
        }
        let label = format!("{name}, seed {seed}");
        Self {
            label,
            system,
            state,
            inputs,
            random,
        }
    }

    fn random_state(system: &Sys, random: &mut Random) -> State<Sys> {
        let mut state = State::start(system);
        let mut u = system.zero_chart();
        let mut rest = u.as_mut();
        for block in system.blocks() {
            let (here, others) = rest.split_at_mut(block.chart());
            if !matches!(block, Block::Flat(_)) {
                random.fill(here, 2.0);
            }
            rest = others;
        }
        let blocks = system.blocks();
        manifold::retract(blocks, state.x.as_mut(), u.as_ref());
        random.fill(state.xi.as_mut(), 1.5);
        let steps = 50;
        for _ in 0..steps {
            let mut u = system.chart_rate(&state.x, &state.xi);
            let step = 1.0 / f64::from(steps);
            u.as_mut().iter_mut().for_each(|u| *u *= step);
            manifold::retract(blocks, state.x.as_mut(), u.as_ref());
            for _ in 0..3 {
                let correction = system.correction(&state.x);
                for (x, c) in state.x.as_mut().iter_mut().zip(correction.as_ref()) {
                    *x += c;
                }
            }
        }
        state
    }
}

/// Returns the columns of A.
fn columns<Sys: System<Scalar = f64>>(system: &Sys, x: &Sys::Coordinates) -> Vec<Vec<f64>> {
    let count = system.zero_velocities().as_ref().len();
    (0..count)
        .map(|i| {
            let mut unit = system.zero_velocities();
            unit.as_mut()[i] = 1.0;
            system.rate(x, &unit).as_ref().to_vec()
        })
        .collect()
}

fn array<const N: usize>(list: &[f64]) -> [f64; N] {
    list.try_into().expect("as many numbers as the system has")
}

macro_rules! models {
    ($($module:ident::$name:ident,)+) => {
        const MODELS: &[&str] = &[$(stringify!($module)),+];

        $(impl Point for At<hamel_tests::$module::$name<f64>> {
            fn label(&self) -> &str {
                &self.label
            }
            fn x(&self) -> &[f64] {
                &self.state.x
            }
            fn xi(&self) -> &[f64] {
                &self.state.xi
            }
            fn accel(&self) -> Vec<f64> {
                let accel = self.system.accel(&self.state.x, &self.state.xi, &self.inputs);
                accel.expect(&self.label).to_vec()
            }
            fn load(&self) -> Vec<f64> {
                let State { x, xi, .. } = &self.state;
                self.system.generalized_force(x, xi, &self.inputs).to_vec()
            }
            fn rate(&self, x: &[f64], xi: &[f64]) -> Vec<f64> {
                self.system.rate(&array(x), &array(xi)).to_vec()
            }
            fn chart_rate(&self) -> Vec<f64> {
                self.system.chart_rate(&self.state.x, &self.state.xi).to_vec()
            }
            fn retracted(&self, u: &[f64]) -> Vec<f64> {
                let mut x = self.state.x;
                manifold::retract(self.system.blocks(), &mut x, u);
                x.to_vec()
            }
            fn correction(&self, x: &[f64]) -> Vec<f64> {
                self.system.correction(&array(x)).to_vec()
            }
            fn mass(&self, x: &[f64]) -> Vec<Vec<f64>> {
                let mass = self.system.mass_matrix(&array(x));
                mass.iter().map(|row| row.to_vec()).collect()
            }
            fn bias(&self) -> Vec<f64> {
                self.system.bias(&self.state.x, &self.state.xi).to_vec()
            }
            fn slope(&self) -> Vec<f64> {
                self.system.potential_force(&self.state.x).to_vec()
            }
            fn momentum(&self, x: &[f64], xi: &[f64]) -> Vec<f64> {
                self.system.momentum(&array(x), &array(xi)).to_vec()
            }
            fn momentum_rate(&self) -> Vec<f64> {
                let State { x, xi, .. } = &self.state;
                self.system.momentum_rate(x, xi, &self.inputs).to_vec()
            }
            fn velocity_of(&self, momentum: &[f64]) -> Vec<f64> {
                let xi = self.system.velocity_from_momentum(&self.state.x, &array(momentum));
                xi.expect(&self.label).to_vec()
            }
            fn needed(&self, xi_dot: &[f64]) -> Vec<f64> {
                let State { x, xi, .. } = &self.state;
                self.system.inverse_dynamics(x, xi, &array(xi_dot)).to_vec()
            }
            fn kinetic(&self, x: &[f64]) -> f64 {
                self.system.kinetic_energy(&array(x), &self.state.xi)
            }
            fn potential(&self, x: &[f64]) -> f64 {
                self.system.potential_energy(&array(x))
            }
            fn energy(&self) -> f64 {
                self.system.energy(&self.state.x, &self.state.xi)
            }
            fn phi(&self, x: &[f64]) -> Vec<f64> {
                self.system.constraint(&array(x)).to_vec()
            }
            fn energy_after(&self, h: f64) -> f64 {
                let mut state = self.state.clone();
                let step = hamel::step(&self.system, Rkmk4, &mut state, h, &|_, _, _| self.inputs);
                step.expect(&self.label);
                self.system.energy(&state.x, &state.xi)
            }
            fn random(&self, count: usize) -> Vec<f64> {
                let mut list = vec![0.0; count];
                self.random.clone().fill(&mut list, 1.0);
                list
            }
        })+

        /// Checks a law at every state of every system; a failure does not hide those of other systems.
        pub fn everywhere(law: fn(&dyn Point)) {
            let mut failures = Vec::new();
            $(
                let system = AssertUnwindSafe(|| {
                    for seed in 1..=STATES_PER_LAW {
                        law(&At::<hamel_tests::$module::$name<f64>>::new(stringify!($module), seed));
                    }
                });
                if catch_unwind(system).is_err() {
                    failures.push(stringify!($module));
                }
            )+
            assert!(failures.is_empty(), "the law fails for {failures:?}");
        }

        #[test]
        fn single_precision_agrees_with_double() {
            $(for seed in 1..=STATES_PER_LAW {
                let double = At::<hamel_tests::$module::$name<f64>>::new(stringify!($module), seed);
                single(&double, &hamel_tests::$module::$name::<f32>::default());
            })+
        }
    };
}

models! {
    actuated_pendulum::ActuatedPendulum,
    aircraft_euler::AircraftEuler,
    benchmark_top::BenchmarkTop,
    body_with_rotor::BodyWithRotor,
    cart_pole::CartPole,
    cart_rods::CartRods,
    coupled_pendulums::CoupledPendulums,
    double_pendulum_angles::DoublePendulum,
    double_pendulum_circles::CircleDoublePendulum,
    double_spherical_pendulum::DoubleSphericalPendulum,
    drag_ball::DragBall,
    drone::Drone,
    elastic_pendulum::ElasticPendulum,
    euler_top_quaternion::EulerTop,
    four_bar::FourBar,
    frame_graph::FrameGraph,
    free_body::FreeBody,
    free_body_both::FreeBodyBoth,
    free_body_momenta::FreeBodyMomenta,
    free_body_no_wrench::FallingBody,
    free_body_rows::FreeBodyRows,
    free_body_world::WorldBody,
    free_body_world_velocity::WorldVelocityBody,
    furuta::Furuta,
    gyrostat::Gyrostat,
    heavy_top::HeavyTop,
    heavy_top_axis::AxisTop,
    heavy_top_columns::ColumnTop,
    heavy_top_quaternion::QuaternionTop,
    heavy_top_world::WorldTop,
    heisenberg::Heisenberg,
    hoop_bead::HoopBead,
    kovalevskaya_top::KovalevskayaTop,
    lagrange_top::LagrangeTop,
    pendulum::Pendulum,
    pendulum_circle::CirclePendulum,
    pendulum_rows::PendulumRows,
    planar_body::PlanarBody,
    planar_world::PlanarWorld,
    polar_particle::PolarParticle,
    principal_axes::PrincipalAxes,
    quadrotor_load::QuadrotorLoad,
    rod_particles::RodParticles,
    rod_particles_rows::RodParticlesRows,
    rope::Rope,
    satellite::Satellite,
    satellite_arm::SatelliteArm,
    six_particles::SixParticles,
    slider_crank::SliderCrank,
    spherical_angles::SphericalAngles,
    spherical_bob::SphericalBob,
    spherical_orthonormal::SphericalOrthonormal,
    spherical_pendulum::SphericalPendulum,
    spinning_particles::SpinningParticles,
    spring_chain::SpringChain,
    suspended_body::SuspendedBody,
    tricopter::Tricopter,
    two_bodies::TwoBodies,
    vane::Vane,
}

#[test]
fn no_model_is_left_out() {
    let mut stems: Vec<&str> = derived::all()
        .into_iter()
        .filter(|model| {
            // With velocity constraints A is not a frame of the tangent space, and with time or drives these laws
            // change: see `physics_constraints.rs` and `time.rs`.
            let generated = model.generated();
            // Differences are not valid for kinks and jumps: see `physics_functions.rs`.
            let graph = &generated.program.graph;
            let bends = (0..graph.len() as u32).any(|id| graph.condition_of(id).is_some());
            // Aerodynamic forces by angles of a velocity have no slopes at zero: see `physics_flight.rs`.
            let steep = model.text.contains("asin(");
            // First-order states follow the velocities: see `states.rs`.
            let states = generated.program.n_z > 0;
            !generated.model.is_constrained() && !bends && !steep && !states
        })
        .map(|model| &*model.name)
        .collect();
    stems.sort();
    assert_eq!(stems, MODELS);
}

fn single<D, S>(double: &At<D>, system: &S)
where
    D: System<Scalar = f64>,
    S: System<Scalar = f32>,
{
    fn narrow(from: &[f64], to: &mut [f32]) {
        to.iter_mut().zip(from).for_each(|(to, v)| *to = *v as f32);
    }
    let (mut x, mut xi) = (system.zero_coordinates(), system.zero_velocities());
    let mut u = system.zero_inputs();
    let State {
        x: x64, xi: xi64, ..
    } = &double.state;
    narrow(x64.as_ref(), x.as_mut());
    narrow(xi64.as_ref(), xi.as_mut());
    narrow(double.inputs.as_ref(), u.as_mut());
    let narrow = system.forward_dynamics(&x, &xi, &u).expect(&double.label);
    let wide = double.system.forward_dynamics(x64, xi64, &double.inputs);
    let narrow: Vec<f64> = narrow.as_ref().iter().map(|v| f64::from(*v)).collect();
    let wide = wide.expect(&double.label);
    let scale = largest(wide.as_ref()).max(1.0);
    assert_close(&double.label, &narrow, wide.as_ref(), F32_TOLERANCE * scale);
}
