//! A second opinion on the diagnosis: recordings by code that is independent of simulator and diagnosis, after
//! the same literature.
//!
//! Motions are prescribed, or come from controllers and integrators of this module's own; every recording is written as
//! files and diagnosed by the command line.

pub mod closed_loop;
pub mod faults;
pub mod grade;
pub mod joint;
pub mod mixtures;
pub mod motion;
pub mod noise;
pub mod numeric;
pub mod page;
pub mod protocol;
pub mod random;
pub mod recording;
pub mod run;
pub mod singles;
pub mod two_mass;

use random::Random;
use recording::Material;

/// What a case belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// One effect of friction, position, rigid body or torque chain.
    Singles,
    /// Nothing.
    Controls,
    /// Limits, events, transmission and measurement.
    Faults,
    /// Faults of the clock.
    Clock,
    /// Structures that the catalogue does not name.
    Unnamed,
    /// Two effects.
    Pairs,
    /// Each effect of the pairs by itself.
    Halves,
    /// Compared with a simulation.
    Simulations,
    /// Compared with a model of another recording.
    Models,
}

impl Part {
    /// All, in the order of the page.
    pub const ALL: [Self; 9] = [
        Self::Singles,
        Self::Controls,
        Self::Faults,
        Self::Clock,
        Self::Unnamed,
        Self::Pairs,
        Self::Halves,
        Self::Simulations,
        Self::Models,
    ];

    /// Name on the command line.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Singles => "singles",
            Self::Controls => "controls",
            Self::Faults => "faults",
            Self::Clock => "clock",
            Self::Unnamed => "unnamed",
            Self::Pairs => "pairs",
            Self::Halves => "halves",
            Self::Simulations => "simulations",
            Self::Models => "models",
        }
    }

    /// What it is, in words.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Singles => "one effect of friction, position, rigid body or torque chain",
            Self::Controls => "nothing hidden",
            Self::Faults => "limits, events, transmission, measurement",
            Self::Clock => "faults of the clock",
            Self::Unnamed => "structures outside the catalogue",
            Self::Pairs => "two effects at once",
            Self::Halves => "each effect of the pairs by itself",
            Self::Simulations => "compared with a simulation",
            Self::Models => "compared with a model of another recording",
        }
    }
}

/// Makes the files of a case.
type Record = dyn Fn(&mut Random) -> Material + Send + Sync;

/// One case: what is hidden, and the recording of it.
pub struct Case {
    /// Name by which it can be run alone.
    pub name: String,
    /// What it belongs to.
    pub part: Part,
    /// Effects that should be named; none of a control.
    pub expected: Vec<&'static str>,
    /// Effects that may be named besides.
    pub tolerated: Vec<&'static str>,
    record: Box<Record>,
}

impl Case {
    fn new(
        name: String,
        part: Part,
        expected: Vec<&'static str>,
        record: impl Fn(&mut Random) -> Material + Send + Sync + 'static,
    ) -> Self {
        Self { name, part, expected, tolerated: Vec::new(), record: Box::new(record) }
    }

    /// What the case of one seed is given; `number` is its place among all cases.
    #[must_use]
    pub fn record(&self, seed: u64, number: usize) -> Material {
        (self.record)(&mut Random::new(seed, number as u64))
    }

    /// Whether a word of the command line means it: its name, its part or an effect that it hides.
    #[must_use]
    pub fn is_meant(&self, word: &str) -> bool {
        self.name == word || self.part.key() == word || self.expected.contains(&word)
    }
}

/// All cases, always in the same order.
#[must_use]
pub fn cases() -> Vec<Case> {
    let mut cases = singles::cases();
    cases.extend(singles::controls());
    cases.extend(faults::cases());
    cases.extend(mixtures::cases());
    cases
}

#[cfg(test)]
mod tests;
