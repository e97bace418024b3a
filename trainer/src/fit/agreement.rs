//! How a prediction agrees with a measurement, as sums that are added from recording to recording.

/// Sums of which a score is made: those of several recordings make that of all.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Agreement {
    pub(super) n: usize,
    /// Mean of what was measured, and its squares around that.
    pub(super) mean: f64,
    pub(super) spread: f64,
    /// Squares of what was measured, and of what the prediction leaves of it.
    pub(super) power: f64,
    pub(super) residual: f64,
}

impl Agreement {
    /// Of some rows.
    pub(super) fn of(
        rows: impl Iterator<Item = usize> + Clone,
        measured: impl Fn(usize) -> f64,
        predicted: impl Fn(usize) -> f64,
    ) -> Self {
        let n = rows.clone().count();
        let sum = |value: &dyn Fn(usize) -> f64| rows.clone().map(value).sum::<f64>();
        let mean = sum(&measured) / n.max(1) as f64;
        Self {
            n,
            mean,
            spread: sum(&|row| (measured(row) - mean).powi(2)),
            power: sum(&|row| measured(row) * measured(row)),
            residual: sum(&|row| (measured(row) - predicted(row)).powi(2)),
        }
    }

    /// Of two parts together (Chan, Golub and LeVeque 1983).
    pub(super) fn with(self, other: &Self) -> Self {
        let n = self.n + other.n;
        if self.n == 0 || other.n == 0 {
            return if self.n == 0 { *other } else { self };
        }
        let (apart, share) = (other.mean - self.mean, other.n as f64 / n as f64);
        Self {
            n,
            mean: self.mean + share * apart,
            spread: self.spread + other.spread + apart * apart * share * self.n as f64,
            power: self.power + other.power,
            residual: self.residual + other.residual,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ops::Range;

    #[test]
    fn parts_make_the_sums_of_the_whole() {
        let measured: Vec<f64> = (0..500).map(|i| 3.0 + (0.1 * f64::from(i)).sin() * f64::from(i)).collect();
        let predicted: Vec<f64> = measured.iter().map(|value| 0.9 * value).collect();
        let of = |rows: Range<usize>| Agreement::of(rows, |row| measured[row], |row| predicted[row]);
        let [whole, parts] = [of(0..500), of(0..0).with(&of(0..120)).with(&of(120..500))];
        assert_eq!(whole.n, parts.n);
        let sums = |of: &Agreement| [of.mean, of.spread, of.power, of.residual];
        for (whole, parts) in sums(&whole).into_iter().zip(sums(&parts)) {
            assert!((whole - parts).abs() < 1e-12 * whole.abs(), "{whole} {parts}");
        }
    }
}
