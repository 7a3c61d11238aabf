//! The iterated linear-quadratic regulator: forwards a run, backwards the best answer to deviations from it, by the
//! exact slopes of the steps that the run makes.
//!
//! W. Li, E. Todorov, *Iterative linear quadratic regulator design for nonlinear biological movement systems*, ICINCO
//! (2004). What the state is off by costs ½ (a |r|² + b tr(I − R) + c |v|² + d |w|²), whose slopes along displacements
//! (δr, R ĥ) are a r and ½ b vee(R − Rᵀ), and the curvature in the attitude is taken as that at R = I, so that all
//! values are positive definite.

use core::array::from_fn;

use hamel::methods::SemiImplicitEuler;
use hamel::{Scalar, State, StepError, System, TangentSystem, manifold, step, step_slopes_into};

use crate::matrix::{
    Matrix, add_diagonal, add_scaled, add_symmetric_product, add_transposed_product, dot, solve,
    take, transpose, transposed_apply, zeros,
};
use crate::model::{Drone, DroneState};

/// Steps of the horizon.
pub const NODES: usize = 20;
/// How often the plan is made better.
pub const ITERATIONS: usize = 8;
/// Length of a step, in s.
const STEP: f64 = 0.05;
/// Displacements: δr and a turn in body axes, then those of ξ = (v, w).
const N: usize = 12;
/// The thrust and three torques.
const M: usize = 4;
/// What place, attitude, velocity and angular velocity cost over a second, and at the end.
const RUNNING: [f64; 4] = [2.0, 1.0, 0.5, 0.1];
const END: [f64; 4] = [80.0, 20.0, 10.0, 1.0];
/// What thrust beyond the weight and torques cost over a second.
const EFFORT: [f64; M] = [0.05, 20.0, 20.0, 20.0];
/// The thrust that carries the drone, in N.
const WEIGHT: f64 = 1.1 * 9.81;

/// A place in the state space of the drone.
pub type Place<S> = State<Drone<S>>;

/// States and inputs over the horizon, and what they cost.
#[derive(Clone, Debug)]
pub struct Plan<S: Scalar> {
    states: [Place<S>; NODES + 1],
    inputs: [[S; M]; NODES],
    cost: S,
}

/// The answer to a deviation e: u + s k + K e, where s is how much of the change k is made.
#[derive(Clone, Copy, Debug)]
struct Answer<S> {
    change: [S; M],
    gain: Matrix<S, M, N>,
}

impl<S: Scalar> Answer<S> {
    /// To go on as before.
    const fn none(zero: S) -> Self {
        Answer {
            change: [zero; M],
            gain: [[zero; N]; M],
        }
    }
}

/// What a state costs by these weights, and its slope.
fn cost<S: Scalar>(place: &Place<S>, weights: [f64; 4]) -> (S, [S; N]) {
    let [a, b, c, d] = weights.map(S::from_f64);
    let half = S::from_f64(0.5);
    let here = DroneState::from(place);
    let [[r11, r12, r13], [r21, r22, r23], [r31, r32, r33]] = here.r_upper;
    let turned = S::from_f64(3.0) - r11 - r22 - r33;
    let value = a * dot(&here.r, &here.r)
        + b * turned
        + c * dot(&here.v, &here.v)
        + d * dot(&here.w, &here.w);
    let ([x, y, z], [vx, vy, vz], [wx, wy, wz]) = (here.r, here.v, here.w);
    let turn = half * b;
    let slope = [
        a * x,
        a * y,
        a * z,
        turn * (r32 - r23),
        turn * (r13 - r31),
        turn * (r21 - r12),
        c * vx,
        c * vy,
        c * vz,
        d * wx,
        d * wy,
        d * wz,
    ];
    (half * value, slope)
}

/// The curvature of the cost of a state: the diagonal of a matrix.
fn curvature<S: Scalar>(weights: [f64; 4]) -> [S; N] {
    let [a, b, c, d] = weights.map(S::from_f64);
    [a, a, a, b, b, b, c, c, c, d, d, d]
}

/// The deviation of a state from another one, to first order of the turn between them.
fn deviation<S: Scalar>(place: &Place<S>, from: &Place<S>) -> [S; N] {
    let (new, old) = (DroneState::from(place), DroneState::from(from));
    // Columns of both rotations; the skew part of RᵀS is the turn.
    let (mut r, mut s) = (zeros(), zeros());
    transpose(&old.r_upper, &mut r);
    transpose(&new.r_upper, &mut s);
    let ([r1, r2, r3], [s1, s2, s3]) = (r, s);
    let skew = |ri, rk, si, sk| S::from_f64(0.5) * (dot(ri, sk) - dot(rk, si));
    let ([x, y, z], [x0, y0, z0]) = (new.r, old.r);
    let ([vx, vy, vz], [vx0, vy0, vz0]) = (new.v, old.v);
    let ([wx, wy, wz], [wx0, wy0, wz0]) = (new.w, old.w);
    [
        x - x0,
        y - y0,
        z - z0,
        skew(&r3, &r2, &s3, &s2),
        skew(&r1, &r3, &s1, &s3),
        skew(&r2, &r1, &s2, &s1),
        vx - vx0,
        vy - vy0,
        vz - vz0,
        wx - wx0,
        wy - wy0,
        wz - wz0,
    ]
}

/// What inputs are beyond those that hover.
fn effort<S: Scalar>(u: &[S; M]) -> [S; M] {
    let [thrust, x, y, z] = *u;
    [thrust - S::from_f64(WEIGHT), x, y, z]
}

/// The regulator: the drone, also in numbers with slopes, the plan as it is, and room for what an iteration tries.
#[derive(Clone, Debug)]
pub struct Regulator<S: Scalar> {
    drone: Drone<S>,
    tangent: TangentSystem<Drone<S>>,
    plan: Plan<S>,
    tried: Plan<S>,
    answers: [Answer<S>; NODES],
}

impl<S: Scalar> Regulator<S> {
    /// A drone two metres off, tilted and moving, whose plan is nothing yet.
    #[inline(never)]
    pub fn tilted() -> Self {
        let drone = Drone::default();
        let mut start = Place::start(&drone);
        let off = [1.5, -1.2, 0.5, 0.5, -0.4, 0.3].map(S::from_f64);
        manifold::retract(drone.blocks(), &mut start.x, &off);
        start.xi = [-0.5, 0.3, 0.2, 0.4, 0.5, -0.3].map(S::from_f64);
        let zero = S::default();
        let plan = Plan {
            states: from_fn(|_| start.clone()),
            inputs: [[S::from_f64(WEIGHT), zero, zero, zero]; NODES],
            cost: zero,
        };
        Regulator {
            tangent: TangentSystem::new(&drone),
            drone,
            tried: plan.clone(),
            plan,
            answers: [Answer::none(zero); NODES],
        }
    }

    /// What the plan costs.
    pub fn cost(&self) -> S {
        self.plan.cost
    }

    /// Plans to hover, as long as nothing better is known.
    ///
    /// # Errors
    /// Those of steps.
    pub fn hover(&mut self) -> Result<(), StepError> {
        self.attempt(S::default())?;
        core::mem::swap(&mut self.plan, &mut self.tried);
        Ok(())
    }

    /// One iteration: answers to the plan, and a plan that is no worse, by ever smaller parts of their changes.
    ///
    /// # Errors
    /// Those of steps.
    #[inline(never)]
    pub fn improve(&mut self) -> Result<(), StepError> {
        if !self.answer()? {
            return Ok(());
        }
        for part in [1.0, 0.5, 0.25, 0.1, 0.03] {
            self.attempt(S::from_f64(part))?;
            if (self.plan.cost - self.tried.cost).is_positive() {
                core::mem::swap(&mut self.plan, &mut self.tried);
                break;
            }
        }
        Ok(())
    }

    /// Tries the plan with `part` of the answers' changes.
    #[inline(never)]
    fn attempt(&mut self, part: S) -> Result<(), StepError> {
        let (half, length) = (S::from_f64(0.5), S::from_f64(STEP));
        let weights = EFFORT.map(S::from_f64);
        let [start, ..] = &self.plan.states;
        let mut here = start.clone();
        let mut total = S::default();
        let old = self.plan.states.iter().zip(&self.plan.inputs);
        let new = self.tried.states.iter_mut().zip(&mut self.tried.inputs);
        for (((before, then), (node, u)), answer) in old.zip(new).zip(&self.answers) {
            let off = deviation(&here, before);
            for (((u, then), change), gain) in
                u.iter_mut().zip(then).zip(&answer.change).zip(&answer.gain)
            {
                *u = *then + part.mul_add(*change, dot(gain, &off));
            }
            let mut work = S::default();
            for (weight, u) in weights.iter().zip(&effort(u)) {
                work = (*weight * *u).mul_add(*u, work);
            }
            total += length * half.mul_add(work, cost(&here, RUNNING).0);
            node.clone_from(&here);
            let held = |_, _: &[S; 12], _: &[S; 6]| *u;
            step(&self.drone, SemiImplicitEuler, &mut here, STEP, &held)?;
        }
        self.tried.cost = total + cost(&here, END).0;
        let [.., last] = &mut self.tried.states;
        *last = here;
        Ok(())
    }

    /// Finds the best answers to deviations, backwards by the value ½ eᵀ V e + vᵀ e of what follows a state; whether
    /// there are any.
    #[inline(never)]
    fn answer(&mut self) -> Result<bool, StepError> {
        let [.., last] = &self.plan.states;
        let (_, mut slope) = cost(last, END);
        let mut value = zeros();
        add_diagonal(&mut value, S::from_f64(1.0), &curvature(END));
        let nodes = self.plan.states.iter().zip(&self.plan.inputs);
        let mut slopes = [[S::default(); N + M]; N];
        for ((place, u), answer) in nodes.zip(&mut self.answers).rev() {
            step_slopes_into(
                &SemiImplicitEuler,
                &self.tangent,
                place,
                u,
                STEP,
                &mut slopes,
            )?;
            if !before(place, u, &slopes, &mut value, &mut slope, answer) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// The answer at a node, and V and v there by those of the next one; whether the inputs' part has an inverse.
#[inline(never)]
fn before<S: Scalar>(
    place: &Place<S>,
    u: &[S; M],
    slopes: &Matrix<S, N, { N + M }>,
    value: &mut Matrix<S, N, N>,
    slope: &mut [S; N],
    answer: &mut Answer<S>,
) -> bool {
    let length = S::from_f64(STEP);
    let weights = EFFORT.map(S::from_f64);
    // Aᵀ V A and Aᵀ v of the states, Bᵀ V [A B] and Bᵀ v of the inputs, with what the node itself costs.
    let mut half: Matrix<S, N, { N + M }> = zeros();
    let mut pushed: Matrix<S, M, { N + M }> = zeros();
    add_symmetric_product(&mut half, value, slopes);
    *value = zeros();
    add_transposed_product(value, slopes, 0, &half);
    add_transposed_product(&mut pushed, slopes, N, &half);
    let all_slope = transposed_apply(slopes, slope);
    let mut first = [S::default(); M];
    let both = slope.iter_mut().chain(&mut first);
    both.zip(all_slope).for_each(|(to, from)| *to = from);
    add_scaled(slope, length, &cost(place, RUNNING).1);
    add_diagonal(value, length, &curvature(RUNNING));
    for ((entry, u), weight) in first.iter_mut().zip(effort(u)).zip(weights) {
        *entry = (length * weight).mul_add(u, *entry);
    }
    // The inputs' own part, and what it is solved for: K and k.
    let (mut inner, mut mixed) = (zeros::<S, M, M>(), zeros::<S, M, N>());
    let mut right: Matrix<S, M, { N + 1 }> = zeros();
    take(&pushed, N, &mut inner);
    take(&pushed, 0, &mut mixed);
    take(&pushed, 0, &mut right);
    add_diagonal(&mut inner, length, &weights);
    for ([.., last], entry) in right.iter_mut().zip(first) {
        *last = entry;
    }
    if !solve(&mut inner, &mut right) {
        return false;
    }
    for row in &mut right {
        row.iter_mut().for_each(|entry| *entry = -*entry);
    }
    take(&right, 0, &mut answer.gain);
    for (change, [.., last]) in answer.change.iter_mut().zip(&right) {
        *change = *last;
    }
    let along = transposed_apply(&mixed, &answer.change);
    add_scaled(slope, S::from_f64(1.0), &along);
    add_transposed_product(value, &mixed, 0, &answer.gain);
    true
}
