//! Of a long recording, the stretches that are searched.
//!
//! The search holds every hypothesis at every working row, so that its memory and its time grow with the recording; what it can tell hardly
//! does. An effect whose torque is a share s of the noise (root mean squares, both whitened) gains s^2 / 2 nats a row: with [`MOST_ROWS`] of them
//! one of a twenty-seventh of the noise gains the twenty nats by which it is told from chance among a thousand shapes, and four times as many
//! rows would only halve that. So a longer recording is sampled: whole stretches, since a row says nothing without those before it, one in each of as
//! many equal parts of the recording (stratified sampling; Cochran 1977), each at another place of its part, so that they do not keep step with a
//! motion that comes back (multiples of the golden section; Weyl 1916). What happens once beside them is not seen.

use crate::diagnose::preparation::cut_off::widest_cut_off_hz;
use crate::diagnose::preparation::rows::ROWS_PER_CUT_OFF;
use crate::recording::Recording;
use std::ops::Range;

/// Most working rows that are searched: see above. Some 8 kB of candidates each.
const MOST_ROWS: f64 = 30_000.0;
/// Most samples between them, of which the states are worked out: some 400 B each.
const MOST_SAMPLES: f64 = 500_000.0;
/// Stretches of all recordings together: twice as many as the blocks of a recording in one piece, so that scatter from stretch to stretch is as
/// well known as that from block to block.
const STRETCHES: f64 = 24.0;
/// Fractional part of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// What is searched of recordings of one joint; `None` where it is all of them. `room` is what there is of the memory (0 to 1) that the most rows
/// and samples take.
#[must_use]
pub(crate) fn searched(recordings: &[Recording], room: f64) -> Option<Vec<Recording>> {
    let rows: f64 = recordings.iter().map(working_rows).sum();
    let samples: f64 = recordings.iter().map(|recording| recording.len() as f64).sum();
    let share = room.min(1.0) * (MOST_ROWS / rows).min(MOST_SAMPLES / samples);
    if rows.is_nan() || share >= 1.0 {
        return None;
    }
    let excerpt = |recording: &Recording| {
        let of_all = recording.len() as f64 / samples;
        let kept = stretches(recording.len(), share, (STRETCHES * of_all).round() as usize);
        recording.excerpt(&kept)
    };
    Some(recordings.iter().map(excerpt).collect())
}

/// Working rows of a recording at most.
fn working_rows(recording: &Recording) -> f64 {
    let seconds = recording.health.period_s.map_or(0.0, |period_s| period_s * recording.len() as f64);
    let widest_hz = recording.health.period_s.map_or(0.0, |period_s| widest_cut_off_hz(1.0 / period_s));
    ROWS_PER_CUT_OFF * widest_hz * seconds
}

/// Stretches of `rows` that make up a share of them, in order: the first begins them, the last ends them.
fn stretches(rows: usize, share: f64, count: usize) -> Vec<Range<usize>> {
    let count = count.max(2);
    let part = rows as f64 / count as f64;
    let length = (share * part) as usize;
    let place = |index: usize| match index {
        0 => 0,
        _ if index + 1 == count => rows - length,
        _ => (index as f64 * part + (GOLDEN * index as f64).fract() * (1.0 - share) * part) as usize,
    };
    (0..count).map(|index| place(index)..place(index) + length).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;
    use crate::joint::Joint;
    use crate::physics::{EffectId, catalogue};
    use crate::recording::{Quantity, parse};

    /// So many rows of a swing, `rate_hz` of them a second.
    fn swing(rows: usize, rate_hz: f64) -> Recording {
        let row = |i: usize| format!("{},{},1\n", i as f64 / rate_hz, (i % 1000) as f64 * 1e-3);
        let text = format!("time_s,position_rad,torque_Nm\n{}", (0..rows).map(row).collect::<String>());
        parse("swing.csv", text.as_bytes(), &Joint::default()).unwrap()
    }

    #[test]
    fn what_is_searched_is_bounded_and_spread_and_a_short_recording_stays_whole() {
        assert!(searched(&[swing(60_000, 250.0)], 1.0).is_none());
        for rate_hz in [1000.0, 4000.0] {
            let sizes = [600_000, 900_000].map(|rows| {
                let recording = swing(rows, rate_hz);
                let found = searched(std::slice::from_ref(&recording), 1.0).unwrap().swap_remove(0);
                let time = |recording: &Recording| recording.values(Quantity::Time).unwrap().to_vec();
                let (all, kept) = (time(&recording), time(&found));
                assert_eq!((kept[0], kept[kept.len() - 1]), (all[0], all[all.len() - 1]));
                assert_eq!(found.health.gaps.len() + 1, STRETCHES as usize);
                // No tenth of the recording is left out.
                let tenth = all[all.len() - 1] / 10.0;
                assert!(kept.windows(2).all(|pair| pair[1] - pair[0] < tenth));
                (working_rows(&found), kept.len() as f64)
            });
            for (rows, samples) in sizes {
                assert!(rows <= MOST_ROWS && samples <= MOST_SAMPLES, "{rows} {samples}");
                assert!(rows > 0.99 * MOST_ROWS || samples > 0.99 * MOST_SAMPLES, "{rows} {samples}");
            }
        }
        let half = searched(&[swing(300_000, 1000.0)], 0.5).unwrap();
        assert!((0.49..=0.5).contains(&(working_rows(&half[0]) / MOST_ROWS)));
        let several = searched(&[swing(200_000, 1000.0), swing(100_000, 1000.0)], 1.0).unwrap();
        assert!(several.iter().map(working_rows).sum::<f64>() <= MOST_ROWS);
        assert_eq!(several.iter().map(|recording| recording.health.gaps.len() + 1).collect::<Vec<_>>(), [16, 8]);
    }

    #[test]
    fn a_joint_warms_up_in_an_excerpt_as_in_the_whole() {
        let time: Vec<f64> = (0..60_000).map(|i| 0.01 * f64::from(i)).collect();
        let position: Vec<f64> = time.iter().map(|t| (1.3 * t).sin()).collect();
        let torque: Vec<f64> = time.iter().map(|t| (1.3 * t).cos()).collect();
        let whole = Signals::without_gap(0.01, time, position, torque);
        let kept = stretches(whole.time.len(), 0.3, 12);
        let of =
            |series: &[f64]| kept.iter().flat_map(|stretch| &series[stretch.clone()]).copied().collect::<Vec<f64>>();
        let length = kept[0].len();
        let excerpt = Signals {
            segments: (0..kept.len()).map(|index| index * length..(index + 1) * length).collect(),
            is_excerpt: true,
            ..Signals::without_gap(0.01, of(&whole.time), of(&whole.position), of(&whole.torque))
        };
        let warmth = |signals: &Signals| {
            let mut state = signals.states();
            state.base_friction = vec![(-2.0, -1.0), (2.0, 1.0)];
            let warm_up = catalogue().into_iter().find(|effect| effect.id() == EffectId::WarmUp).unwrap();
            let column = warm_up.columns(&state, &[60.0, 1.0]).swap_remove(0);
            column.iter().zip(&state.velocity).map(|(column, velocity)| column / velocity).collect::<Vec<f64>>()
        };
        let (all, found) = (of(&warmth(&whole)), warmth(&excerpt));
        let usual = all[all.len() - 1];
        assert!(all.iter().zip(&found).all(|(all, found)| (all - found).abs() < 0.05 * usual));
    }

    #[test]
    fn stretches_do_not_overlap() {
        for (rows, share, count) in [(100, 0.9, 7), (1_000_000, 0.24, 24), (77, 0.3, 0)] {
            let found = stretches(rows, share, count);
            assert!(found.windows(2).all(|pair| pair[0].end <= pair[1].start), "{found:?}");
            assert_eq!((found[0].start, found[found.len() - 1].end), (0, rows));
        }
    }
}
