//! Cases of one rigid body: free, with a fixed point, in flight.

use crate::case::{Case, Field, Measure};
use crate::models::benchmark_top::{BenchmarkTop, BenchmarkTopParameters};
use crate::models::free_body::{FreeBody, FreeBodyParameters};
use crate::models::kovalevskaya_top::{KovalevskayaTop, KovalevskayaTopParameters};
use crate::models::lagrange_top::{LagrangeTop, LagrangeTopParameters};
use crate::models::principal_axes::{PrincipalAxes, PrincipalAxesParameters};
use crate::models::satellite::{Satellite, SatelliteParameters};
use crate::models::spherical_bob::{SphericalBob, SphericalBobParameters};
use crate::reference::Reference;
use hamel::{State, System, so3};

/// A body with x = R, ξ = ω.
fn rotation<Sys>(
    name: &'static str,
    until: f64,
    system: impl Fn(&Reference) -> Sys,
    inputs: crate::case::Inputs<Sys>,
) -> Case<Sys>
where
    Sys: System<Scalar = f64, Coordinates = [f64; 9], Velocities = [f64; 3]>,
{
    let reference = Reference::read(name);
    Case {
        name,
        system: system(&reference),
        start: State {
            t: 0.0,
            x: reference.initial("R"),
            xi: reference.initial("omega"),
        },
        until,
        inputs,
        fields: |_, state| {
            vec![
                Field::Rotation("R", state.x),
                Field::Numbers("omega", state.xi.to_vec()),
            ]
        },
        measure: Measure::Attitude,
        reference,
    }
}

/// Returns the moments of a diagonal inertia.
fn moments(reference: &Reference) -> [f64; 3] {
    let j = reference.matrix("J");
    [j[0][0], j[1][1], j[2][2]]
}

fn free(name: &'static str, until: f64) -> Case<PrincipalAxes<f64>> {
    let system = |reference: &Reference| {
        let [j1, j2, j3] = moments(reference);
        PrincipalAxes::new(PrincipalAxesParameters { j1, j2, j3 }).expect("a body")
    };
    rotation(name, until, system, Box::new(|_, _, _| []))
}

/// A flat plate that flips, started 10⁻³ from rotation about its middle axis.
pub fn dzhanibekov() -> Case<PrincipalAxes<f64>> {
    free("free-dzhanibekov-1e-3", 100.0)
}

/// The plate started 10⁻⁸ off: three flips in 300.
pub fn dzhanibekov_near() -> Case<PrincipalAxes<f64>> {
    free("free-dzhanibekov-1e-8", 300.0)
}

/// Two moments that differ by 10⁻⁶.
pub fn nearly_symmetric() -> Case<PrincipalAxes<f64>> {
    free("free-near-symmetric", 100.0)
}

/// A rod, moments 1 : 1000.
pub fn elongated() -> Case<PrincipalAxes<f64>> {
    free("free-elongated-1000", 5.0)
}

/// A body that spins at 1000 rad/s.
pub fn fast_spin() -> Case<PrincipalAxes<f64>> {
    free("free-fast-spin-1000", 0.5)
}

/// The heavy top benchmark, 150 rad/s.
pub fn benchmark_top() -> Case<BenchmarkTop<f64>> {
    let system = |reference: &Reference| {
        let [x, l, z] = reference.parameter("s");
        assert_eq!([x, z], [0.0; 2], "the centre of mass is on axis 2");
        let ([m], [j1, j2, j3]) = (reference.parameter("m"), moments(reference));
        assert_eq!(j1, j3, "a symmetric top");
        BenchmarkTop::new(BenchmarkTopParameters {
            m,
            g: reference.gravity(),
            l,
            a: j1,
            c: j2,
        })
        .expect("a body")
    };
    let none = Box::new(|_, _: &_, _: &_| []);
    rotation("heavy-top-benchmark-150", 1.0, system, none)
}

/// Kovalevskaya's top.
pub fn kovalevskaya() -> Case<KovalevskayaTop<f64>> {
    let system = |reference: &Reference| {
        let [a, y, z] = reference.parameter("s");
        let ([m], [j1, j2, j3]) = (reference.parameter("m"), moments(reference));
        assert_eq!([y, z], [0.0; 2], "the centre of mass is on axis 1");
        assert_eq!([j1, j2], [2.0 * j3; 2], "moments 2 : 2 : 1");
        KovalevskayaTop::new(KovalevskayaTopParameters {
            m,
            g: reference.gravity(),
            a,
            c: j3,
        })
        .expect("a body")
    };
    let none = Box::new(|_, _: &_, _: &_| []);
    rotation("kovalevskaya-top", 20.0, system, none)
}

fn lagrange(name: &'static str, until: f64) -> Case<LagrangeTop<f64>> {
    let system = |reference: &Reference| {
        let [x, y, l] = reference.parameter("s");
        let ([m], [j1, j2, j3]) = (reference.parameter("m"), moments(reference));
        assert_eq!([x, y], [0.0; 2], "the centre of mass is on axis 3");
        assert_eq!(j1, j2, "a symmetric top");
        LagrangeTop::new(LagrangeTopParameters {
            m,
            g: reference.gravity(),
            l,
            a: j1,
            c: j3,
        })
        .expect("a body")
    };
    rotation(name, until, system, Box::new(|_, _, _| []))
}

/// A fast top.
pub fn fast_top() -> Case<LagrangeTop<f64>> {
    lagrange("lagrange-fast-top", 5.0)
}

/// A sleeping top, 1 % above its critical spin.
pub fn sleeping_top() -> Case<LagrangeTop<f64>> {
    lagrange("lagrange-sleeping-top-stable", 20.0)
}

/// A top that swings through the upright position.
pub fn vertical_top() -> Case<LagrangeTop<f64>> {
    lagrange("lagrange-top-through-vertical", 10.0)
}

/// A satellite with gravity gradient; the direction from the planet is an input.
pub fn gravity_gradient() -> Case<Satellite<f64>> {
    const NAME: &str = "satellite-gravity-gradient";
    let rate = |reference: &Reference| {
        let [rate] = reference.parameter("orbit_rate_n");
        rate
    };
    let system = |reference: &Reference| {
        let [j1, j2, j3] = moments(reference);
        Satellite::new(SatelliteParameters {
            j1,
            j2,
            j3,
            n: rate(reference),
        })
        .expect("a body")
    };
    let n: f64 = rate(&Reference::read(NAME));
    let outward = Box::new(move |t: f64, _: &_, _: &_| [(n * t).cos(), (n * t).sin(), 0.0]);
    Case {
        measure: Measure::Largest,
        ..rotation(NAME, 20000.0, system, outward)
    }
}

fn flight(name: &'static str) -> Case<FreeBody<f64>> {
    let reference = Reference::read(name);
    let [m] = reference.parameter("m");
    let (s, inertia) = (reference.parameter("s"), reference.matrix("Theta"));
    let wrench: [f64; 6] = join(
        reference.parameter::<3>("F"),
        reference.parameter::<3>("tau"),
    );
    Case {
        name,
        system: FreeBody::new(FreeBodyParameters {
            m,
            g: reference.gravity(),
            s,
            theta: inertia,
        })
        .expect("a body"),
        start: State {
            t: 0.0,
            x: join(reference.initial::<3>("r"), reference.initial::<9>("R")),
            xi: join(reference.initial::<3>("v"), reference.initial::<3>("omega")),
        },
        until: 10.0,
        inputs: Box::new(move |_, _, _| wrench),
        fields: |_, state| {
            let mut r = [0.0; 9];
            r.copy_from_slice(&state.x[3..]);
            vec![
                Field::Numbers("r", state.x[..3].to_vec()),
                Field::Rotation("R", r),
                Field::Numbers("v", state.xi[..3].to_vec()),
                Field::Numbers("omega", state.xi[3..].to_vec()),
            ]
        },
        measure: Measure::Largest,
        reference,
    }
}

/// A thrown body whose frame is not at the centre of mass.
pub fn offset_body() -> Case<FreeBody<f64>> {
    flight("free-body-offset-gravity")
}

/// A drone under a constant wrench in body axes.
pub fn constant_wrench() -> Case<FreeBody<f64>> {
    flight("quadrotor-constant-wrench")
}

/// A spherical pendulum that passes both poles: a bob on a rod with the rotational inertia of a sphere, ω̇ = n × g / l,
/// ṅ = ω × n (all in world axes).
pub fn spherical_pendulum() -> Case<SphericalBob<f64>> {
    let reference = Reference::read("spherical-pendulum-through-poles");
    let ([m], [l]) = (reference.parameter("m"), reference.parameter("l"));
    let n: [f64; 3] = reference.initial::<3>("x").map(|x| x / l);
    let tilt = so3::cross([0.0, 0.0, 1.0], n);
    let (sin, cos) = (so3::dot(tilt, tilt).sqrt(), n[2]);
    let angle = sin.atan2(cos);
    Case {
        name: "spherical-pendulum-through-poles",
        system: SphericalBob::new(SphericalBobParameters {
            m,
            g: reference.gravity(),
            l,
        })
        .expect("a body"),
        start: State {
            t: 0.0,
            x: so3::exp(tilt.map(|t| t / sin * angle)),
            xi: so3::cross(n, reference.initial("xdot")).map(|w| w / l),
        },
        until: 10.0,
        inputs: Box::new(|_, _, _| []),
        fields: |system, state| {
            let (x, xi) = (&state.x, &state.xi);
            vec![
                Field::Numbers("x", system.bob(x).to_vec()),
                Field::Numbers("xdot", system.speed(x, xi).to_vec()),
            ]
        },
        measure: Measure::Largest,
        reference,
    }
}

/// Concatenates two lists.
pub(crate) fn join<const A: usize, const B: usize, const C: usize>(
    a: [f64; A],
    b: [f64; B],
) -> [f64; C] {
    assert_eq!(A + B, C, "the lengths add up");
    std::array::from_fn(|k| if k < A { a[k] } else { b[k - A] })
}
