//! How sure a finding is, and what else it may be, in plain words.

use crate::diagnose::answer::outcome::Finding;
use crate::physics::names::plain_name;

/// The probability, the alternatives, and of a structure without a name its channels and the effect that comes nearest.
pub(crate) fn certainty(found: &Finding) -> String {
    let mut sentences = vec![probability(found)];
    sentences.extend(channels(found));
    sentences.extend(nearest(found));
    sentences.join(" ")
}

fn probability(found: &Finding) -> String {
    let sure = format!("Probability {:.0} %", 100.0 * found.probability);
    let others: Vec<String> = found
        .alternatives
        .iter()
        .map(|(effect, probability)| format!("{} ({})", plain_name(*effect), percent(*probability)))
        .collect();
    if others.is_empty() {
        format!("{sure}.")
    } else {
        format!("{sure}; this recording cannot rule out {}.", others.join(" or "))
    }
}

fn channels(found: &Finding) -> Option<String> {
    let (first, rest) = found.channels.split_first()?;
    let rest: Vec<&str> = rest.iter().map(|channel| channel.plain_name()).collect();
    (!rest.is_empty()).then(|| format!("It may depend on {} instead of {}.", rest.join(" or "), first.plain_name()))
}

fn nearest(found: &Finding) -> Option<String> {
    let (effect, share) = found.nearest?;
    let is_told = found.alternatives.iter().any(|(alternative, _)| *alternative == effect);
    (!is_told).then(|| {
        format!("The closest named effect, {}, explains {} of its energy.", plain_name(effect), percent(share))
    })
}

fn percent(share: f64) -> String {
    if share < 0.01 { "below 1 %".to_string() } else { format!("{:.0} %", 100.0 * share) }
}
