//! Counts are exact, and the wrapper changes nothing.

use hamel::adaptive::Adaptive;
use hamel::methods::{General, Rkmk4};
use hamel::{Block, Canonical, Energies, Singular, Split, State, System, integrate, s1};
use hamel_report::counted_system::CountedSystem;
use hamel_report::data::Kind;
use hamel_report::entry::{Division, Worst};
use hamel_report::problem::Problem;

/// A pendulum, l θ̈ = −g sin θ, on the circle.
struct Pendulum {
    g: f64,
    l: f64,
}

impl System for Pendulum {
    type Scalar = f64;
    type Coordinates = [f64; 2];
    type Velocities = [f64; 1];
    type Chart = [f64; 1];
    type Inputs = [f64; 0];

    fn blocks(&self) -> &[Block] {
        &[Block::Circle]
    }
    fn start(&self) -> ([f64; 2], [f64; 1]) {
        (s1::exp(1.0), [0.5])
    }
    fn chart_rate(&self, _: &[f64; 2], xi: &[f64; 1]) -> [f64; 1] {
        *xi
    }
    fn forward_dynamics(
        &self,
        x: &[f64; 2],
        _: &[f64; 1],
        _: &[f64; 0],
    ) -> Result<[f64; 1], Singular> {
        Ok([-self.g / self.l * x[1]])
    }
}

impl Energies for Pendulum {
    fn kinetic_energy(&self, _: &[f64; 2], xi: &[f64; 1]) -> f64 {
        0.5 * (self.l * xi[0]).powi(2)
    }
    fn potential_energy(&self, x: &[f64; 2]) -> f64 {
        -self.g * self.l * x[0]
    }
}

impl Split for Pendulum {
    type Rotors = [hamel::Rotor<f64>; 0];
    const FREE: bool = false;
    fn rotors(&self) -> Self::Rotors {
        []
    }
    fn centre(&self, x: &[f64; 2]) -> [f64; 2] {
        *x
    }
    fn uncentre(&self, y: &[f64; 2]) -> [f64; 2] {
        *y
    }
    fn split_momenta(&self, _: &[f64; 2], xi: &[f64; 1]) -> [f64; 1] {
        *xi
    }
    fn split_velocities(&self, _: &[f64; 2], p: &[f64; 1]) -> [f64; 1] {
        *p
    }
    fn kick(&self, x: &[f64; 2], _: &[f64; 0]) -> [f64; 1] {
        [-self.g / self.l * x[1]]
    }
}

impl Canonical for Pendulum {
    fn momentum(&self, _: &[f64; 2], xi: &[f64; 1]) -> [f64; 1] {
        [self.l * self.l * xi[0]]
    }
    fn momentum_rate(&self, x: &[f64; 2], _: &[f64; 1], _: &[f64; 0]) -> [f64; 1] {
        [-self.g * self.l * x[1]]
    }
    fn velocity_from_momentum(&self, _: &[f64; 2], p: &[f64; 1]) -> Result<[f64; 1], Singular> {
        Ok([p[0] / (self.l * self.l)])
    }
}

const PENDULUM: Pendulum = Pendulum { g: 9.81, l: 0.5 };

#[test]
fn each_kind_of_force_counts_once() {
    let counted = CountedSystem::new(&PENDULUM);
    let (x, xi) = counted.start();
    assert_eq!(counted.evaluations(), 0);
    assert_eq!(
        counted.forward_dynamics(&x, &xi, &[]),
        PENDULUM.forward_dynamics(&x, &xi, &[])
    );
    assert_eq!(counted.kick(&x, &[]), PENDULUM.kick(&x, &[]));
    let rate = counted.momentum_rate(&x, &xi, &[]);
    assert_eq!(rate, PENDULUM.momentum_rate(&x, &xi, &[]));
    assert_eq!(counted.evaluations(), 3);
    // No other function is an evaluation of forces.
    let p = counted.momentum(&x, &xi);
    assert_eq!(counted.velocity_from_momentum(&x, &p), Ok(xi));
    assert_eq!(counted.uncentre(&counted.centre(&x)), x);
    assert_eq!(
        counted.split_velocities(&x, &counted.split_momenta(&x, &xi)),
        xi
    );
    assert_eq!(counted.rate(&x, &xi), PENDULUM.rate(&x, &xi));
    assert_eq!(
        counted.kinetic_energy(&x, &xi),
        PENDULUM.kinetic_energy(&x, &xi)
    );
    assert_eq!(counted.evaluations(), 3);
    counted.reset();
    assert_eq!(counted.evaluations(), 0);
}

#[test]
fn runs_are_those_of_the_system_itself() {
    let mut state = State::start(&PENDULUM);
    integrate(
        &PENDULUM,
        Rkmk4,
        &mut state,
        0.02,
        2.0,
        |_, _, _| [],
        |_| {},
    )
    .expect("a run");
    let counted = CountedSystem::new(&PENDULUM);
    let mut other = State::start(&counted);
    integrate(&counted, Rkmk4, &mut other, 0.02, 2.0, |_, _, _| [], |_| {}).expect("a run");
    assert_eq!((state.x, state.xi), (other.x, other.xi));
    assert_eq!(counted.evaluations(), 400);
}

fn none(_: f64, _: &[f64; 2], _: &[f64; 1]) -> [f64; 0] {
    []
}

type Inputs = fn(f64, &[f64; 2], &[f64; 1]) -> [f64; 0];

/// The pendulum up to t = 1, with the error |ξ − 7|.
fn problem<'a>(
    system: &'a CountedSystem<'a, Pendulum>,
) -> Problem<'a, CountedSystem<'a, Pendulum>, Inputs> {
    let (x, xi) = PENDULUM.start();
    Problem {
        system,
        evaluations: Box::new(|| system.evaluations()),
        x,
        xi,
        until: 1.0,
        inputs: none,
        error: Box::new(|_, xi| (xi[0] - 7.0).abs()),
        momenta: Box::new(|_, _| Vec::new()),
        error_text: Box::new(ToString::to_string),
        conservative: true,
    }
}

#[test]
fn a_problem_gives_error_drift_and_count() {
    let counted = CountedSystem::new(&PENDULUM);
    let problem = problem(&counted);
    let entry = problem.by("rkmk4", Kind::Method, General::Rkmk4);
    let (_, end) = problem.end(&Rkmk4, 50).expect("a run");
    let mut worst = Worst::default();
    let mut states = 0;
    let watch = &mut |deviation| {
        worst.take(deviation);
        states += 1;
    };
    let outcome = entry
        .run(Division::Steps(50), 1.0, watch)
        .expect("equal steps");
    assert_eq!((outcome.evaluations, states), (Some(200), 51));
    assert_eq!(outcome.error, (end[0] - 7.0).abs());
    // The energy of RKMK4 at h = 0.02 changes by about 1e-6; there are no momenta.
    assert!(worst.energy > 0.0 && worst.energy < 1e-5, "{worst:?}");
    assert!(worst.momentum.is_nan() && worst.defect < 1e-15, "{worst:?}");
    assert_eq!(entry.order, Some(4));
}

#[test]
fn runs_by_error_control_count_what_they_evaluate_and_refuse() {
    const TOLERANCE: f64 = 1e-10;
    let counted = CountedSystem::new(&PENDULUM);
    let problem = problem(&counted);
    let (order, controlled) = (8, problem.controlled("rkmk8", 8, Adaptive::rkmk8));
    let mut state = State::start(&PENDULUM);
    let alone = Adaptive::rkmk8(TOLERANCE)
        .run(&PENDULUM, &mut state, 1.0, none)
        .expect("a run");
    let mut states = 0;
    let outcome = controlled
        .run(Division::Tolerance(TOLERANCE), 1.0, &mut |_| states += 1)
        .expect("a tolerance");
    assert_eq!(outcome.statistics, Some(alone));
    assert_eq!(outcome.evaluations, Some(alone.evaluations));
    assert_eq!(
        (states, outcome.error),
        (alone.accepted, (state.xi[0] - 7.0).abs())
    );
    assert_eq!(controlled.order, Some(order));
    // A tolerance is not a number of steps, for either kind of method.
    let equal = problem.by("rkmk4", Kind::Method, Rkmk4);
    let (steps, tolerance) = (Division::Steps(9), Division::Tolerance(TOLERANCE));
    assert!(controlled.run(steps, 1.0, &mut |_| {}).is_none());
    assert!(equal.run(tolerance, 1.0, &mut |_| {}).is_none());
    assert_eq!(equal.divisions(&[9], &[TOLERANCE]), [steps]);
    assert_eq!(controlled.divisions(&[9], &[TOLERANCE]), [tolerance]);
}
