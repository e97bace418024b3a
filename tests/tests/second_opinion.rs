//! Recordings by code that is independent of the simulator: what was once named wrongly is named rightly.

use frikan_tests::exhaustive;
use frikan_tests::second_opinion::grade::Grade;
use frikan_tests::second_opinion::{Case, Part, cases, run};
use rayon::prelude::*;

const SEED: u64 = 1;
/// Another, with which other cases went wrong.
const OTHER_SEED: u64 = 104;

/// Cases of the suite in their order, with what comes of each.
fn grades(seed: u64, is_wanted: impl Fn(&Case) -> bool) -> Vec<(String, Grade, String)> {
    let all = cases();
    let wanted: Vec<(usize, &Case)> = all.iter().enumerate().filter(|(_, case)| is_wanted(case)).collect();
    let graded = |(number, case): (usize, &Case)| {
        let folder = tempfile::tempdir().expect("a folder");
        let answer = run::diagnose(&case.record(seed, number), folder.path()).expect("an answer");
        (case.name.clone(), Grade::of(case, &answer), format!("{answer:?}"))
    };
    wanted.into_par_iter().map(graded).collect()
}

/// The first two seeds; all of them with `FRIKAN_EXHAUSTIVE=1`.
fn some_of(seeds: &[u64]) -> Vec<u64> {
    seeds[..if exhaustive() { seeds.len() } else { 2 }].to_vec()
}

fn all_right(seed: u64, is_wanted: impl Fn(&Case) -> bool, count: usize) {
    let graded = grades(seed, is_wanted);
    assert_eq!(graded.len(), count);
    let wrong: Vec<_> = graded.iter().filter(|(_, grade, _)| *grade != Grade::Right).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn named_are_right(seed: u64, names: &[&str]) {
    all_right(seed, |case| names.contains(&case.name.as_str()), names.len());
}

/// A clipped sensor, a command beyond the limit, a late torque, strong one-off events, and play and wind-up of a gear with and
/// without a second encoder were named elasticity, lag, losses or nothing.
#[test]
fn faults_of_joint_and_measurement_have_their_names() {
    let names = [
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
    named_are_right(SEED, &names);
}

/// A limit that is exceeded at one time of the recording is a one-off event as well, and stated together with it.
#[test]
fn a_limit_that_is_exceeded_once_is_stated_beside_an_event() {
    let graded = grades(SEED, |case| case.name == "saturation-3");
    assert!(matches!(graded[..], [(_, Grade::Right | Grade::InTheSet, _)]), "{graded:#?}");
}

/// What a model holds beyond the speeds that it was fitted on was viscous friction, and the grain of an encoder of 18 bits an elastic
/// transmission.
#[test]
fn nothing_is_missing_from_a_model_of_the_same_joint() {
    all_right(SEED, |case| case.part == Part::Models && case.expected.is_empty(), 5);
}

/// A reversal between two samples of 100 Hz was Stribeck friction, and friction that turns over softly presliding.
#[test]
fn what_happens_between_two_samples_has_no_name() {
    let names = ["control-3", "control-6", "control-9", "control-12", "control-15", "control-20"];
    named_are_right(OTHER_SEED, &names);
}

/// Friction that turns over within a hundredth of the top speed was presliding and a lag, where the noise is small.
#[test]
fn friction_that_turns_over_softly_has_no_name() {
    for seed in some_of(&[310, 311, 312]) {
        named_are_right(seed, &["control-19"]);
    }
}

/// A position that is sampled early or late though its clock is even was an elastic transmission or a wind-up.
#[test]
fn scattered_instants_of_sampling_have_no_name() {
    for seed in some_of(&[321, 322, 323]) {
        named_are_right(seed, &["clock-unseen-jitter"]);
    }
}

/// Steps of a sixth of Coulomb friction beside a weight were a local fault and a ripple. Where a static model leaves no more than they, nothing is
/// missing and nothing has to be repaired.
#[test]
fn a_torque_in_coarse_steps_has_no_physics() {
    for (seed, name) in [(330, "quantisation-5"), (351, "quantisation-1")] {
        let graded = grades(seed, |case| case.name == name);
        assert!(matches!(graded[..], [(_, Grade::Right | Grade::Nothing, _)]), "{graded:?}");
    }
}

/// What a simulation does below the speeds at which it has rows was drawn from its noise, and the difference Stribeck friction.
#[test]
fn what_no_row_of_a_simulation_tells_has_no_name() {
    named_are_right(320, &["simulation-6"]);
}

/// Of friction that is linear in the position a ripple was kept, which holds one term of nine of its series.
#[test]
fn a_series_is_no_ripple() {
    named_are_right(330, &["position_friction-2", "position_friction-6"]);
}

/// In ten seconds of slow noise two long series took up so much of it that whatever is slow seemed more than noise.
#[test]
fn slow_noise_of_a_short_recording_has_no_name() {
    for seed in some_of(&[203, 205, 210]) {
        named_are_right(seed, &["control-17"]);
    }
}

/// What a formula of a large effect gets wrong in one place was a one-off event, and break-away of half the Coulomb friction was of
/// little account where a weight pulls.
#[test]
fn beside_a_large_effect_a_small_one_counts_by_its_place_and_by_the_friction() {
    let names = ["warm_up-2", "contact-5", "pair-5", "pair-7"];
    named_are_right(OTHER_SEED, &names);
}
