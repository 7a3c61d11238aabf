//! The functions that can be requested: their names, and dependencies between them.

use hamel_language::functions::{Asked, FunctionId, Needs, Serves};

#[test]
fn names_are_told_apart() {
    for &id in FunctionId::ALL {
        assert_eq!(FunctionId::from_name(id.name()), Some(id));
    }
}

#[test]
fn a_type_that_is_linearised_can_be_simulated() {
    let asked = Asked::only(&[FunctionId::Linearize]);
    for &id in FunctionId::ALL {
        let system = matches!(id.row().serves, Serves::System | Serves::Tangent);
        assert_eq!(
            asked.wants(id),
            system || id == FunctionId::Linearize,
            "{id:?}"
        );
    }
}

#[test]
fn what_needs_no_inverse_does_not_ask_for_one() {
    let everything = Asked::everything();
    assert_eq!(everything.needs(), Needs::Inverse);
    let singular = everything.without(Needs::Inverse);
    assert_eq!(singular.needs(), Needs::Inertia);
    assert!(singular.wants(FunctionId::Bias) && !singular.wants(FunctionId::Accel));
    let massless = everything.without(Needs::Inertia);
    assert_eq!(massless.needs(), Needs::Nothing);
    assert!(massless.wants(FunctionId::Rate) && !massless.wants(FunctionId::Bias));
    let inverse_dynamics = Asked::only(&[FunctionId::InverseDynamics]);
    assert_eq!(inverse_dynamics.needs(), Needs::Inertia);
    assert!(!inverse_dynamics.wants(FunctionId::Rate));
    assert_eq!(Asked::only(&[FunctionId::Rate]).needs(), Needs::Nothing);
}
