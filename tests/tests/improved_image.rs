//! What a diagnosis writes into an image is what the drive then computes.

use frikan_runtime::shared::model::RigidBody;
use frikan_runtime::shared::units::Unit;
use frikan_tests::concealed::{Case, Concealed, Hidden, conceal, signals};
use frikan_trainer::diagnose::improve::{Origin, improve};
use frikan_trainer::diagnose::{BaseKind, Lock, Options, Prepared, diagnose, model};
use frikan_trainer::plant::NoiseKind;

/// Effects that an image holds as a torque, one of each kind of term.
const EFFECTS: [&str; 8] = [
    "stribeck",
    "direction_asymmetry",
    "temperature",
    "warm_up",
    "load_friction",
    "presliding",
    "position_ripple",
    "torque_scale",
];
/// Share of the gain that the image may lose: a nuisance of the diagnosis is no part of a model.
const MAY_LOSE: f64 = 0.35;
/// What the image may leave over what the diagnosis leaves, for the same reason.
const MAY_LEAVE: f64 = 1.1;

#[test]
fn the_image_leaves_what_the_diagnosis_leaves() {
    for effect in EFFECTS {
        let case = Case {
            hidden: Hidden::Effect(effect, 300.0),
            noise: NoiseKind::White,
            base: BaseKind::CoulombViscous,
            seed: 5,
        };
        let Concealed { recording, joint, .. } = conceal(&case).unwrap();
        let mut signals = signals(&recording, &joint);
        if effect == "warm_up" {
            // Beside a recorded temperature that would be named.
            signals.temperature = None;
        }
        let diagnosis = diagnose(&signals, "N m", &Options::default()).unwrap();
        let origin = Origin::Recording(RigidBody::default());
        let improved = improve(&diagnosis, &signals, origin, Unit::NewtonMetre).unwrap();
        let state = signals.states();
        let prepared = Prepared::new(&signals, Lock::Nothing);
        let mut without = improved.model.clone();
        without.effects.clear();
        let [rmse, bare] = [&improved.model, &without].map(|model| {
            let torque = model::at(model, &state, signals.rigid_body.as_deref()).unwrap().torque;
            let rest: Vec<f64> = signals.torque.iter().zip(&torque).map(|(recorded, model)| recorded - model).collect();
            let rest = prepared.filtered(&rest);
            (rest.iter().map(|r| r * r).sum::<f64>() / rest.len() as f64).sqrt()
        });
        let (before, after) = (diagnosis.baseline.rmse, diagnosis.improved.rmse);
        println!("{effect}: {before:.4} -> {after:.4}, image {rmse:.4}, without {bare:.4}; {:?}", improved.remarks);
        assert!(rmse < MAY_LEAVE * after, "{effect}: the image leaves {rmse} instead of {after}");
        // The diagnosis carries nuisances that an image does not: compare energies, image with image.
        let gain = bare * bare - rmse * rmse;
        let expected = before * before - after * after;
        let correction = improved.model.effects.is_empty();
        assert!(
            correction || gain > (1.0 - MAY_LOSE) * expected,
            "{effect}: {before} -> {after}, image {bare} -> {rmse}"
        );
    }
}
