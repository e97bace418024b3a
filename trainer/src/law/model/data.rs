//! What a law is found from: channels, a target, columns that are fitted along with it, and blocks to hold out.

use crate::numerics::averages::Averages;

/// What a channel means to a friction law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChannelRole {
    /// Velocity of the joint, rad/s or m/s. A friction law needs exactly one.
    Velocity,
    /// Torque or force transmitted through the gear.
    Load,
    /// Temperature.
    Temperature,
    /// Position of the joint, rad or m.
    Position,
    /// Anything else; may scale the friction as a load does.
    Other,
}

/// One input of a law.
#[derive(Clone, Debug)]
pub struct Channel {
    /// The engineer's name, `velocity`.
    pub name: String,
    /// The unit as printed, `rad/s`.
    pub unit: String,
    /// What it means.
    pub role: ChannelRole,
    /// One value a sample.
    pub values: Vec<f64>,
}

/// A column whose coefficient is fitted jointly with every law but is no part of it: acceleration, gravity, offset.
#[derive(Clone, Debug)]
pub struct Nuisance {
    /// Name of the *coefficient*, `inertia`.
    pub name: String,
    /// Unit of the coefficient, `kg m²`.
    pub unit: String,
    /// One value a sample.
    pub values: Vec<f64>,
}

/// States that a filtered sample averages over: the law of each of them counts with its weight, not the law of their average.
#[derive(Clone, Debug)]
pub struct States {
    /// The states of each sample.
    pub averages: Averages,
    /// `channels[i][state]`: the channels of the data, in their order.
    pub channels: Vec<Vec<f64>>,
}

/// Samples of `target = law(channels) + sum of nuisance coefficient x column + noise`, in the order of recording.
#[derive(Clone, Debug)]
pub struct LawData {
    /// Inputs the law may use.
    pub channels: Vec<Channel>,
    /// Torque, force or current, one value a sample.
    pub target: Vec<f64>,
    /// Unit of the target: `N m`, `N` or `A`.
    pub target_unit: String,
    /// Columns fitted along.
    pub nuisance: Vec<Nuisance>,
    /// What a law is averaged over; `None` where it holds for the channels of a sample themselves.
    pub states: Option<States>,
    /// Block of each sample: samples of one block are held out together. Any labels; at least two different ones.
    pub blocks: Vec<usize>,
}

/// Why no law can be looked for in the data.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// Too few samples.
    #[error("{samples} samples are too few to fit {constants} constants")]
    TooFewSamples {
        /// Samples given.
        samples: usize,
        /// Constants of the form.
        constants: usize,
    },
    /// A column has another length than the target.
    #[error("column {column} holds {found} values, the target {expected}")]
    Length {
        /// The column.
        column: String,
        /// Its length.
        found: usize,
        /// Length of the target.
        expected: usize,
    },
    /// A value is NaN or infinite.
    #[error("column {column} is not finite at sample {row}")]
    NotFinite {
        /// The column.
        column: String,
        /// The first such sample.
        row: usize,
    },
    /// There is not exactly one velocity channel.
    #[error("a friction law needs exactly one velocity channel, {found} are given")]
    Velocity {
        /// Velocity channels given.
        found: usize,
    },
    /// The velocity does not vary.
    #[error("the velocity is constant, no friction law can be told from it")]
    ConstantVelocity,
}

impl LawData {
    /// Number of samples.
    pub fn rows(&self) -> usize {
        self.target.len()
    }

    /// Index of the velocity channel.
    ///
    /// # Errors
    /// When there is not exactly one.
    pub fn velocity(&self) -> Result<usize, LawError> {
        let found: Vec<usize> = self.with_role(ChannelRole::Velocity).collect();
        match found[..] {
            [one] => Ok(one),
            _ => Err(LawError::Velocity { found: found.len() }),
        }
    }

    /// Indices of the channels of one role.
    pub fn with_role(&self, role: ChannelRole) -> impl Iterator<Item = usize> {
        self.channels.iter().enumerate().filter(move |(_, c)| c.role == role).map(|(i, _)| i)
    }

    /// Checks lengths, finiteness and that the velocity moves.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn check(&self) -> Result<(), LawError> {
        let expected = self.rows();
        let channels = self.channels.iter().map(|c| (&c.name, &c.values));
        let nuisance = self.nuisance.iter().map(|c| (&c.name, &c.values));
        let target = "target".to_owned();
        for (column, values) in channels.chain(nuisance).chain([(&target, &self.target)]) {
            if values.len() != expected {
                return Err(LawError::Length { column: column.clone(), found: values.len(), expected });
            }
            if let Some(row) = values.iter().position(|x| !x.is_finite()) {
                return Err(LawError::NotFinite { column: column.clone(), row });
            }
        }
        if self.blocks.len() != expected {
            return Err(LawError::Length { column: "blocks".into(), found: self.blocks.len(), expected });
        }
        let velocity = &self.channels[self.velocity()?].values;
        let needed = 8 + self.nuisance.len();
        if expected < needed {
            return Err(LawError::TooFewSamples { samples: expected, constants: needed });
        }
        if velocity.iter().all(|v| *v == velocity[0]) {
            return Err(LawError::ConstantVelocity);
        }
        Ok(())
    }

    /// The same data reduced to `rows`, in that order.
    pub fn select(&self, rows: &[usize]) -> Self {
        let pick = |values: &[f64]| rows.iter().map(|&r| values[r]).collect::<Vec<_>>();
        Self {
            channels: self.channels.iter().map(|c| Channel { values: pick(&c.values), ..c.clone() }).collect(),
            target: pick(&self.target),
            target_unit: self.target_unit.clone(),
            nuisance: self.nuisance.iter().map(|c| Nuisance { values: pick(&c.values), ..c.clone() }).collect(),
            states: self.states.as_ref().map(|states| states.select(rows)),
            blocks: rows.iter().map(|&r| self.blocks[r]).collect(),
        }
    }

    /// Columns that a law is evaluated on.
    pub(in crate::law) fn columns(&self) -> Vec<&[f64]> {
        match &self.states {
            Some(states) => states.channels.iter().map(Vec::as_slice).collect(),
            None => self.channels.iter().map(|c| c.values.as_slice()).collect(),
        }
    }
}

impl States {
    fn select(&self, rows: &[usize]) -> Self {
        let (averages, kept) = self.averages.select(rows);
        let pick = |values: &Vec<f64>| kept.iter().map(|&state| values[state]).collect();
        Self { averages, channels: self.channels.iter().map(pick).collect() }
    }
}
