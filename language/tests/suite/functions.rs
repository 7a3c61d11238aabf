//! The functions that can be asked for: their names, and which of them serve others.

use hamel_language::functions::{Asked, FunctionId, Serves};

#[test]
fn names_are_told_apart() {
    for &id in FunctionId::ALL {
        assert_eq!(FunctionId::named(id.name()), Some(id));
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
    assert!(Asked::everything().wants_inverse());
    assert!(!Asked::without_inverse().wants_inverse());
    assert!(Asked::without_inverse().wants(FunctionId::Bias));
    assert!(!Asked::only(&[FunctionId::InverseDynamics]).wants_inverse());
    assert!(!Asked::only(&[FunctionId::InverseDynamics]).wants(FunctionId::Rate));
}
