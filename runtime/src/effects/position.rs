//! Terms of the position: ripple, table, spring.

use frikan_shared::effect::Effect;
use frikan_shared::elementary::{cos, sin};
use frikan_shared::pool::Pool;

use super::{Contribution, Motion};
use crate::laws::table::evaluate_table;

/// What a position term adds; nothing for any other effect.
#[must_use]
#[inline(never)]
pub fn contribution<const CELLS: usize>(effect: &Effect, motion: &Motion, pool: &Pool<CELLS>) -> Contribution {
    match effect {
        Effect::Ripple { kind, smoothing_velocity, harmonics } => {
            let sum = harmonics.iter().fold(0.0, |sum, line| {
                let angle = line.order * motion.angle;
                sum + (line.cosine * cos(angle) + line.sine * sin(angle))
            });
            Contribution::of_kind(*kind, sum, motion.smooth_sign(*smoothing_velocity))
        }
        Effect::PositionTable { kind, smoothing_velocity, table } => {
            let value = evaluate_table(table, pool, motion.position);
            Contribution::of_kind(*kind, value, motion.smooth_sign(*smoothing_velocity))
        }
        Effect::Spring { stiffness, rest } => Contribution::torque(stiffness * (motion.position - rest)),
        _ => Contribution::default(),
    }
}
