//! A torque whose sign was turned for a while: one law describes all of it once that stretch is turned back.

use crate::checks::law::{Law, moving};
use crate::checks::motion::{smooth, top_speed, torque};
use crate::checks::note::{Fault, Note};
use crate::checks::rows::{others, stretches};
use crate::numerics::products::{dot, norm};
use crate::numerics::statistics::mean;
use crate::recording::{Omission, Quantity, Recording};
use crate::samples::VelocitySource;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Pieces of which the stretch is made at most, and least length of one, s.
const MOST_PIECES: usize = 240;
const SHORTEST_PIECE_S: f64 = 0.2;
/// Fewest pieces of a stretch.
const FEWEST_PIECES: usize = 5;
/// Mean square of what the law leaves of the stretch turned back over what it leaves of the rest, at most; and of the stretch as recorded
/// over both, at least.
const AS_THE_REST: f64 = 4.0;
const CLEARLY_WORSE: f64 = 16.0;
/// Share of the torque's energy that the law may leave then: of a torque that it does not describe it tells no sign.
const MOST_LEFT: f64 = 0.3;
/// Share of the torque's energy below which nothing that the law leaves can be a turned stretch of any length.
const UNSUSPICIOUS: f64 = 0.005;
/// Share of the recording beyond which the rest would be the stretch.
const MOST_OF_ALL: f64 = 0.5;

/// The recording without the rows whose torque is turned.
pub(in crate::checks) fn without_turned_torque(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    let time = recording.values(Quantity::Time)?;
    let [from, to] = turned_stretch(recording)?;
    let rows: Vec<usize> = (0..time.len()).filter(|row| (from..=to).contains(&time[*row])).collect();
    let mended = recording.clone().with_rows(&others(recording.len(), &rows), Omission::Interrupted);
    let note = Note { fault: Fault::TurnedTorque { rows: rows.len() }, when_s: stretches(recording, &rows) };
    Some((Some(mended), note))
}

/// The stretch of time that has to be turned back, if there is one.
fn turned_stretch(recording: &Recording) -> Option<[f64; 2]> {
    let samples = smooth(recording, VelocitySource::Derived)?;
    let Law { columns, fit, .. } = Law::of(&samples)?;
    let torque = torque(&samples)?;
    let velocity = samples.velocity.as_deref()?;
    let moving = moving(velocity, top_speed(velocity));
    // Samples at rest count as nothing.
    let of_moving = |series: &[f64]| {
        let mut masked = vec![0.0; series.len()];
        moving.iter().for_each(|row| masked[*row] = series[*row]);
        masked
    };
    let torque = of_moving(torque);
    let columns: Vec<Vec<f64>> = columns.values.iter().map(|column| of_moving(column)).collect();
    let energy = dot(&torque, &torque);
    if fit.rmse.powi(2) * moving.len() as f64 <= UNSUSPICIOUS * energy {
        return None;
    }
    let span = samples.time.last()? - samples.time.first()?;
    let count = MOST_PIECES.min((span / SHORTEST_PIECE_S) as usize).min(samples.len());
    let pieces: Vec<Range<usize>> =
        (0..count).map(|piece| piece * samples.len() / count..(piece + 1) * samples.len() / count).collect();
    // Turning rows leaves the Gram matrix as it is and turns their share of the moments: every stretch costs one product.
    let width = columns.len();
    let scale: Vec<f64> = columns.iter().map(|column| norm(column).max(f64::MIN_POSITIVE)).collect();
    let gram = DMatrix::from_fn(width, width, |i, j| dot(&columns[i], &columns[j]) / (scale[i] * scale[j]));
    let inverse = gram.pseudo_inverse(1e-9).ok()?;
    let moment = |rows: &Range<usize>| {
        DVector::from_fn(width, |i, _| dot(&columns[i][rows.clone()], &torque[rows.clone()]) / scale[i])
    };
    let moments: Vec<DVector<f64>> = pieces.iter().map(moment).collect();
    let mut sums = vec![DVector::zeros(width)];
    for moment in &moments {
        sums.push(&sums[sums.len() - 1] + moment);
    }
    let left = |from: usize, to: usize| {
        let turned = &sums[count] - 2.0 * (&sums[to] - &sums[from]);
        energy - (turned.transpose() * &inverse * &turned)[(0, 0)]
    };
    let longest = (MOST_OF_ALL * count as f64) as usize;
    let stretches =
        (0..count).flat_map(|from| (from + FEWEST_PIECES..=(from + longest).min(count)).map(move |to| (from, to)));
    let (from, to) = stretches.min_by(|a, b| left(a.0, a.1).total_cmp(&left(b.0, b.1)))?;
    // What the law of that stretch turned back leaves, per sample in motion, of the stretch as recorded and turned, and of the rest.
    let scaled = &inverse * (&sums[count] - 2.0 * (&sums[to] - &sums[from]));
    let law = |row: usize| (0..width).map(|i| scaled[i] / scale[i] * columns[i][row]).sum::<f64>();
    // The sign may have changed within the first and the last piece, or just before and after them.
    let stretch = pieces[from + 1].start..pieces[to - 2].end;
    let (first, last) = (pieces[from.saturating_sub(1)].start, pieces[to.min(count - 1)].end - 1);
    let inside: Vec<usize> = moving.iter().copied().filter(|row| stretch.contains(row)).collect();
    let outside: Vec<usize> = moving.iter().copied().filter(|row| !(first..=last).contains(row)).collect();
    let left_of = |rows: &[usize], sign: f64| {
        mean(&rows.iter().map(|row| (sign * torque[*row] - law(*row)).powi(2)).collect::<Vec<_>>())
    };
    let (recorded, turned, rest) = (left_of(&inside, 1.0), left_of(&inside, -1.0), left_of(&outside, 1.0));
    let is_turned = left(from, to) < MOST_LEFT * energy
        && turned < AS_THE_REST * rest
        && recorded > CLEARLY_WORSE * rest.max(turned);
    is_turned.then(|| [samples.time[first], samples.time[last]])
}
