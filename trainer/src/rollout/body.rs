//! The rigid body that an actuator moves: that of an image, and a payload.

use frikan_shared::model::RigidBody;

use crate::error::{Error, Result, codes};
use crate::joint::{Joint, Payload};
use crate::numerics::Number;
use crate::recording::Recording;

/// Standard acceleration of free fall, m/s2.
pub const FREE_FALL_M_S2: f64 = 9.806_65;

/// The payload of a recording: its columns `payload_kg` and `payload_m`, which have one value, or else what joint.toml says.
#[must_use]
pub fn payload(recording: &Recording, joint: &Joint) -> Option<Payload> {
    let told = joint.payload;
    let first = |name: &str| recording.named(name).and_then(|channel| channel.values.first()).copied();
    let (mass, distance) = (first("payload_kg"), first("payload_m"));
    if mass.is_none() && distance.is_none() {
        return told;
    }
    let told = told.unwrap_or_default();
    let (mass_kg, distance_m) = (mass.unwrap_or(told.mass_kg), distance.unwrap_or(told.distance_m));
    Some(Payload { mass_kg, distance_m, ..told })
}

/// Inertia and gravity of what moves, with a constant torque.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body<T = f64> {
    /// kg m2 (kg on a linear axis).
    pub inertia: T,
    /// Gravity torque per sine of the position, N m.
    pub gravity_sin: T,
    /// Gravity torque per cosine of the position, N m.
    pub gravity_cos: T,
    /// Constant torque that the actuator has to overcome, N m.
    pub offset: T,
}

impl Body {
    /// A payload alone.
    #[must_use]
    pub fn of_payload(payload: &Payload) -> Self {
        let moment = payload.mass_kg * payload.distance_m * FREE_FALL_M_S2;
        Self {
            inertia: payload.mass_kg * payload.distance_m.powi(2),
            gravity_sin: moment * payload.phase_rad.cos(),
            gravity_cos: moment * payload.phase_rad.sin(),
            offset: 0.0,
        }
    }

    /// The body of an image with a payload at it.
    ///
    /// # Errors
    /// `FRK-D014` without an inertia above zero, which nothing can be simulated without.
    pub fn of(body: &RigidBody, payload: Option<&Payload>) -> Result<Self> {
        let own = Self {
            inertia: f64::from(body.inertia),
            gravity_sin: f64::from(body.gravity_sin),
            gravity_cos: f64::from(body.gravity_cos),
            offset: f64::from(body.offset),
        };
        let whole = own.with(&payload.map_or_else(Self::default, Self::of_payload));
        if whole.inertia > 0.0 && whole.inertia.is_finite() {
            return Ok(whole);
        }
        let message =
            "a forward simulation needs an inertia above zero: that of the image, or of a payload of joint.toml";
        Err(Error::new(&codes::MISSING_PARAMETER, message).in_column("inertia").with_value(whole.inertia.to_string()))
    }
}

impl<T: Number> Body<T> {
    /// Both together.
    #[must_use]
    pub fn with(&self, other: &Body) -> Self {
        Self {
            inertia: self.inertia + other.inertia,
            gravity_sin: self.gravity_sin + other.gravity_sin,
            gravity_cos: self.gravity_cos + other.gravity_cos,
            offset: self.offset + other.offset,
        }
    }

    /// Torque of gravity at a position, rad: N m.
    #[must_use]
    pub fn gravity(&self, position: T) -> T {
        let (sine, cosine) = position.sin_cos();
        self.gravity_sin * sine + self.gravity_cos * cosine
    }
}
