//! Which law goes into the image: the simplest, unless locked rows prefer another by more than their error.

use crate::error::Result;
use crate::fit::data::gather::Material;
use crate::fit::filtered::predict_filtered;
use crate::fit::model::HostModel;
use crate::numerics::regression::least_squares;
use crate::numerics::statistics::{NORMAL_95, mean};
use crate::samples::blocks::Split;

/// Blocks from which on their scatter is an error to go by.
const LEAST_BLOCKS: usize = 3;
/// With fewer blocks the mean square has to fall by this share instead.
const CLEAR_SHARE: f64 = 0.1;
/// A law that breaks physics has to be better by this many times the error that another needs.
const WANTED: f64 = 2.0;

/// Squared errors of one candidate on the rows that it is judged by, with their blocks: on the torque as filtered, by which candidates are compared,
/// and as recorded, which is what is told. A controller answers the noise of its encoder, so that the recorded torque goes with the noise of
/// the velocity that a law is evaluated at.
#[derive(Clone, Debug, Default)]
pub(in crate::fit) struct Trial {
    filtered: Vec<f64>,
    recorded: Vec<f64>,
    labels: Vec<usize>,
}

impl Trial {
    /// Adds a model that was fitted without the locked blocks of `split`; where none is locked, all rows count.
    pub(in crate::fit) fn add(&mut self, model: &HostModel, material: &Material, split: &Split) -> Result<()> {
        self.add_predicted(&predict_filtered(model, material)?, material, split);
        Ok(())
    }

    /// Adds what was predicted of the filtered torque at every sample without the locked blocks of `split`.
    pub(in crate::fit) fn add_predicted(&mut self, predicted: &[f64], material: &Material, split: &Split) {
        let samples = &material.samples;
        let recorded = samples.recorded.as_deref().unwrap_or_default();
        let filtered = samples.friction.as_deref().or(samples.actuator.as_deref()).unwrap_or_default();
        let locked: Vec<usize> = split.locked.iter().cloned().flatten().collect();
        let judged = if locked.is_empty() { (0..material.rows.len()).collect() } else { locked };
        for position in judged {
            let row = material.rows[position];
            self.filtered.push((filtered[row] - predicted[row]).powi(2));
            self.recorded.push((recorded[row] - predicted[row]).powi(2));
            self.labels.push(material.labels[position]);
        }
    }

    /// Whether `other` leaves less of the filtered torque, with 97.5 %.
    pub(in crate::fit) fn is_clearly_beaten_by(&self, other: &Self) -> bool {
        let gain = self.gain_of(other);
        gain.mean > NORMAL_95 * gain.error
    }

    /// Whether `other` leaves a smaller share of the filtered torque that is left here, with 97.5 %, every block counted as much: one that moves with ten
    /// times the torque of the others does not decide alone, and its scatter hides nothing.
    pub(in crate::fit) fn is_clearly_beaten_in_blocks_by(&self, other: &Self) -> bool {
        let gain = Gain::of_logarithms(&self.labels, &self.filtered, &other.filtered);
        gain.mean > NORMAL_95 * gain.error
    }

    /// On the torque as recorded.
    pub(in crate::fit) fn mean_square(&self) -> f64 {
        mean(&self.recorded)
    }

    /// On the torque as recorded.
    pub(in crate::fit) fn rmse(&self) -> f64 {
        self.mean_square().sqrt()
    }

    /// By how much `other` has the smaller mean square as filtered.
    fn gain_of(&self, other: &Self) -> Gain {
        Gain::of(&self.labels, &self.filtered, &other.filtered)
    }
}

/// A difference of mean squares over blocks.
struct Gain {
    mean: f64,
    /// Standard error over blocks; with too few of them a share of the mean square.
    error: f64,
}

impl Gain {
    /// By how much `rival` is smaller than `own`, of a ratio of sums over blocks of unequal size (Cochran 1977).
    fn of(labels: &[usize], own: &[f64], rival: &[f64]) -> Self {
        let count = own.len().max(1) as f64;
        let blocks = block_sums(labels, own, rival);
        let gain = blocks.iter().map(|[own, rival, _]| own - rival).sum::<f64>() / count;
        if blocks.len() < LEAST_BLOCKS {
            return Self { mean: gain, error: CLEAR_SHARE * mean(own) };
        }
        let scatter: f64 = blocks.iter().map(|[own, rival, rows]| (own - rival - gain * rows).powi(2)).sum();
        let inflation = blocks.len() as f64 / (blocks.len() - 1) as f64;
        Self { mean: gain, error: (inflation * scatter).sqrt() / count }
    }

    /// By how much the logarithm of the sum of `rival` in a block is smaller than that of `own`.
    fn of_logarithms(labels: &[usize], own: &[f64], rival: &[f64]) -> Self {
        let ratio = |[own, rival, _]: [f64; 3]| (own.max(f64::MIN_POSITIVE) / rival.max(f64::MIN_POSITIVE)).ln();
        let ratios: Vec<f64> = block_sums(labels, own, rival).into_iter().map(ratio).collect();
        let gain = mean(&ratios);
        if ratios.len() < LEAST_BLOCKS {
            return Self { mean: gain, error: CLEAR_SHARE };
        }
        let scatter: f64 = ratios.iter().map(|ratio| (ratio - gain).powi(2)).sum();
        let blocks = ratios.len() as f64;
        Self { mean: gain, error: (scatter / (blocks * (blocks - 1.0))).sqrt() }
    }
}

/// Sums of `own` and `rival` over each block, and its rows.
fn block_sums(labels: &[usize], own: &[f64], rival: &[f64]) -> Vec<[f64; 3]> {
    let mut blocks: Vec<(usize, [f64; 3])> = Vec::new();
    for ((label, own), rival) in labels.iter().zip(own).zip(rival) {
        if blocks.last().is_none_or(|(last, _)| last != label) {
            blocks.push((*label, [0.0; 3]));
        }
        if let Some((_, sums)) = blocks.last_mut() {
            sums.iter_mut().zip([*own, *rival, 1.0]).for_each(|(sum, value)| *sum += value);
        }
    }
    blocks.into_iter().map(|(_, sums)| sums).collect()
}

/// What is known of a candidate when it is judged.
pub(in crate::fit) struct Entry<'a> {
    pub(in crate::fit) trial: &'a Trial,
    /// Constants that it was given freedom by.
    pub(in crate::fit) constants: usize,
    pub(in crate::fit) breaks_physics: bool,
}

/// How two candidates are compared.
pub(in crate::fit) enum Judge {
    /// On rows that neither saw.
    Locked,
    /// On the rows that they were fitted to, of which so many are independent: constants are paid for (Schwarz 1978).
    Penalty { effective: f64 },
}

impl Judge {
    /// Whether `other` is better than `held` by more than the error of the comparison: one standard error (Breiman, Friedman, Olshen and
    /// Stone 1984), since of two laws that are as good the choice costs nothing.
    pub(in crate::fit) fn prefers(&self, other: &Entry<'_>, held: &Entry<'_>) -> bool {
        let factor = if other.breaks_physics && !held.breaks_physics { WANTED } else { 1.0 };
        match self {
            Self::Locked => {
                let gain = held.trial.gain_of(other.trial);
                gain.mean > factor * gain.error
            }
            Self::Penalty { effective } => {
                let gain =
                    effective * (held.trial.mean_square() / other.trial.mean_square().max(f64::MIN_POSITIVE)).ln();
                gain > factor * effective.ln() * (other.constants as f64 - held.constants as f64).max(1.0)
            }
        }
    }

    /// The candidate that is left when each has to be preferred to the one before it: those that keep to physics first, in
    /// their order, then those that break it.
    pub(in crate::fit) fn choose(&self, entries: &[Option<Entry<'_>>]) -> Option<usize> {
        let mut order: Vec<usize> = (0..entries.len()).filter(|&index| entries[index].is_some()).collect();
        order.sort_by_key(|&index| entries[index].as_ref().is_some_and(|entry| entry.breaks_physics));
        order.into_iter().reduce(|held, index| match (&entries[index], &entries[held]) {
            (Some(entry), Some(before)) if self.prefers(entry, before) => index,
            _ => held,
        })
    }
}

/// Rows that count as independent: those that show something new (a share of all), over the correlation length of what a linear
/// fit leaves.
pub(in crate::fit) fn effective_rows(material: &Material, new_share: f64) -> f64 {
    let mut columns: Vec<Vec<f64>> = material.columns.iter().map(|column| material.pick(&column.values)).collect();
    let velocity = material.pick(material.samples.velocity.as_deref().unwrap_or_default());
    columns.push(velocity.iter().map(|v| v.signum()).collect());
    columns.push(velocity);
    let whole: Vec<_> = std::iter::once(0..material.rows.len()).collect();
    let fit = least_squares(&columns, &material.target_at_velocity(), &whole);
    let length = crate::samples::blocks::correlation_time(&fit.residuals, &whole);
    (new_share * material.rows.len() as f64 / length as f64).max(std::f64::consts::E)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(mean: f64, scatter: f64) -> Trial {
        let square = |i: usize| mean + scatter * ((i / 10) as f64 * 2.4).sin();
        let squares: Vec<f64> = (0..100).map(square).collect();
        Trial { filtered: squares.clone(), recorded: squares, labels: (0..100).map(|i| i / 10).collect() }
    }

    fn entry(trial: &Trial, breaks_physics: bool) -> Entry<'_> {
        Entry { trial, constants: 3, breaks_physics }
    }

    #[test]
    fn a_gain_within_its_error_changes_nothing() {
        let (simple, other) = (trial(1.0, 0.0), trial(0.9, 0.5));
        assert!(!Judge::Locked.prefers(&entry(&other, false), &entry(&simple, false)));
        let clear = trial(0.9, 0.05);
        assert!(Judge::Locked.prefers(&entry(&clear, false), &entry(&simple, false)));
        let entries = [Some(entry(&simple, false)), Some(entry(&other, false)), None, Some(entry(&clear, false))];
        assert_eq!(Judge::Locked.choose(&entries), Some(3));
    }

    #[test]
    fn what_breaks_physics_has_to_be_wanted_clearly() {
        let (simple, other) = (trial(1.0, 0.0), trial(0.9, 0.3));
        assert!(Judge::Locked.prefers(&entry(&other, false), &entry(&simple, false)));
        assert!(!Judge::Locked.prefers(&entry(&other, true), &entry(&simple, false)));
        assert!(Judge::Locked.prefers(&entry(&other, true), &entry(&simple, true)));
    }

    #[test]
    fn under_a_penalty_constants_are_paid_for() {
        let judge = Judge::Penalty { effective: 100.0 };
        let (simple, other) = (trial(1.0, 0.0), trial(0.9, 0.0));
        let rich = Entry { trial: &other, constants: 30, breaks_physics: false };
        assert!(!judge.prefers(&rich, &entry(&simple, false)));
        assert!(judge.prefers(&entry(&other, false), &entry(&simple, false)));
    }
}
