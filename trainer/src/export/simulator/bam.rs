//! The parameters of a servo as Rhoban's BAM keeps them (Duclusaud et al. 2024), as JSON for its `load_model`.

use frikan_runtime::evaluate::evaluate;
use frikan_shared::effect::Effect;
use frikan_shared::image::Image;
use frikan_shared::model::MAX_INPUTS;
use frikan_shared::units::Quantity;

use super::content::Content;
use super::form::Form;
use super::request::Request;
use crate::bam::{Parameters, Variant, recognised};
use crate::error::{Error, Result, codes};
use crate::fit::{CELLS, HostModel};

/// Exponent of our Stribeck peak, exp(-(v / v_s)^2).
const STRIBECK_EXPONENT: f64 = 2.0;

/// Motor, inertia and friction of a servo. Friction that came from BAM goes back as it came. Any other is `friction_base + friction_stribeck s +
/// |motor torque| (load_friction_motor + load_friction_motor_stribeck s) + friction_viscous |v|`, s = exp(-|v / dtheta_stribeck|^alpha): the model
/// `m1` of BAM, `m2` with a Stribeck peak, `m5` with friction of the load, which goes with the torque of the motor alone, as in an image.
///
/// # Errors
/// `FRK-U001` without a motor of known constants, whose name is one that BAM knows, or without an inertia.
pub(super) fn parameters(image: &Image<CELLS>, request: &Request) -> Result<String> {
    let mut without_load = image.clone();
    without_load.model.effects.retain(|effect| !matches!(effect, Effect::Load { .. }));
    let content = Content::of(&without_load, request)?;
    let refused = |message: &str| Error::new(&codes::USAGE, message);
    let actuator = content.actuator.and_then(|simulated| simulated.motor()).ok_or_else(|| {
        refused("BAM describes a servo by its motor: give `--joint JOINT.toml` with an [actuator] of kind `position_servo` or `dc_motor`, its supply and its loss by velocity")
    })?;
    let name = request.joint.ok_or_else(|| {
        refused("BAM needs the name of an actuator that it knows, such as xl330 or sts3215: give it as `--joint-name`")
    })?;
    let inertia = content
        .inertia()
        .ok_or_else(|| refused("the image has no inertia of the joint, which BAM needs as `armature`"))?;
    let friction = recognised(&image.model, name).filter(|_| image.model.effects.is_empty());
    let friction = friction.unwrap_or_else(|| {
        let form = content.with_stribeck().unwrap_or(content.coulomb_viscous);
        fitted(form, share_of_load(&image.model), name)
    });
    let parameters = friction.with([
        // torque = kt / R (u - kt v): gain and loss by velocity of the motor give both.
        ("kt", actuator.back_emf / actuator.gain),
        ("R", actuator.back_emf / actuator.gain.powi(2)),
        ("armature", inertia),
        ("command_delay", actuator.delay_s),
    ]);
    Ok(parameters.to_json(&format!("{}. BAM was not run with this file.", content.title)))
}

/// The friction model of a form, with `load` N m of friction for each N m of the motor.
fn fitted(form: Form, load: f64, actuator: &str) -> Parameters {
    let has_peak = form.excess > 0.0 || load > 0.0;
    let variant = match (load > 0.0, has_peak) {
        (true, _) => Variant::M5,
        (false, true) => Variant::M2,
        (false, false) => Variant::M1,
    };
    let value = |key| match key {
        "friction_base" => form.coulomb,
        "friction_viscous" => form.damping[0],
        "friction_stribeck" => form.excess,
        // Without a peak the width has no meaning; it must not be zero.
        "dtheta_stribeck" if form.excess > 0.0 => form.stribeck_velocity,
        "dtheta_stribeck" => 1.0,
        "alpha" => STRIBECK_EXPONENT,
        "load_friction_motor" => load,
        _ => 0.0,
    };
    Parameters::new(variant, actuator, variant.keys().into_iter().map(|key| (key, value(key))))
}

/// Friction for each N m of the actuator's torque: of load-dependent terms, and of a law that reads the load.
fn share_of_load(model: &HostModel) -> f64 {
    let of_terms =
        model.effects.iter().map(|effect| if let Effect::Load { mean, .. } = effect { f64::from(*mean) } else { 0.0 });
    let place = |quantity: Quantity| model.inputs.iter().position(|input| input.quantity == quantity);
    let of_law = place(Quantity::Velocity).zip(place(Quantity::Load)).map(|(velocity, load)| {
        let at = |share: f32| {
            let mut at = [0.0; MAX_INPUTS];
            at.iter_mut().zip(&model.inputs).for_each(|(channel, input)| *channel = 0.5 * (input.low + input.high));
            at[velocity] = model.inputs[velocity].high;
            at[load] = share * model.inputs[load].high;
            f64::from(evaluate(model, &at))
        };
        (at(1.0) - at(0.0)) / f64::from(model.inputs[load].high)
    });
    of_terms.sum::<f64>() + of_law.unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bam::Surroundings;
    use crate::export::simulator::SimulatedActuator;
    use crate::export::simulator::tests::image_of;
    use crate::joint::Joint;
    use frikan_shared::units::Unit;
    use serde_json::Value;

    #[test]
    fn a_servo_is_told_by_its_motor_and_the_friction_of_its_gear() {
        let mut image = image_of(0.02, 0.01, Unit::NewtonMetre);
        let (mean, width) = (0.25, 0.001);
        let (difference, quadratic, stribeck) = (0.0, 0.0, 0.0);
        let load = Effect::Load { mean, difference, quadratic, stribeck, velocity: width, smoothing_velocity: width };
        image.model.effects.push(load).unwrap();
        let joint = Joint::parse(
            "[actuator]\nkind = \"position_servo\"\ntorque_constant_Nm_A = 0.35\nresistance_ohm = 3.5\nsupply_V = 5\nfirmware_error_gain = 0.003\nfirmware_kp = 400\ndelay_s = 0.004\n",
        );
        let actuator = SimulatedActuator::of(&joint.unwrap()).unwrap();
        let request =
            |joint| Request { title: "", into: None, torque_per_ampere: None, joint, release: None, actuator };
        let told: Value = serde_json::from_str(&parameters(&image, &request(Some("xl330"))).unwrap()).unwrap();
        let of = |key: &str| told[key].as_f64().unwrap();
        for (key, value) in [
            ("kt", 0.35),
            ("R", 3.5),
            ("armature", 0.5),
            ("command_delay", 0.004),
            ("friction_base", 0.02),
            ("friction_viscous", 0.01),
            ("load_friction_motor", 0.25),
            ("load_friction_external", 0.0),
        ] {
            assert!((of(key) - value).abs() < 0.02 * value + 1e-9, "{key}: {} for {value}", of(key));
        }
        assert_eq!((told["model"].as_str(), told["actuator"].as_str()), (Some("m5"), Some("xl330")));
        assert!(parameters(&image, &request(None)).unwrap_err().to_string().contains("joint-name"));
    }

    #[test]
    fn what_goes_to_bam_comes_back() {
        let joint = Joint::parse(
            "[actuator]\nkind = \"position_servo\"\ntorque_constant_Nm_A = 0.35\nresistance_ohm = 3.5\nsupply_V = 5\nfirmware_error_gain = 0.003\nfirmware_kp = 400\n",
        );
        let actuator = SimulatedActuator::of(&joint.unwrap()).unwrap();
        let request =
            Request { title: "", into: None, torque_per_ampere: None, joint: Some("xl330"), release: None, actuator };
        let image_of_joint = image_of(0.02, 0.01, Unit::NewtonMetre);
        let back = Parameters::parse(&parameters(&image_of_joint, &request).unwrap()).unwrap();
        let back = crate::bam::image(&back, &Surroundings::default()).unwrap();
        assert!((back.model.rigid_body.inertia - 0.5).abs() < 1e-6);
        for velocity in [-2.0_f32, -0.6, -0.1, 0.1, 0.6, 2.0] {
            let [before, after] =
                [&image_of_joint.model, &back.model].map(|model| evaluate(model, &[velocity; MAX_INPUTS]));
            assert!((after - before).abs() < 2e-3 * before.abs(), "{velocity}: {after} for {before}");
        }
    }
}
