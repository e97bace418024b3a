//! Every effect of the catalogue, hidden in a recording and named by a diagnosis that knows nothing of it.

use frikan_tests::concealed::intervals::held;
use frikan_tests::concealed::simulated::{self, Comparison, Group};
use frikan_tests::concealed::summary::Row;
use frikan_tests::concealed::{Case, Hidden, Outcome, conceal, diagnosis_of, run, set_of, signals};
use frikan_tests::exhaustive;
use frikan_trainer::diagnose::learn_simulation as learn;
use frikan_trainer::diagnose::{self, BaseKind, Lock, Options, Verdict, diagnose};
use frikan_trainer::physics::EffectId;
use frikan_trainer::plant::{CATALOGUE, NoiseKind};
use rayon::prelude::*;

fn hidden(effect: &'static str, lambda: f64, seed: u64) -> Outcome {
    let case = Case {
        hidden: Hidden::Effect(effect, lambda),
        noise: NoiseKind::Coloured,
        base: BaseKind::CoulombViscous,
        seed,
    };
    run(&case).unwrap()
}

fn control(noise: NoiseKind, seed: u64) -> Case {
    Case { hidden: Hidden::Nothing, noise, base: BaseKind::CoulombViscous, seed }
}

/// Every third case, from the first on; all of them with `FRIKAN_EXHAUSTIVE=1`.
fn some_of<T>(cases: impl IntoIterator<Item = T>) -> Vec<T> {
    cases.into_iter().step_by(if exhaustive() { 1 } else { 3 }).collect()
}

fn in_set(outcome: &Outcome, effect: &str) -> bool {
    outcome.diagnosis.findings.first().is_some_and(|found| set_of(found).any(|name| name.name() == effect))
}

/// A gap of the clock splits a recording and has no name among the findings: it is a note on the measurement. Each effect has a seed of its own,
/// whichever others are looked at.
#[test]
fn every_effect_is_in_the_stated_set_and_nearly_all_come_first() {
    const SEED: u64 = 4_000_000;
    let effects: Vec<&'static str> = CATALOGUE.iter().map(|entry| entry.name).filter(|n| *n != "clock_gaps").collect();
    assert!(effects.len() >= 28, "{effects:?}");
    let outcomes: Vec<(&'static str, Outcome)> = some_of(effects.into_iter().enumerate())
        .into_par_iter()
        .map(|(index, effect)| (effect, hidden(effect, 300.0, SEED + index as u64)))
        .collect();
    let mut first = 0;
    for (effect, outcome) in &outcomes {
        println!("{effect}: {:?}", outcome.named());
        first += usize::from(outcome.named().first().is_some_and(|name| name.name() == *effect));
        assert!(in_set(outcome, effect), "{effect} is not in the set of {:?}", outcome.named());
    }
    let most = if exhaustive() { 3 } else { 1 };
    assert!(first + most >= outcomes.len(), "{first} of {} come first", outcomes.len());
}

/// The drive holds its torque over a sample: it is put back by half of one, and so has to be what it is measured against.
#[test]
fn what_is_removed_is_measured_on_the_torque_that_was_put_back() {
    let outcome = hidden("torque_offset", 300.0, 130_070_052);
    assert!(outcome.diagnosis.realigned_by_s != 0.0);
    let removed = Row::of(&outcome).removed_share;
    assert!(removed.is_some_and(|share| (0.9..1.05).contains(&share)), "{removed:?}");
}

#[test]
fn a_weak_newcomer_does_not_displace_what_was_proved() {
    assert_eq!(hidden("viscous_nonlinearity", 80.0, 460_001).named(), [EffectId::ViscousNonlinearity]);
}

#[test]
fn a_term_that_one_block_alone_determines_leaves_the_rest_of_the_search_in_order() {
    assert!(in_set(&hidden("contact", 80.0, 460_021), "contact"));
}

#[test]
fn a_free_function_of_many_coefficients_does_not_go_before_a_name_that_explains_as_much() {
    assert!(in_set(&hidden("direction_asymmetry", 80.0, 460_002), "direction_asymmetry"));
}

#[test]
fn a_name_that_a_free_function_leads_by_little_stays_in_its_set() {
    assert!(in_set(&hidden("spring", 80.0, 82_000_287), "spring"));
}

/// Noise that grows up to the top acceleration of a sweep; a motion that nearly stops and goes on; slow noise behind a coarse
/// encoder: none of them is an effect.
#[test]
fn where_nothing_is_missing_nothing_is_named() {
    let state_dependent =
        [93_000_456, 93_000_510, 93_000_511, 93_000_557].map(|seed| (NoiseKind::StateDependent, seed));
    let coarse = [93_000_625, 93_000_641, 93_000_664].map(|seed| (NoiseKind::CoarseEncoder, seed));
    some_of(state_dependent.into_iter().chain(coarse)).into_par_iter().for_each(|(noise, seed)| {
        assert_eq!(run(&control(noise, seed)).unwrap().named(), [], "{noise:?}, seed {seed}");
    });
}

/// What the noise of a simulation left uncertain in its law is the law's error and nothing that the real joint has.
#[test]
fn a_noisy_simulation_is_not_taken_at_its_word() {
    let seeds = [
        (NoiseKind::Coloured, 71_100_018),
        (NoiseKind::StateDependent, 71_100_022),
        (NoiseKind::CoarseEncoder, 71_100_039),
    ];
    for (noise, seed) in some_of(seeds) {
        let case = Case { base: BaseKind::Reference, ..control(noise, seed) };
        let simulated = conceal(&control(noise, seed + 5_000_000)).unwrap();
        let [real, simulated] = [conceal(&case).unwrap(), simulated].map(|m| signals(&m.recording, &m.joint));
        let law = learn(&simulated, &real).unwrap();
        let reference = law.at(&real.states());
        let diagnosis = diagnosis_of(&case, &diagnose::Comparison::with(real, reference)).unwrap();
        let named: Vec<EffectId> = diagnosis.findings.iter().map(|finding| finding.effect).collect();
        assert_eq!(named, [], "{noise:?}, seed {seed}");
    }
}

/// The drive answers to the grain of a coarse encoder some samples later: beside the known inertia, where the grain is as large, that
/// was taken for a torque out of step.
#[test]
fn the_answer_of_the_drive_to_a_coarse_encoder_is_no_delay() {
    some_of(71_530_000..71_530_003).into_par_iter().for_each(|seed| {
        let case = Case { base: BaseKind::Reference, ..control(NoiseKind::CoarseEncoder, seed) };
        let compared = simulated::run(&Comparison { group: Group::Control, case }).unwrap();
        assert_eq!(compared.findings, Vec::<Vec<EffectId>>::new(), "seed {seed}");
    });
}

/// A simulator that works an effect out itself was told that it lacks it: its law was learned from speed, position and
/// acceleration alone. A channel, a memory and a position stand for the others.
#[test]
fn what_a_simulator_holds_is_not_missing_from_it() {
    let effects = ["temperature", "presliding", "frictional_lag", "position_ripple", "kinematic_error", "coupling"];
    some_of(effects.into_iter().enumerate()).into_par_iter().for_each(|(index, effect)| {
        let seed = 71_500_000 + index as u64;
        let case = Case {
            hidden: Hidden::Effect(effect, 80.0),
            base: BaseKind::Reference,
            ..control(NoiseKind::Coloured, seed)
        };
        let compared = simulated::run(&Comparison { group: Group::Held, case }).unwrap();
        assert_eq!(compared.findings, Vec::<Vec<EffectId>>::new(), "{effect}, seed {seed}");
    });
}

#[test]
fn what_a_simulator_lacks_is_named_beside_what_it_holds() {
    let pairs = [("presliding", "warm_up"), ("frictional_lag", "spring"), ("coupling", "torque_offset")];
    some_of(pairs.into_iter().enumerate()).into_par_iter().for_each(|(index, (held, missing))| {
        let seed = 71_510_000 + index as u64;
        let hidden = Hidden::Pair(held, missing, 80.0);
        let case = Case { hidden, base: BaseKind::Reference, ..control(NoiseKind::Coloured, seed) };
        let compared = simulated::run(&Comparison { group: Group::HeldAndMissing, case }).unwrap();
        let first: Vec<&str> = compared.findings.iter().map(|set| set[0].name()).collect();
        assert_eq!(first, [missing], "beside {held}, seed {seed}");
    });
}

/// Beyond the simulated motion the formulas of a strong effect err by more than the noise, and that was named.
#[test]
fn the_formulas_of_a_shorter_simulation_are_not_taken_for_physics() {
    let effects = ["presliding", "frictional_lag", "dwell_breakaway", "windup_hysteresis"];
    some_of(effects.into_iter().enumerate()).into_par_iter().for_each(|(index, effect)| {
        let seed = 71_520_000 + index as u64;
        let hidden = Hidden::Effect(effect, 8000.0);
        let case = Case { hidden, base: BaseKind::Reference, ..control(NoiseKind::Coloured, seed) };
        let compared = simulated::run(&Comparison { group: Group::ShorterHeld, case }).unwrap();
        assert_eq!(compared.findings, Vec::<Vec<EffectId>>::new(), "{effect}, seed {seed}");
    });
}

/// The spline was once straight in the root of the speed, and a law as sharp as a step missed every reversal by a sample.
#[test]
fn the_form_of_a_base_is_not_taken_for_physics() {
    let [spline, law] = [BaseKind::Spline, BaseKind::Reference];
    for (noise, base, seed) in [
        (NoiseKind::White, spline, 68_000_012),
        (NoiseKind::CoarseEncoder, spline, 68_000_062),
        (NoiseKind::White, law, 68_000_007),
        (NoiseKind::Coloured, law, 68_000_016),
    ] {
        let outcome = run(&Case { base, ..control(noise, seed) }).unwrap();
        assert_eq!(outcome.named(), [], "{base:?} {seed}");
    }
}

/// A power of the velocity near one takes the place of viscous friction: its free exponent leaves the coefficient open.
#[test]
fn a_base_parameter_has_the_uncertainty_of_the_shape_that_it_trades_with() {
    let held = held(&hidden("viscous_nonlinearity", 80.0, 73_000_002));
    let viscous = held.iter().find(|held| held.parameter.ends_with("viscous_coefficient")).unwrap();
    assert!(viscous.deviations.abs() < 3.0, "{viscous:?}");
}

#[test]
fn the_plain_spring_goes_before_one_with_a_loop_that_explains_a_little_more() {
    assert_eq!(hidden("elasticity", 150.0, 71_000_055).named(), [EffectId::Elasticity]);
}

#[test]
fn locked_rows_that_hardly_touch_an_effect_do_not_withdraw_it() {
    assert!(in_set(&hidden("contact", 80.0, 85_000_244), "contact"));
}

#[test]
fn an_event_that_lies_in_locked_rows_is_found_behind_another_lock() {
    let concealed = conceal(&control(NoiseKind::Coloured, 460_040)).unwrap();
    let mut signals = signals(&concealed.recording, &concealed.joint);
    let options = Options::default();
    let before = diagnose(&signals.clone().into(), &options).unwrap();
    assert_eq!((before.findings.len(), before.lock), (0, Lock::Spread));
    let traces = &before.traces;
    let rows: Vec<(f64, bool)> = traces.time.iter().copied().zip(traces.locked.iter().copied()).collect();
    let stretches = rows.chunk_by(|a, b| a.1 == b.1 && b.0 - a.0 < 0.02).filter(|stretch| stretch[0].1);
    let longest = stretches.max_by_key(|stretch| stretch.len()).unwrap();
    let event = longest[0].0..longest[longest.len() - 1].0;
    let recorded = signals.torque.clone();
    let mut with_event = |event_torque: f64| {
        for ((torque, recorded), time) in signals.torque.iter_mut().zip(&recorded).zip(&signals.time) {
            *torque = recorded + if event.contains(time) { event_torque } else { 0.0 };
        }
        diagnose(&signals.clone().into(), &options).unwrap()
    };
    for event_torque in [1.0, 20.0] {
        let after = with_event(event_torque);
        assert_eq!(after.lock, Lock::SpreadElsewhere, "{event_torque} N m");
        let [found] = after.findings.as_slice() else {
            panic!("{} findings of {event_torque} N m", after.findings.len())
        };
        assert_eq!(found.effect, EffectId::TransientEvent);
        let [start, end] = found.fitted.shape[..] else { panic!("{:?}", found.fitted.shape) };
        assert!(start < event.end && end > event.start, "{start} to {end} instead of {event:?}");
    }
    // So large that what its edges leave drowns all else: whether it is named or not, it is not taken for noise.
    let after = with_event(500.0);
    assert_ne!(after.verdict, Verdict::Consistent);
    let is_named = after.findings.iter().any(|found| found.effect == EffectId::TransientEvent);
    assert!(is_named || after.health.iter().any(|note| note.effect == EffectId::TransientEvent), "{:?}", after.health);
}
