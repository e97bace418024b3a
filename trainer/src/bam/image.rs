//! BAM's friction as an image.

use std::collections::BTreeMap;

use frikan_shared::image::Image;
use frikan_shared::model::{Input, Law, Model, RigidBody};
use frikan_shared::pool::Pool;
use frikan_shared::units::{Quantity, Unit};

use super::law::{Form, GRAVITY, GRAVITY_PHASE, SIGN_SLOPE, Torques};
use super::parameters::Parameters;
use crate::error::{Error, Result, codes};
use crate::fit::CELLS;
use crate::fit::model::provenance;
use crate::joint::Payload;
use crate::rollout::Body;
use crate::servo::FLANK_SHARE;

/// Top speed of a law where the supply of its motor is not known, rad/s: beyond any geared servo's.
const TOP_SPEED: f64 = 20.0;
/// Position up to which a law follows it, rad: sixteen turns.
const FURTHEST: f64 = 16.0 * std::f64::consts::TAU;
/// The limit of an image over the largest friction of its law.
const LIMIT_OVER_LARGEST: f64 = 1.5;

/// What BAM does not know of a servo.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surroundings {
    /// Supply voltage, V.
    pub supply: Option<f64>,
    /// Gain of the firmware, as it counts it.
    pub firmware_kp: Option<f64>,
    /// What hangs at the joint: its gravity is the torque from outside.
    pub payload: Option<Payload>,
}

impl Surroundings {
    /// The payload as a body.
    pub(super) fn body(&self) -> Body {
        self.payload.as_ref().map_or_else(Body::default, Body::of_payload)
    }

    /// Amplitude, N m, and phase, rad, of its gravity; none where nothing hangs.
    pub(super) fn gravity(&self) -> Option<(f64, f64)> {
        let body = self.body();
        let amplitude = body.gravity_sin.hypot(body.gravity_cos);
        (amplitude > 0.0).then(|| (amplitude, libm::atan2(body.gravity_cos, body.gravity_sin)))
    }

    /// Largest torque of the motor, N m: at its limit of the current, or at stall under its supply; none where neither is known.
    pub(super) fn largest_torque(&self, parameters: &Parameters) -> Option<f64> {
        let constant = parameters.get("kt")?;
        let at_stall = self.supply.zip(parameters.get("R")).map(|(supply, resistance)| supply / resistance);
        Some(constant * parameters.get("current_limit").or(at_stall)?)
    }
}

/// The friction of a servo as an image of the joint without payload, and its armature as the inertia. The torque of the motor is the load of
/// the gear; the torque from outside, that of gravity of the payload, follows from the position.
///
/// # Errors
/// `FRK-D014` where friction grows with the motor's torque and nothing says how large that is, `FRK-D020` where an image cannot hold a number.
pub fn image(parameters: &Parameters, surroundings: &Surroundings) -> Result<Box<Image<CELLS>>> {
    let gravity = surroundings.gravity();
    let form = Form::of(parameters.variant, gravity.is_some());
    let no_load = surroundings.supply.zip(parameters.get("kt")).map(|(supply, constant)| supply / constant);
    let top = no_load.unwrap_or(TOP_SPEED);
    let mut constants: BTreeMap<&'static str, f64> = parameters.each().collect();
    if form.torques == Torques::Motor {
        // With nothing from outside the gear carries the torque of the motor.
        for (of_motor, of_both) in
            [("load_friction_motor", "load_friction_base"), ("load_friction_motor_stribeck", "load_friction_stribeck")]
        {
            if let Some(share) = parameters.get(of_both) {
                constants.insert(of_motor, share);
            }
        }
    }
    constants.insert(SIGN_SLOPE, 1.0 / (FLANK_SHARE * top));
    if let Some((amplitude, phase)) = gravity {
        constants.extend([(GRAVITY, amplitude), (GRAVITY_PHASE, phase)]);
    }
    let strongest = match form.torques {
        Torques::None => 0.0,
        Torques::Motor | Torques::Both(_) => surroundings.largest_torque(parameters).ok_or_else(|| {
            let message = "friction that grows with the motor's torque needs its largest one: give the supply voltage, `--supply`";
            Error::new(&codes::MISSING_PARAMETER, message).in_column("actuator.supply_V")
        })?,
    };
    let hanging = gravity.map_or(0.0, |(amplitude, _)| amplitude);
    let opposed = parameters.torque(f64::MIN_POSITIVE, strongest, -hanging);
    let largest = opposed.max(parameters.torque(f64::MIN_POSITIVE, hanging.min(strongest), -hanging));
    let inputs = form.inputs().iter().map(|quantity| {
        let (unit, most) = match quantity {
            Quantity::Load => (Unit::NewtonMetre, strongest),
            Quantity::Position => (Unit::Radian, FURTHEST),
            _ => (Unit::RadianPerSecond, top),
        };
        Input { quantity: quantity.clone(), unit, low: -most as f32, high: most as f32 }
    });
    let model = Model {
        inputs: inputs.collect(),
        output_unit: Unit::NewtonMetre,
        output_limit: (LIMIT_OVER_LARGEST * (largest + parameters.friction("friction_viscous") * top)) as f32,
        rigid_body: RigidBody {
            inertia: parameters.friction("armature") as f32,
            given_scale: 0.0,
            ..RigidBody::default()
        },
        law: Law::Expression(form.program(&constants)),
        effects: heapless::Vec::new(),
        cells: Pool::new(),
    };
    model.validate().map_err(|fault| Error::new(&codes::BAD_IMAGE, format!("an image cannot hold this: {fault:?}")))?;
    Ok(Box::new(Image { model, provenance: provenance(&parameters.actuator, &[], 0) }))
}
