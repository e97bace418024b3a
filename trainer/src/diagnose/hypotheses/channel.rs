//! The channels and derived axes along which a structure is described and located.

use crate::physics::JointState;

/// Channel or derived axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Position.
    Position,
    /// Speed |v|.
    Speed,
    /// Transmitted load.
    Load,
    /// Temperature.
    Temperature,
    /// Time.
    Time,
    /// Acceleration.
    Acceleration,
    /// Distance since the last reversal.
    DistanceSinceReversal,
    /// Time since the last reversal.
    TimeSinceReversal,
    /// Length of the stop before the present motion.
    Dwell,
    /// Velocity of another joint.
    OtherVelocity(usize),
    /// Position of another joint.
    OtherPosition(usize),
}

impl Channel {
    /// The name that reports and scripts see.
    pub fn name(self) -> &'static str {
        match self {
            Channel::Position => "position",
            Channel::Speed => "velocity",
            Channel::Load => "load",
            Channel::Temperature => "temperature",
            Channel::Time => "time",
            Channel::Acceleration => "acceleration",
            Channel::DistanceSinceReversal => "distance_since_reversal",
            Channel::TimeSinceReversal => "time_since_reversal",
            Channel::Dwell => "dwell",
            Channel::OtherVelocity(_) => "other_velocity",
            Channel::OtherPosition(_) => "other_position",
        }
    }

    /// The name that people read.
    pub fn plain_name(self) -> &'static str {
        match self {
            Channel::Speed => "speed",
            Channel::DistanceSinceReversal => "the distance since the last reversal",
            Channel::TimeSinceReversal => "the time since the last reversal",
            Channel::Dwell => "the stop before the motion",
            Channel::OtherVelocity(_) => "the other joint's velocity",
            Channel::OtherPosition(_) => "the other joint's position",
            _ => self.name(),
        }
    }

    /// The axes along which a finding is located, velocity apart: it keeps its sign there.
    pub fn axes(state: &JointState) -> Vec<Channel> {
        let mut axes = vec![
            Channel::Position,
            Channel::Load,
            Channel::Temperature,
            Channel::Acceleration,
            Channel::DistanceSinceReversal,
            Channel::TimeSinceReversal,
            Channel::Dwell,
            Channel::Time,
        ];
        axes.extend((0..state.other_joints.len()).map(Channel::OtherVelocity));
        axes
    }

    /// The series of this channel, where the recording has it.
    pub fn series(self, state: &JointState) -> Option<Vec<f64>> {
        match self {
            Channel::Position => Some(state.position.clone()),
            Channel::Speed => Some(state.velocity.iter().map(|v| v.abs()).collect()),
            Channel::Load => state.load.clone(),
            Channel::Temperature => state.temperature.clone(),
            Channel::Time => Some(state.time.clone()),
            Channel::Acceleration => Some(state.acceleration.clone()),
            Channel::DistanceSinceReversal => Some(state.memory.distance.clone()),
            Channel::TimeSinceReversal => Some(state.memory.elapsed.clone()),
            Channel::Dwell => Some(state.memory.dwell.clone()),
            Channel::OtherVelocity(joint) => state.other_joints.get(joint).map(|other| other.velocity.clone()),
            Channel::OtherPosition(joint) => state.other_joints.get(joint).map(|other| other.position.clone()),
        }
    }
}
