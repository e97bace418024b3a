use super::*;
use crate::effects::{Motion, presliding};
use crate::usable::Usable;
use frikan_shared::effect::Element;
use proptest::prelude::*;
use std::vec::Vec;

/// Share of the torque by which an element in counts may be off one in floats: a way that is gathered, and shares of 15 bits.
const TOLERANCE: f64 = 0.012;

/// Positions in counts of a motion to and fro, of a long stroke and a short one, with rests.
fn positions(distance: u32) -> Vec<i32> {
    let distance = f64::from(distance);
    let at = |sample: i32| {
        let phase = f64::from(sample - sample % 400 * i32::from(sample % 2000 < 400)) / 900.0;
        1.0e6 + distance * (3.0 * (6.0 * phase).sin() + 0.7 * (41.0 * phase).sin())
    };
    (0..9000).map(|sample| at(sample).round() as i32).collect()
}

/// `torque z` of the float effect, counts, over positions in counts.
fn in_floats(torque: u16, distance: u32, positions: &[i32]) -> Vec<f64> {
    let element = [Element { torque: f32::from(torque), distance: distance as f32 }];
    let mut memory = [0.0; 4];
    let mut before = positions[0];
    let step = |position: &i32| {
        let travel = position.wrapping_sub(before) as f32;
        before = *position;
        let motion = Motion { travel, usable: Usable::where_negative(-1), ..Motion::default() };
        f64::from(presliding::step(1.0, &element, &mut memory, &motion).torque)
    };
    positions.iter().map(step).collect()
}

#[test]
fn an_element_in_counts_follows_the_one_in_floats() {
    for distance in [1, 7, 40, 1000, 65_536, LARGEST_DISTANCE_COUNTS] {
        for torque in [1, 90, 20_000] {
            let positions = positions(distance);
            let mut contact = IntegerPresliding::new(torque, distance, 32_767).unwrap();
            let mut extremes = [0, 0];
            for (position, expected) in positions.iter().zip(in_floats(torque, distance, &positions)) {
                let answer = contact.friction(0, *position);
                let off = (f64::from(answer) - expected).abs();
                assert!(off <= 1.0 + TOLERANCE * f64::from(torque), "{torque}, {distance}: {answer} for {expected}");
                extremes = [extremes[0].min(answer), extremes[1].max(answer)];
            }
            let most = i32::from(torque) * 9 / 10;
            assert!(extremes[0] <= -most && extremes[1] >= most, "{torque}, {distance}: {extremes:?}");
        }
    }
}

/// The law with the effect in floats, and the table's friction with the contact in counts, over reversals.
#[test]
fn a_reversal_is_that_of_the_float_effect() {
    let (coulomb, viscous, smoothing, torque, distance) = (800.0, 0.02, 60.0, 500u16, 120u32);
    let velocity = |sample: i32| 4000.0 * (f64::from(sample) / 150.0).sin();
    let mut position = 0.0;
    let positions: Vec<i32> = (0..3000)
        .map(|sample| {
            position += velocity(sample) / 1000.0;
            position as i32
        })
        .collect();
    let sign = |sample| (velocity(sample) / smoothing).tanh();
    let law = |sample| coulomb * sign(sample) + viscous * velocity(sample);
    let mut contact = IntegerPresliding::new(torque, distance, 800).unwrap();
    let (mut squares, mut uncorrected) = (0.0, 0.0);
    for ((sample, position), element) in (0..).zip(&positions).zip(in_floats(torque, distance, &positions)) {
        let expected = law(sample) + element - f64::from(torque) * sign(sample);
        let answer = f64::from(contact.friction(law(sample).round() as i32, *position));
        // What the table has of the sign is not the very tangent of the law.
        assert!((answer - expected).abs() < 0.06 * f64::from(torque), "{sample}: {answer} for {expected}");
        squares += (answer - expected).powi(2);
        uncorrected += (law(sample) - expected).powi(2);
    }
    assert!(squares < 1.0e-4 * uncorrected, "{squares} {uncorrected}");
}

proptest! {
    /// Whatever the counts, no more than the friction and the torque together, and the element within its torque.
    #[test]
    fn it_stays_within_its_torque(
        torque in 0u16..=32_767, distance in 1u32..=LARGEST_DISTANCE_COUNTS, least in 1u16..=32_767,
        samples in prop::collection::vec((-32_767i32..=32_767, prop_oneof![-5000i32..5000, any::<i32>(), Just(i32::MIN)]), 64),
    ) {
        let Ok(mut contact) = IntegerPresliding::new(torque.min(least), distance, least) else { unreachable!() };
        let torque = i32::from(torque.min(least));
        for (friction, position) in samples {
            let answer = contact.friction(friction, position);
            prop_assert!(answer.abs() <= friction.abs() + torque, "{answer} for {friction} at {position}");
            prop_assert!(contact.share.abs() <= super::ONE);
            prop_assert!(contact.clone().friction(0, position).abs() <= torque);
        }
    }
}

#[test]
fn a_half_is_halved_to_a_ten_thousandth() {
    for x in (0..23 << LEFT_BITS).step_by(37) {
        let exact = (-f64::from(x) / f64::from(1 << LEFT_BITS)).exp2();
        assert!((f64::from(halved(x)) / f64::from(ONE) - exact).abs() < 1.4e-4, "{x}");
    }
}

#[test]
fn a_joint_at_rest_keeps_its_contact_and_a_reset_relaxes_it() {
    let mut contact = IntegerPresliding::new(1000, 20, 1000).unwrap();
    assert_eq!(contact.friction(0, i32::MAX), 0);
    // Across the wrap of the count.
    let bent = contact.friction(0, i32::MIN + 9);
    assert!((380..410).contains(&bent), "{bent}");
    assert_eq!(contact.friction(0, i32::MIN + 9), bent);
    contact.reset();
    assert_eq!(contact.friction(0, 5), 0);
}

#[test]
fn a_contact_out_of_range_is_refused() {
    let refused = |torque, distance, least| IntegerPresliding::new(torque, distance, least).err();
    assert_eq!(refused(101, 1, 100), Some(PreslidingError::Torque));
    assert_eq!(refused(0, 1, 0), Some(PreslidingError::Torque));
    assert_eq!(refused(1, 1, 32_768), Some(PreslidingError::Torque));
    assert_eq!(refused(1, 0, 1), Some(PreslidingError::Distance));
    assert_eq!(refused(1, LARGEST_DISTANCE_COUNTS + 1, 1), Some(PreslidingError::Distance));
    assert_eq!(refused(0, 1, 1), None);
}
