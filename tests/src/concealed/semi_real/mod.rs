//! Effects added to other people's recordings: real noise, real grain and real motions, and whatever physics is missing there
//! besides.

mod page;
mod recordings;
mod shapes;

pub use page::{ByItself, page};
pub use recordings::{Real, listed};
pub use shapes::ADDED;

use super::set_of;
use frikan_trainer::diagnose::{BaseKind, Diagnosis, Signals, diagnose, strength};
use frikan_trainer::physics::EffectId;

/// Parts of the recorded torque, root mean square, that an effect is given beyond what Coulomb and viscous friction absorb.
pub const SHARES: [f64; 3] = [0.02, 0.05, 0.10];

/// Most of an added torque over the part that friction does not absorb (root mean squares): what is absorbed but for less would be an
/// added torque out of all proportion to its share. Chosen by judgement.
const MOST_ABSORBED: f64 = 3.0;

/// Effects whose torque is a part of that of others (preload of a spring, Coulomb friction of one direction): where one of those is
/// there already, it grows and nothing new is to be seen.
const PARTS_OF_OTHERS: [(&str, [&str; 2]); 1] = [("torque_offset", ["spring", "direction_asymmetry"])];

/// Names that a finding is stated as, the likeliest first.
pub type Set = Vec<&'static str>;

/// What is found in a recording.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Findings, each with its set.
    pub sets: Vec<Set>,
    /// Set aside as minor.
    pub minor: Set,
}

/// What came of one addition.
#[derive(Clone, Debug)]
pub struct Added {
    /// The recording.
    pub recording: String,
    /// The effect that was added.
    pub effect: &'static str,
    /// Its part of the recorded torque.
    pub share: f64,
    /// What is found without it.
    pub before: Found,
    /// What is found with it.
    pub after: Found,
}

impl Added {
    /// Whether a finding holds the effect in its set.
    pub fn is_found(&self) -> bool {
        self.after.holds(self.effect)
    }

    /// Whether it is at least set aside as minor.
    pub fn is_found_or_minor(&self) -> bool {
        self.is_found() || self.after.minor.contains(&self.effect)
    }

    /// Those names of the surplus that no finding had before.
    pub fn new_names(&self) -> Vec<&'static str> {
        self.surplus().into_iter().filter(|name| !self.before.holds(name)).collect()
    }

    /// First names of findings whose sets do not hold the effect, and that no finding without it accounts for: each of those
    /// accounts for one of the names of its set.
    pub fn surplus(&self) -> Vec<&'static str> {
        let mut before: Vec<&Set> = self.before.sets.iter().collect();
        let others = self.after.sets.iter().filter(|set| !set.contains(&self.effect)).map(|set| set[0]);
        others
            .filter(|name| match before.iter().position(|set| set.contains(name)) {
                Some(known) => {
                    before.remove(known);
                    false
                }
                None => true,
            })
            .collect()
    }
}

impl Found {
    /// Whether a finding takes the effect up, under its own name or as a part of another.
    fn takes_up(&self, effect: &str) -> bool {
        let others = PARTS_OF_OTHERS.iter().filter(|(part, _)| *part == effect).flat_map(|(_, others)| others);
        self.holds(effect) || others.into_iter().any(|other| self.holds(other))
    }

    fn of(diagnosis: &Diagnosis) -> Self {
        let sets = diagnosis.findings.iter().map(|found| set_of(found).map(EffectId::name).collect()).collect();
        let minor = diagnosis.discarded.minor.iter().map(|(effect, _)| effect.name()).collect();
        Self { sets, minor }
    }

    /// The findings in words.
    pub fn told(&self) -> Vec<String> {
        self.sets.iter().map(|set| set.join(" or ")).collect()
    }

    /// Whether a finding holds the effect in its set.
    pub fn holds(&self, effect: &str) -> bool {
        self.sets.iter().any(|set| set.contains(&effect))
    }
}

impl Real {
    /// What is found in it as it is.
    ///
    /// # Errors
    /// What keeps it from being diagnosed.
    pub fn found(&self) -> Result<Found, String> {
        self.found_in(&self.signals)
    }

    fn found_in(&self, signals: &Signals) -> Result<Found, String> {
        diagnose(&signals.clone().into(), &self.options).map(|d| Found::of(&d)).map_err(|e| e.to_string())
    }

    /// Why an effect is not added.
    pub fn refuses(&self, effect: &str, before: &Found) -> Option<&'static str> {
        if effect == "inertia_error" && self.signals.rigid_body.is_none() {
            // Without a rigid body to be wrong its inertia is part of the base.
            Some("no rigid body")
        } else if before.takes_up(effect) {
            Some("there already")
        } else if self.unit(effect).is_none() {
            Some("absorbed by friction")
        } else {
            None
        }
    }

    /// Torque of an effect, of which friction leaves as much as the recorded torque (root mean squares); `None` where it leaves too little
    /// of it.
    fn unit(&self, effect: &str) -> Option<Vec<f64>> {
        let torque = &self.signals.torque;
        let shape = shapes::torque(effect, &self.signals.states());
        let strength =
            strength(&self.signals.clone().into(), &shape, torque, BaseKind::CoulombViscous, self.options.lock)?;
        let amplitude = 1.0 / strength.effect_to_noise.max(f64::MIN_POSITIVE);
        let unit: Vec<f64> = shape.iter().map(|value| amplitude * value).collect();
        (root_mean_square(&unit) <= MOST_ABSORBED * root_mean_square(torque)).then_some(unit)
    }

    /// Adds an effect at a share of the torque.
    ///
    /// # Errors
    /// What keeps the sum from being diagnosed.
    pub fn add(&self, effect: &'static str, share: f64, before: &Found) -> Result<Added, String> {
        let unit = self.unit(effect).ok_or("absorbed by friction")?;
        let mut with = self.signals.clone();
        with.torque.iter_mut().zip(&unit).for_each(|(t, u)| *t += share * u);
        let after = self.found_in(&with)?;
        Ok(Added { recording: self.name.clone(), effect, share, before: before.clone(), after })
    }
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(sets: &[&[&'static str]]) -> Found {
        Found { sets: sets.iter().map(|set| set.to_vec()).collect(), minor: Vec::new() }
    }

    #[test]
    fn a_finding_from_before_accounts_for_one_name_of_its_set() {
        let before = found(&[&["spring", "gravity_error"], &["unknown"]]);
        let after = found(&[&["gravity_error"], &["spring"], &["unknown", "stribeck"], &["contact"]]);
        let added = Added { recording: String::new(), effect: "stribeck", share: 0.05, before, after };
        assert!(added.is_found());
        assert_eq!(added.surplus(), ["spring", "contact"]);
    }
}
