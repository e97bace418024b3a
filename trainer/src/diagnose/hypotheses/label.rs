//! What a group of regressors stands for.

use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::unnamed::Generic;
use crate::physics::EffectId;

/// What a group of columns stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Label {
    /// An effect of the catalogue.
    Named(EffectId),
    /// An unnamed structure: a factor of velocity times a function of a channel.
    Generic(Generic),
}

impl Label {
    /// The effect's name: `unknown` for a structure without one.
    pub fn effect(&self) -> EffectId {
        match self {
            Self::Named(effect) => *effect,
            Self::Generic(_) => EffectId::Unknown,
        }
    }

    /// The channel of a structure without a name.
    pub(crate) fn channel(&self) -> Option<Channel> {
        match self {
            Self::Named(_) => None,
            Self::Generic(rival) => Some(rival.channel),
        }
    }

    /// Whether it is a function of the time of a recording, which is that of a simulation only where that follows the same motion.
    pub(crate) fn is_of_time(&self) -> bool {
        match self {
            Self::Named(effect) => matches!(effect, EffectId::TransientEvent | EffectId::SlowDrift | EffectId::WarmUp),
            Self::Generic(rival) => rival.channel == Channel::Time,
        }
    }
}

impl std::fmt::Display for Label {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Label::Named(effect) => f.write_str(effect.name()),
            Label::Generic(rival) => write!(f, "{} c({})", rival.factor.text(), rival.channel.name()),
        }
    }
}

/// Prior precision of each coefficient over what all rows tell of it: none for what has a name.
pub(crate) fn ridge_of(label: &Label, shape: &[f64]) -> Vec<f64> {
    match label {
        Label::Generic(rival) => rival.ridge(shape),
        Label::Named(_) => Vec::new(),
    }
}
