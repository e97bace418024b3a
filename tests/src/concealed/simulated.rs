//! Recordings compared with a simulation of the same command whose simulator holds none, one or all of the hidden effects.

use std::fmt::Write;

use super::summary::share;
use super::{Case, Hidden, conceal, diagnosis_of, set_of, signals};
use frikan_trainer::diagnose::{self, learn_simulation as learn};
use frikan_trainer::physics::EffectId;
use frikan_trainer::plant::{self, NoiseKind};

/// A recording and the simulation that it is compared with.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The row of the table in which it counts.
    pub group: Group,
    /// The recording.
    pub case: Case,
}

/// What the simulator holds, and how much of the recorded motion it has run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Static friction, which is all that the joint has.
    Control,
    /// The one hidden effect.
    Held,
    /// All but the one hidden effect.
    Missing,
    /// The first of two hidden effects.
    HeldAndMissing,
    /// The one hidden effect, in half of the motion.
    ShorterHeld,
    /// The first of two hidden effects, in half of the motion.
    ShorterHeldAndMissing,
}

impl Group {
    /// The rows of the table.
    pub const ALL: [Self; 6] = [
        Self::Control,
        Self::Held,
        Self::Missing,
        Self::HeldAndMissing,
        Self::ShorterHeld,
        Self::ShorterHeldAndMissing,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Control => "all of it: nothing is hidden, and the recording has one of five kinds of noise",
            Self::Held => "all of it: the one hidden effect",
            Self::Missing => "nothing of the one hidden effect",
            Self::HeldAndMissing => "the first of two hidden effects",
            Self::ShorterHeld => "all of it, ten times as large; it ends after half of the motion",
            Self::ShorterHeldAndMissing => "the first of two hidden effects; it ends after half of the motion",
        }
    }

    /// Number of the hidden effects that the simulator holds.
    fn held(self) -> usize {
        usize::from(!matches!(self, Self::Control | Self::Missing))
    }

    /// Share of the recorded motion that is simulated.
    fn simulated(self) -> f64 {
        if matches!(self, Self::ShorterHeld | Self::ShorterHeldAndMissing) { 0.5 } else { 1.0 }
    }
}

/// What was named of a recording beside its simulation.
#[derive(Clone, Debug)]
pub struct Compared {
    /// What was compared.
    pub comparison: Comparison,
    /// Hidden effects that the simulator holds too.
    pub held: Vec<String>,
    /// The hidden effect that it lacks.
    pub missing: Option<String>,
    /// Every finding with its ambiguity set.
    pub findings: Vec<Vec<EffectId>>,
}

/// Hides the effects of a case, simulates the same command without noise with the first of them, and diagnoses.
///
/// # Errors
/// What keeps the joint from being simulated, its law from being learned or the recording from being diagnosed.
pub fn run(comparison: &Comparison) -> Result<Compared, String> {
    let Comparison { group, case } = comparison;
    let real = conceal(case).map_err(|e| e.to_string())?;
    let mut simulator = real.joint.clone();
    simulator.effects.truncate(group.held());
    simulator.noise =
        plant::Noise { kind: NoiseKind::White, white_torque_nm: 0.0, coloured_torque_nm: 0.0, ..simulator.noise };
    let mut simulation = plant::simulate(&simulator, case.seed).map_err(|e| e.to_string())?;
    for column in &mut simulation.columns {
        column.values.truncate((group.simulated() * column.values.len() as f64) as usize);
    }
    let recorded = signals(&real.recording, &real.joint);
    let law = learn(&signals(&simulation, &simulator), &recorded).map_err(|e| e.to_string())?;
    let reference = law.at(&recorded.states());
    let diagnosis = diagnosis_of(case, &diagnose::Comparison::with(recorded, reference))?;
    let mut names = real.joint.effects.into_iter().map(|effect| effect.name);
    Ok(Compared {
        comparison: comparison.clone(),
        held: names.by_ref().take(group.held()).collect(),
        missing: names.next(),
        findings: diagnosis.findings.iter().map(|finding| set_of(finding).collect()).collect(),
    })
}

impl Compared {
    /// What was named first.
    fn first(&self) -> Option<EffectId> {
        self.findings.first().map(|set| set[0])
    }

    fn is_first_right(&self) -> bool {
        self.first().map(EffectId::name) == self.missing.as_deref()
    }

    fn is_in_set(&self) -> bool {
        match &self.missing {
            Some(missing) => self.findings.iter().flatten().any(|effect| effect.name() == missing),
            None => self.findings.is_empty(),
        }
    }

    /// Whether something is named that the simulator holds.
    fn names_the_held(&self) -> bool {
        self.findings.iter().any(|set| self.held.iter().any(|held| set[0].name() == held))
    }

    fn truth(&self) -> String {
        match &self.comparison.case.hidden {
            Hidden::Nothing => format!("nothing hidden, {} noise", self.comparison.case.noise.name()),
            _ => {
                let missing = self.missing.as_deref().unwrap_or("nothing");
                let held = if self.held.is_empty() { "nothing".to_owned() } else { self.held.join(", ") };
                format!("the simulator holds {held}, missing is {missing} ({})", self.comparison.group.name())
            }
        }
    }
}

/// The page.
pub fn report(results: &[Compared], command: &str) -> String {
    let mut text = format!(
        "# Recordings compared with a simulation\n\nRegenerated by `{command}`; every figure below is measured by that command.\nBrackets are 95 % intervals (Wilson). The simulation is of the same command; the recording has noise, the simulation has none. Its\nsimulator holds what the first column says. Faults of the measurement are left out: they are told of a recording whatever it is compared with.\n\n| the simulator holds | right: the missing effect first, or nothing | in the set, or nothing | names what the simulator holds |\n|---|---|---|---|\n"
    );
    for group in Group::ALL {
        let of_group: Vec<&Compared> = results.iter().filter(|result| result.comparison.group == group).collect();
        let part = |hit: fn(&Compared) -> bool| share(of_group.iter().filter(|r| hit(r)).count(), of_group.len());
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} |",
            group.name(),
            part(Compared::is_first_right),
            part(Compared::is_in_set),
            part(Compared::names_the_held)
        );
    }
    let _ = writeln!(text, "\n## Every miss\n");
    for miss in results.iter().filter(|result| !result.is_first_right()) {
        let named: Vec<String> = miss
            .findings
            .iter()
            .map(|set| set.iter().map(|effect| effect.name()).collect::<Vec<_>>().join(" or "))
            .collect();
        let named = if named.is_empty() { "nothing".to_string() } else { named.join(" + ") };
        let _ = writeln!(text, "* {}, seed {}: {named}", miss.truth(), miss.comparison.case.seed);
    }
    text
}
