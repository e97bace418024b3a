//! Effects concealed in simulated recordings, and what the diagnosis makes of them.
//!
//! The simulator (`plant`) and the diagnosis are independent code after the same literature (the Dahl element and the law of a dwell
//! stand in both); this module is the only place where they meet.

pub mod advised;
pub mod afterwards;
pub mod false_alarms;
pub mod intervals;
pub mod page;
pub mod semi_real;
pub mod servo;
pub mod simulated;
pub mod summary;
pub mod symbolic;
pub mod tables;

use std::fmt;

use frikan_trainer::diagnose::{
    BaseKind, Comparison, Diagnosis, Finding, Lock, Options, Settings, Signals, Strength, diagnose, strength,
};
use frikan_trainer::physics::EffectId;
use frikan_trainer::plant::{self, NoiseKind, SimulatedRecording};

/// What is hidden in one recording.
#[derive(Clone, Debug, PartialEq)]
pub enum Hidden {
    /// Nothing: a control.
    Nothing,
    /// One effect at a wanted non-centrality.
    Effect(&'static str, f64),
    /// Two effects, each at a wanted non-centrality.
    Pair(&'static str, &'static str, f64),
}

/// One case of the suite.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What is hidden.
    pub hidden: Hidden,
    /// Noise of the recording.
    pub noise: NoiseKind,
    /// Base model that the diagnosis starts from; a reference is a Stribeck law fitted to the recording.
    pub base: BaseKind,
    /// Seed of everything.
    pub seed: u64,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.hidden {
            Hidden::Nothing => write!(f, "nothing")?,
            Hidden::Effect(effect, wanted) => write!(f, "{effect} at {wanted}")?,
            Hidden::Pair(first, second, wanted) => write!(f, "{first} and {second} at {wanted}")?,
        }
        write!(f, ", {} noise, seed {}", self.noise.name(), self.seed)
    }
}

/// Pairs whose members are far apart in the catalogue.
pub const PAIRS: [(&str, &str); 6] = [
    ("stribeck", "load_friction"),
    ("coupling", "torque_offset"),
    ("inertia_error", "contact"),
    ("presliding", "warm_up"),
    ("position_ripple", "slow_drift"),
    ("frictional_lag", "spring"),
];

/// A recording with the effects of a case hidden in it.
#[derive(Clone, Debug)]
pub struct Concealed {
    /// The recording with its truth.
    pub recording: SimulatedRecording,
    /// The joint with its effects at the amplitudes that were chosen.
    pub joint: plant::Joint,
    /// Reached strength; `None` for a control, or where the recording cannot determine the base.
    pub strength: Option<Strength>,
}

/// What came of a case.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The case.
    pub case: Case,
    /// What was diagnosed.
    pub concealed: Concealed,
    /// The diagnosis.
    pub diagnosis: Diagnosis,
}

/// Signals of a simulated recording as a user's joint file would describe them: nominal inertia and load torque given.
pub fn signals(recording: &SimulatedRecording, joint: &plant::Joint) -> Signals {
    let owned = |name: &str| recording.column(name).map(<[f64]>::to_vec);
    let time = owned("time_s").unwrap_or_default();
    let position = owned("position_rad").unwrap_or_default();
    let period = 1.0 / joint.drive.rate_hz;
    let trajectory = owned("trajectory").unwrap_or_default();
    let mut segments = Vec::new();
    let mut begin = 0;
    for i in 1..=time.len() {
        let gap = i < time.len() && time[i] - time[i - 1] > 1.5 * period;
        if i == time.len() || gap || trajectory[i] != trajectory[i - 1] {
            segments.push(begin..i);
            begin = i;
        }
    }
    let load = owned("load_torque_Nm");
    let mut signals = Signals {
        period,
        torque: owned("torque_Nm").unwrap_or_default(),
        temperature: owned("temperature_C"),
        link_position: owned("link_position_rad"),
        other_positions: owned("other_position_rad").into_iter().collect(),
        segments,
        gear_ratio: Some(joint.drive.gear_ratio),
        rotary: true,
        position_resolution: smallest_step(&position),
        time,
        position,
        ..Signals::default()
    };
    signals.give_rigid_body(joint.inertia_kgm2, load.as_deref());
    signals.load = load;
    signals
}

fn smallest_step(position: &[f64]) -> f64 {
    position.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|s| *s > 1e-12).fold(f64::INFINITY, f64::min)
}

/// The joint of a case before anything is hidden in it.
pub fn joint_of(case: &Case) -> plant::Joint {
    let mut joint = plant::Joint::default();
    joint.noise.kind = case.noise;
    joint
}

/// Amplitude with which the search for the wanted strength begins.
const FIRST_AMPLITUDE: f64 = 0.3;
/// Largest number of passes in which the amplitude is brought to the wanted strength.
const PASSES: usize = 6;

/// Hides the effects of a case at the wanted strength.
pub fn conceal(case: &Case) -> Result<Concealed, plant::PlantError> {
    let mut joint = joint_of(case);
    let (names, wanted): (Vec<&'static str>, f64) = match &case.hidden {
        Hidden::Nothing => {
            let recording = plant::simulate(&joint, case.seed)?;
            return Ok(Concealed { recording, joint, strength: None });
        }
        Hidden::Effect(name, lambda) => (vec![name], *lambda),
        Hidden::Pair(first, second, lambda) => (vec![first, second], *lambda),
    };
    for name in names {
        let amplitude = amplitude_for(&joint, name, wanted, case)?;
        joint.effects.push(plant::Hidden { name: name.to_string(), amplitude });
    }
    let recording = plant::simulate(&joint, case.seed)?;
    let strength = reach(&recording, &recording.truth.effect_torque, &joint, case);
    Ok(Concealed { recording, joint, strength })
}

fn reach(recording: &SimulatedRecording, torque: &[f64], joint: &plant::Joint, case: &Case) -> Option<Strength> {
    let base = if case.base == BaseKind::Spline { BaseKind::Spline } else { BaseKind::CoulombViscous };
    strength(&signals(recording, joint).into(), torque, &recording.truth.noise_torque, base, Lock::Spread)
}

/// Faults of the measurement that have no torque of their own, or none below a threshold: their amplitude is taken as it is.
pub const WITHOUT_TORQUE: [&str; 4] = ["quantisation", "unit_or_sign", "clock_gaps", "time_misalignment"];

/// Amplitude at which an effect adds a torque of the wanted strength to what the joint already hides.
fn amplitude_for(joint: &plant::Joint, name: &'static str, wanted: f64, case: &Case) -> Result<f64, plant::PlantError> {
    if WITHOUT_TORQUE.contains(&name) {
        return Ok(1.0);
    }
    let without = plant::simulate(joint, case.seed)?.truth.effect_torque;
    amplitude_reaching(wanted, FIRST_AMPLITUDE, |amplitude| {
        let recording = plant::conceal(joint, name, amplitude, case.seed)?;
        let torque: Vec<f64> =
            recording.truth.effect_torque.iter().zip(&without).map(|(both, one)| both - one).collect();
        Ok(reach(&recording, &torque, joint, case).map_or(0.0, |strength| strength.lambda))
    })
}

/// Amplitude at which the non-centrality comes within a tenth of the wanted one, as far as a few passes bring it there from a first one.
fn amplitude_reaching<E>(wanted: f64, first: f64, mut lambda_at: impl FnMut(f64) -> Result<f64, E>) -> Result<f64, E> {
    let mut amplitude = first;
    // Non-centrality goes with the square of a torque; of a compliance or a play with another power, which two passes show.
    let mut power = 2.0;
    let mut before: Option<(f64, f64)> = None;
    for _ in 0..PASSES {
        let lambda = lambda_at(amplitude)?.max(1e-3);
        if (wanted / lambda - 1.0).abs() < 0.1 {
            break;
        }
        if let Some((earlier, reached)) = before {
            power = ((lambda / reached).ln() / (amplitude / earlier).ln()).clamp(1.0, 5.0);
        }
        before = Some((amplitude, lambda));
        amplitude *= (wanted / lambda).powf(1.0 / power).clamp(0.1, 8.0);
    }
    Ok(amplitude)
}

/// The diagnosis of a case's signals.
///
/// # Errors
/// What keeps the recording from being diagnosed.
pub fn diagnosis_of(case: &Case, comparison: &Comparison) -> Result<Diagnosis, String> {
    let settings = Settings { seed: case.seed, ..Settings::default() };
    let options = Options { base: case.base, settings, ..Options::default() };
    diagnose(comparison, &options).map_err(|e| e.to_string())
}

/// Runs a case.
pub fn run(case: &Case) -> Result<Outcome, String> {
    let concealed = conceal(case).map_err(|e| e.to_string())?;
    let signals = signals(&concealed.recording, &concealed.joint);
    let comparison = match case.base {
        BaseKind::Reference => symbolic::compare_with_own_law(signals)?,
        _ => signals.into(),
    };
    let diagnosis = diagnosis_of(case, &comparison)?;
    Ok(Outcome { case: case.clone(), concealed, diagnosis })
}

impl Outcome {
    /// Strength of what is hidden on the rows of the diagnosis, its torque and noise put back as it put back the torque; `None` for
    /// a control, of a fault of the measurement, and where it did not start from Coulomb and viscous friction.
    pub fn strength_as_diagnosed(&self) -> Option<Strength> {
        let Self { case, concealed: Concealed { recording, joint, strength: hidden }, diagnosis } = self;
        let is_fault = matches!(case.hidden, Hidden::Effect(name, _) if WITHOUT_TORQUE.contains(&name));
        if hidden.is_none() || is_fault || case.base != BaseKind::CoulombViscous {
            return None;
        }
        let recorded = signals(recording, joint);
        let put_back = |torque: &[f64]| {
            Signals { torque: torque.to_vec(), ..recorded.clone() }.realigned(diagnosis.realigned_by_s)
        };
        let [effect, noise] =
            [&recording.truth.effect_torque, &recording.truth.noise_torque].map(|t| put_back(t).torque);
        strength(&put_back(&recorded.torque).into(), &effect, &noise, case.base, diagnosis.lock)
    }

    /// Names of the findings in the order in which they were accepted.
    pub fn named(&self) -> Vec<EffectId> {
        self.diagnosis.findings.iter().map(|finding| finding.effect).collect()
    }

    /// Channels that the first unnamed finding states, likeliest first; empty where there is none.
    pub fn unknown_channels(&self) -> Vec<&'static str> {
        let stated = self.diagnosis.findings.iter().map(|finding| &finding.channels).find(|stated| !stated.is_empty());
        stated.into_iter().flatten().map(|channel| channel.name()).collect()
    }
}

/// The named effect of a finding, then the rivals of its ambiguity set.
pub fn set_of(finding: &Finding) -> impl Iterator<Item = EffectId> {
    std::iter::once(finding.effect).chain(finding.alternatives.iter().map(|(rival, _)| *rival))
}
