//! The compensator's step against the trainer's reference, for every effect and law; and that the comparison catches what is wrong.

use std::collections::BTreeSet;

use frikan_runtime::compensator::{Compensator, Limits};
use frikan_runtime::shared::effect::Effect;
use frikan_tests::models::{TestModel, every_effect, every_law, symmetric_table, with_effects, with_every_effect};
use frikan_trainer::compile::steps::effects::{Added, Memory, Seen, added};
use frikan_trainer::compile::steps::reference::Reference;
use frikan_trainer::compile::steps::sequence::sequence;
use frikan_trainer::compile::steps::{Answer, Call, LEAST_STEPS, compare, compare_answers, step};

#[test]
fn every_law_and_every_effect_agree_to_the_bit() {
    let laws = every_law().into_iter().map(|(name, model)| (name.to_owned(), model));
    for (name, model) in with_every_effect().into_iter().chain(laws) {
        let comparison = compare(&model, &sequence(&model, LEAST_STEPS));
        assert!(comparison.identical(), "{name}: {comparison:?}");
        assert_eq!(comparison.compared, LEAST_STEPS as u64, "{name}");
    }
}

/// A drive that starts with limits that are refused puts out no position.
#[test]
fn a_sequence_may_begin_anywhere() {
    const SEGMENT: usize = 250;
    for (name, model) in with_every_effect() {
        for calls in sequence(&model, 40 * SEGMENT).chunks(SEGMENT) {
            let comparison = compare(&model, calls);
            assert!(comparison.identical(), "{name}: {comparison:?}");
        }
    }
}

/// A place for each kind of effect; a kind that is new has none, and this does not compile.
fn kind(effect: &Effect) -> usize {
    match effect {
        Effect::Coulomb { .. } => 0,
        Effect::Stribeck { .. } => 1,
        Effect::PowerViscous { .. } => 2,
        Effect::Asymmetry { .. } => 3,
        Effect::Temperature { .. } => 4,
        Effect::WarmUp { .. } => 5,
        Effect::Load { .. } => 6,
        Effect::FrictionalLag { .. } => 7,
        Effect::Presliding { .. } => 8,
        Effect::DwellBreakaway { .. } => 9,
        Effect::Ripple { .. } => 10,
        Effect::PositionTable { .. } => 11,
        Effect::Play { .. } => 12,
        Effect::WindupHysteresis { .. } => 13,
        Effect::Spring { .. } => 14,
    }
}
const KINDS: usize = 15;

/// An effect that is deliberately wrong.
type Wrong = fn(&Effect, &mut Memory, &Seen<'_>) -> Added;

/// By one unit in the last place, where the effect adds anything.
fn off_by_a_unit(effect: &Effect, memory: &mut Memory, seen: &Seen<'_>) -> Added {
    let right = added(effect, memory, seen);
    let next = |x: f32| if x == 0.0 { x } else { x.next_up() };
    Added { torque: next(right.torque), position: next(right.position), velocity: next(right.velocity) }
}

/// Right in motion, nothing at rest or close to it.
fn nothing_when_slow(effect: &Effect, memory: &mut Memory, seen: &Seen<'_>) -> Added {
    let right = added(effect, memory, seen);
    if seen.velocity.abs() < 1.0e-4 { Added::default() } else { right }
}

/// 100 N m more, and 1 rad and rad/s.
fn far_off(effect: &Effect, memory: &mut Memory, seen: &Seen<'_>) -> Added {
    let right = added(effect, memory, seen);
    Added { torque: right.torque + 100.0, position: right.position + 1.0, velocity: right.velocity + 1.0 }
}

/// Forgets everything after each sample.
fn forgetful(effect: &Effect, memory: &mut Memory, seen: &Seen<'_>) -> Added {
    let right = added(effect, memory, seen);
    *memory = None;
    right
}

/// Keeps what it remembered after the first sample.
fn frozen(effect: &Effect, memory: &mut Memory, seen: &Seen<'_>) -> Added {
    let before = *memory;
    let right = added(effect, memory, seen);
    *memory = before.or(*memory);
    right
}

/// Takes every sample for a hundredth longer than it is.
fn slow_clock(effect: &Effect, memory: &mut Memory, seen: &Seen<'_>) -> Added {
    added(effect, memory, &Seen { dt: 1.01 * seen.dt, ..*seen })
}

/// Takes every way for a hundredth longer than it is.
fn long_way(effect: &Effect, memory: &mut Memory, seen: &Seen<'_>) -> Added {
    added(effect, memory, &Seen { travel: 1.01 * seen.travel, ..*seen })
}

fn answers(model: &TestModel, calls: &[Call], effect: Wrong) -> Vec<Answer> {
    let mut compensator = Reference::new(model, effect);
    calls.iter().map(|call| compensator.step(call)).collect()
}

/// Whether the comparison tells the answers of a wrong effect from those of the right one.
fn is_caught(model: &TestModel, calls: &[Call], wrong: Wrong) -> bool {
    let comparison = compare_answers(model, calls, answers(model, calls, wrong));
    assert_eq!(comparison.identical(), comparison.first_difference.is_none());
    !comparison.identical()
}

/// Whether an effect keeps anything from one sample to the next.
fn remembers(effect: &Effect) -> bool {
    let mut memory = None;
    let cells = [];
    let seen = Seen {
        velocity: 1.0,
        position: 0.0,
        angle: 0.0,
        travel: 0.1,
        load: 0.0,
        temperature: 0.0,
        law: 1.0,
        dt: 0.1,
        cells: &cells,
    };
    // A table of an effect needs its cells, and remembers nothing.
    if !matches!(effect, Effect::PositionTable { .. }) {
        let _ = added(effect, &mut memory, &seen);
    }
    memory.is_some()
}

#[test]
fn a_wrong_effect_is_caught_whichever_it_is() {
    let of_all: [(&str, Wrong); 3] =
        [("off by a unit", off_by_a_unit), ("nothing when slow", nothing_when_slow), ("far off", far_off)];
    let of_memory: [(&str, Wrong); 2] = [("forgetful", forgetful), ("frozen", frozen)];
    let mut kinds = BTreeSet::new();
    for (name, effect) in every_effect() {
        kinds.insert(kind(&effect));
        let mut mutations = of_all.to_vec();
        if remembers(&effect) {
            mutations.extend(of_memory);
        }
        if matches!(effect, Effect::FrictionalLag { .. } | Effect::WarmUp { .. } | Effect::DwellBreakaway { .. }) {
            mutations.push(("slow clock", slow_clock));
        }
        if matches!(effect, Effect::Presliding { .. } | Effect::DwellBreakaway { .. } | Effect::WindupHysteresis { .. })
        {
            mutations.push(("long way", long_way));
        }
        let model = with_effects(&[effect]);
        let calls = sequence(&model, LEAST_STEPS);
        assert!(!is_caught(&model, &calls, added), "{name}: the right effect is taken for a wrong one");
        for (mutation, wrong) in mutations {
            assert!(is_caught(&model, &calls, wrong), "{name}, {mutation}");
        }
    }
    assert_eq!(kinds.len(), KINDS, "a kind of effect has no mutation");
}

/// What is wrong around the effects is caught too: a reset that does nothing, limits that are not heeded, an answer for a missing sample.
#[test]
fn a_wrong_compensator_is_caught() {
    let effects: Vec<Effect> = every_effect().into_iter().map(|(_, effect)| effect).skip(5).take(5).collect();
    let model = with_effects(&effects);
    let calls = sequence(&model, LEAST_STEPS);
    let with = |change: fn(&mut Call)| {
        let mut changed = calls.clone();
        changed.iter_mut().for_each(change);
        let mut compensator = Compensator::with_model(Ok(model.clone()), Limits::OFF);
        let answers = changed.iter().map(|call| step(&mut compensator, call));
        compare_answers(&model, &calls, answers.collect::<Vec<_>>())
    };
    assert!(with(|_| ()).identical());
    type Alter = fn(&mut Call);
    let wrong: [(&str, Alter); 5] = [
        ("no reset", |call| call.reset = false),
        ("no gain", |call| call.limits[0] = 1.0),
        ("no limit of the torque", |call| call.limits[1] = f32::MAX),
        ("no slew limit", |call| call.limits[2] = f32::MAX),
        ("a missing velocity is none", |call| {
            if call.measurement.velocity.is_nan() {
                call.measurement.velocity = 0.0;
            }
        }),
    ];
    for (name, change) in wrong {
        let comparison = with(change);
        assert!(!comparison.identical(), "{name}");
        assert!(comparison.equal > 0 && comparison.first_difference.is_some(), "{name}: {comparison:?}");
    }
}

#[test]
fn a_call_without_an_answer_is_not_equal() {
    let model = symmetric_table();
    let comparison = compare_answers(&model, &sequence(&model, 10), []);
    assert_eq!((comparison.compared, comparison.equal), (10, 0));
}

#[test]
fn one_model_has_one_sequence_that_meets_everything() {
    let model = with_effects(&[]);
    let calls = sequence(&model, 20_000);
    let words = |calls: &[Call]| calls.iter().flat_map(|call| call.words().map(f32::to_bits)).collect::<Vec<_>>();
    assert_eq!(words(&calls), words(&sequence(&model, 20_000)));
    type Holds = fn(&Call) -> bool;
    let meets: [(&str, Holds); 8] = [
        ("reset", |call| call.reset),
        ("rest", |call| call.measurement.velocity == 0.0),
        ("missing velocity", |call| call.measurement.velocity.is_nan()),
        ("missing position", |call| call.measurement.position.is_nan()),
        ("beyond the range", |call| call.measurement.velocity.abs() > 2.0),
        ("subnormal", |call| call.measurement.load.is_subnormal()),
        ("no sample period", |call| call.dt == 0.0),
        ("too long a sample period", |call| call.dt > 1.0),
    ];
    for (name, holds) in meets {
        let count = calls.iter().filter(|call| holds(call)).count();
        assert!(count >= 10, "{name}: {count}");
    }
    let reversals = calls.windows(2).filter(|two| two[0].measurement.velocity * two[1].measurement.velocity < 0.0);
    assert!(reversals.count() > 500);
}
