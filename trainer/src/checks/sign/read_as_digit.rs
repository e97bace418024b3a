//! Numbers whose sign was read as size: of sign and magnitude the sign bit was taken for a digit (-5 as 32768 + 5), or of two's
//! complement the lower half for the upper (-5 as 65536 - 5).
//!
//! Such a channel has two ranges far apart and never a value between. Where the offset is that of a number of so many bits and the
//! two ranges meet once put back, they are put back.

use crate::checks::note::{Fault, Note};
use crate::numerics::resolution::resolution;
use crate::recording::{Channel, Quantity, Recording};

/// Bits of the numbers that drives and encoders send.
const BITS: [f64; 7] = [8.0, 10.0, 12.0, 14.0, 16.0, 24.0, 32.0];
/// Fewest passes from one range to the other.
const FEWEST_PASSES: usize = 2;
/// The recording with the signs of the position put back. A position of two's complement is one that starts anew after a turn.
pub(in crate::checks) fn with_signed_position(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    signed(recording, recording.channel(Quantity::Position)?, &[Coding::SignAndMagnitude])
}

/// The recording with the signs of torque, force or current put back.
pub(in crate::checks) fn with_signed_torque(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    let channel = recording.actuator().or_else(|| recording.separated_friction())?;
    signed(recording, channel, &[Coding::SignAndMagnitude, Coding::TwosComplement])
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Coding {
    SignAndMagnitude,
    TwosComplement,
}

impl Coding {
    /// By how many steps negative numbers of so many bits are too large.
    fn offset(self, bits: f64) -> f64 {
        match self {
            Self::SignAndMagnitude => (bits - 1.0).exp2(),
            Self::TwosComplement => bits.exp2(),
        }
    }
}

fn signed(recording: &Recording, channel: &Channel, codings: &[Coding]) -> Option<(Option<Recording>, Note)> {
    let (quantity, time) = (channel.quantity?, recording.values(Quantity::Time)?);
    let values = &channel.values;
    let split = Split::of(values)?;
    let step = resolution(values)?;
    let all = BITS.into_iter().flat_map(|bits| codings.iter().map(move |coding| (bits, *coding)));
    let (offset, signed) = all.into_iter().find_map(|(bits, coding)| {
        let offset = step * coding.offset(bits);
        Some((offset, split.put_back(values, coding, offset)?))
    })?;
    let fault = Fault::SignBit { channel: channel.name.clone(), offset, times: split.passes.len() };
    let when_s = split.passes.iter().map(|row| [time[*row]; 2]).take(LISTED).collect();
    Some((Some(recording.clone().with_values(quantity, signed)), Note { fault, when_s }))
}

/// Passes that a note lists at most.
const LISTED: usize = 50;

/// The two ranges of a channel: the values up to the widest gap, and those from it on.
struct Split {
    low: [f64; 2],
    high: [f64; 2],
    /// Rows that are in another range than the row before.
    passes: Vec<usize>,
}

impl Split {
    fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let widest =
            (1..sorted.len()).max_by(|a, b| (sorted[*a] - sorted[a - 1]).total_cmp(&(sorted[*b] - sorted[b - 1])))?;
        let (low, high) = ([sorted[0], sorted[widest - 1]], [sorted[widest], sorted[sorted.len() - 1]]);
        let passes = (1..values.len()).filter(|row| (values[*row] < high[0]) != (values[row - 1] < high[0]));
        let split = Self { low, high, passes: passes.collect() };
        // Numbers without a sign, in two ranges whose distance is wider than either.
        let is_apart = high[0] - low[1] > (low[1] - low[0]).max(high[1] - high[0]);
        (low[0] >= 0.0 && is_apart && split.passes.len() >= FEWEST_PASSES).then_some(split)
    }

    /// The values with their signs, where they go on across the offset.
    fn put_back(&self, values: &[f64], coding: Coding, offset: f64) -> Option<Vec<f64>> {
        let fits = match coding {
            Coding::SignAndMagnitude => self.low[1] < offset && offset <= self.high[0],
            Coding::TwosComplement => offset > self.high[1],
        };
        if !fits {
            return None;
        }
        let signed: Vec<f64> = values
            .iter()
            .map(|value| match coding {
                _ if *value < self.high[0] => *value,
                Coding::SignAndMagnitude => offset - value,
                Coding::TwosComplement => value - offset,
            })
            .collect();
        // The ranges have to meet: between them is no more room than either covers.
        let negative = signed.iter().copied().filter(|value| *value < 0.0);
        let [lowest, highest] = negative.fold([0.0_f64, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
        (self.low[0] - highest <= (self.low[1] - self.low[0]).max(highest - lowest)).then_some(signed)
    }
}
