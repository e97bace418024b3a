//! Friction between knots that no row tells apart: it bends little there.

use crate::numerics::hat_functions::speed_knot;
use crate::numerics::statistics::quantile;
use std::ops::Range;

/// Deviation of a knot from the straight line between its neighbours that is expected beforehand, over Coulomb friction.
const EXPECTED_CURVATURE_SHARE: f64 = 0.1;

/// Expected bends of a curve over its knots, each a row beside those of a recording: known to be zero within [`EXPECTED_CURVATURE_SHARE`].
#[derive(Clone, Debug)]
pub(crate) struct CurvaturePrior {
    /// Weight of every knot in the bend at each inner one.
    rows: Vec<Vec<f64>>,
}

impl CurvaturePrior {
    /// CurvaturePrior of a curve over speed whose torque at the knots is about `torque`.
    pub fn of(torque: &[f64]) -> Self {
        let knots: Vec<f64> = (0..torque.len()).map(|j| speed_knot(j, torque.len())).collect();
        let size = quantile(torque.iter().map(|value| value.abs()), 0.5);
        let weight = 1.0 / (EXPECTED_CURVATURE_SHARE * size).max(f64::MIN_POSITIVE);
        let rows = (1..knots.len() - 1).map(|j| {
            let share = (knots[j] - knots[j - 1]) / (knots[j + 1] - knots[j - 1]);
            let mut row = vec![0.0; knots.len()];
            row[j - 1..=j + 1].copy_from_slice(&[-(1.0 - share) * weight, weight, -share * weight]);
            row
        });
        Self { rows: rows.collect() }
    }

    /// Puts the rows behind those of columns, of which the first are the knots', and of what they are fitted to; `noise` is the
    /// deviation of a row of these. Returns where they are.
    pub fn put_behind(&self, columns: &mut [Vec<f64>], target: &mut Vec<f64>, noise: f64) -> Range<usize> {
        for (place, column) in columns.iter_mut().enumerate() {
            column.extend(self.rows.iter().map(|row| noise * row.get(place).unwrap_or(&0.0)));
        }
        let begin = target.len();
        target.extend(vec![0.0; self.rows.len()]);
        begin..target.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::least_squares::least_squares;

    /// Coulomb friction of 2 N m over five knots, of which the rows see all but the second.
    #[test]
    fn a_knot_that_no_row_sees_lies_between_its_neighbours_and_one_that_is_seen_stays() {
        let torque = [2.0, 2.0, 2.0, 2.6, 2.0];
        let hat = |seen: usize| (0..5).map(|row| f64::from(row == seen && seen != 1)).collect::<Vec<f64>>();
        let (mut columns, mut target): (Vec<Vec<f64>>, Vec<f64>) = ((0..5).map(hat).collect(), torque.to_vec());
        target[1] = 0.0;
        let rows = CurvaturePrior::of(&torque).put_behind(&mut columns, &mut target, 1e-3);
        let fitted = least_squares(&columns, &target, &[0..5, rows]).unwrap();
        assert!((fitted[1] - 2.0).abs() < 0.2 && (fitted[3] - 2.6).abs() < 1e-3, "{fitted:?}");
    }

    #[test]
    fn a_straight_line_over_speed_does_not_bend() {
        let line: Vec<f64> = (0..9).map(|j| 1.0 + 3.0 * speed_knot(j, 9)).collect();
        for row in CurvaturePrior::of(&line).rows {
            let bend: f64 = row.iter().zip(&line).map(|(weight, torque)| weight * torque).sum();
            assert!(bend.abs() < 1e-9, "{bend}");
        }
    }
}
