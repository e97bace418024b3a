//! Where a finding sits: evidence density along time and every channel, and the interval that holds most of it.

use crate::diagnose::answer::region::{Axis, Region, maximal_sum, regions};
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::proof::locked_rows::rest;
use crate::diagnose::proof::refit::Refit;
use crate::physics::EffectId;
use std::ops::Range;

/// Regions and times of one finding.
#[derive(Clone, Debug, Default)]
pub struct Location {
    /// Regions: first that which a sentence names, where one does, then the sharpest.
    pub regions: Vec<Region>,
    /// Whether the first region says where the effect sits.
    pub is_named: bool,
    /// Stretches of time in s that hold the most evidence.
    pub when_s: Vec<[f64; 2]>,
}

/// Locates one effect of a refit: the evidence that it adds to all the others.
pub(crate) fn locate(workbench: &Workbench, refit: &Refit, index: usize) -> Location {
    let runs = workbench.prepared.open_runs();
    let with = rest(workbench, refit);
    let effect = &refit.effects[index];
    let torque = workbench.torque_of(effect);
    let without: Vec<f64> = with.iter().zip(&torque).map(|(r, t)| r + t).collect();
    let [white_with, white_without] = [with, without].map(|rest| refit.noise.whitened(&rest, &runs));
    let rows: Vec<usize> = runs.iter().flat_map(Range::clone).collect();
    let density: Vec<f64> = rows.iter().map(|&i| 0.5 * (white_without[i].powi(2) - white_with[i].powi(2))).collect();
    let state = &workbench.prepared.state;
    let at_rows = |series: &[f64]| -> Vec<f64> { rows.iter().map(|&i| series[workbench.prepared.rows[i]]).collect() };
    let mut axes = vec![("velocity", at_rows(&state.velocity))];
    axes.extend(Channel::axes(state).into_iter().filter_map(|axis| Some((axis.name(), at_rows(&axis.series(state)?)))));
    let axes: Vec<Axis> = axes.iter().map(|(name, values)| (*name, values.as_slice())).collect();
    let mut location = locate_density(&axes, &at_rows(&state.time), &density);
    location.name_first(effect.label.effect());
    location
}

/// Channels along which an effect is a function, that of its equation first: where it sits is said of these alone. `None` of a structure
/// without a name, which may be one of any channel; empty of what acts in every row alike.
fn own_channels(effect: EffectId) -> Option<&'static [&'static str]> {
    use EffectId::*;
    let channels: &[&str] = match effect {
        Unknown => return None,
        FrictionLevel | Stribeck | ViscousNonlinearity | DirectionAsymmetry => &["velocity"],
        FrictionalLag => &["velocity", "acceleration"],
        Temperature => &["temperature"],
        WarmUp | SlowDrift | TransientEvent => &["time"],
        LoadFriction | DriveBackdrive | TorqueScale => &["load"],
        Presliding | Backlash | WindupHysteresis => &["distance_since_reversal", "time_since_reversal"],
        DwellBreakaway => &["dwell", "distance_since_reversal", "time_since_reversal"],
        PositionRipple | KinematicError | PositionFriction | GravityError | Spring | Contact | RecurrentFault => {
            &["position"]
        }
        InertiaError => &["acceleration"],
        Elasticity => &["acceleration", "load", "time_since_reversal"],
        Coupling => &["other_velocity", "other_position"],
        TorqueOffset | Saturation | TimeMisalignment | Quantisation | UnitOrSign => &[],
        // Their axis is the command, which is no channel.
        ActuatorGain | SupplyOrDutyLimit | CommandDelay | DeadBand => &[],
    };
    Some(channels)
}

/// The channel along which an effect is shown; `None` where there is none of its own.
pub(crate) fn own_axis(effect: EffectId) -> Option<&'static str> {
    own_channels(effect)?.first().copied()
}

impl Location {
    /// Puts first the sharpest region along the channel of the effect's equation, else along another of its own; where none says more than
    /// the rest, nothing is said.
    fn name_first(&mut self, effect: EffectId) {
        let is_own = |channel: &str| own_channels(effect).is_none_or(|own| own.contains(&channel));
        let is_of_equation = |channel: &str| own_axis(effect) == Some(channel);
        let sharpest = |is_meant: &dyn Fn(&str) -> bool| {
            self.regions.iter().position(|region| region.is_telling() && is_meant(region.side.channel))
        };
        let first = sharpest(&is_of_equation).or_else(|| sharpest(&is_own));
        self.is_named = first.is_some();
        if let Some(first) = first {
            self.regions[..=first].rotate_right(1);
        }
    }

    /// The region that a sentence names; `None` of what acts over the whole motion.
    #[must_use]
    pub fn named(&self) -> Option<&Region> {
        self.regions.first().filter(|_| self.is_named)
    }
}

/// Locates a density of evidence along time and along every axis.
pub(crate) fn locate_density(axes: &[Axis], time: &[f64], density: &[f64]) -> Location {
    Location { regions: regions(axes, density), is_named: false, when_s: when(time, density) }
}

/// Up to five stretches of time in which the evidence is densest.
fn when(time: &[f64], density: &[f64]) -> Vec<[f64; 2]> {
    let total: f64 = density.iter().sum();
    if total <= 0.0 || time.is_empty() {
        return Vec::new();
    }
    let mean = total / density.len() as f64;
    let width = (density.len() / 240).max(4);
    let mut sums: Vec<f64> = density.chunks(width).map(|c| c.iter().map(|d| d - 1.5 * mean).sum()).collect();
    let mut stretches = Vec::new();
    while stretches.len() < 5 {
        let best = maximal_sum(&sums);
        let gain: f64 = sums[best.clone()].iter().sum();
        if gain < 0.05 * total {
            break;
        }
        let end = (best.end * width).min(time.len()) - 1;
        stretches.push([time[best.start * width], time[end]]);
        sums[best].fill(f64::NEG_INFINITY);
    }
    stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::answer::region::Side;

    #[test]
    fn an_effect_is_placed_along_its_own_channel_or_nowhere() {
        let region = |channel, share_of_excess| {
            let side = Side { channel, from: 0.0, to: 1.0 };
            Region { side, and: None, share_of_excess, share_of_samples: 0.1 }
        };
        let named = |effect: EffectId, of_velocity: f64| {
            let regions = vec![region("time", 0.8), region("velocity", of_velocity), region("load", 0.6)];
            let mut location = Location { regions, ..Location::default() };
            location.name_first(effect);
            location.named().map(|region| region.side.channel)
        };
        assert_eq!(named(EffectId::SlowDrift, 0.7), Some("time"));
        assert_eq!(named(EffectId::Stribeck, 0.7), Some("velocity"));
        assert_eq!(named(EffectId::Stribeck, 0.2), None, "a region that tells nothing is passed over");
        assert_eq!(named(EffectId::PositionRipple, 0.7), None);
        assert_eq!(named(EffectId::Unknown, 0.7), Some("time"));
    }

    #[test]
    fn presliding_is_placed_along_the_distance_of_its_equation_where_that_tells() {
        let named = |of_distance: f64| {
            let region = |channel, share_of_excess| {
                let side = Side { channel, from: 0.0, to: 1.0 };
                Region { side, and: None, share_of_excess, share_of_samples: 0.1 }
            };
            let regions = vec![region("time_since_reversal", 0.9), region("distance_since_reversal", of_distance)];
            let mut location = Location { regions, ..Location::default() };
            location.name_first(EffectId::Presliding);
            location.named().map(|region| region.side.channel)
        };
        assert_eq!(named(0.6), Some("distance_since_reversal"));
        assert_eq!(named(0.2), Some("time_since_reversal"));
    }
}
