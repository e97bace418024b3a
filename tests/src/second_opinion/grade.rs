//! What an answer is worth.

use super::Case;
use super::run::{Answer, Finding};

/// Grades, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Grade {
    /// Every hidden effect is named, and nothing else. Of a control: nothing is named.
    Right,
    /// Every hidden effect is named, and something else.
    Surplus,
    /// Every hidden effect is named or among the alternatives.
    InTheSet,
    /// Some of the hidden effects are named or among the alternatives.
    InPart,
    /// Nothing is named.
    Nothing,
    /// Something else is named. Of a control: anything is.
    Wrong,
    /// The recording is refused with a message.
    Refused,
}

impl Grade {
    /// All, in the order of the columns.
    pub const ALL: [Self; 7] =
        [Self::Right, Self::Surplus, Self::InTheSet, Self::InPart, Self::Nothing, Self::Wrong, Self::Refused];

    /// Head of its column.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Surplus => "right with surplus",
            Self::InTheSet => "in the set",
            Self::InPart => "one of two",
            Self::Nothing => "nothing said",
            Self::Wrong => "wrong name",
            Self::Refused => "refused",
        }
    }

    /// The grade of an answer.
    #[must_use]
    pub fn of(case: &Case, answer: &Answer) -> Self {
        let findings = match answer {
            Answer::Refused(_) => return Self::Refused,
            Answer::Findings(findings) => findings,
        };
        let (expected, tolerated) = (&case.expected, &case.tolerated);
        let mut counted = findings.iter().filter(|found| !is_one_of(tolerated, &found.effect));
        if expected.is_empty() {
            return if counted.next().is_none() { Self::Right } else { Self::Wrong };
        }
        if findings.is_empty() {
            return Self::Nothing;
        }
        let in_set = |name: &&str| findings.iter().any(|found| holds(found, name));
        if expected.iter().all(|name| findings.iter().any(|found| found.effect == *name)) {
            let has_surplus = counted.any(|found| !is_one_of(expected, &found.effect));
            return if has_surplus { Self::Surplus } else { Self::Right };
        }
        match expected.iter().filter(|name| in_set(name)).count() {
            all if all == expected.len() => Self::InTheSet,
            0 => Self::Wrong,
            _ => Self::InPart,
        }
    }
}

fn is_one_of(names: &[&str], name: &str) -> bool {
    names.contains(&name)
}

fn holds(found: &Finding, name: &str) -> bool {
    found.effect == name || found.alternatives.iter().any(|other| other == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::second_opinion::cases;

    fn graded(case: &str, findings: &[(&str, &[&str])]) -> Grade {
        let all = cases();
        let case = all.iter().find(|own| own.name == case).expect("the case exists");
        let finding = |(effect, alternatives): &(&str, &[&str])| Finding {
            effect: (*effect).to_owned(),
            alternatives: alternatives.iter().map(|name| (*name).to_owned()).collect(),
        };
        Grade::of(case, &Answer::Findings(findings.iter().map(finding).collect()))
    }

    #[test]
    fn single_effects() {
        assert_eq!(graded("stribeck-1", &[("stribeck", &["presliding"])]), Grade::Right);
        assert_eq!(graded("stribeck-1", &[("spring", &[]), ("stribeck", &[])]), Grade::Surplus);
        assert_eq!(graded("stribeck-1", &[("presliding", &["stribeck"])]), Grade::InTheSet);
        assert_eq!(graded("stribeck-1", &[("presliding", &[])]), Grade::Wrong);
        assert_eq!(graded("stribeck-1", &[]), Grade::Nothing);
    }

    #[test]
    fn pairs_and_controls() {
        assert_eq!(graded("pair-1", &[("stribeck", &[])]), Grade::InPart);
        assert_eq!(graded("pair-1", &[("position_ripple", &[]), ("stribeck", &[])]), Grade::Right);
        assert_eq!(graded("control-1", &[]), Grade::Right);
        assert_eq!(graded("control-1", &[("stribeck", &[])]), Grade::Wrong);
        assert_eq!(graded("clock-jitter", &[("time_misalignment", &[])]), Grade::Right);
    }
}
