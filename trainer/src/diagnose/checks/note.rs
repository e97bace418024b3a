//! A note on the measurement chain, as values: a sentence is made of it elsewhere.

use crate::checks::Note;
use crate::physics::EffectId;
use crate::samples::spikes::Spikes;

/// What was seen of the measurement. Torques are in the unit of the actuator, positions in rad or m.
#[derive(Clone, Debug, PartialEq)]
pub enum Observation {
    /// A fault of the recording that was found before its signals were built.
    Recording(RecordingNote),
    /// Samples that no motion of the joint can explain and that were replaced.
    Glitches(Spikes),
    /// The torque stands at its largest value in a share of the samples.
    ClippedTorque {
        /// That value.
        limit: f64,
        /// Share of the samples, 0..1.
        share: f64,
    },
    /// The recorded torque is a command beyond what the drive can give, N m.
    CommandBeyondLimit {
        /// What the drive gives at most.
        limit: f64,
        /// The largest recorded command.
        largest: f64,
        /// Share of the samples beyond the limit, 0..1.
        share: f64,
    },
    /// The torque is recorded in steps larger than its noise.
    CoarseTorque {
        /// The step.
        step: f64,
    },
    /// The position is recorded in steps whose noise hides everything above a frequency.
    CoarsePosition {
        /// The step.
        step: f64,
        /// That frequency, Hz.
        cut_off_hz: f64,
    },
    /// The position was sampled at other instants than the clock says.
    SamplingJitter {
        /// Standard deviation of the instants, s.
        deviation_s: f64,
        /// Sample period, s.
        period_s: f64,
    },
    /// The torque was recorded at another time than the position and put back.
    RealignedTorque {
        /// How late it was, s; negative where early.
        delay_s: f64,
        /// Sample period, s.
        period_s: f64,
    },
    /// The recorded velocity goes with the derivative of the position, but is this many times as large.
    ContradictingVelocity {
        /// Ratio of the recorded to the derived velocity.
        ratio: f64,
    },
    /// Friction comes out as driving the joint.
    DrivingFriction,
    /// A part of the rigid body or the model enters with a sign or in a unit that is not the recording's.
    WrongFactor {
        /// The part.
        part: TorquePart,
        /// Its factor; 1 is right.
        factor: f64,
        /// The unit confusion that leaves this factor; `None` for a turned sign.
        confusion: Option<&'static str>,
    },
    /// Samples at which a model is asked for more than it was fitted on; they are not compared.
    BeyondModelRange {
        /// Each channel with the range that the model was fitted on and its unit.
        channels: Vec<(String, [f64; 2], String)>,
        /// Share of the samples, 0..1.
        share: f64,
    },
    /// Something that happened once, in rows that were locked away.
    LockedEvent {
        /// When, s.
        when_s: [f64; 2],
        /// Root mean square of what the model leaves there.
        rms: f64,
    },
}

/// A fault of one recording, with what it takes to tell it.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingNote {
    /// The fault and its times.
    pub note: Note,
    /// Name of the actuator channel, e.g. `torque`.
    pub actuator: String,
    /// Name of the recording where it is one of several.
    pub recording: Option<String>,
}

/// Part of the torque that is given beside friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorquePart {
    /// Torque of the simulation or the model.
    Model,
    /// Inertia times acceleration.
    Inertia,
    /// Load torque.
    Load,
    /// The whole rigid body.
    RigidBody,
    /// The acceleration itself, where no body is given.
    Acceleration,
}

/// A note on the measurement chain.
#[derive(Clone, Debug, PartialEq)]
pub struct HealthNote {
    /// The effect of the catalogue it stands for.
    pub effect: EffectId,
    /// Whether a diagnosis of physics makes no sense before it is repaired.
    pub blocking: bool,
    /// What was seen.
    pub observation: Observation,
}
