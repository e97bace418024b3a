//! Images of BAM's friction against its formulas, and there and back.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::image::Image;
use frikan_shared::model::MAX_INPUTS;
use frikan_shared::units::Quantity;

use super::*;
use crate::actuator::{Kind, Known};
use crate::error::codes;
use crate::fit::CELLS;
use crate::joint::{Joint, Payload};

const HANGING: Surroundings = Surroundings {
    supply: Some(5.0),
    firmware_kp: None,
    payload: Some(Payload { mass_kg: 0.4, distance_m: 0.1, phase_rad: 0.3 }),
};
const BARE: Surroundings = Surroundings { supply: Some(5.0), firmware_kp: None, payload: None };

/// A servo of about the size of an XL330, with every parameter of its friction model.
fn servo(variant: Variant) -> Parameters {
    let value = |key| match key {
        "friction_base" => 0.0023,
        "friction_viscous" => 0.0185,
        "friction_stribeck" => 0.0042,
        "dtheta_stribeck" => 0.115,
        "alpha" => 1.35,
        "load_friction_base" => 0.25,
        "load_friction_stribeck" => 0.052,
        "load_friction_motor" => 0.23,
        "load_friction_external" => 0.26,
        "load_friction_motor_stribeck" => 0.11,
        "load_friction_external_stribeck" => 0.15,
        "load_friction_motor_quad" => 0.0056,
        "load_friction_external_quad" => 0.0038,
        other => panic!("{other}"),
    };
    let of_motor = [("kt", 0.286), ("R", 2.0), ("armature", 0.0026), ("command_delay", 0.005), ("q_offset", 0.0155)];
    Parameters::new(variant, "xl330", variant.keys().into_iter().map(|key| (key, value(key))).chain(of_motor))
}

/// The friction of an image at a velocity, a torque of the motor and a position.
fn torque(image: &Image<CELLS>, velocity: f32, motor: f32, position: f32) -> f64 {
    let mut at = [0.0; MAX_INPUTS];
    for (channel, input) in at.iter_mut().zip(&image.model.inputs) {
        *channel = match input.quantity {
            Quantity::Velocity => velocity,
            Quantity::Load => motor,
            _ => position,
        };
    }
    f64::from(evaluate(&image.model, &at))
}

/// Velocities beyond the flank of the smoothed sign, torques of the motor and positions, in all pairs.
fn grid() -> impl Iterator<Item = (f32, f32, f32)> {
    let velocities = [-17.0_f32, -3.0, -0.4, -0.06, 0.06, 0.2, 1.1, 9.0];
    let motors = [-0.7_f32, -0.31, -0.02, 0.0, 0.13, 0.39, 0.71];
    let positions = [-2.9_f32, -1.2, -0.3, 0.0, 0.6, 2.2];
    velocities.into_iter().flat_map(move |velocity| {
        motors.into_iter().flat_map(move |motor| positions.into_iter().map(move |position| (velocity, motor, position)))
    })
}

#[test]
fn every_friction_model_is_held_with_and_without_a_torque_from_outside() {
    for variant in Variant::ALL {
        let parameters = servo(variant);
        for surroundings in [HANGING, BARE] {
            let image = image(&parameters, &surroundings).unwrap();
            let body = surroundings.body();
            for (velocity, motor, position) in grid() {
                let external = -body.gravity(f64::from(position));
                let expected = parameters.torque(f64::from(velocity), f64::from(motor), external);
                let found = torque(&image, velocity, motor, position);
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{variant:?} at {velocity} {motor} {position}: {found} {expected}"
                );
            }
            assert!((image.model.rigid_body.inertia - 0.0026).abs() < 1e-9);
        }
    }
}

#[test]
fn a_law_of_bam_is_recognised_and_comes_back_to_the_last_bit() {
    for variant in Variant::ALL {
        for surroundings in [HANGING, BARE] {
            let first = image(&servo(variant), &surroundings).unwrap();
            let recognised = recognised(&first.model, "xl330").unwrap();
            let has_outside = surroundings.payload.is_some() || variant.load().is_none();
            assert_eq!(recognised.variant, if has_outside { variant } else { Variant::M5 });
            let motor = servo(variant);
            let motor = ["kt", "R", "armature"].map(|key| (key, motor.friction(key)));
            let text = recognised.with(motor).to_json("a test");
            let again = image(&Parameters::parse(&text).unwrap(), &surroundings).unwrap();
            for (velocity, motor, position) in grid() {
                let [before, after] = [&first, &again].map(|image| torque(image, velocity, motor, position));
                assert!(
                    (after - before).abs() < 1e-8,
                    "{variant:?} at {velocity} {motor} {position}: {before} {after}"
                );
            }
        }
    }
    let mut other = image(&servo(Variant::M2), &BARE).unwrap();
    if let frikan_shared::model::Law::Expression(program) = &mut other.model.law {
        program.operations.pop();
    }
    assert!(super::recognised(&other.model, "xl330").is_none());
}

#[test]
fn the_joint_of_a_simulation_has_the_friction_of_bam_but_for_the_squares() {
    for variant in Variant::ALL {
        let parameters = servo(variant);
        let known = Surroundings { firmware_kp: Some(400.0), ..HANGING };
        let (text, _) = joint_file(&parameters, &known, "a test");
        let friction = crate::plant::Joint::described_by(&Joint::parse(&text).unwrap()).unwrap().friction;
        for (velocity, motor, position) in grid() {
            let [velocity, motor, position] = [velocity, motor, position].map(f64::from);
            let external = -known.body().gravity(position);
            let dry = friction.dry_level(velocity.abs()) + friction.load_level(velocity.abs(), motor, external);
            let found = dry.copysign(velocity) + friction.viscous_nm_s_rad * velocity;
            let squares = if variant == Variant::M6 { 0.0056 * motor.abs().min(external.abs()).powi(2) } else { 0.0 };
            let expected = parameters.torque(velocity, motor, external);
            assert!(
                (found - expected).abs() <= squares + 1e-12,
                "{variant:?} at {velocity} {motor}: {found} {expected}"
            );
        }
    }
}

#[test]
fn friction_of_a_torque_of_unknown_size_makes_no_image() {
    let error = image(&servo(Variant::M4), &Surroundings::default()).unwrap_err();
    assert_eq!((error.code(), error.column()), (&codes::MISSING_PARAMETER, Some("actuator.supply_V")));
    assert!(image(&servo(Variant::M2), &Surroundings::default()).is_ok());
}

#[test]
fn joint_toml_says_what_bam_knows_and_what_it_does_not() {
    let (text, remarks) = joint_file(&servo(Variant::M6), &HANGING, "a test");
    let joint = Joint::parse(&text).unwrap();
    assert_eq!((joint.actuator.kind, joint.actuator.preset.as_deref()), (Kind::PositionServo, Some("XL330")));
    let given = |constant| joint.actuator.constants.get(&constant).copied().and_then(Known::given);
    use crate::actuator::Constant::{Delay, FirmwareKp, Resistance, Supply, TorqueConstant};
    for (constant, value) in [(TorqueConstant, 0.286), (Resistance, 2.0), (Supply, 5.0), (Delay, 0.005)] {
        assert_eq!(given(constant), Some(value), "{text}");
    }
    assert_eq!(given(FirmwareKp), None);
    assert!(text.contains("# firmware_kp = ..."), "{text}");
    let (with_kp, _) = joint_file(&servo(Variant::M6), &Surroundings { firmware_kp: Some(400.0), ..HANGING }, "a test");
    let plant = crate::plant::Joint::described_by(&Joint::parse(&with_kp).unwrap()).unwrap();
    assert!((plant.inertia_kgm2 - 0.0066).abs() < 1e-12);
    assert!((plant.gravity_torque_nm[0] - 0.392_266).abs() < 1e-9 && (plant.gravity_phase_rad - 0.3).abs() < 1e-9);
    assert_eq!(joint.payload, HANGING.payload);
    assert_eq!((plant.friction.coulomb_torque_nm, plant.friction.stribeck_exponent), (0.0023, 1.35));
    let told = remarks.join("; ");
    assert!(
        told.contains("q_offset of 15.5 mrad") && told.contains("[plant.friction] has no load_friction_motor_quad"),
        "{told}"
    );
    let (_, remarks) = joint_file(&servo(Variant::M5), &BARE, "a test");
    assert!(remarks.join("; ").contains("load_friction_external 0.26 N m"), "{remarks:?}");
}

#[test]
fn what_an_actuator_of_a_kind_has_not_is_told() {
    let hls = Parameters::new(Variant::M1, "feetech_hls", [("friction_base", 0.01), ("friction_viscous", 0.0)]);
    let hls = hls.with([("kt", 1.4), ("R", 7.5), ("current_limit", 1.37)]);
    let (text, remarks) = joint_file(&hls, &Surroundings::default(), "a test");
    assert_eq!(Joint::parse(&text).unwrap().actuator.kind, Kind::Current);
    assert!(text.contains("torque_limit_Nm = 1.9"), "{text}");
    assert!(remarks.iter().any(|remark| remark.starts_with("R is no constant")), "{remarks:?}");
    let sts = Parameters::new(Variant::M1, "sts3215", [("friction_base", 0.05), ("friction_viscous", 0.0)]);
    let sts = sts.with([("kt", 1.2), ("R", 2.7), ("error_gain_ratio", 2.0), ("max_velocity", 5.0)]);
    let (text, _) = joint_file(&sts, &Surroundings::default(), "a test");
    assert!(text.contains("firmware_error_gain = 0.332\n") && text.contains("velocity_limit_rad_s = 5\n"), "{text}");
    assert!(text.contains("# supply_V = ..."), "{text}");
}
