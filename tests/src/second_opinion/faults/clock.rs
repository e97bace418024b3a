//! What a clock can do wrong. Nothing is missing from the model of these joints.

use crate::second_opinion::protocol::Protocol;
use crate::second_opinion::random::{Random, below};
use crate::second_opinion::recording::Material;
use crate::second_opinion::{Case, Part};

/// Fine steps of a sample.
const STEP: usize = 8;
/// Greatest jitter, fine steps.
const JITTER: i64 = 3;
/// Share of the rows that get lost.
const LOST: f64 = 0.05;
/// s.
const GAP_S: f64 = 5.0;
/// Rows that repeat the time of the one before.
const REPEATED: usize = 40;

/// One of each kind; only a wrong unit of time is to be named.
pub(super) fn cases(protocols: &'static [Protocol; 6]) -> Vec<Case> {
    let kinds = ["lost-rows", "gap", "jitter", "repeated-times", "unseen-jitter", "milliseconds"];
    let case = |(way, kind): (usize, &str)| {
        let expected = if way == 5 { vec!["unit_or_sign"] } else { Vec::new() };
        let make = move |random: &mut _| record(way, &protocols[way], random);
        let mut case = Case::new(format!("clock-{kind}"), Part::Clock, expected, make);
        // Whoever says that the clock is at fault is right.
        case.tolerated = vec!["unit_or_sign", "time_misalignment"];
        case
    };
    kinds.into_iter().enumerate().map(case).collect()
}

fn record(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let fine = protocol.oversampled(STEP, random);
    let last = fine.path.len() - 1;
    let regular: Vec<usize> = (0..=last).step_by(STEP).collect();
    let count = regular.len();
    let mut jittered = |i: &usize| {
        let by = below(random, 2 * JITTER as usize + 1) as i64 - JITTER;
        i.saturating_add_signed(by as isize).min(last)
    };
    let sampled: Vec<usize> =
        if matches!(way, 2 | 4) { regular.iter().map(&mut jittered).collect() } else { regular.clone() };
    let mut path = fine.path.at(&sampled);
    let mut kept: Vec<usize> = (0..count).collect();
    let note = match way {
        0 => {
            kept.retain(|_| random.unit() > LOST);
            "5 % of the rows lost"
        }
        1 => {
            let begin = (random.uniform(0.3, 0.5) * count as f64) as usize;
            let end = begin + (GAP_S * protocol.rate_hz) as usize;
            kept.retain(|i| !(begin..end).contains(i));
            "a gap of 5 s"
        }
        2 => "sampled up to 3/8 of a period early or late, at the times that are recorded",
        3 => {
            for _ in 0..REPEATED {
                let row = 5 + below(random, count - 10);
                path.time[row] = path.time[row - 1];
            }
            "40 rows repeat the time of the row before"
        }
        4 => {
            path.time = fine.path.at(&regular).time;
            "sampled up to 3/8 of a period early or late, recorded as regular"
        }
        _ => "time in ms under the name of s",
    };
    let torque = Protocol::torque(&fine.joint, &path);
    if way == 5 {
        path.time.iter_mut().for_each(|t| *t *= 1e3);
    }
    let torque = kept.iter().map(|i| torque[*i]).collect();
    protocol.material(&fine.joint, &path.at(&kept), torque, note, random)
}
