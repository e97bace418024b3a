//! One joint with a torque column and under actuators that record none but whose constants are known: whether what is hidden is named as
//! often at the same non-centrality.

use std::fmt::Write;

use super::summary::{median, share};
use super::{FIRST_AMPLITUDE, Hidden, WITHOUT_TORQUE, amplitude_reaching, diagnosis_of, joint_of, set_of};
use crate::servo_draws::{logged_column, mean_about_rows};
use frikan_trainer::actuator::Kind;
use frikan_trainer::diagnose::{BaseKind, Comparison, Lock, Signals, strength};
use frikan_trainer::joint::Joint;
use frikan_trainer::physics::EffectId;
use frikan_trainer::plant::{self, CATALOGUE, NoiseKind, SimulatedRecording};
use frikan_trainer::recording::parse;
use frikan_trainer::rollout::FREE_FALL_M_S2;
use frikan_trainer::workflow::diagnose::signals;

/// Wanted non-centrality.
const STRENGTH: f64 = 80.0;
/// Rate at which the actuator closes its loop, Hz, and corner of the low-pass of its velocity: no log shows what these delay.
const DRIVE_HZ: f64 = 20_000.0;
const VELOCITY_CORNER_HZ: f64 = 8000.0;
/// Noise of the position beside that of the torque column, rad/(N m): a tenth of a milliradian where a row of the log has 0.26 N m.
const POSITION_NOISE_RAD_NM: f64 = 4e-4;
/// Distance of the payload from the axis, m: so short that it adds to the gravity alone, for the simulated joint has one inertia.
const PAYLOAD_M: f64 = 1e-4;
/// Torque per current, N m/A, resistance, ohm, and supply, V, of the motors.
const MOTOR: [f64; 3] = [4.0, 1.0, 48.0];
/// Stiffness of the position loops, N m/rad; the firmware counts its gain in the same.
const STIFFNESS_NM_RAD: f64 = 400.0;

/// Where the torque comes from that is diagnosed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A torque column.
    Column,
    /// The measured current or duty of a motor, logged with the noise of the torque column.
    Command(Kind),
    /// The reference of a position loop as the drive computed it, beside a position that is logged with noise.
    Position(Kind),
}

impl Source {
    /// All of them, the torque column first.
    pub const ALL: [Self; 5] = [
        Self::Column,
        Self::Command(Kind::Current),
        Self::Command(Kind::DcMotor),
        Self::Position(Kind::Pd),
        Self::Position(Kind::PositionServo),
    ];

    fn name(self) -> String {
        match self {
            Self::Column => "torque column".to_owned(),
            Self::Command(kind) => format!("`{}`, noise of the command", kind.name()),
            Self::Position(kind) => format!("`{}`, noise of the position", kind.name()),
        }
    }
}

/// What came of a draw under one source.
#[derive(Clone, Debug)]
pub struct Told {
    /// Where the torque comes from.
    pub source: Source,
    /// The hidden effect; `None` for a control.
    pub hidden: Option<&'static str>,
    /// Seed of everything.
    pub seed: u64,
    /// Amplitude at which the effect was hidden, 0 of none.
    pub amplitude: f64,
    /// Its non-centrality beside what that torque has as noise.
    pub lambda: f64,
    /// Every finding with its ambiguity set.
    pub findings: Vec<Vec<EffectId>>,
}

/// Effects of the catalogue that a joint without torque column can have: all but faults of that column and of the clock.
pub fn effects() -> impl Iterator<Item = &'static str> {
    let is_fault = |name: &&str| WITHOUT_TORQUE.contains(name) || *name == "torque_offset";
    CATALOGUE.iter().map(|entry| entry.name).filter(move |name| !is_fault(name))
}

/// Hides an effect, or nothing, in one joint under some sources, at the wanted non-centrality beside the noise of each, and diagnoses. What
/// came of it, or what kept the joint from being simulated or the recording from being diagnosed.
pub fn draw(hidden: Option<&'static str>, seed: u64, sources: &[Source]) -> Vec<Result<Told, String>> {
    let mut first = FIRST_AMPLITUDE;
    let told = sources.iter().map(|source| {
        let told = run(*source, hidden, seed, first);
        first = told.as_ref().map_or(first, |told| told.amplitude);
        told.map_err(|why| format!("{source:?}, {hidden:?}, seed {seed}: {why}"))
    });
    told.collect()
}

fn run(source: Source, hidden: Option<&'static str>, seed: u64, first: f64) -> Result<Told, String> {
    let case = super::Case {
        hidden: hidden.map_or(Hidden::Nothing, |name| Hidden::Effect(name, STRENGTH)),
        noise: NoiseKind::Coloured,
        base: BaseKind::CoulombViscous,
        seed,
    };
    let (amplitude, lambda, diagnosis) = if source == Source::Column {
        let super::Outcome { concealed, diagnosis, .. } = super::run(&case)?;
        let amplitude = concealed.joint.effects.first().map_or(0.0, |effect| effect.amplitude);
        (amplitude, concealed.strength.map_or(0.0, |strength| strength.lambda), diagnosis)
    } else {
        let servo = Servo::of(source, joint_of(&case))?;
        let hide = |amplitude| servo.logged(hidden.map(|name| (name, amplitude)), seed);
        let lambda_at = |amplitude| Ok::<_, String>(hide(amplitude)?.lambda());
        let amplitude = hidden.map_or(Ok(0.0), |_| amplitude_reaching(STRENGTH, first, lambda_at))?;
        let log = hide(amplitude)?;
        (amplitude, log.lambda(), diagnosis_of(&case, &log.comparison)?)
    };
    let findings = diagnosis.findings.iter().map(|finding| set_of(finding).collect()).collect();
    Ok(Told { source, hidden, seed, amplitude, lambda, findings })
}

/// The joint under an actuator.
struct Servo {
    simulated: plant::Joint,
    /// joint.toml as its owner has it.
    described: Joint,
    /// Column of the log that has noise, and its noise beside that of the torque column.
    noise: (&'static str, f64),
}

/// What is diagnosed, and what is hidden in it, N m a row.
struct Log {
    comparison: Comparison,
    effect: Vec<f64>,
}

impl Servo {
    fn of(source: Source, bare: plant::Joint) -> Result<Self, String> {
        let (Source::Command(kind) | Source::Position(kind)) = source else { return Err("it has a column".to_owned()) };
        let described = Joint::parse(&description(kind, &bare)).map_err(|e| e.to_string())?;
        let actuator = plant::Joint::described_by(&described).map_err(|e| e.to_string())?.actuator;
        let mut simulated = plant::Joint { actuator, ..bare };
        // As much noise a frequency as at the rate of the torque column.
        simulated.noise.white_torque_nm *= (DRIVE_HZ / simulated.drive.rate_hz).sqrt();
        simulated.drive.rate_hz = DRIVE_HZ;
        simulated.drive.steps_per_sample = 1;
        simulated.control.velocity_corner_hz = VELOCITY_CORNER_HZ;
        let [torque_constant, resistance, supply] = MOTOR;
        let noise = match (source, kind) {
            (Source::Position(_), _) => ("position_rad", POSITION_NOISE_RAD_NM),
            (_, Kind::Current) => ("current_A", 1.0 / torque_constant),
            _ => ("duty", resistance / torque_constant / supply),
        };
        Ok(Self { simulated, described, noise })
    }

    /// What the drive logs of the joint with an effect at an amplitude, as signals under the torque of its actuator.
    fn logged(&self, effect: Option<(&str, f64)>, seed: u64) -> Result<Log, String> {
        let mut joint = self.simulated.clone();
        joint.effects.extend(effect.map(|(name, amplitude)| plant::Hidden { name: name.to_owned(), amplitude }));
        let mut recording = plant::simulate(&joint, seed).map_err(|e| e.to_string())?;
        self.thin(&mut recording);
        let mut all: Option<Signals> = None;
        for (place, part) in recording.split().iter().enumerate() {
            let label = format!("{place}-{}", place % joint.gravity_torque_nm.len());
            let recorded = parse(&label, part.to_csv().as_bytes(), &self.described);
            let next = recorded.and_then(|one| signals(one, &self.described)).map_err(|e| e.to_string())?;
            match &mut all {
                Some(all) => all.append(next).map_err(|e| e.to_string())?,
                None => all = Some(next),
            }
        }
        let comparison = all.ok_or("nothing was recorded")?.into();
        Ok(Log { comparison, effect: recording.truth.effect_torque })
    }

    /// Leaves the rows of the log, with its noise, and of the truth its means about them.
    fn thin(&self, recording: &mut SimulatedRecording) {
        let truth = &mut recording.truth;
        let torques = [&mut truth.effect_torque, &mut truth.noise_torque];
        for series in torques.into_iter().chain([&mut truth.position, &mut truth.velocity, &mut truth.acceleration]) {
            *series = mean_about_rows(series);
        }
        let (noisy, share) = self.noise;
        for column in &mut recording.columns {
            column.values = logged_column(column.name, &column.values);
            if column.name == noisy {
                column.values.iter_mut().zip(&truth.noise_torque).for_each(|(value, noise)| *value += share * noise);
            }
        }
    }
}

impl Log {
    fn lambda(&self) -> f64 {
        // Its noise is that of the base: nobody knows it beforehand.
        let (noise, base) = (vec![0.0; self.effect.len()], BaseKind::CoulombViscous);
        strength(&self.comparison, &self.effect, &noise, base, Lock::Spread).map_or(0.0, |strength| strength.lambda)
    }
}

/// joint.toml of the joint under an actuator: its inertia and its payloads are known as well, and the constants of the actuator.
fn description(kind: Kind, joint: &plant::Joint) -> String {
    let [torque_constant, resistance, supply] = MOTOR;
    let current = format!("torque_constant_Nm_A = {torque_constant}\n");
    let motor = format!("{current}resistance_ohm = {resistance}\nsupply_V = {supply}\n");
    let constants = match kind {
        Kind::Torque => String::new(),
        Kind::Current => current,
        Kind::DcMotor => motor,
        // As much damping as that of the motors.
        Kind::Pd => format!("kp_Nm_rad = {STIFFNESS_NM_RAD}\nkd_Nms_rad = {}\n", torque_constant.powi(2) / resistance),
        Kind::PositionServo => {
            let error_gain = resistance / torque_constant / supply;
            format!("{motor}firmware_error_gain = {error_gain}\nfirmware_kp = {STIFFNESS_NM_RAD}\n")
        }
    };
    let mut text = format!(
        "[rigid_body]\ninertia_kgm2 = {}\ngravity_torque_Nm = 0\n[drive]\ngear_ratio = {}\n[actuator]\nkind = \"{}\"\n{constants}",
        joint.inertia_kgm2,
        joint.drive.gear_ratio,
        kind.name()
    );
    for (place, gravity) in joint.gravity_torque_nm.iter().enumerate() {
        let mass = gravity / (FREE_FALL_M_S2 * PAYLOAD_M);
        let _ = writeln!(text, "[recordings.\"*-{place}\"]\npayload_kg = {mass}\npayload_m = {PAYLOAD_M}");
    }
    text
}

impl Told {
    /// Whether an effect is what was hidden: of an actuator that delivers another torque also by the name that its own constants have.
    fn is_right(&self, effect: EffectId) -> bool {
        let of_actuator = match self.hidden {
            Some("torque_scale") => effect == EffectId::ActuatorGain,
            Some("saturation") => effect == EffectId::SupplyOrDutyLimit,
            _ => false,
        };
        self.hidden == Some(effect.name()) || of_actuator && self.source != Source::Column
    }

    /// Whether what is hidden is named first.
    pub fn is_first(&self) -> bool {
        self.findings.first().is_some_and(|set| self.is_right(set[0]))
    }

    /// Whether what is hidden is named or may stand in for what is.
    fn is_in_set(&self) -> bool {
        self.findings.iter().flatten().any(|effect| self.is_right(*effect))
    }

    /// Whether a name is told in whose set is nothing that is hidden.
    pub fn has_wrong_name(&self) -> bool {
        self.findings.iter().any(|set| !set.iter().any(|effect| self.is_right(*effect)))
    }

    fn names(&self) -> String {
        let set = |set: &Vec<EffectId>| set.iter().map(|effect| effect.name()).collect::<Vec<_>>().join(" or ");
        let sets = self.findings.iter().map(set).collect::<Vec<_>>().join(" + ");
        if sets.is_empty() { "nothing".to_owned() } else { sets }
    }
}

/// The results as a section of Markdown.
#[must_use]
pub fn table(results: &[Told]) -> String {
    let mut text = String::from(
        "\n## Joints that record no torque\n\nThe same joint, motions and effects with a torque column and under actuators of known constants, which record commands and positions\nalone. The torque is what the actuator makes of them; its noise is that of the logged current or duty, as large as\nthat of the torque column, or, of a position loop, whose reference is logged as it was computed, that of the logged position. The amplitude is that of a non-centrality of 80 beside the noise of each. A wrong name has nothing hidden in its set.\n\n| torque | draws | named first | in the set | a wrong name | controls with nothing named | lambda, median | amplitude over that with a torque column, median |\n|---|---|---|---|---|---|---|---|\n",
    );
    let figure = |values: Vec<f64>| median(values).map_or("-".to_owned(), |value| format!("{value:.2}"));
    for source in Source::ALL {
        let of_source = results.iter().filter(|told| told.source == source);
        let (hidden, controls): (Vec<&Told>, Vec<&Told>) = of_source.partition(|told| told.hidden.is_some());
        let part = |of: &[&Told], hit: fn(&Told) -> bool| share(of.iter().filter(|told| hit(told)).count(), of.len());
        let of_column = |told: &&Told| results.iter().find(|one| one.source == Source::Column && one.seed == told.seed);
        let beside = hidden.iter().filter_map(|told| Some(told.amplitude / of_column(told)?.amplitude));
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} |",
            source.name(),
            hidden.len(),
            part(&hidden, Told::is_first),
            part(&hidden, Told::is_in_set),
            part(&hidden, Told::has_wrong_name),
            part(&controls, |told| told.findings.is_empty()),
            figure(hidden.iter().map(|told| told.lambda).collect()),
            figure(beside.collect()),
        );
    }
    text += "\nWhat is not named first, or not alone:\n\n| torque | hidden | seed | lambda | amplitude | named |\n|---|---|---|---|---|---|\n";
    let is_clean = |told: &&Told| told.is_first() == told.hidden.is_some() && !told.has_wrong_name();
    for told in results.iter().filter(|told| !is_clean(told)) {
        let Told { source, hidden, seed, amplitude, lambda, .. } = told;
        let (hidden, source, names) = (hidden.unwrap_or("nothing"), source.name(), told.names());
        let _ = writeln!(text, "| {source} | {hidden} | {seed} | {lambda:.0} | {amplitude:.3} | {names} |");
    }
    text
}
