//! Claims of invariance: proved if they are true, refused by every front end if they are not, and monitored by
//! generated functions.

use hamel::methods::Rkmk4;
use hamel::{State, System, integrate};
use hamel_codegen::builder::source;
use hamel_codegen::generate::from_text;
use hamel_codegen::proof::check::{Identity, Verdict, check};
use hamel_tests::cart_rods::CartRods;
use hamel_tests::double_spherical_pendulum::DoubleSphericalPendulum;
use hamel_tests::euler_top_quaternion::EulerTop;
use hamel_tests::free_body_momenta::FreeBodyMomenta;
use hamel_tests::kovalevskaya_top::KovalevskayaTop;
use hamel_tests::lagrange_top::LagrangeTop;
use hamel_tests::quadrotor_load::QuadrotorLoad;
use hamel_tests::satellite_arm::SatelliteArm;
use hamel_tests::spherical_pendulum::SphericalPendulum;
use std::path::Path;

/// Relative drift of an invariant in a run of 2 s with steps of 0.5 ms: h⁴ times the fifth power of rates of up to 20 /
/// s.
const MAX_DRIFT: f64 = 1e-7;

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.eom"));
    std::fs::read_to_string(path).expect("the model is in the repository")
}

fn claims(text: &str) -> Vec<Identity> {
    let generated = from_text(text).unwrap_or_else(|errors| panic!("{errors:?}"));
    let mut all = check(&generated.model, &generated.program);
    all.retain(|identity| identity.label == "invariant");
    all
}

#[test]
fn textbook_invariants_are_proved_over_the_rationals() {
    for (name, count) in [
        ("lagrange_top", 3),
        ("kovalevskaya_top", 3),
        ("free_body_momenta", 4),
        ("spherical_pendulum", 2),
        ("euler_top_quaternion", 3),
    ] {
        let claims = claims(&text(name));
        assert_eq!(claims.len(), count, "{name}");
        for claim in claims {
            assert_eq!(claim.verdict, Verdict::Proved, "{name}: {}", claim.equation);
        }
    }
}

/// Returns a system of one bead, with more statements.
fn bead(statements: &str) -> String {
    format!(
        "system S {{ param m = 1, k = 2, d = 0.1; coord x; velocity v; rate x = v; input F;
           particle mass m at [x, 0, 0]; potential k * x^2 / 2;
           generalized force v = F - d * v; {statements} }}"
    )
}

#[test]
fn conditions_set_inputs_and_parameters() {
    for claim in [
        "invariant energy when F = 0, d = 0;",
        "invariant e = m * v^2 + k * x^2 when F = 0, d = 0;",
        "invariant p = linear_momentum along [1, 0, 0] when F = 0, d = 0, k = 0;",
        // A root that is not a polynomial, and a division.
        "invariant a = sqrt(m * v^2 + k * x^2) when F = 0, d = 0;",
        "invariant r = 1 / (m * v^2 + k * x^2) when F = 0, d = 0;",
        // The force that balances friction is a value, too.
        "invariant level = linear_momentum along [0, 1, 0];",
    ] {
        let claims = claims(&bead(claim));
        assert_eq!(claims.len(), 1);
        assert!(
            !matches!(claims[0].verdict, Verdict::Failed(_)),
            "{claim}: {:?}",
            claims[0]
        );
    }
    for (claim, leaves) in [
        ("invariant energy;", "d/dt leaves -d v^2 + v F"),
        ("invariant energy when F = 0;", "d/dt leaves -d v^2"),
        ("invariant energy when d = 0;", "d/dt leaves v F"),
        (
            "invariant p = linear_momentum along [1, 0, 0] when F = 0, d = 0;",
            "d/dt leaves -k x",
        ),
        (
            "invariant e = v^2 + x^2 when F = 0, d = 0, k = 3;",
            "is not constant",
        ),
    ] {
        let errors = from_text(&bead(claim)).expect_err("a false claim");
        assert_eq!(errors.len(), 1);
        assert!(errors[0].message.contains(leaves), "{}", errors[0].message);
    }
}

#[test]
fn false_claims_are_refused_at_every_door() {
    let text = bead("invariant energy;");
    let tokens: proc_macro2::TokenStream = text.parse().expect("tokens");
    let expanded = hamel_codegen::expand(tokens).to_string();
    assert!(expanded.contains("compile_error"), "{expanded}");
    assert!(expanded.contains("d/dt leaves"), "{expanded}");
    assert!(!expanded.contains("fn accel"));
    assert!(source(&text, "bead.eom").is_err());
    assert!(from_text(&text).is_err());
}

/// Checks the relative change of monitored functions in a run from the start.
fn drift<Sys>(system: &Sys, watched: impl Fn(&Sys, &Sys::Coordinates, &Sys::Velocities) -> Vec<f64>)
where
    Sys: System<Scalar = f64>,
{
    driven(system, system.zero_inputs(), watched);
}

/// Checks the relative change under constant inputs.
fn driven<Sys>(
    system: &Sys,
    inputs: Sys::Inputs,
    watched: impl Fn(&Sys, &Sys::Coordinates, &Sys::Velocities) -> Vec<f64>,
) where
    Sys: System<Scalar = f64>,
{
    let mut state = State::start(system);
    let first = watched(system, &state.x, &state.xi);
    let mut worst = vec![0.0_f64; first.len()];
    let inputs = |_, _: &_, _: &_| inputs.clone();
    let observe = |state: &State<Sys>| {
        for (worst, (now, first)) in worst
            .iter_mut()
            .zip(watched(system, &state.x, &state.xi).iter().zip(&first))
        {
            *worst = worst.max((now - first).abs() / first.abs().max(1.0));
        }
    };
    integrate(system, Rkmk4, &mut state, 5e-4, 2.0, inputs, observe).expect("a run");
    for worst in worst {
        assert!(worst < MAX_DRIFT, "{worst:e}");
    }
}

#[test]
fn generated_functions_watch_the_invariants() {
    drift(&LagrangeTop::<f64>::default(), |s, x, xi| {
        vec![
            s.energy(x, xi),
            s.vertical_momentum(x, xi),
            s.spin_momentum(x, xi),
        ]
    });
    drift(&KovalevskayaTop::<f64>::default(), |s, x, xi| {
        vec![
            s.energy(x, xi),
            s.vertical_momentum(x, xi),
            s.kovalevskaya(x, xi),
        ]
    });
    drift(&FreeBodyMomenta::<f64>::default(), |s, x, xi| {
        let vectors = [
            s.linear_momentum(x, xi),
            s.angular_momentum(x, xi),
            s.spin(x, xi),
        ];
        vectors
            .into_iter()
            .flatten()
            .chain([s.kinetic(x, xi)])
            .collect()
    });
    drift(&SphericalPendulum::<f64>::default(), |s, x, xi| {
        vec![s.energy(x, xi), s.angular_momentum(x, xi)]
    });
    drift(&EulerTop::<f64>::default(), |s, x, xi| {
        let mut watched = s.angular_momentum(x, xi).to_vec();
        watched.extend([s.energy(x, xi), s.sphere(x, xi)]);
        watched
    });
    drift(&CartRods::<f64>::default(), |s, x, xi| {
        vec![s.energy(x, xi), s.p(x, xi)]
    });
    drift(&DoubleSphericalPendulum::<f64>::default(), |s, x, xi| {
        vec![s.energy(x, xi)]
    });
    drift(&QuadrotorLoad::<f64>::default(), |s, x, xi| {
        vec![s.energy(x, xi)]
    });
}

/// Loads between links change neither momentum nor angular momentum of the whole.
#[test]
fn an_arm_at_work_keeps_the_momenta_of_its_satellite() {
    let torques = [2.0, -1.5, 1.0, 0.8, -0.3, 0.05, 0.01];
    driven(&SatelliteArm::<f64>::default(), torques, |s, x, xi| {
        let momenta = [s.linear_momentum(x, xi), s.angular_momentum(x, xi)];
        momenta.concat()
    });
}
