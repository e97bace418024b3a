//! What a diagnosis writes into an image is what the drive then computes.

use frikan_runtime::shared::model::RigidBody;
use frikan_runtime::shared::units::Unit;
use frikan_tests::concealed::{Case, Concealed, Hidden, conceal, signals};
use frikan_tests::exhaustive;
use frikan_trainer::compile::improved::{Origin, improve};
use frikan_trainer::compile::profile::Profile;
use frikan_trainer::diagnose::{BaseKind, Comparison, Lock, Options, diagnose, model};
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

/// Root mean squares of what the diagnosis and the image of an effect leave, without it and with it.
struct Left {
    diagnosis: [f64; 2],
    image: [f64; 2],
    has_effects: bool,
}

fn left(effect: &'static str, lambda: f64) -> Left {
    let case = Case {
        hidden: Hidden::Effect(effect, lambda),
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
    let diagnosis = diagnose(&signals.clone().into(), &Options::default()).unwrap();
    let origin = Origin::Recording(RigidBody::default());
    let improved = improve(&diagnosis, &signals.clone().into(), origin, Unit::NewtonMetre, Profile::default()).unwrap();
    // The diagnosis puts the sampling's own delay back, and so is the image's error measured.
    let signals = signals.realigned(diagnosis.sampling_delay_s);
    let state = signals.states();
    let prepared = Comparison::from(signals.clone()).prepare(Lock::Nothing);
    let mut without = improved.model.clone();
    without.effects.clear();
    let image = [&without, &improved.model].map(|model| {
        let torque = model::at(model, &state, signals.rigid_body.as_deref()).unwrap().torque;
        let rest: Vec<f64> = signals.torque.iter().zip(&torque).map(|(recorded, model)| recorded - model).collect();
        let rest = prepared.filtered(&rest);
        (rest.iter().map(|r| r * r).sum::<f64>() / rest.len() as f64).sqrt()
    });
    let diagnosis_left = [diagnosis.baseline.rmse, diagnosis.improved.rmse];
    println!("{effect}: {diagnosis_left:?}, image {image:?}; {:?}", improved.remarks);
    Left { diagnosis: diagnosis_left, image, has_effects: !improved.model.effects.is_empty() }
}

/// Of every second effect; of all of them with `FRIKAN_EXHAUSTIVE=1`.
#[test]
fn the_image_leaves_what_the_diagnosis_leaves() {
    for effect in EFFECTS.into_iter().step_by(if exhaustive() { 1 } else { 2 }) {
        let Left { diagnosis: [before, after], image: [bare, rmse], has_effects } = left(effect, 300.0);
        assert!(rmse < MAY_LEAVE * after, "{effect}: the image leaves {rmse} instead of {after}");
        // The diagnosis carries nuisances that an image does not: compare energies, image with image.
        let gain = bare * bare - rmse * rmse;
        let expected = before * before - after * after;
        assert!(
            !has_effects || gain > (1.0 - MAY_LOSE) * expected,
            "{effect}: {before} -> {after}, image {bare} -> {rmse}"
        );
    }
}

/// Its heat is worked out with the friction of the base, which is that of a joint neither cold nor warm; the drive's with the law.
#[test]
fn a_strong_warm_up_survives_the_way_into_the_image() {
    let Left { diagnosis: [before, after], image: [_, rmse], .. } = left("warm_up", 30_000.0);
    assert!(before > 2.0 * after, "{before} -> {after} is not strong");
    assert!(rmse < MAY_LEAVE * after, "the image leaves {rmse} instead of {after}");
}

/// The quotient has factors that do the same, and a power law is far from what the effects leave of the friction: a refit moves its constants
/// further than a linear step goes.
#[test]
fn a_formula_whose_constants_move_far_is_written_as_what_was_refitted() {
    use frikan_runtime::shared::expression::{Operation, Program};
    use frikan_runtime::shared::model::{Input, Law, Model};
    use frikan_runtime::shared::units::Quantity;
    let case = Case {
        hidden: Hidden::Effect("presliding", 300.0),
        noise: NoiseKind::White,
        base: BaseKind::CoulombViscous,
        seed: 5,
    };
    let Concealed { recording, joint, .. } = conceal(&case).unwrap();
    let signals = signals(&recording, &joint);
    let operations = [
        Operation::ScaledInput(0, 3.7),
        Operation::ScaledMagnitude(0, 1.0),
        Operation::Offset(1e-9),
        Operation::PowerOf(0.7),
        Operation::Divide,
    ];
    let model = Model {
        inputs: [Input { quantity: Quantity::Velocity, unit: Unit::RadianPerSecond, low: -4.0, high: 4.0 }]
            .into_iter()
            .collect(),
        output_unit: Unit::NewtonMetre,
        output_limit: 40.0,
        rigid_body: RigidBody { given_scale: 1.0, ..RigidBody::default() },
        law: Law::Expression(Program { operations: operations.into_iter().collect() }),
        effects: [].into_iter().collect(),
        cells: Default::default(),
    };
    model.validate().unwrap();
    let state = signals.states();
    let reference = model::at(&model, &state, signals.rigid_body.as_deref()).unwrap();
    let comparison = Comparison::with(signals.clone(), reference);
    let diagnosis = diagnose(&comparison, &Options { base: BaseKind::Reference, ..Options::default() }).unwrap();
    let origin = Origin::Model(&model);
    let improved = improve(&diagnosis, &comparison, origin, Unit::NewtonMetre, Profile::default()).unwrap();
    let torque = model::at(&improved.model, &state, signals.rigid_body.as_deref()).unwrap().torque;
    let prepared = Comparison::from(signals.clone()).prepare(Lock::Nothing);
    let residual: Vec<f64> = signals.torque.iter().zip(&torque).map(|(recorded, model)| recorded - model).collect();
    let residual = prepared.filtered(&residual);
    let rmse = (residual.iter().map(|r| r * r).sum::<f64>() / residual.len() as f64).sqrt();
    let [before, after] = [diagnosis.baseline.rmse, diagnosis.improved.rmse];
    println!("{before} -> {after}, image {rmse}; {:?}", improved.remarks);
    // An image does not hold how the friction of the recording turns over, beside which it is refitted.
    assert!(after < 0.5 * before && rmse < 2.0 * after, "{before} -> {after}, image {rmse}");
}
