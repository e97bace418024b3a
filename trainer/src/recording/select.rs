//! A recording with some of its rows, or with the values of a channel put right: what the checks hand on.

use super::{Axis, Channel, Health, Quantity, Recording};
use std::ops::Range;

/// What becomes of the motion where rows are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Omission {
    /// It goes on: the rows said nothing new.
    Bridged,
    /// It is interrupted: the next row kept begins a new stretch.
    Interrupted,
}

impl Recording {
    /// The same recording with the rows `kept` only (increasing indices).
    #[must_use]
    pub fn with_rows(mut self, kept: &[usize], omission: Omission) -> Self {
        if kept.len() == self.len() {
            return self;
        }
        for channel in &mut self.channels {
            channel.values = kept.iter().map(|row| channel.values[*row]).collect();
        }
        self.table = self.table.with_rows(kept);
        let moved = |row: &usize| kept.partition_point(|kept| kept < row);
        let mut interruptions: Vec<usize> = self.health.interruptions.iter().map(moved).collect();
        if omission == Omission::Interrupted {
            interruptions.extend((1..kept.len()).filter(|index| kept[*index] > kept[index - 1] + 1));
        }
        self.interrupted_at(interruptions)
    }

    /// Stretches of the recording (in order and apart), interrupted between them; without its text.
    #[must_use]
    pub(crate) fn excerpt(&self, stretches: &[Range<usize>]) -> Self {
        let moved = |row: usize| {
            let before = stretches.partition_point(|stretch| stretch.end <= row);
            let rows: usize = stretches[..before].iter().map(Range::len).sum();
            let within = stretches.get(before).map_or(0, |stretch| row.saturating_sub(stretch.start));
            rows + within
        };
        let starts = stretches.iter().map(|stretch| stretch.start);
        let interruptions = self.health.interruptions.iter().copied().chain(starts).map(moved).collect();
        let of = |channel: &Channel| Channel {
            values: stretches.iter().flat_map(|stretch| &channel.values[stretch.clone()]).copied().collect(),
            name: channel.name.clone(),
            column: channel.column.clone(),
            column_unit: channel.column_unit.clone(),
            ..*channel
        };
        let excerpt = Self {
            label: self.label.clone(),
            channels: self.channels.iter().map(of).collect(),
            health: Health { notes: self.health.notes.clone(), ..Health::default() },
            table: self.table.excerpt(stretches),
            is_excerpt: true,
            nearly_named: self.nearly_named.clone(),
            unusable: self.unusable.clone(),
            file: self.file.clone(),
            ..*self
        };
        excerpt.interrupted_at(interruptions)
    }

    /// The same recording whose motion is interrupted before each of `rows` as well.
    #[must_use]
    pub fn with_interruptions(self, rows: &[usize]) -> Self {
        let interruptions = self.health.interruptions.iter().chain(rows).copied().collect();
        self.interrupted_at(interruptions)
    }

    /// The same recording with other values of a quantity, one a row; without the channel where there is none of it.
    #[must_use]
    pub fn with_values(mut self, quantity: Quantity, values: Vec<f64>) -> Self {
        if let Some(channel) = self.channels.iter_mut().find(|channel| channel.quantity == Some(quantity)) {
            channel.values = values;
        }
        self.with_health()
    }

    /// The same recording without a channel; its column stays in the text.
    #[must_use]
    pub fn without(mut self, quantity: Quantity) -> Self {
        self.channels.retain(|channel: &Channel| channel.quantity != Some(quantity));
        self.with_health()
    }

    /// The same recording with torque or force, and the rigid body's part of it, as the current that stands for it,
    /// `amperes_per_torque` A for each N m or N; as it is where it holds neither.
    #[must_use]
    pub fn with_torque_as_current(mut self, amperes_per_torque: f64) -> Self {
        for channel in &mut self.channels {
            match channel.quantity {
                Some(Quantity::Torque | Quantity::Force) => {
                    channel.quantity = Some(Quantity::Current);
                    channel.name = Quantity::Current.name().to_owned();
                }
                Some(Quantity::RigidBodyTorque) if channel.unit != "A" => {}
                _ => continue,
            }
            channel.unit = "A";
            channel.si_per_column_unit *= amperes_per_torque;
            channel.values.iter_mut().for_each(|value| *value *= amperes_per_torque);
        }
        self.with_health()
    }

    /// The motion of the recording, with its temperature, under a torque of the actuator, N m or N, one value a row, beside other channels by
    /// their names; what was commanded is left out.
    #[must_use]
    pub fn with_torque(mut self, torque: Vec<f64>, others: Vec<(String, Vec<f64>)>) -> Self {
        use Quantity::{Acceleration, Force, LinkPosition, Position, Temperature, Time, Torque, Velocity};
        let stays = [Time, Position, Velocity, Acceleration, LinkPosition, Temperature];
        self.channels.retain(|channel| channel.quantity.is_some_and(|quantity| stays.contains(&quantity)));
        let (quantity, unit) = if self.axis == Axis::Rotary { (Torque, "Nm") } else { (Force, "N") };
        let channel = |quantity: Option<Quantity>, name: String, unit: &'static str, values| {
            let column = quantity.map_or_else(|| name.clone(), Quantity::column);
            Channel { quantity, name, column, unit, column_unit: unit.to_owned(), si_per_column_unit: 1.0, values }
        };
        self.channels.push(channel(Some(quantity), quantity.name().to_owned(), unit, torque));
        self.channels.extend(others.into_iter().map(|(name, values)| {
            let quantity = Quantity::from_name(&name);
            channel(quantity, name, if quantity.is_some() { unit } else { "" }, values)
        }));
        self.with_health()
    }

    /// The same with the channels without a quantity of another recording of as many rows: motions of other joints.
    #[must_use]
    pub(crate) fn beside_unnamed_of(mut self, other: &Self) -> Self {
        self.channels.extend(other.channels.iter().filter(|channel| channel.quantity.is_none()).cloned());
        self
    }

    /// The same with another position, rad or m, one value a row.
    #[must_use]
    pub(crate) fn with_position(mut self, position: Vec<f64>) -> Self {
        if let Some(channel) = self.channels.iter_mut().find(|channel| channel.quantity == Some(Quantity::Position)) {
            channel.values = position;
        }
        self.with_health()
    }

    fn interrupted_at(mut self, mut interruptions: Vec<usize>) -> Self {
        let rows = self.len();
        interruptions.retain(|row| (1..rows).contains(row));
        interruptions.sort_unstable();
        interruptions.dedup();
        self.health.interruptions = interruptions;
        self.with_health()
    }

    fn with_health(mut self) -> Self {
        let Health { notes, interruptions, .. } = std::mem::take(&mut self.health);
        self.health = Health::of(&self.channels, notes, interruptions);
        self
    }
}
