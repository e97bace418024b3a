//! What a recording cannot tell apart, the proposed motion does.

use frikan_tests::concealed::advised::{pairs, run};
use frikan_tests::exhaustive;

/// Pairs of the proof in which position or acceleration hides which of two torques acts; the first two that are open tell enough, all of them with
/// `FRIKAN_EXHAUSTIVE=1`.
const SHOWN: [(&str, &str); 4] = [
    ("gravity_error", "spring"),
    ("spring", "gravity_error"),
    ("torque_scale", "inertia_error"),
    ("inertia_error", "torque_scale"),
];

#[test]
fn the_proposed_motion_tells_confounded_effects_apart() {
    let (mut open, mut resolved) = (0, 0);
    for case in pairs().iter().filter(|case| SHOWN.contains(&(case.truth, case.rival))) {
        if open == 2 && !exhaustive() {
            break;
        }
        let advised = run(case, 1).unwrap_or_else(|error| panic!("{case:?}: {error}"));
        let words = advised.plan.as_ref().map_or("nothing", |plan| plan.words.as_str());
        println!("{} / {}: {words}, reached {:?}", case.truth, case.rival, advised.reached_nats(case));
        if advised.was_open(case) && advised.plan.is_some() {
            open += 1;
            resolved += usize::from(advised.is_resolved(case));
        }
    }
    assert!(open >= 2, "{open} of {} recordings leave their pair open", SHOWN.len());
    assert_eq!(resolved, open);
}
