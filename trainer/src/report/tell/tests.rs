use super::*;
use crate::diagnose::answer::location::Location;
use crate::diagnose::answer::outcome::{Evidence, Given, Score};
use crate::diagnose::answer::traces::Traces;
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::proof::discarded::Discarded;
use crate::diagnose::proof::locked_rows::Proof;
use crate::diagnose::proof::refit::Refit;
use crate::physics::Dimension;

const ROTARY: Units = Units { actuator: "N m", rotary: true };

fn region(channel: &'static str, from: f64, to: f64) -> Region {
    Region { side: Side { channel, from, to }, and: None, share_of_excess: 0.9, share_of_samples: 0.1 }
}

fn presliding(channel: &'static str, from: f64, to: f64) -> Finding {
    let distance = Estimate {
        name: "breakaway_distance",
        symbol: "delta",
        value: 1.2e-3,
        dimension: Dimension::Position,
        ci95: [1.1e-3, 1.3e-3],
    };
    let torque = Estimate { name: "presliding_torque", value: 3.1, dimension: Dimension::Torque, ..distance.clone() };
    let fitted = Fitted {
        label: Label::Named(EffectId::Presliding),
        shape: vec![1.2e-3],
        shape_deviation: vec![None],
        coefficients: vec![3.1],
        deviation: vec![0.1],
    };
    Finding {
        effect: EffectId::Presliding,
        probability: 0.97,
        alternatives: vec![(EffectId::FrictionalLag, 0.02)],
        action: Action::FeedForward,
        equation: String::new(),
        parameters: vec![torque, distance],
        location: Location { regions: vec![region(channel, from, to)], is_named: true, when_s: Vec::new() },
        evidence: Evidence::Rows { held_out_gain_nats: 40.0, family_wise: 1e-9, rivals: 1 },
        fitted,
        score: 40.0,
        margin: 9.0,
        standings: Vec::new(),
        channels: Vec::new(),
        nearest: None,
        locked_gain_nats: Some(20.0),
    }
}

fn diagnosis(found: Finding) -> Diagnosis {
    let refit = || Refit {
        base: Vec::new(),
        base_deviation: Vec::new(),
        covariance: nalgebra::DMatrix::zeros(0, 0),
        effects: Vec::new(),
        noise: crate::diagnose::Noise::white(0, 1.0),
        plain: false,
    };
    let velocity: Vec<f64> = (-50..50).map(|k| 0.002 * f64::from(k) + 0.001).collect();
    let effect: Vec<f64> = velocity.iter().map(|v| -3.1 * v.signum() * f64::from(v.abs() < 0.05)).collect();
    let traces = Traces { time: velocity.clone(), velocity, effects: vec![effect], ..Traces::default() };
    Diagnosis {
        law: None,
        sealed_s: Vec::new(),
        verdict: Verdict::MissingPhysics,
        health: Vec::new(),
        findings: vec![found],
        discarded: Discarded {
            minor: vec![(EffectId::Presliding, 0.042)],
            doubtful: vec![(EffectId::TransientEvent, 0.02)],
            negligible: vec![(EffectId::Elasticity, 0.003)],
            withdrawn: vec![EffectId::Spring],
            undetermined: vec![EffectId::Backlash],
        },
        limits: Vec::new(),
        base: BaseKind::CoulombViscous,
        lock: Lock::Spread,
        given: None,
        base_parameters: Vec::new(),
        noise_rmse: 0.4,
        baseline: Score { rmse: 0.92, r2: 0.9 },
        improved: Score { rmse: 0.41, r2: 0.98 },
        proof: Some(Proof {
            baseline_rmse: 0.92,
            improved_rmse: 0.41,
            ratio_ci95: [0.4, 0.5],
            gain_nats: 20.0,
            locked_deviations: 6.0,
            expected_deviations: 4.0,
            locked_share: 0.2,
            rows: 300,
        }),
        rollout: None,
        sets: Vec::new(),
        rivals: Vec::new(),
        baseline_refit: refit(),
        improved_refit: refit(),
        cut_off_hz: 20.0,
        rows: 1500,
        sampling_delay_s: 0.0,
        realigned_by_s: 0.0,
        traces,
    }
}

#[test]
fn a_finding_reads_as_a_sentence() {
    let story = tell(&diagnosis(presliding("velocity", -0.05, 0.05)), None, ROTARY);
    assert_eq!(
        story.findings[0],
        "Between -0.05 and 0.05 rad/s the real joint needs up to 3.1 N m less: presliding hysteresis, breakaway \
         distance 1.2 mrad (\u{b1} 100 urad). Probability 97 %; this recording cannot rule out frictional lag (2 %)."
    );
    assert_eq!(
        story.headline,
        "One effect is missing from the model: its error is 0.92 N m (root mean square), and noise alone would leave 0.4 N m."
    );
    assert_eq!(
        story.proof.unwrap(),
        "Held-out error 0.92 -> 0.41 N m on 300 rows that took no part in fitting and could only withdraw a finding \
         (ratio 0.446, 95 % interval 0.4 to 0.5)."
    );
    let doubtful = story.doubtful.unwrap();
    assert!(doubtful.contains("not taken for physics: one-off event (0.02 N m)."), "{doubtful}");
    assert_eq!(story.negligible.unwrap(), "Below the least effect, and not modelled: elastic transmission (3 mN m).");
    assert!(story.withdrawn.unwrap().contains("spring"));
    assert!(story.undetermined.unwrap().ends_with("includes zero on this recording: backlash."));
    assert!(story.minor.unwrap().contains("4.2 %"));
}

#[test]
fn a_given_model_is_told_by_how_much_its_own_parameters_are_off() {
    let mut told = diagnosis(presliding("velocity", -0.05, 0.05));
    assert!(tell(&told, None, ROTARY).given.is_empty());
    let parameter = |name: &'static str, value: f64, half: f64| Estimate {
        name,
        symbol: "",
        dimension: Dimension::Torque,
        value,
        ci95: [value - half, value + half],
    };
    told.base_parameters =
        vec![parameter("coulomb_torque_change", -1.2, 0.1), parameter("viscous_coefficient_change", 0.1, 0.2)];
    let holds = vec![EffectId::PositionRipple, EffectId::Temperature, EffectId::PositionRipple];
    told.given = Some(Given { score: Score { rmse: 1.5, r2: 0.6 }, holds });
    assert_eq!(
        tell(&told, None, ROTARY).given,
        [
            "Found in the simulation itself, and so not missing from it: torque ripple over position, friction that \
             depends on temperature.",
            "As it was given, the model is wrong by 1.5 N m; refitting its own parameters leaves 0.92 N m: its coulomb \
             torque is 1.2 N m (\u{b1} 0.1 N m) too high."
        ]
    );
}

#[test]
fn a_region_from_a_reversal_on_says_so() {
    let sentence = finding(&diagnosis(presliding("distance_since_reversal", 1e-6, 0.004)), 0, ROTARY);
    assert!(sentence.starts_with("Within 4 mrad after each reversal the real joint needs up to"), "{sentence}");
}

#[test]
fn two_channels_are_named_where_they_are_sharper_together() {
    let mut found = presliding("velocity", -0.05, 0.05);
    found.location.regions[0].and = Some(Side { channel: "load", from: 1.0, to: 2.0 });
    let sentence = finding(&diagnosis(found), 0, ROTARY);
    assert!(sentence.starts_with("Between -0.05 and 0.05 rad/s and under loads between 1 and 2 N m the real joint"));
}

#[test]
fn channels_that_cannot_be_told_apart_are_said() {
    let channels = vec![Channel::Load, Channel::Position, Channel::TimeSinceReversal];
    let unknown = Finding { effect: EffectId::Unknown, channels, ..presliding("load", 1.0, 2.0) };
    let sentence = finding(&diagnosis(unknown), 0, ROTARY);
    let expected = "It may depend on position or the time since the last reversal instead of load.";
    assert!(sentence.contains(expected), "{sentence}");
}

#[test]
fn no_stop_is_no_stop_of_zero_seconds() {
    let sentence = finding(&diagnosis(presliding("dwell", 0.0, 0.0)), 0, ROTARY);
    assert!(sentence.starts_with("After reversals without a stop the real joint needs up to"), "{sentence}");
}
