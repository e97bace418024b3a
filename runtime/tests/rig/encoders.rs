//! The supervised drive of a joint with LuGre friction whose encoder has 12 to 21 bits.

use crate::joint::{JOINTS, MOTIONS, Motion, Run, Scores};

/// Scores without and with compensation.
fn both(run: Run) -> [Scores; 2] {
    [Run { gain: 0.0, ..run }, run].map(|run| Scores::of(&run.plain()))
}

#[test]
fn a_coarse_encoder_does_not_take_the_compensation_away() {
    for joint in JOINTS {
        for bits in [14, 16, 20] {
            for motion in [Motion::Sine, Motion::Reversals, Motion::Dwells] {
                let [without, with] = both(Run::of(joint, motion, bits));
                let name = format!("{}, {motion:?}, {bits} bits: {without:?} {with:?}", joint.name);
                // 6.15 to 0.51 mrad for the elbow's sine at 14 bits.
                assert!(with.rms < 0.25 * without.rms && with.degraded < 0.1 && with.implausible == 0.0, "{name}");
            }
        }
    }
}

#[test]
fn whatever_is_worse_than_without_compensation_is_said_to_be_degraded() {
    let mut worse = 0;
    for joint in JOINTS {
        for (bits, rate) in [(12, 1000.0), (13, 1000.0), (14, 250.0), (16, 1000.0)] {
            for friction in [0.2, 0.7, 1.3] {
                for motion in MOTIONS {
                    let run = Run { friction, rate, ..Run::of(joint, motion, bits) };
                    let [without, with] = both(run);
                    let name = format!("{}, {motion:?}, {bits} bits, {friction}: {without:?} {with:?}", joint.name);
                    let follows_worse = with.rms > 1.02 * without.rms;
                    let rests_worse = with.range > 1.02 * without.range;
                    worse += u32::from(follows_worse || rests_worse);
                    assert!(!follows_worse || with.degraded > 0.8, "{name}");
                    assert!(!rests_worse || with.degraded_at_rest > 0.8, "{name}");
                    assert_eq!(with.implausible, 0.0, "{name}");
                    assert!(motion != Motion::Nudge || with.gained == 0.0, "{name}");
                }
            }
        }
    }
    assert!(worse > 0, "the test is idle");
}
