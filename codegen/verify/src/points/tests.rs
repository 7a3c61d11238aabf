//! Tests of fresh points: agreement requires all of them.

use super::{COMPARED_POINTS, Disagreement, MAX_FAILED_SEARCHES, compare_at_fresh_points};
use hamel_algebra::field_point::FieldPoint;

#[test]
fn too_few_points_are_no_agreement() {
    let point = |_| Some(FieldPoint::new());
    let some =
        |most: u64| move |_: &FieldPoint, number| (number <= most).then_some(Ok::<(), ()>(()));
    assert_eq!(
        compare_at_fresh_points(point, some(COMPARED_POINTS)),
        Ok(())
    );
    assert_eq!(
        compare_at_fresh_points(point, some(COMPARED_POINTS - 1)),
        Err(Disagreement::Nowhere)
    );
    let looked = std::cell::Cell::new(0);
    let nowhere = |number| {
        looked.set(number);
        None
    };
    assert_eq!(
        compare_at_fresh_points(nowhere, some(COMPARED_POINTS)),
        Err(Disagreement::Nowhere)
    );
    assert_eq!(looked.get(), MAX_FAILED_SEARCHES);
    let last = |_: &FieldPoint, number| {
        Some(if number < COMPARED_POINTS {
            Ok(())
        } else {
            Err(number)
        })
    };
    assert_eq!(
        compare_at_fresh_points(point, last),
        Err(Disagreement::Differs(COMPARED_POINTS))
    );
}
