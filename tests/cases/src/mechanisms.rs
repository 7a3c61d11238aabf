//! Cases of several bodies, and of velocity constraints.

use crate::bodies::join;
use crate::case::{Case, Field, Measure};
use crate::models::double_pendulum_angles::{DoublePendulum, DoublePendulumParameters};
use crate::models::rolling_disk::{RollingDisk, RollingDiskParameters};
use crate::models::sleigh::{Sleigh, SleighParameters};
use crate::models::two_bodies::{TwoBodies, TwoBodiesParameters};
use crate::reference::Reference;
use hamel::State;

/// A planar double pendulum in its chaotic regime, with absolute angles.
pub fn double_pendulum() -> Case<DoublePendulum<f64>> {
    let reference = Reference::read("double-pendulum-planar-chaotic");
    let ([m1, m2], [l1, l2]) = (reference.parameter("m"), reference.parameter("l"));
    let g = reference.gravity();
    Case {
        name: "double-pendulum-planar-chaotic",
        system: DoublePendulum::new(DoublePendulumParameters { m1, m2, l1, l2, g })
            .expect("a pendulum"),
        start: State {
            t: 0.0,
            x: reference.initial("theta"),
            xi: reference.initial("thetadot"),
        },
        until: 10.0,
        inputs: Box::new(|_, _, _| []),
        fields: |_, state| {
            vec![
                Field::Numbers("theta", state.x.to_vec()),
                Field::Numbers("thetadot", state.xi.to_vec()),
            ]
        },
        measure: Measure::Largest,
        reference,
    }
}

/// A chain of two bodies with ball joints.
pub fn two_bodies() -> Case<TwoBodies<f64>> {
    let reference = Reference::read("two-bodies-ball-joints");
    let [m1, m2] = reference.parameter("m");
    let g = reference.gravity();
    let system = TwoBodies::new(TwoBodiesParameters {
        m1,
        m2,
        g,
        s1: reference.parameter("s1"),
        s2: reference.parameter("s2"),
        d: reference.parameter("d"),
        theta1: reference.matrix("Theta1"),
        theta2: reference.matrix("Theta2"),
    });
    Case {
        name: "two-bodies-ball-joints",
        system: system.expect("two bodies"),
        start: State {
            t: 0.0,
            x: join(reference.initial::<9>("R1"), reference.initial::<9>("R2")),
            xi: join(
                reference.initial::<3>("omega1"),
                reference.initial::<3>("omega2"),
            ),
        },
        until: 5.0,
        inputs: Box::new(|_, _, _| []),
        fields: |_, state| {
            let (mut r1, mut r2) = ([0.0; 9], [0.0; 9]);
            r1.copy_from_slice(&state.x[..9]);
            r2.copy_from_slice(&state.x[9..]);
            vec![
                Field::Rotation("R1", r1),
                Field::Rotation("R2", r2),
                Field::Numbers("omega1", state.xi[..3].to_vec()),
                Field::Numbers("omega2", state.xi[3..].to_vec()),
            ]
        },
        measure: Measure::Largest,
        reference,
    }
}

/// Chaplygin's sleigh; ξ are the speed along the blade and the rate of turn.
pub fn sleigh() -> Case<Sleigh<f64>> {
    let reference = Reference::read("chaplygin-sleigh");
    let [[m], [inertia], [a]] = ["m", "I", "a"].map(|name| reference.parameter(name));
    let [[x], [y], [theta], [u], [w]] =
        ["x", "y", "theta", "u", "w"].map(|name| reference.initial::<1>(name));
    Case {
        name: "chaplygin-sleigh",
        system: Sleigh::new(SleighParameters { m, j: inertia, a }).expect("a body"),
        start: State {
            t: 0.0,
            x: [x, y, theta.cos(), theta.sin()],
            xi: [u, w],
        },
        until: 20.0,
        inputs: Box::new(|_, _, _| []),
        fields: |_, state| {
            vec![
                Field::Numbers("x", vec![state.x[0]]),
                Field::Numbers("y", vec![state.x[1]]),
                Field::Angle("theta", state.x[3].atan2(state.x[2])),
                Field::Numbers("u", vec![state.xi[0]]),
                Field::Numbers("w", vec![state.xi[1]]),
            ]
        },
        measure: Measure::Largest,
        reference,
    }
}

/// A disk that rolls without slipping.
pub fn rolling_disk() -> Case<RollingDisk<f64>> {
    let reference = Reference::read("rolling-disk");
    let [[m], [a], [i1], [i3]] = ["m", "a", "I1", "I3"].map(|name| reference.parameter(name));
    let g = reference.gravity();
    Case {
        name: "rolling-disk",
        system: RollingDisk::new(RollingDiskParameters { m, a, g, i1, i3 }).expect("a body"),
        start: State {
            t: 0.0,
            x: join(reference.initial::<3>("r"), reference.initial::<9>("R")),
            xi: reference.initial("omega"),
        },
        until: 5.0,
        inputs: Box::new(|_, _, _| []),
        fields: |_, state| {
            let mut r = [0.0; 9];
            r.copy_from_slice(&state.x[3..]);
            vec![
                Field::Numbers("r", state.x[..3].to_vec()),
                Field::Rotation("R", r),
                Field::Numbers("omega", state.xi.to_vec()),
            ]
        },
        measure: Measure::Largest,
        reference,
    }
}
