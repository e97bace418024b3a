//! What the diagnosis says of structures without a name: where they sit, and the formula that generated them.

use frikan_tests::concealed::{Case, Hidden, Outcome, run};
use frikan_trainer::diagnose::{BaseKind, Label};
use frikan_trainer::physics::EffectId;
use frikan_trainer::plant::NoiseKind;

fn diagnosed(hidden: Hidden, seed: u64) -> Outcome {
    run(&Case { hidden, noise: NoiseKind::Coloured, base: BaseKind::CoulombViscous, seed }).unwrap()
}

/// Checks the numbers of the equation of an effect found at lambda 300 against what was drawn, up to their signs: an
/// amplitude, then the shape. Each drawn parameter comes with the relative deviation that it may have.
fn formula_holds(effect: &'static str, factor: &str, channel: &str, drawn: [(&str, f64); 3]) {
    let outcome = diagnosed(Hidden::Effect(effect, 300.0), 70);
    assert_eq!(outcome.named(), [EffectId::Unknown]);
    assert_eq!(outcome.unknown_channels(), [channel]);
    let found = &outcome.diagnosis.findings[0];
    let Label::Generic(structure) = found.fitted.label else { panic!("{:?} has a name", found.fitted.label) };
    assert_eq!(structure.factor.text(), factor);
    let equation = &found.equation;
    let Some((_, formula)) = equation.split_once(&format!("{factor} (")) else {
        panic!("{equation} is no formula");
    };
    let words = formula.split([' ', '(', ')', '/', '^']);
    let numbers: Vec<f64> = words.filter_map(|word| word.parse::<f64>().ok()).map(f64::abs).collect();
    let amplitude = outcome.concealed.joint.effects[0].amplitude;
    for (index, (name, may_deviate)) in drawn.into_iter().enumerate() {
        let parameters = &outcome.concealed.recording.truth.parameters;
        let (_, value) = parameters.iter().find(|(full, _)| *full == format!("{effect}.{name}")).unwrap();
        let truth = value.abs() * if index == 0 { amplitude } else { 1.0 };
        let deviation = (numbers[index] / truth - 1.0).abs();
        assert!(deviation < may_deviate, "{name} is {truth}, in the equation {equation}");
    }
}

#[test]
fn a_tight_place_is_found_with_its_width() {
    let drawn = [("level_Nm", 0.2), ("place_rad", 0.02), ("width_rad", 0.2)];
    formula_holds("unknown_local_bump", "tanh(v/v_eps)", "position", drawn);
}

#[test]
fn a_step_of_viscosity_is_found_with_its_place() {
    let drawn = [("viscous_Nm_s_rad", 0.2), ("place_rad", 0.1), ("width_rad", 1.0)];
    formula_holds("unknown_position_step_viscous", "v", "position", drawn);
}

#[test]
fn a_load_friction_that_changes_on_the_way_is_no_friction_that_depends_on_position() {
    for seed in [71, 72, 73] {
        let outcome = diagnosed(Hidden::Effect("unknown_load_position", 150.0), seed);
        assert_eq!(outcome.named(), [EffectId::Unknown], "seed {seed}");
        assert_eq!(outcome.unknown_channels(), ["position"], "seed {seed}");
    }
}

#[test]
fn what_a_free_function_took_for_two_effects_is_named_once_one_of_them_is_found() {
    for seed in [630_000_000_005, 630_000_000_008] {
        let outcome = diagnosed(Hidden::Pair("coupling", "torque_offset", 150.0), seed);
        assert_eq!(outcome.named(), [EffectId::TorqueOffset, EffectId::Coupling], "seed {seed}");
    }
}

#[test]
fn a_structure_without_a_name_tells_the_effect_that_comes_nearest() {
    let outcome = diagnosed(Hidden::Effect("unknown_load_position", 150.0), 72);
    let (nearest, share) = outcome.diagnosis.findings[0].nearest.unwrap();
    assert_eq!(nearest, EffectId::PositionFriction);
    assert!((0.8..0.999).contains(&share), "{share}");
}
