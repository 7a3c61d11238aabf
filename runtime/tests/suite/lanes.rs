//! Two systems in one: a scalar of two lanes gives in each what `f64` gives alone.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::common::{Body, QuaternionTop, Reference, Spin, Top, distance, run};
use hamel::adaptive::Adaptive;
use hamel::flows::Flow;
use hamel::methods::{Free, Gauss6, General, Lgvi, Scheme, Splitting};
use hamel::{Monitor, Scalar, State, StepError, s3, so3};

/// Two lanes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pair(pub [f64; 2]);

macro_rules! operators {
    ($($operator:ident $method:ident $assign:ident $method_assign:ident),*) => {$(
        impl $operator for Pair {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self([0, 1].map(|i| self.0[i].$method(other.0[i])))
            }
        }
        impl $assign for Pair {
            fn $method_assign(&mut self, other: Self) {
                *self = $operator::$method(*self, other);
            }
        }
    )*};
}

operators!(Add add AddAssign add_assign, Sub sub SubAssign sub_assign);
operators!(Mul mul MulAssign mul_assign, Div div DivAssign div_assign);

impl Neg for Pair {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|v| -v))
    }
}

impl Scalar for Pair {
    const EPSILON: f64 = f64::EPSILON;

    fn from_f64(value: f64) -> Self {
        Self([value; 2])
    }
    fn sin_cos(self) -> (Self, Self) {
        let [a, b] = self.0.map(Scalar::sin_cos);
        (Self([a.0, b.0]), Self([a.1, b.1]))
    }
    fn sqrt(self) -> Self {
        Self(self.0.map(Scalar::sqrt))
    }
    fn exp(self) -> Self {
        Self(self.0.map(Scalar::exp))
    }
    fn ln(self) -> Self {
        Self(self.0.map(Scalar::ln))
    }
    fn atan2(self, x: Self) -> Self {
        Self([0, 1].map(|i| Scalar::atan2(self.0[i], x.0[i])))
    }
    fn abs(self) -> Self {
        Self(self.0.map(Scalar::abs))
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self([0, 1].map(|i| Scalar::mul_add(self.0[i], a.0[i], b.0[i])))
    }
    fn max(self, other: Self) -> Self {
        Self([0, 1].map(|i| Scalar::max(self.0[i], other.0[i])))
    }
    fn select_lt(self, limit: Self, then: Self, otherwise: Self) -> Self {
        Self([0, 1].map(|i| self.0[i].select_lt(limit.0[i], then.0[i], otherwise.0[i])))
    }
    fn is_positive(self) -> bool {
        self.0.into_iter().all(Scalar::is_positive)
    }
    fn is_finite(self) -> bool {
        self.0.into_iter().all(Scalar::is_finite)
    }
    fn largest_lane(self) -> f64 {
        Scalar::max(self.0[0], self.0[1])
    }
}

fn pair<const N: usize>(a: [f64; N], b: [f64; N]) -> [Pair; N] {
    std::array::from_fn(|i| Pair([a[i], b[i]]))
}

fn lane<const N: usize>(list: [Pair; N], index: usize) -> [f64; N] {
    list.map(|value| value.0[index])
}

fn bodies() -> ([Body<f64>; 2], Body<Pair>) {
    let [a, b] = ["kovalevskaya-top", "lagrange-fast-top"].map(|name| Reference::read(name).body());
    let both = Body {
        inertia: pair(a.inertia, b.inertia),
        m: Pair([a.m, b.m]),
        s: pair(a.s, b.s),
        g: pair(a.g, b.g),
        r0: pair(a.r0, b.r0),
        w0: pair(a.w0, b.w0),
    };
    ([a, b], both)
}

#[test]
fn lanes_agree_with_single_runs() -> Result<(), StepError> {
    let (single, both) = bodies();
    let state = run(&Top(both.clone()), General::Rkmk4, 1.0, 500)?;
    let unit = run(&QuaternionTop(both.clone()), General::Rkmk4, 1.0, 500)?;
    let mut monitor = Monitor::new(&Top(both.clone()), &State::start(&Top(both.clone())));
    monitor.observe(&Top(both.clone()), &state);
    for (index, body) in single.into_iter().enumerate() {
        let alone = run(&Top(body.clone()), General::Rkmk4, 1.0, 500)?;
        assert_eq!(lane(state.x, index), alone.x);
        assert_eq!(lane(state.xi, index), alone.xi);
        let unit_alone = run(&QuaternionTop(body.clone()), General::Rkmk4, 1.0, 500)?;
        assert_eq!(lane(unit.x, index), unit_alone.x);
        let mut monitor_alone = Monitor::new(&Top(body.clone()), &State::start(&Top(body.clone())));
        monitor_alone.observe(&Top(body.clone()), &alone);
        let drift = monitor.relative_energy_deviation().0[index];
        assert_eq!(drift, monitor_alone.relative_energy_deviation());
    }
    Ok(())
}

#[test]
fn lanes_take_the_steps_that_the_worst_needs() -> Result<(), StepError> {
    let (single, both) = bodies();
    let method = Adaptive::rkmk54(1e-8);
    let system = Top(both);
    let mut state = State::start(&system);
    let together = method.run(&system, &mut state, 1.0, |_, _, _| [])?;
    for (index, body) in single.into_iter().enumerate() {
        let alone = Top(body);
        let mut single = State::start(&alone);
        let cost = method.run(&alone, &mut single, 1.0, |_, _, _| [])?;
        let mut exact = State::start(&alone);
        Adaptive::rkmk8(1e-13).run(&alone, &mut exact, 1.0, |_, _, _| [])?;
        assert!(
            together.accepted + 2 >= cost.accepted,
            "{together:?} {cost:?}"
        );
        let error = |x: [f64; 9]| distance(x, exact.x);
        let (together, alone) = (error(lane(state.x, index)), error(single.x));
        // Steps that suit both are not longer than those of one alone.
        assert!(together < 1.5 * alone, "{together:e} {alone:e}");
    }
    Ok(())
}

#[test]
fn implicit_steps_converge_in_every_lane() -> Result<(), StepError> {
    let (single, both) = bodies();
    let state = run(&Top(both), General::BackwardEuler, 0.1, 1000)?;
    for (index, body) in single.into_iter().enumerate() {
        let alone = run(&Top(body), General::BackwardEuler, 0.1, 1000)?;
        // What ends the iteration, a thousand times.
        assert!(distance(lane(state.x, index), alone.x) < 1e-8);
    }
    Ok(())
}

#[test]
fn lanes_take_different_branches() {
    // Zero beside a large angle; different columns of q qᵀ.
    let (a, b) = ([0.0; 3], [-1.0, 2.5, 0.3]);
    let u = pair(a, b);
    let w = pair([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]);
    for (index, alone) in [a, b].into_iter().enumerate() {
        assert_eq!(lane(so3::exp(u), index), so3::exp(alone));
        assert_eq!(lane(s3::exp(u), index), s3::exp(alone));
        assert_eq!(
            lane(so3::dexpinv(u, w), index),
            so3::dexpinv(alone, [1.0, 2.0, 3.0])
        );
        assert_eq!(
            lane(so3::log(so3::exp(u)), index),
            so3::log(so3::exp(alone))
        );
    }
}

#[test]
fn one_bad_lane_is_an_error() {
    let (_, both) = bodies();
    let top = Top(both);
    let mut state = State::start(&top);
    state.xi[1].0[1] = f64::NAN;
    let outcome = hamel::step(&top, General::Rkmk4, &mut state, 0.1, &|_, _, _| []);
    assert_eq!(outcome, Err(StepError::NonFinite { time: 0.0 }));
    let outcome = Adaptive::rkmk54(1e-6).run(&top, &mut state, 1.0, |_, _, _| []);
    assert_eq!(outcome, Err(StepError::NonFinite { time: 0.0 }));
}

#[test]
fn methods_of_bodies_agree_with_single_runs() -> Result<(), StepError> {
    let (single, both) = bodies();
    let top = Top(both);
    for (flow, scheme) in [
        (Flow::Turns, Scheme::Nystrom4),
        (Flow::Axes, Scheme::Suzuki4),
    ] {
        let method = Splitting::with_flow(&top, scheme, flow);
        let state = run(&top, method, 1.0, 100)?;
        for (index, body) in single.iter().enumerate() {
            let alone = Top(body.clone());
            let alone = run(&alone, Splitting::with_flow(&alone, scheme, flow), 1.0, 100)?;
            assert_eq!(lane(state.x, index), alone.x);
            assert_eq!(lane(state.xi, index), alone.xi);
        }
    }
    // Iterations go on until all lanes are content: equal to rounding.
    let (lgvi, gauss) = (run(&top, Lgvi, 0.1, 100)?, run(&top, Gauss6, 0.1, 100)?);
    for (index, body) in single.into_iter().enumerate() {
        let alone = Top(body);
        let error = distance(lane(lgvi.x, index), run(&alone, Lgvi, 0.1, 100)?.x);
        assert!(error < 1e-12, "{error:e}");
        let error = distance(lane(gauss.x, index), run(&alone, Gauss6, 0.1, 100)?.x);
        assert!(error < 1e-12, "{error:e}");
    }
    Ok(())
}

#[test]
fn free_rotors_of_different_symmetry_share_a_step() -> Result<(), StepError> {
    let diagonal = |[a, b, c]: [f64; 3]| [a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c];
    let body = |moments: [f64; 3], w0: [f64; 3]| Body {
        inertia: diagonal(moments),
        m: 0.0,
        s: [0.0; 3],
        g: [0.0; 3],
        r0: so3::identity(),
        w0,
    };
    let asymmetric = body([1.0, 2.0, 2.9], [0.4, -0.7, 1.1]);
    for other in [
        body([1.0, 1.0, 1.7], [0.1, 0.2, -3.0]),
        body([0.4, 1.0, 1.0], [0.1, 0.2, -3.0]),
        body([1.0; 3], [0.1, 0.2, -3.0]),
        body([2.9, 2.0, 1.0], [0.0, 0.3, 0.0]),
        body([2.9, 2.0, 1.0], [0.0; 3]),
        body([1e-3, 1.0, 1.0005], [20.0, 0.5, -0.3]),
    ] {
        let both = Spin(Top(Body {
            inertia: pair(asymmetric.inertia, other.inertia),
            m: Pair([0.0; 2]),
            s: pair([0.0; 3], [0.0; 3]),
            g: pair([0.0; 3], [0.0; 3]),
            r0: pair(asymmetric.r0, other.r0),
            w0: pair(asymmetric.w0, other.w0),
        }));
        for t in [0.05, 0.3, 10.0] {
            let state = run(&both, Free, t, 1)?;
            for (index, body) in [&asymmetric, &other].into_iter().enumerate() {
                let alone = run(&Spin(Top(body.clone())), Free, t, 1)?;
                let error = distance(lane(state.x, index), alone.x);
                // Rounding of the angle about the angular momentum, up to 200 rad.
                assert!(error < 2e-13, "{body:?} {t}: {error:e}");
                assert!(distance(lane(state.xi, index), alone.xi) < 2e-13);
            }
        }
    }
    Ok(())
}
