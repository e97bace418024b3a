//! Joints for the closed loop, and runs with them.

use frikan_runtime::shared::model::Model;
use frikan_runtime::supervised::VelocitySource;
use frikan_trainer::plant::{Control, Drive, Friction, Joint};
use frikan_trainer::rig::{
    Bench, Course, Motion, Row, Scores, adaptation_settings, drive_settings, host_drive, nominal_model, run,
    usual_form, with_contact,
};

/// Joints of three sizes. The defaults of the supervision were chosen on the first.
#[must_use]
pub fn joints() -> [(&'static str, Joint); 3] {
    let friction = |coulomb, viscous, stribeck, velocity, stiffness| Friction {
        coulomb_torque_nm: coulomb,
        viscous_nm_s_rad: viscous,
        stribeck_torque_nm: stribeck,
        stribeck_velocity_rad_s: velocity,
        stribeck_exponent: 1.0,
        contact_stiffness_nm_rad: stiffness,
        ..Friction::default()
    };
    let joint = |inertia_kgm2: f64, friction, (stiffness, damping): (f64, f64)| {
        let omega = (stiffness / inertia_kgm2).sqrt();
        Joint {
            inertia_kgm2,
            gravity_torque_nm: Vec::new(),
            friction,
            control: Control {
                bandwidth_hz: omega / std::f64::consts::TAU,
                damping_ratio: damping / (2.0 * omega * inertia_kgm2),
                velocity_corner_hz: 100.0,
                ..Control::default()
            },
            drive: Drive { counts_per_turn: 1_048_576.0, ..Drive::default() },
            ..Joint::default()
        }
    };
    [
        ("elbow of 0.5 kg m2", joint(0.5, friction(2.0, 1.1, 0.8, 0.05, 3000.0), (500.0, 30.0))),
        ("wrist of 0.02 kg m2", joint(0.02, friction(0.15, 0.05, 0.05, 0.08, 200.0), (30.0, 1.4))),
        ("base of 12 kg m2", joint(12.0, friction(40.0, 25.0, 15.0, 0.03, 60_000.0), (12_000.0, 720.0))),
    ]
}

/// Those, and that of `fixtures/elbow.toml`: its 250 Hz and stiffer loop were never tuned for.
///
/// # Panics
/// Where the fixture is not there.
#[must_use]
pub fn every_joint() -> Vec<(&'static str, Joint)> {
    let file = frikan_trainer::joint::Joint::load(&crate::fixtures::folder().join("elbow.toml")).expect("a fixture");
    let fixture = with_contact(&Joint::described_by(&file).expect("a joint"));
    joints().into_iter().chain([("fixture", fixture)]).collect()
}

/// What compensates in a run.
#[derive(Clone, Copy, Debug)]
pub struct Compensation<'a, const CELLS: usize> {
    /// Its law.
    pub model: &'a Model<CELLS>,
    /// Share of it.
    pub gain: f32,
    /// Velocity at which it is evaluated; the monitor watches the blended one alone.
    pub source: VelocitySource,
    /// Whether it follows a friction that differs from the model's.
    pub adapts: bool,
}

impl<'a, const CELLS: usize> Compensation<'a, CELLS> {
    /// The blended compensation of a supervised drive, that does not adapt.
    #[must_use]
    pub fn supervised(model: &'a Model<CELLS>, gain: f32) -> Self {
        Self { model, gain, source: VelocitySource::Blended, adapts: false }
    }
}

/// The rows of a motion, friction `friction_scale` times that of the description, effects of `seed`.
///
/// # Panics
/// Where the joint cannot be simulated or the gain is none.
#[must_use]
pub fn rows<const CELLS: usize>(
    joint: &Joint,
    motion: Motion,
    friction_scale: f64,
    seed: u64,
    compensation: Compensation<'_, CELLS>,
) -> Vec<Row> {
    let Compensation { model, gain, source, adapts } = compensation;
    let mut settings = drive_settings(joint, gain, model.output_limit).expect("a gain");
    settings.supervision.source = source;
    settings.supervision.monitored = source == VelocitySource::Blended;
    settings.supervision.adaptation = adapts.then(|| adaptation_settings(joint).expect("a friction"));
    let course = Course::Standard(motion);
    let bench = Bench {
        joint: joint.clone(),
        seed,
        friction_scale,
        course,
        feed_forward: usual_form(joint),
        duration: motion.duration(),
        swap: None,
    };
    run(&bench, &mut host_drive(model.clone(), &settings).expect("settings")).expect("a run")
}

/// Scores with a share of the blended compensation by `model`.
#[must_use]
pub fn scores<const CELLS: usize>(
    joint: &Joint,
    motion: Motion,
    scale: f64,
    model: &Model<CELLS>,
    gain: f32,
) -> Scores {
    Scores::of(&rows(joint, motion, scale, 1, Compensation::supervised(model, gain)), motion.nudge_end())
}

/// The model of the joint's own sliding friction.
///
/// # Panics
/// Where an image cannot hold it.
#[must_use]
pub fn own_model(joint: &Joint) -> Model<16> {
    nominal_model(&joint.friction).expect("a model")
}
