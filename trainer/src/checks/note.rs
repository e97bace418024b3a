//! What a check found, as values: which fault, when, with which figures. Sentences are made from it elsewhere.

use crate::error::{Code, codes};

/// A fault of a recording and where it lies in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// The fault.
    pub fault: Fault,
    /// Stretches of time that it concerns, s; empty where it is the whole recording.
    pub when_s: Vec<[f64; 2]>,
}

/// Kinds of fault. Positions are in rad or m, torques in the unit of the actuator.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// Rows that say the same as the row before, with its stamp or a later one: left out.
    RepeatedRows {
        /// Rows left out.
        rows: usize,
    },
    /// Rows with the stamp of the row before but other values: left out.
    RepeatedStamps {
        /// Rows left out.
        rows: usize,
    },
    /// A channel that is new only every so many rows: the rows between are left out.
    HeldSamples {
        /// Name of the channel.
        channel: String,
        /// Rows from one sample to the next.
        every: usize,
        /// Rate of its samples, Hz.
        rate_hz: f64,
    },
    /// A position that starts anew after each turn: unwrapped.
    WrappedPosition {
        /// Travel after which it starts anew.
        period: f64,
        /// How often it did.
        times: usize,
    },
    /// A position that jumped while the motion went on: what follows was shifted back, the motion is interrupted there.
    RezeroedPosition {
        /// By how much it jumped.
        by: f64,
    },
    /// A torque that stays exactly the same while the joint moves and the torque has to change: left out.
    FrozenTorque {
        /// Rows left out.
        rows: usize,
        /// The value, where it was the same in every stretch.
        value: Option<f64>,
    },
    /// A torque with the sign turned for a while: left out.
    TurnedTorque {
        /// Rows left out.
        rows: usize,
    },
    /// A torque that has the wrong sign all along: friction would drive the joint.
    WrongSign {
        /// Work of the actuator over the recording, J (A rad beside a current).
        work: f64,
        /// What friction takes up as recorded, W (A rad/s), negative here, and its standard error.
        dissipation: [f64; 2],
    },
    /// A velocity, or a position, in another unit than its column says.
    WrongUnit(WrongUnit),
    /// A recorded velocity that is not the derivative of the position: left out, the position is differentiated.
    ContradictingVelocity(Contradiction),
    /// The joint moves in one direction only: friction cannot be told from an offset.
    OneDirection,
    /// A column that nearly has the name of a quantity that is not recorded.
    NearlyNamed {
        /// Its name in the file.
        column: String,
        /// The name that it nearly has.
        known: String,
    },
}

/// How a wrong unit shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrongUnit {
    /// The recorded velocity is this many times the derivative of the position.
    VelocityOverDerivative(f64),
    /// Gravity acts as if the position were in degrees: what a law over degrees leaves of the torque, over what one over radians leaves.
    PositionInDegrees(f64),
}

/// How a recorded velocity contradicts the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contradiction {
    /// It does not change while the position does.
    Constant(f64),
    /// It comes later (above zero) or earlier, s.
    Late(f64),
    /// It is this many times the derivative.
    Scaled(f64),
    /// Its correlation with the derivative is only this.
    Unrelated(f64),
}

impl Note {
    /// A fault of the whole recording.
    #[must_use]
    pub fn of_all(fault: Fault) -> Self {
        Self { fault, when_s: Vec::new() }
    }
}

impl Fault {
    /// Entry of the registry.
    #[must_use]
    pub fn code(&self) -> &'static Code {
        match self {
            Self::RepeatedRows { .. } | Self::RepeatedStamps { .. } => &codes::REPEATED_ROWS,
            Self::HeldSamples { .. } => &codes::HELD_SAMPLES,
            Self::WrappedPosition { .. } => &codes::WRAPPED_POSITION,
            Self::RezeroedPosition { .. } => &codes::REZEROED_POSITION,
            Self::FrozenTorque { .. } => &codes::FROZEN_TORQUE,
            Self::TurnedTorque { .. } => &codes::TURNED_TORQUE,
            Self::WrongSign { .. } => &codes::WRONG_SIGN,
            Self::WrongUnit(_) => &codes::WRONG_UNIT,
            Self::ContradictingVelocity(_) => &codes::CONTRADICTING_VELOCITY,
            Self::OneDirection => &codes::ONE_DIRECTION,
            Self::NearlyNamed { .. } => &codes::NEARLY_NAMED,
        }
    }

    /// Whether the recording cannot be put right: nothing may be fitted to it.
    #[must_use]
    pub fn is_blocking(&self) -> bool {
        matches!(self, Self::WrongSign { .. } | Self::WrongUnit(_))
    }
}
