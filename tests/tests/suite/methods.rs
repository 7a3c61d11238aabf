//! Runs methods on generated systems, by the traits that the generator implements for them.

use hamel::methods::{Gauss6, Rkmk4, Rkmk8, Scheme, Splitting};
use hamel::rotor::{Rotor, Symmetry};
use hamel::{Canonical, Method, Split, State, System, integrate};
use hamel_tests::benchmark_top::BenchmarkTop;
use hamel_tests::four_bar::FourBar;
use hamel_tests::free_body::FreeBody;
use hamel_tests::free_body_both::FreeBodyBoth;
use hamel_tests::free_body_world::WorldBody;
use hamel_tests::heavy_top_columns::ColumnTop;
use hamel_tests::pendulum::Pendulum;
use hamel_tests::planar_world::PlanarWorld;
use hamel_tests::principal_axes::PrincipalAxes;
use hamel_tests::reference::relative;
use hamel_tests::rod_particles::RodParticles;
use hamel_tests::spherical_bob::SphericalBob;
use hamel_tests::two_bodies::TwoBodies;

/// Bound of the difference of two high-order methods, with steps at which rounding dominates both.
const TOLERANCE: f64 = 1e-10;

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

/// Splitting, Gauss and RKMK methods reach the same final state, in any coordinates of the system.
fn agree<Sys>(system: &Sys, u: &Sys::Inputs)
where
    Sys: Split<Scalar = f64> + Canonical,
{
    let expected = end(system, Rkmk8, 400, 1.0, u);
    let splitting = Splitting::new(system, Scheme::Nystrom6);
    let ends = [
        end(system, splitting, 200, 1.0, u),
        end(system, Gauss6, 400, 1.0, u),
    ];
    for found in ends {
        let error = relative(found.x.as_ref(), expected.x.as_ref());
        let error = error.max(relative(found.xi.as_ref(), expected.xi.as_ref()));
        assert!(error <= TOLERANCE, "{error:e}");
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

/// Symmetries that follow from the description are constants of the types, for all parameters.
#[test]
fn symmetries_of_rotors_are_known() {
    let symmetry = |rotors: &[Rotor<f64>]| rotors.first().map(|rotor| rotor.symmetry);
    let top = BenchmarkTop::default();
    assert_eq!(symmetry(&top.rotors()), Some(Symmetry::Axial(1)));
    let bob = SphericalBob::default();
    assert_eq!(symmetry(&bob.rotors()), Some(Symmetry::Spherical));
    const { assert!(<PrincipalAxes<f64> as Split>::FREE) };
    const { assert!(!<FreeBody<f64> as Split>::FREE) };
}

/// A chain of bodies has momenta but cannot be split: its inertia depends on the configuration.
#[test]
fn chains_of_bodies_run_by_gauss() {
    let system = TwoBodies::default();
    let expected = end(&system, Rkmk8, 400, 0.5, &[]);
    let found = end(&system, Gauss6, 400, 0.5, &[]);
    assert!(relative(&found.x, &expected.x) <= TOLERANCE);
}

/// Coordinate constraints that are not built into a chart hold up to rounding in long runs, and the projection does not
/// reduce the order.
fn is_led_back<Sys: System<Scalar = f64>>(system: &Sys) {
    let u = system.zero_inputs();
    let long = end(system, Rkmk4, 20_000, 100.0, &u);
    let off = system.constraint_norm(&long.x);
    assert!(off < 1e-11, "off by {off:e} at the end");
    let exact = end(system, Rkmk8, 800, 0.5, &u);
    let [coarse, fine] = [100, 200].map(|steps| {
        let found = end(system, Rkmk4, steps, 0.5, &u);
        relative(found.x.as_ref(), exact.x.as_ref())
            .max(relative(found.xi.as_ref(), exact.xi.as_ref()))
    });
    let order = (coarse / fine).log2();
    assert!(
        (order - 4.0).abs() < 0.3,
        "order {order}: {coarse:e} {fine:e}"
    );
    let mut adaptive = State::start(system);
    hamel::adaptive::Adaptive::rkmk54(1e-6)
        .integrate(
            system,
            &mut adaptive,
            10.0,
            |_, _, _| u.clone(),
            &[],
            |_| {},
        )
        .expect("a run");
    let off = system.constraint_norm(&adaptive.x);
    assert!(off < 1e-11, "off by {off:e} with steps by tolerance");
}

#[test]
fn what_no_chart_keeps_is_led_back_to() {
    is_led_back(&Pendulum::default());
    is_led_back(&FourBar::default());
    is_led_back(&ColumnTop::default());
    is_led_back(&RodParticles::default());
}
