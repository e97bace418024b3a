//! Measurement before physics: what is wrong with the recording itself.

use super::filter::{ZeroPhase, first_derivative, second_derivative};
use super::linear::{least_squares, residual};
use super::signals::Signals;
use crate::physics::EffectId;
use serde::Serialize;

/// A note on the measurement chain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HealthNote {
    /// The effect of the catalogue it stands for.
    pub effect: EffectId,
    /// Whether a diagnosis of physics makes no sense before it is repaired.
    pub blocking: bool,
    /// One sentence with figures.
    pub sentence: String,
}

/// Share of samples at one extreme torque from which it counts as clipped.
const CLIPPED_SHARE: f64 = 0.02;
/// Factors that a wrong unit leaves: degrees for radians, turns for radians, milli for whole, and their inverses.
const UNIT_FACTORS: [(f64, &str); 6] = [
    (57.295_78, "deg taken for rad"),
    (6.283_185, "turns taken for rad"),
    (1000.0, "milli-units taken for units"),
    (0.017_453_29, "rad taken for deg"),
    (0.159_154_9, "rad taken for turns"),
    (0.001, "units taken for milli-units"),
];

/// Looks at the signals alone.
pub fn examine(signals: &Signals) -> Vec<HealthNote> {
    let mut notes = Vec::new();
    notes.extend(clipped_torque(signals));
    notes.extend(wrong_sign_or_unit(signals));
    notes
}

fn clipped_torque(signals: &Signals) -> Option<HealthNote> {
    let top = signals.torque.iter().fold(0.0f64, |m, t| m.max(t.abs()));
    let at_top = signals.torque.iter().filter(|t| t.abs() >= top * (1.0 - 1e-6)).count();
    let share = at_top as f64 / signals.torque.len().max(1) as f64;
    (top > 0.0 && share > CLIPPED_SHARE).then(|| HealthNote {
        effect: EffectId::Saturation,
        blocking: false,
        sentence: format!("the torque stands at its limit of {top:.4} in {:.1} % of the samples", 100.0 * share),
    })
}

/// Fits scale x rigid body (or inertia) with Coulomb, viscous and offset: friction that drives the joint, a negative
/// inertia or a scale near a unit's factor betray a wrong sign or unit.
fn wrong_sign_or_unit(signals: &Signals) -> Option<HealthNote> {
    if signals.velocity.is_some() || signals.period <= 0.0 {
        return None;
    }
    let cut_off = (0.05 / signals.period).min(15.0);
    let filter = ZeroPhase::new(cut_off, signals.period);
    let segments = &signals.segments;
    let position = filter.over(&signals.position, segments);
    let velocity = first_derivative(&position, segments, signals.period);
    let acceleration = second_derivative(&position, segments, signals.period);
    let top = velocity.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    if top <= 0.0 {
        return None;
    }
    let sign: Vec<f64> = velocity.iter().map(|v| (v / (0.02 * top)).tanh()).collect();
    let torque = filter.over(&signals.torque, segments);
    let runs: Vec<_> = segments
        .iter()
        .map(|s| (s.start + filter.reach()).min(s.end)..s.end.saturating_sub(filter.reach()).max(s.start))
        .filter(|r| r.start < r.end)
        .collect();
    let rigid = signals.reference_torque.as_ref().or(signals.rigid_body.as_ref());
    let given = rigid.is_some();
    let main = rigid.map_or(acceleration, |torque| filter.over(torque, segments));
    let columns = vec![main, sign, velocity, vec![1.0; position.len()]];
    let coefficients = least_squares(&columns, &torque, &runs)?;
    let rest = residual(&columns, &torque, &coefficients);
    let energy = |series: &[f64]| runs.iter().flat_map(|r| &series[r.clone()]).map(|v| v * v).sum::<f64>();
    let rows: usize = runs.iter().map(|r| r.len()).sum();
    let explains = 1.0 - energy(&rest) / energy(&torque).max(f64::MIN_POSITIVE);
    let power_share =
        coefficients[0].abs() * (energy(&columns[0]) / rows as f64).sqrt() / (energy(&torque) / rows as f64).sqrt();
    if explains < 0.5 {
        return None;
    }
    let friction_drives =
        coefficients[1] < 0.0 && coefficients[1].abs() * (energy(&columns[1]) / energy(&torque)).sqrt() > 0.1;
    let flipped = coefficients[0] < 0.0 && power_share > 0.3;
    if flipped && friction_drives {
        return Some(HealthNote {
            effect: EffectId::UnitOrSign,
            blocking: true,
            sentence: "torque and motion have opposite signs: both the rigid body and the friction come out negative"
                .into(),
        });
    }
    if flipped && given {
        return Some(HealthNote {
            effect: EffectId::UnitOrSign,
            blocking: true,
            sentence: format!(
                "the given rigid-body torque enters with factor {:.3}: its sign is opposite to the recording's",
                coefficients[0]
            ),
        });
    }
    if given && power_share > 0.3 {
        for (factor, story) in UNIT_FACTORS {
            let ratio = coefficients[0] / factor;
            if (0.8..1.25).contains(&ratio) {
                return Some(HealthNote {
                    effect: EffectId::UnitOrSign,
                    blocking: true,
                    sentence: format!(
                        "the given rigid-body torque enters with factor {:.4}, as with {story}",
                        coefficients[0]
                    ),
                });
            }
        }
    }
    None
}
