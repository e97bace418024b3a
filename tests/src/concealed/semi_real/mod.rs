//! Effects added to other people's recordings: real noise, real grain and real motions, and whatever physics is missing there
//! besides.

mod page;
mod recordings;
mod shapes;

pub use page::page;
pub use recordings::{Real, listed};
pub use shapes::ADDED;

use super::set_of;
use frikan_trainer::diagnose::{BaseKind, Diagnosis, Signals, diagnose, strength};
use frikan_trainer::physics::EffectId;
use shapes::torque;

/// Parts of the recorded torque, root mean square, that an effect is given beyond what Coulomb and viscous friction absorb.
pub const SHARES: [f64; 3] = [0.02, 0.05, 0.10];

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

    /// Effects that can be added: without a rigid body to be wrong its inertia is part of the base.
    pub fn can_have(&self) -> impl Iterator<Item = &'static str> {
        ADDED.into_iter().filter(|effect| *effect != "inertia_error" || self.signals.rigid_body.is_some())
    }

    /// Adds an effect at a share of the torque.
    ///
    /// # Errors
    /// What keeps the sum from being diagnosed.
    pub fn add(&self, effect: &'static str, share: f64, before: &Found) -> Result<Added, String> {
        let shape = torque(effect, &self.signals.states());
        let (plain, lock) = (BaseKind::CoulombViscous, self.options.lock);
        let one = strength(&self.signals.clone().into(), &shape, &self.signals.torque, plain, lock);
        let amplitude = one.map_or(0.0, |s| share / s.effect_to_noise.max(f64::MIN_POSITIVE));
        let mut with = self.signals.clone();
        with.torque.iter_mut().zip(&shape).for_each(|(t, s)| *t += amplitude * s);
        let after = self.found_in(&with)?;
        Ok(Added { recording: self.name.clone(), effect, share, before: before.clone(), after })
    }
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
