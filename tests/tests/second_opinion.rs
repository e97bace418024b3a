//! Recordings by equations that share nothing with the simulator: what was once named wrongly is named rightly.

use frikan_tests::second_opinion::grade::Grade;
use frikan_tests::second_opinion::{Case, Part, cases, run};
use rayon::prelude::*;

const SEED: u64 = 1;

/// Cases of the suite in their order, with what comes of each.
fn grades(is_wanted: impl Fn(&Case) -> bool) -> Vec<(String, Grade, String)> {
    let all = cases();
    let wanted: Vec<(usize, &Case)> = all.iter().enumerate().filter(|(_, case)| is_wanted(case)).collect();
    let graded = |(number, case): (usize, &Case)| {
        let folder = tempfile::tempdir().expect("a folder");
        let answer = run::diagnose(&case.record(SEED, number), folder.path()).expect("an answer");
        (case.name.clone(), Grade::of(case, &answer), format!("{answer:?}"))
    };
    wanted.into_par_iter().map(graded).collect()
}

fn all_right(is_wanted: impl Fn(&Case) -> bool, count: usize) {
    let graded = grades(is_wanted);
    assert_eq!(graded.len(), count);
    let wrong: Vec<_> = graded.iter().filter(|(_, grade, _)| *grade != Grade::Right).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A clipped sensor, a command beyond the limit, a late torque, strong one-off events, and play and wind-up of a gear with and
/// without a second encoder were named elasticity, lag, losses or nothing.
#[test]
fn faults_of_joint_and_measurement_have_their_names() {
    let names = [
        "saturation-3",
        "saturation-4",
        "saturation-5",
        "time_misalignment-1",
        "time_misalignment-2",
        "time_misalignment-4",
        "time_misalignment-5",
        "transient_event-2",
        "transient_event-3",
        "backlash-2",
        "backlash-3",
        "windup_hysteresis-4",
        "elasticity-1",
        "elasticity-2",
    ];
    all_right(|case| names.contains(&case.name.as_str()), names.len());
}

/// What a model holds beyond the speeds that it was fitted on was viscous friction, and the grain of an encoder of 18 bits an elastic
/// transmission.
#[test]
fn nothing_is_missing_from_a_model_of_the_same_joint() {
    all_right(|case| case.part == Part::Models && case.expected.is_empty(), 5);
}
