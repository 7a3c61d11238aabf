//! Methods on generated systems, by the traits that the generator implements for those they fit.

use hamel::methods::{Free, Gauss6, General, Scheme, Splitting, free};
use hamel::rotor::Symmetry;
use hamel::{Canonical, Method, Split, State, System, integrate};
use hamel_tests::benchmark_top::BenchmarkTop;
use hamel_tests::free_body::FreeBody;
use hamel_tests::free_body_both::FreeBodyBoth;
use hamel_tests::free_body_world::WorldBody;
use hamel_tests::planar_world::PlanarWorld;
use hamel_tests::principal_axes::PrincipalAxes;
use hamel_tests::reference::{Reference, distance, relative};
use hamel_tests::spherical_bob::SphericalBob;
use hamel_tests::two_bodies::TwoBodies;

/// Two methods of high order with steps at which both err by rounding.
const SAME: f64 = 1e-10;

fn end<Sys, M>(system: &Sys, method: M, steps: u32, until: f64, u: &Sys::Inputs) -> State<Sys>
where
    Sys: System<Scalar = f64>,
    M: Method<Sys>,
{
    let mut state = State::start(system);
    let h = until / f64::from(steps);
    integrate(
        system,
        method,
        &mut state,
        h,
        until,
        |_, _, _| u.clone(),
        |_| {},
    )
    .expect("a run");
    state
}

/// Splitting, Gauss and RKMK come to the same end, in whatever coordinates the system is written.
fn agree<Sys>(system: &Sys, u: &Sys::Inputs)
where
    Sys: Split<Scalar = f64> + Canonical,
{
    let expected = end(system, General::Rkmk8, 400, 1.0, u);
    let splitting = Splitting::new(system, Scheme::Nystrom6);
    let ends = [
        end(system, splitting, 200, 1.0, u),
        end(system, Gauss6, 400, 1.0, u),
    ];
    for found in ends {
        let error = relative(found.x.as_ref(), expected.x.as_ref());
        let error = error.max(relative(found.xi.as_ref(), expected.xi.as_ref()));
        assert!(error <= SAME, "{error:e}");
    }
}

#[test]
fn bodies_off_their_centres_in_all_coordinates() {
    agree(&FreeBody::default(), &[0.3, -0.2, 0.5, 0.1, 0.2, -0.1]);
    agree(
        &WorldBody::default(),
        &WorldBody::<f64>::default().zero_inputs(),
    );
    agree(
        &FreeBodyBoth::default(),
        &FreeBodyBoth::<f64>::default().zero_inputs(),
    );
    agree(&PlanarWorld::default(), &[1.0, -0.5]);
}

/// The bar of the issue: the benchmark to 1e-9 with at most 250 evaluations of the torque. Six kicks a
/// step and one more.
#[test]
fn benchmark_top_within_250_torques() {
    const STEPS: u32 = 41;
    let system = BenchmarkTop::default();
    assert_eq!(system.rotors()[0].symmetry, Symmetry::Axial(1));
    let end = end(
        &system,
        Splitting::new(&system, Scheme::Nystrom4),
        STEPS,
        1.0,
        &[],
    );
    let expected = Reference::read("heavy-top-benchmark-150").sample::<9>(1.0, "R");
    let error = distance(&end.x, &expected);
    assert!(6 * STEPS < 250 && error <= 1e-9, "{error:e}");
}

/// The bar for closed forms, of which the hardest case asks most: a flip at 1e-8 of a separatrix.
#[test]
fn closed_form_through_the_flips() {
    let reference = Reference::read("free-dzhanibekov-1e-8");
    let [[a, ..], [_, b, _], [.., c]] = reference.matrix("J");
    let system = PrincipalAxes::new(a, b, c).expect("a body");
    const { assert!(<PrincipalAxes<f64> as Split>::FREE) };
    let start = State {
        t: 0.0,
        x: reference.initial("R"),
        xi: reference.initial("omega"),
    };
    let found = free::at(&system, &start, 300.0).expect("no force acts");
    let error = distance(&found.xi, &reference.sample::<3>(300.0, "omega"));
    assert!(error <= 1e-13, "ω: {error:e}");
    let error = distance(&found.x, &reference.sample::<9>(300.0, "R"));
    assert!(error <= 1e-11, "R: {error:e}");
    assert_eq!(Method::<PrincipalAxes<f64>>::order(&Free), 0);
}

/// The spherical pendulum as a rotor of spherical inertia, through both poles.
#[test]
fn spherical_bob_through_the_poles() {
    let reference = Reference::read("spherical-pendulum-through-poles");
    let [l] = reference.parameter("l");
    let mut system = SphericalBob::default();
    system.set_l(l).expect("a length");
    assert_eq!(system.rotors()[0].symmetry, Symmetry::Spherical);
    let x0: [f64; 3] = reference.initial("x");
    let axis = hamel::so3::cross([0.0, 0.0, 1.0], x0);
    let sine = hamel::so3::dot(axis, axis).sqrt();
    let turn = axis.map(|a| a / sine * sine.atan2(x0[2]));
    let w = hamel::so3::cross(x0, reference.initial("xdot"));
    let mut state = State {
        t: 0.0,
        x: hamel::so3::exp(turn),
        xi: w.map(|w| w / (l * l)),
    };
    let method = Splitting::new(&system, Scheme::Nystrom6);
    integrate(
        &system,
        method,
        &mut state,
        0.01,
        10.0,
        |_, _, _| [],
        |_| {},
    )
    .expect("a run");
    let bob = system.bob(&state.x, &state.xi, &[]);
    let error = relative(&bob, &reference.sample::<3>(10.0, "x"));
    assert!(error <= 1e-10, "{error:e}");
}

/// A chain of bodies has momenta, but nothing to split: its inertia depends on the configuration.
#[test]
fn chains_of_bodies_run_by_gauss() {
    let system = TwoBodies::default();
    let expected = end(&system, General::Rkmk8, 400, 0.5, &[]);
    let found = end(&system, Gauss6, 400, 0.5, &[]);
    assert!(relative(&found.x, &expected.x) <= SAME);
}
