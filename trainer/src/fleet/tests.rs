//! Fleets of which the truth is known: who differs is found, who does not is not, whatever their number and spread.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::discoveries::{adjusted, of_any};
use super::trend::{Dated, trends};
use super::*;
use crate::numerics::random::normal;
use crate::parameter::Parameter;

/// A joint with Coulomb friction, known to 1 %.
pub(super) fn measured(joint: &str, friction: f64) -> Measured {
    let point = |v: f64| [v, v.signum() * friction, 0.01 * friction];
    let parameter = Parameter {
        name: "coulomb_torque".into(),
        symbol: "F_c".into(),
        value: friction,
        unit: "N m".into(),
        ci95: [0.98 * friction, 1.02 * friction],
    };
    let law = |name: &str, bic: f64| FittedLaw { name: name.into(), bic, parameters: vec![parameter.clone()] };
    Measured {
        joint: joint.into(),
        kind: "elbow".into(),
        day: None,
        unit: "N m".into(),
        laws: vec![law("Coulomb", -100.0), law("Stribeck", -90.0)],
        curve: (-10..=10).map(|i| point(0.1 * f64::from(i))).collect(),
        residual: 0.05,
        ripple: Some(Ripple { amplitude: 0.01, order: 12.0 }),
    }
}

/// Joints whose friction, residual and ripple scatter by 10, 15 and 30 %; every one of `faults` has half as much more of one of them.
fn fleet(count: usize, faults: &[usize], seed: u64) -> Vec<Measured> {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    (0..count)
        .map(|index| {
            let faulty = |kind: usize| faults.iter().position(|&fault| fault == index).is_some_and(|n| n % 3 == kind);
            let scale = |kind: usize, factor: f64| if faulty(kind) { factor } else { 1.0 };
            let friction = 2.0 * (0.1 * normal(&mut draws)).exp() * scale(0, 1.7);
            Measured {
                residual: 0.05 * (0.15 * normal(&mut draws)).exp() * scale(1, 2.2),
                ripple: Some(Ripple {
                    amplitude: 0.01 * (0.3 * normal(&mut draws)).exp() * scale(2, 5.0),
                    order: 12.0,
                }),
                ..measured(&format!("joint{index:04}"), friction)
            }
        })
        .collect()
}

fn outliers(survey: &Survey) -> Vec<&str> {
    survey.members.iter().filter(|member| member.is_outlier).map(|member| member.joint.as_str()).collect()
}

#[test]
fn of_a_thousand_joints_twenty_faults_are_found_and_hardly_a_healthy_one() {
    let faults: Vec<usize> = (0..20).map(|n| 17 + 43 * n).collect();
    let survey = survey(&fleet(1000, &faults, 1), 0.05);
    let names: Vec<String> = faults.iter().map(|n| format!("joint{n:04}")).collect();
    let found = outliers(&survey);
    let hits = found.iter().filter(|name| names.iter().any(|fault| fault == *name)).count();
    assert!(hits >= 18 && found.len() - hits <= 3, "{hits} of 20 found, {} false", found.len() - hits);
    let first = survey.members.iter().find(|member| member.joint == names[0]).unwrap();
    let reasons: Vec<&str> = first.compared.iter().filter(|c| c.stands_out).map(|c| c.quantity.name()).collect();
    assert_eq!(reasons, ["friction_slow", "friction_medium", "friction_fast"]);
}

#[test]
fn healthy_fleets_of_any_size_raise_no_more_alarms_than_stated() {
    // With no fault every alarm is a false discovery: the share of fleets with one is the stated one.
    for size in [6, 50] {
        let alarms = (0..200).filter(|&seed| !outliers(&survey(&fleet(size, &[], seed), 0.1)).is_empty()).count();
        assert!(alarms <= 30, "{alarms} of 200 fleets of {size} joints");
    }
}

#[test]
fn siblings_are_weighted_by_what_is_known_of_each() {
    let mut draws = ChaCha8Rng::seed_from_u64(3);
    let errors = |index: usize| if index.is_multiple_of(2) { 0.1 } else { 2.0 };
    let estimates: Vec<Estimate> = (0..2000)
        .map(|index| Estimate {
            value: 5.0 + 0.5 * normal(&mut draws) + errors(index) * normal(&mut draws),
            error: errors(index),
        })
        .collect();
    let siblings = Siblings::of(&estimates).unwrap();
    assert!((siblings.mean - 5.0).abs() < 0.06 && (siblings.spread - 0.5).abs() < 0.1, "{siblings:?}");
    let vague = siblings.shrunk(&Estimate { value: 9.0, error: 2.0 });
    assert!(vague.value < 5.5 && vague.error < 0.6, "{vague:?}");
    let known = siblings.shrunk(&Estimate { value: 9.0, error: 0.01 });
    assert!((known.value - 9.0).abs() < 0.01);
}

#[test]
fn without_a_spread_or_with_too_few_siblings_nobody_differs() {
    let alike = vec![Estimate { value: 1.0, error: 0.0 }; 10];
    assert_eq!(Siblings::of(&alike), None);
    assert_eq!(Siblings::of(&[Estimate { value: 1.0, error: 0.1 }; 3]), None);
    let measured_alike = vec![Estimate { value: 1.0, error: 0.1 }; 10];
    let siblings = Siblings::of(&measured_alike).unwrap();
    assert_eq!((siblings.spread, siblings.mean), (0.0, 1.0));
    assert!(outliers(&survey(&[measured("one", 1.0), measured("two", 9.0)], 0.05)).is_empty());
    assert!(survey(&[], 0.05).members.is_empty());
}

#[test]
fn the_law_of_a_kind_is_the_best_for_all_and_kinds_stay_apart() {
    let mut members = fleet(8, &[], 4);
    // One joint of the other kind, for which the other law is better, does not change that of its neighbours.
    members[0].kind = "wrist".into();
    members[0].laws[1].bic = -1e6;
    members[3].laws[1].bic = -95.0;
    let survey = survey(&members, 0.05);
    let laws: Vec<_> = survey.kinds.iter().map(|kind| (kind.name.as_str(), kind.law.as_deref().unwrap())).collect();
    assert_eq!(laws, [("elbow", "Coulomb"), ("wrist", "Stribeck")]);
    assert_eq!(survey.kinds[0].joints, 7);
    let (parameter, expected) = &survey.members[2].constants[0];
    assert!((expected.value - parameter.value).abs() < 0.01 * parameter.value && expected.error > 0.0);
}

#[test]
fn the_newest_recording_counts_and_a_joint_that_ages_faster_than_its_siblings_is_found() {
    let mut draws = ChaCha8Rng::seed_from_u64(5);
    let mut recordings = Vec::new();
    for joint in 0..30 {
        for month in (0..6).rev() {
            let rate = if joint == 7 { 0.25 } else { 0.02 } + 0.005 * f64::from(joint % 3);
            let years = f64::from(month) / 12.0;
            let friction = 2.0 * (rate * years + 0.004 * normal(&mut draws)).exp();
            let one = measured(&format!("joint{joint:02}"), friction);
            recordings.push(Measured { day: Some(30.4375 * f64::from(month)), ..one });
        }
    }
    let survey = survey(&recordings, 0.05);
    assert_eq!(outliers(&survey), ["joint07"]);
    let member = &survey.members[7];
    assert_eq!((member.recordings, member.day), (6, Some(30.4375 * 5.0)));
    let trend = member.compared[5].value.unwrap();
    assert!((trend.value - 0.255).abs() < 0.05 && trend.error < 0.05, "{trend:?}");
    let typical = survey.kinds[0].common[5].unwrap();
    assert!((typical.mean - 0.025).abs() < 0.01, "{typical:?}");
}

#[test]
fn the_scatter_between_recordings_is_that_of_most_joints() {
    let mut draws = ChaCha8Rng::seed_from_u64(6);
    let mut joints: Vec<Vec<Dated>> = (0..40)
        .map(|_| (0..5).map(|day| Dated { day: f64::from(day), value: 0.1 * normal(&mut draws) }).collect())
        .collect();
    joints[0][2].value = 50.0;
    joints.push(vec![Dated { day: 1.0, value: 0.0 }; 5]);
    let trends = trends(&joints);
    let error = trends[1].unwrap().slope.error;
    // 0.1 over the root of the sum of squares of five days, ten.
    assert!((error - 0.1 / 10f64.sqrt()).abs() < 0.008, "{error}");
    assert_eq!(trends[40], None, "all on one day");
}

#[test]
fn shares_of_false_discoveries_are_those_of_benjamini_and_hochberg() {
    let adjusted = adjusted(&[0.01, 0.04, 0.03, 0.5]);
    let expected = [0.04, 0.16 / 3.0, 0.16 / 3.0, 0.5];
    assert!(adjusted.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{adjusted:?}");
    assert_eq!(
        (of_any([0.01, 0.5].into_iter()), of_any([0.9, 0.8].into_iter()), of_any([].into_iter())),
        (0.02, 1.0, 1.0)
    );
}
