//! A joint with its actuator as a forward simulation takes it, with values for everything that a search may move.

use super::commanded::Commanded;
use super::friction::GearFriction;
use crate::actuator::{Actuator, Open, Partial};
use crate::error::Result;
use crate::numerics::Number;
use crate::rollout::{Body, Rig, Series, State, simulate};

/// What is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    Actuator(Open),
    BackEmf,
    Delay,
    FeedbackDelay,
    TorqueLimit,
    Inertia,
    Offset,
    /// Of the joint's own gravity torque, of the sine of the position and of the cosine.
    GravitySin,
    GravityCos,
    Coulomb,
    Stribeck,
    StribeckVelocity,
    Viscous,
    Load,
}

/// A joint with values for everything that is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate<T = f64> {
    pub(super) friction: GearFriction<T>,
    /// Inertia of the joint without payload, kg m2.
    pub(super) inertia: T,
    /// Constant torque, N m.
    pub(super) offset: T,
    pub(super) gravity: [T; 2],
    pub(super) open: [Option<T>; 3],
    /// Loss of a motor by its velocity where coasting shows it, N m s/rad.
    pub(super) back_emf: Option<T>,
    pub(super) delay_s: T,
    /// Time from the motion to what a controller makes of it, s.
    pub(super) feedback_delay_s: T,
    /// Largest torque of a motor where that is not given, N m.
    pub(super) torque_limit: Option<T>,
}

pub(super) fn place(open: Open) -> usize {
    match open {
        Open::Gain => 0,
        Open::Kp => 1,
        Open::Kd => 2,
    }
}

impl Candidate {
    pub(super) fn value(&self, what: What) -> f64 {
        match what {
            What::Actuator(open) => self.open[place(open)].unwrap_or(0.0),
            What::BackEmf => self.back_emf.unwrap_or(0.0),
            What::Delay => self.delay_s,
            What::FeedbackDelay => self.feedback_delay_s,
            What::TorqueLimit => self.torque_limit.unwrap_or(f64::INFINITY),
            What::Inertia => self.inertia,
            What::Offset => self.offset,
            What::GravitySin => self.gravity[0],
            What::GravityCos => self.gravity[1],
            What::Coulomb => self.friction.coulomb,
            What::Stribeck => self.friction.stribeck,
            What::StribeckVelocity => self.friction.stribeck_velocity,
            What::Viscous => self.friction.viscous,
            What::Load => self.friction.load,
        }
    }

    /// The same in other numbers.
    pub(super) fn lifted<T: Number>(&self) -> Candidate<T> {
        let friction = &self.friction;
        Candidate {
            friction: GearFriction {
                coulomb: friction.coulomb.into(),
                stribeck: friction.stribeck.into(),
                stribeck_velocity: friction.stribeck_velocity.into(),
                viscous: friction.viscous.into(),
                load: friction.load.into(),
            },
            inertia: self.inertia.into(),
            offset: self.offset.into(),
            gravity: self.gravity.map(T::from),
            open: self.open.map(|value| value.map(T::from)),
            back_emf: self.back_emf.map(T::from),
            delay_s: self.delay_s.into(),
            feedback_delay_s: self.feedback_delay_s.into(),
            torque_limit: self.torque_limit.map(T::from),
        }
    }
}

impl<T: Number> Candidate<T> {
    pub(super) fn with(mut self, what: What, value: T) -> Self {
        match what {
            What::Actuator(open) => self.open[place(open)] = Some(value),
            What::BackEmf => self.back_emf = Some(value),
            What::Delay => self.delay_s = value,
            What::FeedbackDelay => self.feedback_delay_s = value,
            What::TorqueLimit => self.torque_limit = Some(value),
            What::Inertia => self.inertia = value,
            What::Offset => self.offset = value,
            What::GravitySin => self.gravity[0] = value,
            What::GravityCos => self.gravity[1] = value,
            What::Coulomb => self.friction.coulomb = value,
            What::Stribeck => self.friction.stribeck = value,
            What::StribeckVelocity => self.friction.stribeck_velocity = value,
            What::Viscous => self.friction.viscous = value,
            What::Load => self.friction.load = value,
        }
        self
    }

    /// The actuator of a recording with this candidate's constants for what is open there.
    fn actuator(&self, partial: &Partial) -> Actuator<T> {
        let mut actuator = partial.actuator.lifted();
        for open in [Open::Gain, Open::Kp, Open::Kd] {
            if let Some(value) = self.open[place(open)].filter(|_| partial.open.contains(&open)) {
                actuator = partial.completed(actuator, open, value);
            }
        }
        actuator.back_emf = self.back_emf.unwrap_or(actuator.back_emf);
        actuator.delay_s = self.delay_s;
        actuator.feedback_delay_s = self.feedback_delay_s;
        actuator.limits.torque = self.torque_limit.unwrap_or(actuator.limits.torque);
        actuator
    }

    /// Simulated states of a recording under its commands from its starts on.
    pub(super) fn states(
        &self,
        one: &Commanded<'_>,
        series: &Series,
        starts: &[(usize, State)],
    ) -> Result<Vec<State<T>>> {
        let own = Body {
            inertia: self.inertia,
            gravity_sin: self.gravity[0],
            gravity_cos: self.gravity[1],
            offset: self.offset,
        };
        let body = own.with(&one.payload.as_ref().map_or_else(Body::default, Body::of_payload));
        let actuator = self.actuator(&one.partial);
        simulate(&Rig { actuator, body }, series, &mut { self.friction }, starts)
    }
}
