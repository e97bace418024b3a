//! Whether the 95 % intervals that `fit` prints hold the constants of simulated joints, and whether the law has their terms.

use frikan_trainer::error::{Error, Result};
use frikan_trainer::fit::outcome::Representation;
use frikan_trainer::fit::{Options, fit};
use frikan_trainer::joint::Joint;
use frikan_trainer::{plant, recording};

/// Length of a recording, s.
const SECONDS: f64 = 60.0;

/// How the friction of a joint declines from rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// Coulomb, viscous and exponential Stribeck friction.
    Exponential,
    /// The same with a Gaussian.
    Gaussian,
    /// Coulomb and viscous friction alone.
    CoulombViscous,
}

impl Truth {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Exponential, Self::Gaussian, Self::CoulombViscous];
}

/// How a joint is made and measured.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Its friction.
    pub truth: Truth,
    /// Samples a second, Hz.
    pub rate_hz: f64,
    /// Bits of one turn of the encoder.
    pub bits: u32,
}

/// A printed constant.
#[derive(Clone, Debug)]
pub struct Constant {
    /// Its name.
    pub name: String,
    /// The truth.
    pub truth: f64,
    /// What was found.
    pub value: f64,
    /// With this 95 % interval.
    pub ci95: [f64; 2],
}

impl Constant {
    /// Whether the interval holds the truth.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.ci95[0] <= self.truth && self.truth <= self.ci95[1]
    }
}

/// What `fit` prints of one recording.
#[derive(Clone, Debug)]
pub struct Printed {
    /// The law.
    pub law: String,
    /// Whether it has the terms of the truth and no other.
    pub is_right: bool,
    /// The constants that the truth has as well.
    pub constants: Vec<Constant>,
}

/// The elbow of the fixtures with another friction, rate and encoder.
///
/// # Panics
/// Where the fixture is absent.
#[must_use]
pub fn joint(setting: Setting) -> plant::Joint {
    let file = Joint::load(&crate::fixtures::folder().join("elbow.toml")).expect("it is a fixture");
    let mut joint = plant::Joint::described_by(&file).expect("it is a fixture");
    let friction = &mut joint.friction;
    match setting.truth {
        Truth::Exponential => {}
        Truth::Gaussian => friction.stribeck_exponent = 2.0,
        Truth::CoulombViscous => friction.stribeck_torque_nm = 0.0,
    }
    joint.drive.rate_hz = setting.rate_hz;
    joint.drive.counts_per_turn = 2f64.powi(setting.bits as i32);
    joint.campaign = joint.campaign.with_duration(SECONDS);
    joint
}

/// Simulates one recording and fits it.
///
/// # Errors
/// Whatever simulating or fitting refuses.
pub fn printed(setting: Setting, seed: u64) -> Result<Printed> {
    let joint = joint(setting);
    let simulated = plant::simulate(&joint, seed).map_err(Error::from)?;
    let file = Joint::default();
    let recording = recording::parse("simulated.csv", simulated.to_csv().as_bytes(), &file)?;
    let options = Options { seed: 1, representation: Some(Representation::Expression), ..Options::default() };
    let outcome = fit(&[recording], &[], &file, &options, &|_| ())?;
    let friction = &joint.friction;
    let has_stribeck = setting.truth != Truth::CoulombViscous;
    let mut truths = vec![
        ("inertia", joint.inertia_kgm2),
        ("gravity_sine", joint.gravity_torque_nm[0]),
        ("gravity_cosine", 0.0),
        ("torque_offset", 0.0),
        ("coulomb_torque", friction.coulomb_torque_nm),
        ("viscous_coefficient", friction.viscous_nm_s_rad),
    ];
    if has_stribeck {
        truths.push(("stribeck_extra_torque", friction.stribeck_torque_nm));
        truths.push(("stribeck_velocity", friction.stribeck_velocity_rad_s));
    }
    let of_the_law = |name: &str| !["smoothing", "smoothing_velocity"].contains(&name);
    let mut constants = Vec::new();
    let mut surplus = 0;
    for parameter in outcome.parameters.iter().filter(|parameter| of_the_law(&parameter.name)) {
        match truths.iter().find(|(name, _)| *name == parameter.name) {
            Some((_, truth)) => constants.push(Constant {
                name: parameter.name.clone(),
                truth: *truth,
                value: parameter.value,
                ci95: parameter.ci95,
            }),
            None => surplus += 1,
        }
    }
    let law = outcome.law.expression;
    let declines = !has_stribeck || law.contains(")²)") == (setting.truth == Truth::Gaussian);
    Ok(Printed { is_right: surplus == 0 && constants.len() == truths.len() && declines, law, constants })
}
