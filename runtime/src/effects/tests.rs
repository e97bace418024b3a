use crate::friction::{FrictionState, Measurement};
use crate::test_models::{TestModel, coulomb_model};
use frikan_shared::effect::{Effect, Element, Harmonic, Kind};

const DT: f32 = 1.0e-3;
const SMOOTHING: f32 = 0.02;

/// Torque that `effect` adds to the law at every sample of a motion.
fn added(effect: Effect, motion: impl Iterator<Item = Measurement>) -> std::vec::Vec<f32> {
    let model = coulomb_model(10.0, &[effect]);
    let bare = coulomb_model(10.0, &[]);
    let mut state = FrictionState::new();
    motion
        .map(|measurement| {
            state.step(&model, &measurement, DT).torque - FrictionState::new().step(&bare, &measurement, DT).torque
        })
        .collect()
}

fn at(velocity: f32) -> Measurement {
    Measurement { velocity, ..Measurement::ZERO }
}

fn presliding(elements: &[(f32, f32)]) -> Effect {
    let elements = elements.iter().map(|&(torque, distance)| Element { torque, distance });
    Effect::Presliding { smoothing_velocity: SMOOTHING, elements: elements.collect() }
}

/// A model without effects but `effect`, that reads the velocity alone.
fn by_velocity(effect: Effect) -> TestModel {
    let mut model = coulomb_model(10.0, &[effect]);
    model.inputs.truncate(1);
    model
}

#[test]
fn every_element_follows_its_exact_solution_and_settles_on_the_law() {
    let elements = [(6.0, 1.0e-3), (3.0, 4.0e-3), (0.5, 1.6e-2), (0.5, 6.4e-2)];
    for count in 1..=elements.len() {
        let elements = &elements[..count];
        let model = by_velocity(presliding(elements));
        let (mut state, velocity) = (FrictionState::new(), 0.5f32);
        let smooth_sign = (velocity / SMOOTHING).tanh();
        let added = |torque: f32| torque - 10.0 * smooth_sign;
        for step in 1..=1000 {
            let torque = added(state.step(&model, &at(velocity), DT).torque);
            let way = velocity * DT * step as f32;
            let expected: f32 = elements.iter().map(|(f, d)| f * (1.0 - (-way / d).exp() - smooth_sign)).sum();
            assert!((torque - expected).abs() < 1.0e-3, "{count}, {step}: {torque} {expected}");
        }
        // The way back: from 1 to -1, each over its own distance.
        let torque = added(-state.step(&model, &at(-velocity), DT).torque);
        let way = velocity * DT;
        let expected: f32 = elements.iter().map(|(f, d)| f * (1.0 - 2.0 * (-way / d).exp() - smooth_sign)).sum();
        assert!((torque - expected).abs() < 1.0e-2, "{count}: {torque} {expected}");
    }
}

#[test]
fn presliding_does_not_depend_on_the_sample_period() {
    let model = by_velocity(presliding(&[(4.0, 8.0e-3)]));
    let (mut fine, mut coarse) = (FrictionState::new(), FrictionState::new());
    let mut last = 0.0;
    for _ in 0..100 {
        last = fine.step(&model, &at(0.3), 1.0e-4).torque;
    }
    assert!((coarse.step(&model, &at(0.3), 1.0e-2).torque - last).abs() < 1.0e-3);
}

/// Where the position is read the way is its change, whatever velocity and sample period say; a missing sample loses nothing of it.
#[test]
fn presliding_follows_the_measured_position() {
    let model = coulomb_model(10.0, &[presliding(&[(4.0, 8.0e-3)])]);
    let mut state = FrictionState::new();
    let mut step = |position: f32| {
        state.step(&model, &Measurement { position, velocity: 1.0, ..Measurement::ZERO }, DT).torque - 10.0
    };
    // The smoothed sign is 1. The first sample has no way.
    assert!((step(0.5) + 4.0).abs() < 1.0e-5);
    assert!((step(0.508) + 4.0 * (-1.0f32).exp()).abs() < 1.0e-3);
    assert_eq!(step(f32::NAN), -10.0);
    assert!((step(0.516) + 4.0 * (-2.0f32).exp()).abs() < 1.0e-3);
}

#[test]
fn lag_delays_the_law() {
    let effect = Effect::FrictionalLag { time_constant: 0.02 };
    let velocities = (0..200).map(|step| at(if step < 1 { -0.01 } else { 0.01 }));
    let model = coulomb_model(10.0, &[effect]);
    let mut state = FrictionState::new();
    let torques: std::vec::Vec<f32> = velocities.map(|m| state.step(&model, &m, DT).torque).collect();
    // v_L(t) = 0.01 (1 - 2 exp(-t / 20 ms)) crosses zero after 13.9 ms.
    assert!(torques[13] < 0.0 && torques[14] > 0.0, "{torques:?}");
    assert!((torques[199] - 10.0 * (0.5f32).tanh()).abs() < 1.0e-2);
}

#[test]
fn dwell_raises_the_breakaway_and_travel_takes_it_away() {
    let dwell = |rest: usize| {
        let effect = Effect::DwellBreakaway {
            gain: 1.5,
            time: 0.1,
            distance: 5.0e-3,
            rest_velocity: 1.0e-3,
            dwell_limit: 100.0,
            smoothing_velocity: SMOOTHING,
        };
        let speed = move |step: usize| if step < rest { 0.0 } else { 0.2 };
        let position = move |step: usize| 0.2 * DT * (step + 1).saturating_sub(rest) as f32;
        let sample = move |step| Measurement { position: position(step), ..at(speed(step)) };
        added(effect, (0..rest + 100).map(sample))
    };
    for rest in [100, 1000, 3000] {
        let torques = dwell(rest);
        let latched = 1.5 * (1.0 + rest as f32 * DT / 0.1).ln();
        let expected = latched * (-0.2 * DT / 5.0e-3f32).exp();
        assert!((torques[rest] - expected).abs() < 2.0e-2, "{} {expected}", torques[rest]);
        assert!(torques[rest + 99] < 0.05 * latched);
    }
}

/// A joint of 10 N m that takes 0.1 N m more for every watt that it dissipates.
fn warming_model(time_constant: f32) -> TestModel {
    let effect =
        Effect::WarmUp { time_constant, coulomb: 0.1, viscous: 0.0, power_limit: 50.0, smoothing_velocity: SMOOTHING };
    coulomb_model(10.0, &[effect])
}

#[test]
fn warm_up_reaches_its_power_however_small_the_step() {
    // tau / dt = 1e6: increments are far below what the state resolves.
    let model = warming_model(1000.0);
    let mut state = FrictionState::new();
    let mut torque = 0.0;
    let samples = if cfg!(miri) { 2_000 } else { 2_000_000 };
    for _ in 0..samples {
        torque = state.step(&model, &at(1.0), DT).torque;
    }
    let heat = 10.0 * (1.0 - (-(samples as f64) * 1.0e-3 / 1000.0).exp());
    assert!((f64::from(torque) - 10.0 - 0.1 * heat).abs() < 1.0e-3, "{torque} {heat}");
}

#[test]
fn warmth_fades_in_a_rest_and_is_gone_after_one_of_unknown_length() {
    let model = warming_model(10.0);
    let mut warm = FrictionState::new();
    for _ in 0..200 {
        let _ = warm.step(&model, &at(1.0), 1.0);
    }
    let left = |rest: f32| warm.after_rest(&model.effects, rest).step(&model, &at(1.0), 0.0).torque - 10.0;
    for (rest, expected) in [(1.0e-3, 1.0), (10.0, (-1.0f32).exp()), (1.0e9, 0.0), (-1.0, 0.0), (f32::NAN, 0.0)] {
        assert!((left(rest) - expected).abs() < 6.0e-3, "{rest} s: {}", left(rest));
    }
}

#[test]
fn play_lags_by_half_its_width() {
    let effect = Effect::Play { half_width: 0.1, torque: 2.0 };
    let model = coulomb_model(10.0, &[effect]);
    let mut state = FrictionState::new();
    let mut step = |position: f32| state.step(&model, &Measurement { position, ..Measurement::ZERO }, DT);
    assert_eq!(step(0.5).position, 0.0);
    assert!((step(0.7).position + 0.1).abs() < 1.0e-6);
    assert!((step(0.6).position).abs() < 1.0e-6);
    assert!((step(0.4).torque + 2.0).abs() < 1.0e-4);
}

#[test]
fn static_terms_are_their_equations() {
    let (v, q, load, temperature) = (0.7f32, 1.2f32, -1.5f32, 1.8f32);
    let measurement = Measurement { velocity: v, position: q, load, temperature, ..Measurement::ZERO };
    let s = (v / SMOOTHING).tanh();
    let smoothing_velocity = SMOOTHING;
    let line = Harmonic { order: 3.0, cosine: 0.4, sine: -0.3 };
    let ripple = 0.4 * (3.0 * q).cos() - 0.3 * (3.0 * q).sin();
    let harmonics = heapless::Vec::from_slice(&[line]).unwrap();
    let terms = [
        (Effect::Coulomb { coulomb: 2.0, viscous: 0.5, smoothing_velocity }, 2.0 * s + 0.5 * v),
        (Effect::Asymmetry { coulomb: 2.0, viscous: 0.5, smoothing_velocity }, 2.0 * s + 0.5 * v),
        (
            Effect::Stribeck { amplitude: 3.0, velocity: 0.5, exponent: 1.5, smoothing_velocity },
            3.0 * (-(v / 0.5).powf(1.5)).exp() * s,
        ),
        (Effect::PowerViscous { coefficient: 3.0, exponent: 0.7, smoothing_velocity }, 3.0 * v.powf(0.7) * s),
        (
            Effect::Temperature { reference: 1.0, coulomb: 0.2, viscous: 0.1, decay: 0.0, smoothing_velocity },
            (0.2 * s + 0.1 * v) * 0.8,
        ),
        (
            Effect::Temperature { reference: 1.0, coulomb: 0.2, viscous: 0.1, decay: 0.5, smoothing_velocity },
            0.2 * s * 0.8 + 0.1 * v * (1.0 - (-0.4f32).exp()) / 0.5,
        ),
        (
            // Driving 0.3, backdriving 0.1; load and velocity have different signs here.
            Effect::Load {
                mean: 0.2,
                difference: 0.1,
                quadratic: 0.05,
                stribeck: 0.3,
                velocity: 0.5,
                smoothing_velocity,
            },
            0.1 * 1.5 * s + 0.05 * 1.5 * 1.5 * s + 0.3 * (-(0.7f32 / 0.5).powi(2)).exp() * 1.5 * s,
        ),
        (Effect::Ripple { kind: Kind::Torque, smoothing_velocity, harmonics: harmonics.clone() }, ripple),
        (Effect::Ripple { kind: Kind::Friction, smoothing_velocity, harmonics }, ripple * s),
        (Effect::Spring { stiffness: 2.0, rest: 0.2 }, 2.0),
    ];
    for (effect, expected) in terms {
        let torque = added(effect.clone(), std::iter::once(measurement))[0];
        assert!((torque - expected).abs() < 2.0e-5, "{effect:?}: {torque} {expected}");
    }
}
